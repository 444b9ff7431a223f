"""Small colour profiles, made here, and PNG files that carry one."""
import struct
import zlib
from pathlib import Path

SRGB = ((.4361, .2225, .0139), (.3851, .7169, .0971), (.1431, .0606, .7141))
WIDE = ((.7977, .2880, 0), (.1352, .7119, .0001), (.0313, .0001, .8248))  # ROMM's primaries
WHITE = (.9642, 1, .8249)


def rgb_profile(columns=SRGB, gamma=2.2):
    """A minimal profile's bytes: header, white, three columns, curves, name."""
    def fixed(values):
        return b"XYZ \0\0\0\0" + b"".join(int(round(v * 65536)).to_bytes(4, "big", signed=True)
                                          for v in values)

    curve = b"curv\0\0\0\0\0\0\0\1" + round(gamma * 256).to_bytes(2, "big") + b"\0\0"
    text = b"desc\0\0\0\0\0\0\0\x07recede\0" + bytes(11 + 67 + 5)
    tags = [(b"desc", text[:len(text) // 4 * 4]), (b"cprt", b"text\0\0\0\0CC0\0"),
            (b"wtpt", fixed(WHITE)),
            *zip((b"rXYZ", b"gXYZ", b"bXYZ"), map(fixed, columns)),
            (b"rTRC", curve), (b"gTRC", curve), (b"bTRC", curve)]
    offset = 128 + 4 + 12 * len(tags)
    table, data = len(tags).to_bytes(4, "big"), b""
    for name, content in tags:
        table += name + (offset + len(data)).to_bytes(4, "big") + len(content).to_bytes(4, "big")
        data += content
    head = bytearray(128)
    head[0:4] = (128 + len(table) + len(data)).to_bytes(4, "big")
    head[8:12] = b"\x02\x10\0\0"
    head[12:24] = b"mntrRGB XYZ "
    head[36:40] = b"acsp"
    head[68:80] = fixed(WHITE)[8:]
    return bytes(head) + table + data


HEAD_END = 33  # a PNG's signature and its first chunk


def embed(path, profile):
    """Puts a profile into a PNG file."""
    data = Path(path).read_bytes()
    body = b"iCCPrecede\0\0" + zlib.compress(profile)
    chunk = struct.pack(">I", len(body) - 4) + body + struct.pack(">I", zlib.crc32(body))
    Path(path).write_bytes(data[:HEAD_END] + chunk + data[HEAD_END:])


def embedded(path):
    """The profile in a PNG file, or None."""
    data, at = Path(path).read_bytes(), 8
    while at < len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        if kind == b"iCCP":
            body = data[at + 8 : at + 8 + length]
            return zlib.decompress(body[body.index(b"\0") + 2 :])
        at += 12 + length
    return None
