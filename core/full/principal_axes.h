/* Common parts of the material laws of finite strain: deformation, principal axes, and rotation of
 * moduli from the principal axes to those of space. Inlined into each law, for d = 2 and d = 3.
 * Private to core/full/material_*.c.
 *
 * p and r are principal axes, q is a Gauss point. */
#ifndef RUGO_CORE_FULL_PRINCIPAL_AXES_H
#define RUGO_CORE_FULL_PRINCIPAL_AXES_H

#include "core/full/material.h"
#include "core/vectors.h"
#include <math.h>
#include <string.h>

/* --- principal values of a symmetric matrix --- */

/* A strain below this is taken to be 0: its square underflows. */
static const double STRAIN_LEAST = 1e-150;

INLINE void principal_two(pointwise c[3][3], pointwise value[3], pointwise axis[3][3]) {
    for (int q = 0; q < 4; q++) {
        double mean = (c[0][0][q] + c[1][1][q]) / 2, half = (c[0][0][q] - c[1][1][q]) / 2;
        double off = c[0][1][q], radius = sqrt(half * half + off * off);
        bool round = !(radius > STRAIN_LEAST); /* a multiple of 1: all axes are principal */
        double over = 1 / (round ? 1 : radius);
        double double_cosine = round ? 1 : half * over, double_sine = off * over;
        double large = sqrt((1 + fabs(double_cosine)) / 2), rest = double_sine / (2 * large);
        double cosine = double_cosine >= 0 ? large : rest;
        double sine = double_cosine >= 0 ? rest : large;
        value[0][q] = mean + radius;
        value[1][q] = mean - radius;
        axis[0][0][q] = axis[1][1][q] = cosine;
        axis[0][1][q] = sine;
        axis[1][0][q] = -sine;
    }
}

/* One of Jacobi's rotations (Golub & Van Loan 2013, section 8.5) in the plane of p and r; s is the
 * third axis. Its tangent is off/(half + hypot(half, off)), which needs no branch. */
INLINE void jacobi_rotate(pointwise a[3][3], pointwise axis[3][3], int p, int r, int s) {
    for (int q = 0; q < POINTS_MOST; q++) {
        double off = a[p][r][q], half = (a[r][r][q] - a[p][p][q]) / 2;
        double tangent = off / (fabs(half) + sqrt(half * half + off * off) + STRAIN_LEAST);
        tangent = copysign(1, half) * tangent;
        double cosine = 1 / sqrt(1 + tangent * tangent), sine = tangent * cosine;
        double sp = a[s][p][q], sr = a[s][r][q];
        a[p][p][q] -= tangent * off;
        a[r][r][q] += tangent * off;
        a[p][r][q] = a[r][p][q] = 0;
        a[s][p][q] = a[p][s][q] = cosine * sp - sine * sr;
        a[s][r][q] = a[r][s][q] = sine * sp + cosine * sr;
        for (int i = 0; i < 3; i++) {
            double vp = axis[p][i][q], vr = axis[r][i][q];
            axis[p][i][q] = cosine * vp - sine * vr;
            axis[r][i][q] = sine * vp + cosine * vr;
        }
    }
}

/* Returns whether the matrix of any point has off-diagonal entries larger than rounding. */
INLINE bool off_diagonal(pointwise a[3][3]) {
    int any = 0;
    for (int q = 0; q < POINTS_MOST; q++) {
        double off = a[0][1][q] * a[0][1][q] + a[0][2][q] * a[0][2][q] + a[1][2][q] * a[1][2][q];
        double all = a[0][0][q] * a[0][0][q] + a[1][1][q] * a[1][1][q] + a[2][2][q] * a[2][2][q];
        any |= off > 1e-31 * all;
    }
    return any;
}

/* Finds the principal values and axes of a, which is overwritten. */
INLINE void principal_three(pointwise a[3][3], pointwise value[3], pointwise axis[3][3]) {
    enum { SWEEPS_MOST = 12 };
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int q = 0; q < POINTS_MOST; q++)
                axis[i][j][q] = i == j;
    for (int sweep = 0; sweep < SWEEPS_MOST && off_diagonal(a); sweep++) {
        jacobi_rotate(a, axis, 0, 1, 2);
        jacobi_rotate(a, axis, 0, 2, 1);
        jacobi_rotate(a, axis, 1, 2, 0);
    }
    for (int p = 0; p < 3; p++)
        for (int q = 0; q < POINTS_MOST; q++)
            value[p][q] = a[p][p][q];
}

/* --- deformation --- */

/* With F = 1 + h: out->dilatation = J - 1 without a difference of numbers near 1, out->inverse =
 * F^-1 and c = F F^T - 1, which keeps the digits of small strains. Returns false where a point is
 * inverted. */
INLINE bool deform(int d, pointwise h[3][3], pointwise c[3][3], struct strained *out) {
    int folded = 0;
    for (int q = 0; q < 1 << d; q++) {
        double m[3][3] = {{0}}, f[3][3], inverse[3][3];
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++) {
                m[i][k] = i < d && k < d ? h[i][k][q] : 0;
                f[i][k] = m[i][k] + (i == k);
            }
        double dilatation =
            m[0][0] + m[1][1] + m[2][2] + (m[0][0] * m[1][1] - m[0][1] * m[1][0]) +
            (m[0][0] * m[2][2] - m[0][2] * m[2][0] + m[1][1] * m[2][2] - m[1][2] * m[2][1]) +
            (m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
             m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
             m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]));
        double over = 1 / (1 + dilatation);
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++) {
                int i1 = (i + 1) % 3, i2 = (i + 2) % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
                inverse[k][i] = (f[i1][k1] * f[i2][k2] - f[i1][k2] * f[i2][k1]) * over;
            }
        for (int i = 0; i < d; i++)
            for (int k = 0; k < d; k++) {
                out->inverse[i][k][q] = inverse[i][k];
                c[i][k][q] =
                    m[i][k] + m[k][i] + m[i][0] * m[k][0] + m[i][1] * m[k][1] + m[i][2] * m[k][2];
            }
        out->dilatation[q] = dilatation;
        folded |= !(dilatation > -1);
    }
    return folded == 0;
}

