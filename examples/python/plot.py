"""Tip paths of a head shake, and how error and cost of the time step trade (a Pareto chart).
plot.py HAIR.obj FOLDER; pictures with matplotlib where it is installed, CSV in any case."""

import csv
import pathlib
import sys

import numpy as np

import hairmesh
from hairmesh import study

STEPS = [1 / 30, 1 / 60, 1 / 120, 1 / 240, 1 / 480]  # s; the last one is the reference


def paths(mesh, dt, **values):
    """Tips, (frames at 30 Hz, columns, 3) in m, over two seconds, and the counted work of a simulated second."""
    clip, every, work, tips = study.Clip.shake(2, dt=dt), round(1 / 30 / dt), 0.0, []
    hair = hairmesh.Hair(mesh, **values)
    for frame, place in enumerate(clip.head):
        work += hair.step(dt, head=hairmesh.pose(place[:3], place[3:]))["work"]
        if frame % every == 0:
            tips.append(hair.positions[mesh.tips])
    return np.array(tips), work / 2


def pareto(mesh):
    """Rows: integrator, step (s), work a second, RMS distance to the reference over the hair's length."""
    exact, _ = paths(mesh, STEPS[-1], integrator="bdf2")
    for integrator in ("linearized-euler", "bdf2"):
        for dt in STEPS[:-1]:
            tips, work = paths(mesh, dt, integrator=integrator)
            error = np.sqrt(np.mean(np.sum((tips - exact) ** 2, axis=2))) / mesh.hair_length
            yield integrator, dt, work, float(error)


def write(file, header, rows):
    with open(file, "w", newline="") as stream:
        csv.writer(stream).writerows([header, *rows])


def main(file, folder):
    folder, mesh = pathlib.Path(folder), hairmesh.Mesh.load(file)
    folder.mkdir(parents=True, exist_ok=True)
    tips, _ = paths(mesh, 1 / 60)
    rows = list(pareto(mesh))
    write(folder / "tips.csv", ["frame", "column", "x", "y", "z"],
          [(f, c, *tips[f, c]) for f in range(len(tips)) for c in range(tips.shape[1])])
    write(folder / "pareto.csv", ["integrator", "step", "work", "error"], rows)
    try:
        import matplotlib
    except ImportError:
        print(f"{folder}: tips.csv, pareto.csv; matplotlib (Debian: python3-matplotlib) is missing for the pictures")
        return
    matplotlib.use("svg")
    from matplotlib import pyplot as plt
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.5))
    for column in range(tips.shape[1]):
        left.plot(tips[:, column, 0], tips[:, column, 2], linewidth=0.7)
    left.set(title="Paths of the tips, from above", xlabel="x, m", ylabel="z, m", aspect="equal")
    for name, mark in (("linearized-euler", "o-"), ("bdf2", "s-")):
        points = np.array([row[1:] for row in rows if row[0] == name])
        right.loglog(points[:, 1], points[:, 2], mark, label=name)
        for dt, work, error in points:
            right.annotate(f"1/{round(1 / dt)} s", (work, error), textcoords="offset points", xytext=(5, 4), fontsize=8)
    right.set(title="Cost and error", xlabel="units of work a simulated second", ylabel="RMS error / hair length")
    right.legend()
    figure.tight_layout()
    figure.savefig(folder / "plot.svg")
    print(f"{folder}: tips.csv, pareto.csv, plot.svg")


if __name__ == "__main__":
    main(*sys.argv[1:])
