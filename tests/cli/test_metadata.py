"""Profile, Exif, XMP, IPTC, turn, resolution and depth go with the picture; nothing of ours."""
import json
import subprocess
import sys
from pathlib import Path

import numpy as np

import harness
from harness import check, hole, read, recede, texture, write

sys.path.insert(0, str(Path(__file__).parents[1] / "lib"))
import icc  # noqa: E402 - found by then

TAGS = {"Orientation#": 6, "XResolution": 240, "YResolution": 240, "ResolutionUnit": "inches",
        "Make": "Acme", "Model": "X", "ExposureTime": "1/60", "FNumber": 8, "ISO": 200,
        "Artist": "Ann", "Copyright": "CC0", "GPSLatitude": 12.5, "GPSLatitudeRef": "N",
        "DateTimeOriginal": "2020:02:02 10:00:00", "XMP:Title": "a street"}
KEPT = ["Orientation", "XResolution", "YResolution", "ResolutionUnit", "Make", "Model",
        "ExposureTime", "FNumber", "ISO", "Artist", "Copyright", "GPSLatitude", "DateTimeOriginal",
        "Title", "ICC_Profile"]


def profile(folder):
    path = folder / "recede.icc"
    path.write_bytes(icc.rgb_profile())
    return path


def tag(path, folder, *more):
    arguments = [f"-{name}={value}" for name, value in TAGS.items()]
    subprocess.run(["exiftool", "-q", "-q", "-overwrite_original", *arguments, *more,
                    f"-ICC_Profile<={profile(folder)}", str(path)], check=True)
    return path


def metadata(path):
    names = [f"-{name}" for name in KEPT + ["Software", "ModifyDate", "Keywords", "Comment",
                                            "ThumbnailImage", "Error", "Warning", "BitsPerSample",
                                            "BitDepth"]]
    said = subprocess.run(["exiftool", "-j", "-n", "-b", *names, str(path)], capture_output=True,
                          check=True).stdout
    return json.loads(said)[0]


def fill(folder, image, out, *more):
    mask = write(folder / "mask.png", hole())
    return recede("fill", image, "--mask", mask, "--slant", "30", "-o", out, "-q", "--force", *more)


def check_kept(before, after, what, names=tuple(KEPT)):
    for name in names:
        check(name in before, what, "the test's own input lacks", name)
        check(before[name] == after.get(name), what, name, "was", before[name], "is",
              after.get(name))
    for name in ("Software", "ModifyDate", "Error", "Warning"):
        check(name not in after, what, name, "appeared:", after.get(name))


def test_between_all_formats(folder):
    sources = [("png", "u8"), ("png", "u16"), ("jpg", "u8"), ("tif", "u8"), ("tif", "u16")]
    for suffix, kind in sources:
        image = tag(write(folder / f"in.{suffix}", texture(kind=kind)), folder)
        before = metadata(image)
        for target in ("png", "jpg", "tif"):
            out = folder / f"out.{target}"
            fill(folder, image, out)
            check_kept(before, metadata(out), f"{suffix} {kind} to {target}:")


def test_float_tiff(folder):
    image = tag(write(folder / "in.tif", texture(kind="float")), folder)
    fill(folder, image, folder / "out.tif")
    check_kept(metadata(image), metadata(folder / "out.tif"), "float tif")
    check(read(folder / "out.tif").dtype == np.float32)


def test_exr_attributes(folder):
    """cv2 and exiftool write none into EXR: one is put in by hand, after the first attribute."""
    path = write(folder / "in.exr", texture(kind="half"), half=True)
    plain = path.read_bytes()
    head, rest = plain[:8], plain[8:]
    extra = b"owner\0string\0\x03\0\0\0Ann"
    extra += b"isoSpeed\0float\0\x04\0\0\0\0\0\x48\x43"
    end = rest.index(b"screenWindowWidth\0float\0") + len(b"screenWindowWidth\0float\0") + 8
    table = rest[end + 1:]
    # The table of scan lines follows the header: its offsets move with what was put in.
    first = int.from_bytes(table[:8], "little")
    count = (first - len(head) - end - 1) // 8
    moved = b"".join((int.from_bytes(table[8 * i:8 * i + 8], "little") + len(extra)
                      ).to_bytes(8, "little") for i in range(count))
    path.write_bytes(head + extra + rest[:end + 1] + moved + table[8 * count:])
    fill(folder, path, folder / "out.exr")
    said = json.loads(subprocess.run(["exiftool", "-j", "-n", str(folder / "out.exr")],
                                     capture_output=True, check=True).stdout)[0]
    check("Ann" in said.values() and 200.0 in said.values(), said)
    check("DateTimeOriginal" not in said and "Software" not in said, said)


