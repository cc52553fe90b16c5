#include "core/full/hencky.h"
#include "core/contact/layered.h"
#include "core/vectors.h"
#include <math.h>
#include <string.h>

#define INLINE static inline __attribute__((always_inline))

struct solid solid_of(double poisson, enum kinematics kinematics) {
    struct layered_material material = layered_material(poisson);
    return (struct solid){.kinematics = kinematics,
                          .shear = material.mu,
                          .local = material.local,
                          .mean = material.mean};
}

/* In what follows p and r are principal axes, q a point. */

/* --- principal values of a symmetric matrix --- */

static const double LOST = 1e-150; /* a strain whose square is lost: none */

INLINE void principal_two(pointwise c[3][3], pointwise value[3], pointwise axis[3][3]) {
    for (int q = 0; q < 4; q++) {
        double mean = (c[0][0][q] + c[1][1][q]) / 2, half = (c[0][0][q] - c[1][1][q]) / 2;
        double off = c[0][1][q], radius = sqrt(half * half + off * off);
        bool round = !(radius > LOST); /* all axes are principal */
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

/* One rotation of Jacobi's (Golub & Van Loan, 8.5) in the plane of p and r; s is the third axis.
 * The tangent is off over (half the difference and its hypotenuse), which need no branch. */
INLINE void jacobi_rotate(pointwise a[3][3], pointwise axis[3][3], int p, int r, int s) {
    for (int q = 0; q < POINTS_MOST; q++) {
        double off = a[p][r][q], half = (a[r][r][q] - a[p][p][q]) / 2;
        double tangent = off / (fabs(half) + sqrt(half * half + off * off) + LOST);
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

/* Whether any point's matrix has more off its diagonal than rounding. */
INLINE bool off_diagonal(pointwise a[3][3]) {
    int any = 0;
    for (int q = 0; q < POINTS_MOST; q++) {
        double off = a[0][1][q] * a[0][1][q] + a[0][2][q] * a[0][2][q] + a[1][2][q] * a[1][2][q];
        double all = a[0][0][q] * a[0][0][q] + a[1][1][q] * a[1][1][q] + a[2][2][q] * a[2][2][q];
        any |= off > 1e-31 * all;
    }
    return any;
}

/* Destroys a. */
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

/* --- strain --- */

/* F = 1 + h: J - 1, without the difference of numbers near 1, F^-1 and F F^T - 1, which keeps the
 * digits of small strains. False where a point is turned inside out. */
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
    return !folded;
}

INLINE void strain_small(int d, const struct solid *solid, pointwise h[3][3],
                         struct strained *out) {
    for (int q = 0; q < 1 << d; q++) {
        double trace = 0, square = 0;
        for (int i = 0; i < d; i++)
            trace += h[i][i][q];
        for (int i = 0; i < d; i++)
            for (int k = 0; k < d; k++) {
                double e = (h[i][k][q] + h[k][i][q]) / 2;
                square += e * e;
                out->stress[i][k][q] = 2 * solid->shear * e + (i == k ? solid->local * trace : 0);
                out->inverse[i][k][q] = out->axis[i][k][q] = out->spread[i][k][q] = i == k;
            }
        out->dilatation[q] = trace;
        out->energy[q] = solid->shear * square + solid->local / 2 * trace * trace;
    }
}

/* From the principal strains and stretches: stresses along the axes, and the energy. */
INLINE void stress_principal(int d, const struct solid *solid, struct strained *out) {
    bool hencky = solid->kinematics == KINEMATICS_HENCKY;
    for (int q = 0; q < 1 << d; q++) {
        double trace = 0, square = 0;
        for (int p = 0; p < d; p++) {
            trace += out->strain[p][q];
            square += out->strain[p][q] * out->strain[p][q];
        }
        for (int p = 0; p < d; p++)
            out->principal[p][q] = (2 * solid->shear * out->strain[p][q] + solid->local * trace) *
                                   (hencky ? 1 : out->square[p][q]);
        out->energy[q] = solid->shear * square + solid->local / 2 * trace * trace;
        out->dilatation[q] = hencky ? out->dilatation[q] : trace;
    }
}

/* c: F F^T - 1. */
INLINE void in_space(int d, bool hencky, pointwise c[3][3], struct strained *out) {
    for (int i = 0; i < d; i++)
        for (int k = 0; k < d; k++)
            for (int q = 0; q < 1 << d; q++) {
                double sum = 0;
                for (int p = 0; p < d; p++)
                    sum += out->principal[p][q] * out->axis[p][i][q] * out->axis[p][k][q];
                out->stress[i][k][q] = sum;
                out->spread[i][k][q] =
                    hencky ? (i == k) * (1 + out->dilatation[q]) : (i == k) + c[i][k][q];
            }
}

INLINE bool strain(int d, const struct solid *solid, pointwise h[3][3], struct strained *out) {
    bool hencky = solid->kinematics == KINEMATICS_HENCKY;
    if (solid->kinematics == KINEMATICS_SMALL) {
        strain_small(d, solid, h, out);
        return true;
    }
    pointwise c[3][3], turned[3][3], value[3];
    if (!deform(d, h, c, out))
        return false;
    memcpy(turned, c, sizeof c);
    if (d == 2)
        principal_two(turned, value, out->axis);
    else
        principal_three(turned, value, out->axis);
    for (int p = 0; p < d; p++)
        for (int q = 0; q < 1 << d; q++) {
            if (!(value[p][q] > -1))
                return false;
            out->square[p][q] = 1 + value[p][q];
            out->strain[p][q] = (hencky ? log1p(value[p][q]) : value[p][q]) / 2;
        }
    stress_principal(d, solid, out);
    in_space(d, hencky, c, out);
    return true;
}

WIDE_VECTORS bool solid_strain(int dimension, const struct solid *solid, pointwise h[3][3],
                               struct strained *out) {
    return dimension == 2 ? strain(2, solid, h, out) : strain(3, solid, h, out);
}

/* --- moduli --- */

/* s/sinh s, by its series where that is exact to rounding: its terms fall as (s/pi)^2. */
INLINE void over_sinh(int d, const pointwise s, pointwise out) {
    static const double SERIES_MOST = 1.0 / 16;
    int beyond = 0;
    for (int q = 0; q < 1 << d; q++) {
        double x = s[q] * s[q];
        out[q] = 1 - x * (1.0 / 6 -
                          x * (7.0 / 360 -
                               x * (31.0 / 15120 -
                                    x * (127.0 / 604800 -
                                         x * (73.0 / 3421440 - x * (1414477.0 / 653837184000))))));
        beyond |= x > SERIES_MOST;
    }
    for (int q = 0; beyond && q < 1 << d; q++)
        if (s[q] * s[q] > SERIES_MOST)
            out[q] = s[q] / sinh(s[q]);
}

/* Of the material, along principal axes p, r (Ogden 1984, 6.1; here with gradients in space):
 * normal[p][r] of G_pp G_rr, and of p > r shear[p][r] of (G_pr + G_rp)^2. */
struct principal_moduli {
    pointwise normal[3][3], shear[3][3];
};

/* Stretches enter the shear moduli by (stress_p - stress_r)/(square_p - square_r), which for
 * Hencky's stress is shear/(stretch_p stretch_r) s/sinh s, s the difference of the logarithms: so
 * nothing is lost where stretches are equal or nearly so. */
INLINE void moduli_hencky(int d, const struct solid *solid, const struct strained *point,
                          double pull, struct principal_moduli *out) {
    pointwise outward, apart, part;
    for (int q = 0; q < 1 << d; q++)
        outward[q] = solid->convex ? 0 : pull * (1 + point->dilatation[q]);
    for (int p = 0; p < d; p++) {
        for (int q = 0; q < 1 << d; q++) {
            double stress = solid->convex ? 0 : point->principal[p][q];
            out->normal[p][p][q] = 2 * solid->shear + solid->local - 2 * stress - outward[q];
        }
        for (int r = 0; r < p; r++) {
            for (int q = 0; q < 1 << d; q++)
                apart[q] = point->strain[p][q] - point->strain[r][q];
            over_sinh(d, apart, part);
            for (int q = 0; q < 1 << d; q++) {
                double ratio = sqrt(point->square[r][q] / point->square[p][q]);
                double stress = point->principal[r][q] + outward[q];
                out->normal[p][r][q] = out->normal[r][p][q] = solid->local + outward[q];
                out->shear[p][r][q] = solid->convex ? solid->shear * part[q]
                                                    : solid->shear * part[q] * ratio - stress;
            }
        }
    }
}

INLINE void moduli_st_venant(int d, const struct solid *solid, const struct strained *point,
                             struct principal_moduli *out) {
    for (int p = 0; p < d; p++)
        for (int r = 0; r < d; r++)
            for (int q = 0; q < 1 << d; q++) {
                double squares = point->square[p][q] * point->square[r][q];
                out->normal[p][r][q] = squares * ((p == r ? 2 * solid->shear : 0) + solid->local);
                out->shear[p][r][q] = squares * solid->shear;
            }
}

INLINE void moduli_small(int d, const struct solid *solid, struct principal_moduli *out) {
    for (int p = 0; p < d; p++)
        for (int r = 0; r < d; r++)
            for (int q = 0; q < 1 << d; q++) {
                out->normal[p][r][q] = (p == r ? 2 * solid->shear : 0) + solid->local;
                out->shear[p][r][q] = solid->shear;
            }
}

/* From principal axes, times the weight. */
INLINE void turn(int d, const struct principal_moduli *m, const struct strained *point,
                 const pointwise weight, pointwise out[SYMMETRIC_MOST][9]) {
    /* By symmetric_index(p, r): the dyad of axes p and r, and what it is multiplied with. */
    pointwise dyad[SYMMETRIC_MOST][SYMMETRIC_MOST], factor[SYMMETRIC_MOST][SYMMETRIC_MOST];
    int components = d * (d + 1) / 2;
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

INLINE void moduli_of(int d, const struct solid *solid, const struct strained *point, double pull,
                      const pointwise weight, struct moduli *out) {
    struct principal_moduli m;
    bool stress = solid->kinematics != KINEMATICS_SMALL && !solid->convex;
    if (solid->kinematics == KINEMATICS_SMALL)
        moduli_small(d, solid, &m);
    else if (solid->kinematics == KINEMATICS_ST_VENANT)
        moduli_st_venant(d, solid, point, &m);
    else
        moduli_hencky(d, solid, point, pull, &m);
    turn(d, &m, point, weight, out->material);
    for (int i = 0; i < d; i++)
        for (int k = 0; k < d; k++)
            for (int q = 0; q < 1 << d; q++) {
                double whole = point->stress[i][k][q] + pull * point->spread[i][k][q];
                out->stress[i][k][q] = stress ? weight[q] * whole : 0;
            }
}

WIDE_VECTORS void solid_moduli(int dimension, const struct solid *solid,
                               const struct strained *point, double pull, const pointwise weight,
                               struct moduli *out) {
    if (dimension == 2)
        moduli_of(2, solid, point, pull, weight, out);
    else
        moduli_of(3, solid, point, pull, weight, out);
}
