# TressFX hair, from the description of its header (see app/groom/formats/tfx_file.h).
import array
import struct

import dump


def read(data):
    version, strands, points, positions, root_uvs, _, thickness, colors = struct.unpack_from("<f7I", data)
    assert version == 4 and 4 <= points <= 64 and points & (points - 1) == 0

    def floats(offset, count):
        assert offset % 8 == 0
        return array.array("f", data[offset:offset + 4 * count])

    def threes(values):
        return array.array("f", (value for n, value in enumerate(values) if n % 4 != 3))

    groom = dump.empty()
    dump.counted(groom, [points] * strands)
    groom["points"] = threes(floats(positions, 4 * strands * points))
    if root_uvs:
        groom["root_uvs"] = floats(root_uvs, 2 * strands)
    if thickness:
        groom["widths"] = array.array("f", (width for width in floats(thickness, strands) for _ in range(points)))
    if colors:
        groom["colors"] = threes(floats(colors, 4 * strands * points))
    return [], [groom]
