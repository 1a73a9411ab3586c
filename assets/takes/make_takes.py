#!/usr/bin/env python3
"""Writes the hands of six hairdos as takes: from a shaved head to strokes, paint, ties and hats while it moves. Give each
its end by replaying it: make_takes.py PROGRAM. See app/files/recording.h; places are metres in the scalp's frame."""
import json
import math
import os
import subprocess
import sys


def scene(name, motion="idle_turns.bvh", **more):
    character = {"motion": motion, "style": "shaved", "resolution": "medium", **more}
    return {"name": name, "characters": [character], "camera": {"view": "three-quarter", "framing": "head"}, "playback": {"settle": 1.0}}


def brush(tool, at, along=(0, 0, 0), radius=0.04, strength=0.5, falloff=1, mirror=0):
    return ["brush", tool, " ".join(repr(float(v)) for v in (*at, *along, radius, strength, falloff, mirror)), 0]


def dye(at, color, radius=0.05, strength=0.6, mirror=1):
    return ["paint", "color", " ".join(repr(float(v)) for v in (*at, radius, strength, 1, mirror, *color)), 0]


def checksum(before, state):
    """FNV-1a of a take's text before its last line and of its state, as recording.h says."""
    value = 0xCBF29CE484222325
    for byte in (before + state).encode():
        value = (value ^ byte) * 0x100000001B3 & 0xFFFFFFFFFFFFFFFF
    return f"{value:016x}"


def ask(what, name="", text="", value=0):
    return [what, name, text, value]


def ring(height, radius, n, start=1.0, end=2 * math.pi - 1.0):
    """Places around the head from the left temple over the nape to the right one."""
    turns = [start + (end - start) * k / (n - 1) for k in range(n)]
    return [(radius * math.sin(t), height, radius * math.cos(t) - 0.01) for t in turns]


def base(style, *then):
    """The shaved head, then the hair that a hairdo is cut, combed or tied from, while the figure stands still."""
    yield [ask("pause-motion", value=1)]
    for k in range(20):
        yield []
    yield [ask("style", style)]
    for k in range(10):
        yield []
    for request in then:
        yield [request]
        for k in range(20):
            yield []
    yield [ask("pause-motion")]


def chin_bob():
    """Long hair cut level with the chin, all around; ends drawn in; a fringe painted short."""
    yield from base("long")
    for p in ring(-0.075, 0.105, 40):
        yield [brush("cut", p, radius=0.06, strength=0.9)]
    yield [ask("end-gesture")]
    for p in ring(0.02, 0.09, 24):
        yield [brush("pinch", p, radius=0.07, strength=0.25)]
    yield [ask("end-gesture"), ask("curve", "stiffness", "1,1.2,2")]


def strip(share, off=0.105):
    """A place over the middle of the head: 0 over the forehead, 1 at the nape."""
    turn = math.radians(35 + 145 * share)
    return (0.0, 0.085 + off * math.sin(turn), off * math.cos(turn))


def crest():
    """A strip grown from the shaved head, and dyed."""
    for k in range(10):
        yield []
    for k in range(36):
        yield [brush("grow", strip(share / 6), radius=0.035, strength=1) for share in range(7)]
    yield [ask("end-gesture")]
    for k in range(20):
        yield [dye(strip(share / 6), (1.0, 0.4, 0.35), radius=0.06) for share in range(7)]
    yield [ask("end-gesture")]


def side_sweep():
    """Front and crown combed over to the figure's left, ends twisted."""
    yield from base("long")
    yield [ask("set", "sag_free", "on")]
    for stroke in range(4):
        for k in range(14):
            t = k / 13
            at = (-0.05 + 0.11 * t, 0.175 - 0.05 * t * t, 0.06 - 0.03 * stroke)
            yield [brush("comb", at, (0.009, -0.001 - 0.005 * t, 0.0), radius=0.05, strength=0.7)]
        yield [ask("end-gesture")]
    for k in range(16):
        yield [brush("twist", (0.09, -0.02 - 0.006 * k, 0.0), radius=0.09, strength=0.4)]


def half_up():
    """What is rooted high is tied behind the head, the rest spread and its ends cut."""
    yield from base("long", ask("tie", "", json.dumps({"at": "back", "radius": 0.02, "above": 0.0})))
    for p in ring(-0.05, 0.10, 20, 2.4, 2 * math.pi - 2.4):
        yield [brush("spread", p, radius=0.09, strength=0.2)]
    yield [ask("end-gesture")]
    for p in ring(-0.15, 0.10, 20, 2.4, 2 * math.pi - 2.4):
        yield [brush("cut", p, radius=0.09, strength=0.5)]
    yield [ask("end-gesture")]


def under_the_beanie():
    """Grown a little, a beanie put on, the ends that hang out turned outwards and made heavier."""
    yield from base("shoulder")
    for p in ring(-0.05, 0.10, 24):
        yield [brush("grow", p, radius=0.07, strength=0.3)]
    yield [ask("end-gesture"), ask("attach", "add", "beanie.obj")]
    for k in range(10):
        yield []
    for p in ring(-0.04, 0.10, 24):
        yield [brush("push", p, radius=0.08, strength=0.4)]
    yield [ask("end-gesture"), ask("curve", "mass", "1,1,1.5")]


def behind_the_ear():
    """Long hair combed back over the ears, on both sides, and held behind them."""
    yield from base("long")
    for height in (0.075, 0.045, 0.015, -0.015):
        for k in range(16):
            t = k / 15
            at = (0.082 + 0.012 * math.sin(3.14 * t), height, 0.055 - 0.115 * t)
            yield [brush("comb", at, (0.0006, 0.0, -0.0075), radius=0.045, strength=0.8, mirror=1)]
        yield [ask("end-gesture")]
    for k in range(10):
        t = k / 9
        yield [brush("comb", (0.085, -0.045 - 0.05 * t, 0.04 - 0.09 * t), (0.0, 0.0, -0.0075), radius=0.06, strength=0.7, mirror=1)]
    yield [ask("end-gesture")]


TAKES = {
    "chin_bob": (scene("Chin bob"), chin_bob),
    "crest": (scene("Crest"), crest),
    "side_sweep": (scene("Side sweep"), side_sweep),
    "half_up": (scene("Half up"), half_up),
    "behind_the_ear": (scene("Behind the ear"), behind_the_ear),
    "under_the_beanie": (scene("Under the beanie"), under_the_beanie),
}

for name, (opening, hands) in TAKES.items():
    draft = name + ".draft"
    with open(draft, "w") as file:
        file.write(json.dumps({"hairmesh-recording": 3, "aspect": 1.0, "skips_off": []}) + "\n" + json.dumps(opening) + "\n")
        frames = list(hands()) + [[]] * 20
        for requests in frames:
            file.write(json.dumps([1 / 60, *requests]) + "\n")
    run = subprocess.run([sys.argv[1], "--headless", "--no-images", "--replay", draft, "--record", name + ".take"], capture_output=True, text=True)
    os.remove(draft)
    lines = open(name + ".take").read().splitlines()
    recorded = json.loads(lines[1])
    recorded["characters"][0]["motion"] = opening["characters"][0]["motion"]  # without a folder
    lines[1] = json.dumps(recorded, separators=(",", ":"))
    before, end = "\n".join(lines[:-1]) + "\n", json.loads(lines[-1])
    end["checksum"] = checksum(before, end["state"])
    open(name + ".take", "w").write(before + json.dumps(end, separators=(",", ":")) + "\n")
    print(name, len(frames), "frames", run.stdout.strip().splitlines()[-1:], run.stderr.strip()[-300:])
    run.check_returncode()
