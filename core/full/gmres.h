/* One linear step of Newton's: generalised minimal residuals (Saad &
 * Schultz 1986; flexible, Saad 1993), preconditioned by the flat block standing on the same nodes:
 * its stiffness is inverted exactly by waves (preconditioner.h), its contact forces come from the
 * face alone (face_solver.h). What is left to iterate is how far the rough block differs from the
 * flat one: about four iterations at RMS slopes of 0.1, whatever the number of nodes.
 *
 * Nearly incompressible blocks differ more: what keeps the volume of a flat element changes that of
 * a rough one, by as much as the bulk modulus is large. There the pressure of each element is an
 * unknown of its own, p - k v = 0 beside the forces (v the change of volume that displacements
 * make, k the bulk modulus over the volume; Brezzi & Fortin 1991), in the flat block as in the
 * rough one: they differ by their slopes again.
 *
 * Where even that is too far, as it is for steep blocks, a factorisation of the tangent itself
 * (factorisation.h), of displacements alone, takes the flat block's place. With the dual weighting
 * it is exact. */
#ifndef RUGO_CORE_FULL_GMRES_H
#define RUGO_CORE_FULL_GMRES_H

#include "core/full/face_solver.h"
#include "core/full/factorisation.h"
#include "core/full/tangent.h"

struct gmres;

int gmres_create(struct gmres **out, const struct mesh *mesh, const struct material *material,
                 enum gap_weighting weighting, struct error *err);
void gmres_destroy(struct gmres **gmres);

/* Memory that is touched by so many iterations a linear step. */
double gmres_bytes(const struct mesh *mesh, const struct material *material, double iterations);

/* Whether the tangent has to tell its volumetric part apart. */
bool gmres_needs_pressures(const struct material *material);

/* The weighted values of the face's nodes. */
void gmres_weigh(const struct gmres *gmres, const double *in, double *out);
/* What is to be solved; borrows all. */
struct linear_system {
    const struct tangent *tangent;
    const bool *active;                  /* face */
    struct factorisation *factorisation; /* of that tangent and set; NULL: the flat block serves */
};

/* x, tangent_unknowns: in, forces, with the far side's vertical ones at its first node, and on
 * vertical degrees_of_freedom in contact the change asked of the weighted gap, and the excess of
 * pressures; out, displacements and pressures. Ends when the residual is `tolerance` of what it
 * was; ERROR_NUMERIC when it does not get there. Adds to *iterations. */
int gmres_solve(struct gmres *gmres, const struct linear_system *system, double tolerance,
                double *x, size_t *iterations, struct error *err);

#endif
