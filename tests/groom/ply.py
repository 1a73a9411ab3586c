# Strands in PLY, from G. Turk's description of the format and the names in app/groom/formats/ply_file.h. Strands are found twice,
# by the element "strand" and by the edges.
import array
import struct

import dump

TYPES = {"char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I", "float": "f", "double": "d"}


def header(data):
    end = data.index(b"end_header\n") + len(b"end_header\n")
    elements, kind = [], None
    for line in data[:end].decode().splitlines():
        words = line.split()
        if words[0] == "format":
            kind = words[1]
        elif words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words[0] == "property":
            elements[-1][2].append((words[2], TYPES[words[1]]))
    return kind, elements, end


def columns(data):
    """The numbers of every property, by element and name."""
    kind, elements, at = header(data)
    words = iter(data[at:].split()) if kind == "ascii" else None
    found = {}
    for name, count, properties in elements:
        values = [array.array(code) for _, code in properties]
        row = struct.Struct(("<" if kind != "binary_big_endian" else ">") + "".join(code for _, code in properties))
        for n in range(count):
            if words is not None:
                numbers = [float(next(words)) if code in "fd" else int(next(words)) for _, code in properties]
            else:
                numbers = row.unpack_from(data, at)
                at += row.size
            for column, number in zip(values, numbers):
                column.append(number)
        found[name] = {key: column for (key, _), column in zip(properties, values)}
    assert words is None or next(words, None) is None
    assert words is not None or at == len(data)
    return found


def woven(code, *parts):
    """Numbers of several columns, row by row."""
    return array.array(code, (number for row in zip(*parts) for number in row))


def read(data):
    found = columns(data)
    vertex, strand, edge = found["vertex"], found["strand"], found["edge"]
    groom = dump.empty()
    dump.counted(groom, strand["points"])
    groom["points"] = woven("f", vertex["x"], vertex["y"], vertex["z"])
    if "width" in vertex:
        groom["widths"] = vertex["width"]
    if "red" in vertex:
        groom["colors"] = woven("f", vertex["red"], vertex["green"], vertex["blue"])
    if "root_u" in strand:
        groom["root_uvs"] = woven("f", strand["root_u"], strand["root_v"])
    for key, name in (("ids", "id"), ("groups", "group"), ("guides", "guide")):
        if name in strand:
            groom[key] = strand[name]
    joined = set(zip(edge["vertex1"], edge["vertex2"]))
    firsts = set(groom["strand_first"])
    count = len(vertex["x"])
    assert joined == {(v - 1, v) for v in range(1, count) if v not in firsts}
    return [], [groom]
