"""Cineon files, which OpenImageIO reads and does not write."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np


def write_cineon(path: Path, codes: np.ndarray) -> Path:
    """Codes [h, w, 3] of 10 bits as Kodak's Cineon file format 4.5 has them, three in each word."""
    height, width = codes.shape[:2]
    size = 2048 + 4 * height * width
    header = struct.pack(">6I8s", 0x802A5FD7, 2048, 1024, 1024, 0, size, b"V4.5") + bytes(160)
    header += struct.pack(">BB2x", 0, 3)
    for channel in range(1, 9):
        is_there = channel < 4
        header += struct.pack(">BBBxIIffff", 0, channel * is_there, 10, width, height, 0.0, 0.0, 1023.0, 2.046)
    header += bytes(32 + 228) + struct.pack(">BBBBII20x", 0, 5, 0, 0, 0, 0)
    words = codes.astype(np.uint32)
    packed = (words[..., 0] << 22) | (words[..., 1] << 12) | (words[..., 2] << 2)
    path.write_bytes(header.ljust(2048, b"\0") + packed.astype(">u4").tobytes())
    return path
