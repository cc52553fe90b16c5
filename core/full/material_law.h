/* A material law as a table of functions, one in each material_*.c. Private to core/full. */
#ifndef RUGO_CORE_FULL_MATERIAL_LAW_H
#define RUGO_CORE_FULL_MATERIAL_LAW_H

#include "core/full/material.h"

struct material_law {
    bool logarithmic;    /* an element's mean strain is ln(1 + growth), otherwise growth itself,
                            growth being the mean of strained.dilatation (element.h) */
    double growth_least; /* an element whose growth is not above this is inverted */
    /* As material_strain and material_moduli. */
    bool (*strain)(int dimension, const struct material *material, pointwise h[3][3],
                   struct strained *out);
    void (*moduli)(int dimension, const struct material *material, const struct strained *point,
                   double pull, const pointwise weight, struct moduli *out);
};
extern const struct material_law MATERIAL_HENCKY, MATERIAL_ST_VENANT, MATERIAL_SMALL_STRAIN;

#endif
