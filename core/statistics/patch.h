/* What is measured of a patch: a sub-map of a surface that does not repeat, such as an instrument
 * sees. Measured surfaces and sub-maps of random ones have the same parameters, so that they can be
 * compared. */
#ifndef RUGO_CORE_STATISTICS_PATCH_H
#define RUGO_CORE_STATISTICS_PATCH_H

#include "core/statistics/measured_map.h"

/* ENTRY(quantity, name, power): a quantity has the unit of length to this power; that of
 * PATCH_AREAL is -2, and -1 of a profile. */
#define PATCH_QUANTITIES(ENTRY)                                                                    \
    ENTRY(RMS_HEIGHT, "rms_height", 1)                                                             \
    ENTRY(RMS_SLOPE, "rms_slope", 0)                                                               \
    ENTRY(RMS_CURVATURE, "rms_curvature", -1)                                                      \
    ENTRY(SKEWNESS, "skewness", 0)                                                                 \
    ENTRY(KURTOSIS, "kurtosis", 0)                                                                 \
    ENTRY(LOWEST, "lowest", 1)                                                                     \
    ENTRY(HIGHEST, "highest", 1)                                                                   \
    ENTRY(NAYAK_ALPHA, "nayak_alpha_finite_difference", 0)                                         \
    ENTRY(CORRELATION_LENGTH, "correlation_length", 1)                                             \
    ENTRY(TEXTURE, "texture_aspect", 0)                                                            \
    ENTRY(SUMMIT_DENSITY, "summit_density", PATCH_AREAL)                                           \
    ENTRY(SUMMIT_HEIGHT_MEAN, "summit_height_mean", 1)                                             \
    ENTRY(SUMMIT_HEIGHT_DEVIATION, "summit_height_deviation", 1)                                   \
    ENTRY(SUMMIT_CURVATURE_MEAN, "summit_curvature_mean", -1)                                      \
    ENTRY(PIT_DENSITY, "pit_density", PATCH_AREAL)                                                 \
    ENTRY(PIT_HEIGHT_MEAN, "pit_height_mean", 1)                                                   \
    ENTRY(PIT_HEIGHT_DEVIATION, "pit_height_deviation", 1)                                         \
    ENTRY(PIT_CURVATURE_MEAN, "pit_curvature_mean", -1)
#define PATCH_AREAL (-2) /* of a profile: -1 */
#define PATCH_NUMBER(quantity, name, power) PATCH_##quantity,
enum patch_quantity { PATCH_QUANTITIES(PATCH_NUMBER) PATCH_QUANTITY_COUNT };
#undef PATCH_NUMBER
extern const char *const PATCH_NAMES[PATCH_QUANTITY_COUNT];
/* Returns the power of the unit of length that a quantity has. */
int patch_power(enum patch_quantity quantity, bool profile);

/* Measures a map as an open one, which it must be: roughness by finite differences (FORMULAS.md,
 * F18.2), the shortest lag at which the autocorrelation is 0.2 and its share of the longest such
 * lag (F18.8). Summits and pits are found by nine points, of profiles by three. Heights of summits
 * are about the mean of the map; those of pits are depths, with curvatures as of summits. NaN: what
 * the map does not have. ERROR_MEMORY, or what a correlation fails with. */
int patch_measure(const struct measured_map *map, double out[PATCH_QUANTITY_COUNT],
                  struct error *err);

#endif
