#!/usr/bin/python3
"""Side by side in the manner of the paper's Figures 8 to 10: the exemplar, its scale map, our
result (repaired, and as printed), and the baseline's, for desert, flowers, sea and pebbles.

Writes out/figures/NAME.png and prints the names. The pictures are made by the command itself.
"""
import argparse
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np

from exemplars import EXEMPLARS, exemplar

PROJECT = Path(__file__).resolve().parents[2]
GAP = 8
PANELS = [('repaired', ['--method=paper']), ('as printed', ['--method=paper', '--paper-literal']),
          ('baseline', ['--method=kwatra'])]


def run(*words):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f'{" ".join(str(word) for word in words)}: {done.stderr}')


def panel(picture, title, size):
    """The picture in a white square with its title below."""
    square = np.full((size + 24, size, 3), 255, np.uint8)
    square[:picture.shape[0], :picture.shape[1]] = picture
    cv2.putText(square, title, (2, size + 17), cv2.FONT_HERSHEY_SIMPLEX, .45, (0, 0, 0), 1,
                cv2.LINE_AA)
    return square


def figure(name, binary, size, folder):
    picture, slant, tilt = exemplar(name)
    source, out = folder / f'{name}_exemplar.png', folder / f'{name}_panel.png'
    angles = [f'--slant={slant}', f'--tilt={tilt}']
    cv2.imwrite(str(source), picture)
    panels = [panel(picture, f'example, {slant} and {tilt} deg', size)]
    run(binary, 'scale-map', source, '-o', out, '--force', '--method=paper', *angles)
    panels.append(panel(cv2.imread(str(out)), 'scale map', size))
    for title, options in PANELS:
        run(binary, 'synthesize', source, '-o', out, '--force', f'--size={size}x{size}', *angles,
            *options)
        panels.append(panel(cv2.imread(str(out)), title, size))
    out.unlink()
    gap = np.full((size + 24, GAP, 3), 255, np.uint8)
    row = np.hstack([part for one in panels for part in (one, gap)])
    path = folder / f'{name}.png'
    cv2.imwrite(str(path), row)
    return path


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--binary', default=PROJECT / 'build' / 'cli' / 'recede')
    parser.add_argument('--size', type=int, default=256)
    parser.add_argument('--out', type=Path, default=PROJECT / 'out' / 'figures')
    chosen = parser.parse_args()
    if exemplar('desert') is None:
        sys.exit('figures needs the evaluation data beside the checkout (../shared/evaluate) or in '
                 'RECEDE_EVALUATE')
    chosen.out.mkdir(parents=True, exist_ok=True)
    for name in EXEMPLARS:
        print(figure(name, chosen.binary, chosen.size, chosen.out))


if __name__ == '__main__':
    main()
