"""Height maps as NumPy arrays: what they are like, their contact with a rigid flat, random ones; by librugo.

A map z is an array of shape (ny, nx): z[j, i] is the height at (i*dx, j*dy), x runs fastest. A profile has the
shape (nx,) or (1, nx). Lengths are in any one unit, heights too. Arrays that are C-contiguous and of float64 are
passed by their addresses; others are copied. NaN and masked heights are holes, which open maps may have.
"""

from __future__ import annotations

import ctypes
import operator
import typing
from ctypes import byref

import numpy
from numpy.typing import ArrayLike

from . import library
from .client import Rows

# The measures of a load, in the order of struct rugo_contact_state, whose pointers are maps.
MEASURES = tuple(name for name, kind in library.ContactState._fields_ if kind is not ctypes.c_void_p)


def _open(boundary: str) -> bool:
    if boundary not in ("periodic", "open"):
        raise ValueError(f"the boundary is periodic or open, not {boundary!r}")
    return boundary == "open"


def _grid(shape: typing.Sequence[int], dx: float, dy: typing.Optional[float]) -> library.Grid:
    if len(shape) not in (1, 2):
        raise ValueError(f"a map has the shape (ny, nx), a profile (nx,), not {tuple(shape)}")
    if numpy.ndim(dx) != 0 or (dy is not None and numpy.ndim(dy) != 0):
        raise ValueError(f"dx and dy are one number each, the spacings along x and y: not dx={dx!r}, dy={dy!r}")
    nx, ny = shape[-1], shape[0] if len(shape) == 2 else 1
    return library.Grid(nx, ny, nx * dx, ny * (dx if dy is None else dy))


def _heights(z: ArrayLike) -> numpy.ndarray:
    """The map as the library takes it: itself where it can be passed by its address."""
    if isinstance(z, numpy.ma.MaskedArray):
        z = numpy.ma.filled(z.astype(numpy.float64), numpy.nan)
    return numpy.ascontiguousarray(z, dtype=numpy.float64)


def _taken(z: ArrayLike, dx: float, dy: typing.Optional[float]) -> typing.Tuple[numpy.ndarray, library.Grid]:
    heights = _heights(z)
    return heights, _grid(heights.shape, dx, dy)


def _address(array: numpy.ndarray) -> int:
    return array.ctypes.data


def _measured(name: str, out: ctypes.Structure, z: numpy.ndarray, grid: library.Grid) -> dict:
    library.call(name, byref(grid), _address(z), byref(out))
    return {field: getattr(out, field) for field, _ in out._fields_}


def detrend(z: ArrayLike, dx: float = 1.0, *, dy: typing.Optional[float] = None, trend: str = "plane") -> numpy.ndarray:
    """A copy of the map without its trend of least squares: "mean", "plane" or "quadratic"."""
    heights = numpy.array(_heights(z))
    grid = _grid(heights.shape, dx, dy)
    library.call("rugo_detrend", byref(grid), _address(heights), library.choice("trends", trend))
    return heights


def summits(z: ArrayLike, dx: float = 1.0, *, dy: typing.Optional[float] = None, rule: str = "nine_point",
            boundary: str = "periodic") -> typing.Tuple[numpy.ndarray, float]:
    """The summits of a map, or the peaks of a profile, and the area (length) in which they were sought.

    They are a structured array with the fields x, y, height and curvature, -(z_xx + z_yy)/2, of a profile -z_xx.
    rule: "nine_point" (above the 8 neighbours), "five_point", or "refined" (between the points).
    """
    heights, grid = _taken(z, dx, dy)
    found, searched = library.Summits(), ctypes.c_double(grid.lx * (grid.ly if grid.ny > 1 else 1))
    number = library.choice("summit_rules", rule)
    if _open(boundary):
        library.call("rugo_open_summits_find", byref(found), byref(searched), byref(grid), _address(heights), number)
    else:
        library.call("rugo_summits_find", byref(found), byref(grid), _address(heights), number)
    try:
        kind = numpy.dtype(library.Summit)
        size = found.count * kind.itemsize
        text = ctypes.string_at(found.summits, size) if size > 0 else b""
        return numpy.frombuffer(bytearray(text), dtype=kind), searched.value
    finally:
        library.library().rugo_summits_clear(byref(found))


