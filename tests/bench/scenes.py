"""The fixed scenes of `./dev bench fill`: pictures and masks, made once into the cache."""
import sys
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

sys.path[:0] = [str(Path(__file__).resolve().parents[1] / part) for part in ('lib', 'quality')]
from evaluation import CACHE, data_folder, digest  # noqa: E402
import plane_picture  # noqa: E402
from plane_picture import TEXTURES, View, draw, hole  # noqa: E402

# name: texture, picture, side of the square hole. The hole's share grows with the picture's.
RENDERED = {
    'brick-128': ('brick_regular', View(384, 288, 50, 0), 128),
    'brick-256': ('brick_regular', View(768, 576, 50, 0), 256),
    'gravel-256': ('sk_gravel', View(768, 576, 50, 20), 256),
    'brick-512': ('brick_regular', View(1536, 1152, 50, 0), 512),
    'gravel-512': ('sk_gravel', View(1536, 1152, 50, 20), 512),
}
TEXELS_PER_PX = 1.2
# From the 21 MP photo of dunes: 12 MP, and a hole of 1 MP in the rippled foreground.
DUNES, DUNES_SIZE, DUNES_HOLE = 'dunes-1mp', (4522, 2654), (2000, 500)
DUNES_CENTRE, DUNES_HORIZON = (.47, .895), .60  # parts of the width and the height
SCENES = [*RENDERED, DUNES]


@dataclass
class Scene:
    name: str
    image: Path  # PPM: encoding a picture must not weigh more than filling it
    mask: Path
    options: list  # the orientation

    def hole_pixels(self):
        return int((cv2.imread(str(self.mask), cv2.IMREAD_GRAYSCALE) > 0).sum())


def rendered(name):
    texture, view, side = RENDERED[name]
    picture = draw(texture, view, TEXELS_PER_PX)
    return picture, hole(picture.shape, (view.width / 2, view.height / 2), (side, side), 'rect'), \
        view.options()


def dunes():
    """None where the evaluation data is not there."""
    folder = data_folder()
    if folder is None:
        return None
    picture = cv2.imread(str(folder / 'photo' / 'BIG_dunes_21MP.jpg'))
    picture = cv2.resize(picture, DUNES_SIZE, interpolation=cv2.INTER_AREA)
    width, height = DUNES_SIZE
    mask = hole(picture.shape, (DUNES_CENTRE[0] * width, DUNES_CENTRE[1] * height), DUNES_HOLE,
                'rect')
    y = DUNES_HORIZON * height
    return picture, mask, [f'--horizon=0,{y},{width},{y}']


def scene(name):
    """The scene's files; None where it cannot be made."""
    made = dunes() if name == DUNES else rendered(name)
    if made is None:
        return None
    picture, mask, options = made
    made_from = [Path(__file__), Path(plane_picture.__file__), *sorted(TEXTURES.glob('*.png'))]
    folder = CACHE / 'scenes' / digest(name, *made_from)
    folder.mkdir(parents=True, exist_ok=True)
    for file, content in (('image.ppm', np.where(mask[..., None] > 0, 0, picture)),
                          ('mask.pgm', mask)):
        if not (folder / file).exists():
            cv2.imwrite(str(folder / file), content.astype(np.uint8))
    return Scene(name, folder / 'image.ppm', folder / 'mask.pgm', options)
