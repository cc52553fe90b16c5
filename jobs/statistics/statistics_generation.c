#include "jobs/statistics/statistics_generation.h"
#include "core/statistics/surface_pass.h"
#include "jobs/subset.h"
#include "jobs/surface/surface_paths.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* One in so many realisations is measured again, of the first ones more. */
enum { INTERVAL = 64 };

struct statistics_generation {
    const struct statistics_case *one_case;
    struct moments moments;
    struct summit_finder *finder;
    struct surface_paths *paths; /* owned, as the lists */
    struct summit_list summits[SIDES];
};

bool statistics_generation_applies(const struct statistics_case *one_case) {
    return surface_paths_apply(&one_case->surface);
}

int statistics_generation_create(struct statistics_generation **out,
                                 const struct statistics_case *one_case,
                                 const struct moments *moments, struct summit_finder *finder,
                                 struct error *err) {
    *out = NULL;
    if (!statistics_generation_applies(one_case))
        return 0;
    struct statistics_generation *generation = array_create(1, sizeof *generation);
    if (generation == NULL)
        return error_memory(err, sizeof *generation, "other surfaces");
    generation->one_case = one_case;
    generation->moments = *moments;
    generation->finder = finder;
    int status = surface_paths_create(&generation->paths, &one_case->surface, err);
    if (status != 0)
        statistics_generation_destroy(&generation);
    *out = generation;
    return status;
}

void statistics_generation_destroy(struct statistics_generation **generation) {
    struct statistics_generation *gone = *generation;
    if (gone == NULL)
        return;
    surface_paths_destroy(&gone->paths);
    for (size_t side = 0; side < SIDES; side++)
        summit_list_clear(&gone->summits[side]);
    free(gone);
    *generation = NULL;
}

/* Writes the scalars of the surface of this path from `first` on. */
static int measure(struct statistics_generation *generation, struct random_key key,
                   enum surface_path path, const struct surface_report *own, double *first,
                   struct error *err) {
    const struct grid *grid = &generation->one_case->surface.grid;
    struct surface_report report;
    struct roughness roughness;
    double scalars[SCALAR_COUNT];
    const struct surface_pass pass = {.finder = generation->finder,
                                      .summits = &generation->summits[SIDE_SUMMITS],
                                      .pits = &generation->summits[SIDE_PITS]};
    const double *z;
    int status = surface_paths_make(generation->paths, path, key, own, &z, &report, err);
    if (status == 0)
        status = surface_pass_run(&pass, grid, z, err);
    if (status != 0)
        return status;
    roughness_measure(grid, z, &roughness);
    statistics_scalars_measure(generation->one_case, &generation->moments,
                               &(struct realisation_measures){&roughness, &generation->moments,
                                                              generation->summits, &report},
                               scalars);
    for (size_t a = 0; a < GENERATION_COUNT; a++)
        first[a] = scalars[GENERATION_OWN[a]];
    return 0;
}

int statistics_generation_measure(struct statistics_generation *generation, struct random_key key,
                                  const struct surface_report *own, double scalars[SCALAR_COUNT],
                                  struct error *err) {
    const struct subset due = subset_each(INTERVAL);
    if (generation == NULL || !subset_has(&due, key.realisation))
        return 0;
    int status = measure(generation, key, PATH_OTHER, own, scalars + SCALAR_OTHER, err);
    return status != 0 ? status
                       : measure(generation, key, PATH_LONGER, own, scalars + SCALAR_LONGER, err);
}

double statistics_generation_bytes(const struct statistics_case *one_case) {
    return statistics_generation_applies(one_case) ? surface_paths_bytes(&one_case->surface) : 0;
}

double statistics_generation_seconds(const struct statistics_case *one_case) {
    return statistics_generation_applies(one_case)
               ? surface_paths_seconds(&one_case->surface) / INTERVAL
               : 0;
}

/* Errors of scalars and curves from pairs of surfaces. */

/* A bound from a change, and the standard error of the bound; NaN: not known. */
struct change {
    double bound, standard_error;
};

/* Of each own scalar that is measured again; else NaN. */
struct changes {
    struct change of[SCALAR_OWN];
};

/* --- pairs of surfaces --- */

/* Estimates the mean of scalar `from` less scalar `own`, over the pairs. */
static struct estimate pair_difference(const struct realisations *realisations, size_t own,
                                       size_t from, double *scratch) {
    size_t n = (size_t)realisations->count;
    realisations_column(realisations, from, scratch);
    realisations_column(realisations, own, scratch + n);
    for (size_t r = 0; r < n; r++)
        scratch[r] -= scratch[n + r];
    return estimate_mean(n, scratch);
}

