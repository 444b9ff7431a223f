"""Floors of two textures that meet in a straight line through the hole, some with a kerb: what a
van on the road and its verge leaves. Drawn with the evaluation data's textures and camera, since
its own cases have one texture each.
"""
import json
import sys

import cv2
import numpy as np

from evaluation import SIZE, drawn_cases, synthetic_case

# textures, slant and tilt, kind of hole, direction of the line's normal in the plane, degrees, and
# width of the kerb, texels.
FLOORS = [
    ('gravel_colour', 'p_grass', 40, 0, 'ellipse', 80, 0),
    ('p_cobble', 'sk_gravel', 60, 0, 'rect', 10, 0),
    ('p_tiles', 'p_grass', 60, 18, 'blob', 45, 0),
    ('p_brick', 'gravel_colour', 40, 45, 'ellipse', 90, 24),
    ('p_cobble', 'flower_lawn', 20, 0, 'blob', 60, 24),
    ('sk_gravel', 'p_grass', 60, 0, 'rect', 75, 24),
    ('cobble_red', 'gravel_colour', 40, -60, 'blob', 20, 0),
    ('p_tiles', 'p_cobble', 60, 0, 'ellipse', 90, 0),
    ('p_brick', 'p_grass', 40, 90, 'rect', 30, 0),
    ('gravel_colour', 'p_cobble', 60, 0, 'ellipse', 0, 24),
]
SAMPLES = 4          # each way, of one pixel
KERB = 170, 6        # its grey, and what that differs by
TEXEL_PX = {20: .8, 40: 1, 60: 1}  # at the centre, by slant


def sides(camera, mask, angle_deg, kerb):
    """How much of each pixel lies on the second side, and on the kerb."""
    rows, columns = np.nonzero(mask)
    u0, v0 = camera.tex(columns.mean(), rows.mean())
    normal = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    y, x = np.mgrid[0:SIZE, 0:SIZE].astype(float)
    second, on_kerb = np.zeros((SIZE, SIZE)), np.zeros((SIZE, SIZE))
    for j in range(SAMPLES):
        for i in range(SAMPLES):
            u, v = camera.tex(x + (i + .5) / SAMPLES - .5, y + (j + .5) / SAMPLES - .5)
            across = (u - u0) * normal[0] + (v - v0) * normal[1]
            second += across > 0
            on_kerb += np.abs(across) < kerb / 2
    return second[..., None] / SAMPLES ** 2, on_kerb[..., None] / SAMPLES ** 2


def draw(root, index, folder):
    """One floor into the folder, as make_cases.py writes its cases."""
    sys.path.insert(0, str(root))
    import make_cases
    cv2.setNumThreads(1)
    first, other, slant, tilt, kind, angle_deg, kerb = FLOORS[index]
    random = np.random.default_rng(7000 + index)
    camera = make_cases.Plane(SIZE, SIZE, slant, tilt, make_cases.FOVS[slant],
                              TEXEL_PX[slant], 0,
                              (random.uniform(0, 500), random.uniform(0, 500)))
    textures = [make_cases.render(make_cases.pyramid(make_cases.load_tex(name)), camera, SAMPLES)
                for name in (first, other)]
    mask = make_cases.make_mask(SIZE, SIZE, kind, random)
    second, on_kerb = sides(camera, mask, angle_deg, kerb)
    truth = textures[0] * (1 - second) + textures[1] * second
    grey = KERB[0] + np.random.default_rng(index).normal(0, KERB[1], (SIZE, SIZE, 1))
    truth = np.clip(truth * (1 - on_kerb) + grey * on_kerb + .5, 0, 255).astype(np.uint8)
    folder /= f'{index:03d}_{first}-{other}_s{slant}_t{tilt}_{kind}'
    folder.mkdir()
    pictures = {'truth': truth, 'mask': mask, 'input': np.where(mask[..., None] > 0, 0, truth)}
    for name, picture in pictures.items():
        cv2.imwrite(str(folder / f'{name}.png'), picture)
    (folder / 'meta.json').write_text(json.dumps({**camera.meta(), 'texture': first}))


def load_floors(wanted=()):
    """Every floor, or those whose name begins with one of the wanted words."""
    cases = drawn_cases(__file__, draw, len(FLOORS))
    wanted = tuple(wanted or ('',))
    return [synthetic_case(folder) for folder in sorted(cases.iterdir())
            if folder.name.startswith(wanted)]
