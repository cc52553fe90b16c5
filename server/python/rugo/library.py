"""librugo through ctypes: where it is, its structs and functions as rugo.h declares them, and its errors.

The library is the file that RUGO_LIBRARY names, else one beside this file, else the one that the system's
loader finds. Calls release Python's global lock; an object of the library belongs to one thread at a time.
"""

from __future__ import annotations

import contextlib
import ctypes
import functools
import os
import pathlib
from ctypes import POINTER, Structure, byref, c_char, c_char_p, c_double, c_int, c_size_t, c_uint64, c_void_p

from .client import RugoError

SONAME = "librugo.so.0.1"  # whose structs are those below
LISTS = ("spectra", "distributions", "summit_rules", "trends", "models")  # those that rugo_choice knows


class LibraryError(RugoError):
    """What librugo refuses. `code` is that of rugo.h: -1 an argument or a file is wrong, -2 no memory, -3 a
    file could not be read or written, -4 no result of the required accuracy."""

    def __init__(self, code: int, text: str):
        super().__init__(None, text)
        self.code = code


class Error(Structure):
    _fields_ = [("code", c_int), ("text", c_char * 480)]


class Grid(Structure):
    _fields_ = [("nx", c_size_t), ("ny", c_size_t), ("lx", c_double), ("ly", c_double)]


class Spectrum(Structure):
    _fields_ = [("type", c_int), ("hurst", c_double), ("wavelength_long", c_double), ("wavelength_short", c_double),
                ("wavelength_rolloff", c_double), ("correlation_x", c_double), ("correlation_y", c_double),
                ("table_count", c_size_t), ("table_wave_number", c_void_p), ("table_density", c_void_p),
                ("rms_height", c_double), ("rms_slope", c_double)]


class Moments(Structure):
    _fields_ = [(name, c_double) for name in (
        "m00", "m20", "m02", "m11", "m22", "m40", "m04", "m31", "m13", "m0", "m2", "m4", "nayak_alpha",
        "rms_height", "rms_slope", "rms_curvature")]


class SurfaceOptions(Structure):
    _fields_ = [("heights", c_int), ("shape", c_double), ("quantile", c_void_p), ("quantile_context", c_void_p),
                ("keep_heights", c_int), ("tolerance", c_double), ("max_iterations", c_size_t),
                ("random_amplitudes", c_int), ("second_shape", c_double)]


class Roughness(Structure):
    _fields_ = [(name, c_double) for name in (
        "mean", "rms_height", "rms_slope", "rms_curvature", "skewness", "kurtosis", "lowest", "highest")]


class Summit(Structure):
    _fields_ = [(name, c_double) for name in ("x", "y", "height", "curvature")]


class Summits(Structure):
    _fields_ = [("summits", POINTER(Summit)), ("count", c_size_t)]


class Areal(Structure):
    _fields_ = [(name, c_double) for name in (
        "sa", "sq", "ssk", "sku", "sp", "sv", "sz", "sdq", "sdr", "sal", "str", "spd", "spc")]


class Block(Structure):
    _fields_ = [("model", c_int), ("poisson", c_double), ("height", c_double), ("layer_growth", c_double)]


class ContactState(Structure):
    _fields_ = [("pressure", c_double), ("p", c_void_p), ("gap", c_void_p), ("area", c_double),
                ("area_nodes", c_double), ("area_lower", c_double), ("area_upper", c_double), ("mean_gap", c_double),
                ("stiffness", c_double), ("patches", c_size_t), ("iterations", c_size_t), ("violation", c_double)]


