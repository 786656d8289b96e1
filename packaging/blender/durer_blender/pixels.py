"""Image files in memory: PNG and PFM writers, and the table of textures of a scene."""

import hashlib
import struct
import zlib

import numpy as np


def png(values):
    """Returns 8-bit values of shape (height, width) or (height, width, 3) as a PNG file."""
    height, width = values.shape[:2]
    color = 2 if values.ndim == 3 else 0
    rows = np.zeros((height, 1 + values[0].size), np.uint8)
    rows[:, 1:] = values.reshape(height, -1)

    def chunk(kind, content):
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))

    head = struct.pack(">IIBBBBB", width, height, 8, color, 0, 0, 0)
    body = zlib.compress(rows.tobytes(), 1)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", body) + chunk(b"IEND", b"")


def pfm(values):
    """Returns values of shape (height, width, 3) as a PFM file."""
    height, width = values.shape[:2]
    head = f"PF\n{width} {height}\n-1.0\n".encode()
    return head + np.ascontiguousarray(values[::-1], "<f4").tobytes()


def is_eight_bit(values):
    """True if all values are multiples of 1/255 from 0 to 1, as those of 8-bit files are."""
    scaled = values * 255
    return bool((np.abs(scaled - np.rint(scaled)) < 1e-3).all() and values.min() >= 0 and values.max() <= 1)


def rgba(pictures):
    """Returns a rendered picture of shape (height, width, 4). Without alpha, it is opaque."""
    color = pictures["color"]
    alpha = pictures["alpha"] if "alpha" in pictures else np.ones(color.shape[:2], np.float32)
    return np.concatenate([color, alpha[..., None]], -1)


class Textures:
    """Textures of a scene, with their files. Equal textures are stored once."""

    def __init__(self):
        #: Contents of files by name.
        self.files = {}
        #: Blocks of the scene language.
        self.blocks = []
        self._names = {}

    def file(self, values, is_data):
        """Returns the name of a file with values of shape (height, width, 3), which are linear
        colours, or data such as normals if `is_data` is true."""
        if is_data and is_eight_bit(values):
            content, ending = png(np.rint(values * 255).astype(np.uint8)), "png"
        else:
            content, ending = pfm(values), "pfm"
        return self._file(content, ending)

    def srgb_file(self, values):
        """Returns the name of a file with 8-bit sRGB colours, given from 0 to 1."""
        return self._file(png(np.rint(np.clip(values, 0, 1) * 255).astype(np.uint8)), "png")

    def _file(self, content, ending):
        name = f"{hashlib.sha1(content).hexdigest()[:16]}.{ending}"
        self.files[name] = content
        return name

    def add(self, file, mapping):
        """Returns the name of a texture: a file with a mapping, given as a tuple of pairs of words
        of the scene language."""
        key = (file, mapping)
        if key not in self._names:
            self._names[key] = f"texture{len(self.blocks)}"
            self.blocks.append((self._names[key], file, mapping))
        return self._names[key]
