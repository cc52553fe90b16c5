/* The surface of a case on the coarse mesh of a companion. */
#ifndef RUGO_JOBS_CONTACT_COMPANION_COMPANION_OWN_H
#define RUGO_JOBS_CONTACT_COMPANION_COMPANION_OWN_H

#include "jobs/contact/companion/companion.h"

/* Where a companion presses the surface of the case; all borrowed. */
struct companion_own {
    struct coarse_solver *halfspace;
    const struct contact_level *level; /* that of coarse_level */
    double rms_height;                 /* of the surfaces */
    double *z;                         /* room for heights on the level */
};
/* Fills a series: presses the surface of the case, or copies the values of the probe, which has
 * pressed it on the same mesh if it was due. */
int companion_press_own(const struct companion_own *own, const struct contact_surface *surface,
                        struct contact_tally *tally, double *series,
                        const struct contact_stopper *stopper, struct error *err);

#endif
