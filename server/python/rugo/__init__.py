"""Rugo in Python: studies of rough surfaces and their contact, and single maps as NumPy arrays.

    import rugo

    result = rugo.run("first.json")            # by the installed program; .curves and .scalars are tables
    z = rugo.generate("first.json", case=1)    # the surface of a realisation, z[j, i] at x = i*dx, y = j*dx
    found = rugo.characterise(z, dx=0.125)     # what a map is like: by librugo, as all below
    pressed = rugo.press(z, dx=0.125, pressures=[0.01, 0.1])
    server = rugo.Server("http://127.0.0.1:8080")    # studies on a service: client.py, which works alone too

Lengths are in any one unit, pressures in units of E* = E/(1 - nu^2). Tables are pandas.DataFrames where
pandas is installed, else Rows, which are lists of dicts. NumPy is needed for maps alone.
"""

from __future__ import annotations

import typing

from .client import Rows, RugoError, Server, Study
from .study import Result, generate, run

if typing.TYPE_CHECKING:
    from .library import LibraryError, choices, library_version
    from .maps import Pressed, characterise, detrend, press, psd, summits, surface

_LIBRARY = ("LibraryError", "choices", "library_version")
_MAPS = ("Pressed", "characterise", "detrend", "press", "psd", "summits", "surface")
__all__ = ["Result", "Rows", "RugoError", "Server", "Study", "generate", "run", *_LIBRARY, *_MAPS]


def __getattr__(name):
    """Names that need librugo or NumPy are imported when they are first used."""
    if name in _LIBRARY:
        from . import library as module
    elif name in _MAPS:
        from . import maps as module
    else:
        raise AttributeError(f"module rugo has no attribute {name!r}")
    return getattr(module, name)
