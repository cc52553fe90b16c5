#!/usr/bin/env python3
"""Rugo beside the codes that people in the field use, on the same maps and loads, one thread each: `make bench-peers`.

peers.py RUGO FOLDER SIDE...          prints three tables; maps are left in FOLDER

1. Half-space contact of a periodic Gaussian map, eight loads, for each SIDE: Rugo, Tamaas, ContactMechanics.
2. Statistics of a map of 1024 x 1024: Rugo, SurfaceTopography, surfalize. They do not compute the same quantities.
3. Contact at equal error: one continuous surface on finer and finer grids, and how far areas are from their limit.

Each code runs in a process of its own. CPU time is user and system time of that process (wait4), without what a Python
program takes to import its modules and to read the map; Rugo's is all that it took. Memory is the largest resident set,
modules included. A run below 5 s is repeated: medians of three. A code that is not installed is named, and left out.
"""
import json
import os
import platform
import statistics
import subprocess
import sys
import time
from importlib import metadata

HURST, CELLS, POINTS, SLOPE = 0.8, 8, 8, 0.1  # of the maps of parts 1 and 2, heights in distances of points
LOADS = (0.005, 0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3)  # p/(E* h')
FEW_LOADS = (0.05, 0.1, 0.2)
STATISTICS_SIDE = 1024
COARSEST, FACTORS, LIMIT = 4, (1, 2, 4, 8), 16  # of part 3: points a shortest wave, and times as many
PACKAGES = ("tamaas", "contactmechanics", "surfacetopography", "surfalize", "numpy", "scipy")


# What the processes of other codes do: each function is given a map and texts, and returns what it found. Modules are
# imported first; ready() is called before the work begins.

def press_tamaas(path, ready, tolerance, *pressures):
    """Shares of nodes in contact; E* = 1. A solver goes on from its last pressures."""
    import numpy as np
    import tamaas

    tamaas.set_log_level(tamaas.LogLevel.error)
    z = np.load(path)
    n = len(z)
    ready()
    model = tamaas.ModelFactory.createModel(tamaas.model_type.basic_2d, [float(n)] * 2, [n, n])
    model.E, model.nu = 1, 0
    solver = tamaas.PolonskyKeerRey(model, z, float(tolerance))
    solver.max_iter = 100000
    shares = []
    for pressure in map(float, pressures):
        if not solver.solve(pressure) <= float(tolerance):
            sys.exit(f"no solution at a pressure of {pressure}")
        shares.append(float((model.traction > 0).mean()))
    return shares


def press_contactmechanics(path, ready, _, *pressures):
    """Likewise; each load starts from the displacements of the last one, and tolerances are the package's."""
    import numpy as np
    from ContactMechanics import PeriodicFFTElasticHalfSpace, make_system
    from SurfaceTopography import Topography

    z = np.load(path)
    n, sides = len(z), (float(len(z)),) * 2
    ready()
    system = make_system(substrate=PeriodicFFTElasticHalfSpace((n, n), 1.0, sides),
                         surface=Topography(z, sides, periodic=True))
    shares, last = [], {}
    for pressure in map(float, pressures):
        if not system.minimize_proxy(external_force=pressure * n * n, **last).success:
            sys.exit(f"no solution at a pressure of {pressure}")
        last = {"initial_displacements": system.disp}
        shares.append(float((system.force > 0).mean()))
    return shares


def characterise_surfacetopography(path, ready):
    """RMS height and slope; curvature, power spectrum and autocorrelation are computed, too."""
    import numpy as np
    from SurfaceTopography import Topography

    z = np.load(path)
    ready()
    topography = Topography(z, tuple(map(float, z.shape)), periodic=True)
    topography.rms_curvature_from_area()
    topography.power_spectrum_from_area()
    topography.autocorrelation_from_area()
    return [float(topography.rms_height_from_area()), float(topography.rms_gradient())]


def characterise_surfalize(path, ready):
    """RMS height and slope, of all areal parameters."""
    import numpy as np
    from surfalize import Surface

    z = np.load(path)
    ready()
    found = Surface(z, 1.0, 1.0).roughness_parameters(Surface.ISO_PARAMETERS)
    return [float(found["Sq"]), float(found["Sdq"])]


