"""Studies run by the installed program `rugo`, and their results as tables.

The program is the one that RUGO_PROGRAM names, else the `rugo` of PATH.
"""

from __future__ import annotations

import functools
import io
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import typing

from .client import Rows, RugoError, rows_of_csv, rows_of_scalars

if typing.TYPE_CHECKING:
    import numpy
    import pandas

    Table = typing.Union[pandas.DataFrame, Rows]
Study = typing.Union[str, "os.PathLike[str]", typing.Mapping[str, typing.Any]]


def _program() -> str:
    name = os.environ.get("RUGO_PROGRAM") or "rugo"
    found = shutil.which(name)
    if found is None:
        raise RugoError(None, f"the program {name} is not installed: `sudo make install` in a clone of Rugo installs "
                              "it, or RUGO_PROGRAM names the file")
    return found


def _listen(stream, said: typing.List[bytes], progress: bool) -> None:
    """Keeps what comes, by lines, and passes it on where progress is asked for."""
    for line in stream:
        said.append(line)
        if progress:
            sys.stderr.write(line.decode("utf-8", "replace"))
            sys.stderr.flush()


def _call(command: str, study: Study, changes, options, progress: bool = False) -> bytes:
    """What the program prints about a study: a path, JSON text or a dict. RugoError with what it refuses."""
    line, text = [_program(), command], None
    if isinstance(study, typing.Mapping):
        text = json.dumps(study).encode()
    elif isinstance(study, str) and study.lstrip().startswith("{"):
        text = study.encode()
    line += ["-" if text is not None else os.fspath(study), *options]
    for name, value in (changes or {}).items():
        line += ["--set", f"{name}={json.dumps(value)}"]
    with subprocess.Popen(line, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as running:
        said: typing.List[bytes] = []
        listening = threading.Thread(target=_listen, args=(running.stderr, said, progress))
        listening.start()
        try:
            running.stdin.write(text or b"")
            running.stdin.close()
            printed = running.stdout.read()
            running.wait()
        except KeyboardInterrupt:  # it hands back what it has leased; a second one kills it
            running.send_signal(signal.SIGINT)
            try:
                running.stdout.read()
                running.wait()
            except KeyboardInterrupt:
                running.kill()
            raise
        except BrokenPipeError:  # it ended before it read the study, and said why
            printed = b""
            running.wait()
        except BaseException:
            running.kill()
            raise
        finally:
            listening.join()
    if running.returncode != 0:
        reason = b"".join(said).decode("utf-8", "replace").strip()
        raise RugoError(None, reason or f"rugo {command} ended with status {running.returncode}")
    return printed


def _table(rows: Rows) -> Table:
    try:
        return rows.frame()
    except ImportError:
        return rows


class Picture(str):
    """A picture as SVG text, which notebooks show."""

    def _repr_svg_(self):
        return str(self)


class Result:
    """The results of a study. `summary` is the table that the program prints, `folder` where its files are:
    curves.csv, curves.json, a picture a quantity, and the store rugo.db. A temporary folder lasts as long as
    its Result."""

    def __init__(self, folder: pathlib.Path, summary: str, temporary=None):
        self.folder, self.summary, self._temporary = folder, summary, temporary

    def __repr__(self):
        return f"Result({self.document['name']}, {len(self.document['cases'])} cases)"

    @functools.cached_property
    def document(self) -> dict:
        """The curves, scalars, parameters and notes of the cases, as in curves.json."""
        return json.loads((self.folder / "curves.json").read_text(encoding="utf-8"))

    @functools.cached_property
    def curves(self) -> Table:
        """A row a point of each curve: case, what is swept, quantity, series ("main" where a quantity has one
        alone), model, level, x, y, standard_error, errors by source, theories, total_low, total_high,
        unknown_errors; all columns of curves.csv."""
        return _table(rows_of_csv((self.folder / "curves.csv").read_text(encoding="utf-8")))

    @functools.cached_property
    def scalars(self) -> Table:
        """A row a case and scalar: case, its parameters (by the last word, where several have it by the
        pointer without its first slash), name, value, standard_error, theory, errors by source, total_low, total_high and a list unknown_errors."""
        return _table(rows_of_scalars(self.document))

    def picture(self, quantity: str) -> Picture:
        """The picture of a quantity, such as "contact_area"; KeyError, with those that there are."""
        path = self.folder / f"{quantity}.svg"
        if not path.is_file():
            raise KeyError(f"{quantity}: no picture; there are {sorted(file.stem for file in self.folder.glob('*.svg'))}")
        return Picture(path.read_text(encoding="utf-8"))


def run(study: Study, folder: typing.Optional[typing.Union[str, "os.PathLike[str]"]] = None, *,
        changes: typing.Optional[typing.Mapping[str, typing.Any]] = None, workers: int = 0,
        progress: bool = False) -> Result:
    """Runs a study on this machine by the program `rugo`, and returns its Result.

    study: a dict, JSON text, or the path of a file. changes: parameters in place of the study's, such as
    {"surface/hurst": [0.2, 0.8]}. workers: threads; 0: as many as there are processors. progress: the
    program's messages go to standard error. folder: where store and results stay; a study that is run there
    again goes on where it was. Without one they are temporary. Files that a dict or a text names are relative
    to the current folder, those of a file to its own. Raises RugoError with all faults of the study.
    """
    temporary = tempfile.TemporaryDirectory(prefix="rugo-") if folder is None else None
    place = pathlib.Path(temporary.name if temporary is not None else folder)
    place.mkdir(parents=True, exist_ok=True)
    options = ["--db", str(place / "rugo.db"), "--out", str(place), "--workers", str(workers)]
    summary = _call("run", study, changes, options, progress).decode("utf-8", "replace")
    return Result(place, summary, temporary)


def generate(study: Study, case: int = 0, realisation: int = 0, *,
             changes: typing.Optional[typing.Mapping[str, typing.Any]] = None) -> numpy.ndarray:
    """The surface of a realisation of a case of a study, by the program `rugo`: an array of shape (ny, nx), of
    a profile (nx,), of heights in the units of the study (by default RMS height 1). The points are
    1/points_per_wavelength apart, in units of the shortest wavelength. study, changes: as of run."""
    import numpy

    options = ["--case", str(case), "--realisation", str(realisation), "--format", "npy"]
    return numpy.load(io.BytesIO(_call("generate", study, changes, options)), allow_pickle=False)
