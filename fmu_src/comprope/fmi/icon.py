"""The icon of an FMU: a rope around a sheave, as a PNG, drawn without an image library."""

import struct
import zlib

import numpy as np

SIZE = 128
_ROPE = (40, 60, 90)
_SHEAVE = (215, 120, 40)


def icon() -> bytes:
    """A PNG of 128 by 128 pixels, transparent around the drawing."""
    y, x = np.mgrid[0:SIZE, 0:SIZE] + 0.5
    dx, dy = x - 64.0, y - 72.0
    radius = np.hypot(dx, dy)
    rope = np.where(dy > 0.0, np.abs(radius - 44.0), np.abs(np.abs(dx) - 44.0)) - 4.0
    sheave = np.minimum(np.abs(radius - 34.0) - 4.5, radius - 7.0)
    picture = np.zeros((SIZE, SIZE, 4))
    for distance, colour in ((sheave, _SHEAVE), (rope, _ROPE)):
        cover = np.clip(0.5 - distance, 0.0, 1.0)  # one pixel of transition makes edges smooth
        picture[cover > 0.0, :3] = colour
        picture[..., 3] = np.maximum(picture[..., 3], 255.0 * cover)
    return _png(np.rint(picture).astype(np.uint8))


def _png(rgba: np.ndarray) -> bytes:
    height, width, _ = rgba.shape
    rows = b"".join(b"\0" + row.tobytes() for row in rgba)
    header = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + _chunk(b"IHDR", header) + _chunk(b"IDAT", zlib.compress(rows, 9)) + _chunk(b"IEND", b"")


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
