/* Implements the spectra and random surfaces of rugo.h. */
#include "core/rugo_shared.h"
#include "core/surface/surface.h"
#include <math.h>
#include <stdlib.h>

struct rugo_generator {
    struct generator *generator;
};

struct rugo_spectrum rugo_spectrum_self_affine(double hurst, double wavelength_long,
                                               double wavelength_short, double rms_slope) {
    return (struct rugo_spectrum){.type = RUGO_SELF_AFFINE,
                                  .hurst = hurst,
                                  .wavelength_long = wavelength_long,
                                  .wavelength_rolloff = wavelength_long,
                                  .wavelength_short = wavelength_short,
                                  .rms_slope = rms_slope};
}

static int spectrum_take(struct spectrum *out, const struct rugo_spectrum *from,
                         struct error *err) {
#define TYPE(type, name, value) [RUGO_##type] = SPECTRUM_##type,
    static const enum spectrum_type TYPES[] = {RUGO_SPECTRA(TYPE)};
#undef TYPE
    if ((unsigned)from->type >= sizeof TYPES / sizeof *TYPES)
        return error_set(err, ERROR_INPUT, "there is no spectrum of type %d", (int)from->type);
    if (!(from->rms_height >= 0 && from->rms_slope >= 0) ||
        (from->rms_height > 0 && from->rms_slope > 0))
        return error_set(err, ERROR_INPUT,
                         "of the spectrum's rms_height %g and rms_slope %g one must be above 0 and "
                         "the other 0",
                         from->rms_height, from->rms_slope);
    *out = (struct spectrum){.type = TYPES[from->type],
                             .hurst = from->hurst,
                             .wavelength_long = from->wavelength_long,
                             .wavelength_rolloff = from->wavelength_rolloff,
                             .wavelength_short = from->wavelength_short,
                             .correlation_x = from->correlation_x,
                             .correlation_y = from->correlation_y,
                             .table_count = from->table_count,
                             .table_wave_number = from->table_wave_number,
                             .table_density = from->table_density};
    if (from->rms_slope > 0)
        out->scale = SCALE_RMS_SLOPE;
    else if (from->rms_height > 0)
        out->scale = SCALE_RMS_HEIGHT;
    out->scale_value = from->rms_slope + from->rms_height; /* one of them is 0 */
    return 0;
}

int rugo_spectrum_moments(const struct rugo_spectrum *spectrum, const struct rugo_grid *grid,
                          struct rugo_moments *out, struct rugo_error *err) {
    struct error why = {0};
    struct spectrum shape;
    struct moments moments;
    struct grid cell = grid_of_rugo(grid);
    int status = spectrum_take(&shape, spectrum, &why);
    if (status == 0)
        status = spectrum_moments(&shape, &cell, &moments, &why);
    if (status == 0)
        moments_give(&moments, out);
    return error_give(status, &why, err);
}

double rugo_alpha_of_ratio(int dimension, double hurst, double ratio, double rolloff) {
    return spectrum_alpha_continuous(dimension, hurst, ratio, rolloff);
}

static int ratio_arguments_check(int dimension, double hurst, double rolloff, double alpha,
                                 struct error *err) {
    if (dimension != 1 && dimension != 2)
        return error_set(err, ERROR_INPUT, "the dimension must be 1 or 2, not %d", dimension);
    if (!(hurst >= 0 && hurst <= 1))
        return error_set(err, ERROR_INPUT, "hurst must be in [0, 1], not %g", hurst);
    if (!(rolloff >= 1 && isfinite(rolloff)))
        return error_set(err, ERROR_INPUT, "rolloff must be finite and 1 or more, not %g", rolloff);
    if (!isfinite(alpha))
        return error_set(err, ERROR_INPUT, "alpha must be finite, not %g", alpha);
    return 0;
}

int rugo_ratio_of_alpha(int dimension, double hurst, double rolloff, double alpha, double *ratio,
                        struct rugo_error *err) {
    struct error why = {0};
    int status = ratio_arguments_check(dimension, hurst, rolloff, alpha, &why);
    if (status == 0)
        status = spectrum_ratio_continuous(dimension, hurst, rolloff, alpha, ratio, &why);
    return error_give(status, &why, err);
}