/* Returns the factor from the change by longer iterations to that at half of eps_h. */
static double drift_factor(const struct realisations *realisations, double *scratch) {
    size_t n = (size_t)realisations->count;
    realisations_column(realisations, SCALAR_LONGER_EPS_H, scratch);
    realisations_column(realisations, SCALAR_EPS_H, scratch + n);
    for (size_t r = 0; r < n; r++)
        scratch[r] = log2(scratch[n + r] / scratch[r]);
    return surface_paths_drift(estimate_mean(n, scratch).value);
}

static int changes_measure(const struct realisations *realisations, struct changes *out,
                           struct error *err) {
    size_t n = (size_t)realisations->count;
    double *scratch = array_create(2 * n, sizeof *scratch);
    if (scratch == NULL)
        return error_memory(err, 2 * n * sizeof *scratch, "scalars");
    double factor = drift_factor(realisations, scratch);
    for (size_t a = 0; a < SCALAR_OWN; a++)
        out->of[a] = (struct change){NAN, NAN};
    for (size_t a = 0; a < GENERATION_COUNT; a++) {
        size_t own = GENERATION_OWN[a];
        struct estimate other = pair_difference(realisations, own, SCALAR_OTHER + a, scratch);
        struct estimate longer = pair_difference(realisations, own, SCALAR_LONGER + a, scratch);
        out->of[own] = (struct change){fabs(other.value) + factor * fabs(longer.value),
                                       hypot(other.standard_error, factor * longer.standard_error)};
    }
    free(scratch);
    return 0;
}

/* --- scalars --- */

static void scalar_put(struct case_result *out, size_t at, struct change change, double scale) {
    struct scalar *scalar = NULL;
    for (size_t a = 0; a < out->scalar_count; a++)
        if (strcmp(out->scalars[a].name, statistics_scalar_name(at)) == 0)
            scalar = &out->scalars[a];
    if (scalar == NULL || isnan(scalar->value))
        return;
    scalar->errors[ERROR_GENERATION] =
        (struct scalar_error){.applies = true,
                              .known = !isnan(change.standard_error),
                              .bound = change.bound * scale,
                              .standard_error = change.standard_error * scale};
}

static double scalar_value(const struct case_result *result, size_t at) {
    const struct scalar *scalar = result_scalar(result, statistics_scalar_name(at));
    return scalar != NULL ? scalar->value : (double)NAN;
}

/* Densities change in proportion to the numbers of summits and pits. Where the spectrum is exact,
 * its constants have no such error. */
static void scalars_put(const struct statistics_case *one_case, const struct changes *changes,
                        struct case_result *out) {
    static const size_t NUMBERS[] = {SCALAR_SUMMITS, SCALAR_PITS};
    for (size_t a = 0; a < GENERATION_COUNT; a++)
        if (GENERATION_OWN[a] != SCALAR_EPS_H)
            scalar_put(out, GENERATION_OWN[a], changes->of[GENERATION_OWN[a]], 1);
    for (size_t side = 0; side < SIDES; side++)
        for (size_t density = 1; density <= 2; density++)
            scalar_put(out, NUMBERS[side] + density, changes->of[NUMBERS[side]],
                       scalar_value(out, NUMBERS[side] + density) /
                           scalar_value(out, NUMBERS[side]));
    for (size_t a = SCALAR_RMS_HEIGHT; a <= SCALAR_NAYAK_ALPHA_DIFFERENCE; a++)
        if (!surface_case_band_limited(&one_case->surface) && isnan(changes->of[a].bound))
            scalar_put(out, a, changes->of[a], 1);
}

/* --- curves --- */

/* The changes of summits or pits, relative to the deviation of their heights and to their mean
 * curvature; that of the mean height is absolute. */
struct side_changes {
    double mean;
    struct change shift, stretch, curvature;
};

static struct change relative(struct change change, double value) {
    return (struct change){change.bound / fabs(value), change.standard_error / fabs(value)};
}

static struct side_changes side_changes(const struct changes *changes,
                                        const struct case_result *result, bool pits) {
    size_t side = pits ? SIDE_SCALARS : 0;
    size_t mean = SCALAR_SUMMIT_HEIGHT_MEAN + side, curvature = SCALAR_SUMMIT_CURVATURE_MEAN + side;
    size_t variance = SCALAR_SUMMIT_HEIGHT_VARIANCE + side;
    return (struct side_changes){
        .mean = scalar_value(result, mean),
        .shift = changes->of[mean],
        .stretch = relative(changes->of[variance], 2 * scalar_value(result, variance)),
        .curvature = relative(changes->of[curvature], scalar_value(result, curvature))};
}

