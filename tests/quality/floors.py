"""Floors of two textures that meet in the hole: what a van on the road and its verge leaves. They
meet in a straight line, some with a kerb, in a rough edge, or one is a path through the other.
Drawn with the evaluation data's textures and camera, since its own cases have one texture each.
"""
import json
import sys

import cv2
import numpy as np

from evaluation import SIZE, drawn_cases, synthetic_case

# textures, slant and tilt, kind of hole, direction of the line's normal in the plane, degrees, and
# in texels the width of the kerb, how far the edge strays from its line, and the width of the path
# that the second texture is, 0: all beyond the line.
FLOORS = [
    ('gravel_colour', 'p_grass', 40, 0, 'ellipse', 80, 0, 0, 0),
    ('p_cobble', 'sk_gravel', 60, 0, 'rect', 10, 0, 0, 0),
    ('p_tiles', 'p_grass', 60, 18, 'blob', 45, 0, 0, 0),
    ('p_brick', 'gravel_colour', 40, 45, 'ellipse', 90, 24, 0, 0),
    ('p_cobble', 'flower_lawn', 20, 0, 'blob', 60, 24, 0, 0),
    ('sk_gravel', 'p_grass', 60, 0, 'rect', 75, 24, 0, 0),
    ('cobble_red', 'gravel_colour', 40, -60, 'blob', 20, 0, 0, 0),
    ('p_tiles', 'p_cobble', 60, 0, 'ellipse', 90, 0, 0, 0),
    ('p_brick', 'p_grass', 40, 90, 'rect', 30, 0, 0, 0),
    ('gravel_colour', 'p_cobble', 60, 0, 'ellipse', 0, 24, 0, 0),
    ('gravel_colour', 'p_grass', 40, 0, 'ellipse', 80, 0, 14, 0),
    ('cobble_red', 'flower_lawn', 60, 0, 'blob', 10, 0, 14, 0),
    ('p_cobble', 'sk_gravel', 40, 45, 'rect', 45, 0, 10, 0),
    ('p_grass', 'sk_gravel', 40, 0, 'ellipse', 15, 0, 6, 90),
    ('flower_lawn', 'p_brick', 60, 0, 'rect', 5, 0, 0, 80),
    ('roof_tiles', 'gravel_colour', 40, 18, 'ellipse', 20, 0, 0, 90),
    ('p_cobble', 'p_grass', 60, -60, 'blob', 60, 0, 10, 100),
    ('p_tiles', 'cobble_red', 20, 0, 'ellipse', 70, 0, 0, 90),
]
SAMPLES = 4          # each way, of one pixel
WAVES = 40, 65, 110  # of a rough edge, texels
KERB = 170, 6        # its grey, and what that differs by
TEXEL_PX = {20: .8, 40: 1, 60: 1}  # at the centre, by slant


def strays(along, rough, random):
    """How far a rough edge is from its line."""
    waves = [np.sin(2 * np.pi * (along / wave + random.uniform())) for wave in WAVES]
    return rough * sum(waves) / len(waves)


def sides(camera, mask, angle_deg, kerb, rough, path, random):
    """How much of each pixel lies on the second side, and on the kerb."""
    phases = random.integers(1 << 30)
    rows, columns = np.nonzero(mask)
    u0, v0 = camera.tex(columns.mean(), rows.mean())
    normal = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    y, x = np.mgrid[0:SIZE, 0:SIZE].astype(float)
    second, on_kerb = np.zeros((SIZE, SIZE)), np.zeros((SIZE, SIZE))
    for j in range(SAMPLES):
        for i in range(SAMPLES):
            u, v = camera.tex(x + (i + .5) / SAMPLES - .5, y + (j + .5) / SAMPLES - .5)
            across = (u - u0) * normal[0] + (v - v0) * normal[1]
            along = (v - v0) * normal[0] - (u - u0) * normal[1]
            edge = np.random.default_rng(phases)
            inside = across > strays(along, rough, edge)
            if path:
                across += path / 2
                inside = (across > strays(along, rough, edge)) & (
                    across < path + strays(along, rough, edge))
            second += inside
            on_kerb += np.abs(across) < kerb / 2
    return second[..., None] / SAMPLES ** 2, on_kerb[..., None] / SAMPLES ** 2


def draw(root, index, folder):
    """One floor into the folder, as make_cases.py writes its cases."""
    sys.path.insert(0, str(root))
    import make_cases
    cv2.setNumThreads(1)
    first, other, slant, tilt, kind, angle_deg, kerb, rough, path = FLOORS[index]
    random = np.random.default_rng(7000 + index)
    camera = make_cases.Plane(SIZE, SIZE, slant, tilt, make_cases.FOVS[slant],
                              TEXEL_PX[slant], 0,
                              (random.uniform(0, 500), random.uniform(0, 500)))
    textures = [make_cases.render(make_cases.pyramid(make_cases.load_tex(name)), camera, SAMPLES)
                for name in (first, other)]
    mask = make_cases.make_mask(SIZE, SIZE, kind, random)
    second, on_kerb = sides(camera, mask, angle_deg, kerb, rough, path,
                            np.random.default_rng(8000 + index))
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
    return [synthetic_case(folder)
            for folder in drawn_cases(__file__, draw, len(FLOORS), wanted)]
