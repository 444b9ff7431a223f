"""Streets: a floor between two walls or in front of one, with holes in either. Drawn with the
evaluation data's textures; its own cases have one plane each.
"""
import json
import sys

import cv2
import numpy as np

from evaluation import Case, drawn_cases

WIDTH, HEIGHT = 1000, 700
SAMPLES = 2                # each way, of one pixel
EYE_M, FAR_M = 1.6, 60     # height of the camera; what is farther is sky
FLOOR_SCALE, WALL_SCALE = 200, 125  # texels a metre
SKY = 180, 205, 225
LEAST_FACING = .12         # cosine to the plane's normal: holes are not where it is seen edge-on
CLEARANCE = 12             # px between a hole and another plane
# textures of floor and walls, metres to the left and right wall (0: none), metres to the one in
# front, their height; field of view, pitch, yaw and roll of the camera, degrees.
STREETS = [
    ('sk_gravel', 'brick_regular', 4, 4, 0, 7, 60, 8, 0, 0),
    ('p_cobble', 'p_brick', 3, 5, 0, 6, 60, 6, 8, 1),
    ('gravel_colour', 'planks', 0, 3, 0, 5, 50, 4, 10, -2),
    ('cobble_red', 'p_tiles', 3, 0, 0, 6, 50, 7, -12, 2),
    ('p_tiles', 'cobble_red', 3, 4, 0, 8, 75, 12, 5, 0),
    ('p_grass', 'brick_regular', 0, 4, 0, 6, 40, 5, 12, 0),
    ('sk_gravel', 'roof_tiles', 4, 0, 9, 6, 60, 10, -25, 1),
    ('p_cobble', 'gravel_colour', 5, 5, 0, 7, 75, 9, -6, 0),
    ('brick_regular', 'planks', 0, 0, 8, 5, 50, 9, 6, 2),
    ('carpet', 'p_brick', 0, 0, 7, 6, 60, 14, -12, -1),
    ('p_planks', 'p_cobble', 4, 3, 0, 6, 50, 6, 0, -1),
    ('gravel_colour', 'brick_regular', 5, 0, 10, 8, 60, 11, -30, 0),
]
HOLES = 'floor', 'wall', 'wall'  # of each street


def camera_axes(pitch, yaw, roll):
    """Columns: the camera's x, y and z in the street's x (right), y (down) and z (along)."""
    p, q, r = np.radians([pitch, yaw, roll])
    around_x = np.array([[1, 0, 0], [0, np.cos(p), np.sin(p)], [0, -np.sin(p), np.cos(p)]])
    around_y = np.array([[np.cos(q), 0, np.sin(q)], [0, 1, 0], [-np.sin(q), 0, np.cos(q)]])
    around_z = np.array([[np.cos(r), -np.sin(r), 0], [np.sin(r), np.cos(r), 0], [0, 0, 1]])
    return around_y @ around_x @ around_z


def texels(texture, across, along, scale):
    height, width = texture.shape[:2]
    return texture[np.floor(along * scale).astype(int) % height,
                   np.floor(across * scale).astype(int) % width]


