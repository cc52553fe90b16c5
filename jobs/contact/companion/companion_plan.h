/* The companions of a case: side solves, beside some of its realisations, from which an error of
 * one source is estimated. What one is in a case stands here; companion.h says how it is made. */
#ifndef RUGO_JOBS_CONTACT_COMPANION_COMPANION_PLAN_H
#define RUGO_JOBS_CONTACT_COMPANION_COMPANION_PLAN_H

#include "jobs/contact/contact_level.h"
#include "jobs/contact/measure.h"
#include "jobs/contact/model/model.h"
#include "jobs/subset.h"

/* All companions, in the order in which they are planned and solved. Each may use those before it.
 * A name needs a row, which its file defines by COMPANION_DEFINE (companion.h).
 *
 * LONGER, SHORTER, EQUAL: a surface of its own on a cell of another length, or as long; one series.
 * PROBE: the half-space, series 0, and where blocks are low the block of each model; on the surface
 * of the case.
 * LAW: the surface of the case, series 0, and that of the other law of heights.
 * LIKE: the mirrored sub-map of a surface like a measured one; one series.
 * ASPERITIES: theories by the counted summits of the surface, on the finest level and the next.
 * PATCH: the surface of the case, series 0, and that of parameters which the patch leaves open. */
#define COMPANION_NAMES(NAME)                                                                      \
    NAME(LONGER)                                                                                   \
    NAME(SHORTER) NAME(EQUAL) NAME(PROBE) NAME(LAW) NAME(LIKE) NAME(ASPERITIES) NAME(PATCH)
#define COMPANION_ENTRY(name) COMPANION_##name,
enum companion_name { COMPANION_NAMES(COMPANION_ENTRY) COMPANION_COUNT };
#undef COMPANION_ENTRY

/* A difference that is summed realisation by realisation: a series less another one. */
struct companion_pair {
    size_t of, less;
};
enum { COMPANION_PAIRS_MOST = CONTACT_MODELS_MOST };

struct companion_plan {
    size_t series;     /* how many surfaces or blocks are pressed to all loads; 0: there is none */
    struct subset due; /* the realisations that have it */
    uint64_t draws; /* in each of the first realisations of `due`: surfaces of its own; 0: one, as
                     * in all others */
    struct contact_level level; /* the mesh of all series */
    size_t pair_count;
    struct companion_pair pairs[COMPANION_PAIRS_MOST];
    size_t kept_count; /* measures of every series that stand in the rows of realisations */
    const enum contact_measure *kept;
    /* Of a companion with a surface of its own, else empty. */
    struct surface_case surface; /* borrows from that of the case; its grid is that on which
                                  * surfaces are generated */
    struct surface_band band;    /* of a surface on it */
    double length;               /* of its cell, over that of the case */
};

/* Returns how often the companion is solved in a realisation. */
static inline uint64_t companion_draws(const struct companion_plan *plan, uint64_t realisation) {
    if (!subset_has(&plan->due, realisation))
        return 0;
    return realisation < plan->due.first && plan->draws > 1 ? plan->draws : 1;
}
/* Returns the most of these. */
static inline uint64_t companion_draws_most(const struct companion_plan *plan) {
    return plan->draws > 1 ? plan->draws : 1;
}

#endif