def test_iptc_and_comments(folder):
    image = tag(write(folder / "in.jpg", texture()), folder, "-IPTC:Keywords=stones",
                "-Comment=by hand")
    for target in ("jpg", "tif"):
        fill(folder, image, folder / f"out.{target}")
        check(metadata(folder / f"out.{target}").get("Keywords") == "stones", target)
    check(metadata(folder / "out.jpg").get("Comment") == "by hand")
    image = tag(write(folder / "in.png", texture()), folder, "-PNG:Comment=by hand")
    fill(folder, image, folder / "out.png")
    check(metadata(folder / "out.png").get("Comment") == "by hand")


def test_big_endian_exif(folder):
    image = folder / "in.jpg"
    write(image, texture())
    subprocess.run(["exiftool", "-q", "-overwrite_original", "-ExifByteOrder=MM", "-Make=Acme",
                    "-ExposureTime=1/60", "-GPSLatitude=12.5", str(image)], check=True)
    before = metadata(image)
    for target in ("jpg", "png", "tif"):
        fill(folder, image, folder / f"out.{target}")
        check_kept(before, metadata(folder / f"out.{target}"), target,
                   ("Make", "ExposureTime", "GPSLatitude"))


def test_the_thumbnail_goes(folder):
    """It would show what was removed."""
    image = write(folder / "in.jpg", texture())
    small = write(folder / "small.jpg", texture(12, 16))
    tag(image, folder, f"-ThumbnailImage<={small}")
    check("ThumbnailImage" in metadata(image), "the test's own input has none")
    for target in ("jpg", "png", "tif"):
        fill(folder, image, folder / f"out.{target}")
        check("ThumbnailImage" not in metadata(folder / f"out.{target}"), target)
        check(small.read_bytes()[-300:] not in (folder / f"out.{target}").read_bytes(), target)


def test_depth(folder):
    for suffix, kind, bits in (("png", "u8", 8), ("png", "u16", 16), ("tif", "u16", 16)):
        out = folder / f"out-{kind}.{suffix}"
        fill(folder, write(folder / f"in.{suffix}", texture(kind=kind)), out)
        said = metadata(out)
        check(str(said.get("BitDepth", said.get("BitsPerSample"))).split()[0] == str(bits), said)


def test_nothing_is_added(folder):
    for suffix in ("png", "jpg", "tif"):
        out = folder / f"out.{suffix}"
        fill(folder, write(folder / f"in.{suffix}", texture()), out)
        said = metadata(out)
        for name in KEPT + ["Software", "ModifyDate", "Comment", "Error", "Warning"]:
            # TIFF always says how it is turned (not at all), JPEG how its pixels are shaped.
            if name not in ("XResolution", "YResolution", "ResolutionUnit", "Orientation"):
                check(name not in said, suffix, name, "appeared:", said.get(name))


def test_a_synthesis_is_another_picture(folder):
    """Its profile and resolution are the exemplar's, not its Exif, its place and its title."""
    image = tag(write(folder / "in.png", texture()), folder)
    for target in ("png", "tif", "jpg"):
        out = folder / f"out.{target}"
        recede("synthesize", image, "--size", "70x50", "--frontal", "-q", "-o", out)
        said = metadata(out)
        check(said.get("ICC_Profile") == metadata(image)["ICC_Profile"], target)
        check(said.get("Orientation", 1) == 1, target, "is turned")
        for name in ("Make", "GPSLatitude", "Title", "Error", "Warning"):
            check(name not in said, target, name, "stayed:", said.get(name))


if __name__ == "__main__":
    sys.exit(harness.main(globals()))
