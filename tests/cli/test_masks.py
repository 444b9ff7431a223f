"""Masks as they come: dim, compressed with loss, turned, premultiplied, parts of a larger frame."""
import struct
import subprocess
import sys

import numpy as np

import harness
from harness import check, hole, read, recede, same_bits, texture, write


def fill(folder, image, mask, *more, out="out.png", **options):
    return recede("fill", image, "--mask", mask, "--frontal", "--force", "-o", folder / out, *more,
                  **options)


def expected(folder, image, mask):
    """The fill with this mask, written as PNG."""
    fill(folder, image, write(folder / "expected-mask.png", mask), "-q", out="expected.png")
    return (folder / "expected.png").read_bytes()


def test_a_dim_mask_is_said(folder):
    """A mask of 0 and 1 out of 255 blends in almost nothing."""
    image = write(folder / "in.png", texture())
    for name, pixels, words in (
            ("one.png", hole() // 255, (b"is 1,", b"255")), ("dim.png", hole() // 4, (b"is 63,",)),
            ("sixteen.png", hole().astype(np.uint16) * 100, (b"is 25500,", b"65535")),
            ("float.tif", (hole() / 850).astype(np.float32), (b"is 0.3,", b"white is 1"))):
        mask = write(folder / name, pixels)
        said = fill(folder, image, mask).stderr
        check(all(word in said for word in words), name, said)
        check(b"brightest" not in fill(folder, image, mask, "-q").stderr)
        source = np.full((48, 64), pixels.max(), pixels.dtype)
        said = fill(folder, image, write(folder / "mask.png", hole()), "--source",
                    write(folder / name, source), code=3).stderr
        check(all(word in said for word in words), name, "as a source:", said)
    for value in (128, 255):
        mask = write(folder / "fair.png", hole() // 255 * value)
        check(b"brightest" not in fill(folder, image, mask).stderr, value)


def test_black_of_a_jpeg_is_black(folder):
    """At quality 70 it decodes as 1 everywhere: all would be hole, and nothing a source."""
    image = write(folder / "in.png", texture(96, 128))
    pixels = hole(96, 128, (32, 56, 48, 80))
    for quality in (60, 70, 75, 80, 90, 95):
        mask = folder / "mask.jpg"
        check(harness.cv2.imwrite(str(mask), pixels, [harness.cv2.IMWRITE_JPEG_QUALITY, quality]))
        fill(folder, image, mask)
        decoded = harness.cv2.imread(str(mask), harness.cv2.IMREAD_GRAYSCALE)
        far = decoded <= 2
        check(far.mean() > .8, "the test's own mask is all ringing")
        check(same_bits(texture(96, 128)[far], read(folder / "out.png")[far]), quality)
    # Without loss, 1 is meant.
    soft = pixels.copy()
    soft[31] = 2
    before = expected(folder, image, pixels)
    check(expected(folder, image, soft) != before, "a value of 2 counts for nothing in a PNG")


def tag(path, turn):
    subprocess.run(["exiftool", "-q", "-overwrite_original", f"-Orientation#={turn}", str(path)],
                   check=True)
    return path


def test_a_mask_that_says_it_is_upright(folder):
    """Orientation 1 is something said: the mask lies on the picture as seen."""
    stored, mask = texture(), hole()
    image = tag(write(folder / "in.png", stored), 3)
    seen = write(folder / "seen.png", np.ascontiguousarray(stored[::-1, ::-1]))
    on_seen = expected(folder, seen, mask)
    done = fill(folder, image, tag(write(folder / "mask.png", mask), 1), out="turned.png")
    check(b"fits both ways" not in done.stderr, done.stderr)
    turned = harness.cv2.imread(str(folder / "turned.png"), harness.cv2.IMREAD_COLOR
                                | harness.cv2.IMREAD_IGNORE_ORIENTATION)
    (folder / "whole.png").write_bytes(on_seen)
    check(same_bits(np.ascontiguousarray(turned[::-1, ::-1]), read(folder / "whole.png")))
    done = fill(folder, image, write(folder / "mask.png", mask))  # without a word: as stored
    check(b"fits both ways" in done.stderr, done.stderr)
    # Where only the stored size fits there is nothing to choose.
    image = tag(write(folder / "in.png", stored), 6)
    fill(folder, image, tag(write(folder / "mask.png", mask), 1), "-q")


def write_exr(path, channels, window, frame):
    """The plainest EXR of floats. window, frame: x, y, width, height."""
    height, width = window[3], window[2]
    names = sorted(channels)

    def attribute(name, kind, data):
        return name + b"\0" + kind + b"\0" + struct.pack("<i", len(data)) + data

    def box(x, y, box_width, box_height):
        return struct.pack("<4i", x, y, x + box_width - 1, y + box_height - 1)

    kinds = b"".join(name.encode() + b"\0" + struct.pack("<4i", 2, 0, 1, 1) for name in names)
    head = struct.pack("<ii", 20000630, 2) + attribute(b"channels", b"chlist", kinds + b"\0")
    head += attribute(b"compression", b"compression", b"\0")
    head += attribute(b"dataWindow", b"box2i", box(*window))
    head += attribute(b"displayWindow", b"box2i", box(*frame))
    head += attribute(b"lineOrder", b"lineOrder", b"\0")
    head += attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1))
    head += attribute(b"screenWindowCenter", b"v2f", bytes(8))
    head += attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)) + b"\0"
    row = 4 * width * len(names)
    first = len(head) + 8 * height
    table = b"".join(struct.pack("<Q", first + y * (row + 8)) for y in range(height))
    rows = b"".join(struct.pack("<ii", window[1] + y, row)
                    + b"".join(channels[name][y].astype("<f4").tobytes() for name in names)
                    for y in range(height))
    path.write_bytes(head + table + rows)
    return path


