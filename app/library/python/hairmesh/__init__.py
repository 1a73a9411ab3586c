"""Hair mesh simulation: the library of include/hairmesh.h for Python, with NumPy arrays.

    import hairmesh
    mesh = hairmesh.Mesh.load("bob.obj")
    hair = hairmesh.Hair(mesh, stretch_along=2e5)
    report = hair.step(1 / 60, head=hairmesh.pose(rotation=(0, 0.1, 0, 0.995)))
    print(hair.positions[mesh.tips])

Units are SI, y is up. `positions` and `velocities` are views of the library's memory: no copies, read-only, and steps
write to them. A view keeps its hair alive. Calls give the interpreter's lock away, so threads step different hairs side
by side. What cannot be done raises hairmesh.Error with the fault and the mend.
"""

import ctypes
import math
import operator

try:
    import numpy as np
except ModuleNotFoundError:
    raise ImportError("hairmesh needs NumPy, which this Python does not have; install it: python3 -m pip install numpy "
                      "(Debian, Ubuntu: apt install python3-numpy)") from None

from . import _c
from ._c import Error

__all__ = ["Ellipsoid", "Error", "Hair", "Mesh", "parameters", "pose", "version"]


def version():
    """Version of the library, as "0.1.0"."""
    number = _c.lib.hm_version()
    return f"{number // 10000}.{number // 100 % 100}.{number % 100}"


def parameters():
    """All parameters by name: a dict of dicts with group, unit, help, kind, minimum, maximum, default, choices."""
    kinds = ("real", "integer", "switch", "choice")
    table = {}
    row = _c.Parameter()
    for index in range(_c.lib.hm_parameter_count()):
        _c.lib.hm_parameter_at(index, row)
        table[row.name.decode()] = {
            "group": row.group.decode(),
            "unit": row.unit.decode(),
            "help": row.help.decode(),
            "kind": kinds[row.kind],
            "minimum": row.minimum,
            "maximum": row.maximum,
            "default": row.default_value,
            "logarithmic": bool(row.logarithmic),
            "of_strands": bool(row.of_strands),
            "choices": [row.choices[i].decode() for i in range(row.choice_count)],
        }
    return table


def pose(position=(0, 0, 0), rotation=(0, 0, 0, 1)):
    """A rigid placement: position in m, rotation as a unit quaternion x, y, z, w."""
    return _c.Pose(_numbers(position, 3, "position"), _numbers(rotation, 4, "rotation"))


def _numbers(values, count, name):
    """`count` numbers for the library; ctypes would fill up what is missing with 0."""
    try:
        numbers = [float(value) for value in values]
    except (TypeError, ValueError):
        numbers = []
    if len(numbers) != count:
        raise TypeError(f"{name} is {_shown(values)}; give {count} numbers")
    return (ctypes.c_double * count)(*numbers)


def _whole(value, name):
    """A whole number for the library; ctypes would cut it down to 32 bits."""
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} is {_shown(value)}; give a whole number") from None
    if not -2**31 <= number < 2**31:
        raise ValueError(f"{name} is {number}, beyond 32 bits")
    return number


def _whole_array(values, name):
    """Whole numbers for the library, side by side; NumPy would cut them down to 32 bits."""
    try:
        array = np.asarray(values)
    except ValueError:
        raise TypeError(f"{name} is {_shown(values)}; give whole numbers") from None
    if array.size == 0:
        return np.empty(array.shape, np.int32)
    if array.dtype.kind not in "iu":
        raise TypeError(f"{name} is {_shown(values)}; give whole numbers")
    if array.min() < -2**31 or array.max() >= 2**31:
        raise ValueError(f"{name} has numbers beyond 32 bits")
    return np.ascontiguousarray(array, dtype=np.int32)


def _handle(value, kind, name):
    """What the library knows `value` by, an object of this package."""
    if not isinstance(value, kind):
        raise TypeError(f"{name} is {_shown(value)}; give a hairmesh.{kind.__name__}")
    return value._c


def _text(value, name):
    if not isinstance(value, str):
        raise TypeError(f"{name} is {_shown(value)}; give a str")
    return value.encode()


