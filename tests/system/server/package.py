"""What test_python.c and check-python run: the package rugo, with the program and library that RUGO_PROGRAM and
RUGO_LIBRARY name. Arguments: the tree, an empty folder, and, for the page, the URL of a service."""

import contextlib
import ctypes
import gc
import io
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import threading

import rugo
from rugo import library

TREE, FOLDER, URL = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2], sys.argv[3] if len(sys.argv) > 3 else None
STUDY = {"name": "first", "kind": "statistics", "seed": 11, "realisations": 8,
         "surface": {"hurst": [0.2, 0.8], "wavelength_ratio": 4, "length_ratio": 4},
         "statistics": {"bins": {"height": [-4, 8, 120], "curvature": [-16, 0, 16]}}}
HEADER = re.sub(r"/\*.*?\*/", "", (TREE / "core/rugo.h").read_text(encoding="utf-8"), flags=re.S)


def installed(name):
    try:
        __import__(name)
        return True
    except ImportError:
        return False


def skipped(what, name):
    if not installed(name):
        print(f"SKIP {what}: there is no {name}")
    return not installed(name)


def raises(kind, call, *words):
    try:
        call()
    except kind as error:
        assert all(word in str(error) for word in words), error
        return error
    raise AssertionError(f"not raised: {words}")


# --- the library is that of the header ---


def kind_of(declared):
    """The type of ctypes for one of C: all pointers are alike but those whose structs are read."""
    if "*" in declared or "(" in declared:
        return "pointer"
    word = re.sub(r"^(const |struct |enum )+", "", declared).strip().split()[0]
    return {"size_t": ctypes.c_size_t, "double": ctypes.c_double, "int": ctypes.c_int,
            "uint64_t": ctypes.c_uint64, "void": None}.get(word, ctypes.c_int if "enum " in declared else word)


def python_kind(kind):
    if kind in (ctypes.c_void_p, ctypes.c_char_p) or isinstance(kind, type(ctypes.POINTER(ctypes.c_int))):
        return "pointer"
    if isinstance(kind, type) and issubclass(kind, ctypes.Structure):
        return name_in_c(kind)
    return kind


def name_in_c(structure):
    return "rugo" + re.sub("([A-Z])", lambda letter: "_" + letter.group(1).lower(), structure.__name__)


def members_of_header(name):
    body = re.search(r"struct %s \{(.*?)\};" % name, HEADER, re.S).group(1)
    members = []
    for line in filter(None, (text.strip() for text in body.split(";"))):
        function = re.match(r"double \(\*(\w+)\)", line)
        if function:
            members.append((function.group(1), "pointer"))
            continue
        kind, names = re.match(r"((?:const |struct |enum )*\w+)\s+(.*)", line, re.S).groups()
        for one in names.split(","):
            size = re.search(r"\[(\d+)\]", one)
            found = ("char", int(size.group(1))) if size else "pointer" if "*" in one else kind_of(kind)
            members.append((re.search(r"\w+", one).group(0), found))
    return members


def structs_are_those_of_the_header():
    structs = [kind for kind in vars(library).values()
               if isinstance(kind, type) and issubclass(kind, ctypes.Structure) and kind is not ctypes.Structure]
    assert len(structs) == 11
    for kind in structs:
        fields = [(field, ("char", of._length_) if issubclass(of, ctypes.Array) else python_kind(of))
                  for field, of in kind._fields_]
        assert fields == members_of_header(name_in_c(kind)), (kind, fields, members_of_header(name_in_c(kind)))


def functions_are_those_of_the_header():
    declared = dict()
    for result, name, arguments in re.findall(r"RUGO_API\s+([\w\s]+?[\s*]+)(rugo_\w+)\((.*?)\);", HEADER, re.S):
        taken = [] if arguments == "void" else [kind_of(one.strip()) for one in arguments.split(",")]
        result = result.strip()
        returned = result.replace("struct ", "") if result.startswith("struct") else kind_of(result)
        declared[name] = (returned, taken)
    assert len(declared) > 40
    for name, (result, *arguments) in library._FUNCTIONS.items():
        assert (python_kind(result), [python_kind(one) for one in arguments]) == declared[name], (name, declared[name])


