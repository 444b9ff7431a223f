#!/usr/bin/python3
"""What fills are measured by: a photo's oracle, and the sentence on rivals. TAP."""
import sys
import tempfile
from pathlib import Path

import cv2
import numpy as np

sys.path[:0] = [str(Path(__file__).resolve().parents[1] / 'lib')]
from evaluation import Case  # noqa: E402
from oracle import moved_truth  # noqa: E402
from report import rivalry  # noqa: E402
from tap import Tap  # noqa: E402

HEIGHT, WIDTH = 160, 400
PERIOD = 90  # px, along the horizon
HOLE = np.s_[60:110, 170:230]
RED = (0, 0, 255)


def repeating_photo(folder, hole, plane):
    """A case of noise that repeats along a level horizon, red where its plane is not."""
    random = np.random.default_rng(1)
    tile = cv2.GaussianBlur(random.integers(0, 256, (HEIGHT, PERIOD, 3)).astype(np.float32), (0, 0),
                            1.5)
    truth = np.tile(np.clip(128 + 2 * (tile - 128), 0, 255).astype(np.uint8),
                    (1, WIDTH // PERIOD + 1, 1))[:, :WIDTH]
    truth[~plane] = RED
    mask = np.zeros((HEIGHT, WIDTH), np.uint8)
    mask[hole] = 255
    for name, picture in (('truth', truth), ('mask', mask), ('valid', plane * np.uint8(255)),
                          ('input', np.where(mask[..., None] > 0, 0, truth).astype(np.uint8))):
        cv2.imwrite(str(folder / f'{name}.png'), picture)
    return Case('repeating', folder, None, np.array([0, 1, 100.0]))


def oracle_of_photos(tap, folder):
    plane = np.ones((HEIGHT, WIDTH), bool)
    case = repeating_photo(folder, HOLE, plane)
    found, truth = moved_truth(case).astype(float), case.image('truth').astype(float)
    outside = case.mask == 0
    tap.check((found[outside] == case.image('input')[outside]).all(),
              'an oracle changes nothing outside the hole')
    missed = np.abs(found - truth)[HOLE].mean()
    tap.check(missed < 2, 'where the photo repeats, its oracle is the truth',
              f'{missed:.2f} of 255')

    # Red only inside the piece a period to the right: its ring fits as well as the left one's.
    plane[65:105, 265:315] = False
    found = moved_truth(repeating_photo(folder, HOLE, plane)).astype(float)
    missed = np.abs(found - truth)[HOLE].mean()
    tap.check(missed < 2, 'an oracle comes from the plane alone', f'{missed:.2f} of 255')

    plane[:, :130] = plane[:, 245:] = False
    tap.check(moved_truth(repeating_photo(folder, HOLE, plane)) is None,
              'a hole nearly as wide as the plane has no oracle')


def sentence_on_rivals(tap):
    scores, cases = {}, []
    for name, ours, theirs in (('a', 90, 80), ('b', 100, 100), ('c', 70, 100)):
        cases.append(Case(name, Path(), None, np.zeros(3)))
        scores[name] = {'plane': {'score': ours}, 'shiftmap': {'score': theirs},
                        'gmic-patch': {'score': 20}}
    said = rivalry('photos', cases, scores, 'plane')
    tap.check(said == 'plane, photos: alone the best in 1 of 3, shares the best score in 1, '
              'loses 1 (c 70:100); a rival has full marks in 2, so that 1 can be won alone\n',
              'wins, ties, losses and what can be won are told', said.strip())
    tap.check(rivalry('photos', cases, scores, 'oracle') == '', 'nothing measured, nothing told')


def main():
    tap = Tap()
    with tempfile.TemporaryDirectory() as folder:
        oracle_of_photos(tap, Path(folder))
    sentence_on_rivals(tap)
    return tap.finish()


if __name__ == '__main__':
    sys.exit(main())
