/* The law of heights that are not Gaussian: what /surface/heights/law stands for. */
#ifndef RUGO_JOBS_SURFACE_SURFACE_LAW_H
#define RUGO_JOBS_SURFACE_SURFACE_LAW_H

#include "core/surface/surface_options.h"
#include "core/surface/translation/translation.h"
#include "schema/study/study.h"
#include "schema/study/values.h"

struct surface_law {
    struct translation *translation; /* owned; NULL: Gaussian heights, or iterated ones */
    double height;                   /* RMS height of surfaces on their grid, with a translation */
};

/* As study_kind.fill has it: where the law is a translation, the amplitudes that a study leaves out
 * are random. */
int surface_law_complete(const cJSON *document, cJSON *parameters, struct error *err);

/* Finds the translation of a surface whose other values fit together, where that is its law, and
 * gives it to the spectrum. Adds faults for values that belong to the iteration, and where no such
 * field comes near the spectrum. Fails only with ERROR_MEMORY. */
int surface_law_fill(struct surface_law *out, struct spectrum *spectrum, const struct grid *grid,
                     const struct surface_options *options, struct values *values,
                     struct error *err);
void surface_law_clear(struct surface_law *law);

/* Fills what is known of the law, where there is a translation. */
void surface_law_estimate(const struct surface_law *law, struct study_cost *out);

#endif
