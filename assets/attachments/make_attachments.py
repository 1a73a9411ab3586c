#!/usr/bin/env python3
"""Draws what the example scenes wear: closed meshes in metres about the head joint (x to the left, y up, z forward) of a
head 0.23 m high. See app/files/attachment_spec.h. Run in this folder."""
import math

CENTER = (0.0, 0.095, -0.008)
SKULL = (0.074, 0.086, 0.094)  # half widths of the head over the ears


class Mesh:
    def __init__(self):
        self.points, self.faces = [], []

    def add(self, p):
        self.points.append(p)
        return len(self.points)

    def sheet(self, rows, closed_rows=False):
        """Quads between rings of points; each ring closes on itself."""
        index = [[self.add(p) for p in row] for row in rows]
        pairs = list(zip(index, index[1:])) + ([(index[-1], index[0])] if closed_rows else [])
        for a, b in pairs:
            n = len(a)
            for k in range(n):
                self.faces.append((a[k], b[k], b[(k + 1) % n], a[(k + 1) % n]))
        return index

    def cap(self, ring, p, turned):
        top = self.add(p)
        for k in range(len(ring)):
            a, b = ring[k], ring[(k + 1) % len(ring)]
            self.faces.append((top, b, a) if turned else (top, a, b))

    def write(self, name, what, color):
        """Kd: linear reflectance."""
        with open(name + ".mtl", "w") as file:
            file.write("newmtl %s\nKd %g %g %g\n" % (name, *color))
        with open(name + ".obj", "w") as file:
            file.write(f"# {what}. Metres about the head joint; made by make_attachments.py.\nmtllib {name}.mtl\no {name}\nusemtl {name}\n")
            for p in self.points:
                file.write("v %.5f %.5f %.5f\n" % p)
            for f in self.faces:
                file.write("f " + " ".join(map(str, f)) + "\n")


def on_head(turn, polar, off):
    """A point `off` metres off the skull, `turn` from the front to the left, `polar` from the crown down."""
    d = (math.sin(turn) * math.sin(polar), math.cos(polar), math.cos(turn) * math.sin(polar))
    return tuple(c + (s + off) * x for c, s, x in zip(CENTER, SKULL, d))


def turns(n):
    return [2 * math.pi * k / n for k in range(n)]


def crown(mesh, rim, inside, outside, segments=96, rows=26):
    """A shell over the head down to the polar angle rim(turn); the rings of its outer side at the rim come last."""
    outer = [[on_head(t, rim(t) * i / rows, outside(t, i / rows)) for t in turns(segments)] for i in range(1, rows + 1)]
    inner = [[on_head(t, rim(t) * i / rows, inside(t, i / rows)) for t in turns(segments)] for i in range(rows, 0, -1)]
    rings = mesh.sheet(outer + inner)
    mesh.cap(rings[0], on_head(0, 0, outside(0, 0)), False)
    mesh.cap(rings[-1], on_head(0, 0, inside(0, 0)), True)


def beanie():
    mesh = Mesh()
    rim = lambda t: math.radians(95 - 14 * math.cos(t))
    ribs = lambda t, s: 0.0008 * math.cos(24 * t) * min(1, 3 * s)
    cuff = lambda s: 0.0032 / (1 + math.exp(-90 * (s - 0.74)))
    slack = lambda s: 0.011 * (1 - s) ** 1.5
    snug = lambda t, s: -(0.0035 + 0.003 * max(0, math.cos(t))) * max(0, (s - 0.6) / 0.4) ** 2
    crown(mesh, rim, lambda t, s: 0.012 + snug(t, s), lambda t, s: 0.0185 + slack(s) + snug(t, s) + ribs(t, s) + cuff(s))
    mesh.write("beanie", "A knitted cap", (0.28, 0.05, 0.06))


def sun_hat():
    mesh = Mesh()
    rim = lambda t: math.radians(76 - 8 * math.cos(t))
    rows, segments, wide = 20, 96, 0.075
    flat = lambda t, i, off: on_head(t, rim(t) * i / rows, off)

    def brim(t, s, side):
        x, y, z = flat(t, rows, 0.020)
        out = wide * s
        return (x + out * math.sin(t), y - 0.018 * s * s + 0.0035 * side, z + out * math.cos(t))

    outer = [[flat(t, i, 0.023) for t in turns(segments)] for i in range(1, rows)]
    upper = [[brim(t, s, 1) for t in turns(segments)] for s in (0.06, 0.2, 0.4, 0.6, 0.8, 1.0)]
    lower = [[brim(t, s, -1) for t in turns(segments)] for s in (1.0, 0.8, 0.6, 0.4, 0.2, 0.06)]
    inner = [[flat(t, i, 0.0165) for t in turns(segments)] for i in range(rows, 0, -1)]
    rings = mesh.sheet(outer + upper + lower + inner)
    mesh.cap(rings[0], on_head(0, 0, 0.023), False)
    mesh.cap(rings[-1], on_head(0, 0, 0.0165), True)
    mesh.write("sun_hat", "A hat with a brim", (0.62, 0.46, 0.24))