class Ellipsoid:
    """A solid ellipsoid at its place at a step's end. `before`: its pose `seconds` earlier, for its velocities."""

    def __init__(self, radii, position=(0, 0, 0), rotation=(0, 0, 0, 1), velocity=(0, 0, 0), angular_velocity=(0, 0, 0),
                 before=None, seconds=None):
        self._c = _c.Ellipsoid(pose(position, rotation), _numbers(radii, 3, "radii"), _numbers(velocity, 3, "velocity"),
                               _numbers(angular_velocity, 3, "angular_velocity"))
        if before is not None:
            if seconds is None:
                raise TypeError("seconds is missing: how long before the step's end the ellipsoid was at `before`")
            _c.lib.hm_ellipsoid_moved(self._c, _pose(before, "before"), seconds)


def _view(place, owner):
    """A read-only array over the library's memory, an address and a number of vertices; it keeps `owner` alive."""
    address, count = place
    memory = (ctypes.c_double * (3 * count)).from_address(address)
    memory.owner = owner
    array = np.frombuffer(memory, dtype=np.float64).reshape(count, 3)
    array.flags.writeable = False
    return array


def _array(values, width, name):
    """`values` for the library, rows strided as they are; the second result keeps them alive."""
    given = values
    try:
        values = np.asarray(values)
        if values.dtype not in (np.float32, np.float64):
            values = values.astype(np.float64)
    except (TypeError, ValueError):
        values = np.empty(0)
    if values.ndim != 2 or values.shape[1] != width:
        raise ValueError(f"{name} is {_shown(given)}; give one of shape (n, {width}) and dtype float32 or float64")
    if values.strides[1] != values.itemsize or values.strides[0] <= 0:  # 0 is "side by side" to the library
        values = np.ascontiguousarray(values)
    kind = 1 if values.dtype == np.float32 else 0
    return _c.Array(values.ctypes.data, values.strides[0], len(values), kind), values


def _shown(value):
    """What a value is, for a message: an array's shape and dtype, else its type."""
    if isinstance(value, (list, tuple)):
        try:
            value = np.asarray(value)
        except ValueError:
            return f"a {type(value).__name__} of unlike rows"
    if isinstance(value, np.ndarray):
        return f"an array of shape {value.shape} and dtype {value.dtype}"
    return f"a {type(value).__name__}"


def _pose(value, name):
    if not isinstance(value, _c.Pose):
        raise TypeError(f"{name} is {_shown(value)}; give hairmesh.pose(position, rotation): 3 numbers in m, and a unit "
                        "quaternion x, y, z, w")
    return value


def _pin(value, number):
    try:
        vertex, target, velocity, stiffness = value
        return _c.Pin(_whole(vertex, "vertex"), _numbers(target, 3, "target"), _numbers(velocity, 3, "velocity"),
                      float(stiffness))
    except (TypeError, ValueError):
        raise TypeError(f"pin {number} is {value!r:.80}; give (vertex, target, velocity, stiffness): a whole number, 3 "
                        "numbers in m, 3 in m/s, a number in N/m") from None


class _Owner:
    """What owns an object of the library, which ends with it: a second owner would be left with none."""

    def __reduce_ex__(self, protocol):
        raise TypeError(f"a {type(self).__name__} of hairmesh is neither copied nor pickled; {self._instead}")


