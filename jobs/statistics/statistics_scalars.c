#include "jobs/statistics/statistics_scalars.h"
#include "core/sum.h"
#include "core/theory/sampled_field.h"
#include "jobs/estimate.h"
#include "jobs/like/like_percentile.h"
#include "jobs/statistics/summit_heights.h"
#include <math.h>
#include <stdlib.h>

static const char *const NAMES[SCALAR_COUNT] = {
    [SCALAR_RMS_HEIGHT] = "rms_height",
    [SCALAR_RMS_SLOPE] = "rms_slope",
    [SCALAR_RMS_CURVATURE] = "rms_curvature",
    [SCALAR_SKEWNESS] = "skewness",
    [SCALAR_KURTOSIS] = "kurtosis",
    [SCALAR_LOWEST] = "lowest",
    [SCALAR_HIGHEST] = "highest",
    [SCALAR_M0] = "m0",
    [SCALAR_M2] = "m2",
    [SCALAR_M4] = "m4",
    [SCALAR_NAYAK_ALPHA] = "nayak_alpha",
    [SCALAR_M2_DIFFERENCE] = "m2_finite_difference",
    [SCALAR_M4_DIFFERENCE] = "m4_finite_difference",
    [SCALAR_NAYAK_ALPHA_DIFFERENCE] = "nayak_alpha_finite_difference",
    [SCALAR_SUMMITS] = "summits",
    [SCALAR_SUMMIT_DENSITY] = "summit_density",
    [SCALAR_SUMMIT_DENSITY_PER_AREA] = "summit_density_per_area",
    [SCALAR_SUMMIT_HEIGHT_MEAN] = "summit_height_mean",
    [SCALAR_SUMMIT_HEIGHT_VARIANCE] = "summit_height_variance",
    [SCALAR_SUMMIT_HEIGHT_SKEWNESS] = "summit_height_skewness",
    [SCALAR_SUMMIT_HEIGHT_KURTOSIS] = "summit_height_kurtosis",
    [SCALAR_SUMMIT_CURVATURE_MEAN] = "summit_curvature_mean",
    [SCALAR_PITS] = "pits",
    [SCALAR_PIT_DENSITY] = "pit_density",
    [SCALAR_PIT_DENSITY_PER_AREA] = "pit_density_per_area",
    [SCALAR_PIT_HEIGHT_MEAN] = "pit_height_mean",
    [SCALAR_PIT_HEIGHT_VARIANCE] = "pit_height_variance",
    [SCALAR_PIT_HEIGHT_SKEWNESS] = "pit_height_skewness",
    [SCALAR_PIT_HEIGHT_KURTOSIS] = "pit_height_kurtosis",
    [SCALAR_PIT_CURVATURE_MEAN] = "pit_curvature_mean",
    [SCALAR_GENERATOR_ITERATIONS] = "generator_iterations",
    [SCALAR_GENERATOR_CONVERGED] = "generator_converged",
    [SCALAR_EPS_H] = "eps_h",
    [SCALAR_EPS_S] = "eps_s",
    [SCALAR_EPS_S0] = "eps_s0",
    [SCALAR_EPS_S_AMPLITUDE] = "eps_s_amplitude",
    [SCALAR_EPS_S0_AMPLITUDE] = "eps_s0_amplitude",
#define LAW_NAME(scalar, name) [SCALAR_LAW_##scalar] = "law_" name,
#define PIECE_NAME(quantity, name, power) [SCALAR_PATCH + PATCH_##quantity] = "piece_" name,
    LAW_SCALARS(LAW_NAME) PATCH_QUANTITIES(PIECE_NAME)};

#define OWN_SCALAR(scalar, name) SCALAR_##scalar,
const unsigned char LAW_OWN[LAW_COUNT] = {LAW_SCALARS(OWN_SCALAR)};

const char *statistics_scalar_name(size_t at) {
    return at < SCALAR_COUNT ? NAMES[at] : NULL;
}

/* Measures the moments of heights and the mean curvature of the summits of one realisation; NaN
 * (0/0) where there is none. out: the scalars of summits, or of pits in the same order. */