# m that the built-in head stands off the skull's ellipsoid, by turn (30 degrees a row) and polar angle (from 40 on, 10
# a column).
HEAD_OFF_SKULL = [
    [0.0019, 0.0045, 0.0071, 0.0093, 0.0105, 0.0108, 0.0109, 0.0155],
    [0.0004, 0.0024, 0.0049, 0.0072, 0.0086, 0.0098, 0.0109, 0.0142],
    [-0.0027, -0.0023, -0.0015, -0.0004, 0.0007, 0.0015, 0.0035, 0.0084],
    [-0.0040, -0.0040, -0.0039, -0.0038, -0.0035, -0.0031, -0.0002, 0.0010],
    [-0.0041, -0.0038, -0.0034, -0.0029, -0.0024, -0.0020, -0.0018, -0.0017],
    [-0.0046, -0.0043, -0.0039, -0.0035, -0.0031, -0.0027, -0.0024, -0.0024],
    [-0.0048, -0.0046, -0.0043, -0.0039, -0.0035, -0.0031, -0.0028, -0.0028],
]


def head_off_skull(turn, polar):
    row = math.degrees(math.acos(math.cos(turn))) / 30
    column = min(max(math.degrees(polar) / 10 - 4, 0), 6.999)
    i, j = min(int(row), 5), int(column)
    at = lambda i: HEAD_OFF_SKULL[i][j] * (1 - column + j) + HEAD_OFF_SKULL[i][j + 1] * (column - j)
    return at(i) * (1 - row + i) + at(i + 1) * (row - i)


def headband():
    """Flat on the hair all round: its section lies along the head, and its edges are rolled in."""
    mesh = Mesh()
    middle = lambda t: math.radians(80 - 28 * math.cos(t))
    half, thick, reach = 0.013, 0.0022, 0.094

    def corner(t, a):
        polar = middle(t) + half / reach * math.sin(a)
        off = 0.0105 + thick * math.cos(a) - 0.001 * math.sin(a) ** 2
        return on_head(t, polar, head_off_skull(t, polar) + off)

    mesh.sheet([[corner(t, a) for t in turns(96)] for a in turns(16)], closed_rows=True)
    mesh.write("headband", "A band about forehead and nape", (0.10, 0.16, 0.24))


def tube(mesh, path, radius, closed):
    """A round tube along points."""
    n, rows = len(path), []
    for i, p in enumerate(path):
        a = path[(i - 1) % n] if closed or i > 0 else p
        b = path[(i + 1) % n] if closed or i < n - 1 else p
        along = [v - u for u, v in zip(a, b)]
        size = math.hypot(*along)
        along = [v / size for v in along]
        up = (0, 1, 0) if abs(along[1]) < 0.8 else (0, 0, 1)
        if closed:
            up = (0, 0, 1)
        side = [along[1] * up[2] - along[2] * up[1], along[2] * up[0] - along[0] * up[2], along[0] * up[1] - along[1] * up[0]]
        size = math.hypot(*side)
        side = [v / size for v in side]
        other = [along[1] * side[2] - along[2] * side[1], along[2] * side[0] - along[0] * side[2], along[0] * side[1] - along[1] * side[0]]
        rows.append([tuple(p[k] + radius * (math.cos(t) * side[k] + math.sin(t) * other[k]) for k in range(3)) for t in turns(12)])
    rings = mesh.sheet(rows, closed)
    if not closed:
        mesh.cap(rings[0], path[0], False)
        mesh.cap(rings[-1], path[-1], True)


def glasses():
    mesh = Mesh()
    for side in (-1, 1):
        rim = [(side * 0.033 + 0.025 * math.cos(t), 0.083 + 0.021 * math.sin(t), 0.098 - 0.10 * (side * 0.033 + 0.025 * math.cos(t)) ** 2 / 0.06) for t in turns(40)]
        tube(mesh, rim, 0.0025, True)
        arm = [(side * 0.058, 0.088, 0.092), (side * 0.070, 0.088, 0.080), (side * 0.081, 0.088, 0.050), (side * 0.083, 0.088, 0.0), (side * 0.081, 0.082, -0.020), (side * 0.078, 0.065, -0.034)]
        tube(mesh, arm, 0.0025, False)
    tube(mesh, [(-0.0085, 0.086, 0.0975), (0, 0.090, 0.099), (0.0085, 0.086, 0.0975)], 0.0025, False)
    mesh.write("glasses", "A pair of glasses", (0.02, 0.018, 0.016))


beanie()
sun_hat()
headband()
glasses()
