"""Alpha: transparent pixels are no source, colours stay multiplied or plain as they were stored."""
import struct
import subprocess
import sys

import numpy as np

import harness
from harness import check, hole, read, recede, report_of, same_bits, texture, write


def outside(pixels, mask):
    return np.ascontiguousarray(pixels[mask == 0])


def half_transparent():
    """A picture with colours stored times alpha, which is .5 at its right."""
    pixels = texture(channels=4, kind="float").clip(.05, 1)
    pixels[:, 44:, 3] = .5
    pixels[:, 44:, :3] *= .5
    return pixels


def test_transparent_pixels_are_never_a_source(folder):
    pixels = texture(channels=4)
    pixels[:, :16, :3] = (0, 0, 255)  # a colour that is nowhere else
    pixels[:, :16, 3] = 0
    for suffix in ("png", "tif"):
        image = write(folder / f"in.{suffix}", pixels)
        out = folder / f"out.{suffix}"
        recede("fill", image, "--mask", write(folder / "mask.png", hole()), "--frontal", "-q", "-o",
               out)
        filled = read(out)[hole() > 0].astype(int)
        check((filled[:, 3] == 255).all(), "the fill is not opaque")
        check(not ((filled[:, 2] - filled[:, 1]) > 100).any(), "hidden colour was copied")
        # cv2 multiplies a TIFF's colours by alpha: only the opaque ones can be compared.
        opaque = (hole() == 0) & (pixels[:, :, 3] == 255)
        check(same_bits(pixels[opaque], read(out)[opaque]), suffix)
    hidden = subprocess.run(["convert", str(folder / "out.tif") + "[1x1+0+0]", "txt:"], check=True,
                            capture_output=True, text=True).stdout
    check("(255,0,0,0)" in hidden, "the colour under alpha 0 changed:", hidden)


def test_premultiplied_colours(folder):
    """In EXR colours are stored times alpha: what is not filled keeps its bits all the same."""
    image = write(folder / "in.exr", half_transparent())
    recede("fill", image, "--mask", write(folder / "mask.png", hole()), "--frontal", "-q", "-o",
           folder / "out.exr")
    after = read(folder / "out.exr")
    check(same_bits(outside(read(image), hole()), outside(after, hole())))
    check((after[hole() > 0][:, 3] == 1).all(), "the fill is not opaque")


def write_tiff(path, rgba, extra_samples, big=False):
    """cv2 cannot say what its alpha means: the plainest TIFF of float RGBA, by hand; or BigTIFF."""
    height, width = rgba.shape[:2]
    data = rgba[:, :, [2, 1, 0, 3]].astype("<f4").tobytes()
    tags = [(256, 3, 1, width), (257, 3, 1, height), (258, 3, 4, 8), (259, 3, 1, 1),
            (262, 3, 1, 2), (273, 4, 1, 24), (277, 3, 1, 4), (278, 3, 1, height),
            (279, 4, 1, len(data)), (284, 3, 1, 1), (338, 3, 1, extra_samples), (339, 3, 4, 16)]
    if big:
        values = {258: 0x20002000200020, 339: 0x3000300030003, 273: 16}
        tags = [(tag, kind, count, values.get(tag, value)) for tag, kind, count, value in tags]
        tags.append((315, 2, 4, int.from_bytes(b"Ann", "little")))
        tags.sort()
        folder = struct.pack("<Q", len(tags)) + b"".join(struct.pack("<HHQQ", *t) for t in tags)
        head = b"II+\0" + struct.pack("<HHQ", 8, 0, 16 + len(data))
        path.write_bytes(head + data + folder + bytes(8))
        return path
    folder = struct.pack("<H", len(tags)) + b"".join(struct.pack("<HHII", *tag) for tag in tags)
    head = b"II*\0" + struct.pack("<I8H", 24 + len(data), 32, 32, 32, 32, 3, 3, 3, 3)
    path.write_bytes(head + data + folder + bytes(4))
    return path


def test_gray_with_alpha_into_bmp(folder):
    """BMP has no gray with alpha, but RGB with alpha."""
    gray = texture()[:, :, 1]
    alpha = np.full_like(gray, 255)
    alpha[:, :9] = 100
    write(folder / "rgba.png", np.dstack([gray, gray, gray, alpha]))
    image = folder / "in.png"
    subprocess.run(["convert", folder / "rgba.png", "-define", "png:color-type=4", image],
                   check=True)
    mask = write(folder / "mask.png", hole())
    for suffix in ("png", "bmp"):
        recede("fill", image, "--mask", mask, "--frontal", "-o", folder / f"out.{suffix}")
    subprocess.run(["convert", folder / "out.bmp", "png32:" + str(folder / "bmp.png")], check=True)
    subprocess.run(["convert", folder / "out.png", "png32:" + str(folder / "png.png")], check=True)
    check(same_bits(read(folder / "bmp.png"), read(folder / "png.png")))
    check(read(folder / "bmp.png")[5, 5, 3] == 100, "no alpha")


