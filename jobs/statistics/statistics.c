/* The kind "statistics": summit statistics, spectra and roughness of random surfaces. */
#include "core/statistics/surface_pass.h"
#include "jobs/kind.h"
#include "jobs/merger.h"
#include "jobs/statistics/statistics_case.h"
#include "jobs/statistics/statistics_curves.h"
#include "jobs/statistics/statistics_draws.h"
#include "jobs/statistics/statistics_grid_theory.h"
#include "jobs/statistics/statistics_law.h"
#include "jobs/statistics/statistics_levels.h"
#include "jobs/statistics/statistics_scalars.h"
#include "jobs/statistics/statistics_spectra.h"
#include "jobs/target.h"
#include "schema/result/view.h"
#include <math.h>
#include <stdlib.h>

/* Statistics studies that ask for an error. They have one component, the case itself, with as many
 * surfaces as are needed. The statistical error is the only source: results are of the surfaces as
 * they are generated. */

enum { REALISATIONS_FIRST = 32 };
/* Scatter of the summit density, and of a curve by its norm, over that of densities bin by bin,
 * which the cost model estimates. */
static const double DENSITY_SHARE = 0.03, CURVE_SHARE = 0.4;

static int read_target(struct target *out, const cJSON *parameters, struct fault_list *faults,
                       struct error *err) {
    return target_read(out, parameters, STATISTICS_TABLES, TARGET_SUMMIT_DENSITY,
                       TARGET_SUMMIT_CURVATURE_PDF, faults, err);
}

/* As study_kind has it. */
static int statistics_target_expand(const cJSON *document, struct study_case *one,
                                    struct fault_list *faults, struct error *err) {
    struct target target;
    size_t before = faults->count;
    (void)document;
    int status = read_target(&target, one->parameters, faults, err);
    if (status != 0)
        return status == ERROR_INPUT && faults->count > before ? 0 : status;
    double share = target.quantity == TARGET_SUMMIT_DENSITY ? DENSITY_SHARE : CURVE_SHARE;
    cJSON *parameters = cJSON_Duplicate(one->parameters, true);
    one->components = array_create(1, sizeof *one->components);
    if (parameters == NULL || one->components == NULL) {
        cJSON_Delete(parameters);
        return error_memory(err, sizeof *one->components, "a component");
    }
    cJSON_DeleteItemFromObjectCaseSensitive(parameters, "target");
    one->components[0] = (struct study_case){.parameters = parameters,
                                             .realisations = REALISATIONS_FIRST,
                                             .role = "base",
                                             .share = share};
    one->component_count = 1;
    return 0;
}

/* Returns the standard error of a scalar, or of a curve by norm, over its size. */
static double relative_error(const struct case_result *result, enum target_quantity quantity) {
    const char *name = target_quantity_name(quantity);
    if (quantity == TARGET_SUMMIT_DENSITY) {
        const struct scalar *scalar = result_scalar(result, name);
        return scalar != NULL ? scalar->standard_error / fabs(scalar->value) : (double)NAN;
    }
    const struct curve *curve = result_curve(result, name);
    double error = 0, size = 0;
    for (size_t k = 0; curve != NULL && k < curve->n; k++) {
        if (isnan(curve->standard_error[k]))
            continue;
        error += curve->standard_error[k] * curve->standard_error[k];
        size += curve->y[k] * curve->y[k];
    }
    return sqrt(error / size);
}

