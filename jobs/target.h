/* Studies that ask for an error: /target of a study, and the realisations that its components need.
 *
 * The answer of a case is a sum over components, which are independent of each other. One has the
 * value on a cheap mesh by a cheap model; the others add corrections, as means of differences on
 * the same surfaces. The variance of the sum is the sum over components of V/N, V that of one
 * realisation and N their number. At a given variance of the sum the cost is least where N goes as
 * sqrt(V/C), C the cost of a realisation (Giles 2008, section 3). */
#ifndef RUGO_JOBS_TARGET_H
#define RUGO_JOBS_TARGET_H

#include "schema/result/result.h"
#include "schema/study/study.h"
#include "schema/study/values.h"
#include <stdint.h>

extern const struct parameter_table TARGET_PARAMETERS;
enum { TARGET_PARTS_MOST = 8 };

/* The curves, or scalars, by kind, whose error may be asked for. */
enum target_quantity {
    TARGET_UNNAMED,
    TARGET_CONTACT_AREA, /* of contact, as the next */
    TARGET_MEAN_GAP,
    TARGET_SUMMIT_DENSITY, /* of statistics, as the next two */
    TARGET_SUMMIT_HEIGHT_PDF,
    TARGET_SUMMIT_CURVATURE_PDF
};
struct target {
    double error, confidence;
    enum target_quantity quantity;
    double max_seconds; /* of CPU; INFINITY */
};
/* Reads a target from the parameters of a case with TARGET_PARAMETERS among its tables. A missing
 * error is a fault, and so is a quantity outside first to last; the default is the first. faults
 * may be NULL: the first fault is the error in any case. */
int target_read(struct target *out, const cJSON *parameters,
                const struct parameter_table *const *tables, enum target_quantity first,
                enum target_quantity last, struct fault_list *faults, struct error *err);
/* Adds a fault for each parameter that the document of a study gives and that a target refuses. */
void target_refuse(const cJSON *document, const struct parameter_table *const *tables,
                   struct fault_list *faults);
/* Returns the name of a quantity in studies and results. */
const char *target_quantity_name(enum target_quantity quantity);

/* A component, as the plan needs it. */
struct target_part {
    uint64_t done;          /* realisations so far */
    double work;            /* of one, in any unit that all components share */
    double seconds;         /* of one, as estimated */
    const double *variance; /* of one, at each point */
};
struct target_plan {
    const struct target *target;
    size_t points;
    const double *allowed; /* largest statistical error at each point; NaN: the point is left out */
    double *multipliers;   /* room for a number for each point */
    double *quantiles;     /* likewise */
};
/* Returns by how many standard errors the sum may err at a point at this confidence: Student's
 * quantile, with degrees of freedom by Welch and Satterthwaite (Welch 1947). standard_error: of the
 * sum. NaN where a part has no variance. At most TARGET_PARTS_MOST parts. */
double target_quantile(const struct target *target, size_t count, const struct target_part *parts,
                       size_t point, double *standard_error);
/* Computes the numbers of realisations, needed[count], none below what is done, that take the least
 * work at the normal quantile and keep the statistical error within what is allowed at every point:
 * N = sqrt(sum of m V/C over the points, each with a multiplier m). Returns the work that is
 * lacking. At most TARGET_PARTS_MOST parts. */
double target_least_work(const struct target_plan *plan, size_t count,
                         const struct target_part *parts, double *needed);
/* Computes the realisations of each part in all, none below what is done. They stay as they are if
 * they suffice, and grow no further than max_seconds allows. Depends on its arguments alone. */
void target_allot(const struct target_plan *plan, size_t count, const struct target_part *parts,
                  uint64_t *wanted);

/* Shortens a round that would exceed the time of the target. */
void target_hold(const struct target *target, size_t count, const struct target_part *parts,
                 uint64_t *wanted);

/* Appends a scalar without a standard error, such as an error that was reached. */
int target_add_scalar(struct case_result *result, const char *name, double value,
                      struct error *err);

/* Estimates the realisations that the components of a case will need, as far as that is known
 * before anything ran, into out[TARGET_PARTS_MOST]; returns the CPU seconds of all. */
double target_expect(const struct study_case *one, uint64_t *out);

#endif
