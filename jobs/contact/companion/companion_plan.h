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
 * LONGER, SHORTER: a surface on a cell of another length; one series.
 * PROBE: the half-space, series 0, and where blocks are low the block of each model; on the surface
 * of the case.
 * LAW: the surface of the case, series 0, and that of the other law of heights.
 * LIKE: the mirrored sub-map of a surface like a measured one; one series. */
#define COMPANION_NAMES(NAME) NAME(LONGER) NAME(SHORTER) NAME(PROBE) NAME(LAW) NAME(LIKE)
#define COMPANION_ENTRY(name) COMPANION_##name,
enum companion_name { COMPANION_NAMES(COMPANION_ENTRY) COMPANION_COUNT };
#undef COMPANION_ENTRY

/* A difference that is summed realisation by realisation: a series, or a model of the case on its
 * coarsest level, less another series. */
struct companion_pair {
    bool of_model;
    size_t of, less;
};
enum { COMPANION_PAIRS_MOST = CONTACT_MODELS_MOST + 1, COMPANION_FACTS_MOST = 1 };

struct companion_plan {
    size_t series;     /* how many surfaces or blocks are pressed to all loads; 0: there is none */
    struct subset due; /* the realisations that have it */
    struct contact_level level; /* the mesh of all series */
    size_t pair_count;
    struct companion_pair pairs[COMPANION_PAIRS_MOST];
    size_t fact_count; /* numbers of a realisation that are summed beside its measures */
    size_t kept_count; /* measures of every series that stand in the rows of realisations */
    const enum contact_measure *kept;
    /* Of a companion with a surface of its own, else empty. */
    struct surface_case surface; /* borrows from that of the case; its grid is that on which
                                  * surfaces are generated */
    struct surface_band band;    /* of a surface on it */
    double length;               /* of its cell, over that of the case */
};

#endif
