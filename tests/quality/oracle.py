"""What stands for a perfect fill: the same plane, of the hole's own scale, at another offset.

Rendered cases bring it. A photo has one piece of itself at the most: its truth, moved along the
horizon so that nothing but known pixels of the plane come into the hole, by the way that fits best
around it, and healed: its brightness is led over to that of the border. It is real inside, but at
its border stones are cut, tiles and cracks do not go on, and shadows bleed: look at it before
drawing on its score. Holes as wide as the plane have none.
"""
import cv2
import numpy as np

RING_PX = 3  # around the hole, where the fit is measured


def moved_truth(case):
    """A photo's oracle; None where there is none."""
    truth, mask = case.image('truth'), np.where(case.mask > 0, 255, 0).astype(np.uint8)
    plane = case.image('valid', cv2.IMREAD_GRAYSCALE) > 127
    wide = cv2.dilate(mask, np.ones((2 * RING_PX + 1,) * 2)) > 0
    ways = list(ways_to_known(case, plane & (mask == 0), np.nonzero(wide)))
    if not ways:
        return None
    rows, columns = np.nonzero(wide & (mask == 0) & plane)

    def misfit(way):
        return cv2.absdiff(truth[rows + way[1], columns + way[0]], truth[rows, columns]).mean()
    dx, dy = min(ways, key=misfit)
    x, y, width, height = cv2.boundingRect(mask)
    centre = x + width // 2, y + height // 2  # so seamlessClone moves nothing
    healed = cv2.seamlessClone(np.roll(truth, (-dy, -dx), (0, 1)), truth, mask, centre,
                               cv2.NORMAL_CLONE)
    return np.where(mask[..., None] > 0, healed, case.image('input'))


def ways_to_known(case, known, places):
    """(dx, dy) along the horizon that lead every place (rows, columns) to a known one."""
    height, width = known.shape
    rows, columns = places
    a, b, _ = case.line
    along = np.array([b, -a]) / np.hypot(a, b) if a or b else np.array([1, 0])
    for length in range(1, width):
        for dx, dy in np.rint([length * along, -length * along]).astype(int):
            x, y = columns + dx, rows + dy
            if (min(x.min(), y.min()) >= 0 and x.max() < width and y.max() < height
                    and known[y, x].all()):
                yield dx, dy
