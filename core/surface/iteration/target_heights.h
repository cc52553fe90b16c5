/* The target heights of a non-Gaussian surface: n values in rising order, mean 0 and standard
 * deviation 1 as a sample. */
#ifndef RUGO_CORE_SURFACE_TARGET_HEIGHTS_H
#define RUGO_CORE_SURFACE_TARGET_HEIGHTS_H

#include "core/random.h"
#include "core/surface/iteration/rank.h"
#include "core/surface/surface_options.h"

/* DRAW_RANDOM: n draws, by quantiles of words 0..n-1 of STREAM_HEIGHTS; DRAW_QUANTILES: the
 * quantiles at (i + 1/2)/n. ranker is one for n values. ERROR_NUMERIC when all heights are equal
 * and cannot be scaled. */
int target_heights_draw(const struct heights *heights, const struct height_moments *moments,
                        enum surface_draw draw, struct random_key key, size_t n,
                        struct ranker *ranker, double *sorted, struct error *err);

#endif
