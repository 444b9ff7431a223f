"""What is left out of the output: what would show the old picture, and what has no place."""
import struct
import sys

import harness
from harness import check, hole, recede, texture, write
from test_malformed import with_exif
from test_metadata import SMALL, fill, hides, metadata, with_chunk


def folder_of(at, entries, following=0):
    """A folder at this place, the values behind it; an entry: tag, type, numbers or bytes. Where
    the next begins, if there is one, is behind all of it."""
    heads, values = b"", b""
    start = at + 2 + 12 * len(entries) + 4
    for tag, kind, value in sorted(entries):
        size = {2: 1, 3: 2, 4: 4, 7: 1}[kind]
        data = value if isinstance(value, bytes) else struct.pack(
            f"<{len(value)}{' HI'[size // 2]}", *value)
        head = struct.pack("<HHI", tag, kind, len(data) // size)
        if len(data) > 4:
            head += struct.pack("<I", start + len(values))
            values += data + bytes(len(data) % 2)
        else:
            head += data.ljust(4, b"\0")
        heads += head
    made = struct.pack("<H", len(entries)) + heads
    return made + struct.pack("<I", start + len(values) if following else 0) + values


def block_of(kind):
    """A block with SMALL as another picture: in strips, in tiles, in a third folder, in one below,
    or in the first."""
    size = len(SMALL)
    parts = [size // 3, size // 3, size - 2 * (size // 3)]
    most = 4000  # SMALL is there, in this order
    offsets = [most, most + parts[0], most + 2 * parts[0]]
    make = (271, 2, b"Acme\0\0")
    whole = [(513, 4, [most]), (514, 4, [size])]
    folders = {"strips": [[make], [(273, 4, offsets), (279, 3, parts)]],
               "tiles": [[make], [(324, 4, offsets), (325, 4, parts)]],
               "third": [[make], [(296, 3, [2])], whole],
               "short": [[make], [(273, 3, offsets), (279, 4, parts)]],
               "below": [[make, (330, 4, [2000])]],
               "first": [[make, *whole]]}[kind]
    data = b"II*\0\x08\0\0\0"
    for i, entries in enumerate(folders):
        data += folder_of(len(data), entries, i + 1 < len(folders))
    if kind == "below":
        data = data.ljust(2000, b"\0") + folder_of(2000, whole)
    return data.ljust(most, b"\0") + SMALL


def test_thumbnails_of_every_kind_go(folder):
    for kind in ("strips", "tiles", "third", "short", "below", "first"):
        for suffix in ("jpg", "png"):
            image = with_exif(folder / f"in.{suffix}", texture(), block_of(kind))
            check(hides(image), "the test's own input hides nothing")
            for target in ("jpg", "png", "tif"):
                fill(folder, image, folder / f"out.{target}")
                check(not hides(folder / f"out.{target}"), kind, suffix, "to", target)
                check(metadata(folder / f"out.{target}").get("Make") == "Acme", kind, target)


def test_what_a_tiff_left_in_exif_blanks_nothing(folder):
    """Strips in the first folder, which were where the Exif block has other things."""
    block = b"II*\0\x08\0\0\0"
    block += folder_of(8, [(271, 2, b"Acme\0\0"), (273, 4, [8]), (279, 4, [99999])])
    image = with_exif(folder / "in.jpg", texture(), block)
    fill(folder, image, folder / "out.jpg")
    check(metadata(folder / "out.jpg").get("Make") == "Acme")


def test_exif_of_too_many_folders_goes(folder):
    """Not all of its thumbnails would be found: it is said, and the turn counts."""
    block = b"II*\0\x08\0\0\0" + folder_of(8, [(271, 2, b"Acme\0\0"), (274, 3, [3])], 1)
    for i in range(40):
        block += folder_of(len(block), [(296, 3, [2])], i < 39)
    image = with_exif(folder / "in.jpg", texture(), block)
    mask = write(folder / "mask.png", hole())
    done = recede("fill", image, "--mask", mask, "--frontal", "--force", "-o", folder / "out.jpg")
    check(b"Exif" in done.stderr and b"Acme" not in (folder / "out.jpg").read_bytes(), done)
    before, after = (harness.read(path).astype(int) for path in (image, folder / "out.jpg"))
    check(abs(before[:12] - after[::-1, ::-1][:12]).mean() < 6, "is not stored as it is seen")


def test_comments_without_a_place_are_said(folder):
    mask = write(folder / "mask.png", hole())
    plain = write(folder / "plain.jpg", texture()).read_bytes()
    comment = folder / "comment.jpg"
    comment.write_bytes(plain[:2] + b"\xff\xfe\0\x09by hand" + plain[2:])
    text = with_chunk(write(folder / "text.png", texture()), b"tEXt", b"Comment\0by hand")
    for image, home in ((comment, "jpg"), (text, "png"), (folder / "plain.jpg", "")):
        for target in ("jpg", "png", "tif", "bmp", "tga"):
            out = folder / f"out.{target}"
            done = recede("fill", image, "--mask", mask, "--frontal", "--force", "-o",
                          out)
            kept = b"by hand" in out.read_bytes()
            check(kept == (target == home), image.name, target, "kept:", kept)
            check((b"comments" in done.stderr) == (home not in ("", target)), image.name, target,
                  done.stderr)
    done = recede("synthesize", text, "--size", "70x50", "--frontal", "-o", folder / "made.bmp")
    check(not done.stderr, done)  # another picture, of which it said nothing


PROMISES = b"""<x:xmpmeta xmlns:x="adobe:ns:meta/">
<rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#"><rdf:Description
 xmlns:dc="http://purl.org/dc/elements/1.1/" xmlns:xmp="http://ns.adobe.com/xap/1.0/"
 xmlns:hdrgm="http://ns.adobe.com/hdr-gain-map/1.0/"
 xmlns:GCamera="http://ns.google.com/photos/1.0/"
 xmlns:Container="http://ns.google.com/photos/1.0/container/"
 xmlns:Item="http://ns.google.com/photos/1.0/container/item/"
 hdrgm:Version="1.0" GCamera:MotionPhoto="1" GCamera:MicroVideo="1"
 GCamera:MicroVideoOffset="999" xmp:CreatorTool="kept tool">
<Container:Directory><rdf:Seq><rdf:li Item:Semantic="GainMap" Item:Length="999"/></rdf:Seq>
</Container:Directory><dc:source>kept source</dc:source></rdf:Description></rdf:RDF></x:xmpmeta>"""


def test_what_is_behind_a_jpeg_is_said(folder):
    """A gain map or a video; and XMP promises it no longer."""
    mask = write(folder / "mask.png", hole())
    plain = write(folder / "plain.jpg", texture()).read_bytes()
    packet = b"http://ns.adobe.com/xap/1.0/\0" + PROMISES
    promising = (plain[:2] + b"\xff\xe1" + struct.pack(">H", len(packet) + 2) + packet + plain[2:])
    image = folder / "in.jpg"
    for what, behind, said in (("nothing", b"", False), ("fill", bytes(5000) + b"\xff" * 99, False),
                               ("a line", b"\r\n", False), ("picture", plain, True),
                               ("video", bytes(3) + b"\x18ftypmp42" + bytes(range(256)), True)):
        image.write_bytes(promising + behind)
        for target in ("jpg", "png", "tif"):
            out = folder / f"out.{target}"
            done = recede("fill", image, "--mask", mask, "--frontal", "--force", "-o", out)
            check((b"further pictures" in done.stderr) == said, what, target, done.stderr)
            data = out.read_bytes()
            check(b"kept tool" in data and b"kept source" in data, what, target, "lacks XMP")
            for word in (b"hdrgm:Version", b"Directory", b"GainMap\"", b"Motion", b"MicroVideo"):
                check(word not in data, what, target, "promises", word)


if __name__ == "__main__":
    sys.exit(harness.main(globals()))
