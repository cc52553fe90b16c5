/* The "surface" part of a case, shared by every kind and by `rugo generate`. */
#ifndef RUGO_JOBS_SURFACE_SURFACE_CASE_H
#define RUGO_JOBS_SURFACE_SURFACE_CASE_H

#include "core/map/preparation/extend.h"
#include "core/surface/counter_face.h"
#include "core/surface/grooves/grooves.h"
#include "core/surface/height_moments.h"
#include "core/surface/plateau_face.h"
#include "core/surface/surface.h"
#include "jobs/surface/surface_law.h"
#include "schema/study/values.h"
#include <math.h>

/* A measured patch that surfaces hold in their first rows and columns
 * (core/map/preparation/extend.h). */
struct held_patch {
    struct height_map map;       /* owned, in lambda_s */
    enum detrend trend;          /* that was taken out of it */
    struct map_grooves *grooves; /* of it, owned; NULL: the case has none */
};

struct surface_case {
    int dimension;    /* 1 profile, 2 surface */
    struct grid grid; /* cell in units of lambda_s = 1: lx = length_ratio * wavelength_ratio, ly
                         likewise; its points are as far apart along y as along x */
    struct spectrum spectrum;
    struct surface_options options;
    double wavelength_ratio;             /* as given, or solved for nayak_alpha */
    bool hurst_solved;                   /* for nayak_alpha and wavelength_ratio */
    bool ratio_solved;                   /* for nayak_alpha and hurst */
    double length_ratio, length_ratio_y; /* sides of the cell in longest waves; of profiles both are
                                            the length */
    double *table;                       /* owned: memory behind a table spectrum */
    struct height_table *height_table;   /* owned: samples or quantiles of heights; NULL: none */
    struct translation *translation;     /* owned: that of the spectrum; NULL: none */
    struct grooves *grooves;             /* beside the random part; owned; NULL: none */
    const char *heights_name;            /* of the theory curves of heights */
    /* A second face that this one is pressed on (surface_counter.h), with its wavelengths in
     * lambda_s of this one and no grid: owned; NULL: there is one face. */
    struct surface_case *counter;
    struct counter_face *counter_face; /* owned: the same, for generators */
    struct plateau_face *plateau;      /* owned: that of a stratified face (surface_plateau.h), with
                                          wavelengths in lambda_s of the valleys; NULL: none */
    struct held_patch *held;           /* owned; NULL: surfaces hold no patch */
};
/* Highest wave numbers along x and y, in units of 2 pi over that side; y of profiles is 0. */
struct surface_band {
    size_t x, y;
};
/* Reads the surface of a case; adds faults (pointer "/surface/...") where values do not fit their
 * rows or each other, and returns ERROR_INPUT. faults may be NULL: the first fault is the error in
 * any case. *out is left cleared on failure. Absent values are their defaults. */
int surface_case_read(struct surface_case *out, const cJSON *parameters, struct fault_list *faults,
                      struct error *err);
/* Fills a surface from values that a kind has checked by tables with SURFACE_PARAMETERS among them.
 * Where all values fit together *whole is `out`; else it is NULL and *out is cleared, and
 * values_status returns the faults: whoever needs the surface takes it from *whole. Fails only with
 * ERROR_MEMORY; *out is to be cleared in any case. */
int surface_case_fill(struct surface_case *out, struct values *values,
                      const struct surface_case **whole, struct error *err);
/* Returns the dimension of the surface, 1 or 2, which does not depend on the other values. */
int surface_case_dimension(struct values *values);
void surface_case_clear(struct surface_case *surface);
/* Makes surfaces hold nx by ny heights, so far apart as the points of the grid, which is twice as
 * large along each side; z is copied. Where the case has grooves, those of the patch are found,
 * which go on. ERROR_MEMORY. */
int surface_case_hold(struct surface_case *surface, size_t nx, size_t ny, const double *z,
                      enum detrend trend, struct error *err);

/* Returns whether surfaces are translated from a Gaussian field, which alone is band limited. */
static inline bool surface_case_translated(const struct surface_case *surface) {
    return surface->spectrum.translation != NULL;
}
/* Returns whether the heights are Gaussian, and so is their sum with those of a counter face; with
 * grooves they are not. */
static inline bool surface_case_gaussian(const struct surface_case *surface) {
    return surface->options.heights.type == HEIGHTS_GAUSSIAN && surface->plateau == NULL &&
           surface->grooves == NULL &&
           (surface->counter == NULL || surface->counter->options.heights.type == HEIGHTS_GAUSSIAN);
}
/* Returns whether surfaces, or one of two faces, are made by iteration. */
static inline bool surface_case_iterated(const struct surface_case *surface) {
    return surface_is_iterated(&surface->options) ||
           (surface->counter != NULL && surface_is_iterated(&surface->counter->options));
}
/* Returns whether the random part has no waves outside the prescribed band, and whether the
 * generated surfaces, with their grooves, have none. */
static inline bool surface_case_random_limited(const struct surface_case *surface) {
    const struct surface_case *counter = surface->counter;
    if (surface->plateau != NULL)
        return false;
    bool own = surface->options.heights.type == HEIGHTS_GAUSSIAN ||
               (surface->options.keep == KEEP_SPECTRUM && !surface_case_translated(surface));
    return own && surface->held == NULL &&
           (counter == NULL || counter->options.heights.type == HEIGHTS_GAUSSIAN ||
            counter->options.keep == KEEP_SPECTRUM);
}
static inline bool surface_case_band_limited(const struct surface_case *surface) {
    return surface->grooves == NULL && surface_case_random_limited(surface);
}
/* Returns whether each surface has the prescribed spectrum exactly; with random amplitudes, and of
 * the sum of two faces, only their mean has. */
