/* The sum over the components of a case that asks for an error, with its errors
 * (contact_target.h). */
#ifndef RUGO_JOBS_CONTACT_TARGET_CONTACT_SUM_H
#define RUGO_JOBS_CONTACT_TARGET_CONTACT_SUM_H

#include "jobs/contact/contact_errors.h"
#include "jobs/contact/tally/contact_tally.h"
#include "jobs/kind.h"
#include "jobs/target.h"

/* base: the coarsest level on the longest cell that has begun; cell: the same on the next shorter
 * one; mesh: from there to the next level; fine: from that one to the limit; model: from the cheap
 * model to the one that is asked for; model_mesh: the change of that to the limit of the levels, if
 * it has a component of its own. */
enum role { ROLE_BASE, ROLE_CELL, ROLE_MESH, ROLE_FINE, ROLE_MODEL, ROLE_MODEL_MESH, ROLES };

enum { CONTACT_LENGTHS_MOST = 4 };

/* A measure of the answer, by load, or its density of pressures, by bin (contact_density.h): these
 * are its points. The result owns all arrays. Measures that depend on the cell are per longest wave
 * (measure_factor). */
struct contact_sum {
    size_t points;
    double *value, *standard_error, *width; /* width: half of the interval at the confidence */
    double *effective;                      /* realisations of the standard error (result.h) */
    double *base;                           /* of the base alone */
    double *mesh, *cell, *model, *solver;   /* bounds; 0 for a source without a component */
    double *law, *law_standard_error;       /* law_difference; NaN: not known */
    double *length, *length_standard_error; /* of the bound of the cell: the part by the change
                                             * between the two lengths, and its standard error */
    double *mesh_standard_error, *model_standard_error; /* standard errors of these bounds */
    double *variance[ROLES];                            /* of one realisation */
};

struct contact_answer {
    struct target target;
    const struct target_component *of[ROLES]; /* NULL: none; borrowed */
    size_t length_count; /* components on cells of rising length that have begun */
    const struct target_component *lengths[CONTACT_LENGTHS_MOST];
    const struct target_component *longer; /* not begun yet; NULL: none */
    const struct contact_case *one_case;   /* whose loads the answer has */
    const struct contact_model *model;     /* the model that is asked for */
    bool named_mesh;                       /* the answer is for the finest level, not for the
                                            * limit */
    bool densities;                        /* of pressure are asked for */
    bool patch;                            /* it is like a patch, which leaves something open */
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

/* Returns the component by whose levels the limit of the mesh is estimated. */
static inline enum role contact_sum_mesh(const struct contact_answer *answer) {
    return answer->of[ROLE_FINE] != NULL ? ROLE_FINE : ROLE_MESH;
}

/* Returns the component that solves the model that is asked for on the finest mesh; NULL: none. */
static inline const struct target_component *
contact_sum_finest_model(const struct contact_answer *answer) {
    const struct target_component *mesh = answer->of[ROLE_MODEL_MESH];
    return mesh != NULL ? mesh : answer->of[ROLE_MODEL];
}

/* Returns the variance of one realisation from the standard error of a mean. */
static inline double component_variance(const struct target_component *component,
                                        double standard_error) {
    return standard_error * standard_error * (double)component->done;
}

/* Over the change between "base" and "cell", a quarter as long: the largest error that is left, if
 * it falls at least as 1/L. */
#define CELL_SHARE contact_error_left(0.25, 0.5)

/* Non-Gaussian profiles change with their length slowly and not always monotonically, since their
 * heights are generated for each cell. Their areas A on a cell of N shortest waves are within this
 * over N sqrt(A) of those on long ones, whatever the change from L/4. Measured on Weibull profiles,
 * minimum and maximum C = 1 and minimum C = 2, H of 0.6 and 0.8, wavelength ratios 2 and 8, loads
 * of 0.01 to 0.3, cells of 32 and 64 longest waves against 256 and 1024: 0.5 to 1.3, with standard
 * errors of 0.1 to 0.4. On longer cells it is below its statistical error. */
#define HEIGHTS_CELL 1.4
/* Returns that factor for heights of any kurtosis K. Up to 9, that of C = 1, it is the above;
 * beyond, it is multiplied by (K - 1)/8, as the scatter of the root mean square of so few heights
 * grows with K - 1. Measured on tables of quantiles, H = 0.8, ratios 2 and 8, cells of 8 to 64
 * longest waves against 256 (ratio 8) and 1024, loads of 0.01 to 0.3: up to 8.2 +- 0.8 for high
 * peaks and 5.3 +- 0.4 for deep valleys (Weibull, C = 0.5; K = 71, factor 12.3), 1.3 +- 0.2 for
 * plateaus with valleys (K = 14, factor 2.2). */
double contact_heights_cell(const struct heights *heights);

/* A value that is added from a cell of L longest waves a side (its shorter one), over that on a
 * long one, differs from 1 by at most these over L (profiles) or L^2 (surfaces). It is a difference
 * of levels, or one of models whose areas are stretched alike. Measured on profiles of slope 0.1,
 * loads of 0.01 to 0.3, L from 2 to 64: levels 1.3, models 0.7 (Weibull minimum, C = 1; Gaussian
 * ones change less). */
#define LEVELS_CELL 1.6
#define MODELS_CELL 0.8

/* Makes the arrays of a sum, all of zeros. */
int contact_sum_room(const struct contact_answer *answer, size_t points, struct contact_sum *out,
                     struct error *err);
/* Sets the standard errors, their effective realisations and the widths of a sum from the variances
 * of its components. */
void contact_sum_finish(const struct contact_answer *answer, struct contact_sum *sum);
/* Adds to the bound of the cell the error of a value that was added at a point from a shorter cell.
 * share: LEVELS_CELL or MODELS_CELL. */
void contact_sum_bound_added(const struct contact_answer *answer, enum role role, double share,
                             double added, size_t point, struct contact_sum *sum);
/* Sums a measure over the components, all of which have realisations. The arena of the result owns
 * the arrays. */
int contact_sum_create(const struct contact_answer *answer, enum contact_measure measure,
                       struct contact_sum *out, struct error *err);
/* Divides one sum by another at every load. Errors of the two add up linearly, as they may be
 * correlated. */
int contact_sum_quotient(const struct contact_answer *answer, const struct contact_sum *dividend,
                         const struct contact_sum *divisor, struct contact_sum *out,
                         struct error *err);
/* Fills the components that there are as parts of a plan; returns their number. */
size_t contact_sum_parts(const struct contact_answer *answer, const struct contact_sum *sum,
                         struct target_part parts[ROLES]);
/* Returns the work of one realisation: points x transforms of all its loads, levels and models. */
double contact_sum_work(const struct target_component *component);
/* Returns the sum of the bounds at a load of the sources that the target counts. A mesh that the
 * study names is not counted. Sources are independent of each other and of the statistical error,
 * and add up by their squares (JCGM 100 2008, section 5.1); bounds of one source add up linearly.
 */
double contact_sum_bounds(const struct contact_answer *answer, const struct contact_sum *sum,
                          size_t load);

#endif
