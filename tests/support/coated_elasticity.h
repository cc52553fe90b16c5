/* The compliance of a coated block from the equations of elasticity of both layers, solved
 * directly: independent of core/contact/coating.c, and slow. */
#ifndef RUGO_TESTS_SUPPORT_COATED_ELASTICITY_H
#define RUGO_TESTS_SUPPORT_COATED_ELASTICITY_H

#include "core/contact/block.h"
#include <math.h>
#include <stdbool.h>
#include <stddef.h>

enum { ELASTICITY_UNKNOWNS = 8 };

/* Displacements X sin(x) and Z cos(x) of k = 1, and the stresses that act on a plane of depth. */
struct elasticity_field {
    long double x, z, shear, normal;
};

/* The solutions of Navier's equations are (A + B s) exp(sign s) and, as the equations require,
 * (-sign A + (3 - 4 nu - sign s) B) exp(sign s), here for the A or the B of 1. s: depth from where
 * the exponential is 1, mu: shear modulus. */
static inline struct elasticity_field elasticity_at(int sign, bool second, long double s,
                                                    long double mu, long double nu) {
    long double e = expl(sign * s), lambda = 2 * mu * nu / (1 - 2 * nu), x, dx, z, dz;
    x = second ? s * e : e;
    dx = second ? e + sign * s * e : sign * e;
    z = second ? (3 - 4 * nu - sign * s) * e : -sign * e;
    dz = second ? sign * z - sign * e : sign * z;
    return (struct elasticity_field){x, z, mu * (dx - z), lambda * (x + dz) + 2 * mu * dz};
}

static inline void elasticity_solve(size_t n,
                                    long double a[ELASTICITY_UNKNOWNS][ELASTICITY_UNKNOWNS + 1]) {
    for (size_t c = 0; c < n; c++) {
        size_t pivot = c;
        for (size_t r = c + 1; r < n; r++)
            pivot = fabsl(a[r][c]) > fabsl(a[pivot][c]) ? r : pivot;
        for (size_t j = 0; j <= ELASTICITY_UNKNOWNS; j++) {
            long double t = a[c][j];
            a[c][j] = a[pivot][j];
            a[pivot][j] = t;
        }
        for (size_t r = 0; r < n; r++) {
            long double by = r == c ? 0 : a[r][c] / a[c][c];
            for (size_t j = c; j <= ELASTICITY_UNKNOWNS; j++)
                a[r][j] -= by * a[c][j];
        }
    }
}

/* S E* under k = 1: pressure 1 and no shear at the face, all four continuous at the interface, and
 * nothing far below, or neither Z nor shear at the far side. */
static inline double coated_elasticity(const struct block *block) {
    long double t = block->coating.thickness, nu[2] = {block->coating.poisson, block->poisson};
    long double mu[2], far = block->height, a[ELASTICITY_UNKNOWNS][ELASTICITY_UNKNOWNS + 1] = {{0}};
    bool infinite = isinf(block->height);
    size_t n = infinite ? 6 : 8;
    mu[1] = (1 - nu[1]) / 2;
    mu[0] = block->coating.modulus * mu[1] * (1 + nu[1]) / (1 + nu[0]);
    for (size_t c = 0; c < n; c++) {
        size_t layer = c / 4;
        int sign = c % 4 < 2 ? -1 : 1;
        long double top = layer == 0 ? 0 : t, bottom = layer == 0 || infinite ? t : far;
        long double from = sign < 0 ? top : bottom;
        if (layer == 0) {
            struct elasticity_field face = elasticity_at(sign, c % 2, -from, mu[0], nu[0]);
            a[0][c] = face.normal;
            a[1][c] = face.shear;
        }
        struct elasticity_field at = elasticity_at(sign, c % 2, t - from, mu[layer], nu[layer]);
        long double side = layer == 0 ? 1 : -1;
        a[2][c] = side * at.x;
        a[3][c] = side * at.z;
        a[4][c] = side * at.shear;
        a[5][c] = side * at.normal;
        if (layer == 1 && !infinite) {
            struct elasticity_field low = elasticity_at(sign, c % 2, far - from, mu[1], nu[1]);
            a[6][c] = low.z;
            a[7][c] = low.shear;
        }
    }
    a[0][ELASTICITY_UNKNOWNS] = -1;
    elasticity_solve(n, a);
    long double z = 0;
    for (size_t c = 0; c < 4; c++) {
        int sign = c < 2 ? -1 : 1;
        z += a[c][ELASTICITY_UNKNOWNS] / a[c][c] *
             elasticity_at(sign, c % 2, sign < 0 ? 0 : -t, mu[0], nu[0]).z;
    }
    return (double)z;
}

#endif