static void measure_summits(const struct statistics_case *one_case, const struct moments *moments,
                            const struct summit_list *list, double *out) {
    const struct grid *grid = &one_case->surface.grid;
    double n = (double)list->count, ratio = one_case->surface.wavelength_ratio;
    bool surface = one_case->surface.dimension == 2;
    struct sum heights = {0}, curvatures = {0}, squares = {0}, cubes = {0}, fourths = {0};
    for (size_t a = 0; a < list->count; a++) {
        sum_add(&heights, list->summits[a].height);
        sum_add(&curvatures, list->summits[a].curvature);
    }
    double height = sum_value(&heights) / n, curvature = sum_value(&curvatures) / n;
    for (size_t a = 0; a < list->count; a++) {
        double deviation = list->summits[a].height - height;
        double square = deviation * deviation;
        sum_add(&squares, square);
        sum_add(&cubes, square * deviation);
        sum_add(&fourths, square * square);
    }
    double variance = sum_value(&squares) / n;
    out[SCALAR_SUMMITS] = statistics_case_symmetric(one_case) ? n / 2 : n;
    out[SCALAR_SUMMIT_DENSITY] = out[SCALAR_SUMMITS] / (surface ? grid->lx * grid->ly : grid->lx);
    out[SCALAR_SUMMIT_DENSITY_PER_AREA] =
        out[SCALAR_SUMMIT_DENSITY] * (surface ? ratio * ratio : ratio);
    out[SCALAR_SUMMIT_HEIGHT_MEAN] = height / sqrt(moments->m0);
    out[SCALAR_SUMMIT_HEIGHT_VARIANCE] = variance / moments->m0;
    out[SCALAR_SUMMIT_HEIGHT_SKEWNESS] = sum_value(&cubes) / n / (variance * sqrt(variance));
    out[SCALAR_SUMMIT_HEIGHT_KURTOSIS] = sum_value(&fourths) / n / (variance * variance);
    out[SCALAR_SUMMIT_CURVATURE_MEAN] = curvature / sqrt(moments->m4);
}

void statistics_scalars_measure(const struct statistics_case *one_case,
                                const struct moments *moments,
                                const struct realisation_measures *measures,
                                double out[SCALAR_COUNT]) {
    const struct roughness *roughness = measures->roughness;
    const struct surface_report *report = measures->report;
    bool iterated = report->end != END_DIRECT;
    out[SCALAR_RMS_HEIGHT] = roughness->rms_height;
    out[SCALAR_RMS_SLOPE] = roughness->rms_slope;
    out[SCALAR_RMS_CURVATURE] = roughness->rms_curvature;
    out[SCALAR_SKEWNESS] = roughness->skewness;
    out[SCALAR_KURTOSIS] = roughness->kurtosis;
    out[SCALAR_LOWEST] = roughness->lowest / sqrt(moments->m0);
    out[SCALAR_HIGHEST] = roughness->highest / sqrt(moments->m0);
    out[SCALAR_M0] = measures->moments->m0;
    out[SCALAR_M2] = measures->moments->m2;
    out[SCALAR_M4] = measures->moments->m4;
    out[SCALAR_NAYAK_ALPHA] = measures->moments->nayak_alpha;
    out[SCALAR_M2_DIFFERENCE] = roughness->m2;
    out[SCALAR_M4_DIFFERENCE] = roughness->m4;
    out[SCALAR_NAYAK_ALPHA_DIFFERENCE] = roughness->nayak_alpha;
    for (size_t side = 0; side < SIDES; side++)
        if (side < statistics_case_sides(one_case))
            measure_summits(one_case, moments, &measures->summits[side], out + side * SIDE_SCALARS);
        else
            for (size_t a = SCALAR_PITS; a <= SCALAR_PIT_CURVATURE_MEAN; a++)
                out[a] = NAN;
    out[SCALAR_GENERATOR_ITERATIONS] = (double)report->iterations;
    out[SCALAR_GENERATOR_CONVERGED] = iterated ? report->end == END_CONVERGED : NAN;
    out[SCALAR_EPS_H] = iterated ? report->eps_h : NAN;
    out[SCALAR_EPS_S] = iterated ? report->eps_s : NAN;
    out[SCALAR_EPS_S0] = iterated ? report->eps_s0 : NAN;
    out[SCALAR_EPS_S_AMPLITUDE] = iterated ? report->eps_s_amplitude : NAN;
    out[SCALAR_EPS_S0_AMPLITUDE] = iterated ? report->eps_s0_amplitude : NAN;
    for (size_t a = SCALAR_OWN; a < SCALAR_COUNT; a++)
        out[a] = NAN;
}

void statistics_constants(const struct modes *modes, const struct moments *moments,
                          struct roughness *out) {
    struct sampled_moments sampled;
    sampled_moments(modes, &sampled);
    *out = (struct roughness){.mean = 0,
                              .rms_height = moments->rms_height,
                              .rms_slope = sampled.rms_slope,
                              .rms_curvature = sampled.rms_curvature,
                              .skewness = NAN,
                              .kurtosis = NAN,
                              .m2 = sampled.m2,
                              .m4 = sampled.m4,
                              .nayak_alpha = sampled.nayak_alpha,
                              .lowest = NAN,
                              .highest = NAN};
}

