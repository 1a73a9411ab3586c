"""Studies: files and table do not depend on who computes, on workers that die, or on a run that is cut off."""

import os
import pathlib
import signal
import sys
import tempfile
import unittest

try:
    import numpy as np
except ImportError:
    sys.exit(77)

from hairmesh import study

BOB = pathlib.Path(__file__).parents[2] / "assets" / "hair" / "bob_example.obj"
try:
    from dask.distributed import Client, LocalCluster
except ImportError:
    Client = None


def bytes_of(folder):
    """All files of a study by name."""
    return {str(file.relative_to(folder)): file.read_bytes() for file in sorted(folder.rglob("*")) if file.is_file()}


class Study(unittest.TestCase):
    def setUp(self):
        clips = {"shake": study.Clip.shake(0.5), "slow": study.Clip.shake(0.25, degrees=20)}
        self.jobs = study.jobs(clips, {"bob": BOB.read_text()}, [{"bend": 0.3}, {"bend": 1.0, "friction": 0.5}], range(3))
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.at = pathlib.Path(self.folder.name)

    def serial(self):
        study.run(self.jobs, self.at / "serial", scheduler="serial")
        return bytes_of(self.at / "serial")

    def test_a_run_that_was_cut_off_goes_on(self):
        expected = self.serial()
        self.assertEqual(len(expected), 12 + 1)

        def stop(key):
            raise KeyboardInterrupt

        with self.assertRaises(KeyboardInterrupt):
            study.run(self.jobs, self.at / "cut", scheduler="serial", done=stop)
        self.assertEqual(len(bytes_of(self.at / "cut")), 1)
        summary = study.run(self.jobs, self.at / "cut", scheduler="serial")
        self.assertEqual((summary["jobs"], summary["skipped"]), (12, 1))
        self.assertEqual(bytes_of(self.at / "cut"), expected)
        again = study.run(self.jobs, self.at / "cut", scheduler="serial")
        self.assertEqual((again["skipped"], again["worker_seconds"]), (12, 0))
        self.assertEqual(bytes_of(self.at / "cut"), expected)

    def test_a_job_that_raises_stops_no_other_and_is_tried_again(self):
        bad = study.jobs({"shake": study.Clip.shake(0.25)}, {"bob": BOB.read_text()}, [{"bend": -5}, {"bend": 0.3}])
        for _ in range(2):
            summary = study.run(bad, self.at / "bad", scheduler="serial")
            self.assertEqual(list(summary["failed"]), [bad[0]["key"]])
            self.assertEqual(len(list((self.at / "bad" / "jobs").iterdir())), 1)
            rows = (self.at / "bad" / "table.csv").read_text().splitlines()
            self.assertEqual(len(rows), 3)
            self.assertIn("bend", rows[1].rsplit(",", 1)[0])
            self.assertTrue(rows[0].split(",")[5] == "error" and "error" not in rows[2].lower(), rows)
        self.assertEqual(summary["skipped"], 1)

    def test_seeds_draw_parameters_in_their_range(self):
        drawn = [job["parameters"]["bend"] for job in self.jobs if job["row"]["clip"] == "slow" and "friction" not in job["parameters"]]
        self.assertEqual(drawn[0], 0.3)
        self.assertEqual(len(set(drawn)), 3)
        self.assertEqual(len({job["key"] for job in self.jobs}), 12)

    def test_the_table_tells_what_happened(self):
        self.serial()
        rows = (self.at / "serial" / "table.csv").read_text().splitlines()
        self.assertEqual(len(rows), 13)
        self.assertTrue(rows[0].startswith("key,clip,style,seed,parameters,"))
        with np.load(self.at / "serial" / "jobs" / (self.jobs[0]["key"] + ".npz")) as data:
            self.assertEqual(data["tips"].shape[0], 30)
            self.assertGreater(np.ptp(data["tips"], axis=0).max(), 0.05)

    def test_programs_are_jobs_too(self):
        write = "import pathlib, sys; pathlib.Path(sys.argv[1], 'part.csv').write_text(sys.argv[2]); print('done', sys.argv[2])"
        commands = {f"part {n}": [sys.executable, "-c", write, "{out}", str(n)] for n in range(3)}
        commands["fault"] = [sys.executable, "-c", "raise SystemExit(3)"]
        jobs = study.program_jobs(commands)
        self.assertEqual(study.run(jobs, self.at, scheduler="serial")["skipped"], 0)
        self.assertEqual(study.run(jobs, self.at, scheduler="serial")["skipped"], 4)
        study.unpack(jobs, self.at)
        self.assertEqual((self.at / "programs" / "part 2" / "out" / "part.csv").read_text(), "2")
        self.assertEqual((self.at / "programs" / "part 1" / "output").read_text(), "done 1\n")
        table = (self.at / "table.csv").read_text().splitlines()
        self.assertEqual(table[0], "key,name,command,exit,files")
        self.assertTrue(table[4].endswith(",3,0"), table[4])

    def test_clips_are_kept(self):
        clip = study.Clip.shake(0.2)
        clip.save(self.at / "clip.npz")
        back = study.Clip.load(self.at / "clip.npz")
        for name in ("dt", "head", "radii", "bodies"):
            np.testing.assert_array_equal(getattr(clip, name), getattr(back, name))

    @unittest.skipIf(Client is None, "Dask (Debian: python3-distributed) is missing")
    def test_a_killed_worker_changes_nothing(self):
        expected = self.serial()
        # A thread cannot be killed alone: every worker is a process, and its nanny starts another one.
        with LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster:
            with Client(cluster) as client:
                workers, written = list(client.run(os.getpid).values()), []

                def kill(key):
                    written.append(key)
                    if len(written) == 2:
                        os.kill(workers[0], signal.SIGKILL)

                summary = study.run(self.jobs, self.at / "dask", client=client, done=kill)
        self.assertEqual(len(written), 12)
        self.assertEqual(len(set(written)), 12, "a job was written twice")
        self.assertEqual(summary["skipped"], 0)
        self.assertEqual(bytes_of(self.at / "dask"), expected)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
