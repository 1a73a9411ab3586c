"""Many simulations, spread over processes or machines by Dask: clips x styles x parameters x seeds.

    from hairmesh import study
    jobs = study.jobs(clips={"shake": study.Clip.shake(10)}, styles={"bob": open("bob.obj").read()},
                      parameters=[{"bend": 0.3}, {"bend": 0.6}], seeds=range(5))
    study.run(jobs, "results")          # a local cluster; scheduler="tcp://host:8786" for any other

results/jobs/KEY.npz has one job's metrics and arrays, results/table.csv a row a job in the order of the jobs. A job is
named by what it is made of, written once, and skipped when it is there: a run that was cut off goes on. Files and table
do not depend on who computed what and when: a worker that dies costs time only. What depends on the machine, time and
memory, is in what run() returns.
"""

import csv
import hashlib
import io
import itertools
import json
import logging
import math
import os
import pathlib
import resource
import shlex
import shutil
import subprocess
import tempfile
import time

import numpy as np

import hairmesh


class Clip:
    """Motion of a head and of the ellipsoids around it. A pose is position and unit quaternion, seven numbers."""

    def __init__(self, dt, head, radii=(), bodies=None):
        """head: (frames, 7); radii: (bodies, 3) in m; bodies: (frames, bodies, 7)."""
        self.dt = float(dt)
        self.head = np.asarray(head, dtype=np.float64).reshape(-1, 7)
        self.radii = np.asarray(radii, dtype=np.float64).reshape(-1, 3)
        self.bodies = np.zeros((len(self.head), 0, 7)) if bodies is None else np.asarray(bodies, dtype=np.float64)
        if self.bodies.shape != (len(self.head), len(self.radii), 7):
            raise ValueError(f"bodies has the shape {self.bodies.shape}; (frames, bodies, 7) are needed")

    @classmethod
    def shake(cls, seconds, degrees=60.0, rate=1.0, dt=1 / 60):
        """The head turns to either side `rate` times a second, with a skull around its joint."""
        angle = math.radians(degrees) * np.sin(2 * math.pi * rate * dt * np.arange(round(seconds / dt)))
        head = np.zeros((len(angle), 7))
        head[:, 4], head[:, 6] = np.sin(angle / 2), np.cos(angle / 2)
        skull = head.copy()
        skull[:, 0], skull[:, 1], skull[:, 2] = 0.005 * np.sin(angle), 0.085, 0.005 * np.cos(angle)
        return cls(dt, head, [[0.072, 0.1, 0.09]], skull[:, None])

    @classmethod
    def load(cls, file):
        """Reads what save() wrote."""
        with np.load(file) as data:
            return cls(data["dt"], data["head"], data["radii"], data["bodies"])

    def save(self, file):
        """Writes a NumPy file with dt, head, radii and bodies."""
        np.savez(file, dt=self.dt, head=self.head, radii=self.radii, bodies=self.bodies)


def _key(parts):
    return hashlib.sha256(b"\0".join(parts)).hexdigest()[:20]


def _draw(parameters, seed, spread):
    """The parameters of a seed: 0 leaves them; another one scales each number by a log-normal factor, in its range."""
    if seed == 0:
        return dict(parameters)
    random, rows, drawn = np.random.default_rng(seed), hairmesh.parameters(), dict(parameters)
    for name in sorted(parameters):
        factor = math.exp(spread * random.standard_normal())
        if rows[name]["kind"] == "real" and not isinstance(parameters[name], str):
            drawn[name] = min(max(parameters[name] * factor, rows[name]["minimum"]), rows[name]["maximum"])
    return drawn


def jobs(clips, styles, parameters=({},), seeds=(0,), spread=0.2, function=None):
    """All combinations as a list of jobs. clips: Clips by name; styles: texts of OBJ files by name; parameters: dicts;
    function: of a job, gives a dict of numbers and arrays (simulate where there is none)."""
    function = function or simulate
    listed = []
    for (clip, motion), (style, text), values, seed in itertools.product(clips.items(), styles.items(), parameters, seeds):
        drawn = _draw(values, seed, spread)
        stamp = json.dumps([hairmesh.version(), function.__module__, function.__qualname__, drawn, seed], sort_keys=True)
        parts = [stamp.encode(), text.encode(), np.float64(motion.dt).tobytes()]
        parts += [array.tobytes() for array in (motion.head, motion.radii, motion.bodies)]
        row = {"clip": clip, "style": style, "seed": seed, "parameters": json.dumps(drawn, sort_keys=True)}
        listed.append({"key": _key(parts), "row": row, "parameters": drawn, "motion": motion, "text": text,
                       "function": function})
    return listed


