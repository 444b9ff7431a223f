#!/usr/bin/python3
"""Method paper keeps the scale trend better than its baseline kwatra, on every texture. TAP.

test_scale_trend.py RECEDE

All rendered cases of the evaluation data with a slant of 40 degrees or more. What is compared is
the score's `scale` term: octaves by which the fill's detail is too large or too small, 0 as in the
truth.

The rule, for each texture, on the medians over its fills: the paper's error is less than .7 of
kwatra's. Or, only where kwatra itself is as good as the oracle (the same plane at another offset),
so that nothing better can be shown: the paper is as good as the oracle too.

Medians, because both methods average and another seed gives another fill. Above all for planks: a
fill without the end of a plank in it has no detail along the planks at all, and then the term is
1.6 octaves (the paper's on p_planks for one seed in five, kwatra's for all). Of three fills they
were still chance: kwatra's of p_flowers .25, where sixteen have .91, and the paper's .21 and .10.
"""
import os
import sys
import tempfile
from collections import defaultdict
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import cv2
import numpy as np

sys.path[:0] = [str(Path(__file__).resolve().parents[1] / 'lib')]
from evaluation import Judge, data_folder, load_cases, steep_names  # noqa: E402
from methods import ORACLE, Failed, result  # noqa: E402
from tap import Tap  # noqa: E402

STEEP_DEG = 40
FILLS = 5              # of a texture by each method: its cases in turn, then another seed
CLEARLY = .7           # of kwatra's error
# As good as the oracle: the term is measured in steps of .05 octaves along and across.
SAME = np.hypot(.05, .05) + 1e-6
METHODS = ('paper', 'kwatra')


def fills_of(cases):
    """[(case, seed)], FILLS for each texture."""
    textures = defaultdict(list)
    for case in cases:
        textures[case.texture].append(case)
    return [(found[i % len(found)], i // len(found))
            for found in textures.values() for i in range(max(FILLS, len(found)))]


def errors_of(case, seed, binary, folder):
    """{method: the scale term, or why there is none}"""
    judge = Judge(case)
    found = {}
    for method in (*METHODS, ORACLE):
        try:
            path, _ = result(method, case, binary, [f'--seed={seed}'], folder)
            found[method] = judge.scale_error(cv2.imread(str(path)))
        except Failed as failure:
            found[method] = str(failure)
    return found


def compare(tap, texture, errors):
    """errors: of its fills, each {method: octaves}."""
    failures = [value for found in errors for value in found.values() if isinstance(value, str)]
    if failures:
        tap.check(False, f'{texture}: a method gives no result', failures[0])
        return
    medians = {method: float(np.median([found[method] for found in errors]))
               for method in (*METHODS, ORACLE)}
    said = ' '.join(f'{method} {middle:.2f} (' +
                    ' '.join(f'{found[method]:.2f}' for found in errors) + ')'
                    for method, middle in medians.items())
    good = medians[ORACLE] + SAME
    if medians['kwatra'] <= good:
        tap.check(medians['paper'] <= good,
                  f'{texture}: kwatra is as good as the oracle, and so is the paper', said)
    else:
        tap.check(medians['paper'] < CLEARLY * medians['kwatra'],
                  f'{texture}: the paper keeps the scale better than kwatra', said)


def seeded(folder, seed):
    """A folder for each seed: results are named by case and method."""
    path = Path(folder) / str(seed)
    path.mkdir(exist_ok=True)
    return path


def compare_all(tap, binary, folder):
    fills = fills_of(load_cases(steep_names(STEEP_DEG)))
    errors = defaultdict(list)
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        pending = [(case.texture, pool.submit(errors_of, case, seed, binary, seeded(folder, seed)))
                   for case, seed in fills]
        for texture, found in pending:
            errors[texture].append(found.result())
    for texture, found in sorted(errors.items()):
        compare(tap, texture, found)
    singles = [found['paper'] < CLEARLY * found['kwatra']
               for of_texture in errors.values() for found in of_texture]
    print(f'# {len(errors)} textures; in {sum(singles)} of {len(singles)} single pairs of fills '
          'the paper is clearly better')
    tap.check(len(errors) == 11, 'every steep texture is compared', ' '.join(sorted(errors)))


def main():
    tap = Tap()
    if data_folder() is None:
        tap.skip('cases of the evaluation data', 'the data is not beside the checkout')
    else:
        with tempfile.TemporaryDirectory() as folder:
            compare_all(tap, Path(sys.argv[1]), folder)
    return tap.finish()


if __name__ == '__main__':
    sys.exit(main())
