"""The C interface of include/hairmesh.h, by ctypes: structures and functions under their names there."""

import ctypes
import ctypes.util
import os
import pathlib
from ctypes import POINTER, c_char_p, c_double, c_int32, c_size_t, c_uint64, c_void_p

SONAME = "libhairmesh.so.0.1"


class Mesh(ctypes.Structure):
    _fields_ = [("id", c_uint64)]


class Hair(ctypes.Structure):
    _fields_ = [("id", c_uint64)]


class Array(ctypes.Structure):
    _fields_ = [("data", c_void_p), ("stride", c_size_t), ("count", c_size_t), ("type", ctypes.c_int)]


class View(ctypes.Structure):
    _fields_ = [("data", c_void_p), ("stride", c_size_t), ("count", c_size_t)]


class Pose(ctypes.Structure):
    _fields_ = [("position", c_double * 3), ("rotation", c_double * 4)]


class MeshSettings(ctypes.Structure):
    _fields_ = [
        ("positions", Array),
        ("column_lengths", c_void_p),
        ("column_count", c_size_t),
        ("faces", c_void_p),
        ("face_count", c_size_t),
        ("reverse_faces", c_int32),
    ]


class MeshInfo(ctypes.Structure):
    _fields_ = [
        ("vertex_count", c_int32),
        ("column_count", c_int32),
        ("face_count", c_int32),
        ("layer_count", c_int32),
        ("hair_length", c_double),
        ("volume", c_double),
        ("column_first", c_void_p),
        ("faces", c_void_p),
        ("rest", View),
    ]


class Parameter(ctypes.Structure):
    _fields_ = [
        ("name", c_char_p),
        ("group", c_char_p),
        ("unit", c_char_p),
        ("help", c_char_p),
        ("kind", ctypes.c_int),
        ("minimum", c_double),
        ("maximum", c_double),
        ("default_value", c_double),
        ("logarithmic", c_int32),
        ("of_strands", c_int32),
        ("choices", POINTER(c_char_p)),
        ("choice_count", c_int32),
    ]


class HairSettings(ctypes.Structure):
    _fields_ = [("head", Pose), ("measure_stages", c_int32), ("gradual", c_int32)]


class Ellipsoid(ctypes.Structure):
    _fields_ = [("pose", Pose), ("radii", c_double * 3), ("velocity", c_double * 3), ("angular_velocity", c_double * 3)]


class Pin(ctypes.Structure):
    _fields_ = [("vertex", c_int32), ("target", c_double * 3), ("velocity", c_double * 3), ("stiffness", c_double)]


class StepInput(ctypes.Structure):
    _fields_ = [
        ("dt", c_double),
        ("time", c_double),
        ("head", Pose),
        ("roots", Array),
        ("ellipsoids", c_void_p),
        ("ellipsoid_count", c_size_t),
        ("pins", c_void_p),
        ("pin_count", c_size_t),
        ("max_work", c_double),
    ]


class Report(ctypes.Structure):
    _fields_ = [
        ("solver_iterations", c_int32),
        ("solves", c_int32),
        ("residual", c_double),
        ("converged", c_int32),
        ("contacts", c_int32),
        ("corrected", c_int32),
        ("max_penetration", c_double),
        ("self_contacts", c_int32),
        ("guided", c_int32),
        ("repaired", c_int32),
        ("carried", c_int32),
        ("pins", c_int32),
        ("pins_out_of_reach", c_int32),
        ("work", c_double),
        ("solve_cut", c_int32),
        ("corrections_cut", c_int32),
        ("seconds", c_double * 5),
    ]


class StrandSettings(ctypes.Structure):
    _fields_ = [("numbers", c_void_p), ("first", c_int32), ("count", c_int32), ("points", c_int32)]


class StrandOutput(ctypes.Structure):
    _fields_ = [("positions", Array), ("tangents", Array), ("radii", Array)]


class Strand(ctypes.Structure):
    _fields_ = [("face", c_int32), ("place", c_double * 2), ("end", c_double), ("flyaway", c_int32)]


