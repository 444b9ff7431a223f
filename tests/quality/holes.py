"""More holes in the evaluation data's photos than its own one each, four in every photo that shows
a plane: an ellipse, a rectangle, a blob and an ellipse turned, wherever chance puts them in the
plane's part of the photo. The photo is the truth.
"""
import json

import cv2
import numpy as np

from evaluation import drawn_cases, photo_case

# The horizon's height at the left and right edge, None: a plane seen from the front, and the
# polygon that holds the plane; fractions of the photo's width and height. Those of the first five
# are make_photo_cases.py's, which cannot be imported without running.
PHOTOS = {
    'pebble_beach': (-.05, [(0, .04), (1, .04), (1, 1), (0, 1)]),
    'pier_sunset': (.44, [(.47, .53), (.54, .53), (.80, 1), (.17, 1)]),
    'motorway': (.575, [(.47, .62), (.53, .62), (.87, 1), (0, 1), (0, .85)]),
    'dunes': (.60, [(0, .82), (1, .82), (1, 1), (0, 1)]),
    'roofs': (None, [(.32, .62), (.53, .63), (.74, .87), (.66, 1), (.22, 1), (.27, .85)]),
    'tea_field': (.40, [(0, .56), (1, .56), (1, 1), (0, 1)]),
    'dune_ridge': (.45, [(0, .66), (.34, .55), (.62, .72), (.76, .86), (.88, .98), (.50, .98),
                         (.44, .76), (.27, .76), (0, .80)]),
}
KINDS = 'ellipse', 'rectangle', 'blob', 'turned'
LONGEST_PX = 1000     # of a photo's width, beyond which it is reduced
AREA = .012, .03      # of the photo
ASPECT = .5, 2        # of a hole, width to height
LEAST_INSIDE = .97    # of a hole's pixels lie in the polygon,
RING_PX = 12
LEAST_AROUND = .75    # and of those of a ring around it


def hole_of(kind, shape, random):
    """A mask with one hole somewhere; it may leave the picture."""
    height, width = shape
    area, aspect = random.uniform(*AREA), np.exp(random.uniform(*np.log(ASPECT)))
    half_y = np.sqrt(area * width * height / (np.pi * aspect))
    half_x = half_y * aspect
    x, y = random.uniform(0, width), random.uniform(0, height)
    turn = random.uniform(20, 70) if kind == 'turned' else 0
    mask = np.zeros(shape, np.uint8)
    if kind == 'rectangle':
        corners = [(round(x + i * half_x), round(y + j * half_y)) for i, j in ((-1, -1), (1, 1))]
        cv2.rectangle(mask, *corners, 255, -1)
    elif kind == 'blob':
        angles = np.linspace(0, 2 * np.pi, 60, endpoint=False)
        radius = 1 + sum(random.uniform(0, .15) * np.sin(k * angles + random.uniform(0, 6.28))
                         for k in (2, 3, 5))
        outline = np.stack([x + half_x * radius * np.cos(angles),
                            y + half_y * radius * np.sin(angles)], 1)
        cv2.fillPoly(mask, [np.round(outline).astype(np.int32)], 255)
    else:
        cv2.ellipse(mask, (round(x), round(y)), (round(half_x), round(half_y)), turn, 0, 360, 255,
                    -1)
    return mask


def fits(mask, plane):
    hole = mask > 0
    around = (cv2.dilate(mask, np.ones((2 * RING_PX + 1,) * 2)) > 0) & ~hole
    edge = np.concatenate([hole[0], hole[-1], hole[:, 0], hole[:, -1]])
    return (hole.any() and not edge.any() and plane[hole].mean() >= LEAST_INSIDE
            and plane[around].mean() >= LEAST_AROUND)


def draw(root, index, folder):
    """One hole into the folder, as make_photo_cases.py writes its cases."""
    cv2.setNumThreads(1)
    name, kind = list(PHOTOS)[index // len(KINDS)], KINDS[index % len(KINDS)]
    level, polygon = PHOTOS[name]
    truth = cv2.imread(str(root / 'photo' / f'{name}.jpg'))
    scale = min(1, LONGEST_PX / truth.shape[1])
    truth = cv2.resize(truth, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    height, width = truth.shape[:2]
    valid = np.zeros((height, width), np.uint8)
    cv2.fillPoly(valid, [np.array([(x * width, y * height) for x, y in polygon], np.int32)], 255)
    random = np.random.default_rng(9000 + index)
    mask = hole_of(kind, (height, width), random)
    while not fits(mask, valid > 0):
        mask = hole_of(kind, (height, width), random)
    folder /= f'{name}_{kind}'
    folder.mkdir()
    pictures = {'truth': truth, 'mask': mask, 'valid': valid | mask,
                'input': np.where(mask[..., None] > 0, 0, truth)}
    for stem, picture in pictures.items():
        cv2.imwrite(str(folder / f'{stem}.png'), picture)
    line = [0, 0, 1] if level is None else [0, 1, -level * height]
    (folder / 'geo.json').write_text(json.dumps({'horizon': line,
                                                 'horizon_y_left_right': [level, level]}))


def load_holes(wanted=()):
    """Every such hole, or those whose name begins with one of the wanted words."""
    return [photo_case(folder)
            for folder in drawn_cases(__file__, draw, len(PHOTOS) * len(KINDS), wanted)]
