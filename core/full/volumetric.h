/* The mean dilatations of a mesh's elements, and the pressures that they make: what stiffens beyond
 * bounds as Poisson's ratio nears 1/2 (gmres.h says what for). Private to core/full. */
#ifndef RUGO_CORE_FULL_VOLUMETRIC_H
#define RUGO_CORE_FULL_VOLUMETRIC_H

#include "core/full/element.h"
#include "core/full/mesh.h"

struct volumetric {
    const struct mesh *mesh; /* borrowed */
    bool flat;               /* one element stands for its layer */
    struct element_volumetric
        *element; /* owned: elements in the order of the mesh, x fastest, or layers */
};

int volumetric_create(struct volumetric **out, const struct mesh *mesh, bool flat,
                      struct error *err);
void volumetric_destroy(struct volumetric **volumetric);
double volumetric_bytes(const struct mesh *mesh, bool flat);

/* out = p + factor k v of every element: v what displacements u (mesh_degrees_of_freedom) add to
 * its V e, k the pressure of that. p and out may be the same. */
void volumetric_pressures(const struct volumetric *volumetric, const double *u, double factor,
                          const double *p, double *out);
/* Adds factor times the forces of pressures p outward to force (mesh_degrees_of_freedom). */
void volumetric_forces(const struct volumetric *volumetric, const double *p, double factor,
                       double *force);

#endif
