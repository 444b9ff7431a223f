#!/usr/bin/env python3
"""Fills in a real GIMP without a window, checked byte by byte.

pixels.py HOST PLUGIN COMMAND: HOST is 2 or 3; COMMAND the command recede, or "" where there is
none.
"""
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import xcf
from host import Host, Tap

WIDTH, HEIGHT = 96, 72
MODES = {"rgb": (False, False), "rgba": (False, True), "gray": (True, False), "graya": (True, True)}
PRECISIONS = ["u8", "u8-linear", "u16", "u16-linear", "u32-linear", "half-linear", "float",
              "float-linear", "double-linear"]
# Script-Fu that selects in image i, the layer being d.
RECTANGLE = "(gimp-image-select-rectangle i CHANNEL-OP-REPLACE 40 24 28 20)"
SELECTIONS = {
    "rectangle": RECTANGLE,
    "feathered": RECTANGLE + "(gimp-selection-feather i 8)",
    "disjoint": RECTANGLE + "(gimp-image-select-ellipse i CHANNEL-OP-ADD 12 40 14 14)",
    "border": "(gimp-image-select-rectangle i CHANNEL-OP-REPLACE 0 30 20 60)",
}
OFFSET = (7, -5)


def picture(path, alpha, seed=3):
    """A 16-bit picture: bricks with noise; alpha: fading into a transparent corner."""
    random = np.random.default_rng(seed)
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    joint = (y % 8 < 1) | ((x + 8 * (y // 8 % 2)) % 16 < 1)
    base = np.where(joint[..., None], [.75, .72, .7], [.3, .36, .62])
    colour = np.clip(base + random.normal(0, .03, (HEIGHT, WIDTH, 3)), 0, 1)
    if alpha:
        opacity = np.clip((x + y) / 30. - .3, 0, 1)
        colour = np.dstack([colour, opacity])
    cv2.imwrite(str(path), np.round(colour * 65535).astype(np.uint16))


def script_of(host, case, source, out, end="(gimp-image-delete i)"):
    mode, precision, selection, offset, extra = case
    gray, _ = MODES[mode]
    lines = [f'(define i (t-load "{source}"))', "(define d (t-layer i))"]
    if gray:
        lines.append("(gimp-image-convert-grayscale i)")
    if precision != "u16":  # it is that already, and GIMP refuses
        lines.append(f"(gimp-image-convert-precision i {host.precision(precision)})")
    if offset:
        lines.append(f"(gimp-layer-set-offsets d {offset[0]} {offset[1]})")
    lines.append(extra.get("before", ""))
    lines += [SELECTIONS[selection], "(define c (car (gimp-selection-save i)))",
              "(t-select-layer i d)", f'(t-save i "{out}-before.xcf")']
    lines.append(host.fill(**{"orientation": "angles", "slant": 35, **extra.get("fill", {})}))
    lines += [f'(t-save i "{out}-after.xcf")', end]
    return "\n".join(lines)


def mask_over(layer, channel):
    """The selection's values over a layer, zero where the selection does not reach."""
    mask = np.zeros((layer.height, layer.width))
    x, y = layer.offsets
    values = channel.values[..., 0] / (channel.values.max() or 1)
    x0, y0 = max(x, 0), max(y, 0)
    x1, y1 = min(x + layer.width, channel.width), min(y + layer.height, channel.height)
    mask[y0 - y : y1 - y, x0 - x : x1 - x] = values[y0:y1, x0:x1]
    return mask


def faults(before, after, mask):
    """What is wrong with a fill, as sentences."""
    outside, inside = mask == 0, mask == mask.max()
    if not np.array_equal(before.bytes[outside], after.bytes[outside]):
        changed = (before.bytes[outside] != after.bytes[outside]).any(-1).sum()
        yield f"{changed} pixels outside the selection changed"
    if not np.isfinite(after.values).all():
        yield "not finite"
    changed = (before.bytes[inside] != after.bytes[inside]).any(-1).mean()
    if changed < .5:
        yield f"only {changed:.0%} of the selected pixels changed"
    colours = before.values.shape[2] // 3 * 3 or 1
    full = 65535 if after.values.max() > 255 else 255 if after.values.max() > 1.5 else 1
    known = before.values[outside][..., :colours].reshape(-1, colours)
    filled = after.values[inside][..., :colours].reshape(-1, colours)
    allowed = .25 * max(known.max(), full / 9)
    if len(filled) and np.abs(filled.mean(0) - known.mean(0)).max() > allowed:
        yield f"mean {filled.mean(0)}, around it {known.mean(0)}"
    if before.values.shape[2] in (2, 4):
        opaque = after.values[inside][..., -1]
        if opaque.min() < opaque.max() * .999 or opaque.max() < before.values[..., -1].max() * .999:
            yield "filled pixels are not opaque"


def cases():
    """(mode, precision, selection, offset, extra); undo.py has all modes in all precisions."""
    for kind in SELECTIONS:
        yield "rgb", "u8", kind, OFFSET, {}
        yield "rgba", "u16", kind, None, {}
    yield "gray", "half-linear", "border", None, {}
    yield "graya", "float", "disjoint", OFFSET, {}
    yield "graya", "u8", "border", None, {}


def check_table(host, tap, folder):
    todo = list(cases())
    for alpha in (False, True):
        picture(folder / f"picture-{alpha:d}.png", alpha)
    script = [script_of(host, case, folder / f"picture-{MODES[case[0]][1]:d}.png", folder / str(n))
              for n, case in enumerate(todo)]
    output = host.run(*script, seconds=500)
    tap.case(host.done, "the table's script came to its end", output)
    for number, case in enumerate(todo):
        name = f"{case[0]} {case[1]} {case[2]}" + (" offset" if case[3] else "")
        if not (folder / f"{number}-after.xcf").exists():
            tap.case(False, name, "no result")
            continue
        before = xcf.Image(folder / f"{number}-before.xcf")
        after = xcf.Image(folder / f"{number}-after.xcf")
        mask = mask_over(before.layers[0], before.channels[0])
        wrong = list(faults(before.layers[0], after.layers[0], mask))
        tap.case(not wrong, name, "\n".join(wrong))


def check_new_layer(host, tap, folder):
    """The new layer laid over the old one looks like the fill in place."""
    todo = [("rgb", "u8", "feathered", OFFSET), ("graya", "u16", "disjoint", None),
            ("rgb", "float", "rectangle", None)]
    script = [script_of(host, (*case, {"fill": {"result": "new-layer"}}),
                        folder / f"picture-{MODES[case[0]][1]:d}.png", folder / f"new-{n}")
              for n, case in enumerate(todo)]
    output = host.run(*script)
    for number, case in enumerate(todo):
        name = "new layer, " + " ".join(case[:3])
        if not (folder / f"new-{number}-after.xcf").exists():
            tap.case(False, name, output)
            continue
        before = xcf.Image(folder / f"new-{number}-before.xcf")
        after = xcf.Image(folder / f"new-{number}-after.xcf")
        mask = mask_over(before.layers[0], before.channels[0])
        rows, columns = np.nonzero(mask)
        top, bottom = after.layers[0], after.layers[-1]
        alpha = top.values[..., -1] / {2: 65535, 1: 255, 6: 1}[after.precision // 100]
        where = tuple(np.subtract(top.offsets, bottom.offsets))
        box = mask[rows.min() : rows.max() + 1, columns.min() : columns.max() + 1]
        tap.case(len(after.layers) == len(before.layers) + 1
                 and np.array_equal(before.layers[0].bytes, bottom.bytes)
                 and where == (columns.min(), rows.min()) and alpha.shape == box.shape
                 and np.abs(alpha - box).max() < .005, name,
                 f"layers {len(after.layers)}, at {where}, shape {alpha.shape} {box.shape}")


def check_beyond(host, tap, folder):
    """A new layer has nothing beyond the horizon, be the sky cut out or not."""
    for alpha in (True, False):
        random = np.random.default_rng(5)
        image = random.integers(100, 256, (120, 160, 4), np.uint8)[..., : 3 + alpha]
        if alpha:
            image[..., 3] = 255
            image[:40] = 0
        cv2.imwrite(f"{folder}/sky-{alpha:d}.png", image)
        output = host.run(
            f'(define i (t-load "{folder}/sky-{alpha:d}.png"))', "(define d (t-layer i))",
            "(gimp-image-select-rectangle i CHANNEL-OP-REPLACE 60 10 40 80)",
            host.fill(orientation="angles", slant=83, result="new-layer"),
            f'(t-save i "{folder}/sky-{alpha:d}.xcf")')
        name = "no new pixels beyond the horizon, " + ("cut out" if alpha else "opaque")
        if not host.done:
            tap.case(False, name, output)
            continue
        made = xcf.Image(f"{folder}/sky-{alpha:d}.xcf").layers[0].values[..., -1].max(1)
        # With a field of view of 50 degrees it crosses row 38.4; the layer begins in row 10.
        tap.case(not made[:28].any() and made[32:].all(), name, list(made))


def check_components(host, tap, folder):
    """What the Channels dialog has switched off stays, and alpha that is locked."""
    off = "(gimp-image-set-component-active i CHANNEL-{} FALSE)"
    fading = "(gimp-image-select-rectangle i CHANNEL-OP-REPLACE 0 0 40 30)"
    for name, script, kept in (
            ("green and blue switched off", off.format("GREEN") + off.format("BLUE"), (1, 2)),
            ("alpha switched off", off.format("ALPHA"), (3,)),
            ("alpha locked", "(gimp-layer-set-lock-alpha d TRUE)", (3,))):
        stem = folder / name.replace(" ", "-")
        output = host.run(
            f'(define i (t-load "{folder}/picture-1.png"))', "(define d (t-layer i))",
            f"(gimp-image-convert-precision i {host.precision('u32-linear')})", fading, script,
            f'(t-save i "{stem}-before.xcf")', host.fill(orientation="angles", slant=35),
            f'(t-save i "{stem}-after.xcf")')
        if not host.done:
            tap.case(False, name, output)
            continue
        before, after = (xcf.Image(f"{stem}-{when}.xcf").layers[0].values
                         for when in ("before", "after"))
        changed = [int((before[..., k] != after[..., k]).sum()) for k in range(4)]
        tap.case(all((changed[k] == 0) == (k in kept) for k in range(4)), name, changed)


def check_same_as_command(host, tap, folder, command):
    """The same seed gives the command's pixels on the same file."""
    for bits, kind in ((8, "rectangle"), (8, "feathered"), (16, "disjoint")):
        name = f"the command's pixels, {bits} bits, {kind}"
        if not command:
            tap.case(True, name + " # SKIP the command is not built")
            continue
        stem = folder / f"same-{bits}-{kind}"
        image = cv2.imread(str(folder / "picture-0.png"), -1)
        cv2.imwrite(f"{stem}.png", image if bits == 16 else (image / 257).round().astype(np.uint8))
        output = host.run(
            f'(define i (t-load "{stem}.png"))', "(define d (t-layer i))", SELECTIONS[kind],
            "(define c (car (gimp-selection-save i)))", "(t-select-layer i d)",
            host.fill(orientation="angles", slant=35, tilt=10, seed=7, surface="flat"),
            f'(t-save i "{stem}.xcf")')
        if not host.done:
            tap.case(False, name, output)
            continue
        after = xcf.Image(f"{stem}.xcf")
        cv2.imwrite(f"{stem}-mask.png", after.channels[0].values[..., 0].astype(
            np.uint8 if after.channels[0].bytes.shape[2] == 1 else np.uint16))
        run = subprocess.run(
            [command, "fill", f"{stem}.png", "--mask", f"{stem}-mask.png", "-o", f"{stem}-out.png",
             "--slant", "35", "--tilt", "10", "--seed", "7", "--surface", "flat"],
            capture_output=True, text=True, check=False)
        theirs = cv2.imread(f"{stem}-out.png", -1)
        ours = after.layers[0].values[..., ::-1]
        tap.case(theirs is not None and np.array_equal(theirs, ours), name, run.stderr if
                 theirs is None else f"{(theirs != ours).any(-1).sum()} pixels differ")


def check_mask(host, tap, folder):
    """A layer mask is filled like a layer, and stays when its layer is filled."""
    keep = "(gimp-image-select-item i CHANNEL-OP-REPLACE m)(gimp-selection-save i)"
    for target in ("m", "d"):
        stem = folder / f"mask-{target}"
        output = host.run(
            f'(define i (t-load "{folder}/picture-0.png"))', "(define d (t-layer i))",
            f"(gimp-image-convert-precision i {host.precision('u8')})",
            "(define m (car (gimp-layer-create-mask d ADD-MASK-COPY)))(gimp-layer-add-mask d m)",
            keep, RECTANGLE, f'(t-save i "{stem}-before.xcf")',
            host.fill(layer=target, orientation="angles", slant=35), keep,
            f'(t-save i "{stem}-after.xcf")')
        name = "a layer mask is filled" if target == "m" else "a layer with a mask is filled"
        if not host.done:
            tap.case(False, name, output)
            continue
        old, new = xcf.Image(f"{stem}-before.xcf"), xcf.Image(f"{stem}-after.xcf")
        inside = np.zeros((HEIGHT, WIDTH), bool)
        inside[24:44, 40:68] = True
        masks, layers = ([(a.bytes != b.bytes).any(-1) for a, b in ((new.channels[0],
                          old.channels[0]), (new.layers[0], old.layers[0]))])
        changed, kept = (masks, layers) if target == "m" else (layers, masks)
        tap.case(changed[inside].mean() > .5 and not changed[~inside].any() and not kept.any(),
                 name, f"{changed[inside].mean()} {changed[~inside].sum()} {kept.sum()}")


def check_synthesis(host, tap, folder):
    """A new image: the size asked for, the image's precision, the exemplar's colours."""
    for mode, precision, selected in (("rgb", "u8", False), ("graya", "u16", True),
                                      ("rgb", "float-linear", False)):
        stem = folder / f"made-{mode}-{precision}"
        name = f"synthesize {mode} {precision}" + (" of a selection" if selected else "")
        lines = [f'(define i (t-load "{folder}/picture-{MODES[mode][1]:d}.png"))',
                 "(define d (t-layer i))"]
        if MODES[mode][0]:
            lines.append("(gimp-image-convert-grayscale i)")
        if precision != "u16":
            lines.append(f"(gimp-image-convert-precision i {host.precision(precision)})")
        if selected:
            lines.append("(gimp-image-select-rectangle i CHANNEL-OP-REPLACE 40 8 50 50)")
        made = host.synthesize(width=120, height=90, orientation="angles", slant=30)
        output = host.run(*lines, f'(t-save i "{stem}-old.xcf")', f"(define n (car {made}))",
                          f'(t-save n "{stem}.xcf")')
        if not host.done:
            tap.case(False, name, output)
            continue
        old, new = xcf.Image(f"{stem}-old.xcf"), xcf.Image(f"{stem}.xcf")
        colours = slice(0, 1 if MODES[mode][0] else 3)
        values = new.layers[0].values[..., colours]
        opaque = old.layers[0].values[10:50, 50:85, colours]
        tap.case((new.width, new.height, new.precision) == (120, 90, old.precision)
                 and np.abs(values.mean() / opaque.mean() - 1) < .2
                 and .5 < values.std() / opaque.std() < 1.5, name,
                 f"{new.width}x{new.height}, mean {values.mean()} for {opaque.mean()}")


def check_laid(host, tap, folder):
    """A texture from the front is laid onto the plane. 2.10's scripts cannot say so."""
    made = {}
    for seen in ("receding", "frontal"):
        call = host.synthesize(width=120, height=90, orientation="angles", slant=60, exemplar=seen)
        output = host.run(f'(define i (t-load "{folder}/picture-0.png"))',
                          "(define d (t-layer i))", f"(define n (car {call}))",
                          f'(t-save n "{folder}/{seen}.xcf")')
        if not host.done:
            tap.case(False, f"synthesize {seen}", output)
            return
        made[seen] = xcf.Image(folder / f"{seen}.xcf").layers[0].values
    apart = (np.abs(made["receding"] - made["frontal"]).max(-1) > .02).mean()
    means = made["receding"].mean(), made["frontal"].mean()
    tap.case(apart > .5 and abs(means[0] / means[1] - 1) < .2, "a texture from the front",
             f"{apart} {means}")


def main():
    name, plugin, command = sys.argv[1:4]
    tap = Tap()
    with Host(name, plugin) as host:
        check_table(host, tap, host.folder)
        check_new_layer(host, tap, host.folder)
        check_beyond(host, tap, host.folder)
        check_mask(host, tap, host.folder)
        check_components(host, tap, host.folder)
        check_synthesis(host, tap, host.folder)
        if name == "3":
            check_laid(host, tap, host.folder)
        check_same_as_command(host, tap, host.folder, command and Path(command).resolve())
    tap.plan()


if __name__ == "__main__":
    main()
