"""Exemplars of the paper's kind from the evaluation data: desert, flowers, sea, pebbles, each with
the orientation it was seen at."""
import math
import sys
from pathlib import Path

import cv2
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / 'quality'))
from evaluation import data_folder, working_folder  # noqa: E402

EDGE = 105  # px, the paper's
# Photo or texture, box of a photo as parts of it (x0, y0, x1, y1) or None for a flat texture to be
# seen in perspective, slant, tilt, texels of a flat texture per px at the centre.
EXEMPLARS = {
    'desert': ('photo/dunes.jpg', (.2, .88, .4, 1.), 30, 18, None),
    'flowers': ('p_flowers', None, 60, 20, 5.),
    'sea': ('p_waves', None, 50, 0, 4.),
    'pebbles': ('photo/pebble_beach.jpg', (.2, .1, .8, 1.), 60, 0, None),
}


def seen_in_perspective(texture, edge, slant, tilt, texels_per_px, fov=50):
    """The texture's plane through a pinhole: px (p across, q along the tilt) of texel (m, l) are
    f m / (z + l sin), f l cos / (z + l sin)."""
    s, t = math.radians(slant), math.radians(tilt)
    focal = edge / 2 / math.tan(math.radians(fov / 2))
    z = focal * texels_per_px
    centre = (edge - 1) / 2
    project = np.array([[focal, 0, 0], [0, focal * math.cos(s), 0], [0, math.sin(s), z]])
    turn = np.array([[math.cos(t), math.sin(t), 0], [math.sin(t), -math.cos(t), 0], [0, 0, 1]])
    move = np.array([[1, 0, centre], [0, 1, centre], [0, 0, 1.]])
    middle = np.array([[1, 0, -texture.shape[1] / 2], [0, 1, -texture.shape[0] / 2], [0, 0, 1.]])
    more = 8  # averaged away, against aliasing
    enlarge = np.array([[more, 0, (more - 1) / 2], [0, more, (more - 1) / 2], [0, 0, 1.]])
    big = cv2.warpPerspective(texture, enlarge @ move @ turn @ project @ middle,
                              (edge * more, edge * more), flags=cv2.INTER_AREA,
                              borderMode=cv2.BORDER_WRAP)
    return cv2.resize(big, (edge, edge), interpolation=cv2.INTER_AREA)


def texture(name):
    """A flat texture; those that the evaluation data draws are drawn at their first use."""
    folder = str(working_folder())
    if folder not in sys.path:
        sys.path.insert(0, folder)
    import make_cases
    return make_cases.load_tex(name)


def exemplar(name, edge=EDGE):
    """(picture, slant, tilt) or None without the evaluation data."""
    if data_folder() is None:
        return None
    file, box, slant, tilt, texels = EXEMPLARS[name]
    if box is None:
        return seen_in_perspective(texture(file), edge, slant, tilt, texels), slant, tilt
    picture = cv2.imread(str(data_folder() / file))
    height, width = picture.shape[:2]
    x0, x1 = int(box[0] * width), int(box[2] * width)
    y0, y1 = int(box[1] * height), int(box[3] * height)
    side = min(x1 - x0, y1 - y0)
    picture = picture[y1 - side:y1, x0:x0 + side]
    return cv2.resize(picture, (edge, edge), interpolation=cv2.INTER_AREA), slant, tilt