_GRID, _ERROR, _HANDLE = POINTER(Grid), POINTER(Error), POINTER(c_void_p)
# What each function returns and takes; heights and other arrays go by their addresses.
_FUNCTIONS = {
    "rugo_version": (c_char_p,),
    "rugo_choice": (c_char_p, c_char_p, c_size_t, POINTER(c_int)),
    "rugo_surface_defaults": (SurfaceOptions,),
    "rugo_generator_create": (c_int, _HANDLE, POINTER(Spectrum), _GRID, POINTER(SurfaceOptions), _ERROR),
    "rugo_generator_run": (c_int, c_void_p, c_uint64, c_uint64, c_uint64, c_void_p, c_void_p, _ERROR),
    "rugo_generator_destroy": (None, _HANDLE),
    "rugo_roughness": (c_int, _GRID, c_void_p, POINTER(Roughness), _ERROR),
    "rugo_open_roughness": (c_int, _GRID, c_void_p, POINTER(Roughness), _ERROR),
    "rugo_moments": (c_int, _GRID, c_void_p, POINTER(Moments), _ERROR),
    "rugo_open_moments": (c_int, _GRID, c_void_p, POINTER(Moments), _ERROR),
    "rugo_areal": (c_int, _GRID, c_void_p, c_int, POINTER(Areal), _ERROR),
    "rugo_psd_size": (c_size_t, _GRID),
    "rugo_psd": (c_int, _GRID, c_void_p, c_void_p, c_void_p, _ERROR),
    "rugo_open_psd": (c_int, _GRID, c_void_p, c_void_p, c_void_p, _ERROR),
    "rugo_summits_find": (c_int, POINTER(Summits), _GRID, c_void_p, c_int, _ERROR),
    "rugo_open_summits_find": (c_int, POINTER(Summits), POINTER(c_double), _GRID, c_void_p, c_int, _ERROR),
    "rugo_summits_clear": (None, POINTER(Summits)),
    "rugo_detrend": (c_int, _GRID, c_void_p, c_int, _ERROR),
    "rugo_seam": (c_int, _GRID, c_void_p, POINTER(c_double), _ERROR),
    "rugo_block_defaults": (Block, c_int, _GRID),
    "rugo_contact_create": (c_int, _HANDLE, _GRID, POINTER(Block), _ERROR),
    "rugo_contact_create_open": (c_int, _HANDLE, _GRID, _ERROR),
    "rugo_contact_begin": (c_int, c_void_p, c_void_p, _ERROR),
    "rugo_contact_press": (c_int, c_void_p, c_double, POINTER(ContactState), _ERROR),
    "rugo_contact_approach": (c_double, c_void_p),
    "rugo_contact_full_pressure": (c_double, c_void_p),
    "rugo_contact_destroy": (None, _HANDLE),
}


def _open() -> ctypes.CDLL:
    beside = pathlib.Path(__file__).with_name(SONAME)
    name = os.environ.get("RUGO_LIBRARY") or (str(beside) if beside.exists() else SONAME)
    try:
        return ctypes.CDLL(name)
    except OSError as error:
        raise RugoError(None, f"librugo is not installed, or cannot be loaded ({error}): `sudo make install` and "
                              "`sudo ldconfig` in a clone of Rugo install it, or RUGO_LIBRARY names the file") from None


@functools.lru_cache(maxsize=None)
def library() -> ctypes.CDLL:
    """The library with its functions declared; RugoError where there is none, or one of other structs."""
    found = _open()
    try:
        for name, (result, *arguments) in _FUNCTIONS.items():
            function = getattr(found, name)
            function.restype, function.argtypes = result, arguments
    except AttributeError as error:
        raise RugoError(None, f"this package needs another librugo: {error}") from None
    version = found.rugo_version().decode()
    if not f"librugo.so.{version}".startswith(SONAME + "."):
        raise RugoError(None, f"this package is for {SONAME}, and the librugo found is of version {version}")
    return found


def library_version() -> str:
    """The version of librugo, which is that of the program."""
    return library().rugo_version().decode()


def call(name: str, *arguments) -> None:
    """Calls a function of librugo with an error behind its arguments; raises LibraryError."""
    error = Error()
    status = getattr(library(), name)(*arguments, byref(error))
    if status != 0:
        raise LibraryError(status, error.text.decode("utf-8", "replace"))


@contextlib.contextmanager
def made(kind: str, create: str, *arguments):
    """An object of librugo for the length of a `with`: rugo_KIND_CREATE makes it, rugo_KIND_destroy ends it."""
    handle = c_void_p()
    call(f"rugo_{kind}_{create}", byref(handle), *arguments)
    try:
        yield handle
    finally:
        getattr(library(), f"rugo_{kind}_destroy")(byref(handle))


@functools.lru_cache(maxsize=None)
def _choices(kind: str) -> dict:
    found, value = {}, c_int()
    while True:
        name = library().rugo_choice(kind.encode(), len(found), byref(value))
        if name is None:
            return found
        found[name.decode()] = value.value


def choices(kind: str) -> dict:
    """The names of a list of librugo and the values of its enumeration: of "spectra", "distributions",
    "summit_rules", "trends" or "models"; ValueError for another list."""
    if kind not in LISTS:
        raise ValueError(f"{kind!r} is none of the lists: {', '.join(LISTS)}")
    return dict(_choices(kind))


def choice(kind: str, name: str) -> int:
    """The value of a name of a list; ValueError with those that there are."""
    known = _choices(kind)
    if name not in known:
        raise ValueError(f"{name!r} is none of the {kind.replace('_', ' ')}: {', '.join(known)}")
    return known[name]
