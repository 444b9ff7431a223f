"""Profile, Exif, XMP, IPTC, turn, resolution and depth go with the picture; nothing of ours."""
import base64
import json
import re
import struct
import subprocess
import sys
import zlib
from pathlib import Path

import numpy as np

import harness
from harness import check, hole, read, recede, same_bits, texture, write

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
    return recede("fill", image, "--mask", mask, "--slant", "30", "--quality", "draft", "-o", out,
                  "-q", "--force", *more)


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


SMALL = b"\xff\xd8\xff\xdb" + bytes(range(7, 250)) * 3  # stands for a small picture of the old one


def hides(path):
    """Whether the file holds SMALL, as it is, in base64 or as hexadecimal digits, packed or not."""
    data = path.read_bytes()
    for name, chunk in png_chunks(data):
        if name == b"zTXt":
            data += zlib.decompress(chunk.split(b"\0", 1)[1][1:])
        if name == b"iTXt":
            data += unpacked(chunk)
    plain = re.sub(rb"\s", b"", data)
    words = (SMALL, base64.b64encode(SMALL), SMALL.hex().encode(), SMALL.hex().upper().encode())
    return any(word in plain or word in data for word in words)


def unpacked(chunk):
    try:
        return zlib.decompress(chunk.split(b"\0", 1)[1].split(b"\0", 3)[-1])
    except zlib.error:
        return b""


def png_chunks(data):
    at = 8 if data.startswith(b"\x89PNG") else len(data)
    while at < len(data):
        length = int.from_bytes(data[at:at + 4], "big")
        yield data[at + 4:at + 8], data[at + 8:at + 8 + length]
        at += 12 + length


def with_chunk(path, name, data):
    """Puts a chunk after a PNG's first."""
    plain = path.read_bytes()
    chunk = struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    path.write_bytes(plain[:33] + chunk + plain[33:])
    return path


def test_pictures_in_xmp_go(folder):
    small = folder / "small.bin"
    small.write_bytes(SMALL)
    for suffix in ("jpg", "png", "tif"):
        image = write(folder / f"in.{suffix}", texture())
        subprocess.run(["exiftool", "-q", "-overwrite_original", "-XMP:Title=a street",
                        f"-XMP-xmp:ThumbnailImage<={small}", str(image)], check=True)
        check(hides(image), "the test's own input hides nothing")
        for target in ("jpg", "png", "tif"):
            fill(folder, image, folder / f"out.{target}")
            check(not hides(folder / f"out.{target}"), suffix, "to", target)
            check(metadata(folder / f"out.{target}").get("Title") == "a street", suffix, target)


def test_pictures_in_packed_or_terse_xmp_go(folder):
    text = base64.b64encode(SMALL).decode()
    kinds = {"element": f"<a:image_b>1</a:image_b><q:Thumbnails><z>{text}</z></q:Thumbnails>",
             "attribute": f"<rdf:li xmpGImg:image = '{text}' xmpGImg:width='9'/>",
             "original": f"<GImage:Data>{text}</GImage:Data>",
             "depths": f"<GDepth:Data>{text}</GDepth:Data>",
             "unclosed": f"<xmpGImg:image>{text}"}
    for name, inside in kinds.items():
        xmp = f"<x:xmpmeta><dc:title>kept</dc:title>{inside}</x:xmpmeta>".encode()
        for packed in (False, True):
            data = b"XML:com.adobe.xmp\0" + bytes([packed, 0]) + b"en\0\0"
            data += zlib.compress(xmp) if packed else xmp
            image = with_chunk(write(folder / "in.png", texture()), b"iTXt", data)
            check(hides(image), "the test's own input hides nothing")
            done = recede("fill", image, "--mask", write(folder / "mask.png", hole()), "--frontal",
                          "--force", "-o", folder / "out.png")
            check(not hides(folder / "out.png"), name, packed)
            whole = name != "unclosed"
            check(whole == (b"kept</dc:title>" in (folder / "out.png").read_bytes()), name, packed)
            check(whole != (b"XMP" in done.stderr), name, done.stderr)


def exif_block(folder, turn):
    """A block with Exif's mark, this turn, and SMALL as its thumbnail."""
    carrier = write(folder / "carrier.jpg", texture())
    (folder / "small.bin").write_bytes(SMALL)
    subprocess.run(["exiftool", "-q", "-overwrite_original", f"-Orientation#={turn}", "-Make=Acme",
                    f"-ThumbnailImage<={folder / 'small.bin'}", str(carrier)], check=True)
    data = carrier.read_bytes()
    start = data.index(b"Exif\0\0")
    return data[start:start + int.from_bytes(data[start - 2:start], "big") - 2]


