/* St. Venant and Kirchhoff's material: energy shear sum E_p^2 + (local/2) (sum E_p)^2 per reference
 * volume, E_p = (square of the principal stretch - 1)/2 Green's strain. */
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
            out->strain[p][q] = value[p][q] / 2;
    for (int q = 0; q < 1 << d; q++) {
        double trace = 0, square = 0;
        for (int p = 0; p < d; p++) {
            trace += out->strain[p][q];
            square += out->strain[p][q] * out->strain[p][q];
        }
        for (int p = 0; p < d; p++)
            out->principal[p][q] =
                (2 * material->shear * out->strain[p][q] + material->local * trace) *
                out->square[p][q];
        out->energy[q] = material->shear * square + material->local / 2 * trace * trace;
        out->dilatation[q] = trace;
    }
    turn_stress(d, out);
    for (int i = 0; i < d; i++)
        for (int k = 0; k < d; k++)
            for (int q = 0; q < 1 << d; q++)
                out->spread[i][k][q] = (i == k) + c[i][k][q];
    return true;
}

WIDE_VECTORS static bool st_venant_strain(int dimension, const struct material *material,
                                          pointwise h[3][3], struct strained *out) {
    return dimension == 2 ? strain(2, material, h, out) : strain(3, material, h, out);
}

INLINE void principal_moduli(int d, const struct material *material, const struct strained *point,
                             struct principal_moduli *out) {
    for (int p = 0; p < d; p++)
        for (int r = 0; r < d; r++)
            for (int q = 0; q < 1 << d; q++) {
                double squares = point->square[p][q] * point->square[r][q];
                out->normal[p][r][q] =
                    squares * ((p == r ? 2 * material->shear : 0) + material->local);
                out->shear[p][r][q] = squares * material->shear;
            }
}

INLINE void moduli(int d, const struct material *material, const struct strained *point,
                   double pull, const pointwise weight, struct moduli *out) {
    struct principal_moduli m;
    principal_moduli(d, material, point, &m);
    turn_moduli(d, &m, point, weight, out->material);
    weigh_stress(d, material, point, pull, weight, out);
}

WIDE_VECTORS static void st_venant_moduli(int dimension, const struct material *material,
                                          const struct strained *point, double pull,
                                          const pointwise weight, struct moduli *out) {
    if (dimension == 2)
        moduli(2, material, point, pull, weight, out);
    else
        moduli(3, material, point, pull, weight, out);
}

const struct material_law MATERIAL_ST_VENANT = {
    .growth_least = -INFINITY, .strain = st_venant_strain, .moduli = st_venant_moduli};