def psd(z: ArrayLike, dx: float = 1.0, *, dy: typing.Optional[float] = None,
        boundary: str = "periodic") -> typing.Tuple[numpy.ndarray, numpy.ndarray]:
    """Wave numbers |k| (radians per length) and the power spectral density over them, in rings: the mean square
    height is its integral over the plane of k, of a profile over both signs. Open maps are taken under Hann's
    window."""
    heights, grid = _taken(z, dx, dy)
    wave_number, density = numpy.empty((2, library.library().rugo_psd_size(byref(grid))))
    library.call("rugo_open_psd" if _open(boundary) else "rugo_psd", byref(grid), _address(heights),
                 _address(wave_number), _address(density))
    return wave_number, density


def _summit_group(z: numpy.ndarray, dx: float, dy, rule: str, boundary: str) -> dict:
    found, searched = summits(z, dx, dy=dy, rule=rule, boundary=boundary)
    some = len(found) > 0
    return {"count": len(found), "density": len(found) / searched if searched > 0 else numpy.nan,
            "height_mean": float(found["height"].mean()) if some else numpy.nan,
            "height_deviation": float(found["height"].std()) if some else numpy.nan,
            "curvature_mean": float(found["curvature"].mean()) if some else numpy.nan}


def characterise(z: ArrayLike, dx: float = 1.0, *, dy: typing.Optional[float] = None, boundary: str = "periodic",
                 trend: typing.Optional[str] = None, rule: str = "nine_point") -> typing.Dict[str, dict]:
    """What a map is like: a dict of groups, named as those of `rugo characterise`, whose defaults are others: the
    command looks whether a map is periodic, and takes a plane off one that is not.

    grid: points, spacings. heights: mean, rms (about the mean), skewness, kurtosis (3 for Gaussian ones), lowest,
    highest. finite_difference: rms_slope, the root mean square of the gradient, by forward differences;
    rms_curvature, that of (z_xx + z_yy)/2, of a profile of z_xx, by second differences. spectral: moments m_pq,
    the sums of kx^p ky^q over all waves, Nayak's alpha, slope and curvature by derivatives that are exact for
    waves which the grid holds; of open maps interpolated, by derivatives of polynomials through the points nearby.
    summits_RULE, of a profile its peaks: count, density (per area, of a profile per length), mean and deviation of heights, mean curvature.
    areal: parameters of ISO 25178-2 (surfaces alone).

    boundary: "periodic", or "open" for a map that ends at its sides, such as a measured one, and may have holes.
    trend: "mean", "plane" or "quadratic" is subtracted first, from a copy; None: nothing, of open maps, too.

    SurfaceTopography's heights() are z.T: its first index runs along x. Of its periodic topographies
    rms_height_from_area, rms_gradient and rms_curvature_from_area are heights.rms, finite_difference.rms_slope
    and finite_difference.rms_curvature; of profiles those from_profile.
    """
    if trend is not None:
        z = detrend(z, dx, dy=dy, trend=trend)
    heights, grid = _taken(z, dx, dy)
    holes = "open_" if _open(boundary) else ""
    roughness = _measured(f"rugo_{holes}roughness", library.Roughness(), heights, grid)
    found = {"grid": {"nx": grid.nx, "ny": grid.ny, "dx": dx, "dy": dx if dy is None else dy},
             "heights": {"rms" if name == "rms_height" else name: roughness[name]
                         for name in ("mean", "rms_height", "skewness", "kurtosis", "lowest", "highest")},
             "finite_difference": {name: roughness[name] for name in ("rms_slope", "rms_curvature")},
             "interpolated" if holes else "spectral":
                 _measured(f"rugo_{holes}moments", library.Moments(), heights, grid),
             f"summits_{rule}": _summit_group(heights, dx, dy, rule, boundary)}
    if grid.ny > 1:
        areal = library.Areal()
        library.call("rugo_areal", byref(grid), _address(heights), int(holes != ""), byref(areal))
        found["areal"] = {field.capitalize(): getattr(areal, field) for field, _ in areal._fields_}
    return found


