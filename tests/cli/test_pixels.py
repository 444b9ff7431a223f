"""Every kind of pixel: depth and channels stay, bits outside the mask stay; masks, alpha, Exif's
turn, values that are no numbers."""
import struct
import subprocess
import sys
import zlib

import numpy as np

import harness
from harness import check, hole, read, recede, report_of, same_bits, texture, write

KINDS = [("png", "u8"), ("png", "u16"), ("tif", "u8"), ("tif", "u16"), ("tif", "float"),
         ("exr", "half"), ("exr", "float"), ("bmp", "u8"), ("ppm", "u8")]


def holds(suffix, channels):
    return suffix not in ("ppm", "bmp", "exr") or channels == 3  # what cv2 can write of it


def outside(pixels, mask):
    return np.ascontiguousarray(pixels[mask == 0])


def make(folder, suffix, kind, channels, name="in"):
    """cv2 has no gray with alpha: ImageMagick makes it from what cv2 wrote."""
    pixels = texture(channels=channels, kind=kind)
    path = folder / f"{name}.{suffix}"
    if channels == 2:
        rgba = np.dstack([pixels[:, :, 0]] * 3 + [pixels[:, :, 1]])
        write(folder / "rgba.png", rgba)
        run_convert(folder / "rgba.png", "-define", "png:color-type=4", path)
    else:
        write(path, pixels, half=kind == "half")
    return path


def run_convert(*arguments):
    subprocess.run(["convert", *map(str, arguments)], check=True, timeout=60)


def check_fill(folder, suffix, kind, channels):
    image = make(folder, suffix, kind, channels)
    mask = hole()
    out = folder / f"out.{suffix}"
    recede("fill", image, "--mask", write(folder / "mask.png", mask), "--slant", "30", "-q",
           "--force", "-o", out)
    before, after = read(image), read(out)
    what = (suffix, kind, channels)
    check(before.dtype == after.dtype and before.shape == after.shape, what, after.dtype,
          after.shape)
    check(same_bits(outside(before, mask), outside(after, mask)), what, "bits outside changed")
    inside = np.s_[17:29, 21:39]
    check(not np.array_equal(before[inside], after[inside]), what, "nothing was filled")


def test_bits_outside_the_mask_stay(folder):
    for suffix, kind in KINDS:
        for channels in (1, 3, 4) if kind != "half" else (3,):
            if holds(suffix, channels):
                check_fill(folder, suffix, kind, channels)


def test_gray_with_alpha(folder):
    for suffix, kind in (("png", "u8"), ("png", "u16")):
        image = make(folder, suffix, kind, 2)
        out = folder / "out.png"
        recede("fill", image, "--mask", write(folder / "mask.png", hole()), "--frontal", "-q",
               "--force", "-o", out)
        said = subprocess.run(["identify", "-verbose", str(out)], capture_output=True, check=True,
                              text=True).stdout
        check("GrayAlpha" in said and f"png:IHDR.bit_depth: {16 if kind == 'u16' else 8}" in said,
              said[:600])


def test_floats_beyond_0_to_1_stay(folder):
    pixels = texture(kind="float")
    check(pixels.min() < 0 or pixels.max() > 1, "the test's own picture is tame")
    image = write(folder / "in.exr", pixels)
    recede("fill", image, "--mask", write(folder / "mask.png", hole()), "--frontal", "-q", "-o",
           folder / "out.exr")
    check(same_bits(outside(read(image), hole()), outside(read(folder / "out.exr"), hole())))


def test_values_that_are_no_numbers(folder):
    pixels = texture(kind="float")
    pixels[5, 5] = np.nan
    pixels[6, 10] = np.inf
    pixels[7, 12, 1] = -np.inf
    pixels[20, 25] = np.nan  # within the hole
    for suffix in ("tif", "exr"):
        image = write(folder / f"in.{suffix}", pixels)
        out = folder / f"out.{suffix}"
        report = report_of("fill", image, "--mask", write(folder / "mask.png", hole()), "-q",
                           "--frontal", "-o", out)
        after = read(out)
        check(report["nonfinite_pixels"] >= 3, report["nonfinite_pixels"])
        said = recede("fill", image, "--mask", folder / "mask.png", "--frontal", "-o", out,
                      "--force").stderr
        check(f"{report['nonfinite_pixels']} px are no numbers".encode() in said, said)
        check(np.isfinite(after[hole() > 0]).all(), "the fill is not finite")
        check(same_bits(outside(read(image), hole()), outside(after, hole())))


