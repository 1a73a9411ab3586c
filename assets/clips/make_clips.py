#!/usr/bin/env python3
"""Writes this project's own motion clips: python3 assets/clips/make_clips.py [folder]

Every clip is a function from time to pose, sampled at 60 frames per second; feet stand on y = 0 by inverse kinematics,
and every clip ends in the pose and velocity it began with (walk: some strides further on), so that it loops. The same
Python gives the same bytes: no randomness, no clock. The figure is described in figure.py. Measures are centimetres,
degrees, seconds; yaw turns left, pitch forward, roll to the right.
"""
import math
import os
import sys

from figure import (ANKLE_HEIGHT, BALL, HEEL, Foot, Pose, Track, add, apply, ease, grounded, hermite, mix, rot_y, scale,
                    sub, turned, write_bvh)

FPS = 60
TAU = 2 * math.pi


def wave(t, period, phase=0.0):
    """Sine with the period, ahead by `phase` of a cycle."""
    return math.sin(TAU * (t / period + phase))


def bump(t, start, end):
    """0 outside, a smooth hill of height 1 between."""
    return math.sin(math.pi * ease((t - start) / (end - start))) ** 2 if start < t < end else 0.0


def window(t, start, end, ramp):
    """0 outside, 1 inside, eased over `ramp` at both ends."""
    return ease((t - start) / ramp) * ease((end - t) / ramp)


# ------------------------------------------------------------------------------------------------- idle with head turns

IDLE = 10.0
IDLE_YAW = Track([(0, 0), (0.6, 0), (1.5, 56), (2.2, 58), (3.5, -60), (4.3, -62), (5.4, 0), (8.2, 4), (9.2, -5),
                  (10, 0)], IDLE)
IDLE_PITCH = Track([(0, 0), (1.8, -6), (3.0, 6), (4.2, -4), (5.6, 0), (6.0, 24), (6.45, -8), (6.9, 22), (7.4, -3),
                    (8, 0), (8.6, 6), (10, 0)], IDLE)
IDLE_ROLL = Track([(0, 0), (1.7, -5), (4.0, 5), (5.4, 0), (7.7, 0), (8.4, 17), (9.1, -9), (10, 0)], IDLE)


def idle_turns(t):
    """Standing at ease: breathing, weight from foot to foot, the head turning far left and right, nodding, tilting."""
    breath, sway = wave(t, IDLE / 3), wave(t, IDLE)
    yaw, pitch, roll = IDLE_YAW(t), IDLE_PITCH(t), IDLE_ROLL(t)
    pose = Pose((2.2 * sway, 93.0 - 0.5 * sway * sway + 0.12 * breath, -0.6 + 0.4 * wave(t, IDLE / 2)))
    pose.turn["Hips"] = turned(0.06 * yaw + 1.5 * sway, 1.5, 2.2 * sway)
    pose.bend_spine(0.16 * yaw, 0.5 - 1.0 * breath + 0.10 * pitch, -2.6 * sway + 0.12 * roll)
    pose.look(yaw, pitch + 0.5 * breath, roll)
    for side, sign in (("Left", 1), ("Right", -1)):
        pose.arm(side, flex=2 + 0.8 * breath + sign * sway, abduct=9 + 0.6 * breath, twist=-12, elbow=15 + 1.5 * breath,
                 wrist=4, shrug=0.9 * breath)
    pose.leg("Left", grounded(9.5, 0.5, yaw=9), knee_out=4)
    pose.leg("Right", grounded(-9.5, -1.0, yaw=-10), knee_out=4)
    return pose


# ----------------------------------------------------------------------------------------------------------------- walk

STRIDE_TIME = 1.1  # s, both steps
WALK_SPEED = 110.0  # cm/s
STRIDE = STRIDE_TIME * WALK_SPEED
STRIDES = 6
WALK_START = 0.3 * STRIDE_TIME  # one leg passes the other: no foot strikes at the loop's seam
WALK = STRIDES * STRIDE_TIME
STANCE = 0.62  # of the stride with the foot on the ground
SWING_LIFT = 4.5  # cm, over the arc that leaves and arrives smoothly
REACH = 29.0  # cm, flat ankle ahead of the hips at heel strike
# Pitch of the foot over the stride: heel strike, foot flat, heel off, toe off, swing. Human gait after Winter 1991.
WALK_PITCH = Track([(0, -17), (0.085, 0), (0.36, 0), (0.50, 20), (0.62, 54), (0.67, 58), (0.80, 12), (0.88, -8),
                    (0.95, -18)], 1.0, soften=0.012)
