#include "jobs/surface/surface_case.h"
#include "core/cost.h"
#include "core/surface/acf_spectrum.h"
#include "jobs/surface/surface_grooves.h"
#include "jobs/surface/surface_parameters.h"
#include "jobs/surface/surface_plateau.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TWO_PI 6.283185307179586
static const double ROUNDING = 1e-9; /* relative: guards integers behind divisions */

static const struct parameter_table *const TABLES[] = {&SURFACE_PARAMETERS, NULL};

static const char LAGS[] = "/surface/spectrum/lag", CORRELATION[] = "/surface/spectrum/correlation";
enum { ACF_ROWS = 1000 }; /* most, of the table that an autocorrelation becomes */

static const char SKEWNESS[] = "/surface/heights/skewness",
                  KURTOSIS[] = "/surface/heights/kurtosis", SHAPE[] = "/surface/heights/shape",
                  SECOND[] = "/surface/heights/second_shape";

/* What other heights have would be overlooked beside these; a shape is known to be none. */
static void refuse_skewness(struct values *values) {
    double skewness = values_number(values, SKEWNESS);
    if (!isnan(skewness))
        values_fault(values, SKEWNESS,
                     "%g: these heights have no shape to be solved for; name a distribution that "
                     "has one",
                     skewness);
}

/* Refuses what belongs to a distribution of two shapes. */
static void refuse_second(struct values *values) {
    static const char *const PATHS[] = {SECOND, KURTOSIS};
    for (size_t p = 0; p < 2; p++)
        if (!isnan(values_number(values, PATHS[p])))
            values_fault(values, PATHS[p], "%g: belongs to a distribution of two shapes, beta",
                         values_number(values, PATHS[p]));
}

/* Reads the shape, or solves for it; a fault where there is none. */
static void read_shape(struct heights *heights, const struct distribution *distribution,
                       struct values *values) {
    struct error reason = {0};
    double shape = values_number(values, SHAPE), skewness = values_number(values, SKEWNESS);
    heights->shape = shape;
    if (!isnan(shape) && !isnan(skewness))
        values_fault(values, SKEWNESS, "give shape or skewness, not both");
    else if (!isnan(skewness) &&
             heights_shape_of_skewness(heights, skewness, &heights->shape, &reason) != 0)
        values_fault(values, SKEWNESS, "%s", reason.text);
    else if (isnan(skewness) &&
             !(shape >= distribution->shape_low && shape <= distribution->shape_high))
        values_fault(values, SHAPE,
                     "the distribution needs its shape (%s), a number in [%g, %g], or its skewness",
                     distribution->shape_means, distribution->shape_low, distribution->shape_high);
}

/* Solves for both shapes of a skewness and a kurtosis. */
static void read_kurtosis(struct heights *heights, struct values *values, double kurtosis) {
    struct error reason = {0};
    double skewness = values_number(values, SKEWNESS);
    if (isnan(skewness) || !isnan(values_number(values, SHAPE)) ||
        !isnan(values_number(values, SECOND)))
        values_fault(values, KURTOSIS, "belongs to skewness, and takes the place of both shapes");
    else if (heights_shapes_of_moments(skewness, kurtosis, heights, &reason) != 0)
        values_fault(values, KURTOSIS, "%s", reason.text);
}

static void read_distribution(struct surface_case *out, struct values *values) {
    struct heights *heights = &out->options.heights;
    const struct distribution *distribution = heights_distribution(heights->type);
    double second = values_number(values, SECOND), kurtosis = values_number(values, KURTOSIS);
    out->heights_name = distribution->family;
    if (!distribution->has_second)
        refuse_second(values);
    else if (!isnan(second))
        heights->second = second;
    if (distribution->has_second && !isnan(kurtosis))
        read_kurtosis(heights, values, kurtosis);
    else if (distribution->shape_means != NULL)
        read_shape(heights, distribution, values);
    else
        refuse_skewness(values);
}

/* Adds a fault for an invalid table; any other failure is returned. */
static int table_status(struct values *values, const char *path, int status,
                        const struct error *reason, struct error *err) {
    if (status == ERROR_INPUT)
        values_fault(values, path, "%s", reason->text);
    return status == 0 || status == ERROR_INPUT ? 0 : error_set(err, status, "%s", reason->text);
}

