/* The measures of a solved load, whatever the model. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_MEASURE_H
#define RUGO_JOBS_CONTACT_CONTACT_MEASURE_H

#include "core/contact/area.h"
#include "core/contact/patches.h"
#include "jobs/contact/measure.h"
#include "jobs/contact/model/model.h"
#include "schema/result/result.h"
#include <math.h>

struct contact_quantities;

/* What measuring on one grid needs; all borrowed. */
struct measure_context {
    const struct contact_case *one_case; /* whose parameters measures may need */
    struct area_workspace *area;
    struct patch_finder *finder;
    struct contact_quantities *quantities; /* quantity/quantity.h */
    double points;                         /* of the grid */
    double rms_slope, rms_height;          /* of the prescribed spectrum */
    bool scaled;                           /* the surface has a scale */
    bool free_space; /* the grid is a map in free space, no cell of fixed sides */
    /* Called by quantities that take long; non-zero ends them with ERROR_STOPPED. NULL: never. */
    int (*stop)(void *context);
    void *stop_context;
    /* Takes the share that is done of quantities that take long; NULL: nothing does. */
    void (*progress)(void *context, double share);
    void *progress_context;
};
/* Returns a value that fits into exact sums, as its square must, too; else NaN. A stiffness so
 * large is that of full contact but for rounding. */
static inline double measure_limited(double value) {
    static const double VALUE_MOST = 1e6;
    return fabs(value) < VALUE_MOST ? value : (double)NAN;
}
/* Returns a stiffness over E* h'/sqrt(m0), from one over E* per length. */
static inline double measure_stiffness(const struct measure_context *context, double stiffness) {
    return measure_limited(stiffness * context->rms_height / context->rms_slope);
}
/* Fills all measures but the fits; NaN for those of quantities that are not asked for. Errors are
 * those of a quantity. */
int contact_measure(const struct measure_context *context, const struct contact_pressed *pressed,
                    double values[MEASURE_OWN], struct error *err);
/* Fits through rising loads, from the areas by edges there: at load k over the loads up to it, in
 * fits[k], one stride behind the other in the order of the measures from MEASURE_KAPPA on. NaN from
 * the first load on that has no area. Of the error function loads of full contact are left out.
 * FORMULAS.md, F16.1 to F16.3. */
void contact_measure_fits(size_t n, const double *loads, const double *edges, double *fits,
                          size_t stride);

/* What a measure that depends on the cell is reported of. */
enum measure_unit { UNIT_CELL, UNIT_WAVE };
/* Returns a measure of one cell over that of a cell that is `cells` of it; NaN for a measure
 * without a limit in large cells. */
double measure_factor(enum measure_cell cell, double cells);
/* Returns the label of a curve with its unit, of a surface of this dimension; the result owns it.
 * NULL: no memory, or a measure without a curve. */
const char *measure_label(const struct measure *measure, enum measure_unit unit, int dimension,
                          struct case_result *result);

#endif