/* Columns of the scalars, n values each. */
struct scalar_columns {
    size_t n;
    double *values;  /* SCALAR_COUNT x n */
    double *scratch; /* n */
};
static const double *column(const struct scalar_columns *columns, enum statistics_scalar scalar) {
    return columns->values + (size_t)scalar * columns->n;
}

/* Returns the scalar with the number of summits or pits that a scalar is a mean over; SCALAR_COUNT
 * for another scalar. */
static size_t number_behind(size_t scalar) {
    if (scalar >= SCALAR_SUMMIT_HEIGHT_MEAN && scalar <= SCALAR_SUMMIT_CURVATURE_MEAN)
        return SCALAR_SUMMITS;
    if (scalar >= SCALAR_PIT_HEIGHT_MEAN && scalar <= SCALAR_PIT_CURVATURE_MEAN)
        return SCALAR_PITS;
    return SCALAR_COUNT;
}

/* Returns whether a scalar is a moment of heights about their mean, and which. */
static bool is_moment(size_t scalar, enum height_moment *moment) {
    size_t first = number_behind(scalar) == SCALAR_PITS ? SCALAR_PIT_HEIGHT_VARIANCE
                                                        : SCALAR_SUMMIT_HEIGHT_VARIANCE;
    if (scalar < first || scalar > first + HEIGHT_KURTOSIS)
        return false;
    *moment = (enum height_moment)(scalar - first);
    return true;
}

/* Estimates a mean over all summits of the case; moments are about the common mean. */
static struct estimate summit_estimate(const struct scalar_columns *columns,
                                       enum statistics_scalar scalar) {
    enum height_moment moment;
    enum statistics_scalar number = (enum statistics_scalar)number_behind(scalar);
    const double *values = column(columns, scalar);
    if (is_moment(scalar, &moment)) {
        const double *mean =
            column(columns, (enum statistics_scalar)((int)scalar - (int)moment - 1));
        const struct height_columns heights = {.n = columns->n,
                                               .number = column(columns, number),
                                               .mean = mean,
                                               .variance = mean + columns->n,
                                               .skewness = mean + 2 * columns->n,
                                               .kurtosis = mean + 3 * columns->n};
        height_moment_values(&heights, moment, columns->scratch);
        values = columns->scratch;
    }
    return estimate_weighted(columns->n, values, column(columns, number));
}

int statistics_scalar_values(const struct realisations *realisations, size_t scalar, double *values,
                             double *weights, struct error *err) {
    size_t n = (size_t)realisations->count, number = number_behind(scalar);
    enum height_moment moment;
    realisations_column(realisations, scalar, values);
    if (number == SCALAR_COUNT)
        return 0;
    realisations_column(realisations, number, weights);
    if (!is_moment(scalar, &moment))
        return 0;
    double *columns = array_create(4 * n, sizeof *columns);
    if (columns == NULL)
        return error_memory(err, 4 * n * sizeof *columns, "scalars");
    for (size_t a = 0; a < 4; a++)
        realisations_column(realisations, scalar - moment - 1 + a, columns + a * n);
    const struct height_columns heights = {.n = n,
                                           .number = weights,
                                           .mean = columns,
                                           .variance = columns + n,
                                           .skewness = columns + 2 * n,
                                           .kurtosis = columns + 3 * n};
    height_moment_values(&heights, moment, values);
    free(columns);
    return 0;
}

/* Fills in the theory of summits, or of pits in the same order. */
static void theory_of_summits(const struct statistics_case *one_case,
                              const struct summit_theory *theory, bool pits, double *out) {
    int dimension = one_case->surface.dimension;
    double ratio = one_case->surface.wavelength_ratio, lx = one_case->surface.grid.lx;
    struct summit_expectation expected = summit_theory_expectation(theory, pits);
    out[SCALAR_SUMMIT_DENSITY] = expected.density;
    out[SCALAR_SUMMIT_DENSITY_PER_AREA] = expected.density * ratio;
    out[SCALAR_SUMMITS] = expected.density * lx;
    if (dimension == 2) {
        out[SCALAR_SUMMIT_DENSITY_PER_AREA] *= ratio;
        out[SCALAR_SUMMITS] *= one_case->surface.grid.ly;
    }
    out[SCALAR_SUMMIT_HEIGHT_MEAN] = expected.height_mean;
    out[SCALAR_SUMMIT_HEIGHT_VARIANCE] = expected.height_variance;
    out[SCALAR_SUMMIT_HEIGHT_SKEWNESS] = expected.height_skewness;
    out[SCALAR_SUMMIT_HEIGHT_KURTOSIS] = expected.height_kurtosis;
    out[SCALAR_SUMMIT_CURVATURE_MEAN] = expected.curvature;
}

