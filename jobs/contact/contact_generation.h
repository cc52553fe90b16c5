/* What contact owes to the way in which non-Gaussian surfaces are found: beside some realisations
 * the surface is found again in other ways (surface_paths.h), and pressed on a half-space on the
 * coarse mesh of the probe (contact_probe.h), as the own one is. What changes in these pairs is the
 * error "generation" (contact_generation_errors.h).
 *
 * They are so seldom that they take less than a tenth of the case's time, but for the first ones of
 * a small study. Gaussian surfaces are found in one way alone, and have none. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_GENERATION_H
#define RUGO_JOBS_CONTACT_CONTACT_GENERATION_H

#include "core/surface/surface.h"
#include "jobs/contact/contact_coarse.h"

/* The surface of a realisation; all borrowed. */
struct contact_surface {
    struct random_key key;
    const double *z;                     /* heights on the own grid of the case */
    const struct surface_report *report; /* of its generation; NULL: it is not found again */
};

/* Chooses mesh and interval of a case that is read, after its probes. */
void contact_generation_choose(struct contact_case *one_case);

struct contact_generation;
/* Borrows the case. *out is NULL where nothing is found again. moments: of the prescribed spectrum.
 */
int contact_generation_create(struct contact_generation **out, const struct contact_case *one_case,
                              const struct moments *moments, struct error *err);
void contact_generation_destroy(struct contact_generation **generation);
/* Presses the surface and the others where the realisation is one of those, into their cells of the
 * tally, which holds the values of the probe. Where no surface or no answer is found, there are no
 * values. */
int contact_generation_solve(struct contact_generation *generation,
                             const struct contact_surface *surface, struct contact_tally *tally,
                             const struct contact_stopper *stopper, struct error *err);

/* Of this object; and CPU seconds a realisation in the mean, on a 3 GHz core. */
double contact_generation_bytes(const struct contact_case *one_case);
double contact_generation_seconds(const struct contact_case *one_case);

#endif