/* As job_kind has it: the result of the case, with the scalars of the target. */
static int statistics_target_answer(const cJSON *parameters, size_t count,
                                    const struct target_component *components, uint64_t *wanted,
                                    struct case_result *out, struct error *err) {
    struct target target;
    if (count != 1)
        return error_set(err, ERROR_INPUT, "%zu components of a target; statistics have one",
                         count);
    wanted[0] = components[0].done;
    int status = read_target(&target, parameters, NULL, err);
    if (status != 0 || components[0].done == 0)
        return status;
    status = merger_result(components[0].merger, out, err);
    if (status != 0)
        return status;
    double error = relative_error(out, target.quantity), standard_error;
    double multiplier, quantile;
    const double variance = error * error * (double)components[0].done;
    const struct target_part part = {components[0].done, 1, components[0].seconds, &variance};
    const struct target_plan plan = {&target, 1, &target.error, &multiplier, &quantile};
    double reached = target_quantile(&target, 1, &part, 0, &standard_error) * standard_error;
    target_allot(&plan, 1, &part, wanted);
    status = target_add_scalar(out, "error_asked", target.error, err);
    if (status == 0)
        status = target_add_scalar(out, "error_reached", reached, err);
    return status != 0 ? status : target_add_scalar(out, "error_chance", reached, err);
}

/* How the results of studies of statistics are shown: the summits of each case beside theory. */

static const char *const HEADLINES[] = {"nayak_alpha",
                                        "summit_density",
                                        "summit_height_mean",
                                        "summit_curvature_mean",
                                        "eps_h",
                                        "eps_s",
                                        "percentile_skewness",
                                        "percentile_kurtosis",
                                        "percentile_correlation_length",
                                        "percentile_summit_density",
                                        "percentile_summit_curvature_mean",
                                        NULL};
static const char *const DENSITIES[] = {"height_pdf", "summit_height_pdf", "summit_curvature_pdf",
                                        NULL};
static const struct logarithmic_picture LOGARITHMIC[] = {
    {"psd", NULL}, {"nayak_alpha_by_ratio", NULL}, {NULL, NULL}};
static const char DISTRIBUTION[] = "/surface/heights/distribution";
static const struct series_name SERIES_NAMES[] = {
    {"pits", DISTRIBUTION, "weibull_min", "weibull max (as pits)"},
    {"pits", DISTRIBUTION, "weibull_max", "weibull min (as pits)"},
    {"", NULL, NULL, "summits"},
    {NULL, NULL, NULL, NULL}};
static const struct shown_name NAMES[] = {
    {"z/sqrt(m0)", "height", "height z/sqrt(m0)"},
    {"-sqrt(3/m4) kappa_m", "curvature", "curvature -sqrt(3/m4) kappa_m"},
    {"kappa_m/sqrt(m4)", "mean curvature", "mean curvature kappa_m/sqrt(m4)"},
    {"z''/sqrt(m4)", "curvature", "curvature z''/sqrt(m4)"},
    {"-z''/sqrt(m4)", "curvature", "curvature -z''/sqrt(m4)"},
    {"k lambda_s", "wavenumber", "wavenumber k lambda_s"},
    {"lambda_l/lambda_s", "ratio of wavelengths", "ratio of wavelengths lambda_l/lambda_s"},
    {"acf", "autocorrelation", NULL},
    {"psd", "power spectral density", NULL},
    {"summit_mean_curvature", "mean curvature of summits", NULL},
    {"nayak_alpha", "Nayak parameter", "Nayak parameter alpha"},
    {"nayak_alpha_by_ratio", "Nayak parameter", "Nayak parameter alpha"},
    {"nayak_alpha_by_hurst", "Nayak parameter", "Nayak parameter alpha"},
    {"summit_density", "summit density", "summit density (lambda_s = 1)"},
    {"pit_density", "pit density", "pit density (lambda_s = 1)"},
    {"summit_height_mean", "mean height of summits", "mean height of summits/sqrt(m0)"},
    {"pit_height_mean", "mean depth of pits", "mean depth of pits/sqrt(m0)"},
    {"summit_curvature_mean", "mean curvature of summits", "mean curvature of summits/sqrt(m4)"},
    {"pit_curvature_mean", "mean curvature of pits", "mean curvature of pits/sqrt(m4)"},
    {"eps_h", "error of the heights", "error of the heights eps_h"},
    {"eps_s", "error of the spectrum", "error of the spectrum eps_s"},
    {NULL, NULL, NULL}};
