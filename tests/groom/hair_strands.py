# `.hair`, from the description at cemyuksel.com/research/hairmodels: header of 128 bytes, then segments, points,
# thickness, transparency, colours, each where its bit of the flags is set.
import array
import struct

import dump


def read(data):
    magic, strands, points, flags, segments, thickness, _, *color = struct.unpack_from("<4sIIIIff3f", data)
    assert magic == b"HAIR"
    at = 128

    def take(code, count, size):
        nonlocal at
        values = array.array(code, data[at:at + count * size])
        assert len(values) == count
        at += count * size
        return values

    groom = dump.empty()
    counts = take("H", strands, 2) if flags & 1 else [segments] * strands
    dump.counted(groom, [count + 1 for count in counts])
    groom["points"] = take("f", 3 * points, 4)
    if flags & 4:
        groom["widths"] = take("f", points, 4)
    elif thickness:
        groom["widths"] = array.array("f", [thickness] * points)
    if flags & 8:
        take("f", points, 4)
    if flags & 16:
        groom["colors"] = take("f", 3 * points, 4)
    elif color != [1, 1, 1]:
        groom["colors"] = array.array("f", color * points)
    return [], [groom]
