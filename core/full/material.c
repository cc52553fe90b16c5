#include "core/full/material.h"
#include "core/contact/layered.h"

static const struct material_law *const LAWS[] = {
    [KINEMATICS_HENCKY] = &MATERIAL_HENCKY,
    [KINEMATICS_ST_VENANT] = &MATERIAL_ST_VENANT,
    [KINEMATICS_SMALL] = &MATERIAL_SMALL_STRAIN,
    [KINEMATICS_NEO_HOOKE] = &MATERIAL_NEO_HOOKE,
};

struct material material_of(double poisson, enum kinematics kinematics) {
    struct layered_material layered = layered_material(poisson);
    return (struct material){.law = LAWS[kinematics],
                             .kinematics = kinematics,
                             .shear = layered.mu,
                             .local = layered.local,
                             .mean = layered.mean};
}

bool material_strain(int dimension, const struct material *material, pointwise h[3][3],
                     struct strained *out) {
    return material->law->strain(dimension, material, h, out);
}

void material_moduli(int dimension, const struct material *material, const struct strained *point,
                     double pull, const pointwise weight, struct moduli *out) {
    material->law->moduli(dimension, material, point, pull, weight, out);
}