def choices_are_those_of_the_lists():
    text = (TREE / "core/rugo_lists.h").read_text(encoding="utf-8")
    lists = {}
    for name, body in re.findall(r"#define RUGO_(\w+)\(ENTRY\)((?:.*\\\n)+.*\n)", text):
        entries = {entry: int(value) for entry, value in re.findall(r'ENTRY\(\w+, "(\w+)", (\d+)\)', body)}
        for other in re.findall(r"RUGO_(\w+)\(ENTRY\)", body):
            entries = {**lists.pop(other.lower()), **entries}
        lists[name.lower()] = entries
    assert sorted(lists) == sorted(library.LISTS)
    for name, entries in lists.items():
        assert len(entries) >= 3 and rugo.choices(name) == entries, (name, rugo.choices(name))
    raises(ValueError, lambda: library.choice("models", "beam"), "halfspace, layered, full")
    raises(ValueError, lambda: rugo.choices("model"), "'model'", "spectra, distributions, summit_rules, trends, models")
    assert set(rugo.client.IN_PACKAGE) | set(rugo.client.__all__) == set(rugo.__all__)
    raises(AttributeError, lambda: rugo.client.press, "no attribute 'press'")


def versions_are_one():
    version = re.search(r'RUGO_VERSION "(.*)"', HEADER).group(1)
    assert rugo.library_version() == version and f"librugo.so.{version}".startswith(library.SONAME + ".")
    printed = subprocess.run([os.environ["RUGO_PROGRAM"], "--version"], stdout=subprocess.PIPE, check=True).stdout.decode()
    assert printed.startswith(f"rugo {version}")


def what_is_absent_is_named():
    code = "import rugo\nfor call in (lambda: rugo.run({}), lambda: rugo.choices('models')):\n" \
           "    try:\n        call()\n    except rugo.RugoError as error:\n        print(error)"
    absent = dict(os.environ, RUGO_PROGRAM="no-such-program", RUGO_LIBRARY="/no/such/librugo.so")
    lines = subprocess.run([sys.executable, "-c", code], env=absent, stdout=subprocess.PIPE, check=True).stdout.decode().splitlines()
    assert len(lines) == 2, lines
    assert lines[0].startswith("the program no-such-program is not installed") and "RUGO_PROGRAM" in lines[0]
    assert lines[1].startswith("librugo is not installed") and "RUGO_LIBRARY" in lines[1]


# --- studies ---


def rows_of(table):
    return table if isinstance(table, list) else table.to_dict("records")


def a_study_is_run():
    result = rugo.run(STUDY)
    curves, scalars, folder = rows_of(result.curves), rows_of(result.scalars), result.folder
    assert [case["case"] for case in result.document["cases"]] == [0, 1] and "first" in result.summary
    assert {row["hurst"] for row in curves} == {0.2, 0.8} and all(row["series"] for row in curves)
    names = next(line for line in (folder / "curves.csv").read_text().splitlines() if not line.startswith("#"))
    assert list(curves[0]) == names.split(",") and len(curves) > 400
    points = [y for case in result.document["cases"] for curve in case["curves"] if "x2" not in curve for y in curve["y"]]
    listed = [row["y"] for row in curves if row["quantity"] != "summit_joint_pdf"]
    same = [a == b or (a is None and b != b) or a is b for a, b in zip(points, listed)]
    assert len(points) == len(listed) and all(same)
    slopes = [row["value"] for row in scalars if row["name"] == "rms_slope"]
    assert len(slopes) == 2 and slopes[0] > slopes[1] > 0
    assert result.picture("psd")._repr_svg_().startswith(("<?xml", "<svg"))
    raises(KeyError, lambda: result.picture("no_such"), "summit_height_pdf")
    del result
    gc.collect()
    assert not folder.exists()


def an_interrupt_ends_the_program_well():
    """It hands back what it leased, and says so; the next run does not wait for it."""
    long = dict(STUDY, name="long", realisations=1000000)
    folder = pathlib.Path(FOLDER, "interrupted")
    signal.signal(signal.SIGINT, signal.default_int_handler)  # jobs in the background of a shell ignore it
    threading.Timer(3, os.kill, (os.getpid(), signal.SIGINT)).start()
    raises(KeyboardInterrupt, lambda: rugo.run(long, folder, workers=1))
    printed = subprocess.run([os.environ["RUGO_PROGRAM"], "status", "long", "--db", str(folder / "rugo.db")], stdout=subprocess.PIPE, check=True).stdout.decode()
    assert "(0 running" in printed, printed