static const struct result_view STATISTICS_VIEW = {.headlines = HEADLINES,
                                                   .densities = DENSITIES,
                                                   .logarithmic = LOGARITHMIC,
                                                   .series_names = SERIES_NAMES,
                                                   .names = NAMES};

/* Reads a case. The limit is not needed, as nothing large is computed. */
static int read_case(void *one_case, const cJSON *parameters, double memory_limit,
                     struct fault_list *faults, struct error *err) {
    (void)memory_limit;
    return statistics_case_read(one_case, parameters, faults, err);
}

static void clear_case(void *one_case) {
    statistics_case_clear(one_case);
}

static void estimate(const void *one_case, struct study_cost *out) {
    statistics_case_estimate(one_case, out);
}

static const struct surface_case *surface_of(const void *one_case) {
    const struct statistics_case *statistics = one_case;
    return &statistics->surface;
}

static bool wants_gaussian(const void *one_case) {
    return statistics_case_wants_gaussian(one_case);
}

/* --- realisations --- */

struct statistics_workspace {
    const struct statistics_case *one_case; /* borrowed */
    struct moments moments;                 /* of the prescribed spectrum */
    struct roughness constants;             /* of all surfaces, where the spectrum is exact */
    struct summit_finder *finder;
    struct levels_workspace *levels; /* NULL without levels */
    struct spectra spectra;
    struct statistics_law *law;        /* NULL for Gaussian heights */
    struct like_patch *patch;          /* NULL: no sub-maps are measured */
    struct statistics_draws *draws;    /* NULL: what the patch leaves open is not asked for */
    struct summit_list summits[SIDES]; /* of a symmetric case the first holds all */
};

static int workspace_create(void *workspace, const void *one_case,
                            const struct surface_basis *basis, const void *shared,
                            struct error *err) {
    struct statistics_workspace *work = workspace;
    const struct statistics_case *statistics = one_case;
    const struct grid *grid = &statistics->surface.grid;
    const struct modes *modes = basis->modes;
    /* heights that are set point by point have waves up to the grid's */
    bool limited = surface_case_band_limited(&statistics->surface) || modes->translation != NULL;
    const struct surface_band band = {limited ? modes->mode_x : grid->nx / 2,
                                      limited ? modes->mode_y : grid->ny / 2};
    (void)shared;
    work->one_case = statistics;
    work->moments = basis->moments;
    if (surface_case_exact(&statistics->surface))
        statistics_constants(modes, &basis->moments, &work->constants);
    int status = summit_finder_create(&work->finder, grid, statistics->stencil,
                                      statistics->curvature, band.x, band.y, err);
    if (status == 0)
        status = statistics_case_translate(statistics, work->finder, modes->height, err);
    if (status == 0)
        status = levels_workspace_create(&work->levels, statistics, band, modes->height, err);
    if (status == 0)
        status = spectra_create(&work->spectra, statistics, modes, err);
    if (status == 0 && like_case_is_cut(&statistics->like))
        status = like_patch_create(&work->patch, &statistics->like, grid, err);
    if (status == 0)
        status = statistics_draws_create(&work->draws, statistics, &basis->moments, err);
    if (status != 0)
        return status;
    return statistics_law_create(&work->law, statistics, &basis->moments, err);
}

static void workspace_clear(void *workspace) {
    struct statistics_workspace *work = workspace;
    statistics_law_destroy(&work->law);
    like_patch_destroy(&work->patch);
    statistics_draws_destroy(&work->draws);
    summit_finder_destroy(&work->finder);
    levels_workspace_destroy(&work->levels);
    spectra_clear(&work->spectra);
    for (size_t side = 0; side < SIDES; side++)
        summit_list_clear(&work->summits[side]);
}

struct measured {
    struct roughness roughness;
    struct moments moments; /* of its own spectrum */
};

