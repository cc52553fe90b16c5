/* The sum over the components of a case that asks for an error, and what it errs by
 * (contact_target.h). */
#ifndef RUGO_JOBS_CONTACT_CONTACT_SUM_H
#define RUGO_JOBS_CONTACT_CONTACT_SUM_H

#include "jobs/contact/contact_cell.h"
#include "jobs/contact/contact_errors.h"
#include "jobs/contact/contact_tally.h"
#include "jobs/kind.h"
#include "jobs/target.h"

enum role { ROLE_BASE, ROLE_CELL, ROLE_MESH, ROLE_MODEL, ROLES };

/* A quantity of the answer, by load; all arrays are the result's. */
struct contact_sum {
    double *value, *standard_error, *width; /* width: of the interval at the confidence, half */
    double *mesh, *cell, *model, *solver;   /* bounds; 0 where the source has no component */
    double *variance[ROLES];                /* of one realisation */
};

struct contact_answer {
    struct target target;
    const struct target_component *of[ROLES]; /* NULL: none; borrowed */
    const struct contact_case *one_case;      /* that whose loads are told */
    bool named_mesh;                          /* the finest level stands in place of the limit */
    size_t loads;
    struct case_result *result;
};

static inline const struct contact_case *component_case(const struct target_component *component) {
    return component->study;
}

static inline const struct contact_tally *
component_tally(const struct target_component *component) {
    return component->tally;
}

/* Variance of one realisation behind the standard error of a mean. */
static inline double component_variance(const struct target_component *component,
                                        double standard_error) {
    return standard_error * standard_error * (double)component->done;
}

/* Of the change between "base" and the component "cell", a quarter as long: the most that is left
 * of an error that falls at least as 1/L. */
#define CELL_SHARE contact_cell_share(0.25, 0.5)

/* Of a difference of models on a cell at least four waves long: the most that a longer one changes.
 * Measured on profiles of slope 0.1: 0.1 % of the area, of 2 %. */
#define MODEL_CELL_SHARE 0.05

/* Sums a measure over the components, all of which have realisations. Arrays are of the arena of
 * the result. */
int contact_sum_create(const struct contact_answer *answer, enum contact_measure measure,
                       struct contact_sum *out, struct error *err);
/* The components that there are, as the planner sees them; returns how many. */
size_t contact_sum_parts(const struct contact_answer *answer, const struct contact_sum *sum,
                         struct target_part parts[ROLES]);
/* Work of one realisation: points x transforms of all its loads, levels and models. */
double contact_sum_work(const struct target_component *component);
/* Bounds of the sources that the target counts at a load: of what the study names, none. */
double contact_sum_bounds(const struct contact_answer *answer, const struct contact_sum *sum,
                          size_t load);

#endif