WALK_LOOK = Track([(0, 0), (1.4, 14), (3.3, -4), (4.8, -16), (6.6, 0)], WALK, soften=0.2)


def stance_foot(phase, x, yaw):
    """The foot over the ground, relative to the place where it struck."""
    return grounded(x, 0, yaw, WALK_PITCH(phase))


def walking_foot(t, side):
    """World foot at time t; the left one strikes at t = 0, the right one half a stride later."""
    x, yaw = (5.5, 6) if side == "Left" else (-5.5, -6)
    cycles = t / STRIDE_TIME + (0 if side == "Left" else 0.5)
    count = math.floor(cycles + 1e-9)
    phase = max(0.0, cycles - count)
    struck_at = (count - (0 if side == "Left" else 0.5)) * STRIDE + REACH - WALK_SPEED * WALK_START
    if phase <= STANCE:
        foot = stance_foot(phase, x, yaw)
        return Foot(add(foot.ankle, (0, 0, struck_at)), yaw, foot.pitch, foot.toe)
    # Swing: leaves and arrives with the velocities that the stance has there.
    step = 1e-3
    off, off_before = stance_foot(STANCE, x, yaw).ankle, stance_foot(STANCE - step, x, yaw).ankle
    on, on_after = stance_foot(0, x, yaw).ankle, stance_foot(step, x, yaw).ankle
    on, on_after = add(on, (0, 0, STRIDE)), add(on_after, (0, 0, STRIDE))
    slope_off, slope_on = scale(sub(off, off_before), 1 / step), scale(sub(on_after, on), 1 / step)
    ankle = [hermite(phase, STANCE, 1.0, off[k], on[k], slope_off[k], slope_on[k]) for k in range(3)]
    swing = (phase - STANCE) / (1 - STANCE)
    ankle[1] += SWING_LIFT * math.sin(math.pi * swing) ** 2
    pitch = WALK_PITCH(phase)
    toe = -max(0.0, pitch) * (1 - ease((swing - 0.1) / 0.45)) - 6 * math.sin(math.pi * swing) ** 2
    return Foot((ankle[0], ankle[1], ankle[2] + struck_at), yaw, pitch, toe)


def walk(t):
    """Walking forward at 1.1 m/s: pelvis and shoulders turn against each other, the head looks around, level."""
    t += WALK_START
    u = t / STRIDE_TIME
    turn, double = math.cos(TAU * u), math.cos(2 * TAU * (u - 0.04))
    look = WALK_LOOK(t)
    pose = Pose((1.9 * math.cos(TAU * (u - 0.31)), 90.2 - 1.9 * double,
                 WALK_SPEED * (t - WALK_START) - math.sin(2 * TAU * (u - 0.02))))
    pose.turn["Hips"] = turned(-5.5 * turn, 3.0 + 0.8 * double, 3.2 * math.cos(TAU * (u - 0.20)))
    pose.bend_spine(10.5 * turn + 0.1 * look, 0.5 + 1.2 * double, -4.6 * math.cos(TAU * (u - 0.20)))
    pose.look(look + 0.8 * turn, 1.5 - 1.4 * math.cos(2 * TAU * (u - 0.12)),
              0.05 * look + 0.9 * math.cos(TAU * (u - 0.25)))
    for side, sign in (("Left", 1), ("Right", -1)):
        swing = sign * math.cos(TAU * (u - 0.03))  # 1 when this side's leg is in front
        delayed = sign * math.cos(TAU * (u - 0.07))
        pose.arm(side, flex=-1 - 21 * swing, abduct=8 + 1.5 * delayed, twist=-16, elbow=21 - 9 * delayed,
                 wrist=4 - 4 * delayed, shrug=0.8 * double)
        pose.leg(side, walking_foot(t, side), knee_out=1)
    return pose


# ----------------------------------------------------------------------------------------------------------- head shake

SHAKE = 8.0


