/* What is measured of a solved load, whatever the model. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_MEASURE_H
#define RUGO_JOBS_CONTACT_CONTACT_MEASURE_H

#include "core/contact/area.h"
#include "core/contact/patches.h"
#include "jobs/contact/measure.h"
#include "jobs/contact/model.h"

/* What measuring on one grid takes; all borrowed. */
struct contact_meter {
    struct area_workspace *area;
    struct patch_finder *finder;
    double points;                /* of the grid */
    double rms_slope, rms_height; /* of the prescribed spectrum */
    bool scaled;                  /* which gives the surface lengths of its own */
};
/* Fills all measures but the fits. */
void contact_measure(const struct contact_meter *meter, const struct contact_pressed *pressed,
                     double values[MEASURE_OWN]);
/* The fits through rising loads, from the areas by edges there: at load k those over the loads up
 * to it. NaN from the first load on that has no area. FORMULAS.md, F16.1 and F16.2. */
void contact_measure_fits(size_t n, const double *loads, const double *edges, double *kappa,
                          double *power_law_a, double *power_law_b);

#endif
