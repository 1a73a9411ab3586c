# USD curves in text, from openusd.org's description of the layer's grammar and of UsdGeomBasisCurves: what this program
# writes of them, one statement after another.
import array
import re

import dump

NUMBERS = re.compile(r"[^\s,()\[\]]+")


def value_after(text, at):
    """The text of a bracketed value, and where it ends."""
    assert text[at] in "[{("
    depth = 0
    for mark in re.compile(r"[\[\](){}]").finditer(text, at):
        depth += 1 if mark.group() in "[{(" else -1
        if depth == 0:
            return text[at + 1:mark.start()], mark.end()
    raise AssertionError("a bracket is not closed")


def attributes(body):
    """Name -> (type, value, interpolation) of a prim's body."""
    found, at = {}, 0
    statement = re.compile(r"\s*(?:uniform )?([\w\[\]]+) ([\w:.]+) = ")
    while True:
        match = statement.match(body, at)
        if not match:
            assert not body[at:].strip(), body[at:at + 80]
            return found
        at = match.end()
        if body[at] == '"':
            end = body.index('"', at + 1)
            value, at = body[at + 1:end], end + 1
        else:
            value, at = value_after(body, at)
        interpolation = None
        if body[at:at + 2] == " (":
            about, at = value_after(body, at + 1)
            interpolation = re.fullmatch(r'\s*interpolation = "(\w+)"\s*', about).group(1)
        found[match.group(2)] = (match.group(1), value, interpolation)


def numbers(code, text):
    convert = float if code == "f" else int
    return array.array(code, map(convert, NUMBERS.findall(text)))


def read(data):
    text = data.decode()
    assert text.startswith("#usda 1.0\n")
    about, at = value_after(text, text.index("("))
    assert re.search(r'upAxis = "Y"', about) and re.search(r"metersPerUnit = [\d.e-]+\n", about)
    rate = float(re.search(r"timeCodesPerSecond = (\S+)", about).group(1))
    first, last = (float(re.search(name + r" = (\S+)", about).group(1)) for name in ("startTimeCode", "endTimeCode"))
    world, _ = value_after(text, text.index("{", text.index('def Xform "hair"', at)))
    body, _ = value_after(world, world.index("{", world.index('def BasisCurves "strands"')))
    found = attributes(body)
    assert [found[key][1] for key in ("type", "basis", "wrap")] == ["cubic", "catmullRom", "pinned"]
    still = dump.empty()
    dump.counted(still, numbers("i", found["curveVertexCounts"][1]))
    for key, name, code, scope in (("widths", "widths", "f", "vertex"),
                                   ("colors", "primvars:displayColor", "f", "vertex"),
                                   ("root_uvs", "primvars:groom_root_uv", "f", "uniform"),
                                   ("ids", "primvars:groom_id", "i", "uniform"),
                                   ("groups", "primvars:groom_group_id", "i", "uniform"),
                                   ("guides", "primvars:groom_guide", "i", "uniform")):
        if name in found:
            assert found[name][2] == scope
            still[key] = array.array(still[key].typecode, numbers(code, found[name][1]))
    times, moments = [], []
    samples, at = found["points.timeSamples"][1], 0
    for match in iter(lambda: re.compile(r"[\s,]*(\S+): ").match(samples, at), None):
        value, at = value_after(samples, match.end())
        times.append(float(match.group(1)) / rate)
        moments.append(dict(still, points=numbers("f", value)))
    assert times[0] * rate == first and abs(times[-1] * rate - last) < 1e-9
    return times, moments
