#!/usr/bin/env python3
"""Expected nine-point summit density of a Gaussian grid over Nayak's, without simulating surfaces.

A grid point is a summit when all eight differences to its neighbours are positive: an orthant probability of a
normal vector whose covariance is the autocorrelation of the discrete spectrum. Sequential conditioning (Genz 1992)
with Sobol points. The oracle behind test_summit_statistics.c; about half a minute, needs NumPy and SciPy.
"""
import numpy as np
from scipy.stats import norm, qmc

HURST, CELLS = 0.8, 8  # Hurst exponent, L/lambda_l
NEIGHBOURS = [(1, 0), (0, 1), (-1, 0), (0, -1), (1, 1), (-1, -1), (1, -1), (-1, 1)]


def autocorrelation(ratio, points):
    """R at lags 0..2 grid steps in x and y, and Nayak's density times the point area."""
    reach = int(CELLS * ratio)
    mx, my = np.arange(reach + 1), np.arange(-reach, reach + 1)
    square = my[:, None] ** 2 + mx[None, :] ** 2
    inside = (square >= CELLS**2) & (square <= reach**2)
    power = np.where(inside, np.where(inside, square, 1) ** -(HURST + 1.0), 0)
    power[:, 1:] *= 2
    power /= power.sum()
    step = 2 * np.pi / (CELLS * ratio)  # lambda_s = 1
    m2 = (power * square).sum() / 2 * step**2
    m4 = (power * (mx[None, :] ** 4 + my[:, None] ** 4)).sum() / 2 * step**4
    lag = lambda m, n: np.cos(step * m * n / points)
    table = np.array([[lag(my, j) @ power @ lag(mx, i) for j in range(3)] for i in range(3)])
    return table, m4 / (6 * np.pi * np.sqrt(3) * m2) / points**2


def density(ratio, points, samples=2**20, repeats=8):
    table, nayak = autocorrelation(ratio, points)
    corr = lambda a, b: table[abs(a[0] - b[0]), abs(a[1] - b[1])]
    zero = (0, 0)
    covariance = np.array([[corr(zero, zero) - corr(zero, a) - corr(zero, b) + corr(a, b) for b in NEIGHBOURS]
                           for a in NEIGHBOURS])
    root = np.linalg.cholesky(covariance)
    estimates = []
    for seed in range(repeats):
        uniform = qmc.Sobol(7, seed=seed).random(samples)
        draws, product = np.zeros((samples, 8)), np.ones(samples)
        for k in range(8):
            tail = norm.sf(-(draws[:, :k] @ root[k, :k]) / root[k, k])
            product *= tail
            if k < 7:
                draws[:, k] = norm.isf(np.clip(uniform[:, k] * tail, 1e-300, 1))
        estimates.append(product.mean() / nayak)
    return np.mean(estimates), np.std(estimates, ddof=1) / np.sqrt(repeats)


if __name__ == "__main__":
    for ratio, points in [(8, 4), (8, 8), (8, 16), (16, 8), (32, 8), (64, 8), (128, 8)]:
        print(f"ratio {ratio:3d}, {points:2d} points a wave: %.5f +- %.5f" % density(ratio, points))
