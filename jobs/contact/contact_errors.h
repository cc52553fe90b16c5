/* The errors of the values on the finest level by source, but the statistical one. They are
 * estimated from differences of pairs, point by point: (reported - true) lies within value +-
 * bound. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_ERRORS_H
#define RUGO_JOBS_CONTACT_CONTACT_ERRORS_H

#include "jobs/contact/contact_error.h"
#include "jobs/contact/tally/contact_tally.h"
#include "schema/result/result.h"

/* Estimates the error of a measure below MEASURE_PAIRED at every load, or
 * point of sliding, into out[contact_case_values]. False, and nothing in out, where nothing is
 * known of the source. */
bool contact_errors(const struct contact_tally *tally, enum contact_measure measure, size_t model,
                    enum error_source source, struct contact_error *out);
/* What solutions hold, in all realisations, on which the error of their solver depends. */
struct solver_counts {
    double tolerance;
    double nodes, open, patches; /* nodes in contact and others; patches: NaN where not known */
};
/* Returns the bound of the error that the tolerance of a solver leaves in a value (F15.16). Gaps
 * are over the RMS height. */
double contact_errors_solver(enum measure_solver solver, const struct solver_counts *of,
                             double value);
/* Returns whether the source bears on a measure of a model. */
bool contact_error_applies(const struct contact_tally *tally, enum contact_measure measure,
                           size_t model, size_t level, enum error_source source);

/* Estimates the change of the difference between a model and the most complete one, from the
 * coarsest level to the limit of the levels, within value +- bound, at every load. False where
 * there is no difference, or one level. */
bool contact_errors_model_change(const struct contact_tally *tally, enum contact_measure measure,
                                 size_t model, struct contact_error *out);

/* Estimates the error of the mesh of the density of pressures at position `at` of pdf_loads, by
 * bin. Bounds are on both sides, from the two finest levels, and at least those of the two bins on
 * either side. Standard errors are those of nodes that fall into bins at random. shares: of the
 * finest level, by contact_tally_pressure_shares; coarse: scratch. All have room for all bins;
 * false where there is one level. */
bool contact_errors_pressures(const struct contact_tally *tally, size_t model, size_t at,
                              const struct estimate *shares, struct estimate *coarse, double *bound,
                              double *standard_error);
/* Bounds the error of the finest level of a density, or of a difference of densities, by its change
 * from the next coarser level, by bin; with the standard errors of the bounds. */
void contact_errors_bins(const struct contact_case *one_case, const struct estimate *change,
                         double *bound, double *standard_error);
/* Raises each bound of n bins to those of the two bins on either side; NaN stays. */
void contact_errors_near_bins(size_t n, double *bound);
/* Returns the relative error of a measure that finer levels of a model do not reduce. */
double contact_errors_mesh_floor(const struct contact_case *one_case, enum contact_measure measure,
                                 size_t model);
/* Returns the change of a density y at x in bin b of n over the relative change of the area. At one
 * load the mean pressure is inverse to the area: q(x) becomes c^2 q(c x). */
double contact_errors_stretch(size_t n, const double *x, const double *y, size_t b);
/* Returns a bound of the same, for an error of either sign. */
double contact_errors_sensitivity(size_t n, const double *x, const double *y, size_t b);
/* Estimates the error of the model of the density of pressures at position `at` of pdf_loads, by
 * bin: the difference on the finest level, within what finer ones may change. shares: as above;
 * room: scratch. All have room for all bins; false where the case counts no pairs, or there is no
 * difference or one level. */
bool contact_errors_density_model(const struct contact_tally *tally, size_t model, size_t at,
                                  const struct estimate *shares, struct estimate *room,
                                  double *value, double *bound, double *standard_error);

#endif