static int read_samples(struct surface_case *out, struct values *values, struct error *err) {
    static const char path[] = "/surface/heights/samples";
    double *samples = NULL;
    size_t n = 0;
    struct error reason = {0};
    int status = values_numbers(values, path, &samples, &n, err);
    if (status != 0)
        return status;
    out->heights_name = "samples";
    refuse_skewness(values);
    refuse_second(values);
    if (samples == NULL) {
        values_fault(values, path, "the distribution needs its samples, heights in any order");
        return 0;
    }
    status = height_table_of_samples(&out->height_table, n, samples, &reason);
    free(samples);
    return table_status(values, path, status, &reason, err);
}

static int read_quantiles(struct surface_case *out, struct values *values, struct error *err) {
    static const char at[] = "/surface/heights/probability", path[] = "/surface/heights/quantile";
    double *probability = NULL, *quantile = NULL;
    size_t n = 0, quantiles = 0;
    struct error reason = {0};
    out->heights_name = "quantiles";
    refuse_skewness(values);
    refuse_second(values);
    int status = values_numbers(values, at, &probability, &n, err);
    if (status == 0)
        status = values_numbers(values, path, &quantile, &quantiles, err);
    if (status == 0 && (probability == NULL || quantile == NULL || n != quantiles))
        values_fault(values, path,
                     "the distribution needs probability and quantile, as many of each");
    else if (status == 0 && height_table_check(n, probability, &reason) != 0)
        values_fault(values, at, "%s", reason.text);
    else if (status == 0)
        status = table_status(
            values, path,
            height_table_of_quantiles(&out->height_table, n, probability, quantile, &reason),
            &reason, err);
    free(probability);
    free(quantile);
    return status;
}

/* Reads tolerances on single errors. */
static void read_tolerances(struct surface_options *options, struct values *values) {
    static const char *const PATHS[] = {"/surface/heights/tolerances/eps_h",
                                        "/surface/heights/tolerances/eps_s",
                                        "/surface/heights/tolerances/eps_s0"};
    double *const own[] = {&options->tolerance_h, &options->tolerance_s, &options->tolerance_s0};
    for (size_t a = 0; a < 3; a++) {
        double tolerance = values_number(values, PATHS[a]);
        if (isnan(tolerance))
            continue;
        *own[a] = tolerance;
        if (options->tolerance == 0)
            values_fault(values, PATHS[a], "%g beside a tolerance of 0, which has no end",
                         tolerance);
    }
}

static void read_iteration(struct surface_options *options, struct values *values) {
    options->law = (enum height_law)values_choice(values, "/surface/heights/law");
    options->amplitudes = (enum surface_amplitudes)values_choice(values, "/surface/amplitudes");
    options->tolerance = values_number(values, "/surface/heights/tolerance");
    read_tolerances(options, values);
    options->keep = (enum surface_keep)values_choice(values, "/surface/heights/keep");
    options->iteration =
        (enum surface_iteration)values_choice(values, "/surface/heights/iteration");
    options->draw = (enum surface_draw)values_choice(values, "/surface/heights/draw");
    options->stall_gain = values_number(values, "/surface/heights/stall_gain");
    double stall = values_number(values, "/surface/heights/stall_iterations");
    double most = values_number(values, "/surface/heights/max_iterations");
    double relaxed = values_number(values, "/surface/heights/relaxed_iterations");
    options->stall_iterations = isnan(stall) ? options->stall_iterations : (size_t)stall;
    options->max_iterations = isnan(most) ? options->max_iterations : (size_t)most;
    options->relaxed_iterations = isnan(relaxed) ? options->relaxed_iterations : (size_t)relaxed;
}

/* Reads the heights and the iteration that produces them. */
static int read_heights(struct surface_case *out, struct values *values, struct error *err) {
    struct surface_options *options = &out->options;
    int distribution = values_choice(values, "/surface/heights/distribution");
    int status = 0;
    *options = SURFACE_DEFAULTS;
    options->heights.type =
        distribution < HEIGHTS_TABLE ? (enum heights_type)distribution : HEIGHTS_TABLE;
    if (distribution == GIVEN_SAMPLES)
        status = read_samples(out, values, err);
    else if (distribution == GIVEN_QUANTILES)
        status = read_quantiles(out, values, err);
    else
        read_distribution(out, values);
    options->heights.table = out->height_table;
    read_iteration(options, values);
    return status;
}