def refine(path, ready, factor, output):
    """Writes the same periodic surface with factor times as many points a side: its spectrum is padded by zeros."""
    import numpy as np

    z, factor = np.load(path), int(factor)
    ready()
    n = len(z)
    half = np.fft.rfft2(z, norm="forward")
    padded = np.zeros((factor * n, factor * n // 2 + 1), complex)
    padded[:n // 2, :n // 2] = half[:n // 2, :n // 2]
    padded[-(n // 2 - 1):, :n // 2] = half[n // 2 + 1:, :n // 2]
    np.save(output, factor * np.fft.irfft2(padded, s=(factor * n, factor * n), norm="forward"))
    return []


CHILDREN = {function.__name__: function for function in (press_tamaas, press_contactmechanics, refine,
                                                         characterise_surfacetopography, characterise_surfalize)}


def child(name, path, *words):
    before = []
    found = CHILDREN[name](path, lambda: before.append(time.process_time()), *words)
    print(json.dumps({"before": before[0], "found": found}))


# This process itself imports nothing large: on Linux the largest resident set of a child begins with its parent's.

def run_once(command):
    """CPU seconds, MB at most and standard output of a command; a word on what failed in place of all."""
    one_thread = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")}
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                               env=os.environ | one_thread)
    with process.stdout, process.stderr:
        output, errors = process.stdout.read(), process.stderr.read()
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        return (errors.strip() or f"exit status {process.returncode}").splitlines()[-1]
    return used.ru_utime + used.ru_stime, used.ru_maxrss / 1024, output


def run(command):
    first = run_once(command)
    if isinstance(first, str) or first[0] >= 5:
        return first
    runs = [first, run_once(command), run_once(command)]
    failed = [result for result in runs if isinstance(result, str)]
    return failed[0] if failed else (*(statistics.median(result[k] for result in runs) for k in (0, 1)), first[2])


def run_child(name, path, *words):
    """Seconds without imports, MB and what the function found, or a word on what failed."""
    result = run([sys.executable, os.path.abspath(__file__), "--child", name, path, *map(str, words)])
    if isinstance(result, str):
        return result
    seconds, peak, output = result
    report = json.loads(output.splitlines()[-1])
    return seconds - report["before"], peak, report["found"]


def run_rugo(program, *words):
    result = run([program, *map(str, words), "--format", "json"])
    if isinstance(result, str):
        sys.exit(f"{program} {words[0]}: {result}")
    return *result[:2], json.loads(result[2])


def press_rugo(program, path, loads, *words):
    return run_rugo(program, "press", path, "--boundary", "periodic", "--error", "none", "--loads",
                    ",".join(map(str, loads)), *words)


def generate(program, folder, side, ratio, cells, points):
    """A map of side points; heights in distances of points, so that its slope is SLOPE in a file without distances."""
    path = f"{folder}/map-{side}-{points}.npy"
    study = {"name": "peers", "kind": "statistics", "seed": 1,
             "surface": {"dimension": 2, "hurst": HURST, "wavelength_ratio": ratio, "length_ratio": cells,
                         "points_per_wavelength": points, "rms_slope": SLOPE * points}}
    with open(path + ".json", "w", encoding="ascii") as file:
        json.dump(study, file)
    subprocess.run([program, "generate", path + ".json", "-o", path], check=True, stdout=subprocess.DEVNULL)
    return path


def furthest(found, reference):
    return max(abs(a / b - 1) for a, b in zip(found, reference, strict=True))


def table(title, *columns):
    print(f"\n{title}\n\n| {' | '.join(columns)} |\n|{' --- |' * len(columns)}", flush=True)


def row(*cells):
    print(f"| {' | '.join(map(str, cells))} |", flush=True)


def compared(name, tolerance, result, reference):
    """A row: a result (seconds, MB, figures) beside Rugo's."""
    if isinstance(result, str):
        return row(name, tolerance, f"not available: {result}", "", "", "")
    seconds, peak, found = result
    row(name, tolerance, f"{seconds:.2f}", f"{seconds / reference[0]:.1f}", f"{peak:.0f}",
        f"{furthest(found, reference[2]):.2g}")


COLUMNS = ("code", "tolerance", "CPU s", "times Rugo's", "peak MB")


def contact(program, folder, side):
    path = generate(program, folder, side, side / (CELLS * POINTS), CELLS, POINTS)
    seconds, peak, found = press_rugo(program, path, LOADS)
    reference = seconds, peak, found["nodes"]
    table(f"Half-space contact, {side} x {side}, {len(LOADS)} loads {LOADS[0]} to {LOADS[-1]}", *COLUMNS,
          "largest difference of nodes in contact")
    compared("Rugo", "1e-8", reference, reference)
    seconds, peak, found = press_rugo(program, path, LOADS, "--tolerance", "1e-4")
    compared("Rugo", "1e-4", (seconds, peak, found["nodes"]), reference)
    pressures = [load * found["rms_slope"] for load in LOADS]
    for tolerance in ("1e-4", "1e-6"):
        compared("Tamaas", tolerance, run_child("press_tamaas", path, tolerance, *pressures), reference)
    compared("ContactMechanics", "default", run_child("press_contactmechanics", path, "", *pressures), reference)


def characterise(program, folder):
    side = STATISTICS_SIDE
    path = generate(program, folder, side, side / (CELLS * POINTS), CELLS, POINTS)
    seconds, peak, found = run_rugo(program, "characterise", path, "--boundary", "periodic")
    reference = seconds, peak, [found["areal"]["Sq"], found["areal"]["Sdq"]]
    table(f"Statistics, {side} x {side}", *COLUMNS, "largest difference of RMS height and slope")
    compared("Rugo, errors included", "", reference, reference)
    for name in ("SurfaceTopography", "surfalize"):
        compared(name, "", run_child(f"characterise_{name.lower()}", path), reference)


def equal_error(program, folder, ratio=8, cells=4):
    side = ratio * cells * COARSEST
    coarsest = generate(program, folder, side, ratio, cells, COARSEST)
    results = {}
    for factor in (*FACTORS, LIMIT):
        path = f"{folder}/refined-{factor}.npy"
        failed = run_child("refine", coarsest, factor, path)
        if isinstance(failed, str):
            sys.exit(f"peers.py: refine: {failed}")
        results[factor] = path, *press_rugo(program, path, FEW_LOADS)
    limit = results[LIMIT][3]["edges"]
    table(f"Areas at {len(FEW_LOADS)} loads {FEW_LOADS[0]} to {FEW_LOADS[-1]}: largest difference from the limit, "
          f"Rugo's edges at {LIMIT * COARSEST} points a shortest wave", "points", "side", "Rugo, edges", "Rugo, nodes",
          "CPU s", "Tamaas 1e-4, nodes", "CPU s", "ContactMechanics, nodes", "CPU s")
    for factor in FACTORS:
        path, seconds, _, found = results[factor]
        pressures = [load * found["rms_slope"] for load in FEW_LOADS]
        peers = []
        for result in (run_child("press_tamaas", path, "1e-4", *pressures),
                       run_child("press_contactmechanics", path, "", *pressures)):
            peers += ["not available", ""] if isinstance(result, str) else [f"{furthest(result[2], limit):.2%}",
                                                                            f"{result[0]:.2f}"]
        row(factor * COARSEST, factor * side, f"{furthest(found['edges'], limit):.3%}",
            f"{furthest(found['nodes'], limit):.2%}", f"{seconds:.2f}", *peers)


def main(program, folder, *sides):
    os.makedirs(folder, exist_ok=True)
    version = subprocess.run([program, "--version"], check=True, capture_output=True, text=True).stdout.split("\n")[0]
    print(f"{version}; Python {platform.python_version()}; {os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}")
    for package in PACKAGES:
        try:
            print(package, metadata.version(package))
        except metadata.PackageNotFoundError:
            print(package, "not available")
    for side in map(int, sides):
        contact(program, folder, side)
    characterise(program, folder)
    equal_error(program, folder)


if __name__ == "__main__":
    sys.exit(child(*sys.argv[2:]) if sys.argv[1] == "--child" else main(*sys.argv[1:]))