def test_exif_as_a_text(folder):
    """As ImageMagick writes it into PNG: it turns once, and its thumbnail goes."""
    block = exif_block(folder, 6)
    body = f"\nexif\n{len(block):8}\n".encode()
    body += b"\n".join(block.hex().encode()[at:at + 72] for at in range(0, 2 * len(block), 72))
    key = b"Raw profile type exif\0"
    mask = write(folder / "seen-mask.png", np.rot90(hole(), -1))
    for name, data in ((b"tEXt", key + body), (b"zTXt", key + b"\0" + zlib.compress(body)),
                       (b"iTXt", key + b"\1\0\0\0" + zlib.compress(body))):
        image = with_chunk(write(folder / "in.png", texture()), name, data)
        check(hides(image), "the test's own input hides nothing")
        for target in ("png", "tif"):
            out = folder / f"out.{target}"
            recede("fill", image, "--mask", mask, "--frontal", "--force", "-q", "-o", out)
            said = metadata(out)
            check(said.get("Orientation") == 6 and said.get("Make") == "Acme", target, said)
            check(b"Raw profile" not in out.read_bytes() and not hides(out), name, target)
        stored = harness.cv2.imread(str(folder / "out.png"), harness.cv2.IMREAD_COLOR
                                    | harness.cv2.IMREAD_IGNORE_ORIENTATION)
        check(same_bits(stored[hole() == 0], texture()[hole() == 0]), name)
    image = with_chunk(write(folder / "in.png", texture()), b"tEXt", key + b"\nexif\n 99\n00")
    done = recede("fill", image, "--mask", write(folder / "mask.png", hole()), "--frontal",
                  "--force", "-o", folder / "out.png")
    check(b"Exif" in done.stderr, "a damaged text vanished silently")


def test_layers_of_a_tiff_go(folder):
    """Photoshop's tag 37724 holds the old picture. Put in by hand: exiftool does not write it."""
    image = write(folder / "in.tif", texture())
    data = bytearray(image.read_bytes())
    check(data[:2] == b"II", "the test's own input is of the other order")
    first = int.from_bytes(data[4:8], "little")
    count = int.from_bytes(data[first:first + 2], "little")
    entries = data[first + 2:first + 2 + 12 * count]
    layers = len(data)
    data += SMALL + bytes(len(SMALL) % 2)
    data[4:8] = struct.pack("<I", len(data))
    data += struct.pack("<H", count + 1) + entries
    data += struct.pack("<HHII", 37724, 7, len(SMALL), layers) + bytes(4)
    image.write_bytes(data)
    fill(folder, image, folder / "out.tif")
    check(hides(image) and not hides(folder / "out.tif"))


def test_xmp_alone_turns_nothing(folder):
    """Viewers turn by Exif, whatever XMP says beside it or alone."""
    for suffix in ("png", "jpg", "tif"):
        for exif in (None, 3):
            image = write(folder / f"in.{suffix}", texture())
            plain = folder / f"plain.{suffix}"
            turn = [f"-Orientation#={exif}"] if exif else []
            for more, path in (([], plain), (["-XMP-tiff:Orientation#=6"], image)):
                path.write_bytes(image.read_bytes())
                subprocess.run(["exiftool", "-q", "-overwrite_original", "-Make=Acme", *turn, *more,
                                str(path)], check=True)
            for target in ("bmp",) if harness.SANITIZED else ("png", "tif", "bmp", "tga"):
                pixels = []
                for path in (plain, image):
                    fill(folder, path, folder / f"out.{target}")
                    fill(folder, folder / f"out.{target}", folder / "again.ppm")  # as it is seen
                    pixels.append((folder / "again.ppm").read_bytes())
                check(pixels[0] == pixels[1], suffix, exif, target)
            fill(folder, image, folder / "out.tif")
            said = subprocess.run(["exiftool", "-s3", "-n", "-EXIF:Orientation",
                                   str(folder / "out.tif")], capture_output=True, check=True).stdout
            check(said.strip() in ((b"3",) if exif else (b"", b"1")), suffix, exif, said)


def test_webp_brings_its_metadata(folder):
    image = folder / "in.webp"
    check(harness.cv2.imwrite(str(image), texture(), [harness.cv2.IMWRITE_WEBP_QUALITY, 101]))
    tag(image, folder)
    before = metadata(image)
    for target in ("png", "tif", "jpg"):
        fill(folder, image, folder / f"out.{target}")
        check_kept(before, metadata(folder / f"out.{target}"), f"webp to {target}:",
                   [name for name in KEPT if "Resolution" not in name])
    stored = harness.cv2.imread(str(folder / "out.png"), harness.cv2.IMREAD_IGNORE_ORIENTATION
                                | harness.cv2.IMREAD_COLOR)
    check(same_bits(stored[hole() == 0], texture()[hole() == 0]), "not stored as it was")


def test_what_is_lost_is_said(folder):
    mask = write(folder / "mask.png", hole())
    images = [write(folder / "in.jpg", texture()), write(folder / "float.tif",
                                                         texture(kind="float"))]
    for image, targets in zip(images, (("bmp", "ppm", "tga"), ("exr",))):
        for profiled in (False, True):
            if profiled:
                subprocess.run(["exiftool", "-q", "-overwrite_original",
                                f"-ICC_Profile<={profile(folder)}", str(image)], check=True)
            for target in (*targets, image.suffix[1:]):
                done = recede("fill", image, "--mask", mask, "--frontal", "--force", "-o",
                              folder / f"out.{target}")
                lost = profiled and target in targets
                check((b"profile" in done.stderr) == lost, image.name, target, done.stderr)


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