static void read_scale(struct surface_case *out, struct values *values) {
    double slope = values_number(values, "/surface/rms_slope");
    double height = values_number(values, "/surface/rms_height");
    if (!isnan(slope) && !isnan(height))
        values_fault(values, "/surface/rms_height", "give rms_slope or rms_height, not both");
    out->spectrum.scale = !isnan(slope)    ? SCALE_RMS_SLOPE
                          : !isnan(height) ? SCALE_RMS_HEIGHT
                                           : SCALE_NONE;
    out->spectrum.scale_value = !isnan(slope) ? slope : !isnan(height) ? height : 1;
    if (!isnan(values_number(values, "/surface/unit")) && out->spectrum.scale == SCALE_NONE)
        values_fault(values, "/surface/unit",
                     "heights have no unit without a scale: give rms_slope or rms_height");
}

/* Solves for the lambda_l/lambda_s of nayak_alpha; NaN with a fault where no ratio gives it. */
static int solve_ratio(struct surface_case *out, struct values *values, double alpha,
                       double rolloff, struct error *err) {
    struct error reason = {0};
    double reached;
    out->wavelength_ratio = NAN;
    if (isnan(out->spectrum.hurst) || isnan(rolloff) || isnan(out->length_ratio))
        return 0; /* at fault already */
    double hurst = out->spectrum.hurst;
    int status;
    if (values_choice(values, "/surface/alpha_formula") == ALPHA_CONTINUOUS)
        status = spectrum_ratio_continuous(out->dimension, hurst, rolloff, alpha,
                                           &out->wavelength_ratio, &reason);
    else if (surface_case_is_square(out))
        status = spectrum_ratio_discrete(out->dimension, hurst, rolloff, out->length_ratio, alpha,
                                         &out->wavelength_ratio, &reached, &reason);
    else
        status = spectrum_ratio_rectangle(hurst, rolloff, out->length_ratio, out->length_ratio_y,
                                          alpha, &out->wavelength_ratio, &reached, &reason);
    if (status == 0)
        return 0;
    out->wavelength_ratio = NAN;
    if (status == ERROR_MEMORY)
        return error_set(err, status, "%s", reason.text);
    values_fault(values, "/surface/nayak_alpha", "%s", reason.text);
    return 0;
}

/* Reads the anisotropy. The cell must hold the longest waves of a self-affine surface along x, too.
 * Nayak's parameter is that of isotropic surfaces. */
static void read_anisotropy(struct surface_case *out, struct values *values) {
    static const char path[] = "/surface/anisotropy";
    double anisotropy = values_number(values, path);
    double degrees = values_number(values, "/surface/lay_angle");
    out->spectrum.anisotropy = anisotropy;
    if (!(anisotropy > 1))
        return; /* no direction has longer waves, whatever the angle */
    out->spectrum.lay_angle = degrees * M_PI / 180;
    if (out->dimension == 1)
        values_fault(values, path, "%g: profiles have one direction", anisotropy);
    if (out->spectrum.type == SPECTRUM_SELF_AFFINE &&
        anisotropy > out->length_ratio * (1 + ROUNDING))
        values_fault(values, path, "%g is more than length_ratio, %g: no longest wave fits along x",
                     anisotropy, out->length_ratio);
    else if (out->spectrum.type == SPECTRUM_SELF_AFFINE && degrees != 0 &&
             anisotropy > out->length_ratio_y * (1 + ROUNDING))
        values_fault(
            values, path,
            "%g is more than length_ratio_y, %g: no longest wave fits along an oblique lay",
            anisotropy, out->length_ratio_y);
    if (!isnan(values_number(values, "/surface/nayak_alpha")))
        values_fault(values, path,
                     "%g: nayak_alpha is of isotropic surfaces; give wavelength_ratio", anisotropy);
}

/* Solves for the hurst of nayak_alpha and wavelength_ratio; NaN with a fault where none gives it.
 */
static int solve_hurst(struct surface_case *out, struct values *values, double alpha,
                       double rolloff, struct error *err) {
    struct error reason = {0};
    double ratio = out->wavelength_ratio;
    if (isnan(rolloff) || isnan(out->length_ratio) || isnan(out->length_ratio_y) ||
        rolloff > ratio * (1 + ROUNDING))
        return 0; /* at fault */
    rolloff = fmin(rolloff, ratio);
    int status =
        values_choice(values, "/surface/alpha_formula") == ALPHA_CONTINUOUS
            ? spectrum_hurst_continuous(out->dimension, ratio, rolloff, alpha, &out->spectrum.hurst,
                                        &reason)
            : spectrum_hurst_discrete(out->dimension, ratio, rolloff, out->length_ratio,
                                      out->length_ratio_y, alpha, &out->spectrum.hurst, &reason);
    if (status == ERROR_MEMORY)
        return error_set(err, status, "%s", reason.text);
    if (status != 0)
        values_fault(values, "/surface/nayak_alpha", "%s", reason.text);
    return 0;
}

