/* What sub-maps of random surfaces are expected to have, by the spectrum of the surfaces: exactly,
 * without surfaces (FORMULAS.md, F18.38). */
#ifndef RUGO_JOBS_LIKE_LIKE_EXPECTATION_H
#define RUGO_JOBS_LIKE_LIKE_EXPECTATION_H

#include "core/map/preparation/detrend.h"
#include "core/statistics/spectra/map_spectrum.h"

struct like_expectation;
/* rings: of a map as large as the sub-maps, under a window, of which its size, its rings and its
 * holes count; borrowed. kind: of the trend that is taken out of it. ERROR_MEMORY. */
int like_expectation_create(struct like_expectation **out, const struct map_spectrum *rings,
                            enum detrend kind, const struct grid *cell, struct error *err);
void like_expectation_destroy(struct like_expectation **expectation);

/* Fills the density of each ring, rings->rings of them but ring 0, of sub-maps of random surfaces
 * on the cell. spectrum: with its scale, and with the lay of the rings. ERROR_MEMORY, or what
 * modes_create fails with. */
int like_expectation_rings(const struct like_expectation *expectation,
                           const struct spectrum *spectrum, double *density, struct error *err);
/* What waves of about one wave number put into the mean squares of sub-maps: of height about the
 * mean, slope (forward differences) and curvature (central ones). What a trend takes of slopes and
 * curvatures is left out. */
enum { LIKE_MOMENTS = 3 };
struct like_waves {
    double wave_number; /* across the lay; 0: there are none */
    double squares[LIKE_MOMENTS];
};
/* So many an octave, rising, from the longest waves of the cell on. */
enum { LIKE_WAVES_AN_OCTAVE = 32, LIKE_WAVES = 32 * LIKE_WAVES_AN_OCTAVE };
int like_expectation_waves(const struct like_expectation *expectation,
                           const struct spectrum *spectrum, struct like_waves waves[LIKE_WAVES],
                           struct error *err);

#endif
