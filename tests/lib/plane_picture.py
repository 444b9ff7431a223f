"""Pictures of a textured plane seen by a camera, drawn from the free textures in tests/data."""
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

TEXTURES = Path(__file__).resolve().parents[1] / 'data'
SUPERSAMPLING = 4  # per axis: far texels are several to a pixel


@dataclass
class View:
    """The camera, by the command's own convention: tilt 0 recedes to the top, 90 to the right."""
    width: int
    height: int
    slant_deg: float
    tilt_deg: float
    fov_deg: float = 50.0

    def options(self):
        return [f'--slant={self.slant_deg}', f'--tilt={self.tilt_deg}', f'--fov={self.fov_deg}']

    def w(self, x, y):
        """Proportional to 1 / depth; 1 in the picture's centre."""
        focal = max(self.width, self.height) / 2 / np.tan(np.radians(self.fov_deg) / 2)
        tilt = np.radians(self.tilt_deg)
        along = ((x - (self.width - 1) / 2) * np.sin(tilt) -
                 (y - (self.height - 1) / 2) * np.cos(tilt))
        return 1 - np.tan(np.radians(self.slant_deg)) / focal * along

    def texture_coordinates(self, x, y, texels_per_px, offset):
        """Where on the plane a pixel looks; texels_per_px across the tilt in the centre."""
        w = self.w(x, y)
        tilt, cosine = np.radians(self.tilt_deg), np.cos(np.radians(self.slant_deg))
        x, y = x - (self.width - 1) / 2, y - (self.height - 1) / 2
        along, across = x * np.sin(tilt) - y * np.cos(tilt), x * np.cos(tilt) + y * np.sin(tilt)
        return (across / w * texels_per_px + offset[0],
                -along / (w * cosine) * texels_per_px + offset[1])


def texture(name):
    picture = cv2.imread(str(TEXTURES / f'{name}.png'), cv2.IMREAD_COLOR)
    if picture is None:
        raise SystemExit(f'{TEXTURES}/{name}.png: cannot be read')
    return picture


def draw(name, view, texels_per_px=1.0, offset=(0, 0)):
    """The plane covered by repetitions of the texture, 8 bits, BGR."""
    step = 1 / SUPERSAMPLING
    y, x = np.mgrid[0:view.height * SUPERSAMPLING, 0:view.width * SUPERSAMPLING]
    x, y = (x + .5) * step - .5, (y + .5) * step - .5
    u, v = view.texture_coordinates(x, y, texels_per_px, offset)
    tile = texture(name)
    # One texel of margin, so that interpolation goes on across the repetition.
    height, width = tile.shape[:2]
    tile = cv2.copyMakeBorder(tile, 0, 1, 0, 1, cv2.BORDER_WRAP)
    fine = cv2.remap(tile, np.mod(u, width).astype(np.float32),
                     np.mod(v, height).astype(np.float32), cv2.INTER_LINEAR)
    return cv2.resize(fine, (view.width, view.height), interpolation=cv2.INTER_AREA)


def hole(shape, centre, size, kind='ellipse'):
    """A mask, 255 inside; centre and size are (x, y) in px."""
    mask = np.zeros(shape[:2], np.uint8)
    (x, y), (width, height) = centre, size
    if kind == 'ellipse':
        cv2.ellipse(mask, (int(x), int(y)), (int(width / 2), int(height / 2)), 0, 0, 360, 255, -1)
    else:
        left, top = int(x - width / 2), int(y - height / 2)
        mask[top:top + int(height), left:left + int(width)] = 255
    return mask
