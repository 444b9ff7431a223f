"""Files that are damaged, that lie, or that are no pictures: exit code 3 (5 where only too large),
within 10 s and 2 GB, and never a crash."""
import os
import random
import resource
import struct
import subprocess
import sys
import time
import zlib

import numpy as np

import harness
from harness import check, texture, write

MOST_BYTES = 2 << 30
MOST_SECONDS = 10


# libpng leaves OpenImageIO's code by longjmp on an error, and its strings are never freed.
LEAKS_OF_OTHERS = {"ASAN_OPTIONS": os.environ.get("ASAN_OPTIONS", "") + ":detect_leaks=0"}


def limit():
    if not harness.SANITIZED:  # ASan's shadow does not fit in any limit of addresses
        resource.setrlimit(resource.RLIMIT_AS, (MOST_BYTES, MOST_BYTES))
        resource.setrlimit(resource.RLIMIT_CPU, (MOST_SECONDS, MOST_SECONDS))


def commands(folder):
    return harness.Many(folder, prepare=limit, environment=LEAKS_OF_OTHERS)


def read_with(many, path):
    """Has the command read all pixels of the file; returns its exit code."""
    done = many.run("scale-map", path, "--frontal", "--force", "-q", "-o",
                    path.parent / "out.png")
    code, text = done.returncode, done.stderr.decode(errors="replace")
    check(code in (0, 3, 5), path.name, "ended with", code, text)
    check(code == 0 or "recede: " in text, path.name, "says nothing")
    return code


def refused(many, path, codes=(3,)):
    began = time.monotonic()
    code = read_with(many, path)
    check(code in codes, path.name, "ended with", code)
    check(time.monotonic() - began < 60, path.name, "took too long")


def originals(folder):
    """A sound file of every format, with noise so that nothing is long runs."""
    pixels = texture(40, 56)
    made = {}
    for suffix in ("png", "jpg", "tif", "exr", "bmp", "ppm"):
        kind = texture(40, 56, kind="half") if suffix == "exr" else pixels
        made[suffix] = write(folder / f"sound.{suffix}", kind, half=True).read_bytes()
    subprocess.run(["convert", str(folder / "sound.png"), "-interlace", "Plane",
                    str(folder / "progressive.jpg")], check=True)
    made["progressive.jpg"] = (folder / "progressive.jpg").read_bytes()
    subprocess.run(["convert", str(folder / "sound.png"), "-depth", "16", "-compress", "LZW",
                    str(folder / "lzw.tif")], check=True)
    made["lzw.tif"] = (folder / "lzw.tif").read_bytes()
    return made


def test_sound_files_are_read(folder):
    """Or else the tests below would prove nothing."""
    with commands(folder) as many:
        for suffix, data in originals(folder).items():
            path = folder / f"x.{suffix}"
            path.write_bytes(data)
            check(read_with(many, path) == 0, suffix)


def test_cut_files_are_refused(folder):
    with commands(folder) as many:
        for suffix, data in originals(folder).items():
            for part in (.01, .1, .3, .5, .7, .9, .97):
                path = folder / f"cut-{part}.{suffix}"
                path.write_bytes(data[:max(1, int(len(data) * part))])
                refused(many, path)


