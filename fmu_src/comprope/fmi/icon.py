"""Icons of FMUs as PNG, drawn without an image library: a rope around a sheave, and a machine with car and counterweight."""

import struct
import zlib

import numpy as np

SIZE = 128
_ROPE = (40, 60, 90)
_SHEAVE = (215, 120, 40)


def icon(name: str) -> bytes:
    """The icon "sheave" or "machine": 128 by 128 pixels, transparent around the drawing."""
    y, x = np.mgrid[0:SIZE, 0:SIZE] + 0.5
    sheave, rope = {"sheave": _sheave, "machine": _machine}[name](x, y)
    picture = np.zeros((SIZE, SIZE, 4))
    for distance, colour in ((sheave, _SHEAVE), (rope, _ROPE)):
        cover = np.clip(0.5 - distance, 0.0, 1.0)  # one pixel of transition makes edges smooth
        picture[cover > 0.0, :3] = colour
        picture[..., 3] = np.maximum(picture[..., 3], 255.0 * cover)
    return _png(np.rint(picture).astype(np.uint8))


def _sheave(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distances [pixels] from the sheave in the pit and from the rope below it."""
    dx, dy = x - 64.0, y - 72.0
    radius = np.hypot(dx, dy)
    rope = np.where(dy > 0.0, np.abs(radius - 44.0), np.abs(np.abs(dx) - 44.0)) - 4.0
    return np.minimum(np.abs(radius - 34.0) - 4.5, radius - 7.0), rope


def _machine(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distances [pixels] from the traction sheave, and from hoist ropes, car and counterweight."""
    dx, dy = x - 64.0, y - 44.0
    radius = np.hypot(dx, dy)
    hoist = np.where(dy < 0.0, np.abs(radius - 36.0), np.abs(np.abs(dx) - 36.0)) - 3.0
    car = np.maximum(np.abs(x - 28.0) - 20.0, np.abs(y - 102.0) - 22.0)
    counterweight = np.maximum(np.abs(x - 100.0) - 11.0, np.abs(y - 84.0) - 22.0)
    return np.minimum(np.abs(radius - 26.0) - 4.5, radius - 7.0), np.minimum(np.minimum(hoist, car), counterweight)


def _png(rgba: np.ndarray) -> bytes:
    height, width, _ = rgba.shape
    rows = b"".join(b"\0" + row.tobytes() for row in rgba)
    header = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + _chunk(b"IHDR", header) + _chunk(b"IDAT", zlib.compress(rows, 9)) + _chunk(b"IEND", b"")


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