class Pressed:
    """A map under rising or falling loads. An array of one value a load each: pressure (mean, over E*), area
    (contact fraction by edges between nodes, the best estimate), area_nodes (share of nodes, too large),
    area_lower and area_upper (bounds; all of the full model as the face stretches under load), mean_gap,
    stiffness (-d pressure/d mean_gap; infinite in full contact), patches, iterations, violation (largest
    penetration over the RMS height), approach (of the flat, since it first touched). full_pressure is the least
    pressure of full contact, NaN where there is none. p and gap, unless None, are the local pressures over E*
    and the gaps: (loads,) + the shape of the map."""

    pressure: numpy.ndarray
    area: numpy.ndarray
    area_nodes: numpy.ndarray
    area_lower: numpy.ndarray
    area_upper: numpy.ndarray
    mean_gap: numpy.ndarray
    stiffness: numpy.ndarray
    patches: numpy.ndarray
    iterations: numpy.ndarray
    violation: numpy.ndarray
    approach: numpy.ndarray

    def __init__(self, states: typing.List[dict], full_pressure: float, p, gap):
        for name in (*MEASURES, "approach"):
            setattr(self, name, numpy.array([state[name] for state in states]))
        self.full_pressure, self.p, self.gap, self._states = full_pressure, p, gap, states

    @property
    def rows(self) -> Rows:
        """A dict a load, of the measures; rows.frame() is a pandas.DataFrame."""
        return Rows(dict(state) for state in self._states)


def _block(grid: library.Grid, model: str, poisson, height, layer_growth) -> library.Block:
    block = library.library().rugo_block_defaults(library.choice("models", model), byref(grid))
    for name, value in (("poisson", poisson), ("height", height), ("layer_growth", layer_growth)):
        if value is not None:
            setattr(block, name, value)
    return block


def _press_one(contact, pressure: float, maps: typing.Sequence[numpy.ndarray]) -> dict:
    state = library.ContactState()
    library.call("rugo_contact_press", contact, pressure, byref(state))
    for out, address in zip(maps, (state.p, state.gap)):
        ctypes.memmove(_address(out), address, out.nbytes)
    measures = {name: getattr(state, name) for name in MEASURES}
    return dict(measures, approach=library.library().rugo_contact_approach(contact))


def press(z: ArrayLike, dx: float = 1.0, pressures: ArrayLike = (), *, dy: typing.Optional[float] = None,
          boundary: str = "periodic", model: str = "halfspace", poisson: typing.Optional[float] = None,
          height: typing.Optional[float] = None, layer_growth: typing.Optional[float] = None,
          maps: bool = False) -> Pressed:
    """Presses a rough elastic block, whose face is the map, on a rigid flat, without friction and adhesion.
    Hardness, friction, leak and conductance are for the command `rugo press` and for studies.

    z: heights towards the flat, the highest touch first; any mean. pressures: mean pressures over E*, one after
    the other; a load p/(E* h') of studies times the RMS slope h' (characterise: spectral, of open maps interpolated). boundary: "periodic", or
    "open" for a half-space in free space that touches within the map alone. model, of periodic maps: "halfspace", "layered" or
    "full" (finite strain; far slower). poisson (0.3; without influence on a half-space), height of the block in
    the unit of dx (1.5 times the longer side of the map; of a half-space infinite), layer_growth (1.1): of the block. maps: whether to keep p
    and gap, two maps a load. Raises LibraryError, with the accuracy reached where there is no convergence.

    Heights of other packages are passed as they are, with the spacing along the last axis as dx. Of a topography of
    SurfaceTopography that is rugo.press(topography.heights().T, dx=topography.pixel_size[0],
    dy=topography.pixel_size[1], pressures=[...]), and with square pixels, but for the directions of its axes,
    rugo.press(topography.heights(), dx=topography.pixel_size[0], pressures=[...]).
    """
    heights, grid = _taken(z, dx, dy)
    block = _block(grid, model, poisson, height, layer_growth)
    if _open(boundary) and (model, poisson, height, layer_growth) != ("halfspace", None, None, None):
        raise ValueError("an open map presses a half-space: it has no other model and no block")
    loads = numpy.atleast_1d(numpy.asarray(pressures, dtype=numpy.float64))
    kept = [numpy.empty((len(loads), *heights.shape)) for _ in range(2)] if maps else []
    creation = ("create_open", byref(grid)) if boundary == "open" else ("create", byref(grid), byref(block))
    with library.made("contact", *creation) as contact:
        library.call("rugo_contact_begin", contact, _address(heights))
        full_pressure = library.library().rugo_contact_full_pressure(contact)
        states = [_press_one(contact, load, [out[n] for out in kept]) for n, load in enumerate(loads)]
    return Pressed(states, full_pressure, *(kept or (None, None)))


