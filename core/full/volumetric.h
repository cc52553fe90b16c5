/* The mean dilatations of a mesh's elements and the pressures that they cause. This part of the
 * stiffness grows without bound as Poisson's ratio tends to 1/2; gmres.h describes its treatment.
 * Private to core/full. */
#ifndef RUGO_CORE_FULL_VOLUMETRIC_H
#define RUGO_CORE_FULL_VOLUMETRIC_H

#include "core/full/element.h"
#include "core/full/mesh.h"

struct volumetric {
    const struct mesh *mesh; /* borrowed */
    bool one_per_layer;      /* of a flat mesh: one entry serves all elements of a layer */
    struct element_volumetric
        *element; /* owned: elements in the order of the mesh with x fastest, or layers */
};

int volumetric_create(struct volumetric **out, const struct mesh *mesh, bool one_per_layer,
                      struct error *err);
void volumetric_destroy(struct volumetric **volumetric);
double volumetric_bytes(const struct mesh *mesh, bool one_per_layer);

/* out[e] = p[e] + factor * k v of every element e, where v is the change of volume by displacements
 * u (mesh_degrees_of_freedom values) and k is element_volumetric.stiffness. p and out may be the
 * same. */
void volumetric_pressures(const struct volumetric *volumetric, const double *u, double factor,
                          const double *p, double *out);
/* Adds factor times the forces of pressures p (one an element, positive outward) to force
 * (mesh_degrees_of_freedom values). */
void volumetric_forces(const struct volumetric *volumetric, const double *p, double factor,
                       double *force);

#endif