def program_jobs(commands):
    """Runs of programs as jobs: lists of arguments by name. "{out}" in an argument is a folder of the job's own; what
    the program writes there, and to its output, is kept. The workers need the program."""
    listed = []
    for name, command in commands.items():
        program = shutil.which(command[0])
        digest = hashlib.sha256(pathlib.Path(program).read_bytes()).hexdigest() if program else "absent"
        key = _key([b"program", digest.encode(), *(part.encode() for part in command)])
        row = {"name": name, "command": shlex.join(command)}
        listed.append({"key": key, "row": row, "command": list(command), "function": run_program})
    return listed


def run_program(job):
    """Runs a job of program_jobs. Metrics: the exit status and the number of files."""
    with tempfile.TemporaryDirectory() as folder:
        command = [part.replace("{out}", folder) for part in job["command"]]
        ended = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        files = {"output": ended.stdout}
        for file in sorted(pathlib.Path(folder).rglob("*")):
            if file.is_file():
                files["out/" + str(file.relative_to(folder))] = file.read_bytes()
    arrays = {name: np.frombuffer(data, dtype=np.uint8) for name, data in files.items()}
    return {"metrics": {"exit": ended.returncode, "files": len(files) - 1}, **arrays}


def unpack(listed, folder):
    """Writes what programs wrote as files again: folder/programs/NAME/output and folder/programs/NAME/out/..."""
    for job in listed:
        with np.load(pathlib.Path(folder) / "jobs" / (job["key"] + ".npz")) as data:
            for name in data.files:
                if name != "metrics":
                    file = pathlib.Path(folder) / "programs" / job["row"]["name"] / name
                    file.parent.mkdir(parents=True, exist_ok=True)
                    _write(file, data[name].tobytes())


def simulate(job):
    """Runs a clip once. Metrics: what the tips did relative to the head, steps' counts; arrays: the tips' paths."""
    clip, mesh = job["motion"], hairmesh.Mesh.from_text(job["text"], job["row"]["style"])
    hair = hairmesh.Hair(mesh, head=hairmesh.pose(clip.head[0, :3], clip.head[0, 3:]), **job["parameters"])
    tips, lengths = np.empty((len(clip.head), len(mesh.tips), 3)), np.diff(mesh.rest, axis=0)
    inside = np.setdiff1d(np.arange(len(mesh.rest) - 1), mesh.tips)  # edges along columns
    rest = np.linalg.norm(lengths[inside], axis=1)
    stretch, totals = 0.0, {"solver_iterations": 0, "contacts": 0, "guided": 0, "repaired": 0, "work": 0.0}
    for frame in range(len(clip.head)):
        before = max(frame - 1, 0)
        bodies = [hairmesh.Ellipsoid(radii, place[:3], place[3:], before=hairmesh.pose(was[:3], was[3:]), seconds=clip.dt)
                  for radii, place, was in zip(clip.radii, clip.bodies[frame], clip.bodies[before])]
        report = hair.step(clip.dt, head=hairmesh.pose(clip.head[frame, :3], clip.head[frame, 3:]), ellipsoids=bodies)
        for name in totals:
            totals[name] += report[name]
        positions = hair.positions
        tips[frame] = positions[mesh.tips]
        edges = np.linalg.norm(np.diff(positions, axis=0)[inside], axis=1)
        stretch = max(stretch, float(np.max(np.abs(edges / rest - 1))))
    path = np.linalg.norm(np.diff(tips, axis=0), axis=2).sum(axis=0)
    metrics = {"frames": len(clip.head), "vertices": len(mesh.rest), "tip_path_mean": float(path.mean()),
               "tip_path_max": float(path.max()), "stretch_max": stretch, **totals}
    return {"metrics": metrics, "tips": tips.astype(np.float32)}


def _encode(result):
    """A job's result as the bytes of a NumPy file; the same result gives the same bytes."""
    arrays = {name: value for name, value in result.items() if name != "metrics"}
    buffer = io.BytesIO()
    np.savez_compressed(buffer, metrics=json.dumps(result["metrics"], sort_keys=True), **arrays)
    return buffer.getvalue()


