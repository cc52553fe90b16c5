/* The mean dilatations of a mesh's elements and the pressures that they cause. This part of the
 * stiffness grows without bound as Poisson's ratio tends to 1/2; gmres.h describes its treatment.
 * Private to core/full. */
#ifndef RUGO_CORE_FULL_VOLUMETRIC_H
#define RUGO_CORE_FULL_VOLUMETRIC_H

#include "core/full/element.h"
#include "core/full/mesh.h"

struct volumetric {
    const struct mesh *mesh; /* borrowed */
    bool one_per_layer;      /* of a flat mesh: four entries serve all elements of a layer, by the
                                parity of column and row, which differ where columns widen */
    double row;              /* factor of the equations p - k v = 0 (gmres.h) */
    double *gradient; /* owned: [entry][a*dimension + k], derivative of V e by displacement k of the
                         node that stands for corner a; entries are elements in the order of the
                         mesh with x fastest, or those of layers */
    double *stiffness; /* owned: [entry], k */
};

/* The equations of the pressures count as their error of e times the shear modulus, a force an area
 * like all others. */
int volumetric_create(struct volumetric **out, const struct mesh *mesh,
                      const struct material *material, bool one_per_layer, struct error *err);
void volumetric_destroy(struct volumetric **volumetric);
double volumetric_bytes(const struct mesh *mesh, bool one_per_layer);

/* Stores an element's part; weights of corners that hang go to their nodes. */
void volumetric_store(struct volumetric *volumetric, size_t entry,
                      const struct mesh_element *element, const struct element_volumetric *own);
/* Stores that of all elements of a layer, where one_per_layer. */
void volumetric_store_layer(struct volumetric *volumetric, size_t layer,
                            const struct element_volumetric *own);

/* out[e] = p[e] + factor * k v of every element e, where v is the change of volume by displacements
 * u (mesh_degrees_of_freedom values) and k is element_volumetric.stiffness. p and out may be the
 * same. */
void volumetric_pressures(const struct volumetric *volumetric, const double *u, double factor,
                          const double *p, double *out);
/* Adds factor times the forces of pressures p (one an element, positive outward) to force
 * (mesh_degrees_of_freedom values). */
void volumetric_forces(const struct volumetric *volumetric, const double *p, double factor,
                       double *force);
/* out[e] = factor * p[e]; both may be the same. */
void volumetric_scale(const struct volumetric *volumetric, double factor, const double *p,
                      double *out);

#endif
