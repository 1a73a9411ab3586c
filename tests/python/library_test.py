"""The Python package: views without copies, parameters, states, strands, faults."""

import copy
import gc
import math
import pathlib
import pickle
import subprocess
import sys
import unittest

try:
    import numpy as np
except ImportError:
    sys.exit(77)

import hairmesh

BOB = pathlib.Path(__file__).parents[2] / "assets" / "hair" / "bob_example.obj"


def turned(angle):
    return hairmesh.pose(rotation=(0, math.sin(angle / 2), 0, math.cos(angle / 2)))


def shake(hair, first, last):
    for n in range(first, last):
        report = hair.step(head=turned(math.sin(0.2 * n)))
    return report


class Import(unittest.TestCase):
    def test_without_numpy_one_sentence_says_what_to_install(self):
        done = subprocess.run([sys.executable, "-c", "import sys; sys.modules['numpy'] = None; import hairmesh"],
                              capture_output=True, text=True)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("\nImportError: hairmesh needs NumPy", done.stderr)
        self.assertIn("python3 -m pip install numpy", done.stderr)
        self.assertNotIn("another exception", done.stderr)


class Library(unittest.TestCase):
    def setUp(self):
        self.mesh = hairmesh.Mesh.load(BOB)

    def test_views_are_the_librarys_memory(self):
        hair = hairmesh.Hair(self.mesh)
        positions = hair.positions
        before, address = positions.copy(), positions.ctypes.data
        shake(hair, 0, 10)
        self.assertGreater(np.abs(positions - before).max(), 0.01)
        self.assertEqual(hair.positions.ctypes.data, address)
        self.assertFalse(positions.flags.writeable)
        self.assertFalse(positions.flags.owndata)
        with self.assertRaises(ValueError):
            positions[0] = 0
        del hair
        gc.collect()
        self.assertTrue(np.isfinite(positions).all())  # the view keeps its hair alive

    def test_a_built_in_style_needs_no_file(self):
        mesh = hairmesh.Mesh.style("short", "low")
        head = hairmesh.Ellipsoid(hairmesh.Mesh.head_radii())
        hair = hairmesh.Hair(mesh)
        hair.step(ellipsoids=[head])
        self.assertGreater(len(mesh.rest), 200)
        self.assertAlmostEqual(mesh.rest[mesh.roots][:, 1].max(), 0.115, delta=0.01)  # at the crown
        with self.assertRaisesRegex(hairmesh.Error, "short, shoulder, long"):
            hairmesh.Mesh.style("mohawk")

    def test_arrays_make_the_same_mesh(self):
        lengths = np.diff(self.mesh.column_first)
        mesh = hairmesh.Mesh(self.mesh.rest.astype(np.float64), lengths, self.mesh.faces)
        np.testing.assert_array_equal(mesh.rest, self.mesh.rest)
        np.testing.assert_array_equal(mesh.faces, self.mesh.faces)
        self.assertEqual(mesh.hair_length, self.mesh.hair_length)
        one, other = hairmesh.Hair(mesh), hairmesh.Hair(self.mesh)
        shake(one, 0, 20), shake(other, 0, 20)
        self.assertEqual(one.save(), other.save())

    def test_states_go_on_to_the_bit(self):
        hair, other = hairmesh.Hair(self.mesh), hairmesh.Hair(self.mesh)
        shake(hair, 0, 15)
        state = hair.save()
        shake(hair, 15, 30)
        for buffer in (bytearray(state), np.frombuffer(state, np.uint8), memoryview(state), state):
            other.restore(buffer)
        shake(other, 15, 30)
        self.assertEqual(hair.save(), other.save())
        hair.reset()
        np.testing.assert_array_equal(hair.positions, self.mesh.rest)
        self.assertEqual(np.abs(hair.velocities).max(), 0)
        hair.carry(hairmesh.pose(), hairmesh.pose((1, 2, 3)))
        np.testing.assert_allclose(hair.positions, self.mesh.rest + (1, 2, 3), atol=1e-12)

    def test_roots_of_any_stride_and_type(self):
        hair, other = hairmesh.Hair(self.mesh), hairmesh.Hair(self.mesh)
        wide = np.zeros((len(self.mesh.tips), 5), np.float64)
        wide[:, 1:4] = self.mesh.rest[self.mesh.roots] + (0, 0, 0.01)
        hair.step(roots=wide[:, 1:4])
        other.step(roots=np.asfortranarray(wide[:, 1:4]).astype(np.float32))
        np.testing.assert_allclose(hair.positions, other.positions, atol=1e-5)
        one = np.broadcast_to(np.array([0.0, 0.1, 0.0]), (len(self.mesh.tips), 3))  # rows of stride 0
        state = hair.save()
        hair.step(roots=one)
        other.restore(state)
        other.step(roots=one.copy())
        np.testing.assert_array_equal(hair.positions, other.positions)
        with self.assertRaisesRegex(hairmesh.Error, "roots has"):
            hair.step(roots=wide[:3, 1:4])
        with self.assertRaises(ValueError):
            hair.step(roots=wide)

    def test_parameters(self):
        table = hairmesh.parameters()
        self.assertEqual(table["solver"]["choices"], ["default", "paper"])
        hair = hairmesh.Hair(self.mesh, stretch_along=2e5, solver="paper", collide=False)
        self.assertEqual([hair.get(name) for name in ("stretch_along", "solver", "collide")], [2e5, 1, 0])
        for name, row in table.items():
            self.assertGreater(len(row["help"]), 10)
            if name not in ("stretch_along", "solver", "collide"):
                self.assertEqual(hair.get(name), row["default"])
        hair.reset_parameters()
        self.assertEqual({name: hair.get(name) for name in table}, {name: row["default"] for name, row in table.items()})
        with self.assertRaisesRegex(hairmesh.Error, "density") as caught:
            hair.set(densty=3)
        self.assertEqual(caught.exception.result, "HM_ERROR_NAME")
        for fault in ({"densty": 3}, {"density": -1}):
            with self.assertRaises(hairmesh.Error):
                hair.set(bend=7, solver="paper", **fault)
            self.assertEqual([hair.get(name) for name in ("bend", "solver")], [table["bend"]["default"], 0], "all or none")

    def test_colliders_pins_and_report(self):
        hair, vertex = hairmesh.Hair(self.mesh), int(self.mesh.tips[0])
        there = self.mesh.rest[vertex] + (0.01, 0, 0)
        skull = hairmesh.Ellipsoid((0.08, 0.11, 0.1), (0, 0.085, 0), before=hairmesh.pose((0, 0.084, 0)), seconds=1 / 60)
        for _ in range(20):
            report = hair.step(ellipsoids=[skull], pins=[(vertex, there, (0, 0, 0), math.inf)])
        self.assertGreater(report["contacts"], 0)
        self.assertEqual(report["pins"], 1)
        np.testing.assert_allclose(hair.positions[vertex], there, atol=1e-6)
        self.assertAlmostEqual(hair.time, 20 / 60)

    def test_strands(self):
        hair = hairmesh.Hair(self.mesh, strands=200)
        positions, tangents, radii = hair.strands(points=12)
        self.assertEqual((positions.shape, tangents.shape, radii.shape), ((200, 12, 3), (200, 12, 3), (200, 12)))
        some, _, _ = hair.strands([7, 199, 0], 12)
        np.testing.assert_array_equal(some, positions[[7, 199, 0]])
        np.testing.assert_allclose(np.linalg.norm(tangents, axis=2), 1, atol=1e-5)
        drawn = radii[:, 0] > 0  # a hairline leaves some out
        self.assertGreater(drawn.sum(), 100)
        self.assertTrue((radii[drawn] > 1e-5).all() and (radii[drawn] < 5e-3).all() and (radii[~drawn] == 0).all())
        double, _, _ = hair.strands(points=12, dtype=np.float64)
        for wrong in (np.int32, np.float16, ">f8"):
            with self.assertRaises(TypeError):
                hair.strands(points=12, dtype=wrong)
        np.testing.assert_allclose(double, positions, atol=1e-6)
        self.assertIn(hair.strand(7)["face"], range(len(self.mesh.faces)))
        with self.assertRaisesRegex(hairmesh.Error, "200"):
            hair.strands([200])

    def test_what_owns_an_object_of_the_library_is_not_copied(self):
        hair = hairmesh.Hair(self.mesh)
        for one, mend in ((self.mesh, "share it"), (hair, "restore"), ([hair], "restore")):
            for copied in (copy.copy, copy.deepcopy, pickle.dumps):
                if isinstance(one, list) and copied is copy.copy:
                    continue  # a list of the same hair
                with self.assertRaisesRegex(TypeError, mend):
                    copied(one)
        gc.collect()
        hair.step()
        self.assertEqual(len(self.mesh.rest), len(hair.positions))

    def test_faults_name_file_and_mend(self):
        with self.assertRaisesRegex(hairmesh.Error, "wrong.obj: .*layer_0.*;"):
            hairmesh.Mesh.from_text("v 0 0 0\n", "wrong.obj")
        hair = hairmesh.Hair(self.mesh)
        with self.assertRaisesRegex(hairmesh.Error, "dt"):
            hair.step(dt=math.nan)
        with self.assertRaises(hairmesh.Error):
            hair.restore(b"no state")
        state = hair.save()
        with self.assertRaisesRegex(hairmesh.Error, f"has {len(state) - 1} bytes where {len(state)} were saved"):
            hair.restore(state[:-1])
        with self.assertRaisesRegex(hairmesh.Error, "collider cannot be sdf"):
            hair.set(collider="sdf")

    def test_faults_name_shape_and_dtype(self):
        hair = hairmesh.Hair(self.mesh)
        with self.assertRaisesRegex(TypeError, r"head is an array of shape \(4, 4\) and dtype float64; give hairmesh.pose"):
            hair.step(head=np.eye(4))
        with self.assertRaisesRegex(TypeError, r"pin 1 is \(1, 2\); give \(vertex"):
            hair.step(pins=[(0, (0, 0, 0), (0, 0, 0), 1), (1, 2)])
        for wrong, what in (((1,), "position"), (("a", 0, 0), "position"), (np.zeros((3, 3)), "position"), (5, "position")):
            with self.assertRaisesRegex(TypeError, f"{what} is an? .*; give 3 numbers"):
                hairmesh.pose(wrong)
        with self.assertRaisesRegex(TypeError, "rotation is .*; give 4 numbers"):
            hairmesh.pose(rotation=(0, 0, 0))
        with self.assertRaisesRegex(TypeError, "radii is .*; give 3 numbers"):
            hairmesh.Ellipsoid((1, 1))
        for pin in ((3, (0, 0), (0, 0, 0), 1), (3, (0, 0, 0), (0,), 1), (3.9, (0, 0, 0), (0, 0, 0), 1),
                    (2**32 + 3, (0, 0, 0), (0, 0, 0), 1)):
            with self.assertRaisesRegex(TypeError, "pin 0 is .*; give"):
                hair.step(pins=[pin])
        for numbers, error in (([2**32 + 3], ValueError), ([3.9], TypeError), (["a"], TypeError)):
            with self.assertRaisesRegex(error, "numbers"):
                hair.strands(numbers)
            with self.assertRaises(error):
                hair.strand(numbers[0])
        with self.assertRaisesRegex(ValueError, "points"):
            hair.strands(points=2**32 + 2)
        with self.assertRaisesRegex(TypeError, "mesh is a str; give a hairmesh.Mesh"):
            hairmesh.Hair("bob")
        with self.assertRaisesRegex(TypeError, "an ellipsoid is an array .*; give a hairmesh.Ellipsoid"):
            hair.step(ellipsoids=[(1, 1, 1)])
        with self.assertRaisesRegex(TypeError, "column_lengths"):
            hairmesh.Mesh(self.mesh.rest, np.diff(self.mesh.column_first) + 0.5, self.mesh.faces)
        lengths = np.diff(self.mesh.column_first)
        for faces, error, words in (([[0, 1, 2]], ValueError, r"of shape \(1, 3\) .*; give whole numbers of shape \(n, 4\)"),
                                    ([0, 1, 2, 3], ValueError, r"of shape \(4,\) .*; give .* \(n, 4\)"),
                                    ([[0, 1, 2, -1], [0, 1]], TypeError, "a list of unlike rows; give whole numbers"),
                                    ([["a"] * 4], TypeError, "; give whole numbers")):
            with self.assertRaisesRegex(error, "faces is .*" + words):
                hairmesh.Mesh(self.mesh.rest, lengths, faces)
        for words in ({"style": None}, {"style": 3}, {"resolution": b"low"}):
            with self.assertRaisesRegex(TypeError, f"{next(iter(words))} is a .*; give a str"):
                hairmesh.Mesh.style(**words)
        with self.assertRaisesRegex(TypeError, "text is a NoneType; give a str"):
            hairmesh.Mesh.from_text(None)
        with self.assertRaisesRegex(TypeError, "state is a NoneType; give the bytes"):
            hair.restore(None)
        with self.assertRaisesRegex(ValueError, r"roots is an array of shape \(3,\) and dtype int64; .*\(n, 3\).*float32"):
            hair.step(roots=[1, 2, 3])
        self.assertEqual(hairmesh.version().count("."), 2)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
