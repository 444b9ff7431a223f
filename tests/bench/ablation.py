#!/usr/bin/python3
"""What each stage of the plane engine gains: scores and CPU time with one stage off at a time.

    ./dev bench ablation                       every stage, the rendered cases: some minutes
    ./dev bench ablation --cases 000,013 --stages join,detail

Prints a markdown table and writes it, with all scores, into --out. The stages and what they do are
read from core/params.c.
"""
import argparse
import json
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / 'quality'))
from evaluation import PROJECT, load_cases  # noqa: E402
from methods import missing_programs  # noqa: E402
from report import STEEP_DEG, figures, mean, number, table  # noqa: E402
from score import score_all  # noqa: E402

STAGE = re.compile(r'STAGE\("engine-([a-z-]+)",\s*\w+,\s*"([^"]*)"\)')
METHOD = 'plane'


def words(text):
    return [word for word in text.split(',') if word]


def stages():
    """{name: what it does}"""
    return dict(STAGE.findall((PROJECT / 'core' / 'params.c').read_text()))


def arguments():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--binary', type=Path, default=PROJECT / 'build' / 'cli' / 'recede')
    parser.add_argument('--cases', type=words, help="comma-separated beginnings of cases' names")
    parser.add_argument('--photos', action='store_true', help='the photos too')
    parser.add_argument('--stages', type=words, default=list(stages()))
    parser.add_argument('--jobs', type=int, default=2)
    parser.add_argument('--out', type=Path, default=PROJECT / 'out' / 'ablation')
    chosen = parser.parse_args()
    for name in chosen.stages:
        if name not in stages():
            parser.error(f'no stage {name}; there are {", ".join(stages())}')
    return chosen


def main():
    chosen = arguments()
    problems = list(missing_programs([METHOD], chosen.binary))
    if problems:
        sys.exit('\n'.join(problems))
    cases = [case for case in load_cases(chosen.cases) if chosen.photos or not case.is_photo]
    variants = {'everything on': []}
    variants.update({f'no {name}: {stages()[name]}': [f'--set=engine-{name}=0']
                     for name in chosen.stages})
    variants['no choice: a single start of the coarsest level'] = ['--set=engine-starts=1']
    rows, everything, base = [], {}, None
    for title, extra in variants.items():
        print(title, file=sys.stderr)
        folder = chosen.out / (extra[0].split('=')[1] if extra else 'all')
        scores = score_all(cases, [METHOD], chosen.binary, extra, folder, chosen.jobs)
        everything[title] = scores
        row = figures(cases, scores, [METHOD])[METHOD]
        base = base or row
        total = mean(found[METHOD]['score'] for found in scores.values())
        rows.append([title, number(total), number(row['mean_steep']), number(row['regular'], 3),
                     number(row['sharpness'], 3), number(row['seam'], 3), number(row['cpu'], 2),
                     number(row['cpu'] / base['cpu'], 2), row['failed']])
    text = table(['variant', 'score', f'>= {STEEP_DEG:.0f} deg', 'regular', 'sharpness', 'seam',
                  'CPU s', 'ratio', 'failed'], rows)
    print(text)
    (chosen.out / 'ablation.md').write_text(text)
    (chosen.out / 'ablation.json').write_text(json.dumps(everything, indent=1))


if __name__ == '__main__':
    main()
