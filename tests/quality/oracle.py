"""What a perfect fill looks like: the same plane, of the hole's own scale, at another offset.

Rendered cases bring theirs. A photo's is the nearest that it has: its truth, moved along the
horizon so that nothing but known pixels of the plane come into the hole, by the way that fits best
around it, and healed: its brightness is led over to that of the border. It is real in everything
but its border, where tiles and cracks do not go on; holes as wide as the plane have none.
"""
import os
from pathlib import Path

import cv2
import numpy as np

from evaluation import CACHE, digest

RING_PX = 3  # around the hole, where the fit is measured


def oracle(case):
    """Path of the picture; None where there is none."""
    if not case.is_photo:
        return case.folder / 'oracle.png'
    key = digest(case.folder / 'truth.png', case.folder / 'mask.png', case.folder / 'valid.png',
                 case.line, Path(__file__))
    path = CACHE / 'oracles' / f'{key}.png'
    if not path.exists():
        picture = moved_truth(case)
        if picture is None:
            return None
        path.parent.mkdir(parents=True, exist_ok=True)
        temporary = path.with_suffix(f'.{os.getpid()}.png')
        cv2.imwrite(str(temporary), picture)
        temporary.replace(path)
    return path


def moved_truth(case):
    truth, mask = case.image('truth'), np.where(case.mask > 0, 255, 0).astype(np.uint8)
    plane = case.image('valid', cv2.IMREAD_GRAYSCALE) > 127
    wide = cv2.dilate(mask, np.ones((2 * RING_PX + 1,) * 2)) > 0
    ring = wide & (mask == 0) & plane
    ways = list(ways_to_known(case, plane & (mask == 0), np.nonzero(wide)))
    if not ways:
        return None

    def misfit(way):
        return cv2.absdiff(moved(truth, way), truth)[ring].astype(float).mean()
    best = moved(truth, min(ways, key=misfit))
    x, y, width, height = cv2.boundingRect(mask)
    centre = x + (width - 1) // 2, y + (height - 1) // 2  # so seamlessClone moves nothing
    healed = cv2.seamlessClone(best, truth, mask, centre, cv2.NORMAL_CLONE)
    return np.where(mask[..., None] > 0, healed, case.image('input'))


def moved(picture, way):
    return np.roll(picture, (-way[1], -way[0]), (0, 1))


def ways_to_known(case, known, hole):
    """(dx, dy) along the horizon that lead every pixel of the hole to a known one."""
    height, width = known.shape
    rows, columns = hole
    a, b, _ = case.line
    along = np.array([b, -a]) / np.hypot(a, b) if a or b else np.array([1, 0])
    for length in range(1, width):
        for dx, dy in np.rint([length * along, -length * along]).astype(int):
            x, y = columns + dx, rows + dy
            if (min(x.min(), y.min()) >= 0 and x.max() < width and y.max() < height
                    and known[y, x].all()):
                yield dx, dy
