#!/usr/bin/python3
"""The paper's Table 1 again: 128 and 256 px square from 105 px exemplars, several textures and
runs, the paper's method (repaired and as printed) beside its baseline.

CPU seconds of one thread. Energy: the report's (eq. 8 with each method's own neighbourhoods, not
comparable between methods), and `nearest`: the mean distance of the result's 8 x 8 neighbourhoods
to their true nearest in the exemplar, in levels of 255 per value, the same for all.
"""
import argparse
import json
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from exemplars import EDGE, EXEMPLARS, exemplar

PROJECT = Path(__file__).resolve().parents[2]
METHODS = {
    'repaired': ['method=paper'],
    'literal': ['method=paper', 'paper-literal=1'],
    'kwatra': ['method=kwatra'],
}
PAPER_MINUTES = {128: ((.96, .42), (2, 1)), 256: ((6.55, .75), (8.5, 1.5))}
SAMPLED = 600  # neighbourhoods of a result that `nearest` looks at


def synthesize(binary, picture, size, settings, seed):
    with tempfile.NamedTemporaryFile() as out:
        done = subprocess.run([binary, str(EDGE), str(EDGE), str(size), out.name, f'seed={seed}',
                               *settings], input=picture.tobytes(), capture_output=True)
        if done.returncode:
            sys.exit(done.stderr.decode())
        pixels = np.frombuffer(Path(out.name).read_bytes(), np.uint8)
    return {**json.loads(done.stdout), 'pixels': pixels.reshape(size, size, 3)}


def neighbourhoods(picture):
    view = np.lib.stride_tricks.sliding_window_view(picture.astype(np.float32), (8, 8), (0, 1))
    return view.reshape(-1, 8 * 8 * 3)


def nearest(result, picture):
    source, made = neighbourhoods(picture), neighbourhoods(result)
    made = made[np.random.default_rng(0).choice(len(made), SAMPLED, replace=False)]
    square = (made ** 2).sum(1)[:, None] + (source ** 2).sum(1) - 2 * made @ source.T
    return float(np.sqrt(np.maximum(square.min(1), 0) / source.shape[1]).mean())


def spread(values):
    return statistics.mean(values), statistics.stdev(values) if len(values) > 1 else 0.


def measure(binary, textures, sizes, runs):
    """{(size, method): [{texture, cpu_seconds, energy, nearest}]}; methods take turns."""
    found = {(size, method): [] for size in sizes for method in METHODS}
    for size in sizes:
        for texture in textures:
            picture, slant, tilt = exemplar(texture)
            for seed in range(runs):
                for method, settings in METHODS.items():
                    run = synthesize(binary, picture, size,
                                     [*settings, f'slant={slant}', f'tilt={tilt}'], seed)
                    run['nearest'] = nearest(run.pop('pixels'), picture)
                    found[size, method].append({'texture': texture, **run})
    return found


def show(found, sizes):
    print('| size | method | CPU s | spread | energy (own) | nearest | kwatra / method | paper min '
          '| paper ratio |')
    print('|---|---|---:|---:|---:|---:|---:|---:|---:|')
    for size in sizes:
        base = spread([run['cpu_seconds'] for run in found[size, 'kwatra']])[0]
        ours, theirs = PAPER_MINUTES.get(size, ((0, 0), (0, 0)))
        for method in METHODS:
            runs = found[size, method]
            mean, deviation = spread([run['cpu_seconds'] for run in runs])
            minutes = theirs if method == 'kwatra' else ours
            print(f'| {size} | {method} | {mean:.3f} | {deviation:.3f} '
                  f'| {spread([run["energy"] for run in runs])[0]:.0f} '
                  f'| {spread([run["nearest"] for run in runs])[0]:.2f} | {base / mean:.2f} '
                  f'| {minutes[0]} ± {minutes[1]} '
                  f'| {theirs[0] / minutes[0] if minutes[0] else 0:.2f} |')


def show_textures(found, sizes):
    print('\n| size | texture | ' + ' | '.join(f'{m} s, nearest' for m in METHODS) + ' |')
    print('|---|---|' + '---:|' * len(METHODS))
    for size in sizes:
        for texture in EXEMPLARS:
            cells = []
            for method in METHODS:
                runs = [run for run in found[size, method] if run['texture'] == texture]
                cells.append('{:.3f}, {:.2f}'.format(*(spread([run[key] for run in runs])[0]
                                                      for key in ('cpu_seconds', 'nearest'))))
            print(f'| {size} | {texture} | ' + ' | '.join(cells) + ' |')


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--binary', default=PROJECT / 'build' / 'tests' / 'bench' / 'synthesize')
    parser.add_argument('--runs', type=int, default=5, help='of each texture')
    parser.add_argument('--sizes', type=int, nargs='+', default=[128, 256])
    chosen = parser.parse_args()
    if exemplar('desert') is None:
        sys.exit('table1 needs the evaluation data beside the checkout (../shared/evaluate) or in '
                 'RECEDE_EVALUATE')
    found = measure(chosen.binary, EXEMPLARS, chosen.sizes, chosen.runs)
    show(found, chosen.sizes)
    show_textures(found, chosen.sizes)


if __name__ == '__main__':
    main()
