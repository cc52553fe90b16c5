/* What a measured map is like: all that `rugo characterise` reports, as numbers. */
#ifndef RUGO_JOBS_MAPS_MAP_CHARACTERISATION_H
#define RUGO_JOBS_MAPS_MAP_CHARACTERISATION_H

#include "core/map/form.h"
#include "core/map/preparation/preparation.h"
#include "core/statistics/grooves/map_grooves.h"
#include "core/statistics/heights/areal.h"
#include "core/statistics/heights/height_fit.h"
#include "core/statistics/uncertainty/map_directions.h"
#include "core/statistics/uncertainty/stationarity.h"
#include "jobs/maps/map_extent.h"
#include "jobs/maps/map_functional.h"
#include "jobs/maps/map_parameters.h"
#include "jobs/maps/map_scales.h"
#include "jobs/maps/map_spectra.h"

/* Points of a curve; y is owned by x. */
struct map_curve {
    size_t count;
    double *x, *y;
};

enum { HISTOGRAM_BINS_MOST = 80 };
/* Heights counted in even bins from the lowest to the highest. */
struct map_histogram {
    size_t count;      /* of bins; 0: all heights are the same */
    double low, width; /* of the first bin, and of each */
    double total;      /* heights */
    double counts[HISTOGRAM_BINS_MOST];
};

/* How well one map determines its parameters. */
struct map_certainty {
    bool has_errors;
    const char *reason; /* "standard", or why there are none; static */
    double lengths;     /* correlation lengths inside */
    double freedom;     /* degrees of freedom of the errors; NaN without errors, as the next */
    double factor;      /* standard errors to either side of a 95 % interval */
};

struct map_characterisation {
    struct map_parameters parameters;
    struct areal areal; /* of surfaces alone, as `directions` */
    struct map_functional functional;
    bool hills_have_errors;
    struct summit_errors hill_errors; /* of areal.spd and areal.spc */
    struct map_certainty certainty;
    struct scalar_errors errors;        /* where there are errors */
    struct scalar_errors moment_errors; /* of parameters.moments, likewise */
    struct height_fits height_fits;
    struct map_histogram histogram;
    struct map_directions directions;
    struct stationarity stationarity; /* p-values NaN without errors, and no spreads */
    double stationarity_p_value;      /* of all divisions together */
    struct map_form form;             /* that is left */
    struct map_scales scales;
    struct map_grooves grooves;
    double rest_height;           /* RMS height without them; NaN where there are none */
    struct map_spectra spectra;   /* of the map without grooves */
    struct map_curve correlation; /* radial: lag, autocorrelation */
    struct map_curve quantiles;   /* probability, height; empty for few heights */
};
/* Fills *out, {0} at first, which the caller clears in any case. The map is as preparation_run left
 * it, with its record. The spectrum is fitted over the wavelengths of `trusted` (spectrum_range.h),
 * {0} where they follow from the map. ERROR_INPUT where these leave no wave; ERROR_MEMORY. */
int map_characterise(struct map_characterisation *out, const struct height_map *map,
                     const struct preparation_record *record,
                     const struct spectrum_fit_request *trusted, enum map_extent extent,
                     struct error *err);
void map_characterisation_clear(struct map_characterisation *characterisation);
/* Returns whether two laws of heights stand out, that of a plateau above valleys, where no Gaussian
 * one holds and there are no grooves. */
bool map_is_stratified(const struct map_characterisation *characterisation);

/* The distribution that fits the heights best, ready to be drawn. */
struct map_height_law {
    struct heights heights;
    struct height_moments moments;
};
/* Returns false where none fits, or where it is the normal one. */
bool map_height_law_find(struct map_height_law *out,
                         const struct map_characterisation *characterisation);
/* Returns its density at a height x, with this mean and standard deviation. */
double map_height_law_density(const struct map_height_law *law, double x, double mean,
                              double deviation);

#endif
