#!/usr/bin/env python3
"""The same work in vectorised NumPy, one core, as a peer for `make bench`: CPU time, medians.

peer_numpy.py gaussian N REPEATS      a Gaussian surface with its nine-point summits, and with the
                                      statistics of a study
peer_numpy.py weibull N ITERATIONS    plain alternation, C = 1 maximum (Perez-Rafols & Almqvist 2019)
peer_numpy.py contact N LOAD...       half-space contact by the textbook solver (Polonsky & Keer 1999)

Each prints `peer NAME N ms FIGURES...`, one line a variant: plain (as one writes it first) and tuned.
"""
import sys
import time

import numpy as np
from scipy import fft

POINTS, CELLS, HURST = 8, 8, 0.8  # points a shortest wave, L/lambda_l, Hurst exponent


def spectrum(n):
    """Half-plane amplitudes of the self-affine band, rows my (fft order), columns mx >= 0; m0 = 1."""
    my = np.fft.fftfreq(n, 1 / n)[:, None]
    mx = np.arange(n // 2 + 1)[None, :]
    m = np.hypot(mx, my)
    inside = (m >= CELLS) & (m <= n // POINTS)
    power = np.where(inside, np.where(inside, m, 1.0) ** (-2 * (HURST + 1)), 0.0)
    weight = np.where(mx == 0, 1, 2)
    return np.sqrt(power / (power * weight).sum())


def mirror(half):
    """Makes the column mx = 0 conjugate-symmetric."""
    column = half[:, 0]
    column[-1:len(column) // 2:-1] = np.conj(column[1:(len(column) + 1) // 2])
    return half


def gaussian(amplitude, rng, band_only):
    n = amplitude.shape[0]
    if not band_only:
        half = amplitude * np.exp(2j * np.pi * rng.random(amplitude.shape))
        return fft.irfft2(mirror(half), s=(n, n), norm="forward")
    reach = n // POINTS
    columns = np.zeros((n, reach + 1), complex)
    rows = np.r_[0:reach + 1, n - reach:n]
    phase = 2 * np.pi * rng.random((len(rows), reach + 1))
    columns[rows] = amplitude[rows, :reach + 1] * (np.cos(phase) + 1j * np.sin(phase))
    columns = fft.ifft(mirror(columns), axis=0, norm="forward", overwrite_x=True)
    return fft.irfft(columns, n, axis=1, norm="forward")


def summits(z):
    top = np.ones(z.shape, bool)
    for dy in (-1, 0, 1):
        for dx in (-1, 0, 1):
            if dx or dy:
                top &= z > np.roll(z, (dy, dx), (0, 1))
    curvature = -(np.roll(z, 1, 0) + np.roll(z, -1, 0) + np.roll(z, 1, 1) + np.roll(z, -1, 1) - 4 * z) / 2
    return z[top], curvature[top]


def statistics(z):
    """What a study counts of a surface: heights, their powers, summits and pits by height, curvature and both."""
    shape = [(z**power).mean() for power in (2, 3, 4)]
    heights = np.histogram(z, 240, (-4, 8))[0]
    sides = []
    for side in (z, -z):
        height, curvature = summits(side)
        sides.append((len(height), height.mean(), height.var(), curvature.mean(),
                      np.histogram2d(height, curvature, (240, 160), ((-4, 8), (0, 16)))[0]))
    return shape, heights, sides


def timed(function, repeats):
    times = []
    for _ in range(repeats):
        start = time.process_time()
        result = function()
        times.append(1e3 * (time.process_time() - start))
    return np.median(times), min(times), max(times), result


def run_gaussian(n, repeats):
    amplitude, rng = spectrum(n), np.random.default_rng(1)
    for name, band_only in (("plain", False), ("tuned", True)):
        middle, low, high, found = timed(lambda: summits(gaussian(amplitude, rng, band_only)), repeats)
        print(f"peer gaussian-{name} {n} {middle:.1f} {low:.1f} {high:.1f} summits {len(found[0])}")
        middle, low, high, found = timed(lambda: statistics(gaussian(amplitude, rng, band_only)), repeats)
        print(f"peer gaussian-{name}-statistics {n} {middle:.1f} {low:.1f} {high:.1f} summits {found[2][0][0]}")


def alternate(amplitude, rng, iterations, tuned):
    """Iterations of: exact spectrum, then exact heights by rank. Returns the surface of exact spectrum."""
    n = amplitude.shape[0]
    reach = n // POINTS
    target = np.sort(-rng.weibull(1, n * n))
    target = (target - target.mean()) / target.std()
    z = gaussian(amplitude, rng, True)
    order = None
    for _ in range(iterations):
        if tuned:
            half = fft.fft(fft.rfft(z, axis=1)[:, :reach + 1], axis=0, overwrite_x=True)
            size = np.abs(half)
            half *= amplitude[:, :reach + 1] / np.where(size > 0, size, 1)
            spectral = fft.irfft(fft.ifft(half, axis=0, norm="forward"), n, axis=1, norm="forward").ravel()
            # Nearly sorted already in the order of the last iteration: timsort is quick on that.
            again = np.argsort(spectral if order is None else spectral[order], kind="stable")
            order = again if order is None else order[again]
        else:
            half = fft.rfft2(z)
            spectral = fft.irfft2(amplitude * np.exp(1j * np.angle(half)), s=(n, n), norm="forward").ravel()
            order = np.argsort(spectral)
        z = np.empty(n * n)
        z[order] = target
        z = z.reshape(n, n)
    return spectral.reshape(n, n)


def run_weibull(n, iterations):
    amplitude = spectrum(n)
    for name, tuned in (("plain", False), ("tuned", True)):
        middle, _, _, z = timed(lambda: alternate(amplitude, np.random.default_rng(1), iterations, tuned), 1)
        measured, _, _, _ = timed(lambda: statistics(z), 3)
        skewness = (z**3).mean() / (z**2).mean() ** 1.5
        print(f"peer weibull-{name} {n} {middle / iterations:.1f} ms an iteration, {middle / 1e3:.2f} s for "
              f"{iterations}, statistics {measured:.0f} ms, summits {len(summits(z)[0])}, skewness {skewness:.4f}")


def press(z, load, p, tolerance):
    """Polonsky & Keer (1999) with transforms: mean pressure load (E* = 1), cell of unit length, starting from p."""
    n = z.shape[0]
    k = 2 * np.pi * np.hypot(np.fft.fftfreq(n, 1 / n)[:, None], np.arange(n // 2 + 1)[None, :])
    soft = np.where(k > 0, 2 / np.where(k > 0, k, 1), 0)
    displace = lambda x: fft.irfft2(soft * fft.rfft2(x), s=z.shape)
    p, t, old, keep = p * load / p.mean(), np.zeros_like(z), 1.0, 0.0
    for iteration in range(5000):
        gap = displace(p) - z
        inside = p > 0
        gap -= gap[inside].mean()
        displaced = np.abs(gap + z).max()
        if max(np.abs(gap[inside]).max(), -gap.min()) <= tolerance * displaced:
            break
        size = (gap[inside] ** 2).sum()
        t = np.where(inside, gap + keep * size / old * t, 0)
        old = size
        r = displace(t)
        r -= r[inside].mean()
        step = (gap[inside] * t[inside]).sum() / (r[inside] * t[inside]).sum()
        p = np.maximum(0, np.where(inside, p - step * t, p))
        outside = (p == 0) & (gap < 0)
        p[outside] -= step * gap[outside]
        keep = 0.0 if outside.any() else 1.0
        p *= load / p.mean()
    return p, iteration


def run_contact(n, *loads):
    amplitude = spectrum(n)
    z = gaussian(amplitude, np.random.default_rng(1), True)
    k = 2 * np.pi * np.hypot(np.fft.fftfreq(n, 1 / n)[:, None], np.arange(n // 2 + 1)[None, :])
    half = np.abs(fft.rfft2(z, norm="forward")) ** 2
    slope = np.sqrt((k**2 * half * np.where(np.arange(n // 2 + 1) == 0, 1, 2)).sum())
    p = np.ones_like(z)
    for load in loads:
        middle, _, _, (p, iterations) = timed(lambda: press(z, load * slope, p, 1e-8), 1)
        print(f"peer contact {n} load {load}: {middle:.0f} ms, {iterations} iterations, nodes {(p > 0).mean():.4f}")


if __name__ == "__main__":
    if sys.argv[1] == "contact":
        sys.exit(run_contact(int(sys.argv[2]), *map(float, sys.argv[3:])))
    {"gaussian": run_gaussian, "weibull": run_weibull}[sys.argv[1]](int(sys.argv[2]), int(sys.argv[3]))
