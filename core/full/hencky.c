#include "core/full/hencky.h"
#include "core/contact/layered.h"
#include "core/vectors.h"
#include <math.h>

#define INLINE static inline __attribute__((always_inline))

struct solid solid_of(double poisson, enum kinematics kinematics) {
    struct layered_material material = layered_material(poisson);
    return (struct solid){.kinematics = kinematics,
                          .shear = material.mu,
                          .local = material.local,
                          .mean = material.mean};
}

/* --- principal values of a symmetric matrix --- */

INLINE void principal_two(double c[3][3], double value[3], double axis[3][3]) {
    double mean = (c[0][0] + c[1][1]) / 2, half = (c[0][0] - c[1][1]) / 2;
    double radius = sqrt(half * half + c[0][1] * c[0][1]), cosine = 1, sine = 0;
    if (radius > 0) {
        double double_cosine = half / radius, double_sine = c[0][1] / radius;
        if (double_cosine >= 0) {
            cosine = sqrt((1 + double_cosine) / 2);
            sine = double_sine / (2 * cosine);
        } else {
            sine = sqrt((1 - double_cosine) / 2);
            cosine = double_sine / (2 * sine);
        }
    }
    value[0] = mean + radius;
    value[1] = mean - radius;
    axis[0][0] = axis[1][1] = cosine;
    axis[0][1] = sine;
    axis[1][0] = -sine;
}

/* One rotation of Jacobi's (Golub & Van Loan, 8.5) in the plane of p and q; r is the third axis. */
INLINE void jacobi_rotate(double a[3][3], double axis[3][3], int p, int q, int r) {
    double off = a[p][q];
    if (off == 0)
        return;
    double tau = (a[q][q] - a[p][p]) / (2 * off);
    double t = copysign(1, tau) / (fabs(tau) + sqrt(1 + tau * tau));
    double c = 1 / sqrt(1 + t * t), s = t * c;
    double rp = a[r][p], rq = a[r][q];
    a[p][p] -= t * off;
    a[q][q] += t * off;
    a[p][q] = a[q][p] = 0;
    a[r][p] = a[p][r] = c * rp - s * rq;
    a[r][q] = a[q][r] = s * rp + c * rq;
    for (int i = 0; i < 3; i++) {
        double vp = axis[p][i], vq = axis[q][i];
        axis[p][i] = c * vp - s * vq;
        axis[q][i] = s * vp + c * vq;
    }
}

INLINE void principal_three(double c[3][3], double value[3], double axis[3][3]) {
    enum { SWEEPS_MOST = 12 };
    double a[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            a[i][j] = c[i][j];
            axis[i][j] = i == j;
        }
    for (int sweep = 0; sweep < SWEEPS_MOST; sweep++) {
        double off = a[0][1] * a[0][1] + a[0][2] * a[0][2] + a[1][2] * a[1][2];
        double all = a[0][0] * a[0][0] + a[1][1] * a[1][1] + a[2][2] * a[2][2];
        if (!(off > 1e-31 * all))
            break;
        jacobi_rotate(a, axis, 0, 1, 2);
        jacobi_rotate(a, axis, 0, 2, 1);
        jacobi_rotate(a, axis, 1, 2, 0);
    }
    for (int p = 0; p < 3; p++)
        value[p] = a[p][p];
}

/* --- strain --- */

/* J - 1, without the difference of numbers near 1. */
INLINE double dilatation_of(int d, double h[3][3]) {
    double trace = h[0][0] + h[1][1], minor = h[0][0] * h[1][1] - h[0][1] * h[1][0];
    if (d == 2)
        return trace + minor;
    double minors =
        minor + h[0][0] * h[2][2] - h[0][2] * h[2][0] + h[1][1] * h[2][2] - h[1][2] * h[2][1];
    double determinant = h[0][0] * (h[1][1] * h[2][2] - h[1][2] * h[2][1]) -
                         h[0][1] * (h[1][0] * h[2][2] - h[1][2] * h[2][0]) +
                         h[0][2] * (h[1][0] * h[2][1] - h[1][1] * h[2][0]);
    return trace + h[2][2] + minors + determinant;
}

