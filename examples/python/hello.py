"""Hello, hair, in Python: turns the head under a hair mesh to and fro and prints where the tip of one column goes.
hello.py HAIR.obj [SECONDS]"""

import math
import sys

import hairmesh


def pose(time):
    """The head turns 60 degrees to either side, twice a second; a skull around its joint moves with it."""
    swing, rate = math.pi / 3, 2 * math.pi * 2
    angle, speed = swing * math.sin(rate * time), swing * rate * math.cos(rate * time)
    x, y, z = 0.005 * math.sin(angle), 0.085, 0.005 * math.cos(angle)
    turn = (0, math.sin(angle / 2), 0, math.cos(angle / 2))
    skull = hairmesh.Ellipsoid((0.072, 0.1, 0.09), (x, y, z), turn, (speed * z, 0, -speed * x), (0, speed, 0))
    return hairmesh.pose(rotation=turn), skull


def main(file, seconds=2.0):
    try:
        mesh = hairmesh.Mesh.load(file)
    except (OSError, hairmesh.Error) as fault:
        sys.exit(f"hello.py: {fault}")
    hair = hairmesh.Hair(mesh)
    tip = hair.positions[mesh.tips[0]]
    print(f"{len(mesh.tips)} columns, {len(mesh.rest)} vertices\n  time s     x m     y m     z m")
    step = 1
    while step / 60.0 <= float(seconds):
        head, skull = pose(step / 60.0)
        hair.step(head=head, ellipsoids=[skull], time=step / 60.0)
        print(f"{step / 60.0:8.3f} {tip[0]:7.4f} {tip[1]:7.4f} {tip[2]:7.4f}")
        step += 1
    value = 14695981039346656037  # FNV-1a of the positions' bytes
    for byte in hair.positions.tobytes():
        value = (value ^ byte) * 1099511628211 % 2**64
    print(f"end state: {value:016x}")


if __name__ == "__main__":
    main(*sys.argv[1:]) if len(sys.argv) in (2, 3) else sys.exit("hello.py HAIR.obj [SECONDS]")
