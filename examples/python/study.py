"""1,000 ten-second simulations: ten stiffnesses of bending by ten dampings, ten seeds each, on a local Dask cluster.
study.py HAIR.obj FOLDER [SEEDS [WORKERS]]; run again, it skips what is there."""

import sys

import numpy as np

from hairmesh import study


def main(file, folder, seeds=10, workers=None):
    with open(file) as stream:
        styles = {"hair": stream.read()}
    parameters = [{"bend": float(bend), "damping": float(damping)}
                  for bend in np.geomspace(0.1, 3, 10) for damping in np.linspace(0.01, 0.1, 10)]
    jobs = study.jobs({"shake": study.Clip.shake(10)}, styles, parameters, range(int(seeds)))
    summary = study.run(jobs, folder, workers=workers and int(workers))
    print("{jobs} jobs, {skipped} were there: {seconds:.1f} s, {worker_seconds:.1f} s of all workers, {mb:.0f} MB a "
          "worker at most; {table}".format(mb=summary["peak_bytes"] / 1e6, **summary))


if __name__ == "__main__":
    main(*sys.argv[1:])