/* Reads two of hurst, wavelength_ratio and nayak_alpha. Where one of the first two is not given, it
 * is solved for. */
static int read_bandwidth(struct surface_case *out, struct values *values, double rolloff,
                          struct error *err) {
    double alpha = values_number(values, "/surface/nayak_alpha");
    double hurst = values_number(values, "/surface/hurst");
    bool has_ratio = !isnan(out->wavelength_ratio);
    out->spectrum.hurst = hurst;
    out->hurst_solved = isnan(hurst) && has_ratio && !isnan(alpha);
    if (out->hurst_solved)
        return solve_hurst(out, values, alpha, rolloff, err);
    if (isnan(hurst))
        values_fault(values, "/surface/hurst",
                     "a self-affine spectrum needs it: a number in (0, 1]; or wavelength_ratio and "
                     "nayak_alpha, which give it");
    out->ratio_solved = !isnan(alpha) && !has_ratio;
    if (out->ratio_solved)
        return solve_ratio(out, values, alpha, rolloff, err);
    if (!isnan(alpha)) {
        values_fault(values, "/surface/nayak_alpha",
                     "give two of hurst, wavelength_ratio and nayak_alpha, not all");
        out->wavelength_ratio = NAN;
    } else if (!has_ratio)
        values_fault(values, "/surface/wavelength_ratio",
                     "give wavelength_ratio, or nayak_alpha in its place");
    return 0;
}

static int read_self_affine(struct surface_case *out, struct values *values, struct error *err) {
    double rolloff = values_number(values, "/surface/rolloff_ratio");
    read_anisotropy(out, values);
    int status = read_bandwidth(out, values, rolloff, err);
    if (status != 0)
        return status;
    double ratio = out->wavelength_ratio;
    if (rolloff > ratio * (1 + ROUNDING))
        values_fault(values, "/surface/rolloff_ratio",
                     "%g is more than wavelength_ratio, %g: the roll-off lies within the band",
                     rolloff, ratio);
    out->spectrum.wavelength_short = 1;
    out->spectrum.wavelength_long = ratio;
    out->spectrum.wavelength_rolloff = fmax(1, ratio / rolloff);
    return 0;
}

static int read_exponential(struct surface_case *out, struct values *values, struct error *err) {
    double *lengths;
    size_t n;
    int status = values_numbers(values, "/surface/spectrum/length", &lengths, &n, err);
    if (status != 0)
        return status;
    if (lengths == NULL) {
        values_fault(values, "/surface/spectrum/length",
                     "exponential_acf needs its correlation lengths, [b] or [bx, by]");
        return 0;
    }
    out->spectrum.correlation_x = lengths[0];
    out->spectrum.correlation_y = lengths[n - 1];
    free(lengths);
    return 0;
}

static void check_table(const struct surface_case *surface, struct values *values, double points) {
    const struct spectrum *spectrum = &surface->spectrum;
    bool any = false;
    for (size_t a = 0; a < spectrum->table_count; a++) {
        any = any || spectrum->table_density[a] > 0;
        if (a > 0 && spectrum->table_wave_number[a] <= spectrum->table_wave_number[a - 1]) {
            values_fault(values, "/surface/spectrum/wave_number", "must rise; number %zu does not",
                         a);
            return;
        }
    }
    double last = spectrum->table_wave_number[spectrum->table_count - 1];
    if (!any)
        values_fault(values, "/surface/spectrum/density", "must be above 0 somewhere");
    if (last > TWO_PI / 2 * points * (1 + ROUNDING))
        values_fault(values, "/surface/spectrum/wave_number",
                     "%g is beyond what points_per_wavelength resolves, %g radians per lambda_s",
                     last, TWO_PI / 2 * points);
}