def _candidates():
    """Where the shared library may be: named by HAIRMESH_LIBRARY, beside this package's prefix, or known to the system."""
    named = os.environ.get("HAIRMESH_LIBRARY")
    if named:
        yield named
        return
    for parent in pathlib.Path(__file__).resolve().parents:
        if parent.name.startswith("lib"):
            for pattern in (SONAME, "*/" + SONAME, "../lib64/" + SONAME):
                yield from (str(path) for path in sorted(parent.glob(pattern)))
            break
    yield SONAME
    found = ctypes.util.find_library("hairmesh")
    if found:
        yield found


def _load():
    faults = []
    for name in _candidates():
        try:
            return ctypes.CDLL(name)
        except OSError as error:
            faults.append(str(error))
    raise ImportError("hairmesh: the shared library cannot be loaded (" + "; ".join(faults) +
                      "); install it, or name the file in HAIRMESH_LIBRARY")


lib = _load()

_FUNCTIONS = {
    "hm_version": (c_int32, []),
    "hm_result_name": (c_char_p, [ctypes.c_int]),
    "hm_error_message": (c_char_p, []),
    "hm_default_mesh_settings": (None, [POINTER(MeshSettings)]),
    "hm_mesh_create": (None, [POINTER(MeshSettings), POINTER(Mesh)]),
    "hm_mesh_create_from_text": (None, [c_char_p, c_size_t, c_char_p, c_int32, POINTER(Mesh)]),
    "hm_mesh_create_style": (None, [c_char_p, c_char_p, c_double, POINTER(Mesh)]),
    "hm_mesh_destroy": (None, [Mesh]),
    "hm_mesh_describe": (None, [Mesh, POINTER(MeshInfo)]),
    "hm_parameter_count": (c_int32, []),
    "hm_parameter_at": (None, [c_int32, POINTER(Parameter)]),
    "hm_default_hair_settings": (None, [POINTER(HairSettings)]),
    "hm_hair_create": (None, [Mesh, POINTER(HairSettings), POINTER(Hair)]),
    "hm_hair_destroy": (None, [Hair]),
    "hm_hair_set": (None, [Hair, c_char_p, c_double]),
    "hm_hair_set_text": (None, [Hair, c_char_p, c_char_p]),
    "hm_hair_get": (None, [Hair, c_char_p, POINTER(c_double)]),
    "hm_hair_reset_parameters": (None, [Hair]),
    "hm_default_ellipsoid": (None, [POINTER(Ellipsoid)]),
    "hm_ellipsoid_moved": (None, [POINTER(Ellipsoid), POINTER(Pose), c_double]),
    "hm_default_step_input": (None, [POINTER(StepInput)]),
    "hm_hair_step": (None, [Hair, POINTER(StepInput), POINTER(Report)]),
    "hm_hair_reset": (None, [Hair, POINTER(Pose)]),
    "hm_hair_carry": (None, [Hair, POINTER(Pose), POINTER(Pose)]),
    "hm_hair_save": (None, [Hair, c_void_p, c_size_t, POINTER(c_size_t)]),
    "hm_hair_restore": (None, [Hair, c_char_p, c_size_t]),
    "hm_hair_positions": (None, [Hair, POINTER(View)]),
    "hm_hair_velocities": (None, [Hair, POINTER(View)]),
    "hm_default_strand_settings": (None, [POINTER(StrandSettings)]),
    "hm_hair_grow_strands": (None, [Hair, POINTER(StrandSettings), POINTER(StrandOutput)]),
    "hm_hair_describe_strand": (None, [Hair, c_int32, POINTER(Strand)]),
}


class Error(Exception):
    """A call that failed; `result` is its name, as HM_ERROR_SIZE."""

    def __init__(self, code):
        super().__init__(lib.hm_error_message().decode(errors="replace"))
        self.code = code
        self.result = lib.hm_result_name(code).decode()


def _raise_on_failure(code, function, arguments):
    if code != 0:
        raise Error(code)


for _name, (_result, _arguments) in _FUNCTIONS.items():
    _function = getattr(lib, _name)
    _function.argtypes = _arguments
    _function.restype = _result
    # Functions of hm_result raise; those without a result, hm_default_..., give none.
    if _result is None and not _name.startswith("hm_default"):
        _function.restype = ctypes.c_int
        _function.errcheck = _raise_on_failure
