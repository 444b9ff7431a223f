#!/usr/bin/python3
"""Fills of known truth must be good, not only done. TAP.

test_quality.py RECEDE

On planes drawn from the free textures of tests/data and on a photo always; on some cases of the
evaluation data, by its own yardstick, where it lies beside the checkout.
"""
import os
import sys
import tempfile
from pathlib import Path

import cv2
import numpy as np

sys.path[:0] = [str(Path(__file__).resolve().parents[1] / 'lib')]
from evaluation import data_folder, load_cases  # noqa: E402
from methods import run  # noqa: E402
from plane_picture import View, draw, hole  # noqa: E402
from score import score_all  # noqa: E402
from tap import Tap  # noqa: E402

DRAWN = ('brick_regular', 'sk_gravel')
VIEW = View(400, 300, 55, 0)
HOLE = (110, 90)     # px
BANDS = 5            # of detail, an octave each
SLICES = 3           # of the hole, from near to far
# Steep ones: bricks, roof tiles, gravel. Few, because a test may not take minutes; all of them are
# scored by `./dev bench quality`.
CASES = ['013', '024', '029']


# A photo of a dark pier, brighter water beside it, and nobody says which of them is the plane.
PIER = Path(__file__).resolve().parents[2] / 'docs' / 'images' / 'pier.jpg'
PIER_HORIZON = '--horizon=0,362,1200,362'
PIER_HOLE = np.s_[452:656, 495:663]
# And stones of the evaluation data, two of which have straight edges that point at each other: x at
# the hole's top and bottom.
STONES_WIDTH = 1000
STONES_HOLE = np.s_[524:638, 96:272]
STONES_HORIZON = '--horizon=0,-33,1000,-33'
STONES_EDGE = 260, 232


def detail_octave(picture, region):
    """The mean octave of the detail in the region: 0 finest. A texel twice as wide gives one more.
    """
    gray = cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY).astype(np.float32)
    blurred = [gray] + [cv2.GaussianBlur(gray, (0, 0), .8 * 2 ** k) for k in range(BANDS)]
    energy = [((fine - coarse)[region] ** 2).mean() for fine, coarse in zip(blurred, blurred[1:])]
    return float(np.dot(range(BANDS), energy) / sum(energy))


def scale_error(result, truth, mask):
    """Octaves by which the result's detail is too coarse or too fine; mean over slices of depth."""
    rows = np.nonzero(mask)[0]
    edges = np.linspace(rows.min(), rows.max() + 1, SLICES + 1)
    y = np.arange(mask.shape[0])[:, None]
    errors = []
    for low, high in zip(edges, edges[1:]):
        region = (mask > 0) & (y >= low) & (y < high)
        errors.append(abs(detail_octave(result, region) - detail_octave(truth, region)))
    return float(np.mean(errors))


def likeness(result, truth, mask):
    """Correlation of the result with the truth inside the hole; only for regular textures."""
    inside = mask > 0
    values = [cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY)[inside].astype(float)
              for picture in (result, truth)]
    return float(np.corrcoef(*values)[0, 1])


def fill(binary, folder, truth, mask, *options):
    image, hole_file, out = (folder / name for name in ('image.png', 'mask.png', 'out.png'))
    cv2.imwrite(str(image), np.where(mask[..., None] > 0, 0, truth).astype(np.uint8))
    cv2.imwrite(str(hole_file), mask)
    run([binary, 'fill', image, '--mask', hole_file, '-o', out, '--force', *options])
    return cv2.imread(str(out))


def drawn_planes(tap, binary, folder):
    mask = hole((VIEW.height, VIEW.width), (VIEW.width / 2, VIEW.height / 2), HOLE)
    errors = {}
    for name in DRAWN:
        truth = draw(name, VIEW)
        for method in ('plane', 'paper', 'kwatra'):
            result = fill(binary, folder, truth, mask, *VIEW.options(), f'--method={method}')
            errors[name, method] = scale_error(result, truth, mask)
            if (name, method) == ('brick_regular', 'plane'):
                like = likeness(result, truth, mask)
                tap.check(like > .6, 'bricks go on across the hole', f'correlation {like:.2f}')
        ours = errors[name, 'plane']
        tap.check(ours < .25, f'{name}: detail of the right size at every depth',
                  f'{ours:.2f} octaves of error')
    paper, kwatra = (np.mean([errors[name, method] for name in DRAWN])
                     for method in ('paper', 'kwatra'))
    tap.check(paper < .7 * kwatra,
              'drawn planes: the paper keeps the scale better than its baseline',
              f'octaves of error: paper {paper:.2f}, kwatra {kwatra:.2f}')


def photo_without_source_mask(tap, binary, folder):
    truth = cv2.imread(str(PIER))
    mask = np.zeros(truth.shape[:2], np.uint8)
    mask[PIER_HOLE] = 255
    result = fill(binary, folder, truth, mask, PIER_HORIZON)
    known, filled = (cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY)[PIER_HOLE]
                     for picture in (truth, result))
    bright = np.mean(filled > np.percentile(known, 99))
    tap.check(bright < .06, 'a hole in a pier is filled with boards, not with the water beside it',
              f'{bright:.3f} of it is brighter than 99 of 100 pixels of the boards')


def part_with_edge(gray, ends):
    """Of the rows the part where brightness steps in one sense at a straight line."""
    rows = np.arange(len(gray))
    x = np.round(np.linspace(*ends, len(gray))).astype(int)
    steps = gray[rows, x + 3] - gray[rows, x - 3]
    return max(np.mean(steps > 4), np.mean(steps < -4))


def hole_among_stones(tap, binary, folder):
    photo = cv2.imread(str(data_folder() / 'photo' / 'pebble_beach.jpg'))
    scale = STONES_WIDTH / photo.shape[1]
    truth = cv2.resize(photo, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    mask = np.zeros(truth.shape[:2], np.uint8)
    mask[STONES_HOLE] = 255
    result = fill(binary, folder, truth, mask, STONES_HORIZON)
    gray = cv2.blur(cv2.cvtColor(result, cv2.COLOR_BGR2GRAY), (3, 3)).astype(int)[STONES_HOLE[0]]
    part = max(part_with_edge(gray, [end + off for end, off in zip(STONES_EDGE, (top, bottom))])
               for top in range(-8, 9, 2) for bottom in range(-8, 9, 2))
    tap.check(part < .9, 'the straight edge of a stone does not go on through a hole',
              f'in {part:.2f} of its rows there is one')


def evaluation_cases(tap, binary, folder):
    scores = score_all(load_cases(CASES), ['plane'], binary, ['--seed=1'], folder,
                       jobs=os.cpu_count())
    for name, found in scores.items():
        plane = found['plane']
        tap.check(plane['score'] >= 80, f'{name}: the plane engine scores at least 80',
                  f'{plane["score"]} {plane.get("error") or plane["terms"]}')
        tap.check(plane.get('changed_outside') == 0, f'{name}: nothing changes outside the hole')


def main():
    binary = Path(sys.argv[1])
    tap = Tap()
    with tempfile.TemporaryDirectory() as folder:
        drawn_planes(tap, binary, Path(folder))
        photo_without_source_mask(tap, binary, Path(folder))
        if data_folder() is None:
            tap.skip('stones and cases of the evaluation data',
                     'the data is not beside the checkout')
        else:
            hole_among_stones(tap, binary, Path(folder))
            evaluation_cases(tap, binary, Path(folder))
    return tap.finish()


if __name__ == '__main__':
    sys.exit(main())