/* Fills the parameters of a surface: constants of all surfaces, or what its spectrum has, and what
 * depends on heights, about their mean. */
static void measured_fill(const struct statistics_workspace *work, const struct modes *modes,
                          double mean, const struct height_sums *sums, struct measured *out) {
    *out = (struct measured){work->constants, work->moments};
    struct roughness *roughness = &out->roughness;
    if (!surface_case_exact(&work->one_case->surface))
        spectral_band_moments(work->spectra.band, modes, &out->moments, roughness);
    double variance = roughness->rms_height * roughness->rms_height, square = mean * mean;
    double third = sums->third - mean * (3 * variance + square);
    double fourth = sums->fourth - 4 * mean * sums->third + 3 * square * (2 * variance + square);
    roughness->mean = mean;
    roughness->skewness = third / (variance * roughness->rms_height);
    roughness->kurtosis = fourth / (variance * variance);
    roughness->lowest = sums->lowest;
    roughness->highest = sums->highest;
}

/* Counts the heights into the tally's scratch, and finds summits and pits. */
static int measure_surface(struct statistics_workspace *work, const struct realisation *realisation,
                           struct statistics_tally *tally, struct measured *out,
                           struct error *err) {
    const struct statistics_case *one_case = work->one_case;
    struct height_sums sums;
    double mean;
    const struct surface_pass pass = {.finder = work->finder,
                                      .bins = &one_case->height,
                                      .scale = tally->scales.height,
                                      .counts = tally->counts.height,
                                      .sums = &sums,
                                      .summits = &work->summits[SIDE_SUMMITS],
                                      .pits = &work->summits[SIDE_PITS]};
    summit_finder_gaussian(work->finder, realisation->gaussian);
    int status = surface_pass_run(&pass, &one_case->surface.grid, realisation->z, err);
    if (status != 0)
        return status;
    const struct modes *modes = spectra_modes(&work->spectra, realisation, &mean);
    measured_fill(work, modes, mean, &sums, out);
    spectra_measure(&work->spectra, modes, tally);
    if (!statistics_case_symmetric(one_case))
        return 0;
    return summit_list_append(&work->summits[SIDE_SUMMITS], &work->summits[SIDE_PITS], err);
}

static int realise(void *workspace, const struct realisation *realisation, void *tally,
                   double *scalars, struct error *err) {
    struct statistics_workspace *work = workspace;
    const struct grid *grid = &work->one_case->surface.grid;
    struct measured measured;
    int status = measure_surface(work, realisation, tally, &measured, err);
    if (status != 0)
        return status;
    statistics_tally_add(tally, realisation->key.realisation, grid_points(grid), work->summits);
    status = levels_workspace_add(work->levels, realisation, work->summits, tally, err);
    if (status != 0)
        return status;
    const struct realisation_measures measures = {.roughness = &measured.roughness,
                                                  .moments = &measured.moments,
                                                  .summits = work->summits,
                                                  .report = &realisation->report};
    statistics_scalars_measure(work->one_case, &work->moments, &measures, scalars);
    if (work->patch != NULL)
        status = like_patch_measure(work->patch, realisation->key, realisation->z,
                                    scalars + SCALAR_PATCH, err);
    if (status != 0)
        return status;
    struct statistics_levels *levels = tally;
    status = statistics_draws_measure(work->draws, realisation, work->summits, scalars,
                                      levels->draws, err);
    if (status != 0)
        return status;
    return statistics_law_measure(work->law, realisation, work->summits, levels->pairs, scalars,
                                  err);
}

/* --- the tally --- */

static int sums_create(void *tally, const void *one_case, const struct surface_basis *basis,
                       struct error *err) {
    const struct spectra_sizes sizes = spectra_sizes(one_case);
    return statistics_levels_create(tally, one_case, &basis->moments, &sizes, err);
}

static void sums_clear(void *tally) {
    statistics_levels_clear(tally);
}