def a_folder_keeps_it():
    path = pathlib.Path(FOLDER, "kept.json")
    path.write_text(json.dumps(STUDY), encoding="utf-8")
    first = rugo.run(path, pathlib.Path(FOLDER, "kept"), changes={"surface/hurst": [0.5]})
    again = rugo.run(json.dumps(dict(STUDY, surface=dict(STUDY["surface"], hurst=[0.5]))), pathlib.Path(FOLDER, "kept"))
    assert rows_of(first.curves)[0]["hurst"] == 0.5 and (again.folder / "rugo.db").exists()
    assert [c["curves"] for c in first.document["cases"]] == [c["curves"] for c in again.document["cases"]]
    fault = raises(rugo.RugoError, lambda: rugo.run(dict(STUDY, surface={"hurst": 1.4})), "/surface/hurst", "1.4 is not in")
    with contextlib.redirect_stderr(io.StringIO()) as passed:
        raises(rugo.RugoError, lambda: rugo.run(dict(STUDY, surface={"hurst": 1.4}), progress=True), "1.4 is not in")
    assert "1.4 is not in" in passed.getvalue()
    assert fault.status is None


def pandas_recipes():
    """The blocks of the page, one after the other, and the cells of the notebook; no pivot is empty."""
    if skipped("the page and the notebook", "pandas") or skipped("the page and the notebook", "numpy"):
        return
    import pandas

    cells = json.loads((TREE / "server/python/study.ipynb").read_text(encoding="utf-8"))["cells"]
    names, sources = {}, ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
    with contextlib.redirect_stdout(io.StringIO()):
        for source in sources:
            exec(source, names)
    assert len(sources) == 5 and names["areas"].shape == (6, 6) and names["fits"].shape == (3, 4)
    assert not names["areas"].isna().any(axis=None) and len(names["pressed"].area) == 2
    if URL is None:
        print("SKIP the page: no service was given")
        return
    page = (TREE / "server/python/README.md").read_text(encoding="utf-8")
    blocks, names = re.findall("```python\n(.*?)```", page, re.S), {}
    assert len(blocks) == 6
    for block in blocks:
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            exec(block.replace("http://127.0.0.1:8080", URL), names)
    for name in ("by_height", "served", "filed"):
        assert names[name].shape[0] > 10 and names[name].shape[1] == 2, (name, names[name].shape)
        assert list(names[name].columns) == [(0.2, "main"), (0.8, "main")]
    pandas.testing.assert_frame_equal(names["by_height"], names["served"])
    pandas.testing.assert_frame_equal(names["by_height"], names["filed"])
    assert names["moments"].shape[1] == 2 and len(names["moments"]) > 5
    counts = len(names["table"]), len(names["largest"][names["study"].id]), len(names["pressed"].p)
    assert counts == (2, 2, 3), counts


# --- maps ---


def arrays_are_not_copied(numpy, maps):
    z = numpy.arange(12.0).reshape(3, 4)
    assert maps._heights(z) is z
    assert maps._heights(z.T) is not z and maps._heights(z.T).flags.c_contiguous
    masked = maps._heights(numpy.ma.masked_less(z, 1))
    assert numpy.isnan(masked[0, 0]) and masked[0, 1] == 1
    out = numpy.empty((64, 64))
    made = rugo.surface((64, 64), dx=1 / 8, wavelength_long=4, wavelength_short=1, out=out)
    assert made is out and abs(out.std() - 1) < 1e-12
    for wrong in (numpy.empty((64, 32)), numpy.empty((64, 64), "float32"), numpy.empty((64, 128))[:, ::2]):
        raises(ValueError, lambda: rugo.surface((64, 64), wavelength_long=8, wavelength_short=2, out=wrong), "C-contiguous")