def _whole(name: str, value, least: int = 0) -> int:
    """A whole number that 64 bits hold; what wraps around would be another one."""
    number = operator.index(value)
    if not least <= number < 2**64:
        raise ValueError(f"{name} is {number}; allowed: whole numbers from {least} to 2^64 - 1")
    return number


def surface(shape: typing.Union[int, typing.Sequence[int]], dx: float = 1.0, *, dy: typing.Optional[float] = None,
            seed: int = 1, realisation: int = 0, sequence: int = 0, spectrum: str = "self_affine", hurst: float = 0.8,
            wavelength_long: float = 0.0, wavelength_short: float = 0.0,
            wavelength_rolloff: typing.Optional[float] = None, correlation: typing.Sequence[float] = (0.0, 0.0),
            table: typing.Sequence[ArrayLike] = ((), ()), rms_height: float = 0.0, rms_slope: float = 0.0,
            heights: str = "gaussian", heights_shape: typing.Optional[float] = None, second_shape: float = 0.0,
            keep_heights: bool = False, random_amplitudes: bool = False, tolerance: typing.Optional[float] = None,
            max_iterations: typing.Optional[int] = None, out: typing.Optional[numpy.ndarray] = None) -> numpy.ndarray:
    """A random surface of this shape, (ny, nx), or a profile, nx: the same for the same seed and realisation, and as
    a study of this seed has it.

    spectrum: "self_affine" from wavelength_long to wavelength_short, flat beyond wavelength_rolloff (between the
    two; none: the longest); "exponential_acf" with the lengths correlation = (bx, by); or "table" of wave numbers
    (rising, radians per length) and densities. rms_height or rms_slope scales it; neither: RMS height 1. heights:
    "gaussian", or of "weibull_min", "weibull_max", "lognormal", "gamma" or "beta", with heights_shape and, of beta,
    second_shape; then the spectrum is exact, or with keep_heights the heights, and tolerance and max_iterations are
    those of the iteration. random_amplitudes: the mean of all surfaces has the spectrum, not each of them. out: a
    C-contiguous array of float64 to fill.
    """
    shape = (int(shape),) if numpy.ndim(shape) == 0 else tuple(shape)
    grid = _grid(shape, dx, dy)
    z = numpy.empty(shape) if out is None else out
    if z.dtype != numpy.float64 or z.shape != shape or not z.flags.c_contiguous or not z.flags.writeable:
        raise ValueError(f"out must be a C-contiguous array of float64 of the shape {shape}")
    wave_number, density = (_heights(column) for column in table)
    if wave_number.shape != density.shape or wave_number.ndim != 1:
        raise ValueError("a table has as many densities as wave numbers")
    kind = library.Spectrum(
        library.choice("spectra", spectrum), hurst, wavelength_long, wavelength_short,
        wavelength_long if wavelength_rolloff is None else wavelength_rolloff, *correlation,
        len(wave_number), _address(wave_number), _address(density), rms_height, rms_slope)
    options = library.library().rugo_surface_defaults()
    options.heights = library.choice("distributions", heights)
    options.second_shape = second_shape
    options.keep_heights, options.random_amplitudes = bool(keep_heights), bool(random_amplitudes)
    seed, sequence, realisation = (_whole(name, value) for name, value in
                                   (("seed", seed), ("sequence", sequence), ("realisation", realisation)))
    if max_iterations is not None:
        max_iterations = _whole("max_iterations", max_iterations, 1)
    for name, value in (("shape", heights_shape), ("tolerance", tolerance), ("max_iterations", max_iterations)):
        if value is not None:
            setattr(options, name, value)
    with library.made("generator", "create", byref(kind), byref(grid), byref(options)) as generator:
        library.call("rugo_generator_run", generator, seed, sequence, realisation, _address(z), None)
    return z
