"""The figure whose motion make_clips.py writes: skeleton, inverse kinematics, smooth tracks and the BVH writer.

Python 3 standard library only. Centimetres, degrees, y up; the figure faces +z, so its left is +x. Rotations are 3x3
matrices (tuples of rows) acting on column vectors. At rest every joint's rotation is the identity and the arms hang 45
degrees from the body (A pose).
"""
import math

# name, parent, offset from the parent at rest. A woman of 170 cm: hip joints at 88.5 cm, shoulders at 138, head joint
# (where skull and neck meet) at 150; segment lengths after the usual anthropometric shares of body height.
_ARM = 28 * math.sqrt(0.5)
_FOREARM = 24.5 * math.sqrt(0.5)
_HAND = 17 * math.sqrt(0.5)
_MIDDLE = [
    ("Hips", None, (0, 93.5, 0)),
    ("Spine", "Hips", (0, 9, -1)),
    ("Spine1", "Spine", (0, 11, -0.8)),
    ("Chest", "Spine1", (0, 11.5, -0.4)),
    ("Neck", "Chest", (0, 15.5, -1.3)),
    ("Head", "Neck", (0, 9.5, 2.0)),
]
_LIMBS = [
    ("Shoulder", "Chest", (2.5, 12.0, 1.0)),
    ("Arm", "Shoulder", (14.0, 1.0, -3.0)),
    ("ForeArm", "Arm", (_ARM, -_ARM, 0)),
    ("Hand", "ForeArm", (_FOREARM, -_FOREARM, 0)),
    ("UpLeg", "Hips", (9, -5, 0)),
    ("Leg", "UpLeg", (0, -42, 0.4)),
    ("Foot", "Leg", (0, -38.5, -0.8)),
    ("Toe", "Foot", (0, -6.3, 12)),
]
_END_SITES = {"Head": (0, 19.5, 1.5), "Hand": (_HAND, -_HAND, 0), "Toe": (0, 0, 6)}

ANKLE_HEIGHT = 8.0
BALL = (0, -6.3, 12)  # toe joint from the ankle, foot frame
HEEL = (0, -8.0, -4.5)
SIDES = {"Left": 1, "Right": -1}


def _skeleton():
    joints, ends = list(_MIDDLE), {"Head": _END_SITES["Head"]}
    for side, sign in SIDES.items():
        for name, parent, (x, y, z) in _LIMBS:
            limb_parent = parent if parent in ("Chest", "Hips") else side + parent
            joints.append((side + name, limb_parent, (sign * x, y, z)))
            if name in _END_SITES:
                ex, ey, ez = _END_SITES[name]
                ends[side + name] = (sign * ex, ey, ez)
    return joints, ends


JOINTS, END_SITES = _skeleton()
OFFSET = {name: offset for name, _, offset in JOINTS}
PARENT = {name: parent for name, parent, _ in JOINTS}

IDENTITY = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def mul(a, b):
    return tuple(tuple(sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)) for i in range(3))


def product(*matrices):
    result = IDENTITY
    for matrix in matrices:
        result = mul(result, matrix)
    return result


def transpose(a):
    return tuple(zip(*a))


def apply(a, v):
    return tuple(sum(a[i][k] * v[k] for k in range(3)) for i in range(3))


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def scale(a, s):
    return tuple(x * s for x in a)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def normalized(a):
    return scale(a, 1 / math.sqrt(dot(a, a)))


def mix(a, b, weight):
    return tuple(x + weight * (y - x) for x, y in zip(a, b))