def look(street, floor, wall):
    """The picture, each pixel's plane (0: sky) and its cosine to the normal; the planes' axes."""
    _, _, left, right, front, high, fov, *angles = street
    focal = .5 * WIDTH / np.tan(np.radians(fov / 2))
    step = (np.arange(WIDTH * SAMPLES) + .5) / SAMPLES - .5
    x, y = np.meshgrid(step, step[:HEIGHT * SAMPLES])
    rays = np.stack([(x - (WIDTH - 1) / 2) / focal, (y - (HEIGHT - 1) / 2) / focal,
                     np.ones_like(x)], -1) @ camera_axes(*angles).T
    planes = [(1, EYE_M)] + [(axis, metres) for axis, metres in
                             ((0, -left), (0, right), (2, front)) if metres]
    picture = np.full((*x.shape, 3), SKY, np.float32)
    nearest, which = np.full(x.shape, np.inf), np.zeros(x.shape, int)
    facing = np.zeros(x.shape)
    for index, (axis, metres) in enumerate(planes, 1):
        with np.errstate(divide='ignore', invalid='ignore'):
            depth = metres / rays[..., axis]
        place = rays * depth[..., None]
        seen = (depth > 0) & (depth < nearest) & (place[..., 2] < FAR_M)
        if axis != 1:
            seen &= (place[..., 1] < EYE_M) & (place[..., 1] > EYE_M - high)
        place = place[seen]
        if axis == 1:
            picture[seen] = texels(floor, place[:, 0], place[:, 2], FLOOR_SCALE)
        else:
            picture[seen] = texels(wall, place[:, 2 - axis], place[:, 1], WALL_SCALE)
        nearest[seen], which[seen] = depth[seen], index
        facing[seen] = np.abs(rays[seen][:, axis]) / np.linalg.norm(rays[seen], axis=1)
    picture = cv2.resize(picture, (WIDTH, HEIGHT), interpolation=cv2.INTER_AREA)
    return picture, which[::SAMPLES, ::SAMPLES], facing[::SAMPLES, ::SAMPLES], planes


def hole(which, facing, on_floor, random):
    """A mask all of which, and a little more, lies on one plane; and that plane's number."""
    wanted = (which == 1) if on_floor else (which > 1)
    rows, columns = np.nonzero(wanted & (facing > LEAST_FACING))
    while True:
        at = random.integers(len(rows))
        centre = int(columns[at]), int(rows[at])
        half = int(random.integers(35, 100)), int(random.integers(35, 80))
        mask = cv2.ellipse(np.zeros((HEIGHT, WIDTH), np.uint8), centre, half, 0, 0, 360, 255, -1)
        wide = cv2.dilate(mask, np.ones((2 * CLEARANCE + 1,) * 2)) > 0
        plane = which[centre[1], centre[0]]
        if (which[wide] == plane).all() and not (
                wide[0].any() or wide[-1].any() or wide[:, 0].any() or wide[:, -1].any()):
            return mask, plane


def line_of(street, axis, mask):
    """w = a x + b y + c of the plane with that normal, positive at the hole."""
    *_, fov, pitch, yaw, roll = street
    focal = .5 * WIDTH / np.tan(np.radians(fov / 2))
    normal = camera_axes(pitch, yaw, roll)[axis]
    a, b = normal[:2] / focal
    line = np.array([a, b, normal[2] - a * (WIDTH - 1) / 2 - b * (HEIGHT - 1) / 2])
    rows, columns = np.nonzero(mask)
    return line * np.sign(line @ [columns.mean(), rows.mean(), 1])


def draw(root, index, folder):
    sys.path.insert(0, str(root))
    import make_cases
    cv2.setNumThreads(1)
    street, random = STREETS[index], np.random.default_rng(8000 + index)
    picture, which, facing, planes = look(street, *(
        make_cases.load_tex(name).astype(np.float32) for name in street[:2]))
    picture = np.clip(picture + random.normal(0, 1.5, picture.shape) + .5, 0, 255)
    for number, kind in enumerate(HOLES):
        mask, plane = hole(which, facing, kind == 'floor', random)
        made = folder / f'street-{kind}_{index:02d}{"abc"[number]}_{street[0]}_{street[1]}'
        made.mkdir()
        cv2.imwrite(str(made / 'truth.png'), picture.astype(np.uint8))
        cv2.imwrite(str(made / 'mask.png'), mask)
        line = line_of(street, planes[plane - 1][0], mask)
        (made / 'meta.json').write_text(json.dumps({'line': list(line), 'fov': street[6]}))


def load_streets(wanted=()):
    """Every hole, or those whose name begins with one of the wanted words."""
    found = []
    for folder in drawn_cases(__file__, draw, len(STREETS), wanted):
        meta = json.loads((folder / 'meta.json').read_text())
        found.append(Case(folder.name, folder, 0., np.array(meta['line']),
                          [f'--fov={meta["fov"]}']))
    return found
