/* The law of heights that are not Gaussian: what /surface/heights/law stands for. */
#ifndef RUGO_JOBS_SURFACE_SURFACE_LAW_H
#define RUGO_JOBS_SURFACE_SURFACE_LAW_H

#include "jobs/surface/surface_case.h"
#include "schema/study/study.h"

/* As study_kind.fill has it: where the law is a translation, the amplitudes that a study leaves out
 * are random. */
int surface_law_complete(const cJSON *document, cJSON *parameters, struct error *err);

/* Finds the translation of a surface whose other values fit together, where that is its law. Adds
 * faults for values that belong to the iteration, and where no such field comes near the spectrum.
 * Fails only with ERROR_MEMORY. */
int surface_law_fill(struct surface_case *surface, struct values *values, struct error *err);

/* Fills what is known of the law, where the surface has one. */
void surface_law_estimate(const struct surface_case *surface, struct study_cost *out);

#endif