class Mesh(_Owner):
    """A hair mesh; any number of hairs share one."""

    _instead = "share it, or make another of its rest, column_first and faces"

    def __init__(self, positions, column_lengths, faces, reverse_faces=False):
        """positions: (vertices, 3) in m, column after column, root first; faces: (n, 4) columns, the fourth -1 in a
        triangle, counter-clockwise seen from outside."""
        settings = _c.MeshSettings()
        _c.lib.hm_default_mesh_settings(settings)
        lengths = _whole_array(column_lengths, "column_lengths").reshape(-1)
        corners = _whole_array(faces, "faces")
        if corners.ndim != 2 or corners.shape[1] != 4:
            raise ValueError(f"faces is {_shown(faces)}; give whole numbers of shape (n, 4), the fourth -1 in a triangle")
        settings.positions, kept = _array(positions, 3, "positions")
        settings.column_lengths, settings.column_count = lengths.ctypes.data, len(lengths)
        settings.faces, settings.face_count = corners.ctypes.data, len(corners)
        settings.reverse_faces = bool(reverse_faces)
        handle = _c.Mesh()
        _c.lib.hm_mesh_create(settings, handle)
        self._take(handle)

    @classmethod
    def from_text(cls, text, name="hair mesh", reverse_faces=False):
        """Reads the text of an OBJ file: one group a layer, layer_0 the scalp."""
        text = text if isinstance(text, bytes) else _text(text, "text")
        mesh = cls.__new__(cls)
        handle = _c.Mesh()
        _c.lib.hm_mesh_create_from_text(text, len(text), str(name).encode(), bool(reverse_faces), handle)
        mesh._take(handle)
        return mesh

    @classmethod
    def load(cls, file, reverse_faces=False):
        """Reads an OBJ file."""
        with open(file, "rb") as stream:
            return cls.from_text(stream.read(), file, reverse_faces)

    @classmethod
    def style(cls, style="shoulder", resolution="low", head_height=0.23):
        """A built-in style, "short", "shoulder", "long", "bob", "pixie" or "shaved", at "low", "medium", "high" or "ultra", on a plain head: an
        ellipsoid about the origin, Mesh.head_radii(head_height) for steps' Ellipsoid."""
        mesh = cls.__new__(cls)
        handle = _c.Mesh()
        _c.lib.hm_mesh_create_style(_text(style, "style"), _text(resolution, "resolution"), head_height, handle)
        mesh._take(handle)
        return mesh

    @staticmethod
    def head_radii(head_height=0.23):
        """Radii of the head of built-in styles, m."""
        return tuple(share * head_height for share in (0.34, 0.5, 0.42))

    def _take(self, handle):
        self._c = handle
        info = _c.MeshInfo()
        _c.lib.hm_mesh_describe(handle, info)
        count = info.column_count
        self.hair_length, self.volume = info.hair_length, info.volume
        self.column_first = np.array((ctypes.c_int32 * (count + 1)).from_address(info.column_first))
        self.faces = np.array((ctypes.c_int32 * (4 * info.face_count)).from_address(info.faces)).reshape(-1, 4)
        self._rest = info.rest.data, info.rest.count

    @property
    def rest(self):
        """Vertices at rest in m, in the head's frame: a view of shape (vertices, 3)."""
        return _view(self._rest, self)

    @property
    def roots(self):
        """First vertex of every column."""
        return self.column_first[:-1]

    @property
    def tips(self):
        """Last vertex of every column."""
        return self.column_first[1:] - 1

    def __del__(self):
        if getattr(self, "_c", None) is not None and self._c.id:
            _c.lib.hm_mesh_destroy(self._c)