static inline bool surface_case_exact(const struct surface_case *surface) {
    return surface_case_band_limited(surface) && surface->options.amplitudes == AMPLITUDES_FIXED &&
           surface->counter == NULL;
}
/* Returns the highest wave numbers of the spectrum on the grid: at most nx/2 and ny/2. */
struct surface_band surface_case_band(const struct surface_case *surface);
/* Returns those of the generated surfaces: the same if they are band limited, else those of the
 * grid. */
struct surface_band surface_case_own_band(const struct surface_case *surface);
/* Returns those by which surfaces are sampled on other grids: of translated ones, those of the
 * Gaussian field, and with grooves those of the random part. */
struct surface_band surface_case_sampled_band(const struct surface_case *surface);
static inline bool surface_band_fits(struct surface_band band, const struct grid *grid) {
    return grid->nx > 2 * band.x && (grid_is_profile(grid) || grid->ny > 2 * band.y);
}

static inline bool surface_case_is_square(const struct surface_case *surface) {
    return surface->length_ratio == surface->length_ratio_y;
}
/* Return sides in longest waves: the shorter one, and the geometric mean, which is exact for
 * squares. */
static inline double surface_case_shorter(const struct surface_case *surface) {
    return fmin(surface->length_ratio, surface->length_ratio_y);
}
static inline double surface_case_mean_side(const struct surface_case *surface) {
    return sqrt(surface->length_ratio * surface->length_ratio_y);
}
/* Returns the area of the cell in squares of the longest wave; of profiles its length in longest
 * waves. */
static inline double surface_case_waves(const struct surface_case *surface) {
    return pow(surface_case_mean_side(surface), surface->dimension);
}
/* Returns the longer side in lambda_s, which is the longest wave that the cell can hold. */
static inline double surface_case_longest(const struct surface_case *surface) {
    return surface->dimension == 1 ? surface->grid.lx : fmax(surface->grid.lx, surface->grid.ly);
}

/* Returns how many times as long as the longest wave of the first face that of both is. */
static inline double surface_case_times_longest(const struct surface_case *surface) {
    if (surface->plateau != NULL)
        return fmax(1, surface->plateau->spectrum.wavelength_long / surface->wavelength_ratio);
    return surface->counter != NULL
               ? fmax(1, surface->length_ratio / surface->counter->length_ratio)
               : 1;
}
/* Returns how many times as short as lambda_s the shortest wave of both faces is. */
static inline double surface_case_times_shortest(const struct surface_case *surface) {
    if (surface->plateau != NULL)
        return fmax(1, 1 / surface->plateau->spectrum.wavelength_short);
    bool banded =
        surface->counter != NULL && surface->counter->spectrum.type == SPECTRUM_SELF_AFFINE;
    return banded ? fmax(1, 1 / surface->counter->spectrum.wavelength_short) : 1;
}

/* Returns the law of the heights of a stratified face, in RMS heights of its valleys. */
static inline struct stratified_heights
surface_case_stratified(const struct surface_case *surface) {
    return stratified_heights_of(1, surface->plateau->rms_ratio, surface->plateau->offset);
}
/* Return the spectrum and the options of the plateau or the counter face; NULL: there is neither.
 */
static inline const struct spectrum *
surface_case_second_spectrum(const struct surface_case *surface) {
    if (surface->plateau != NULL)
        return &surface->plateau->spectrum;
    return surface->counter != NULL ? &surface->counter->spectrum : NULL;
}
static inline const struct surface_options *
surface_case_second_options(const struct surface_case *surface) {
    if (surface->plateau != NULL)
        return &surface->plateau->options;
    return surface->counter != NULL ? &surface->counter->options : NULL;
}

/* Return the peak bytes of a generator of the surface, with heights on its grid, and the
 * nanoseconds of a point, by the tolerance on a grid where it is not NULL. */
double surface_case_bytes(const struct surface_case *surface);
double surface_case_nanoseconds(const struct surface_case *surface, const struct grid *grid);
/* Fills moments of the heights, of two faces of their sum; false, and untouched, where they are not
 * known. ERROR_MEMORY and ERROR_INPUT as spectrum_moments. */
int surface_case_heights(const struct surface_case *surface, struct height_moments *out,
                         bool *known, struct error *err);

/* Returns the points a side for `points`, at least that: if it is no integer, rounded up to an even
 * number without prime factors above 7. */
size_t surface_case_side(double points);
/* Makes the grid of the cell with at least so many points a shortest wave (of both faces), as far
 * apart along x as along y. Sides of p by q parts of equal length have p n by q n points, n rounded
 * as above. If the grid would be too large, or sides that need rounding are no simple ratio, adds a
 * fault at `path` and returns false; *out is then unchanged. */
bool surface_case_grid(const struct surface_case *surface, double points, const char *path,
                       struct values *values, struct grid *out);
/* A grid has at most 2^31 points. */
#define SURFACE_POINTS_MOST 2147483648.0

/* Fills what is known of a surface before it is made: its law, what was solved for, skewness and
 * kurtosis of heights that are not Gaussian. */
void surface_case_estimate(const struct surface_case *surface, struct study_cost *out);

#endif