def test_gray_mask_blends(folder):
    image = write(folder / "in.png", texture())
    mask = hole()
    recede("fill", image, "--mask", write(folder / "mask.png", mask), "--frontal", "-q", "-o",
           folder / "whole.png")
    recede("fill", image, "--mask", write(folder / "half.png", mask // 2), "--frontal", "-q", "-o",
           folder / "half-out.png")
    before, whole, half = (read(folder / name).astype(int)
                           for name in ("in.png", "whole.png", "half-out.png"))
    expected = before + (whole - before) * (127 / 255)
    check(abs(half - expected)[mask > 0].max() <= 1.01, abs(half - expected).max())


def test_kinds_of_masks(folder):
    image = write(folder / "in.png", texture())
    mask = hole()
    rgb = np.dstack([mask] * 3)
    rgba = np.dstack([np.full_like(rgb, 255), mask])  # white on transparent
    kinds = {"gray.png": mask, "gray16.png": mask.astype(np.uint16) * 257, "rgb.png": rgb,
             "rgba.png": rgba, "float.tif": (mask / 255).astype(np.float32), "gray.bmp": mask}
    made = set()
    for name, pixels in kinds.items():
        out = folder / ("out-" + name + ".png")
        recede("fill", image, "--mask", write(folder / name, pixels), "--frontal", "-q", "-o", out)
        made.add(out.read_bytes())
    run_convert(folder / "gray.png", "-monochrome", "-define", "png:bit-depth=1",
                folder / "bilevel.png")
    recede("fill", image, "--mask", folder / "bilevel.png", "--frontal", "-q", "-o",
           folder / "last.png")
    made.add((folder / "last.png").read_bytes())
    check(len(made) == 1, "masks of other kinds give other fills")
    bad = (mask / 255).astype(np.float32)
    bad[3, 4] = np.nan
    done = recede("fill", image, "--mask", write(folder / "bad.tif", bad), "--frontal", "-o",
                  folder / "bad.png", code=3)
    check(b"(4, 3)" in done.stderr, done.stderr)


def test_source_mask_limits_what_is_copied(folder):
    pixels = texture()
    pixels[:, :20] = (0, 0, 255)
    image = write(folder / "in.png", pixels)
    source = np.zeros((48, 64), np.uint8)
    source[:, :20] = 255
    recede("fill", image, "--mask", write(folder / "mask.png", hole()), "--source",
           write(folder / "source.png", source), "--frontal", "--set", "engine-tone=0", "-q",
           "-o", folder / "out.png")
    middle = read(folder / "out.png")[20:26, 26:34].astype(int)
    check((middle[:, :, 2] - middle[:, :, 1] > 60).all(), "not from the source:", middle[0, 0])


def test_few_bits_are_expanded(folder):
    write(folder / "plain.png", texture())
    for bits in (1, 2, 4):
        image = folder / f"gray{bits}.png"
        run_convert(folder / "plain.png", "-colorspace", "gray", "-depth", bits, "-define",
                    f"png:bit-depth={bits}", "-define", "png:color-type=0", image)
        recede("fill", image, "--mask", write(folder / "mask.png", hole()), "--frontal", "-q", "-o",
               folder / f"out{bits}.png")
        said = recede("fill", image, "--mask", folder / "mask.png", "--frontal", "-o",
                      folder / f"said{bits}.png").stderr
        check(f"{bits}-bit samples".encode() in said, said)
        before, after = read(image), read(folder / f"out{bits}.png")
        check(np.array_equal(outside(before, hole()), outside(after, hole())), bits)
    run_convert(folder / "plain.png", "-colors", "16", "-type", "Palette",
                "png8:" + str(folder / "indexed.png"))
    done = recede("fill", folder / "indexed.png", "--mask", folder / "mask.png", "--frontal", "-o",
                  folder / "out-indexed.png")
    check(b"palette" in done.stderr, done.stderr)
    check(same_bits(outside(read(folder / "indexed.png"), hole()),
                    outside(read(folder / "out-indexed.png"), hole())))


def test_several_pictures_in_a_file(folder):
    """The first is used, and the loss of the others said."""
    write(folder / "a.png", texture())
    write(folder / "b.png", texture()[::-1])
    run_convert(folder / "a.png", folder / "b.png", folder / "in.tif")
    run_convert("-delay", 10, folder / "a.png", folder / "b.png", "-define", "webp:lossless=true",
                folder / "in.webp")
    plain = (folder / "a.png").read_bytes()
    control = b"acTL" + struct.pack(">II", 1, 0)
    chunk = struct.pack(">I", 8) + control + struct.pack(">I", zlib.crc32(control))
    (folder / "in.png").write_bytes(plain[:33] + chunk + plain[33:])
    for suffix in ("tif", "webp", "png"):
        done = recede("fill", folder / f"in.{suffix}", "--mask", write(folder / "mask.png", hole()),
                      "--frontal", "--force", "-o", folder / "out.png")
        check(b"several pictures" in done.stderr, suffix, done.stderr)
        check(same_bits(outside(texture(), hole()), outside(read(folder / "out.png")[:, :, :3],
                                                           hole())), suffix)


def test_what_cannot_be_kept_is_refused_by_name(folder):
    mask = write(folder / "mask.png", hole())
    write(folder / "plain.png", texture())
    run_convert(folder / "plain.png", "-colorspace", "CMYK", folder / "cmyk.jpg")
    run_convert(folder / "plain.png", "-colorspace", "CMYK", folder / "cmyk.tif")
    run_convert(folder / "plain.png", "-colorspace", "Lab", folder / "lab.tif")
    run_convert(folder / "plain.png", "-define", "quantum:format=floating-point", "-depth", "64",
                folder / "double.tif")
    run_convert(folder / "plain.png", "-type", "Palette", "-compress", "RLE", folder / "packed.bmp")
    for name, word in (("cmyk.jpg", "CMYK"), ("cmyk.tif", "CMYK"), ("lab.tif", "L*a*b*"),
                       ("double.tif", "double"), ("packed.bmp", "RLE")):
        done = recede("fill", folder / name, "--mask", mask, "--frontal", "-o", folder / "out.png",
                      code=3)
        check(word.encode() in done.stderr, name, done.stderr)


def test_what_the_output_cannot_hold(folder):
    mask = write(folder / "mask.png", hole())
    images = {"u8": write(folder / "u8.png", texture()),
              "u16": write(folder / "u16.png", texture(kind="u16")),
              "float": write(folder / "float.exr", texture(kind="float")),
              "half": write(folder / "half.exr", texture(kind="half"), half=True)}
    glass = texture(channels=4)
    glass[:, :9, 3] = 100
    images["glass"] = write(folder / "glass.png", glass)
    images["rgba"] = write(folder / "rgba.png", texture(channels=4))

    def fill(kind, suffix, code):
        return recede("fill", images[kind], "--mask", mask, "--frontal", "--force", "-o",
                      folder / f"out.{suffix}", code=code).stderr

    check(b".exr or .tif" in fill("float", "png", 4))
    check(b".png or .tif" in fill("u8", "exr", 4))
    check(b"transparency" in fill("glass", "jpg", 4))
    # Before the work, in which it would be found that there is nothing to copy from.
    nothing = write(folder / "nothing.png", np.zeros((48, 64), np.uint8))
    recede("fill", images["glass"], "--mask", mask, "--source", nothing, "--frontal", "-o",
           folder / "never.jpg", code=4)
    check(b"reduced to 8" in fill("u16", "jpg", 0))
    check(b"32 bits" in fill("half", "tif", 0) and fill("half", "exr", 0) == b"")
    check(b"rounds every pixel" in fill("float", "hdr", 0))
    fill("rgba", "jpg", 0)
    check(read(folder / "out.jpg").shape == (48, 64, 3))
    check(b"use .png" in fill("u8", "webp", 4))
    fill("u8", "xyz", 4)
    fill("u8", "", 4)


def test_hdr_stays_outside_the_mask(folder):
    mask = write(folder / "mask.png", hole())
    image = write(folder / "in.hdr", np.abs(texture(kind="float")))
    done = recede("fill", image, "--mask", mask, "--frontal", "-o", folder / "out.hdr")
    check(done.stderr == b"", done.stderr)
    check(same_bits(outside(read(image), hole()), outside(read(folder / "out.hdr"), hole())))


def test_webp_is_read(folder):
    image = folder / "in.webp"
    check(harness.cv2.imwrite(str(image), texture(), [harness.cv2.IMWRITE_WEBP_QUALITY, 101]))
    recede("fill", image, "--mask", write(folder / "mask.png", hole()), "--frontal", "-q", "-o",
           folder / "out.png")
    check(same_bits(outside(read(image), hole()), outside(read(folder / "out.png"), hole())))


def test_the_suffix_of_an_input_may_lie(folder):
    mask = write(folder / "mask.png", hole())
    image = write(folder / "in.png", texture())
    image.rename(folder / "in.jpg")
    recede("fill", folder / "in.jpg", "--mask", mask, "--frontal", "-q", "-o", folder / "out.png")
    check(same_bits(outside(read(folder / "out.png"), hole()), outside(texture(), hole())))


TURNS = {  # Exif's number: what makes the seen picture of the stored one
    2: lambda p: p[:, ::-1], 3: lambda p: p[::-1, ::-1], 4: lambda p: p[::-1],
    5: lambda p: p.swapaxes(0, 1), 6: lambda p: np.rot90(p, -1),
    7: lambda p: np.rot90(p, 2).swapaxes(0, 1), 8: lambda p: np.rot90(p)}


def test_exif_turn(folder):
    """A stored picture with a tag gives the fill of the seen picture, stored again the same way."""
    stored, mask = texture(), hole()
    for number, turn in TURNS.items():
        image = write(folder / f"{number}.png", stored)
        subprocess.run(["exiftool", "-q", "-overwrite_original", f"-Orientation#={number}",
                        str(image)], check=True)
        seen = write(folder / "seen.png", np.ascontiguousarray(turn(stored)))
        seen_mask = write(folder / "seen-mask.png", np.ascontiguousarray(turn(mask)))
        stored_mask = write(folder / "mask.png", mask)
        options = ["--slant", "50", "-q", "--force", "-o"]
        recede("fill", seen, "--mask", seen_mask, *options, folder / "expected.png")
        recede("fill", image, "--mask", stored_mask, *options, folder / "out.png")
        after = read_stored(folder / "out.png")
        check(same_bits(np.ascontiguousarray(turn(after)), read(folder / "expected.png")), number)
        said = subprocess.run(["exiftool", "-s3", "-n", "-Orientation", str(folder / "out.png")],
                              capture_output=True, check=True, text=True).stdout.strip()
        check(said == str(number), "the tag became", said)
        if number >= 5:  # the seen mask has another size: it can be told apart
            recede("fill", image, "--mask", seen_mask, *options, folder / "out2.png")
            check(same_bits(read_stored(folder / "out2.png"), after), number)


def read_stored(path):
    flags = harness.cv2.IMREAD_UNCHANGED | harness.cv2.IMREAD_IGNORE_ORIENTATION
    return harness.cv2.imread(str(path), flags)


def test_smallest_pictures(folder):
    """From 1x1 on: a fill or a clear error, never anything else."""
    for height, width in ((1, 1), (1, 2), (2, 2), (3, 1), (4, 5), (8, 8), (9, 7), (16, 3)):
        pixels = texture(48, 64)[:height, :width]
        mask = np.zeros((height, width), np.uint8)
        mask[0, 0] = 255
        image = write(folder / "in.png", np.ascontiguousarray(pixels))
        done = recede("fill", image, "--mask", write(folder / "mask.png", mask), "--slant", "30",
                      "--force", "-o", folder / "out.png", code=None)
        check(done.returncode in (0, 1, 3), (height, width), done)
        check(done.returncode == 0 or len(done.stderr) > 20, done)
        recede("synthesize", image, "--size", "5x4", "--slant", "30", "--force", "-o",
               folder / "out.png", code=None)


if __name__ == "__main__":
    sys.exit(harness.main(globals()))
