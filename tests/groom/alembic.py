# Alembic curves in an Ogawa container, from the container's and the schema's description (see app/groom/formats/ogawa.h,
# app/groom/formats/alembic_property.h and app/groom/formats/alembic_file.h for the sources).
import array
import struct

import dump

DATA = 1 << 63
TYPES = {1: "B", 2: "b", 3: "H", 4: "h", 5: "I", 6: "i", 10: "f", 11: "d"}


class Container:
    def __init__(self, data):
        assert data[:8] == b"Ogawa\xff\x00\x01", "no finished Ogawa file of version 1"
        self.data = data
        self.root = struct.unpack_from("<Q", data, 8)[0]

    def group(self, at):
        assert not at & DATA
        if at == 0:
            return ()
        count, = struct.unpack_from("<Q", self.data, at)
        return struct.unpack_from("<%dQ" % count, self.data, at + 8)

    def block(self, at):
        assert at & DATA
        at -= DATA
        if at == 0:
            return b""
        size, = struct.unpack_from("<Q", self.data, at)
        assert at + 8 + size <= len(self.data)
        return self.data[at + 8:at + 8 + size]


class Header:
    def __init__(self, data):
        self.data, self.at = data, 0

    def number(self, size):
        value = int.from_bytes(self.data[self.at:self.at + size], "little")
        self.at += size
        return value

    def text(self, size):
        self.at += size
        return self.data[self.at - size:self.at].decode()

    def metadata(self, index, table, size):
        text = self.text(self.number(size)) if index == 255 else table[index]
        return dict(pair.split("=", 1) for pair in text.split(";") if pair)


def properties(file, compound, table):
    children = file.group(compound)
    found = {}
    if not children:
        return found
    header = Header(file.block(children[-1]))
    for child in children[:-1]:
        word = header.number(4)
        size = 1 << (word >> 2 & 3)
        prop = {"array": word & 3 > 1, "compound": word & 3 == 0, "type": word >> 4 & 15, "extent": word >> 12 & 255,
                "group": child, "first": 0, "last": 0, "sampling": 0}
        if not prop["compound"]:
            prop["samples"] = header.number(size)
            if word & 0x200:
                prop["first"], prop["last"] = header.number(size), header.number(size)
            elif not word & 0x800:
                prop["first"], prop["last"] = 1, prop["samples"] - 1
            if word & 0x100:
                prop["sampling"] = header.number(size)
        name = header.text(header.number(size))
        prop["metadata"] = header.metadata(word >> 20 & 255, table, size)
        found[name] = prop
    assert header.at == len(header.data)
    return found


def sample(file, prop, moment):
    moment = min(moment, prop["samples"] - 1, prop["last"])
    stored = 0 if moment < prop["first"] or prop["last"] == 0 else moment - prop["first"] + 1
    block = file.block(file.group(prop["group"])[stored * (2 if prop["array"] else 1)])[16:]
    return array.array(TYPES[prop["type"]], block) if prop["type"] in TYPES else block


def curves(file, at, table, found):
    children = file.group(at)
    for prop in properties(file, children[0], table).values():
        if prop["metadata"].get("schema") == "AbcGeom_Curve_v2":
            found.append(properties(file, prop["group"], table))
    headers = Header(file.block(children[-1])[:-32])
    child = 1
    while headers.at < len(headers.data):
        headers.text(headers.number(4))
        headers.metadata(headers.number(1), table, 4)
        curves(file, children[child], table, found)
        child += 1


def samplings(data):
    at, found = 0, []
    while at < len(data):
        _, cycle, count = struct.unpack_from("<IdI", data, at)
        found.append((cycle, struct.unpack_from("<%dd" % count, data, at + 16)))
        at += 16 + 8 * count
    return found


def moment_of(file, geom, more, moment):
    groom = dump.empty()
    dump.counted(groom, sample(file, geom["nVertices"], moment))
    groom["points"] = sample(file, geom["P"], moment)
    names = {"widths": "groom_width", "colors": "groom_color", "root_uvs": "groom_root_uv", "ids": "groom_id",
             "groups": "groom_group_id", "guides": "groom_guide"}
    for key, name in names.items():
        if name in more:
            groom[key] = array.array(groom[key].typecode, sample(file, more[name], moment))
    if groom["widths"]:
        assert groom["widths"] == sample(file, geom["width"], moment)
        assert more["groom_width"]["metadata"]["geoScope"] == "vtx"
    return groom


def read(data):
    file = Container(data)
    version, _, top, about, times, indexed = file.group(file.root)
    assert file.block(version) == bytes(4) and b"_ai_AlembicVersion" in file.block(about)
    header, table = Header(file.block(indexed)), [""]
    while header.at < len(header.data):
        table.append(header.text(header.number(1)))
    found = []
    curves(file, top, table, found)
    geom, = found
    assert list(sample(file, geom["curveBasisAndType"], 0)) == [1, 0, 0, 0]
    user = properties(file, geom[".userProperties"]["group"], table)
    assert list(sample(file, user["groom_version_major"], 0)) == [1]
    assert list(sample(file, user["groom_version_minor"], 0)) == [4]
    assert sample(file, user["groom_tool"], 0) == b"hairmesh\0"
    more = properties(file, geom[".arbGeomParams"]["group"], table) if ".arbGeomParams" in geom else {}
    cycle, stored = samplings(file.block(times))[geom["P"]["sampling"]]
    count = geom["P"]["samples"]
    moments = []
    for n in range(count):
        moments.append(moment_of(file, geom, more, n))
        xs = moments[-1]["points"]
        box = [f(xs[axis::3]) for f in (min, max) for axis in range(3)]
        assert list(sample(file, geom[".selfBnds"], n)) == box
    return [stored[n % len(stored)] + n // len(stored) * cycle for n in range(count)], moments