def head_shake(t):
    """Hair show: fast 'no' (peak about 600 degrees per second), head banging, two wide circles of the head."""
    no = window(t, 0.4, 3.0, 0.5)
    bang = window(t, 3.0, 5.4, 0.45)
    circle = window(t, 5.4, 7.8, 0.5)
    side_phase = wave(t - 0.4, 0.5)
    beat, trail = wave(t - 3.1, 0.6, -0.25), wave(t - 3.1, 0.6, -0.37)
    angle = TAU * (t - 5.4) / 1.1
    yaw = 48 * no * side_phase + 8 * circle * math.sin(angle + 0.6)
    pitch = 6 * no + bang * (16 + 34 * beat) + circle * (4 + 28 * math.cos(angle))
    roll = 4 * no * wave(t - 0.4, 0.5, -0.2) + 26 * circle * math.sin(angle)
    dip = bang * (1.6 + 1.4 * trail)
    pose = Pose((1.0 * circle * math.sin(angle), 92.4 - dip - 1.0 * no, -0.8 - 1.6 * bang * (1 + 0.5 * trail)))
    pose.turn["Hips"] = turned(-5 * no * wave(t - 0.4, 0.5, -0.15), 2 + 5 * bang + 3 * bang * trail,
                               2 * circle * math.sin(angle - 0.5))
    pose.bend_spine(6 * no * wave(t - 0.4, 0.5, -0.08),
                    3 * no + bang * (10 + 11 * trail) + circle * (4 + 7 * math.cos(angle - 0.4)),
                    7 * circle * math.sin(angle - 0.4))
    pose.look(yaw, pitch + 5 * bang, roll)
    for side, sign in (("Left", 1), ("Right", -1)):
        pose.arm(side, flex=4 + 10 * bang + 5 * bang * trail + 3 * sign * no * side_phase,
                 abduct=11 + 9 * no + 8 * circle + 2 * circle * sign * math.sin(angle), twist=-14,
                 elbow=18 + 22 * no + 16 * bang - 6 * bang * trail + 18 * circle, wrist=5, shrug=2 * bang * (1 + trail))
    pose.leg("Left", grounded(11, 1.5, yaw=12), knee_out=5)
    pose.leg("Right", grounded(-11, -1.5, yaw=-12), knee_out=5)
    return pose


# ----------------------------------------------------------------------------------------------------------- jump, spin

JUMP = 8.0  # a full turn to the left in the air, then its mirror image
TAKE_OFF, FLIGHT = 1.34, 0.50
LANDING = TAKE_OFF + FLIGHT
FLIGHT_SPEED = 981 * FLIGHT / 2  # cm/s at take-off and landing: 31 cm of height
JUMP_YAW = Track([(0, 0), (0.35, 0), (1.0, -34), (1.34, 36), (1.59, 182), (1.84, 330), (2.1, 366),
                  (2.7, 360), (4, 360)], soften=0.04)
JUMP_TWIST = Track([(0, 0), (0.35, 0), (1.0, -20), (1.28, 14), (1.6, 10), (1.9, -8), (2.2, 8), (2.8, 0), (4, 0)])
JUMP_LEAN = Track([(0, 0), (0.3, 0), (0.98, 24), (1.34, 2), (1.7, 2), (1.86, 8), (2.14, 26), (3.0, 0), (4, 0)])
JUMP_FOLD = Track([(0, 0), (1.16, 0), (1.42, 1), (1.68, 1), (1.95, 0), (4, 0)])  # arms folded on the chest
JUMP_OPEN = Track([(0, 0), (0.4, 0), (1.0, 0.55), (1.3, 0.15), (1.75, 0.1), (2.08, 1), (2.5, 0.7), (3.3, 0), (4, 0)])
JUMP_HEEL = Track([(0, 0), (1.12, 0), (1.34, 54), (1.36, 54)], soften=0.02)
LANDING_HEEL = Track([(1.82, 30), (1.84, 30), (1.95, 0), (4, 0)], soften=0.015)
STAND, CROUCH, LAUNCH, DEEP = 93.1, 70.0, 97.0, 66.0  # height of the hips


def jump_height(t):
    """Height of the hips: crouch, push off, a parabola of gravity, knees taking up the landing, standing up."""
    if t < 0.4:
        return STAND
    if t < 1.0:
        return STAND + (CROUCH - STAND) * ease((t - 0.4) / 0.6)
    if t < TAKE_OFF:
        return hermite(t, 1.0, TAKE_OFF, CROUCH, LAUNCH, 0, FLIGHT_SPEED)
    if t < LANDING:
        s = t - TAKE_OFF
        return LAUNCH + FLIGHT_SPEED * s - 981 * s * s / 2
    if t < LANDING + 0.34:
        return hermite(t, LANDING, LANDING + 0.34, LAUNCH, DEEP, -FLIGHT_SPEED, 0)
    return DEEP + (STAND - DEEP) * ease((t - LANDING - 0.34) / 1.0)


