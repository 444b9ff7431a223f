"""Reads GIMP's own files, for tests: every layer's and channel's raw bytes, whatever the precision.

Only what GIMP writes by default: RLE tiles, no zlib.
"""
import struct
from pathlib import Path

import numpy as np

TILE = 64
COMPONENTS = {0: 3, 1: 4, 2: 1, 3: 2, 4: 1, 5: 2}  # by layer type: RGB, RGBA, GRAY, GRAYA, indexed
# By the hundreds of the precision: the numbers' type, as stored (big-endian since version 12).
NUMBERS = {1: ">u1", 2: ">u2", 3: ">u4", 5: ">f2", 6: ">f4", 7: ">f8"}
PROP_OFFSETS, PROP_COMPRESSION = 15, 17


class Reader:
    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, fmt):
        values = struct.unpack_from(">" + fmt, self.data, self.at)
        self.at += struct.calcsize(">" + fmt)
        return values if len(values) > 1 else values[0]

    def string(self):
        length = self.take("I")
        text = self.data[self.at : self.at + length - 1].decode() if length else ""
        self.at += length
        return text

    def properties(self):
        found = {}
        while True:
            kind, length = self.take("II")
            if kind == 0:
                return found
            found[kind] = self.data[self.at : self.at + length]
            self.at += length


def unpack_plane(data, at, count):
    """One byte plane of a run-length coded tile: (bytes, where it ends)."""
    out = bytearray()
    while len(out) < count:
        code = data[at]
        at += 1
        if code in (127, 128):
            length = data[at] << 8 | data[at + 1]
            at += 2
        else:
            length = code + 1 if code < 127 else 256 - code
        if code <= 127:
            out += data[at : at + 1] * length
            at += 1
        else:
            out += data[at : at + length]
            at += length
    return bytes(out), at


class Drawable:
    """name, (x, y) offsets, bytes [h, w, bytes a pixel], values [h, w, components]."""

    def __init__(self, file, at):
        reader = Reader(file.data)
        reader.at = at
        self.width, self.height = reader.take("II")
        kind = reader.take("I") if file.reading_layers else 2
        self.name = reader.string()
        properties = reader.properties()
        self.offsets = (0, 0)
        if file.reading_layers:
            self.offsets = struct.unpack(">ii", properties[PROP_OFFSETS])
        hierarchy = reader.take(file.pointer)
        self.bytes = self.read_hierarchy(file, hierarchy)
        number = np.dtype(NUMBERS[file.precision // 100])
        flat = np.ascontiguousarray(self.bytes).view(number)
        self.values = flat.reshape(self.height, self.width, COMPONENTS[kind]).astype(float)

    def read_hierarchy(self, file, at):
        reader = Reader(file.data)
        reader.at = at
        _, _, depth = reader.take("III")
        reader.at = reader.take(file.pointer)
        reader.take("II")
        out = np.zeros((self.height, self.width, depth), np.uint8)
        for y in range(0, self.height, TILE):
            for x in range(0, self.width, TILE):
                part = out[y : y + TILE, x : x + TILE]
                start = reader.take(file.pointer)
                for plane in range(depth):
                    data, start = unpack_plane(file.data, start, part[..., 0].size)
                    part[..., plane] = np.frombuffer(data, np.uint8).reshape(part.shape[:2])
        return out


class Image:
    def __init__(self, path):
        self.data = Path(path).read_bytes()
        version = self.data[9:13].decode()
        version = 0 if version == "file" else int(version[1:])
        self.pointer = "Q" if version >= 11 else "I"
        reader = Reader(self.data)
        reader.at = 14
        self.width, self.height, _ = reader.take("III")
        self.precision = reader.take("I") if version >= 4 else 150
        assert reader.properties()[PROP_COMPRESSION] in (b"\0", b"\1")
        self.layers = self.read_list(reader, True)
        self.channels = self.read_list(reader, False)

    def read_list(self, reader, layers):
        self.reading_layers = layers
        found = []
        while True:
            at = reader.take(self.pointer)
            if at == 0:
                return found
            found.append(Drawable(self, at))