struct rugo_surface_options rugo_surface_defaults(void) {
    return (struct rugo_surface_options){.heights = RUGO_GAUSSIAN,
                                         .shape = 1,
                                         .tolerance = SURFACE_DEFAULTS.tolerance,
                                         .max_iterations = SURFACE_DEFAULTS.max_iterations};
}

static int options_take(struct surface_options *out, const struct rugo_surface_options *from,
                        struct error *err) {
#define TYPE(type, name, value) [RUGO_##type] = HEIGHTS_##type,
    static const enum heights_type TYPES[] = {RUGO_DISTRIBUTIONS(TYPE)[RUGO_QUANTILE] =
                                                  HEIGHTS_QUANTILE};
#undef TYPE
    *out = SURFACE_DEFAULTS;
    if (from == NULL)
        return 0;
    if ((unsigned)from->heights >= sizeof TYPES / sizeof *TYPES)
        return error_set(err, ERROR_INPUT, "there is no distribution of heights of type %d",
                         (int)from->heights);
    if (from->heights == RUGO_QUANTILE && from->quantile == NULL)
        return error_set(err, ERROR_INPUT, "a distribution by its quantiles has no function");
    out->heights = (struct heights){.type = TYPES[from->heights],
                                    .shape = from->shape,
                                    .second = from->second_shape,
                                    .quantile = from->quantile,
                                    .context = from->quantile_context};
    out->amplitudes = from->random_amplitudes != 0 ? AMPLITUDES_RANDOM : AMPLITUDES_FIXED;
    out->keep = from->keep_heights != 0 ? KEEP_HEIGHTS : KEEP_SPECTRUM;
    out->tolerance = from->tolerance;
    out->max_iterations = from->max_iterations;
    return 0;
}

int rugo_generator_create(struct rugo_generator **out, const struct rugo_spectrum *spectrum,
                          const struct rugo_grid *grid, const struct rugo_surface_options *options,
                          struct rugo_error *err) {
    struct error why = {0};
    struct spectrum shape;
    struct surface_options settings;
    struct grid cell = grid_of_rugo(grid);
    struct rugo_generator *generator = array_create(1, sizeof *generator);
    int status = generator == NULL ? error_memory(&why, sizeof *generator, "a generator") : 0;
    if (status == 0)
        status = spectrum_take(&shape, spectrum, &why);
    if (status == 0)
        status = options_take(&settings, options, &why);
    if (status == 0)
        status = generator_create(&generator->generator, &shape, &cell, &settings, &why);
    if (status == 0)
        *out = generator;
    else
        free(generator);
    return error_give(status, &why, err);
}

void rugo_generator_destroy(struct rugo_generator **generator) {
    if (*generator == NULL)
        return;
    generator_destroy(&(*generator)->generator);
    free(*generator);
    *generator = NULL;
}

int rugo_generator_run(struct rugo_generator *generator, uint64_t seed, uint64_t sequence,
                       uint64_t realisation, double *z, struct rugo_surface_report *report,
                       struct rugo_error *err) {
    struct error why = {0};
    struct surface_report made = {0};
    const struct random_key key = {seed, sequence, realisation};
    int status = generator_run(generator->generator, key, z, &made, &why);
    if (status == 0 && report != NULL)
        *report =
            (struct rugo_surface_report){made.iterations, made.eps_h, made.eps_s, made.eps_s0};
    return error_give(status, &why, err);
}

int rugo_resample(const struct rugo_grid *from, const double *z, const struct rugo_grid *to,
                  size_t mode_x, size_t mode_y, double *out, struct rugo_error *err) {
    struct error why = {0};
    struct grid source, target;
    int status = grid_take(&source, from, &why);
    if (status == 0)
        status = grid_take(&target, to, &why);
    if (status == 0)
        status = surface_resample(&source, z, &target, out, mode_x, mode_y, &why);
    return error_give(status, &why, err);
}
