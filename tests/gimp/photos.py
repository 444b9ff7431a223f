#!/usr/bin/env python3
"""Photos as they come, in a real GIMP without a window: with a colour profile that is not sRGB, and
large.

photos.py HOST PLUGIN COMMAND PICTURE: COMMAND is the command recede, or "" where there is none.
"""
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import xcf
from host import Host, Tap
from pixels import RECTANGLE, faults, mask_over, picture

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "lib"))
import icc  # noqa: E402 - found by then

HOLE = (40, 24, 28, 20)  # RECTANGLE
LARGE, LARGE_HOLE = (4000, 3000), (1400, 1900, 1150, 880)
FILL = {"orientation": "angles", "slant": 35, "tilt": 10, "seed": 7, "surface": "flat"}
OPTIONS = ["--slant", "35", "--tilt", "10", "--seed", "7", "--surface", "flat"]


def inside(shape, hole):
    mask = np.zeros(shape[:2], bool)
    x, y, width, height = hole
    mask[y : y + height, x : x + width] = True
    return mask


def profiled(path, bits, profile):
    picture(path, False)
    image = cv2.imread(str(path), -1)
    cv2.imwrite(str(path), image if bits == 16 else (image / 257).round().astype(np.uint8))
    icc.embed(path, profile)


def check_profile_of_file(host, tap, command):
    """A PNG with a profile, filled and saved as one: the command's file, pixel by pixel."""
    profile = icc.rgb_profile(icc.WIDE, 1.8)
    for bits in (8, 16):
        stem = host.folder / f"wide-{bits}"
        profiled(f"{stem}.png", bits, profile)
        output = host.run(f'(define i (t-load "{stem}.png"))', "(define d (t-layer i))", RECTANGLE,
                          host.fill(**FILL), f'(t-save-png i "{stem}-out.png")')
        before, after = (cv2.imread(str(path), -1) for path in (f"{stem}.png", f"{stem}-out.png"))
        if not tap.case(after is not None, f"a wide profile, {bits} bits: is filled", output):
            continue
        mask = inside(before.shape, HOLE)
        tap.case(icc.embedded(f"{stem}-out.png") == profile, "and keeps its profile")
        tap.case(np.array_equal(before[~mask], after[~mask])
                 and (before[mask] != after[mask]).any(-1).mean() > .5,
                 "the selection changed and nothing else")
        cv2.imwrite(f"{stem}-mask.png", mask.astype(np.uint8) * 255)
        if not command:
            tap.case(True, "the command's pixels # SKIP the command is not built")
            continue
        run = subprocess.run([command, "fill", f"{stem}.png", "--mask", f"{stem}-mask.png", "-o",
                              f"{stem}-command.png", *OPTIONS], capture_output=True, text=True,
                             check=False)
        theirs = cv2.imread(f"{stem}-command.png", -1)
        tap.case(theirs is not None and np.array_equal(theirs, after), "the command's pixels",
                 run.stderr)


def check_profile_of_image(host, tap):
    """Other kinds of pixels in an image that has a profile, and a new image made from it."""
    source, made = host.folder / "wide-16.png", host.folder / "wide-made.png"
    for gray, precision in ((False, "float-linear"), (False, "u8-linear"), (True, "u16"),
                            (True, "half-linear")):
        stem = host.folder / f"wide-{gray:d}-{precision}"
        lines = [f'(define i (t-load "{source}"))', "(define d (t-layer i))"]
        if gray:
            lines.append("(gimp-image-convert-grayscale i)")
        if precision != "u16":
            lines.append(f"(gimp-image-convert-precision i {host.precision(precision)})")
        output = host.run(
            *lines, RECTANGLE, "(define c (car (gimp-selection-save i)))", "(t-select-layer i d)",
            f'(t-save i "{stem}-before.xcf")', host.fill(**FILL), f'(t-save i "{stem}-after.xcf")')
        name = f"a wide profile, {'gray' if gray else 'rgb'} {precision}"
        if not host.done:
            tap.case(False, name, output)
            continue
        before, after = (xcf.Image(f"{stem}-{when}.xcf") for when in ("before", "after"))
        mask = mask_over(before.layers[0], before.channels[0])
        wrong = list(faults(before.layers[0], after.layers[0], mask))
        tap.case(not wrong, name, "\n".join(wrong))
    made_by = host.synthesize(width=60, height=50, orientation="frontal")
    output = host.run(f'(define i (t-load "{source}"))', "(define d (t-layer i))",
                      f"(define n (car {made_by}))", f'(t-save-png n "{made}")')
    tap.case(host.done and icc.embedded(made) == icc.embedded(source),
             "a new image has the profile of its exemplar", output)


def check_large(host, tap, photo):
    """12 megapixels of 16 bits, 1 megapixel selected."""
    random = np.random.default_rng(1)
    image = cv2.resize(cv2.imread(photo), LARGE, interpolation=cv2.INTER_CUBIC).astype(np.int32)
    image = (image * 257 + random.integers(-400, 401, image.shape)).clip(0, 65535)
    source, out = host.folder / "large.tif", host.folder / "large-out.tif"
    cv2.imwrite(str(source), image.astype(np.uint16), [cv2.IMWRITE_TIFF_COMPRESSION, 1])
    x, y, width, height = LARGE_HOLE
    select = f"(gimp-image-select-rectangle i CHANNEL-OP-REPLACE {x} {y} {width} {height})"
    output = host.run(f'(define i (t-load "{source}"))', "(define d (t-layer i))", select,
                      host.fill(orientation="angles", slant=80, quality="draft", seed=1),
                      f'(t-save i "{out}")')
    after = cv2.imread(str(out), -1)
    if not tap.case(after is not None and after.dtype == np.uint16 and after.shape == image.shape,
                    "12 megapixels of 16 bits, 1 megapixel filled", output):
        return
    mask = inside(image.shape, LARGE_HOLE)
    tap.case(np.array_equal(image[~mask], after[~mask]), "nothing else changed")
    strip = inside(image.shape, (x - 60, y - 60, width + 120, height + 120)) & ~mask
    filled, near = after[mask].astype(float), image[strip].astype(float)
    tap.case((after[mask] != image[mask]).any(-1).mean() > .99
             and abs(filled.mean() / near.mean() - 1) < .25
             and .3 < filled.std() / near.std() < 3, "and it looks like what is around it",
             f"mean {filled.mean()} {near.mean()}, spread {filled.std()} {near.std()}")


def main():
    name, plugin, command, photo = sys.argv[1:5]
    tap = Tap()
    with Host(name, plugin) as host:
        check_profile_of_file(host, tap, command and Path(command).resolve())
        check_profile_of_image(host, tap)
        check_large(host, tap, photo)
    tap.plan()


main()