void statistics_scalars_with_grooves(const struct statistics_case *one_case,
                                     const struct moments *moments, double out[SCALAR_COUNT]) {
    static const enum statistics_scalar UNKNOWN[] = {SCALAR_RMS_CURVATURE,
                                                     SCALAR_M2_DIFFERENCE,
                                                     SCALAR_M4_DIFFERENCE,
                                                     SCALAR_NAYAK_ALPHA_DIFFERENCE,
                                                     SCALAR_M2,
                                                     SCALAR_M4,
                                                     SCALAR_NAYAK_ALPHA};
    const struct groove_moments grooves = grooves_cumulants(one_case->surface.grooves);
    const double m0 = moments->m0;
    struct height_moments heights;
    bool known = false;
    for (size_t a = 0; a < sizeof UNKNOWN / sizeof *UNKNOWN; a++)
        out[UNKNOWN[a]] = NAN;
    out[SCALAR_M0] = m0 * (1 + grooves.second);
    out[SCALAR_RMS_HEIGHT] = sqrt(out[SCALAR_M0]);
    out[SCALAR_RMS_SLOPE] = sqrt(moments->rms_slope * moments->rms_slope + m0 * grooves.slope);
    if (isinf(out[SCALAR_RMS_SLOPE]))
        out[SCALAR_RMS_SLOPE] = NAN;
    if (surface_case_heights(&one_case->surface, &heights, &known, NULL) == 0 && known) {
        out[SCALAR_SKEWNESS] = heights.skewness;
        out[SCALAR_KURTOSIS] = heights.kurtosis;
    }
}

/* Fills in the theory of each scalar, NaN where there is none. */
static void theory_of_scalars(const struct statistics_case *one_case, const struct moments *moments,
                              const struct summit_theories *theories, double out[SCALAR_COUNT]) {
    const bool stratified = one_case->surface.plateau != NULL;
    const double kinked = stratified ? (double)NAN : 1; /* curvatures grow on finer grids */
    struct height_moments heights;
    bool known = false;
    for (size_t a = 0; a < SCALAR_COUNT; a++)
        out[a] = NAN;
    out[SCALAR_RMS_HEIGHT] = moments->rms_height;
    out[SCALAR_RMS_SLOPE] = moments->rms_slope;
    out[SCALAR_RMS_CURVATURE] = kinked * moments->rms_curvature;
    if (surface_case_heights(&one_case->surface, &heights, &known, NULL) == 0 && known) {
        out[SCALAR_SKEWNESS] = heights.skewness;
        out[SCALAR_KURTOSIS] = heights.kurtosis;
    }
    out[SCALAR_M2_DIFFERENCE] = moments->m2;
    out[SCALAR_M4_DIFFERENCE] = kinked * moments->m4;
    out[SCALAR_NAYAK_ALPHA_DIFFERENCE] = kinked * moments->nayak_alpha;
    if (!surface_case_exact(&one_case->surface)) {
        out[SCALAR_M0] = moments->m0;
        out[SCALAR_M2] = moments->m2;
        out[SCALAR_M4] = kinked * moments->m4;
        out[SCALAR_NAYAK_ALPHA] = kinked * moments->nayak_alpha;
    }
    if (one_case->surface.grooves != NULL)
        statistics_scalars_with_grooves(one_case, moments, out);
    const struct summit_theory *own = summit_theories_own(theories, one_case);
    for (size_t side = 0; own != NULL && side < statistics_case_sides(one_case); side++)
        theory_of_summits(one_case, own, side == SIDE_PITS, out + side * SIDE_SCALARS);
}

/* Adds a scalar with a fixed name. */
static int add_scalar(struct case_result *out, const char *name, struct estimate estimate,
                      double effective, double theory, struct error *err) {
    struct scalar scalar = scalar_named(name, estimate.value, estimate.standard_error, theory);
    scalar.effective = effective;
    return result_add_scalar(out, &scalar, err);
}

