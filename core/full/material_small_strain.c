/* Linear elasticity in small strains: energy shear e:e + (local/2) (tr e)^2 per volume, e the
 * symmetric part of the displacement gradient. */
#include "core/full/material.h"
#include "core/full/principal_axes.h"
#include "core/vectors.h"

INLINE bool strain(int d, const struct material *material, pointwise h[3][3],
                   struct strained *out) {
    for (int q = 0; q < 1 << d; q++) {
        double trace = 0, square = 0;
        for (int i = 0; i < d; i++)
            trace += h[i][i][q];
        for (int i = 0; i < d; i++)
            for (int k = 0; k < d; k++) {
                double e = (h[i][k][q] + h[k][i][q]) / 2;
                square += e * e;
                out->stress[i][k][q] =
                    2 * material->shear * e + (i == k ? material->local * trace : 0);
                out->inverse[i][k][q] = out->axis[i][k][q] = out->spread[i][k][q] = i == k;
            }
        out->dilatation[q] = trace;
        out->energy[q] = material->shear * square + material->local / 2 * trace * trace;
    }
    return true;
}

WIDE_VECTORS static bool small_strain(int dimension, const struct material *material,
                                      pointwise h[3][3], struct strained *out) {
    return dimension == 2 ? strain(2, material, h, out) : strain(3, material, h, out);
}

INLINE void principal_moduli(int d, const struct material *material, struct principal_moduli *out) {
    for (int p = 0; p < d; p++)
        for (int r = 0; r < d; r++)
            for (int q = 0; q < 1 << d; q++) {
                out->normal[p][r][q] = (p == r ? 2 * material->shear : 0) + material->local;
                out->shear[p][r][q] = material->shear;
            }
}

INLINE void moduli(int d, const struct material *material, const struct strained *point,
                   double pull, const pointwise weight, struct moduli *out) {
    struct principal_moduli m;
    principal_moduli(d, material, &m);
    (void)pull;
    turn_moduli(d, &m, point, weight, out->material);
    clear_stress(d, out);
}

WIDE_VECTORS static void small_moduli(int dimension, const struct material *material,
                                      const struct strained *point, double pull,
                                      const pointwise weight, struct moduli *out) {
    if (dimension == 2)
        moduli(2, material, point, pull, weight, out);
    else
        moduli(3, material, point, pull, weight, out);
}

const struct material_law MATERIAL_SMALL_STRAIN = {
    .growth_least = -1, .strain = small_strain, .moduli = small_moduli};