def test_premultiplied_masks(folder):
    """Colours that hold alpha already are not multiplied by it again."""
    image = write(folder / "in.png", texture())
    alpha = hole().astype(np.float32) / 255
    alpha[:, 30:] *= .5
    write(folder / "float.tif", alpha)
    fill(folder, image, folder / "float.tif", out="expected.png")
    rgba = dict.fromkeys("RGBA", alpha)  # white times alpha
    fill(folder, image, write_exr(folder / "mask.exr", rgba, (0, 0, 64, 48), (0, 0, 64, 48)))
    check((folder / "out.png").read_bytes() == (folder / "expected.png").read_bytes())


def test_an_exr_lies_where_its_windows_say(folder):
    image = write(folder / "in.png", texture())
    mask = hole()
    whole = expected(folder, image, mask)
    values = mask / 255
    # The data's window: a part of the frame, more than it, as large but elsewhere; a frame that
    # starts elsewhere.
    for x, y, width, height in ((18, 14, 30, 20), (-5, -4, 80, 60), (10, 9, 64, 48)):
        for start in (0, 100):
            around = np.pad(values, 200)[200 + y:200 + y + height, 200 + x:200 + x + width]
            part = write_exr(folder / "mask.exr", {"Y": around},
                             (start + x, start + y, width, height), (start, start, 64, 48))
            fill(folder, image, part)
            check((folder / "out.png").read_bytes() == whole, x, y, width, height, start)
    # A picture that is itself a part of the frame.
    rgb = texture(kind="float")
    channels = {name: rgb[:, :, 2 - c] for c, name in enumerate("RGB")}
    image = write_exr(folder / "in.exr", channels, (20, 10, 64, 48), (0, 0, 100, 80))
    fill(folder, image, write(folder / "mask.png", mask), out="whole.exr")
    in_frame = np.zeros((80, 100))
    in_frame[10:58, 20:84] = values
    fill(folder, image, write_exr(folder / "mask.exr", {"Y": in_frame}, (0, 0, 100, 80),
                                  (0, 0, 100, 80)), out="out.exr")
    check((folder / "out.exr").read_bytes() == (folder / "whole.exr").read_bytes())
    other = write_exr(folder / "mask.exr", {"Y": values[:40]}, (0, 0, 64, 40), (0, 0, 64, 40))
    check(b"64 x 40" in fill(folder, image, other, out="out.exr", code=3).stderr)


def test_a_source_may_lie_far_away(folder):
    """Farther than a fill looks of itself; and what lies between is not copied."""
    pixels = texture(100, 900)
    pixels[:, 100:700] = (0, 0, 255)
    source = np.zeros((100, 900), np.uint8)
    source[:, 720:] = 255
    image = write(folder / "wide.png", pixels)
    for method in ("plane", "paper"):
        fill(folder, image, write(folder / "mask.png", hole(100, 900, (30, 60, 20, 60))),
             "--source", write(folder / "far.png", source), "--method", method)
        made = read(folder / "out.png")[30:60, 20:60].astype(int)
        red = (made[:, :, 2] - made[:, :, :2].max(axis=2) > 100).mean()
        check(red == 0 and made.std() > 5, method, red, made.std())
    # So much nearer than the hole that it is filled in steps, from what is filled by then.
    floor = texture(600, 800)
    floor[:540] = (0, 0, 255)
    source = np.zeros((600, 800), np.uint8)
    source[540:] = 255
    recede("fill", write(folder / "floor.png", floor), "--mask",
           write(folder / "hole.png", hole(600, 800, (140, 160, 380, 420))), "--source",
           write(folder / "near.png", source), "--slant", "75", "--force", "-o", folder / "out.png")
    made = read(folder / "out.png")[140:160, 380:420].astype(int)
    check(made.mean() > 30 and made.std() > 5, "steps", made.mean(), made.std())


if __name__ == "__main__":
    sys.exit(harness.main(globals()))