class Hair(_Owner):
    """A hair of a mesh: parameters and state. Keyword arguments set parameters."""

    _instead = "make another of its mesh, and restore() there what save() gives here"

    def __init__(self, mesh, head=None, measure_stages=False, gradual=False, **values):
        settings = _c.HairSettings()
        _c.lib.hm_default_hair_settings(settings)
        if head is not None:
            settings.head = _pose(head, "head")
        settings.measure_stages, settings.gradual = bool(measure_stages), bool(gradual)
        handle = _c.Hair()
        _c.lib.hm_hair_create(_handle(mesh, Mesh, "mesh"), settings, handle)
        self._c, self.mesh, self.time = handle, mesh, 0.0
        view = _c.View()
        _c.lib.hm_hair_positions(handle, view)
        self._positions = view.data, view.count
        _c.lib.hm_hair_velocities(handle, view)
        self._velocities = view.data, view.count
        self.set(**values)

    def __del__(self):
        if getattr(self, "_c", None) is not None and self._c.id:
            _c.lib.hm_hair_destroy(self._c)

    def set(self, **values):
        """Sets parameters: numbers, booleans, or texts such as "on" and the names of choices. All or, where one cannot
        be, none."""
        before = {name: self.get(name) for name in values}
        try:
            for name, value in values.items():
                if isinstance(value, str):
                    _c.lib.hm_hair_set_text(self._c, name.encode(), value.encode())
                else:
                    _c.lib.hm_hair_set(self._c, name.encode(), float(value))
        except Exception:
            for name, value in before.items():
                _c.lib.hm_hair_set(self._c, name.encode(), value)
            raise

    def get(self, name):
        """Value of a parameter, as a number."""
        value = ctypes.c_double()
        _c.lib.hm_hair_get(self._c, name.encode(), value)
        return value.value

    def reset_parameters(self):
        """Gives all parameters their defaults."""
        _c.lib.hm_hair_reset_parameters(self._c)

    @property
    def positions(self):
        """Vertices in m, world: a view of shape (vertices, 3)."""
        return _view(self._positions, self)

    @property
    def velocities(self):
        """Velocities of the vertices in m/s: a view of shape (vertices, 3)."""
        return _view(self._velocities, self)

    def step(self, dt=1 / 60, head=None, roots=None, ellipsoids=(), pins=(), time=None, max_work=math.inf):
        """Advances by dt seconds. Roots, (columns, 3) in m, or the head's pose, are those of the step's end; pins are
        (vertex, target, velocity, stiffness). Returns what the step did, as a dict."""
        step = _c.StepInput()
        _c.lib.hm_default_step_input(step)
        step.dt, step.max_work = dt, max_work
        step.time = self.time + dt if time is None else time
        if head is not None:
            step.head = _pose(head, "head")
        kept = None
        if roots is not None:
            step.roots, kept = _array(roots, 3, "roots")
        if isinstance(ellipsoids, Ellipsoid):
            ellipsoids = (ellipsoids,)
        bodies = (_c.Ellipsoid * len(ellipsoids))(*[_handle(one, Ellipsoid, "an ellipsoid") for one in ellipsoids])
        holds = (_c.Pin * len(pins))(*[_pin(pin, number) for number, pin in enumerate(pins)])
        step.ellipsoids, step.ellipsoid_count = ctypes.addressof(bodies), len(ellipsoids)
        step.pins, step.pin_count = ctypes.addressof(holds), len(pins)
        report = _c.Report()
        _c.lib.hm_hair_step(self._c, step, report)
        self.time = step.time
        done = {name: getattr(report, name) for name, _ in _c.Report._fields_}
        done["seconds"] = tuple(report.seconds)
        return done

    def reset(self, head=None):
        """Puts the hair to its rest shape, at rest."""
        _c.lib.hm_hair_reset(self._c, _pose(head, "head") if head is not None else pose())

    def carry(self, before, now):
        """Carries the hair along rigidly from one pose of the head to another."""
        _c.lib.hm_hair_carry(self._c, _pose(before, "before"), _pose(now, "now"))

    def save(self):
        """The state as bytes; steps go on from it in the same bits. Parameters and `time` are not part of it."""
        size = ctypes.c_size_t()
        _c.lib.hm_hair_save(self._c, None, 0, size)
        buffer = ctypes.create_string_buffer(size.value)
        _c.lib.hm_hair_save(self._c, buffer, size.value, size)
        return buffer.raw

    def restore(self, state):
        """Restores what save() gave for a hair of the same mesh: bytes, or any other buffer."""
        try:
            state = bytes(memoryview(state))
        except TypeError:
            raise TypeError(f"state is {_shown(state)}; give the bytes that save() gave") from None
        _c.lib.hm_hair_restore(self._c, state, len(state))

    def strands(self, numbers=None, points=16, dtype=np.float32):
        """Grows strands, all or those of the numbers given. Returns positions and tangents, (strands, points, 3), and
        radii, (strands, points), in m; 0 for a strand that is not drawn, as where a hairline thins out."""
        if np.dtype(dtype) not in (np.dtype(np.float32), np.dtype(np.float64)):
            raise TypeError(f"strands are float32 or float64, not {np.dtype(dtype)}")
        settings = _c.StrandSettings()
        _c.lib.hm_default_strand_settings(settings)
        if numbers is None:
            numbers = np.arange(int(self.get("strands")))
        numbers, points = _whole_array(numbers, "numbers").reshape(-1), _whole(points, "points")
        settings.numbers, settings.count, settings.points = numbers.ctypes.data, len(numbers), points
        shape = (len(numbers), points)
        positions, tangents, radii = (np.empty(shape + (3,), dtype), np.empty(shape + (3,), dtype), np.empty(shape, dtype))
        kind = 1 if np.dtype(dtype) == np.float32 else 0
        target = lambda array: _c.Array(array.ctypes.data, 0, len(numbers) * points, kind)
        output = _c.StrandOutput(target(positions), target(tangents), target(radii))
        _c.lib.hm_hair_grow_strands(self._c, settings, output)
        return positions, tangents, radii

    def strand(self, number):
        """What a strand is: root face, place in it, layers that it reaches, whether it leaves its clump."""
        strand = _c.Strand()
        _c.lib.hm_hair_describe_strand(self._c, _whole(number, "number"), strand)
        return {"face": strand.face, "place": tuple(strand.place), "end": strand.end, "flyaway": bool(strand.flyaway)}