/* (1 + h)^-1, whose determinant is 1 + dilatation. */
INLINE void inverse_of(int d, double h[3][3], double dilatation, double inverse[3][3]) {
    double over = 1 / (1 + dilatation);
    if (d == 2) {
        inverse[0][0] = (1 + h[1][1]) * over;
        inverse[1][1] = (1 + h[0][0]) * over;
        inverse[0][1] = -h[0][1] * over;
        inverse[1][0] = -h[1][0] * over;
        return;
    }
    double f[3][3];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            f[i][k] = h[i][k] + (i == k);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            int i1 = (i + 1) % 3, i2 = (i + 2) % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
            inverse[k][i] = (f[i1][k1] * f[i2][k2] - f[i1][k2] * f[i2][k1]) * over;
        }
}

INLINE void strain_small(int d, const struct solid *solid, double h[3][3], struct strained *out) {
    double trace = 0, square = 0;
    for (int i = 0; i < d; i++)
        trace += h[i][i];
    for (int i = 0; i < d; i++)
        for (int k = 0; k < d; k++) {
            double e = (h[i][k] + h[k][i]) / 2;
            square += e * e;
            out->stress[i][k] = 2 * solid->shear * e + (i == k ? solid->local * trace : 0);
            out->inverse[i][k] = out->axis[i][k] = i == k;
        }
    out->dilatation = trace;
    out->energy = solid->shear * square + solid->local / 2 * trace * trace;
}

/* From the stretches: stresses along the axes, and the energy. */
INLINE void stress_principal(int d, const struct solid *solid, struct strained *out) {
    bool hencky = solid->kinematics == KINEMATICS_HENCKY;
    double trace = 0, square = 0;
    for (int p = 0; p < d; p++) {
        trace += out->strain[p];
        square += out->strain[p] * out->strain[p];
    }
    for (int p = 0; p < d; p++)
        out->principal[p] = (2 * solid->shear * out->strain[p] + solid->local * trace) *
                            (hencky ? 1 : out->square[p]);
    out->energy = solid->shear * square + solid->local / 2 * trace * trace;
    if (!hencky)
        out->dilatation = trace;
}

INLINE bool strain(int d, const struct solid *solid, double h[3][3], struct strained *out) {
    if (solid->kinematics == KINEMATICS_SMALL) {
        strain_small(d, solid, h, out);
        return true;
    }
    double c[3][3], value[3]; /* F F^T - 1: small strains keep their digits */
    for (int i = 0; i < d; i++)
        for (int k = 0; k < d; k++) {
            c[i][k] = h[i][k] + h[k][i];
            for (int l = 0; l < d; l++)
                c[i][k] += h[i][l] * h[k][l];
        }
    out->dilatation = dilatation_of(d, h);
    if (!(out->dilatation > -1))
        return false;
    inverse_of(d, h, out->dilatation, out->inverse);
    if (d == 2)
        principal_two(c, value, out->axis);
    else
        principal_three(c, value, out->axis);
    for (int p = 0; p < d; p++) {
        if (!(value[p] > -1))
            return false;
        out->square[p] = 1 + value[p];
        out->strain[p] = (solid->kinematics == KINEMATICS_HENCKY ? log1p(value[p]) : value[p]) / 2;
    }
    stress_principal(d, solid, out);
    for (int i = 0; i < d; i++)
        for (int k = 0; k < d; k++) {
            out->stress[i][k] = 0;
            for (int p = 0; p < d; p++)
                out->stress[i][k] += out->principal[p] * out->axis[p][i] * out->axis[p][k];
        }
    return true;
}

bool solid_strain(int dimension, const struct solid *solid, double h[3][3], struct strained *out) {
    return dimension == 2 ? strain(2, solid, h, out) : strain(3, solid, h, out);
}

/* --- moduli --- */

/* s/sinh s, by its series where that is exact to rounding: its terms fall as (s/pi)^2. */
INLINE double over_sinh(double s) {
    double x = s * s;
    if (x > 1.0 / 16)
        return s / sinh(s);
    return 1 -
           x * (1.0 / 6 - x * (7.0 / 360 -
                               x * (31.0 / 15120 -
                                    x * (127.0 / 604800 -
                                         x * (73.0 / 3421440 - x * (1414477.0 / 653837184000))))));
}

/* Along principal axes p, q (Ogden 1984, 6.1; here with gradients in space): normal[p][q] of
 * G_pp G_qq, along[p][q] of G_pq^2, cross[p][q] of G_pq G_qp. */
struct principal_moduli {
    double normal[3][3], along[3][3], cross[3][3];
};

/* Stretches enter the shear moduli by (stress_p - stress_q)/(square_p - square_q), which for
 * Hencky's stress is shear/(stretch_p stretch_q) s/sinh s, s the difference of the logarithms, and
 * for St Venant's a polynomial: nothing is lost where stretches are equal or nearly so. The pull
 * adds to Hencky's stresses pull J, to St Venant's pull square_p. */
