/* Hencky's material: energy shear sum e_p^2 + (local/2) (ln J)^2 per reference volume, e_p the
 * logarithms of the principal stretches. */
#include "core/full/material.h"
#include "core/full/principal_axes.h"
#include "core/vectors.h"

INLINE bool strain(int d, const struct material *material, pointwise h[3][3],
                   struct strained *out) {
    pointwise c[3][3], value[3];
    if (!deform_principal(d, h, c, value, out))
        return false;
    for (int p = 0; p < d; p++)
        for (int q = 0; q < 1 << d; q++)
            out->strain[p][q] = log1p(value[p][q]) / 2;
    for (int q = 0; q < 1 << d; q++) {
        double trace = 0, square = 0;
        for (int p = 0; p < d; p++) {
            trace += out->strain[p][q];
            square += out->strain[p][q] * out->strain[p][q];
        }
        for (int p = 0; p < d; p++)
            out->principal[p][q] =
                2 * material->shear * out->strain[p][q] + material->local * trace;
        out->energy[q] = material->shear * square + material->local / 2 * trace * trace;
    }
    turn_stress(d, out);
    for (int i = 0; i < d; i++)
        for (int k = 0; k < d; k++)
            for (int q = 0; q < 1 << d; q++)
                out->spread[i][k][q] = (i == k) * (1 + out->dilatation[q]);
    return true;
}

WIDE_VECTORS static bool hencky_strain(int dimension, const struct material *material,
                                       pointwise h[3][3], struct strained *out) {
    return dimension == 2 ? strain(2, material, h, out) : strain(3, material, h, out);
}

/* s/sinh s by its series where that is exact to rounding; the terms fall as (s/pi)^2. */
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
    for (int q = 0; beyond != 0 && q < 1 << d; q++)
        if (s[q] * s[q] > SERIES_MOST)
            out[q] = s[q] / sinh(s[q]);
}

/* The shear moduli contain (stress_p - stress_r)/(square_p - square_r), which for Hencky's stress
 * is shear/(stretch_p stretch_r) s/sinh s with s the difference of the logarithms: no digits are
 * lost where stretches are nearly equal. */
INLINE void principal_moduli(int d, const struct material *material, const struct strained *point,
                             double pull, struct principal_moduli *out) {
    pointwise outward, apart, part;
    for (int q = 0; q < 1 << d; q++)
        outward[q] = material->convex ? 0 : pull * (1 + point->dilatation[q]);
    for (int p = 0; p < d; p++) {
        for (int q = 0; q < 1 << d; q++) {
            double stress = material->convex ? 0 : point->principal[p][q];
            out->normal[p][p][q] = 2 * material->shear + material->local - 2 * stress - outward[q];
        }
        for (int r = 0; r < p; r++) {
            for (int q = 0; q < 1 << d; q++)
                apart[q] = point->strain[p][q] - point->strain[r][q];
            over_sinh(d, apart, part);
            for (int q = 0; q < 1 << d; q++) {
                double ratio = sqrt(point->square[r][q] / point->square[p][q]);
                double stress = point->principal[r][q] + outward[q];
                out->normal[p][r][q] = out->normal[r][p][q] = material->local + outward[q];
                out->shear[p][r][q] = material->convex ? material->shear * part[q]
                                                       : material->shear * part[q] * ratio - stress;
            }
        }
    }
}

INLINE void moduli(int d, const struct material *material, const struct strained *point,
                   double pull, const pointwise weight, struct moduli *out) {
    struct principal_moduli m;
    principal_moduli(d, material, point, pull, &m);
    turn_moduli(d, &m, point, weight, out->material);
    weigh_stress(d, material, point, pull, weight, out);
}

WIDE_VECTORS static void hencky_moduli(int dimension, const struct material *material,
                                       const struct strained *point, double pull,
                                       const pointwise weight, struct moduli *out) {
    if (dimension == 2)
        moduli(2, material, point, pull, weight, out);
    else
        moduli(3, material, point, pull, weight, out);
}

const struct material_law MATERIAL_HENCKY = {
    .logarithmic = true, .growth_least = -1, .strain = hencky_strain, .moduli = hencky_moduli};
