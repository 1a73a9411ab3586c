"""The examples in Python that hello_c does not stand for: plots and a study, each run as a person runs it."""

import csv
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy  # noqa: F401
except ImportError:
    sys.exit(77)

import hairmesh
from hairmesh import study

ROOT = pathlib.Path(__file__).parents[2]
BOB = ROOT / "assets" / "hair" / "bob_example.obj"


def run(example, *arguments, path=()):
    """Runs an example; `path` comes before what Python finds."""
    environment = dict(os.environ, PYTHONPATH=os.pathsep.join([*map(str, path), os.environ["PYTHONPATH"]]))
    command = [sys.executable, str(ROOT / "examples" / "python" / example), str(BOB), *map(str, arguments)]
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout


class Examples(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.at = pathlib.Path(folder.name)

    def without(self, *names):
        """A folder that hides packages from Python."""
        for name in names:
            (self.at / "hidden").mkdir(exist_ok=True)
            (self.at / "hidden" / (name + ".py")).write_text("raise ImportError\n")
        return [self.at / "hidden"]

    def test_plots(self):
        said = run("plot.py", self.at)
        with open(self.at / "pareto.csv") as stream:
            rows = list(csv.DictReader(stream))
        self.assertEqual(len(rows), 8)
        finest, coarsest = float(rows[7]["error"]), float(rows[4]["error"])
        self.assertLess(finest, 0.1 * coarsest)
        if "plot.svg" in said:
            self.assertIn("</svg>", (self.at / "plot.svg").read_text())
        self.assertIn("is missing", run("plot.py", self.at / "plain", path=self.without("matplotlib")))
        self.assertEqual((self.at / "plain" / "pareto.csv").read_bytes(), (self.at / "pareto.csv").read_bytes())

    def test_study(self):
        try:
            import dask.distributed  # noqa: F401
        except ImportError:
            self.skipTest("Dask (Debian: python3-distributed) is missing")
        self.assertIn("100 jobs, 0 were there", run("study.py", self.at, 1, 2))
        self.assertIn("100 jobs, 100 were there", run("study.py", self.at, 1, 2))
        with open(self.at / "table.csv") as stream:
            self.assertEqual(len({row["key"] for row in csv.DictReader(stream)}), 100)
        with self.assertRaises(subprocess.CalledProcessError) as caught:
            run("study.py", self.at / "no", 1, 2, path=self.without("dask"))
        self.assertIn("python3-distributed", caught.exception.stderr)

    def test_every_public_name_is_documented(self):
        for owner in (hairmesh, study, *(getattr(hairmesh, name) for name in hairmesh.__all__)):
            self.assertTrue(owner.__doc__, owner)
            for name, value in vars(owner).items():
                ours = getattr(value, "__module__", "").startswith("hairmesh") if callable(value) else isinstance(value, property)
                if ours and not name.startswith("_"):
                    self.assertTrue(value.__doc__, f"{owner.__name__}.{name}")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