INLINE void moduli_finite(int d, const struct solid *solid, const struct strained *point,
                          double pull, struct principal_moduli *out) {
    bool hencky = solid->kinematics == KINEMATICS_HENCKY;
    double outward = pull * (1 + point->dilatation), even = solid->local * point->dilatation + pull;
    for (int p = 0; p < d; p++)
        for (int q = 0; q < d; q++) {
            double xp = point->square[p], xq = point->square[q], same = p == q;
            double bare = 2 * solid->shear * same + solid->local;
            if (hencky) {
                double s = point->strain[p] - point->strain[q];
                out->normal[p][q] = bare - same * point->principal[p] + (1 - same) * outward;
                out->along[p][q] = solid->shear * sqrt(xq / xp) * over_sinh(s);
                out->cross[p][q] = out->along[p][q] - point->principal[q] - outward;
            } else {
                out->normal[p][q] = xp * xq * bare + same * (point->principal[p] + pull * xp);
                out->along[p][q] = xq * (solid->shear * (xp + xq - 1) + even);
                out->cross[p][q] = xq * solid->shear * xp;
            }
        }
}

/* Normal moduli without stress (Hencky's: of the energy in logarithms alone); of each pair of
 * shears the largest cross term that leaves them positive. */
INLINE void moduli_convex(int d, const struct solid *solid, const struct strained *point,
                          struct principal_moduli *out) {
    bool hencky = solid->kinematics == KINEMATICS_HENCKY;
    for (int p = 0; p < d; p++)
        for (int q = 0; q < d; q++) {
            double most = sqrt(fmax(0, out->along[p][q]) * fmax(0, out->along[q][p]));
            out->normal[p][q] = ((p == q ? 2 * solid->shear : 0) + solid->local) *
                                (hencky ? 1 : point->square[p] * point->square[q]);
            out->along[p][q] = fmax(0, out->along[p][q]);
            out->cross[p][q] = copysign(fmin(fabs(out->cross[p][q]), most), out->cross[p][q]);
        }
}

INLINE void moduli_small(int d, const struct solid *solid, struct principal_moduli *out) {
    for (int p = 0; p < d; p++)
        for (int q = 0; q < d; q++) {
            out->normal[p][q] = (p == q ? 2 * solid->shear : 0) + solid->local;
            out->along[p][q] = out->cross[p][q] = solid->shear;
        }
}

INLINE void moduli_of(int d, const struct solid *solid, const struct strained *point, double pull,
                      double moduli[9][9]) {
    struct principal_moduli m;
    if (solid->kinematics == KINEMATICS_SMALL)
        moduli_small(d, solid, &m);
    else
        moduli_finite(d, solid, point, pull, &m);
    if (solid->convex && solid->kinematics != KINEMATICS_SMALL)
        moduli_convex(d, solid, point, &m);
    /* The dyad of axes p and q as a row, and the rows that it is multiplied with, summed. */
    double dyad[9][9], factor[9][9];
    for (int p = 0; p < d; p++)
        for (int q = 0; q < d; q++)
            for (int i = 0; i < d; i++)
                for (int k = 0; k < d; k++)
                    dyad[p * d + q][i * d + k] = point->axis[p][i] * point->axis[q][k];
    for (int p = 0; p < d; p++)
        for (int q = 0; q < d; q++)
            for (int n = 0; n < d * d; n++) {
                double sum = 0;
                if (p == q)
                    for (int r = 0; r < d; r++)
                        sum += m.normal[p][r] * dyad[r * d + r][n];
                else
                    sum = m.along[p][q] * dyad[p * d + q][n] + m.cross[p][q] * dyad[q * d + p][n];
                factor[p * d + q][n] = sum;
            }
    for (int m1 = 0; m1 < d * d; m1++)
        for (int n = 0; n < d * d; n++) {
            double sum = 0;
            for (int r = 0; r < d * d; r++)
                sum += dyad[r][m1] * factor[r][n];
            moduli[m1][n] = sum;
        }
}

WIDE_VECTORS void solid_moduli(int dimension, const struct solid *solid,
                               const struct strained *point, double pull, double moduli[9][9]) {
    if (dimension == 2)
        moduli_of(2, solid, point, pull, moduli);
    else
        moduli_of(3, solid, point, pull, moduli);
}