def damaged_files(folder, seed, count, damage):
    """Has files read that damage(random, number, bytes) makes of each sound one."""
    source = random.Random(seed)
    codes = {0: 0, 3: 0, 5: 0}
    with commands(folder) as many:
        for suffix, data in originals(folder).items():
            for number in range(count // 4 if harness.SANITIZED else count):
                path = folder / f"damaged.{suffix}"
                path.write_bytes(damage(source, number, bytearray(data)))
                try:
                    codes[read_with(many, path)] += 1
                except harness.Failure as failure:
                    raise harness.Failure(f"number {number}: {failure}") from None
    print(f"# {sum(codes.values())} files; exit codes {codes}", flush=True)
    check(codes[3] > 0, "no file was damaged enough to be refused")


def flip_bits(source, number, data):
    # Half of them in the first bytes, where the headers are.
    end = min(400, len(data)) if number % 2 else len(data)
    for _ in range(1 + number % 10 // 3):
        data[source.randrange(end)] ^= 1 << source.randrange(8)
    return data


def overwrite_a_block(source, number, data):
    length = source.randrange(4, 200)
    start = source.randrange(8, max(9, len(data) - length))
    data[start:start + length] = [b"\0" * length, b"\xff" * length,
                                  source.randbytes(length)][number % 3]
    return data


def take_out_or_double(source, number, data):
    start = source.randrange(8, len(data) - 60)
    piece = data[start:start + source.randrange(1, 50)]
    return data[:start] + (piece * 2 if number % 2 else b"") + data[start + len(piece):]


def test_flipped_bits(folder):
    damaged_files(folder, 1, 120, flip_bits)


def test_overwritten_blocks(folder):
    damaged_files(folder, 2, 56, overwrite_a_block)


def test_parts_taken_out_or_doubled(folder):
    damaged_files(folder, 3, 56, take_out_or_double)


def test_damaged_metadata(folder):
    """What is carried from file to file is read by our own code."""
    source = random.Random(7)
    mask = write(folder / "mask.png", np.eye(40, 56, dtype=np.uint8) * 255)
    for suffix in ("png", "jpg", "tif"):
        image = write(folder / f"in.{suffix}", texture(40, 56))
        subprocess.run(["exiftool", "-q", "-q", "-overwrite_original", "-Make=Acme", "-ISO=100",
                        "-GPSLatitude=12.5", "-XMP:Title=a", "-IPTC:Keywords=b", "-Artist=c",
                        f"-ThumbnailImage<={write(folder / 'small.jpg', texture(12, 16))}",
                        str(image)], check=True)
        data = image.read_bytes()
        with commands(folder) as many:
            for number in range(0, 16, 5 if harness.SANITIZED else 1):
                damaged = bytearray(data)
                # JPEG and PNG have them first (PNG after IHDR), TIFF last.
                last = len(data) if suffix == "tif" else 700
                for _ in range(1 + number // 4):
                    place = source.randrange(max(0, last - 700), last)
                    damaged[place] = source.choice((0, 255, 1, 127))
                image.write_bytes(damaged)
                out = folder / f"out.{('png', 'jpg', 'tif')[number % 3]}"
                done = many.run("fill", image, "--mask", mask, "--frontal", "-q", "--force", "-o",
                                out)
                check(done.returncode in (0, 3), suffix, number, "ended with", done.returncode)
                if done.returncode == 0:
                    harness.read(out)


def exif_of(entries):
    """A block of one folder; an entry: tag, type, count, value."""
    return (b"II*\0\x08\0\0\0" + struct.pack("<H", len(entries))
            + b"".join(struct.pack("<HHII", *entry) for entry in entries) + bytes(4))


def with_exif(path, pixels, block):
    data = write(path, pixels).read_bytes()
    if path.suffix == ".jpg":
        path.write_bytes(data[:2] + b"\xff\xe1" + struct.pack(">H", len(block) + 8) + b"Exif\0\0"
                         + block + data[2:])
    else:
        path.write_bytes(data[:33] + png_chunk(b"eXIf", block) + data[33:])
    return path


def test_exif_bombs(folder):
    """A few KB, of which gigabytes could be made."""
    pointers = [(tag, 4, 1, 8) for tag in (0x8769, 0x8825, 0xa005) for _ in range(150)]
    circle = exif_of(pointers + [(0x9000 + i, 4, 1, 8) for i in range(150)])
    # The same 50 KB are the value of each of 4000 entries; 65535 tags, all different, are there.
    shared = exif_of([(0x9000 + i, 7, 50000, 8) for i in range(4000)]) + bytes(2000)
    wide = exif_of([(i, 4, 1, 8) for i in range(65535) if i not in (274, 0x8769, 0x8825, 0xa005)])
    with commands(folder) as many:
        for suffix, block in (("jpg", circle), ("png", circle), ("jpg", shared), ("png", wide)):
            path = with_exif(folder / f"in.{suffix}", texture(40, 56), block)
            mask = with_exif(folder / "mask.png", np.eye(40, 56, dtype=np.uint8) * 255, block)
            began = time.monotonic()
            for target in ("tif", "png"):
                out = folder / f"out.{target}"
                done = many.run("fill", path, "--mask", mask, "--frontal", "--force", "-o", out)
                check(done.returncode == 0, suffix, len(block), done)
                check(out.stat().st_size < 10 << 20, suffix, len(block), target, "is too long")
                check(target == "png" or block == circle or b"Exif" in done.stderr, done)
            check(time.monotonic() - began < 20, suffix, len(block), "took too long")


def test_texts_beyond_measure(folder):
    """XMP of thumbnails, or of a name without an end, and many texts that are to be unpacked."""
    key = b"XML:com.adobe.xmp\0"
    most = 4 << 20
    thumbnails = b"<x>" + b"<a:Thumbnails/>" * (most // 15 - 9) + b"kept</x>"
    name = b"<x>" + b":Thumbnails" * (most // 11 - 9) + b"</x>"
    raw = b"Raw profile type exif\0\0" + zlib.compress(b"\nexif\n 2000000\n" + b"0" * 4000000, 9)
    texts = {"thumbnails": [(b"iTXt", key + b"\0\0\0\0" + thumbnails)],
             "name": [(b"iTXt", key + b"\0\0\0\0" + name)],
             "long": [(b"iTXt", key + b"\0\0\0\0" + thumbnails * 2)],
             "packed": [(b"iTXt", key + b"\1\0\0\0" + zlib.compress(name, 9))],
             "many": [(b"zTXt", raw)] * 30, "most": [(b"zTXt", raw)] * 500}
    plain = write(folder / "plain.png", texture(40, 56)).read_bytes()
    mask = write(folder / "mask.png", np.eye(40, 56, dtype=np.uint8) * 255)
    path, out = folder / "in.png", folder / "out.png"
    with commands(folder) as many:
        for what, chunks in texts.items():
            path.write_bytes(plain[:33] + b"".join(png_chunk(*one) for one in chunks) + plain[33:])
            done = many.run("fill", path, "--mask", mask, "--frontal", "--force", "-o", out)
            check(done.returncode == (3 if what == "most" else 0), what, done)
            if what == "most":
                check(b"500 compressed texts" in done.stderr, done)
                continue
            check((b"XMP" in done.stderr) == (what in ("long", "many")), what, done.stderr)
            check((b"<x>kept</x>" in out.read_bytes()) == (what == "thumbnails"), what)


def test_no_pictures(folder):
    contents = {"text": b"This is no picture.\n" * 50, "zeros": bytes(5000), "one": b"\x89",
                "html": b"<html><body>404</body></html>", "pdf": b"%PDF-1.4\n" + bytes(300),
                "elf": open("/proc/self/exe", "rb").read(5000), "gif": b"GIF89a" + bytes(50),
                "noise": random.Random(4).randbytes(3000), "newlines": b"\n" * 999}
    with commands(folder) as many:
        for name, content in contents.items():
            for suffix in ("png", "jpg", "tif", "tga"):
                path = folder / f"{name}.{suffix}"
                path.write_bytes(content)
                refused(many, path)


def png_chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def png_of(width, height, data, bits=8, colour=2):
    head = struct.pack(">IIBBBBB", width, height, bits, colour, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + png_chunk(b"IHDR", head) + png_chunk(b"IDAT", data)
            + png_chunk(b"IEND", b""))


def tiff_of(width, height):
    tags = [(256, 4, 1, width), (257, 4, 1, height), (258, 3, 1, 8), (259, 3, 1, 1),
            (262, 3, 1, 1), (273, 4, 1, 8), (277, 3, 1, 1), (278, 4, 1, height), (279, 4, 1, 99)]
    return (b"II*\0\x08\0\0\0" + struct.pack("<H", len(tags))
            + b"".join(struct.pack("<HHII", *tag) for tag in tags) + bytes(104))


def bombs(folder):
    small = zlib.compress(bytes(1000))
    jpeg = bytearray(originals(folder)["jpg"])
    frame = jpeg.index(b"\xff\xc0")
    jpeg[frame + 5:frame + 9] = struct.pack(">HH", 65500, 65500)
    exr = bytearray(originals(folder)["exr"])
    window = exr.index(b"dataWindow\0box2i\0") + len(b"dataWindow\0box2i\0") + 4
    exr[window:window + 16] = struct.pack("<iiii", 0, 0, 200000, 200000)
    bmp = bytearray(originals(folder)["bmp"])
    bmp[18:26] = struct.pack("<ii", 60000, 60000)
    return {"60000.png": png_of(60000, 60000, small),
            "most.png": png_of(2**31 - 1, 2**31 - 1, small),
            "wide.png": png_of(2**31 - 1, 1, small), "deep.png": png_of(50000, 50000, small, 16, 6),
            "60000.tif": tiff_of(60000, 60000), "most.tif": tiff_of(2**32 - 1, 2**32 - 1),
            "negative.tif": tiff_of(2**31, 2**31), "65500.jpg": bytes(jpeg), "wide.exr": bytes(exr),
            "60000.bmp": bytes(bmp), "60000.ppm": b"P6\n60000 60000\n255\n" + bytes(100),
            "most.ppm": b"P6\n2147483647 2147483647\n255\n" + bytes(100),
            "60000.hdr": b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 60000 +X 60000\n" + bytes(99)}


def test_bombs_are_refused(folder):
    with commands(folder) as many:
        for name, data in bombs(folder).items():
            path = folder / name
            path.write_bytes(data)
            refused(many, path, codes=(3, 5))


def test_a_true_bomb_takes_no_memory(folder):
    """20000 x 20000 px of zeros in 1.2 MB: sound, and refused by the limit, not by exhaustion."""
    packer = zlib.compressobj(9)
    row = bytes(20000 * 3 + 1)
    data = b"".join(packer.compress(row) for _ in range(20000)) + packer.flush()
    path = folder / "true.png"
    path.write_bytes(png_of(20000, 20000, data))
    with commands(folder) as many:
        refused(many, path, codes=(5,))


def test_progressive_bombs(folder):
    """Decoders begin to decode these when they are opened, and keep all coefficients: the size with
    these, and the passes over the picture, are looked at before."""
    data = originals(folder)["progressive.jpg"]
    frame, scan = data.index(b"\xff\xc2"), data.rindex(b"\xff\xda")
    huge = folder / "huge.jpg"
    huge.write_bytes(data[:frame + 5] + struct.pack(">HH", 65500, 65500) + data[frame + 9:])
    many_scans = folder / "scans.jpg"
    many_scans.write_bytes(data[:scan] + data[scan:-2] * 300 + b"\xff\xd9")
    with commands(folder) as many:
        for path, code, word in ((huge, 5, b"65500 x 65500"), (many_scans, 3, b"scans")):
            done = many.run("orient", path, "--frontal")
            check(done.returncode == code and word in done.stderr, path.name, done)
        large = folder / "large.jpg"
        subprocess.run(["convert", "-size", "2000x2000", "gradient:red-blue", "-interlace", "Plane",
                        str(large)], check=True)
        for memory, code in ((12, 5), (99, 0)):  # 11.4 MiB of pixels, and twice that
            done = many.run("orient", large, "--frontal", "--memory", memory)
            check(done.returncode == code, memory, done)


def test_stray_bytes_between_segments(folder):
    """Decoders skip them, and so it is no sign that the file was cut."""
    data = originals(folder)["jpg"]
    tables = data.index(b"\xff\xdb")
    path = folder / "stray.jpg"
    path.write_bytes(data[:tables] + b"\0\1\xff\0\2" + data[tables:])
    with commands(folder) as many:
        check(read_with(many, path) == 0)
        path.write_bytes(path.read_bytes()[:-2])
        refused(many, path)


def test_large_plain_masks_are_read(folder):
    """Drawn masks pack best: what counts is what is packed, a byte a pixel and less."""
    packed = zlib.compress(bytes(6001) * 4000, 9)
    plain = png_of(6000, 4000, packed, 8, 3)
    path = folder / "indexed.png"
    path.write_bytes(plain[:33] + png_chunk(b"PLTE", bytes(3)) + plain[33:])
    with commands(folder) as many:
        done = many.run("orient", path, "--frontal")
        check(done.returncode == 0, done)


def test_a_cut_mask_is_refused(folder):
    mask = np.full((40, 56), 255, np.uint8)
    mask[:30] = 0
    image = write(folder / "in.png", texture(40, 56))
    data = write(folder / "mask.png", mask).read_bytes()
    (folder / "mask.png").write_bytes(data[:len(data) // 2])
    harness.recede("fill", image, "--mask", folder / "mask.png", "--frontal", "-o",
                   folder / "out.png", code=3)


if __name__ == "__main__":
    sys.exit(harness.main(globals()))
