/* The sum over the components of a case that asks for an error, and what it errs by
 * (contact_target.h). */
#ifndef RUGO_JOBS_CONTACT_CONTACT_SUM_H
#define RUGO_JOBS_CONTACT_CONTACT_SUM_H

#include "jobs/contact/contact_cell.h"
#include "jobs/contact/contact_errors.h"
#include "jobs/contact/contact_tally.h"
#include "jobs/kind.h"
#include "jobs/target.h"

/* base: the coarsest level on the longest cell that has begun; cell: the same on the next shorter
 * one; mesh: from there to the next level; fine: from that one to the limit; model: from the cheap
 * model to the one that is asked for; model_mesh: what that changes to the limit of the levels,
 * where it has a component of its own. */
enum role { ROLE_BASE, ROLE_CELL, ROLE_MESH, ROLE_FINE, ROLE_MODEL, ROLE_MODEL_MESH, ROLES };

enum { CONTACT_LENGTHS_MOST = 4 };

/* A quantity of the answer, by load; all arrays are the result's. */
struct contact_sum {
    double *value, *standard_error, *width; /* width: of the interval at the confidence, half */
    double *base;                           /* of the base alone */
    double *mesh, *cell, *model, *solver;   /* bounds; 0 where the source has no component */
    double *generation;                     /* likewise; 0 where it is not probed */
    double *length, *length_chance;     /* of the bound of the cell: what the change between the two
                                           lengths tells, and how far chance may bring it */
    double *mesh_chance, *model_chance; /* how far chance may bring these bounds */
    double *variance[ROLES];            /* of one realisation */
};

struct contact_answer {
    struct target target;
    const struct target_component *of[ROLES]; /* NULL: none; borrowed */
    size_t length_count; /* components on cells of rising length that have begun */
    const struct target_component *lengths[CONTACT_LENGTHS_MOST];
    const struct target_component *longer; /* not begun yet; NULL: none */
    const struct contact_case *one_case;   /* that whose loads are told */
    const struct contact_model *model;     /* that is asked for */
    bool named_mesh;                       /* the finest level stands in place of the limit */
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

/* The component whose levels tell the limit of the mesh. */
static inline enum role contact_sum_mesh(const struct contact_answer *answer) {
    return answer->of[ROLE_FINE] != NULL ? ROLE_FINE : ROLE_MESH;
}

/* The component that solves the model that is asked for on the finest mesh; NULL: none. */
static inline const struct target_component *
contact_sum_finest_model(const struct contact_answer *answer) {
    const struct target_component *mesh = answer->of[ROLE_MODEL_MESH];
    return mesh != NULL ? mesh : answer->of[ROLE_MODEL];
}

/* Variance of one realisation behind the standard error of a mean. */
static inline double component_variance(const struct target_component *component,
                                        double standard_error) {
    return standard_error * standard_error * (double)component->done;
}

/* Of the change between "base" and the component "cell", a quarter as long: the most that is left
 * of an error that falls at least as 1/L. */
#define CELL_SHARE contact_cell_share(0.25, 0.5)

/* Non-Gaussian profiles change with their length slowly and not always one way, since their heights
 * are made for each cell: their areas A on a cell of N shortest waves are within this over N
 * sqrt(A) of those on long ones, whatever the change from L/4. Measured on Weibull profiles,
 * minimum and maximum C = 1 and minimum C = 2, H of 0.6 and 0.8, wavelength ratios 2 and 8, loads
 * of 0.01 to 0.3, cells of 32 and 64 longest waves against 256 and 1024: 0.5 to 1.3, with standard
 * errors of 0.1 to 0.4; on longer cells chance hides it. */
#define HEIGHTS_CELL 1.4
/* Returns that of heights of any kurtosis K: up to 9, that of C = 1, the above; from there on times
 * (K - 1)/8, as what so few heights change in their root mean square grows with K - 1. Measured on
 * tables of quantiles, H = 0.8, ratios 2 and 8, cells of 8 to 64 longest waves against 256 (ratio
 * 8) and 1024, loads of 0.01 to 0.3: up to 8.2 +- 0.8 for high peaks and 5.3 +- 0.4 for deep
 * valleys (Weibull, C = 0.5; K = 71, 12.3 is counted), 1.3 +- 0.2 for plateaus with valleys (K =
 * 14, 2.2). */
double contact_heights_cell(const struct heights *heights);

/* What is added on a cell of L longest waves a side (its shorter one), over its value on a long
 * one, is within these over L (profiles) or L^2 (surfaces) of 1: a difference of levels, and one of
 * models whose areas are stretched alike. Measured on profiles of slope 0.1, loads of 0.01 to 0.3,
 * L from 2 to 64: levels 1.3, models 0.7 (Weibull minimum, C = 1; Gaussian ones change less). */
#define LEVELS_CELL 1.6
#define MODELS_CELL 0.8

/* Sums a measure over the components, all of which have realisations. Arrays are of the arena of
 * the result. */
int contact_sum_create(const struct contact_answer *answer, enum contact_measure measure,
                       struct contact_sum *out, struct error *err);
/* The components that there are, as the planner sees them; returns how many. */
size_t contact_sum_parts(const struct contact_answer *answer, const struct contact_sum *sum,
                         struct target_part parts[ROLES]);
/* Work of one realisation: points x transforms of all its loads, levels and models. */
double contact_sum_work(const struct target_component *component);
/* What the bounds of the sources that the target counts come to at a load: of what the study names
 * none. generation: with that of the surfaces, which no realisations lessen. Sources are
 * independent of each other and of chance, so that they add up by their squares (JCGM 100 2008,
 * section 5.1), those of one source as they are. */
double contact_sum_bounds(const struct contact_answer *answer, const struct contact_sum *sum,
                          size_t load, bool generation);

#endif