static int read_table(struct surface_case *out, struct values *values, double points,
                      struct error *err) {
    double *wave_number = NULL, *density = NULL;
    size_t n = 0, densities = 0;
    read_anisotropy(out, values);
    int status = values_numbers(values, "/surface/spectrum/wave_number", &wave_number, &n, err);
    if (status == 0)
        status = values_numbers(values, "/surface/spectrum/density", &density, &densities, err);
    if (status == 0 && (wave_number == NULL || density == NULL || n != densities))
        values_fault(values, "/surface/spectrum/density",
                     "a table needs wave_number and density, as many of each");
    else if (status == 0) {
        out->table = array_create(2 * n, sizeof *out->table);
        if (out->table == NULL)
            status = error_memory(err, 2 * n * sizeof *out->table, "a table spectrum");
    }
    if (out->table != NULL && wave_number != NULL && density != NULL) {
        memcpy(out->table, wave_number, n * sizeof *wave_number);
        memcpy(out->table + n, density, n * sizeof *density);
        out->spectrum.table_count = n;
        out->spectrum.table_wave_number = out->table;
        out->spectrum.table_density = out->table + n;
        check_table(out, values, points);
    }
    free(wave_number);
    free(density);
    return status;
}

/* The wave numbers of the table that an autocorrelation becomes: from below the cell's first to the
 * shortest waves that the points or the lags resolve, close enough for the last lag. */
static size_t acf_wave_numbers(const struct surface_case *surface, const struct acf_table *acf,
                               double points, double *out) {
    double length = surface->length_ratio_y > surface->length_ratio ? surface->length_ratio_y
                                                                    : surface->length_ratio;
    double least = TWO_PI / (length * surface->wavelength_ratio), gap = acf->lag[1];
    for (size_t a = 1; a < acf->n; a++)
        gap = fmin(gap, acf->lag[a] - acf->lag[a - 1]);
    double highest = TWO_PI / 2 * fmin(points, 1 / gap), lowest = 0.9 * least;
    double step = fmax(TWO_PI / 6 / acf->lag[acf->n - 1], (highest - lowest) / (ACF_ROWS - 1));
    if (!(highest > least))
        return 0;
    size_t m = (size_t)fmin(ACF_ROWS, ceil((highest - lowest) / step) + 1);
    for (size_t a = 0; a < m; a++)
        out[a] = lowest + (highest - lowest) * (double)a / (double)(m - 1);
    return m;
}

/* Makes the table of an autocorrelation, which has no other fault. */
static int table_of_acf(struct surface_case *out, struct values *values,
                        const struct acf_table *acf, double points, struct error *err) {
    struct error reason = {0};
    if (isnan(out->wavelength_ratio) || isnan(out->length_ratio) || isnan(points))
        return 0; /* at fault */
    out->table = array_create(2 * (size_t)ACF_ROWS, sizeof *out->table);
    if (out->table == NULL)
        return error_memory(err, 2 * (size_t)ACF_ROWS * sizeof *out->table, "a table spectrum");
    size_t m = acf_wave_numbers(out, acf, points, out->table);
    if (m < 2) {
        values_fault(values, LAGS, "lags are so far apart that no wave of the cell is resolved");
        return 0;
    }
    int status = acf_spectrum(out->dimension, acf, m, out->table, out->table + ACF_ROWS, &reason);
    out->spectrum.table_count = m;
    out->spectrum.table_wave_number = out->table;
    out->spectrum.table_density = out->table + ACF_ROWS;
    return table_status(values, CORRELATION, status, &reason, err);
}

static int read_acf(struct surface_case *out, struct values *values, double points,
                    struct error *err) {
    double *lag = NULL, *correlation = NULL;
    size_t n = 0, correlations = 0;
    struct error reason = {0};
    read_anisotropy(out, values);
    int status = values_numbers(values, LAGS, &lag, &n, err);
    if (status == 0)
        status = values_numbers(values, CORRELATION, &correlation, &correlations, err);
    struct acf_table acf = {n, lag, correlation};
    if (status == 0 && (lag == NULL || correlation == NULL || n != correlations))
        values_fault(values, CORRELATION,
                     "an acf_table needs lag and correlation, as many of each");
    else if (status == 0 && acf_table_check(&acf, &reason) != 0)
        values_fault(values, LAGS, "%s", reason.text);
    else if (status == 0)
        status = table_of_acf(out, values, &acf, points, err);
    free(lag);
    free(correlation);
    return status;
}

static void read_lengths(struct surface_case *out, struct values *values) {
    static const char path[] = "/surface/length_ratio_y";
    double along_y = values_number(values, path);
    out->length_ratio = values_number(values, "/surface/length_ratio");
    if (!isnan(along_y) && out->dimension == 1)
        values_fault(values, path, "%g: profiles have one length, length_ratio", along_y);
    bool own = !isnan(along_y) && !isnan(out->length_ratio) && out->dimension == 2;
    out->length_ratio_y = own ? along_y : out->length_ratio;
}