def rot_x(degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return ((1, 0, 0), (0, c, -s), (0, s, c))


def rot_y(degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return ((c, 0, s), (0, 1, 0), (-s, 0, c))


def rot_z(degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return ((c, -s, 0), (s, c, 0), (0, 0, 1))


def turned(yaw=0, pitch=0, roll=0):
    """Yaw to the left, pitch forward, roll to the figure's right: R_y R_x R_z."""
    return product(rot_y(yaw), rot_x(pitch), rot_z(roll))


def part_of(matrix, share):
    """The rotation about the same axis by a share of the angle."""
    cosine = max(-1.0, min(1.0, (matrix[0][0] + matrix[1][1] + matrix[2][2] - 1) / 2))
    angle = math.acos(cosine)
    axis = (matrix[2][1] - matrix[1][2], matrix[0][2] - matrix[2][0], matrix[1][0] - matrix[0][1])
    length = math.sqrt(dot(axis, axis))
    if length < 1e-9:
        return IDENTITY
    x, y, z = scale(axis, 1 / length)
    c, s = math.cos(angle * share), math.sin(angle * share)
    d = 1 - c
    return (
        (c + x * x * d, x * y * d - z * s, x * z * d + y * s),
        (y * x * d + z * s, c + y * y * d, y * z * d - x * s),
        (z * x * d - y * s, z * y * d + x * s, c + z * z * d),
    )


class Foot:
    """Where a foot is: ankle position, yaw, pitch (toes down positive) and the bend of the toes against the foot."""

    def __init__(self, ankle, yaw=0.0, pitch=0.0, toe=0.0):
        self.ankle, self.yaw, self.pitch, self.toe = ankle, yaw, pitch, toe


def grounded(x, z, yaw=0.0, pitch=0.0):
    """A foot that stands at (x, z), the place of its ankle when flat; pitched, it rolls over its ball or its heel."""
    pivot = BALL if pitch > 0 else HEEL
    flat = add((x, ANKLE_HEIGHT, z), apply(rot_y(yaw), pivot))
    ankle = sub(flat, apply(turned(yaw, pitch), pivot))
    return Foot(ankle, yaw, pitch, -max(0.0, pitch))


class Pose:
    """Joint rotations against the parent, and the root's place."""

    def __init__(self, root=(0, 93.5, 0)):
        self.root = root
        self.turn = {name: IDENTITY for name, _, _ in JOINTS}
        self.shortfall = 0.0  # cm by which a leg could not reach its foot

    def world(self):
        """Name to (rotation, position)."""
        placed = {}
        for name, parent, offset in JOINTS:
            if parent is None:
                placed[name] = (self.turn[name], self.root)
            else:
                rotation, position = placed[parent]
                placed[name] = (mul(rotation, self.turn[name]), add(position, apply(rotation, offset)))
        return placed

    def bend_spine(self, yaw=0, pitch=0, roll=0):
        """Shares a turn of the chest against the hips among the three spine joints, more of the twist higher up."""
        for name, twist, bend in (("Spine", 0.22, 0.36), ("Spine1", 0.34, 0.34), ("Chest", 0.44, 0.30)):
            self.turn[name] = turned(yaw * twist, pitch * bend, roll * bend)

    def look(self, yaw=0, pitch=0, roll=0):
        """Turns the head to an orientation in the world, shared with the neck. Needs hips and spine set before."""
        chest = self.world()["Chest"][0]
        against_chest = mul(transpose(chest), turned(yaw, pitch, roll))
        self.turn["Neck"] = part_of(against_chest, 0.42)
        self.turn["Head"] = part_of(against_chest, 0.58)

    def arm(self, side, flex=0, abduct=0, twist=0, elbow=0, wrist=0, shrug=0):
        """From hanging down: flex forward, abduct sideways, twist outward; shrug lifts the collar."""
        sign = SIDES[side]
        hang = rot_z(-45 * sign)  # from the A pose to hanging straight down
        self.turn[side + "Shoulder"] = rot_z(sign * shrug)
        self.turn[side + "Arm"] = product(rot_z(sign * (abduct - shrug)), rot_x(-flex), rot_y(sign * twist), hang)
        self.turn[side + "ForeArm"] = product(transpose(hang), rot_x(-elbow), hang)
        self.turn[side + "Hand"] = product(transpose(hang), rot_x(-wrist), hang)

    def leg(self, side, foot, knee_out=0):
        """Two-bone inverse kinematics: the knee bends about an axis across the mean heading of hips and foot."""
        hips_rotation, hips_position = self.turn["Hips"], self.root
        hip = add(hips_position, apply(hips_rotation, OFFSET[side + "UpLeg"]))
        thigh, shank = OFFSET[side + "Leg"], OFFSET[side + "Foot"]
        reach = sub(foot.ankle, hip)
        distance = math.sqrt(dot(reach, reach))
        low, high = 2.0, 150.0  # degrees of knee flexion; never quite straight, so that the knee cannot snap back
        longest = add(thigh, apply(rot_x(low), shank))
        self.shortfall = max(self.shortfall, distance - math.sqrt(dot(longest, longest)))
        for _ in range(50):
            knee = (low + high) / 2
            span = add(thigh, apply(rot_x(knee), shank))
            low, high = (knee, high) if dot(span, span) > distance * distance else (low, knee)
        span = add(thigh, apply(rot_x(knee), shank))

        hips_yaw = math.degrees(math.atan2(hips_rotation[0][2], hips_rotation[2][2]))
        difference = (foot.yaw - hips_yaw + 180) % 360 - 180
        across = apply(rot_y(hips_yaw + 0.5 * difference + SIDES[side] * knee_out), (1, 0, 0))
        down = normalized(reach)
        axis = normalized(sub(across, scale(down, dot(across, down))))
        world_basis = transpose((axis, down, cross(axis, down)))
        local_down = normalized(span)
        local_basis = transpose(((1, 0, 0), local_down, cross((1, 0, 0), local_down)))
        thigh_world = mul(world_basis, transpose(local_basis))
        shank_world = mul(thigh_world, rot_x(knee))
        self.turn[side + "UpLeg"] = mul(transpose(hips_rotation), thigh_world)
        self.turn[side + "Leg"] = rot_x(knee)
        self.turn[side + "Foot"] = mul(transpose(shank_world), turned(foot.yaw, foot.pitch))
        self.turn[side + "Toe"] = rot_x(foot.toe)

    def mirrored(self):
        """Left and right exchanged."""
        pose = Pose((-self.root[0], self.root[1], self.root[2]))
        pose.shortfall = self.shortfall
        for name, matrix in self.turn.items():
            if name.startswith("Left"):
                name = "Right" + name[4:]
            elif name.startswith("Right"):
                name = "Left" + name[5:]
            signs = (-1, 1, 1)
            pose.turn[name] = tuple(tuple(signs[i] * signs[j] * matrix[i][j] for j in range(3)) for i in range(3))
        return pose


class Track:
    """A smooth curve through (time, value) keys that never overshoots them, periodic where a period is given.

    Monotone cubic (Fritsch and Carlson 1980), then averaged over `soften` seconds to either side, which takes the kinks
    out of the acceleration."""

    def __init__(self, keys, period=None, soften=0.06):
        self.soften, self.period = soften, period
        keys = sorted(keys)
        if period:
            keys = [key for key in keys if key[0] < keys[0][0] + period - 1e-9]  # a last key may repeat the first
            before = [(t - period, v) for t, v in keys]
            after = [(t + period, v) for t, v in keys]
            keys = before + keys + after
        self.times = [t for t, _ in keys]
        self.values = [v for _, v in keys]
        steps = [self.times[i + 1] - self.times[i] for i in range(len(keys) - 1)]
        slopes = [(self.values[i + 1] - self.values[i]) / steps[i] for i in range(len(steps))]
        self.tangents = [0.0] * len(keys)
        for i in range(1, len(keys) - 1):
            a, b = slopes[i - 1], slopes[i]
            if a * b > 0:
                w1, w2 = 2 * steps[i] + steps[i - 1], steps[i] + 2 * steps[i - 1]
                self.tangents[i] = (w1 + w2) / (w1 / a + w2 / b)

    def _sharp(self, t):
        if self.period:
            t %= self.period
        if t <= self.times[0]:
            return self.values[0]
        if t >= self.times[-1]:
            return self.values[-1]
        i = max(k for k in range(len(self.times)) if self.times[k] <= t)
        return hermite(t, self.times[i], self.times[i + 1], self.values[i], self.values[i + 1], self.tangents[i],
                       self.tangents[i + 1])

    def __call__(self, t):
        if not self.soften:
            return self._sharp(t)
        weights = (1, 2, 3, 4, 3, 2, 1)
        samples = (self._sharp(t + self.soften * (k - 3) / 3) for k in range(7))
        return sum(w * s for w, s in zip(weights, samples)) / 16


def hermite(t, t0, t1, v0, v1, slope0, slope1):
    h = t1 - t0
    s = (t - t0) / h
    return (v0 * (1 + 2 * s) * (1 - s) ** 2 + v1 * s * s * (3 - 2 * s) + h * slope0 * s * (1 - s) ** 2
            + h * slope1 * s * s * (s - 1))


def ease(s):
    """0 to 1 with zero velocity and acceleration at both ends (minimum jerk)."""
    s = max(0.0, min(1.0, s))
    return s * s * s * (10 + s * (6 * s - 15))


def _euler_yxz(matrix, near):
    """Angles y, x, z of R_y R_x R_z, on the branch nearest to `near`, so that channels do not jump by turns."""
    x = math.asin(max(-1.0, min(1.0, -matrix[1][2])))
    y = math.atan2(matrix[0][2], matrix[2][2])
    z = math.atan2(matrix[1][0], matrix[1][1])
    candidates = []
    for angles in ((y, x, z), (y + math.pi, math.pi - x, z + math.pi)):
        unwrapped = []
        for angle, old in zip(angles, near):
            degrees = math.degrees(angle)
            unwrapped.append(degrees - 360 * round((degrees - old) / 360))
        candidates.append(unwrapped)
    return min(candidates, key=lambda c: sum((a - b) ** 2 for a, b in zip(c, near)))


def _short(value, decimals):
    text = f"{value:.{decimals}f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def _write_joint(lines, name, depth):
    pad = "  " * depth
    x, y, z = (_short(v, 3) for v in OFFSET[name])
    lines.append(f"{pad}{'JOINT' if PARENT[name] else 'ROOT'} {name}")
    lines.append(pad + "{")
    lines.append(f"{pad}  OFFSET {x} {y} {z}")
    position = "" if PARENT[name] else "Xposition Yposition Zposition "
    lines.append(f"{pad}  CHANNELS {3 if PARENT[name] else 6} {position}Yrotation Xrotation Zrotation")
    for child in children(name):
        _write_joint(lines, child, depth + 1)
    if name in END_SITES:
        x, y, z = (_short(v, 3) for v in END_SITES[name])
        lines += [f"{pad}  End Site", pad + "  {", f"{pad}    OFFSET {x} {y} {z}", pad + "  }"]
    lines.append(pad + "}")


def children(name):
    return [child for child, parent, _ in JOINTS if parent == name]


def _depth_first(name="Hips"):
    yield name
    for child in children(name):
        yield from _depth_first(child)


def write_bvh(path, poses, frames_per_second=60):
    """Writes the poses. The trunk, whose motion reaches the hair, keeps 3 decimals, the limbs 2."""
    lines = ["HIERARCHY"]
    _write_joint(lines, "Hips", 0)
    lines += ["MOTION", f"Frames: {len(poses)}", f"Frame Time: {1 / frames_per_second:.8f}"]
    near = {name: (0.0, 0.0, 0.0) for name in OFFSET}
    order = list(_depth_first())
    for pose in poses:
        row = [_short(v, 3) for v in pose.root]
        for name in order:
            near[name] = _euler_yxz(pose.turn[name], near[name])
            decimals = 3 if name in ("Hips", "Spine", "Spine1", "Chest", "Neck", "Head") else 2
            row += [_short(v, decimals) for v in near[name]]
        lines.append(" ".join(row))
    with open(path, "w", newline="\n") as file:
        file.write("\n".join(lines) + "\n")
