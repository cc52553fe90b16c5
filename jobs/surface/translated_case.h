/* The Gaussian field g behind the heights of a case, z = f(g): that of its own law, or of the
 * translation with the spectrum and the heights of an iterated case. Exact theory of summits
 * follows from it (FORMULAS.md, F6.12 and F13.6). */
#ifndef RUGO_JOBS_SURFACE_TRANSLATED_CASE_H
#define RUGO_JOBS_SURFACE_TRANSLATED_CASE_H

#include "core/theory/translated_summits.h"
#include "jobs/surface/surface_case.h"

/* Returns whether theory of summits applies to a Gaussian field of these moments: its spectrum is
 * isotropic and has finite moments, and an alpha above 3/2 (profiles: 1). */
bool translated_case_applies(const struct surface_case *surface, const struct moments *gaussian);

struct translated_case {
    bool exists; /* and theory of summits applies to it */
    struct translated_surface surface;
    struct translation *beside; /* owned: that of an iterated case; else NULL */
};
/* modes: of the prescribed spectrum. Borrows both. None exists for Gaussian heights, and where no
 * translation has the spectrum within OTHER_LAW_MISFIT (other_law.h). Takes some tens of
 * milliseconds beside iterated surfaces. ERROR_MEMORY alone. */
int translated_case_create(struct translated_case *out, const struct surface_case *surface,
                           const struct modes *modes, struct error *err);
void translated_case_clear(struct translated_case *translated);

#endif