/* Computes out->inverse, out->dilatation = J - 1, out->square and out->axis of a deformation h, and
 * c = F F^T - 1, whose principal values go to value[p]. Returns false where a point is inverted. */
INLINE bool deform_principal(int d, pointwise h[3][3], pointwise c[3][3], pointwise value[3],
                             struct strained *out) {
    pointwise turned[3][3];
    if (!deform(d, h, c, out))
        return false;
    memcpy(turned, c, sizeof turned);
    if (d == 2)
        principal_two(turned, value, out->axis);
    else
        principal_three(turned, value, out->axis);
    for (int p = 0; p < d; p++)
        for (int q = 0; q < 1 << d; q++) {
            if (!(value[p][q] > -1))
                return false;
            out->square[p][q] = 1 + value[p][q];
        }
    return true;
}

/* Turns Kirchhoff's stress from its principal axes into space. */
INLINE void turn_stress(int d, struct strained *out) {
    for (int i = 0; i < d; i++)
        for (int k = 0; k < d; k++)
            for (int q = 0; q < 1 << d; q++) {
                double sum = 0;
                for (int p = 0; p < d; p++)
                    sum += out->principal[p][q] * out->axis[p][i][q] * out->axis[p][k][q];
                out->stress[i][k][q] = sum;
            }
}

/* --- moduli --- */

/* Moduli of a law along principal axes p, r (Ogden 1984, section 6.1; here with gradients in
 * space): normal[p][r] multiplies G_pp G_rr, and for p > r shear[p][r] multiplies (G_pr + G_rp)^2.
 */
struct principal_moduli {
    pointwise normal[3][3], shear[3][3];
};

/* Values stand by symmetric_index(p, r) of two principal axes and symmetric_index(i, k) in space.
 */
typedef pointwise by_pairs[SYMMETRIC_MOST][SYMMETRIC_MOST];

/* Computes the symmetric dyads of axes p and r. */
INLINE void turn_dyads(int d, const struct strained *point, by_pairs dyad) {
    for (int p = 0; p < d; p++)
        for (int r = 0; r <= p; r++)
            for (int i = 0; i < d; i++)
                for (int k = i; k < d; k++)
                    for (int q = 0; q < 1 << d; q++) {
                        double pr = point->axis[p][i][q] * point->axis[r][k][q];
                        double rp = point->axis[r][i][q] * point->axis[p][k][q];
                        dyad[symmetric_index(d, p, r)][symmetric_index(d, i, k)][q] =
                            p == r ? pr : pr + rp;
                    }
}

/* Computes the factor of each dyad, times the weight. */
INLINE void turn_factors(int d, const struct principal_moduli *m, const pointwise weight,
                         by_pairs dyad, by_pairs factor) {
    int components = d * (d + 1) / 2;
    for (int p = 0; p < d; p++)
        for (int r = 0; r <= p; r++)
            for (int n = 0; n < components; n++)
                for (int q = 0; q < 1 << d; q++) {
                    double sum = 0;
                    if (p == r)
                        for (int s = 0; s < d; s++)
                            sum += m->normal[p][s][q] * dyad[s][n][q];
                    else
                        sum = m->shear[p][r][q] * dyad[symmetric_index(d, p, r)][n][q];
                    factor[symmetric_index(d, p, r)][n][q] = weight[q] * sum;
                }
}

/* Turns the moduli from principal axes into space, times the weight. */
INLINE void turn_moduli(int d, const struct principal_moduli *m, const struct strained *point,
                        const pointwise weight, pointwise out[SYMMETRIC_MOST][9]) {
    by_pairs dyad, factor;
    int components = d * (d + 1) / 2;
    turn_dyads(d, point, dyad);
    turn_factors(d, m, weight, dyad, factor);
    for (int n = 0; n < components; n++)
        for (int j = 0; j < d; j++)
            for (int l = j; l < d; l++)
                for (int q = 0; q < 1 << d; q++) {
                    double sum = 0;
                    for (int pr = 0; pr < components; pr++)
                        sum += dyad[pr][n][q] * factor[pr][symmetric_index(d, j, l)][q];
                    out[n][j * d + l][q] = out[n][l * d + j][q] = sum;
                }
}

INLINE void clear_stress(int d, struct moduli *out) {
    for (int i = 0; i < d; i++)
        for (int k = 0; k < d; k++)
            for (int q = 0; q < 1 << d; q++)
                out->stress[i][k][q] = 0;
}

/* Sets the stress part of the second variation (material.h): Kirchhoff's stress and pull x spread,
 * times the weight; 0 of convex moduli, which leave it out. */
INLINE void weigh_stress(int d, const struct material *material, const struct strained *point,
                         double pull, const pointwise weight, struct moduli *out) {
    if (material->convex) {
        clear_stress(d, out);
        return;
    }
    for (int i = 0; i < d; i++)
        for (int k = 0; k < d; k++)
            for (int q = 0; q < 1 << d; q++) {
                double whole = point->stress[i][k][q] + pull * point->spread[i][k][q];
                out->stress[i][k][q] = weight[q] * whole;
            }
}

#endif