/* Fills in scalars that every surface has by construction; NaN for those that are random. */
static void constants_of_scalars(const struct statistics_case *one_case,
                                 const struct surface_basis *basis, double out[SCALAR_COUNT]) {
    const struct moments *moments = &basis->moments;
    struct roughness roughness;
    for (size_t a = 0; a < SCALAR_COUNT; a++)
        out[a] = NAN;
    if (one_case->surface.options.heights.type == HEIGHTS_GAUSSIAN)
        out[SCALAR_GENERATOR_ITERATIONS] = 0;
    if (!surface_case_exact(&one_case->surface))
        return;
    statistics_constants(basis->modes, moments, &roughness);
    out[SCALAR_RMS_HEIGHT] = roughness.rms_height;
    out[SCALAR_RMS_SLOPE] = roughness.rms_slope;
    out[SCALAR_RMS_CURVATURE] = roughness.rms_curvature;
    out[SCALAR_M0] = moments->m0;
    out[SCALAR_M2] = moments->m2;
    out[SCALAR_M4] = moments->m4;
    out[SCALAR_NAYAK_ALPHA] = moments->nayak_alpha;
    out[SCALAR_M2_DIFFERENCE] = roughness.m2;
    out[SCALAR_M4_DIFFERENCE] = roughness.m4;
    out[SCALAR_NAYAK_ALPHA_DIFFERENCE] = roughness.nayak_alpha;
}

/* Estimates a random scalar. Where all values happen to be equal its error is not known; for a
 * share of realisations it has the bound of a count not seen (F15.8). */
static struct estimate random_estimate(const struct scalar_columns *columns,
                                       enum statistics_scalar scalar) {
    struct estimate out = number_behind(scalar) < SCALAR_COUNT
                              ? summit_estimate(columns, scalar)
                              : estimate_mean(columns->n, column(columns, scalar));
    if (out.standard_error == 0)
        out.standard_error = scalar == SCALAR_GENERATOR_CONVERGED
                                 ? fmin(1, TALLY_NONE_SEEN / (double)columns->n)
                                 : NAN;
    return out;
}

/* Returns the effective realisations of a random scalar (result.h): means over summits are of those
 * that have any. */
static double random_effective(const struct scalar_columns *columns,
                               enum statistics_scalar scalar) {
    size_t number = number_behind(scalar);
    if (number == SCALAR_COUNT)
        return estimate_effective(columns->n, column(columns, scalar), NULL);
    const double *summits = column(columns, (enum statistics_scalar)number);
    return estimate_effective(columns->n, summits, summits);
}

static int add_scalars(struct case_result *out, const struct statistics_case *one_case,
                       const struct surface_basis *basis, const struct summit_theories *theories,
                       const struct scalar_columns *columns, struct error *err) {
    double theory[SCALAR_COUNT], constants[SCALAR_COUNT];
    theory_of_scalars(one_case, &basis->moments, theories, theory);
    constants_of_scalars(one_case, basis, constants);
    int status = 0;
    for (enum statistics_scalar a = 0; a < SCALAR_OWN && status == 0; a++) {
        struct estimate estimate = {constants[a], 0};
        double effective = 0;
        if (isnan(constants[a])) {
            estimate = random_estimate(columns, a);
            effective = random_effective(columns, a);
        }
        status = add_scalar(out, NAMES[a], estimate, effective, theory[a], err);
    }
    if (status == 0 && one_case->surface.hurst_solved)
        status = add_scalar(out, "hurst", (struct estimate){one_case->surface.spectrum.hurst, 0}, 0,
                            NAN, err);
    if (status != 0)
        return status;
    /* as given, or as solved for nayak_alpha */
    return add_scalar(out, "wavelength_ratio",
                      (struct estimate){one_case->surface.wavelength_ratio, 0}, 0, NAN, err);
}

int statistics_scalars(const struct statistics_case *one_case, const struct surface_basis *basis,
                       const struct summit_theories *theories,
                       const struct realisations *realisations, struct case_result *out,
                       struct error *err) {
    struct scalar_columns columns = {.n = (size_t)realisations->count};
    columns.values = array_create(columns.n + 1, (SCALAR_COUNT + 1) * sizeof(double));
    if (columns.values == NULL)
        return error_memory(err, columns.n * (SCALAR_COUNT + 1) * sizeof(double), "scalars");
    columns.scratch = columns.values + SCALAR_COUNT * columns.n;
    for (size_t a = 0; a < SCALAR_COUNT; a++)
        realisations_column(realisations, a, columns.values + a * columns.n);
    int status = add_scalars(out, one_case, basis, theories, &columns, err);
    free(columns.values);
    return status != 0 ? status
                       : like_scalars(&one_case->like, realisations, SCALAR_PATCH, out, err);
}