def surfaces_are_those_of_studies(numpy):
    z = rugo.generate(STUDY, case=1, realisation=3)
    assert z.shape == (128, 128) and z.dtype == numpy.float64
    same = rugo.surface((128, 128), dx=1 / 8, seed=11, realisation=3, hurst=0.8, wavelength_long=4, wavelength_short=1)
    assert numpy.array_equal(z, same)
    other = rugo.generate(STUDY, realisation=3, changes={"surface/hurst": 0.8})
    assert numpy.array_equal(z, other)
    weibull = rugo.surface((128, 128), dx=1 / 8, wavelength_long=4, wavelength_short=1, heights="weibull_max",
                           heights_shape=1.2, rms_slope=0.1)
    found = rugo.characterise(weibull, dx=1 / 8)
    assert found["heights"]["skewness"] < -1 and abs(found["spectral"]["rms_slope"] - 0.1) < 1e-3
    for wrong in ({"seed": 2**64 + 1}, {"seed": -1}, {"realisation": -1}, {"max_iterations": 0}):
        raises(ValueError, lambda: rugo.surface(64, wavelength_long=8, wavelength_short=2, **wrong), "allowed: whole numbers")
    raises(TypeError, lambda: rugo.surface(64, wavelength_long=8, wavelength_short=2, seed=1.5))
    kept = rugo.surface((64, 64), wavelength_long=8, wavelength_short=2, heights="gamma", heights_shape=4, keep_heights=numpy.bool_(True))
    assert abs(kept.std() - 1) < 1e-12
    profile = rugo.surface(512, dx=1 / 8, spectrum="table", table=([0.5, 1, 6], [1, 1, 1]))
    assert profile.shape == (512,) and abs(profile.std() - 1) < 1e-12
    raises(rugo.RugoError, lambda: rugo.generate(STUDY, case=9), "there is no case 9")


def maps_are_characterised_as_by_the_program(numpy):
    z = rugo.generate(STUDY, case=1, realisation=3)
    path = pathlib.Path(FOLDER, "map.npy")
    for heights, boundary in ((z, "periodic"), (z[:90, :100], "open")):
        numpy.save(path, heights)
        line = [os.environ["RUGO_PROGRAM"], "characterise", str(path), "--dx", "0.125", "--detrend", "none",
                "--boundary", boundary, "--format", "json"]
        printed = json.loads(subprocess.run(line, stdout=subprocess.PIPE, check=True).stdout)
        found, compared = rugo.characterise(heights, dx=0.125, boundary=boundary), 0
        assert all(group in printed for group in found)
        for group in found:
            for name, value in printed[group].items():
                if name in found[group] and isinstance(value, (int, float)):
                    # both come from the same sums; the file keeps every digit
                    assert abs(found[group][name] - value) <= 1e-8 * abs(value) + 1e-12, (group, name, value)
                    compared += 1
        assert compared >= 30, compared
    wave_number, density = rugo.psd(z, 1 / 8)
    assert len(wave_number) == len(density) > 30 and (density >= 0).all()
    peaks, length = rugo.summits(z[0], 1 / 8)
    assert length == 16 and (peaks["curvature"] > 0).all() and 4 < len(peaks) < 30
    tilted = z + numpy.arange(128)
    level = rugo.characterise(tilted, 1 / 8, trend="plane", boundary="open")
    assert level["heights"]["rms"] < 2 < tilted.std()
    raises(ValueError, lambda: rugo.characterise(z, rule="six_point"), "nine_point, five_point, refined")
    raises(ValueError, lambda: rugo.characterise(z, boundary="closed"), "closed")
    raises(ValueError, lambda: rugo.characterise(z.reshape(2, 64, 128)), "(ny, nx)")
    raises(ValueError, lambda: rugo.characterise(z, dx=(0.1, 0.2)), "one number each", "dx=(0.1, 0.2)")
    holes = z.copy()
    holes[3, 5] = numpy.nan
    assert raises(rugo.LibraryError, lambda: rugo.characterise(holes), "hole").code == -1
    assert rugo.characterise(holes, 1 / 8, boundary="open")["heights"]["rms"] > 0
    for call in (lambda: rugo.summits(holes, 1 / 8), lambda: rugo.psd(holes, 1 / 8), lambda: rugo.characterise(holes[3], 1 / 8)):
        raises(rugo.LibraryError, call, "1 of ", "all heights are needed here")