/* Returns the derivative by x of f(x) = (x - origin)^power y. */
static double slope(const struct curve *curve, size_t k, double origin, int power) {
    size_t left = k > 0 ? k - 1 : k, right = k + 1 < curve->n ? k + 1 : k;
    double below = curve->y[left], above = curve->y[right];
    if (power == 1) {
        below *= curve->x[left] - origin;
        above *= curve->x[right] - origin;
    }
    return right > left ? (above - below) / (curve->x[right] - curve->x[left]) : 0;
}

/* The change of point k of a curve with a shift of its heights, and with a stretch: of heights
 * about their mean, of curvatures about 0. */
struct sensitivity {
    double shift, stretch, curvature;
};

static bool sensitivity_of(const struct curve *curve, double mean, size_t k,
                           struct sensitivity *out) {
    *out = (struct sensitivity){0};
    if (strcmp(curve->quantity, "summit_height_pdf") == 0) {
        out->shift = fabs(slope(curve, k, 0, 0));
        out->stretch = fabs(slope(curve, k, mean, 1));
    } else if (strcmp(curve->quantity, "summit_height_cdf") == 0) {
        out->shift = fabs(slope(curve, k, 0, 0));
        out->stretch = fabs(curve->x[k] - mean) * out->shift;
    } else if (strcmp(curve->quantity, "summit_curvature_pdf") == 0) {
        out->curvature = fabs(slope(curve, k, 0, 1));
    } else if (strcmp(curve->quantity, "summit_mean_curvature") == 0) {
        out->curvature = fabs(curve->y[k]);
    } else {
        return false;
    }
    return true;
}

static void side_curve_put(const struct curve *curve, const struct side_changes *side,
                           double *bound, double *standard_error) {
    struct sensitivity at;
    for (size_t k = 0; k < curve->n && sensitivity_of(curve, side->mean, k, &at); k++) {
        bound[k] = at.shift * side->shift.bound + at.stretch * side->stretch.bound +
                   at.curvature * side->curvature.bound;
        standard_error[k] = hypot(
            hypot(at.shift * side->shift.standard_error, at.stretch * side->stretch.standard_error),
            at.curvature * side->curvature.standard_error);
    }
}

/* The prescribed heights are known, and so is the error of the heights of all points: their
 * difference. */
static void height_curve_put(const struct curve *curve, double *bound, double *standard_error) {
    for (size_t k = 0; k < curve->n; k++) {
        bound[k] = fabs(curve->y[k] - curve->theories[0].y[k]);
        standard_error[k] = curve->standard_error[k];
    }
}

static int curve_put(const struct statistics_case *one_case, const struct changes *changes,
                     struct case_result *out, struct curve *curve, struct error *err) {
    struct curve_error *error = &curve->errors[ERROR_GENERATION];
    struct sensitivity unused;
    bool heights = strncmp(curve->quantity, "height_", 7) == 0;
    bool sided = curve->n > 0 && sensitivity_of(curve, 0, 0, &unused);
    bool spectrum = strcmp(curve->quantity, "psd") == 0 || strcmp(curve->quantity, "acf") == 0;
    error->applies = !spectrum || !surface_case_band_limited(&one_case->surface);
    if ((!heights && !sided) || (heights && curve->theory_count == 0) ||
        (sided && isnan(changes->of[SCALAR_SUMMIT_HEIGHT_MEAN].standard_error)))
        return 0;
    double *value = result_numbers(out, 3 * curve->n);
    if (value == NULL)
        return error_memory(err, 3 * curve->n * sizeof *value, "errors of a curve");
    bool pits = curve->series != NULL && strcmp(curve->series, "pits") == 0;
    const struct side_changes side = side_changes(changes, out, pits);
    memset(value, 0, curve->n * sizeof *value);
    if (heights)
        height_curve_put(curve, value + curve->n, value + 2 * curve->n);
    else
        side_curve_put(curve, &side, value + curve->n, value + 2 * curve->n);
    error->value = value;
    error->bound = value + curve->n;
    error->standard_error = value + 2 * curve->n;
    return 0;
}

int statistics_generation_errors(const struct statistics_case *one_case,
                                 const struct realisations *realisations, struct case_result *out,
                                 struct error *err) {
    struct changes changes;
    if (!statistics_generation_applies(one_case))
        return 0;
    int status = changes_measure(realisations, &changes, err);
    if (status != 0)
        return status;
    scalars_put(one_case, &changes, out);
    for (size_t a = 0; a < out->curve_count && status == 0; a++)
        status = curve_put(one_case, &changes, out, &out->curves[a], err);
    return status;
}