JUMP_FORWARD = Track([(0, -0.8), (0.4, -0.8), (1.0, -4), (1.34, 6), (1.84, 4), (2.16, -3), (3.1, -0.8), (4, -0.8)])


def jump_root(t):
    return (0.0, jump_height(t), JUMP_FORWARD(t))


def jumping_foot(t, side):
    x, yaw = (10, 7) if side == "Left" else (-10, -7)
    if t <= TAKE_OFF:
        return grounded(x, 0, yaw, JUMP_HEEL(t))
    if t >= LANDING:
        return grounded(x, 0, yaw, LANDING_HEEL(t))
    # In the air the feet keep their place under the hips, drawn up a little, and turn with the body.
    s = (t - TAKE_OFF) / FLIGHT
    leave = sub(grounded(x, 0, yaw, JUMP_HEEL(TAKE_OFF)).ankle, jump_root(TAKE_OFF))
    land = sub(grounded(x, 0, yaw, LANDING_HEEL(LANDING)).ankle, jump_root(LANDING))
    heading = 360 * (0.5 * ease(s) + 0.5 * s * s * (3 - 2 * s))
    tuck = math.sin(math.pi * s) ** 2
    local = add(mix(leave, land, ease(s)), (-0.35 * x * tuck, 7 * tuck, (-5 if side == "Left" else 1) * tuck))
    pitch = JUMP_HEEL(TAKE_OFF) + (LANDING_HEEL(LANDING) - JUMP_HEEL(TAKE_OFF)) * ease(s)
    toe = -JUMP_HEEL(TAKE_OFF) * (1 - ease(s / 0.4)) - LANDING_HEEL(LANDING) * ease((s - 0.6) / 0.4)
    return Foot(add(jump_root(t), apply(rot_y(heading), local)), heading + yaw, pitch, toe)


def jump_spin_left(t):
    fold, spread, lean, twist = JUMP_FOLD(t), JUMP_OPEN(t), JUMP_LEAN(t), JUMP_TWIST(t)
    yaw = JUMP_YAW(t)
    breath = wave(t, 4.0)
    pose = Pose(jump_root(t))
    pose.turn["Hips"] = turned(yaw, 1.5 + 0.6 * lean, 0)
    pose.bend_spine(twist, 0.8 * lean - 0.4 * breath, 0)
    pose.look(yaw + 1.25 * twist, 0.35 * lean + 0.3 * breath, 0)
    winding = bump(t, 0.4, 1.5)
    for side, lead in (("Left", 1), ("Right", -1)):
        # Winding up to the right, the left arm crosses in front and the right one swings back.
        flex = 3 + 34 * lead * winding + fold * (34 + 4 * lead) + 16 * spread
        abduct = 9 + 40 * spread - 14 * winding * (lead > 0) - 10 * fold
        elbow = 15 + 32 * winding * (lead > 0) + 100 * fold + 22 * spread
        pose.arm(side, flex=flex, abduct=abduct, twist=-12 - 44 * fold, elbow=elbow, wrist=4 + 10 * fold,
                 shrug=5 * spread)
        pose.leg(side, jumping_foot(t, side), knee_out=6)
    return pose


def jump_spin(t):
    """Crouch, jump, a full turn in the air, landing in bent knees; to the left, then to the right."""
    half = JUMP / 2
    return jump_spin_left(t) if t < half else jump_spin_left(t - half).mirrored()


# ---------------------------------------------------------------------------------------------------------------- dance

DANCE = 8.0  # 120 beats a minute, 16 beats
ARMS_UP = Track([(0, 0), (2.0, 0), (3.1, 1), (5.6, 1), (6.9, 0), (8, 0)], DANCE, soften=0.15)
DANCE_YAW = Track([(0, 0), (1.0, 22), (2.0, -18), (3.0, 12), (4.2, -26), (5.4, 28), (6.6, -14),
                   (8, 0)], DANCE, soften=0.15)