static int merge(void *into, const void *from, struct error *err) {
    (void)err;
    statistics_levels_merge(into, from);
    return 0;
}

static void put(struct bytes *bytes, const void *tally) {
    statistics_levels_put(bytes, tally);
}

static void get(struct byte_reader *reader, void *tally) {
    statistics_levels_get(reader, tally);
}

static bool adds_up(const void *tally) {
    return statistics_levels_add_up(tally);
}

static bool belongs(const void *tally, const struct block_result *result) {
    const struct statistics_tally *statistics = tally;
    double found[SIDES] = {0}, both = statistics_case_symmetric(statistics->one_case) ? 2 : 1;
    for (uint64_t r = 0; r < result->count; r++) {
        const double *scalars = result->scalars + r * result->scalar_count;
        found[SIDE_SUMMITS] += both * scalars[SCALAR_SUMMITS];
        found[SIDE_PITS] += scalars[SCALAR_PITS];
    }
    bool belong = statistics->points.realisations == result->count;
    for (size_t side = 0; side < statistics->sides; side++)
        belong = belong && found[side] == (double)statistics->summits[side].total.sum;
    return belong;
}

static int result(const void *one_case, const struct surface_basis *basis, const void *tally,
                  const struct realisations *realisations, struct case_result *out,
                  struct error *err) {
    struct summit_theories theories;
    int status = summit_theories_create(&theories, one_case, basis, err);
    if (status == 0)
        status = statistics_scalars(one_case, basis, &theories, realisations, out, err);
    if (status == 0)
        status = statistics_curves(one_case, basis->modes, &theories, tally, out, err);
    summit_theories_clear(&theories);
    if (status == 0)
        status = statistics_grid_theory(one_case, basis, out, err);
    const struct statistics_levels *levels = tally;
    if (status == 0)
        status = statistics_law_differences(one_case, realisations, levels->pairs, out, err);
    if (status == 0)
        status = statistics_draws_errors(one_case, levels->draws, out, err);
    return status != 0 ? status : statistics_levels_errors(tally, out, err);
}

static bool point_groups(const void *tally, const struct curve *curve, size_t at,
                         struct point_groups *out) {
    const struct statistics_tally *own = tally;
    return statistics_groups_point(&own->groups, own->one_case, curve, at, out);
}

static int scalar_values(const void *tally, const struct realisations *realisations, size_t scalar,
                         double *values, double *weights, struct error *err) {
    (void)tally;
    return statistics_scalar_values(realisations, scalar, values, weights, err);
}

static int complete(const void *one_case, const struct surface_basis *basis,
                    struct case_result *out, struct error *err) {
    return statistics_curves_complete(one_case, basis, out, err);
}

const struct job_kind STATISTICS_KIND = {
    .study = {.name = "statistics",
              .tables = STATISTICS_TABLES,
              .default_realisations = 1000,
              .check = kind_check,
              .fill = surface_law_complete,
              .expand = statistics_target_expand},
    .scalar = statistics_scalar_name,
    .view = &STATISTICS_VIEW,
    .case_size = sizeof(struct statistics_case),
    .read = read_case,
    .clear = clear_case,
    .estimate = estimate,
    .surface = surface_of,
    .wants_gaussian = wants_gaussian,
    .measures_roughness = true,
    .workspace_size = sizeof(struct statistics_workspace),
    .workspace_create = workspace_create,
    .workspace_clear = workspace_clear,
    .tally_size = sizeof(struct statistics_levels),
    .tally_create = sums_create,
    .tally_clear = sums_clear,
    .realise = realise,
    .merge = merge,
    .format = 0x5354, /* "ST" */
    .format_version = 8,
    .put = put,
    .get = get,
    .adds_up = adds_up,
    .belongs = belongs,
    .result = result,
    .answer = statistics_target_answer,
    .point_groups = point_groups,
    .scalar_values = scalar_values,
    .complete = complete,
};
