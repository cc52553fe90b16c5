/* The mean dilatations of a mesh's elements, and the pressures that they make: what stiffens beyond
 * bounds as Poisson's ratio nears 1/2 (krylov.h says what for). Private to core/full. */
#ifndef RUGO_CORE_FULL_BULK_H
#define RUGO_CORE_FULL_BULK_H

#include "core/full/element.h"
#include "core/full/mesh.h"

struct bulk {
    const struct mesh *mesh; /* borrowed */
    bool flat;               /* one element stands for its layer */
    struct element_bulk
        *element; /* owned: elements in the order of the mesh, x fastest, or layers */
};

int bulk_create(struct bulk **out, const struct mesh *mesh, bool flat, struct error *err);
void bulk_destroy(struct bulk **bulk);
double bulk_bytes(const struct mesh *mesh, bool flat);

/* out = p + factor k v of every element: v what displacements u (mesh_freedoms) add to its V e, k
 * the pressure of that. p and out may be the same. */
void bulk_bind(const struct bulk *bulk, const double *u, double factor, const double *p,
               double *out);
/* Adds factor times the forces of pressures p outward to force (mesh_freedoms). */
void bulk_push(const struct bulk *bulk, const double *p, double factor, double *force);

#endif
