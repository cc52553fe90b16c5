/* Displacements of the face of a periodic elastic half-space under pressures and shear tractions,
 * wave by wave (F24.1). Private to core/contact/slip.
 *
 * Fields are numbered: NORMAL is the pressure, and the displacement into the block; ALONG_X and
 * ALONG_Y are the tractions on the face, and its displacements along them. Tractions are in units
 * of E* = E/(1 - nu^2), displacements in the grid's length, of mean 0. A profile, in plane strain,
 * has no ALONG_Y. */
#ifndef RUGO_CORE_CONTACT_SLIP_TRANSFER_H
#define RUGO_CORE_CONTACT_SLIP_TRANSFER_H

#include "core/surface/transform.h"

enum { NORMAL, ALONG_X, ALONG_Y, FIELDS };

struct transfer {
    struct grid grid;
    size_t fields; /* 2 of profiles, 3 of surfaces */
    double poisson;
    struct transform *plans[FIELDS]; /* owned, one a field */
    double transforms;               /* made so far, forward and inverse */
};

/* poisson in [0, 0.5]. ERROR_INPUT for others, or for a grid out of range; ERROR_MEMORY. */
int transfer_create(struct transfer *out, const struct grid *grid, double poisson,
                    struct error *err);
void transfer_clear(struct transfer *transfer);
double transfer_bytes(const struct grid *grid);

/* out = C in, grid_points a field; in and out may be the same. A field of in that is NULL is 0, and
 * one of out that is NULL is not computed. C is symmetric; on fields of mean 0 it is positive. */
void transfer_apply(struct transfer *transfer, double *const in[FIELDS], double *const out[FIELDS]);
/* out = M in, likewise, where M is about the inverse of C without the coupling of NORMAL to the
 * others: a preconditioner. M is symmetric; on fields of mean 0 it is positive. */
void transfer_precondition(struct transfer *transfer, double *const in[FIELDS],
                           double *const out[FIELDS]);

/* Returns the product of two fields, or vectors of fields, of n values. */
static inline double transfer_dot(size_t n, const double *a, const double *b) {
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

#endif