int surface_case_dimension(struct values *values) {
    return values_number(values, "/surface/dimension") == 1 ? 1 : 2;
}

/* Checks that the cell of a surface without a fault holds a wave of the band: else the spectrum
 * would be empty. */
static void check_modes(const struct surface_case *surface, struct values *values) {
    if (spectrum_has_mode(&surface->spectrum, &surface->grid))
        return;
    if (surface->spectrum.type == SPECTRUM_SELF_AFFINE)
        values_fault(values, "/surface/length_ratio",
                     "no wave of this cell lies between lambda_l and lambda_s: take an integer, or "
                     "a wider band");
    else
        values_fault(values, "/surface/length_ratio",
                     "no wave of this cell has a density above 0: take a longer cell, or a table "
                     "of more wave numbers");
}

/* Reads the whole surface. A value at fault is NaN or empty, and what depends on it is left out. */
static int read_surface(struct surface_case *out, struct values *values, struct error *err) {
    const size_t before = values_fault_count(values);
    double points = values_number(values, "/surface/points_per_wavelength");
    out->dimension = surface_case_dimension(values);
    read_lengths(out, values);
    out->wavelength_ratio = values_number(values, "/surface/wavelength_ratio");
    int type = values_choice(values, "/surface/spectrum/type");
    bool acf = type == SPECTRUM_GIVEN_ACF;
    out->spectrum.type = acf ? SPECTRUM_TABLE : (enum spectrum_type)type;
    int status = read_heights(out, values, err);
    read_scale(out, values);
    if (status == 0 && out->spectrum.type == SPECTRUM_SELF_AFFINE)
        status = read_self_affine(out, values, err);
    else if (status == 0 && isnan(out->wavelength_ratio))
        values_fault(values, "/surface/wavelength_ratio",
                     "this spectrum needs it for the size of the cell, L/lambda_s = length_ratio "
                     "wavelength_ratio");
    if (status == 0 && out->spectrum.type == SPECTRUM_EXPONENTIAL_ACF)
        status = read_exponential(out, values, err);
    if (status == 0 && out->spectrum.type == SPECTRUM_TABLE)
        status = (acf ? read_acf : read_table)(out, values, points, err);
    if (status == 0 && !isnan(out->length_ratio * out->wavelength_ratio * points) &&
        surface_case_grid(out, points, "/surface/points_per_wavelength", values, &out->grid) &&
        values_fault_count(values) == before)
        check_modes(out, values);
    return status;
}

/* Reads the plateau of a stratified face, whose grid becomes that of both surfaces. */
static int read_plateau(struct surface_case *out, struct values *values, struct error *err) {
    static const char POINTS[] = "/surface/points_per_wavelength";
    const struct valley_face valleys = {.dimension = out->dimension,
                                        .lx = out->grid.lx,
                                        .length_ratio = out->length_ratio,
                                        .wavelength_ratio = out->wavelength_ratio,
                                        .spectrum = &out->spectrum,
                                        .options = &out->options};
    int status = surface_plateau_fill(&out->plateau, &valleys, values, err);
    if (status != 0 || out->plateau == NULL)
        return status;
    if (out->grooves != NULL)
        values_fault(
            values, "/surface/grooves/period",
            "grooves are of a face of one random part; allowed: one of grooves and plateau");
    out->spectrum.plateau = out->plateau;
    out->heights_name = "stratified";
    if (surface_case_grid(out, values_number(values, POINTS), POINTS, values, &out->grid) &&
        !spectrum_has_mode(&out->plateau->spectrum, &out->grid))
        values_fault(values, "/surface/plateau/length_ratio",
                     "no wave of this cell lies between the longest and the shortest of the "
                     "plateau: take an integer, or a wider band");
    return 0;
}

static int read_grooves(struct surface_case *out, struct values *values, struct error *err) {
    const bool translated =
        out->options.law == LAW_TRANSLATION && out->options.heights.type != HEIGHTS_GAUSSIAN;
    int status = surface_grooves_read(&out->grooves, &out->grid, translated, values, err);
    out->spectrum.grooves = out->grooves;
    return status;
}

int surface_case_fill(struct surface_case *out, struct values *values,
                      const struct surface_case **whole, struct error *err) {
    size_t before = values_fault_count(values);
    *out = (struct surface_case){0};
    *whole = NULL;
    int status = read_surface(out, values, err);
    if (status == 0 && values_fault_count(values) == before)
        status = read_grooves(out, values, err);
    if (status == 0 && values_fault_count(values) == before)
        status = surface_law_fill(&out->translation, &out->spectrum, out->dimension, &out->options,
                                  values, err);
    if (status == 0 && values_fault_count(values) == before)
        status = read_plateau(out, values, err);
    if (status == 0 && values_fault_count(values) == before)
        *whole = out;
    else
        surface_case_clear(out);
    return status;
}

