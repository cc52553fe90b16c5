/* Asking for an error: /target of a study, and how many realisations its components take.
 *
 * The answer of a case is a sum over components, which are independent of each other: one has the
 * value on a cheap mesh by a cheap model, the others what is to be added to it, as means of
 * differences on the same surfaces. The variance of the sum is the sum over components of V/N, V
 * that of one realisation and N their number. At a given variance of the sum it costs least where N
 * goes as sqrt(V/C), C the cost of a realisation (Giles 2008, section 3). */
#ifndef RUGO_JOBS_TARGET_H
#define RUGO_JOBS_TARGET_H

#include "schema/result/result.h"
#include "schema/study/study.h"
#include "schema/study/values.h"
#include <stdint.h>

extern const struct parameter_table TARGET_PARAMETERS;
enum { TARGET_PARTS_MOST = 8 };

/* Curves, or scalars, whose error may be asked for, by kind. */
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
/* Reads it from the parameters of a case with TARGET_PARAMETERS among its tables. A fault where
 * there is no error, or a quantity that is none of those from first to last; unnamed, it is the
 * first. faults may be NULL: the first fault is the error in any case. */
int target_read(struct target *out, const cJSON *parameters,
                const struct parameter_table *const *tables, enum target_quantity first,
                enum target_quantity last, struct fault_list *faults, struct error *err);
/* The name of a quantity in studies and results. */
const char *target_quantity_name(enum target_quantity quantity);

/* What a component is to the planner. */
struct target_part {
    uint64_t done;          /* realisations so far */
    double work;            /* of one, as counted: any unit that all components share */
    double seconds;         /* of one, as estimated */
    const double *variance; /* of one, at each point */
};
struct target_plan {
    const struct target *target;
    size_t points;
    const double *allowed; /* at each point: how far chance may go; NaN: the point is left out */
    double *multipliers;   /* room for as many numbers as there are points */
    double *quantiles;     /* likewise */
};
/* By how many standard errors the sum errs at this confidence, at one point: Student's quantile,
 * its degrees of freedom by Welch and Satterthwaite (Welch 1947). standard_error: of the sum. NaN
 * where a part has no variance. */
double target_quantile(const struct target *target, size_t count, const struct target_part *parts,
                       size_t point, double *standard_error);
/* Numbers of realisations, needed[count], none below what is done, which take the least work of
 * those whose chance is allowed at every point, at the normal quantile: N = sqrt(sum of m V/C over
 * the points, each with a multiplier m). Returns the work that is lacking. At most
 * TARGET_PARTS_MOST parts. */
double target_least_work(const struct target_plan *plan, size_t count,
                         const struct target_part *parts, double *needed);
/* Realisations of each part in all, none below what is done: as many as there are where these are
 * enough, or where more would pass max_seconds. Depends on nothing else than its arguments. */
void target_allot(const struct target_plan *plan, size_t count, const struct target_part *parts,
                  uint64_t *wanted);

/* Shortens a round that would pass the time of the target. */
void target_hold(const struct target *target, size_t count, const struct target_part *parts,
                 uint64_t *wanted);

/* Appends a scalar that is known as it is, such as an error that was reached. */
int target_add_scalar(struct case_result *result, const char *name, double value,
                      struct error *err);

/* Realisations that the components of a case will take in the end, as far as that is known before
 * anything ran, into out[TARGET_PARTS_MOST]; returns the CPU seconds of all. */
double target_expect(const struct study_case *one, uint64_t *out);

#endif
