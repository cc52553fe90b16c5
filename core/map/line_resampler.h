/* A line of heights at other places. Private to map_resample.c. */
#ifndef RUGO_CORE_MAP_LINE_RESAMPLER_H
#define RUGO_CORE_MAP_LINE_RESAMPLER_H

#include "core/error.h"
#include <stddef.h>

struct line_resampler;

/* From `from` points at 0, 1, ... to `to` points `step` apart, in the middle of them; all of these
 * lie between the first and the last of those. ERROR_INPUT for steps above 1 where there are too
 * few points for the kernel. */
int line_resampler_create(struct line_resampler **out, size_t from, size_t to, double step,
                          struct error *err);
void line_resampler_destroy(struct line_resampler **resampler);
void line_resampler_run(struct line_resampler *resampler, const double *from, double *to);

#endif
