# What a second reader found, as tests/app/groom/second_reader.h compares it.
import array
import struct

ARRAYS = ("strand_first", "points", "widths", "colors", "root_uvs", "ids", "groups", "guides")


def empty():
    groom = {name: array.array("f") for name in ("points", "widths", "colors", "root_uvs")}
    groom.update({name: array.array("i") for name in ("ids", "groups")})
    groom["strand_first"] = array.array("I", [0])
    groom["guides"] = array.array("B")
    return groom


def counted(groom, counts):
    """Strands of so many points each."""
    for count in counts:
        groom["strand_first"].append(groom["strand_first"][-1] + count)


def write(file, times, moments):
    with open(file, "wb") as out:
        arrays = [array.array("d", times)] + [groom[name] for groom in moments for name in ARRAYS]
        for values in arrays:
            out.write(struct.pack("<Q", len(values) * values.itemsize))
            out.write(values.tobytes())
