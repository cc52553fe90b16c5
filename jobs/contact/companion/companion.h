/* A companion: one row of a table, filled in one file companion_NAME.c, and a name in the list of
 * companion_plan.h. The scene, the cost, the tally, the rows of results and the errors walk the
 * table; nothing else names a companion.
 *
 * Life: plan (of a case that is read) -> create (for one thread) -> solve (a realisation that is
 * due) ... -> clear; then its errors from the sums of a tally. */
#ifndef RUGO_JOBS_CONTACT_COMPANION_COMPANION_H
#define RUGO_JOBS_CONTACT_COMPANION_COMPANION_H

#include "core/surface/surface.h"
#include "jobs/contact/companion/coarse_solver.h"
#include "jobs/contact/contact_error.h"
#include "jobs/contact/tally/contact_tally.h"
#include "schema/result/result.h"

/* The surface of a realisation; all borrowed. */
struct contact_surface {
    struct random_key key;
    const double *z; /* heights on the grid of the case */
};

/* plan: that of the companion in the case. All functions borrow their arguments. */
struct companion {
    const char *what;         /* "a longer cell": in messages */
    const char *parameter;    /* by whose choice COMPANION_NONE it is left out; NULL: by none */
    enum error_source source; /* ERROR_SOURCES: none. The first of several companions of a source
                               * computes its errors */
    /* Fills an empty plan from a case that is read, with the plans before it; false where the case
     * has no such companion. A choice must not depend on the memory of this machine. */
    bool (*plan)(const struct contact_case *one_case, struct companion_plan *out);
    size_t size; /* of its workspace */
    /* Fills a workspace of zeros, which is cleared even after a failure. moments: of the prescribed
     * spectrum. */
    int (*create)(void *workspace, const struct contact_case *one_case,
                  const struct companion_plan *plan, const struct moments *moments,
                  struct error *err);
    void (*clear)(void *workspace);
    /* Return the bytes of a workspace, and the CPU seconds of one solve on a 3 GHz core. */
    double (*bytes)(const struct contact_case *one_case, const struct companion_plan *plan);
    double (*seconds)(const struct contact_case *one_case, const struct companion_plan *plan);
    /* Fills the series of `out`, its part of the tally, which has the values of the models and of
     * the companions before it. Without a surface or a solution there are no values. */
    int (*solve)(void *workspace, const struct contact_surface *surface,
                 struct contact_tally *tally, struct companion_tally *out,
                 const struct contact_stopper *stopper, struct error *err);
    /* Returns whether the source bears on a model of a case. NULL without a source, as the next. */
    bool (*applies)(const struct contact_case *one_case, size_t model);
    /* Estimates the error of a measure below MEASURE_PAIRED at every load, into out[load_count].
     * False where nothing is known of it, also in a case without the companion. */
    bool (*errors)(const struct contact_tally *tally, enum contact_measure measure, size_t model,
                   struct contact_error *out);
    /* Appends curves and scalars of its own to a result. NULL: it has none. */
    int (*curves)(const struct contact_tally *tally, struct case_result *out, struct error *err);
};

/* Defines the row of a name, with all members in their order; `workspace` is the type of its
 * workspace. A row that lacks one does not compile, nor does a name without a row link. */
#define COMPANION_DEFINE(name, what, parameter, source, plan, workspace, create, clear, bytes,     \
                         seconds, solve, applies, errors, curves)                                  \
    const struct companion COMPANION_ROW_##name = {                                                \
        what,  parameter, source, plan,  sizeof(workspace), create, clear, bytes, seconds,         \
        solve, applies,   errors, curves};
#define COMPANION_DECLARE(name) extern const struct companion COMPANION_ROW_##name;
COMPANION_NAMES(COMPANION_DECLARE)
#undef COMPANION_DECLARE

extern const struct companion *const COMPANIONS[COMPANION_COUNT];
/* Returns the companion that estimates the errors of a source; NULL: none does. */
const struct companion *companion_of(enum error_source source);

/* Plans the companions of a case that is read. values: of its study. */
void companions_plan(struct contact_case *one_case, struct values *values);
/* Return the bytes of the companions of a case, their mean CPU seconds a realisation, and the
 * CPU seconds that they take beyond that in a realisation. */
double companions_bytes(const struct contact_case *one_case);
double companions_seconds(const struct contact_case *one_case);
double companions_beyond_seconds(const struct contact_case *one_case, uint64_t realisation);
int companions_curves(const struct contact_tally *tally, struct case_result *out,
                      struct error *err);

/* The workspaces of the companions of a case, for one thread. */
struct companion_bench;
/* Borrows the case. moments: of the prescribed spectrum. */
int companion_bench_create(struct companion_bench **out, const struct contact_case *one_case,
                           const struct moments *moments, struct error *err);
void companion_bench_destroy(struct companion_bench **bench);
/* Solves the companions of a realisation into a tally that has the values of its models. Non-zero
 * of the stopper ends it with ERROR_STOPPED. */
int companion_bench_solve(struct companion_bench *bench, const struct contact_surface *surface,
                          struct contact_tally *tally, const struct contact_stopper *stopper,
                          struct error *err);

/* Presses a measured map, heights in lambda_s without its trend, as the sub-maps of random surfaces
 * are: area by edges and mean gap/sqrt(m0) at each load of a case with surfaces like it. NaN where
 * no solution is found. */
int companion_like_measure(const struct contact_case *one_case, const double *z, double *areas,
                           double *gaps, struct error *err);

#endif