def test_webp_with_transparency_is_refused(folder):
    """Its reader darkens the colours; without transparency, or all opaque, it is read."""
    pixels = texture(channels=4)
    for alpha, code in ((200, 3), (255, 0)):
        pixels[:, :9, 3] = alpha
        image = folder / "in.webp"
        check(harness.cv2.imwrite(str(image), pixels, [harness.cv2.IMWRITE_WEBP_QUALITY, 101]))
        mask = write(folder / "mask.png", hole())
        plain = write(folder / "in.png", texture())
        done = recede("fill", image, "--mask", mask, "--frontal", "-o", folder / "out.png",
                      code=code)
        check(code == 0 or b"save it as .png" in done.stderr, done.stderr)
        done = recede("orient", plain, "--frontal", "--mask", image, code=code)
        check(code == 0 or b"save it as .png" in done.stderr, done.stderr)


def test_premultiplied_exemplars(folder):
    """An exemplar of multiplied colours is the middle of the result bit for bit, and what lies
    around is as bright as it."""
    pixels = half_transparent()
    pixels[..., 3] = .5
    pixels[:, :44, :3] *= .5
    files = {"exr": write(folder / "in.exr", pixels),
             "tif": write_tiff(folder / "in.tif", pixels, 1)}
    for suffix, image in files.items():
        out = folder / f"out.{suffix}"
        for size, inner, outer in (("120x90", np.s_[21:69, 28:92], np.s_[:]),
                                   ("50x31", np.s_[:], np.s_[8:39, 7:57])):
            recede("synthesize", image, "--size", size, "--frontal", "-q", "--force", "-o", out)
            if suffix == "exr":
                after = read(out)
            else:  # cv2 would multiply once more
                recede("synthesize", image, "--size", size, "--frontal", "-q", "--force", "-o",
                       folder / "as.exr")
                after = read(folder / "as.exr")
            check(same_bits(np.ascontiguousarray(after[inner]),
                            np.ascontiguousarray(pixels[outer])), suffix, size,
                  "the exemplar is not the middle")
            plain = after[..., :3] / after[..., 3:]
            check(abs(plain.mean() - (pixels[..., :3] / .5).mean()) < .1, suffix, size,
                  "what lies around is not as bright")


def test_orient_reads_what_fill_reads(folder):
    """Colours times alpha show an edge where alpha has one: the plane is read from the colours."""
    plain = texture(192, 256, channels=4, kind="float").clip(.05, 1)
    plain[:, :, 3] = np.linspace(.02, 1, 256)[None] ** 2
    multiplied = plain.copy()
    multiplied[:, :, :3] *= multiplied[:, :, 3:]
    a = write_tiff(folder / "plain.tif", plain, 2)
    b = write_tiff(folder / "multiplied.tif", multiplied, 1)
    found = [recede("orient", path, code=None).stdout for path in (a, b)]
    check(found[0] == found[1], "read from the multiplied colours", found)


def test_alpha_keeps_its_kind(folder):
    """Plain stays plain and multiplied multiplied; into EXR colours are multiplied."""
    pixels = texture(channels=4, kind="float").clip(.05, 1)
    pixels[:, 44:, 3] = .5
    write(folder / "mask.png", hole())
    for name, extra_samples, big in (("Unassociated", 2, False), ("Associated", 1, False),
                                     ("Unassociated", 2, True), ("Associated", 1, True)):
        image = write_tiff(folder / f"{name}.tif", pixels, extra_samples, big)
        for suffix in ("tif", "exr"):
            recede("fill", image, "--mask", folder / "mask.png", "--frontal", "-q", "-o",
                   folder / f"{name}-out.{suffix}", "--force")
        said = subprocess.run(["exiftool", "-s3", "-ExtraSamples", "-Artist",
                               str(folder / f"{name}-out.tif")],
                              capture_output=True, check=True, text=True).stdout
        check(said.startswith(name) and ("Ann" in said) == big, name, big, "became", said)
        expected = pixels.copy()
        if name == "Unassociated":
            expected[:, :, :3] *= expected[:, :, 3:]
        check(same_bits(outside(expected, hole()),
                        outside(read(folder / f"{name}-out.exr"), hole())), name)


if __name__ == "__main__":
    sys.exit(harness.main(globals()))