int surface_case_read(struct surface_case *out, const cJSON *parameters, struct fault_list *faults,
                      struct error *err) {
    struct values *values = NULL;
    const struct surface_case *whole;
    *out = (struct surface_case){0};
    int status = values_create(&values, parameters, TABLES, faults, err);
    if (status == 0)
        status = surface_case_fill(out, values, &whole, err);
    if (status == 0)
        status = values_status(values, err);
    if (status != 0)
        surface_case_clear(out);
    values_destroy(&values);
    return status;
}

static void face_clear(struct surface_case *face) {
    free(face->table);
    height_table_destroy(&face->height_table);
    translation_destroy(&face->translation);
    free(face->grooves);
}

void surface_case_clear(struct surface_case *surface) {
    face_clear(surface);
    if (surface->counter != NULL)
        face_clear(surface->counter);
    free(surface->counter);
    free(surface->counter_face);
    free(surface->plateau);
    if (surface->held != NULL) {
        height_map_clear(&surface->held->map);
        free(surface->held->grooves);
    }
    free(surface->held);
    *surface = (struct surface_case){0};
}

int surface_case_hold(struct surface_case *surface, size_t nx, size_t ny, const double *z,
                      enum detrend trend, struct error *err) {
    const double dx = grid_dx(&surface->grid);
    struct held_patch *held = array_create(1, sizeof *held);
    double *copy = array_create(nx * ny, sizeof *copy);
    if (held == NULL || copy == NULL) {
        free(held);
        free(copy);
        return error_memory(err, nx * ny * sizeof *copy, "a held patch");
    }
    memcpy(copy, z, nx * ny * sizeof *copy);
    *held = (struct held_patch){
        .map = {.grid = {nx, ny, dx * (double)nx, dx * (double)ny}, .z = copy}, .trend = trend};
    surface->held = held;
    if (surface->grooves == NULL)
        return 0;
    held->grooves = array_create(1, sizeof *held->grooves);
    return held->grooves != NULL ? extension_grooves(held->grooves, &held->map, err)
                                 : error_memory(err, sizeof *held->grooves, "grooves of a patch");
}

/* Returns the highest wave number along a side of so many points and lambda_s. */
static size_t side_band(const struct spectrum *spectrum, size_t points, double length) {
    double highest = length / spectrum->wavelength_short;
    if (spectrum->type == SPECTRUM_EXPONENTIAL_ACF)
        highest = (double)points;
    else if (spectrum->type == SPECTRUM_TABLE)
        highest = spectrum->table_wave_number[spectrum->table_count - 1] * length / TWO_PI;
    size_t nyquist = points / 2;
    highest = floor(highest * (1 + ROUNDING));
    return highest < (double)nyquist ? (size_t)highest : nyquist;
}

static struct surface_band band_of(const struct spectrum *spectrum, const struct grid *grid,
                                   int dimension) {
    return (struct surface_band){side_band(spectrum, grid->nx, grid->lx),
                                 dimension == 1 ? 0 : side_band(spectrum, grid->ny, grid->ly)};
}

struct surface_band surface_case_band(const struct surface_case *surface) {
    struct surface_band band = band_of(&surface->spectrum, &surface->grid, surface->dimension);
    const struct spectrum *second = surface_case_second_spectrum(surface);
    if (second == NULL)
        return band;
    struct surface_band other = band_of(second, &surface->grid, surface->dimension);
    return (struct surface_band){other.x > band.x ? other.x : band.x,
                                 other.y > band.y ? other.y : band.y};
}

struct surface_band surface_case_own_band(const struct surface_case *surface) {
    const struct grid *grid = &surface->grid;
    return surface_case_band_limited(surface) ? surface_case_band(surface)
                                              : (struct surface_band){grid->nx / 2, grid->ny / 2};
}

struct surface_band surface_case_sampled_band(const struct surface_case *surface) {
    const struct grid *grid = &surface->grid;
    return surface_case_translated(surface) || surface_case_random_limited(surface)
               ? surface_case_band(surface)
               : (struct surface_band){grid->nx / 2, grid->ny / 2};
}

