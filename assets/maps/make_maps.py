#!/usr/bin/env python3
"""Draws the maps of the built-in looks and of docs/styling.md: the head unrolled, front in the middle, crown on top (app/files/field_map.h).
Needs numpy. Run in this folder."""
import struct
import zlib

import numpy as np

W, H = 128, 64
u, v = np.meshgrid((np.arange(W) + 0.5) / W, (np.arange(H) + 0.5) / H)
front = np.exp(-(((u - 0.5) / 0.11) ** 2))  # 1 at the forehead, 0 beside the temples
side = np.sin(np.pi * v) * np.sin(2 * np.pi * (u - 0.5))  # -1 at the right ear, 1 at the left one
low = np.clip((v - 0.12) / 0.5, 0, 1)  # 0 at the crown, 1 at the nape

maps = {
    "layers_length": 0.46 + 0.16 * low**1.3 - 0.06 * front,
    "bob_length": 0.74 - 0.40 * front,
    "left_side": side >= 0.3,  # of the parting
    "dyed_streak": np.where(
        ((side > 0.25) & (side < 0.75) & (np.cos(2 * np.pi * (u - 0.5)) > 0.3))[..., None], [0.75, 0.0, 0.12], 1.0
    ),
}


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


for name, value in maps.items():
    pixels = (255 * np.clip(value, 0, 1)).astype(np.uint8)
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)
    kind = 2 if pixels.ndim == 3 else 0  # colour or grey
    with open(f"{name}.png", "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", W, H, 8, kind, 0, 0, 0)))
        file.write(chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))