def _work(job):
    """What a worker does with a job: the file's bytes, and what they cost; of a job that raises, its error."""
    start = sum(os.times()[:4])  # processor time, of programs that it started as well
    try:
        data = _encode(job["function"](job))
    except Exception as error:
        return {"key": job["key"], "error": f"{type(error).__name__}: {error}"}
    peak = max(resource.getrusage(who).ru_maxrss for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return {"key": job["key"], "data": data, "seconds": sum(os.times()[:4]) - start, "peak_bytes": 1024 * peak}


def _write(file, data):
    """A file appears whole or not at all."""
    part = file.with_name(file.name + f".{os.getpid()}.part")
    part.write_bytes(data)
    os.replace(part, file)


def _in_turn(todo):
    for job in todo:
        yield _work(job)


def _spread(todo, client):
    """Results as they come. Dask gives the jobs of a worker that died to another one."""
    from dask.distributed import as_completed
    waiting = as_completed([client.submit(_work, job, key=job["key"], pure=False) for job in todo], with_results=True)
    for future, result in waiting:
        yield result
        future.release()


def _client(scheduler, workers):
    try:
        from dask.distributed import Client, LocalCluster
    except ImportError as error:
        raise ImportError('Dask is missing (Debian: python3-distributed); install it, or say scheduler="serial"') from error
    if scheduler is not None:
        return Client(scheduler), None
    cluster = LocalCluster(n_workers=workers or os.cpu_count(), threads_per_worker=1, processes=True,
                           dashboard_address=None, silence_logs=logging.CRITICAL)
    return Client(cluster), cluster


def write_table(listed, folder, failed=None):
    """Writes folder/table.csv of the jobs that are there, in the order given, and of those that failed (errors by key);
    returns its path."""
    rows, failed = [], failed or {}
    for job in listed:
        if job["key"] in failed:
            rows.append({"key": job["key"], **job["row"], "error": failed[job["key"]]})
            continue
        with np.load(folder / "jobs" / (job["key"] + ".npz")) as data:
            metrics = json.loads(str(data["metrics"]))
        rows.append({"key": job["key"], **job["row"], **metrics})
    text = io.StringIO()
    names = list(dict.fromkeys(name for row in rows for name in row))
    table = csv.DictWriter(text, names, lineterminator="\n")
    table.writeheader()
    table.writerows(rows)
    _write(folder / "table.csv", text.getvalue().encode())
    return folder / "table.csv"


def run(listed, folder, scheduler=None, workers=None, client=None, done=None):
    """Runs the jobs that are not in `folder` yet and writes the table.

    scheduler: address of a Dask scheduler; None: a local cluster of `workers` processes, one a core where not said;
    "serial": this process alone, without Dask. client: a Dask client of the caller's instead. done: called with every
    key that was written. A job that raises stops no other: it has its error in the table's column of that name, and is
    tried again by the next run. Returns jobs, skipped, failed (errors by key), seconds, worker_seconds (of their
    processors), peak_bytes (of the largest worker) and the table's path."""
    folder, start = pathlib.Path(folder), time.perf_counter()
    (folder / "jobs").mkdir(parents=True, exist_ok=True)
    unique = {job["key"]: job for job in listed}
    todo = [job for key, job in unique.items() if not (folder / "jobs" / (key + ".npz")).exists()]
    failed = {}
    summary = {"jobs": len(unique), "skipped": len(unique) - len(todo), "failed": failed, "worker_seconds": 0.0,
               "peak_bytes": 0}
    own = cluster = None
    if todo and scheduler != "serial" and client is None:
        own, cluster = _client(scheduler, workers)
        client = own
    try:
        for result in _spread(todo, client) if client is not None and todo else _in_turn(todo):
            if "error" in result:
                failed[result["key"]] = result["error"]
                continue
            _write(folder / "jobs" / (result["key"] + ".npz"), result["data"])
            summary["worker_seconds"] += result["seconds"]
            summary["peak_bytes"] = max(summary["peak_bytes"], result["peak_bytes"])
            if done:
                done(result["key"])
    finally:
        if own is not None:
            own.close()
        if cluster is not None:
            cluster.close(timeout=60)
    summary["table"] = str(write_table(listed, folder, failed))
    summary["seconds"] = time.perf_counter() - start
    return summary
