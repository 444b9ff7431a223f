#!/usr/bin/python3
"""How well `recede orient` reads the plane: the angle between its normal and the true one.

    ./dev bench orient                   the shared cases and photos, and holes in drawn streets
    ./dev bench orient --cases FOLDER    other cases that make_cases.py's code has drawn
    ./dev bench orient 01 pier           those whose name begins so

Every picture is read with its mask (the plane under the hole is meant) and its field of view (50
for photos, whose horizons were read off by hand to 3 % of the height). "low" is a confidence below
0.5: the command says not to trust it, and `fill` falls back to no perspective. Writes orient.json
into --out.
"""
import argparse
import json
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / 'quality'))
from evaluation import PROJECT, load_cases, synthetic_case  # noqa: E402
from report import number, table  # noqa: E402
from streets import load_streets  # noqa: E402

LOW = .5       # RECEDE_CONFIDENCE_LOW
GROSS_DEG = 25
GOOD_DEG = 5
PHOTO_FOV_DEG = 50


def arguments():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('names', nargs='*', help='beginnings of cases\' names')
    parser.add_argument('--binary', type=Path, default=PROJECT / 'build' / 'cli' / 'recede')
    parser.add_argument('--cases', type=Path, help='a folder of cases instead of the shared ones')
    parser.add_argument('--jobs', type=int, default=2)
    parser.add_argument('--out', type=Path, default=PROJECT / 'out' / 'orient')
    return parser.parse_args()


def fov_of(case):
    given = [option[6:] for option in case.options if option.startswith('--fov=')]
    return float(given[0]) if given else PHOTO_FOV_DEG


def true_normal(case, width, height):
    """From the horizon's line w = a x + b y + c; None where nobody has read it off."""
    a, b, c = case.line
    if case.is_photo and a == b == 0:
        return None
    focal = .5 * max(width, height) / np.tan(np.radians(fov_of(case)) / 2)
    normal = np.array([a * focal, b * focal, a * (width - 1) / 2 + b * (height - 1) / 2 + c])
    return normal / np.linalg.norm(normal)


def found_normal(orientation):
    slant, tilt = np.radians([orientation['slant_deg'], orientation['tilt_deg']])
    return np.array([-np.sin(slant) * np.sin(tilt), np.sin(slant) * np.cos(tilt), np.cos(slant)])


def measure(binary, case):
    ran = subprocess.run([binary, 'orient', case.folder / 'input.png' if
                          (case.folder / 'input.png').exists() else case.folder / 'truth.png',
                          '--mask', case.folder / 'mask.png', f'--fov={fov_of(case)}',
                          '--threads=1', '--json=-'], capture_output=True, text=True, timeout=120)
    row = {'case': case.name, 'photo': case.is_photo, 'error': None, 'confidence': 0.,
           'seconds': None, 'said': ran.stderr.strip()}
    if ran.returncode:
        return row
    said = json.loads(ran.stdout)
    orientation = said['orientation']
    height, width = case.mask.shape
    truth = true_normal(case, width, height)
    if truth is not None:
        cosine = np.clip(truth @ found_normal(orientation), -1, 1)
        row['error'] = float(np.degrees(np.arccos(cosine)))
    return row | {'confidence': orientation['confidence'], 'slant': orientation['slant_deg'],
                  'tilt': orientation['tilt_deg'], 'seconds': sum(said['stages'].values())}


def verdict(row):
    if row['error'] is None:
        return row['said'] if row['seconds'] is None else 'truth unknown'
    low = row['confidence'] < LOW
    if row['error'] > GROSS_DEG:
        return 'gross, announced' if low else 'GROSS, NOT ANNOUNCED'
    return 'good, but announced as low' if low and row['error'] < GOOD_DEG else 'low' if low else ''


def summary(name, rows):
    errors = np.array([90. if row['error'] is None else row['error'] for row in rows])
    low = np.array([row['confidence'] < LOW for row in rows])
    gross = errors > GROSS_DEG
    seconds = [row['seconds'] for row in rows if row['seconds'] is not None]
    return [name, len(rows), number(np.median(errors), 2), number(np.percentile(errors, 90), 2),
            int((errors < GOOD_DEG).sum()), int(gross.sum()), int((gross & ~low).sum()),
            int(((errors < GOOD_DEG) & low).sum()),
            number(np.mean(seconds) if seconds else None, 2)]


def wanted_cases(names):
    streets = load_streets(names)
    only_streets = names and all(name.startswith('street') for name in names)
    return ([] if only_streets else load_cases(names)) + streets


def group_of(row):
    if row['photo']:
        return 'photos'
    return row['case'].split('_')[0] + 's' if row['case'].startswith('street') else 'drawn'


def main():
    given = arguments()
    cases = ([synthetic_case(path) for path in sorted(given.cases.iterdir())] if given.cases
             else wanted_cases(given.names))
    with ThreadPoolExecutor(given.jobs) as pool:
        rows = list(pool.map(lambda case: measure(given.binary, case), cases))
    print(table(['case', 'error°', 'slant', 'tilt', 'confidence', ''],
                [[row['case'], number(row['error']), number(row.get('slant')),
                  number(row.get('tilt')), number(row['confidence'], 2), verdict(row)]
                 for row in rows]))
    known = [row for row in rows if not row['photo'] or
             row['error'] is not None or row['seconds'] is None]
    groups = {name: [row for row in known if group_of(row) == name]
              for name in ('drawn', 'photos', 'street-floors', 'street-walls')}
    print(table(['', 'cases', 'median°', 'p90°', f'< {GOOD_DEG}°', f'> {GROSS_DEG}°',
                 'of these not announced', f'< {GOOD_DEG}° but low', 'seconds'],
                [summary(name, found) for name, found in groups.items() if found]))
    given.out.mkdir(parents=True, exist_ok=True)
    (given.out / 'orient.json').write_text(json.dumps(rows, indent=1) + '\n')


if __name__ == '__main__':
    main()
