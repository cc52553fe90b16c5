/* The compressible neo-Hooke material (Bonet & Wood 2008): energy (shear/2)(tr(F F^T - 1) - 2 ln J)
 * + (local/2)(ln J)^2 per reference volume. Plane strain has a third stretch of 1. Kirchhoff's
 * stress is shear (F F^T - 1) + local ln J, so that the moduli are isotropic and need no principal
 * axes. */
#include "core/full/material.h"
#include "core/full/principal_axes.h"
#include "core/vectors.h"

INLINE bool strain(int d, const struct material *material, pointwise h[3][3],
                   struct strained *out) {
    pointwise c[3][3];
    if (!deform(d, h, c, out))
        return false;
    for (int q = 0; q < 1 << d; q++) {
        double trace = 0, logarithm = log1p(out->dilatation[q]);
        for (int i = 0; i < d; i++)
            trace += c[i][i][q];
        out->energy[q] = material->shear / 2 * (trace - 2 * logarithm) +
                         material->local / 2 * logarithm * logarithm;
        out->strain[0][q] = logarithm;
        for (int i = 0; i < d; i++)
            for (int k = 0; k < d; k++) {
                out->stress[i][k][q] =
                    material->shear * c[i][k][q] + (i == k ? material->local * logarithm : 0);
                out->spread[i][k][q] = (i == k) * (1 + out->dilatation[q]);
                out->axis[i][k][q] = i == k;
            }
    }
    return true;
}

WIDE_VECTORS static bool neo_hooke_strain(int dimension, const struct material *material,
                                          pointwise h[3][3], struct strained *out) {
    return dimension == 2 ? strain(2, material, h, out) : strain(3, material, h, out);
}

INLINE void moduli(int d, const struct material *material, const struct strained *point,
                   double pull, const pointwise weight, struct moduli *out) {
    double of_stress = material->convex ? 0 : 1;
    memset(out->material, 0, sizeof out->material);
    for (int q = 0; q < 1 << d; q++) {
        double outward = of_stress * pull * (1 + point->dilatation[q]);
        double volume = weight[q] * (material->local + outward);
        double shear = weight[q] * (material->shear - outward -
                                    of_stress * material->local * point->strain[0][q]);
        for (int i = 0; i < d; i++)
            for (int k = i; k < d; k++) {
                pointwise *row = out->material[symmetric_index(d, i, k)];
                for (int j = 0; i == k && j < d; j++)
                    row[j * d + j][q] = volume;
                row[i * d + k][q] += i == k ? 2 * shear : shear;
                if (i != k)
                    row[k * d + i][q] += shear;
            }
    }
    weigh_stress(d, material, point, pull, weight, out);
}

WIDE_VECTORS static void neo_hooke_moduli(int dimension, const struct material *material,
                                          const struct strained *point, double pull,
                                          const pointwise weight, struct moduli *out) {
    if (dimension == 2)
        moduli(2, material, point, pull, weight, out);
    else
        moduli(3, material, point, pull, weight, out);
}

const struct material_law MATERIAL_NEO_HOOKE = {.logarithmic = true,
                                                .growth_least = -1,
                                                .strain = neo_hooke_strain,
                                                .moduli = neo_hooke_moduli};
