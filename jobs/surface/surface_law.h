/* The law of heights that are not Gaussian: what /surface/heights/law stands for. */
#ifndef RUGO_JOBS_SURFACE_SURFACE_LAW_H
#define RUGO_JOBS_SURFACE_SURFACE_LAW_H

#include "core/surface/surface_options.h"
#include "core/surface/translation/translation.h"
#include "schema/study/study.h"
#include "schema/study/values.h"

/* As study_kind.fill has it: where the law is a translation, the amplitudes that a study leaves out
 * are random. */
int surface_law_complete(const cJSON *document, cJSON *parameters, struct error *err);

/* Finds the translation of a surface whose other values fit together, which the caller owns, and
 * gives it to the spectrum; NULL for Gaussian heights and iterated ones. Adds faults for values
 * that belong to the iteration, and where no such field comes near the spectrum. Its cost does not
 * depend on the cell. Fails only with ERROR_MEMORY. */
int surface_law_fill(struct translation **out, struct spectrum *spectrum, int dimension,
                     const struct surface_options *options, struct values *values,
                     struct error *err);

/* Fills what is known of a translation; does nothing for NULL. */
void surface_law_estimate(const struct translation *translation, struct study_cost *out);

#endif