# Step-touch over two seconds: the leading foot steps out, the other closes, and back again.
STEP_LEFT = Track([(0.06, 9), (0.44, 27), (1.56, 27), (1.94, 9)], 2.0, soften=0.03)
STEP_RIGHT = Track([(0.56, -9), (0.94, 9), (1.06, 9), (1.44, -9)], 2.0, soften=0.03)
BODY_ACROSS = Track([(0.0, 3), (0.5, 15), (1.0, 15), (1.5, 3), (2.0, 3)], 2.0, soften=0.18)


def dancing_foot(t, side):
    cycle = t % 2.0
    swings = ((0.01, 0.49), (1.51, 1.99)) if side == "Left" else ((0.51, 0.99), (1.01, 1.49))
    lift = sum(bump(cycle, start, end) for start, end in swings)
    x = (STEP_LEFT if side == "Left" else STEP_RIGHT)(cycle) - 9
    flat = grounded(x, 0, 8 if side == "Left" else -8, 22 * lift)
    return Foot(add(flat.ankle, (0, 6 * lift, 0)), flat.yaw, flat.pitch, flat.toe * 0.4)


def dance(t):
    """Step-touch on the beat, hips swaying, arms swinging low, then raised overhead, head and chest following."""
    up, sway, beat = ARMS_UP(t), wave(t, 2.0, -0.12), math.cos(TAU * t / 0.5)
    double, roll_wave = wave(t, 1.0), wave(t, 1.0, -0.18)
    look = DANCE_YAW(t)
    pose = Pose((BODY_ACROSS(t) - 9, 88.6 + 1.5 * beat, -1.0 + 1.5 * wave(t, 1.0, 0.2)))
    pose.turn["Hips"] = turned(9 * roll_wave, 3, -6.0 * sway + 2.0 * double)
    pose.bend_spine(-13 * roll_wave + 0.2 * look, 1 - 4 * up + 1.8 * beat, 9.0 * sway - 2.5 * double)
    pose.look(look, 2 - 7 * up + 5.0 * math.cos(TAU * (t / 0.5 - 0.12)), -7.0 * wave(t, 2.0, -0.22))
    for side, sign in (("Left", 1), ("Right", -1)):
        swing = sign * wave(t, 1.0, -0.1)
        low_flex, low_abduct, low_elbow = 12 + 26 * swing, 16 + 5 * swing, 62 + 14 * swing
        high_flex, high_abduct, high_elbow = 12 + 5 * swing, 150 + 9 * sign * wave(t, 2.0, -0.2), 46 - 14 * swing
        pose.arm(side, flex=low_flex + (high_flex - low_flex) * up, abduct=low_abduct + (high_abduct - low_abduct) * up,
                 twist=-14 + 62 * up, elbow=low_elbow + (high_elbow - low_elbow) * up,
                 wrist=6 + 10 * up * sign * wave(t, 1.0), shrug=22 * up)
        pose.leg(side, dancing_foot(t, side), knee_out=7)
    return pose


CLIPS = {
    "idle_turns": (idle_turns, IDLE),
    "walk": (walk, WALK),
    "head_shake": (head_shake, SHAKE),
    "jump_spin": (jump_spin, JUMP),
    "dance": (dance, DANCE),
}


SOLE = BALL[1] + ANKLE_HEIGHT  # thickness under the ball of the foot


def lowest_point(pose):
    """Height of the lowest of heels, balls and toe tips."""
    world = pose.world()
    heights = []
    for side in ("Left", "Right"):
        rotation, ankle = world[side + "Foot"]
        heights += [add(ankle, apply(rotation, HEEL))[1], add(ankle, apply(rotation, BALL))[1] - SOLE]
        rotation, toe = world[side + "Toe"]
        heights.append(add(toe, apply(rotation, (0, -SOLE, 6)))[1])
    return min(heights)


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(os.path.abspath(__file__))
    for name, (pose_at, duration) in CLIPS.items():
        frames = round(duration * FPS)
        poses = [pose_at(frame / FPS) for frame in range(frames + 1)]
        path = os.path.join(folder, name + ".bvh")
        write_bvh(path, poses, FPS)
        print(f"{name}: {len(poses)} frames, {os.path.getsize(path) / 1024:.0f} KB, lowest point "
              f"{min(lowest_point(pose) for pose in poses):.1f} cm, longest leg shortfall "
              f"{max(pose.shortfall for pose in poses):.2f} cm")


if __name__ == "__main__":
    main()