def maps_are_pressed_as_by_the_program(numpy):
    z = rugo.generate(STUDY, case=1, realisation=3)
    path, dx = pathlib.Path(FOLDER, "pressed.npy"), 0.125
    numpy.save(path, z)
    line = [os.environ["RUGO_PROGRAM"], "press", str(path), "--dx", str(dx), "--detrend", "none", "--boundary", "periodic",
            "--loads", "0.05,0.2", "--format", "csv"]
    printed = rugo.client.rows_of_csv(subprocess.run(line, stdout=subprocess.PIPE, check=True).stdout.decode())
    slope = rugo.characterise(z, dx)["spectral"]["rms_slope"]
    pressed = rugo.press(z, dx, [0.05 * slope, 0.2 * slope], maps=True)
    areas = [row["y"] for row in printed if (row["quantity"], row["series"]) == ("contact_area", "edges")]
    # one solver, from loads that differ by rounding: within its tolerance of 1e-8
    assert len(areas) == 2 and numpy.allclose(pressed.area, areas, rtol=1e-6), (pressed.area, areas)
    assert pressed.p.shape == (2, 128, 128) and (pressed.p >= 0).all()
    # the solver's tolerance is 1e-8 of the pressure
    assert numpy.allclose(pressed.p.mean(axis=(1, 2)), pressed.pressure, rtol=1e-7)
    assert numpy.array_equal(pressed.area_nodes, (pressed.p > 0).mean(axis=(1, 2)))
    assert 0 < pressed.area[0] < pressed.area[1] < 1 and (pressed.area_lower < pressed.area).all()
    assert pressed.full_pressure > pressed.pressure[1]
    free = rugo.press(z, dx, 0.01, boundary="open")
    assert len(free.area) == 1 and free.p is None and free.approach[0] > 0
    layered = rugo.press(z, dx, [0.05 * slope], model="layered", height=8.0, poisson=0.4)
    assert abs(layered.area[0] - pressed.area[0]) < 0.05 and layered.area[0] != pressed.area[0]
    line = rugo.press(z[0], dx, [0.1 * slope], maps=True)
    assert line.gap.shape == (1, 128)
    assert raises(rugo.LibraryError, lambda: rugo.press(z, dx, [-1]), "must be 0 or more, not -1").code == -1
    raises(ValueError, lambda: rugo.press(z, dx, [0.1], boundary="open", model="layered"), "half-space")


def surface_topography_agrees():
    if skipped("the comparison with SurfaceTopography", "SurfaceTopography"):
        return
    from SurfaceTopography import Topography, UniformLineScan

    z = rugo.surface((96, 128), dx=0.25, dy=0.5, wavelength_long=16, wavelength_short=2, rms_slope=0.2)
    topography = Topography(z.T.copy(), (32, 48), periodic=True)
    found = rugo.characterise(topography.heights().T, dx=topography.pixel_size[0], dy=topography.pixel_size[1])
    line = UniformLineScan(z[0].copy(), 32, periodic=True)
    profile = rugo.characterise(line.heights(), dx=line.pixel_size[0])
    pairs = ((topography.rms_height_from_area(), found["heights"]["rms"]),
             (topography.rms_gradient(), found["finite_difference"]["rms_slope"]),
             (topography.rms_curvature_from_area(), found["finite_difference"]["rms_curvature"]),
             (line.rms_height_from_profile(), profile["heights"]["rms"]),
             (line.rms_slope_from_profile(), profile["finite_difference"]["rms_slope"]),
             (line.rms_curvature_from_profile(), profile["finite_difference"]["rms_curvature"]))
    for theirs, ours in pairs:
        # the same differences, summed in another order
        assert abs(theirs - ours) <= 1e-11 * abs(theirs), pairs


os.chdir(FOLDER)
structs_are_those_of_the_header()
functions_are_those_of_the_header()
choices_are_those_of_the_lists()
versions_are_one()
what_is_absent_is_named()
a_study_is_run()
an_interrupt_ends_the_program_well()
a_folder_keeps_it()
if not skipped("maps as arrays", "numpy"):
    import numpy as arrays
    from rugo import maps as arrays_of_rugo

    arrays_are_not_copied(arrays, arrays_of_rugo)
    surfaces_are_those_of_studies(arrays)
    maps_are_characterised_as_by_the_program(arrays)
    maps_are_pressed_as_by_the_program(arrays)
    surface_topography_agrees()
pandas_recipes()
print("package: all as it should be")