double surface_case_bytes(const struct surface_case *surface) {
    const struct grid *grid = &surface->grid;
    struct surface_band band = surface_case_band(surface);
    double bytes = generator_bytes(grid, band.x, band.y, &surface->options);
    if (surface->held != NULL)
        bytes += extension_bytes(&surface->held->map.grid);
    if (surface->grooves != NULL)
        bytes += sizeof(double) * (double)grid_points(grid); /* without them, for other grids */
    const struct surface_options *second = surface_case_second_options(surface);
    if (second == NULL)
        return bytes;
    return bytes + generator_bytes(grid, band.x, band.y, second) +
           generator_sum_bytes(grid, band.x, band.y);
}

/* Of a point of a family of sines, the slowest of the named shapes. */
static const double GROOVE_NANOSECONDS = 12;

double surface_case_nanoseconds(const struct surface_case *surface, const struct grid *grid) {
    double own = cost_generation(&surface->options, grid);
    const struct surface_options *second = surface_case_second_options(surface);
    if (surface->held != NULL)
        own +=
            1e9 * extension_seconds(&surface->held->map.grid) / (double)grid_points(&surface->grid);
    if (surface->grooves != NULL)
        own += GROOVE_NANOSECONDS * (double)surface->grooves->families;
    return second == NULL ? own : own + cost_generation(second, grid);
}

/* Adds the cumulants of independent heights: moments of their sum. */
static struct height_moments add_heights(const struct height_moments *a, double a_height,
                                         const struct height_moments *b, double b_height) {
    double m0 = a_height * a_height + b_height * b_height;
    double x = a_height / sqrt(m0), y = b_height / sqrt(m0);
    struct height_moments out = *a;
    out.skewness = a->skewness * pow(x, 3) + b->skewness * pow(y, 3);
    out.kurtosis = 3 + (a->kurtosis - 3) * pow(x, 4) + (b->kurtosis - 3) * pow(y, 4);
    return out;
}

/* Adds the cumulants of grooves, whose units are RMS heights of the random part. */
static struct height_moments add_grooves(const struct height_moments *rest,
                                         const struct grooves *grooves) {
    const struct groove_moments cumulants = grooves_cumulants(grooves);
    const double square = 1 + cumulants.second;
    struct height_moments out = *rest;
    out.skewness = (rest->skewness + cumulants.third) / pow(square, 1.5);
    out.kurtosis = 3 + (rest->kurtosis - 3 + cumulants.fourth) / (square * square);
    return out;
}

int surface_case_heights(const struct surface_case *surface, struct height_moments *out,
                         bool *known, struct error *err) {
    const struct surface_case *counter = surface->counter;
    struct height_moments own, other;
    struct moments of_own, of_other;
    struct spectrum face = surface->spectrum;
    if (surface->plateau != NULL) {
        const struct stratified_heights heights = surface_case_stratified(surface);
        *out = stratified_moments(&heights);
        *known = true;
        return 0;
    }
    *known = heights_moments(&surface->options.heights, &own, NULL) == 0 &&
             (counter == NULL || heights_moments(&counter->options.heights, &other, NULL) == 0) &&
             (surface->grooves == NULL || grooves_independent(surface->grooves));
    if (*known && surface_case_gaussian(surface))
        counter = NULL;
    if (*known && counter == NULL)
        *out = surface->grooves != NULL ? add_grooves(&own, surface->grooves) : own;
    if (!*known || counter == NULL)
        return 0;
    face.counter = NULL;
    int status = spectrum_moments(&face, &surface->grid, &of_own, err);
    if (status == 0)
        status = spectrum_moments(&counter->spectrum, &surface->grid, &of_other, err);
    if (status == 0)
        *out = add_heights(&own, of_own.rms_height, &other, of_other.rms_height);
    return status;
}

void surface_case_estimate(const struct surface_case *surface, struct study_cost *out) {
    struct height_moments heights;
    bool known = false;
    if (!surface_case_gaussian(surface) &&
        surface_case_heights(surface, &heights, &known, NULL) != 0)
        known = false; /* of a sum, without memory */
    surface_law_estimate(surface->translation, out);
    out->wavelength_ratio = surface->ratio_solved ? surface->wavelength_ratio : 0;
    out->hurst = surface->hurst_solved ? surface->spectrum.hurst : 0;
    out->skewness = known ? heights.skewness : 0;
    out->kurtosis = known                            ? heights.kurtosis
                    : surface_case_gaussian(surface) ? KURTOSIS_GAUSSIAN
                                                     : 0;
}
