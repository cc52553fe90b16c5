/* Sub-maps of surfaces of known spectra, and how often the law that fits a sub-map is that of the
 * spectrum. Include after check.h. */
#ifndef RUGO_TESTS_SUPPORT_SPECTRUM_RECOVERY_H
#define RUGO_TESTS_SUPPORT_SPECTRUM_RECOVERY_H

#include "core/map/preparation/detrend.h"
#include "core/statistics/spectra/spectrum_fit.h"
#include "core/statistics/uncertainty/map_directions.h"
#include "core/surface/surface.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Random amplitudes on a periodic whole of unit spacing, of which a sub-map from the origin is
 * measured; one as large as the whole is measured as periodic. */
struct recovery_case {
    const char *name;
    size_t whole, nx, ny; /* points; ny 1: profiles, of which the whole is one too */
    double hurst, rolloff, shortest, longest;
    double holes;                  /* share of the points, in discs of radius 3 */
    bool fixed;                    /* amplitudes that are not random, as a control */
    double lay_ratio, lay_degrees; /* 0: none; else wavelengths above are those across the lay */
};

enum recovered {
    RECOVERED_HURST,
    RECOVERED_ROLLOFF,
    RECOVERED_SHORT,
    RECOVERED_LONG,
    RECOVERED_AMPLITUDE,
    RECOVERED_HEIGHT,
    RECOVERED_SLOPE,
    RECOVERED_RATIO,
    RECOVERED_ANGLE,
    RECOVERED
};
static const char *const RECOVERED_NAMES[RECOVERED] = {"hurst",     "rolloff",   "short",
                                                       "long",      "amplitude", "rms_height",
                                                       "rms_slope", "lay_ratio", "lay_angle"};

struct recovery {
    size_t patches, plain; /* of surfaces with a lay: of these none was found in so many */
    struct {
        size_t seen, inside;       /* with a value; whose interval holds the truth */
        double bias, error, width; /* means over the seen: of value less truth, of its square's
                                      root, of the interval; but for H over the truth */
    } of[RECOVERED];
    double deviance; /* mean */
    double seconds;  /* of CPU a patch */
};

/* The mean of |k|^order times the power of the true law between two wavelengths; order 0, 2 or 4.
 */
static inline double true_moment(const struct recovery_case *c, double density, int order,
                                 double longest, double shortest) {
    enum { STEPS = 4000 };
    int dimension = c->ny == 1 ? 1 : 2;
    double low = 2 * M_PI / fmin(longest, c->longest), high = 2 * M_PI / shortest, total = 0;
    double ratio = c->lay_ratio > 0 ? c->lay_ratio : 1;
    const double square = 1 / (ratio * ratio);
    const double along = order == 0   ? 1
                         : order == 2 ? (1 + square) / 2
                                      : 3 * (1 + square * square) / 8 + square / 4;
    double by_lay = along / ratio;
    double step = log(high / low) / STEPS;
    for (int a = 0; a < STEPS; a++) {
        double k = low * exp((a + 0.5) * step);
        double fall = fmax(k * c->rolloff / (2 * M_PI), 1);
        total += (dimension == 1 ? 2 : 2 * M_PI) * density * pow(k, dimension + order) * step *
                 pow(fall, -(dimension + 2 * c->hurst));
    }
    return total * by_lay;
}

/* The density at waves longer than the roll-off, by that of one wave of the falling part. */
static inline double true_plateau(const struct recovery_case *c, const struct modes *modes) {
    double side = (double)c->whole, dimension = c->ny == 1 ? 1 : 2;
    const struct lay lay = {.ratio = c->lay_ratio > 0 ? c->lay_ratio : 1,
                            .angle = c->lay_degrees * M_PI / 180};
    const struct lay_frame frame = lay_frame_of(&lay);
    const double along_x = lay_length(&frame, 1, 0);
    size_t m = (size_t)(0.8 * side / c->shortest / along_x);
    return modes_power(modes, m, 0) * pow(side / (2 * M_PI), dimension) *
           pow(along_x * (double)m * c->rolloff / side, dimension + 2 * c->hurst);
}

static inline void holes_cut(const struct recovery_case *c, double *z, uint64_t realisation) {
    enum { RADIUS = 3 };
    size_t wanted = (size_t)(c->holes * (double)(c->nx * c->ny)), made = 0;
    for (uint64_t n = 0; made < wanted; n++) {
        double at[2];
        random_uniform((struct random_key){77, 0, realisation}, STREAM_HEIGHTS, 2 * n, 2, at);
        long x = (long)(at[0] * (double)c->nx), y = (long)(at[1] * (double)c->ny);
        for (long j = y - RADIUS; j <= y + RADIUS; j++)
            for (long i = x - RADIUS; i <= x + RADIUS; i++)
                if (i >= 0 && j >= 0 && i < (long)c->nx && j < (long)c->ny &&
                    (i - x) * (i - x) + (j - y) * (j - y) <= RADIUS * RADIUS &&
                    !isnan(z[j * (long)c->nx + i])) {
                    z[j * (long)c->nx + i] = NAN;
                    made++;
                }
    }
}

static inline void recovery_count(struct recovery *out, const struct recovery_case *c,
                                  const struct spectrum_fit *fit, double plateau) {
    double dimension = c->ny == 1 ? 1 : 2;
    double longest = isnan(fit->long_wavelength.value) ? fit->longest : c->longest;
    double shortest = isnan(fit->short_wavelength.value) ? fit->shortest : c->shortest;
    const double truth[RECOVERED] = {
        c->hurst,
        c->rolloff,
        c->shortest,
        c->longest,
        plateau * pow(fit->reference_wavelength / c->rolloff, dimension + 2 * c->hurst),
        sqrt(true_moment(c, plateau, 0, longest, shortest)),
        sqrt(true_moment(c, plateau, 2, longest, shortest)),
        c->lay_ratio > 0 ? c->lay_ratio : 1,
        c->lay_degrees * M_PI / 180};
    const struct interval *found[RECOVERED] = {
        &fit->hurst,           &fit->rolloff_wavelength, &fit->short_wavelength,
        &fit->long_wavelength, &fit->amplitude,          &fit->rms_height,
        &fit->rms_slope,       &fit->lay_ratio,          &fit->lay_angle};
    assert_true(fit->fitted);
    for (size_t a = 0; a < RECOVERED; a++) {
        double unit = a == RECOVERED_HURST || a == RECOVERED_ANGLE ? 1 : truth[a];
        double error = (found[a]->value - truth[a]) / unit;
        /* an end that is open holds what lies beyond it; wavelengths of a periodic cell are known
         * to rounding */
        bool inside =
            !(truth[a] < found[a]->low * (1 - 1e-9)) && !(truth[a] > found[a]->high * (1 + 1e-9));
        out->of[a].inside += inside ? 1 : 0;
        if (isnan(found[a]->value))
            continue;
        out->of[a].seen++;
        out->of[a].bias += error;
        out->of[a].error += error * error;
        out->of[a].width += (found[a]->high - found[a]->low) / unit;
    }
    out->deviance += fit->deviance;
}

static inline double cpu_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Fits, with a lay where one is to be sought and is found. */
static inline void recovery_fit(struct spectrum_fit *fit, const struct measured_map *map,
                                const struct map_spectrum *spectrum, bool seek) {
    const struct spectrum_fit_request request = {0};
    struct map_spectrum *ellipses = NULL;
    struct map_directions directions;
    struct lay lay = LAY_NONE;
    if (seek) {
        assert_int_equal(map_directions_find(&directions, map, spectrum, NULL), 0);
        assert_int_equal(map_directions_lay(&lay, &directions, spectrum, &request, NULL), 0);
    }
    assert_int_equal(spectrum_fit_along(spectrum, &lay, &request, &ellipses, fit, NULL), 0);
    map_spectrum_destroy(&ellipses);
}

static inline void recovery_measure(struct recovery *out, const struct recovery_case *c,
                                    struct generator *generator, uint64_t realisation) {
    size_t rows = c->ny == 1 ? 1 : c->whole;
    const struct grid piece = {c->nx, c->ny, (double)c->nx, (double)c->ny};
    double *whole = malloc(c->whole * rows * sizeof *whole);
    double *z = malloc(c->nx * c->ny * sizeof *z);
    struct map_spectrum *spectrum = NULL;
    struct spectrum_fit fit;
    struct trend trend;
    assert_non_null(whole);
    assert_non_null(z);
    assert_int_equal(
        generator_run(generator, (struct random_key){31, 0, realisation}, whole, NULL, NULL), 0);
    for (size_t j = 0; j < c->ny; j++)
        memcpy(z + j * c->nx, whole + j * c->whole, c->nx * sizeof *z);
    if (c->holes > 0)
        holes_cut(c, z, realisation);
    bool open = c->nx < c->whole;
    if (open)
        assert_int_equal(detrend(&piece, z, DETREND_PLANE, &trend, NULL), 0);
    const struct measured_map map = {&piece, z, open ? BOUNDARY_OPEN : BOUNDARY_PERIODIC};
    double start = cpu_seconds();
    assert_int_equal(map_spectrum_create(&spectrum, &map, NULL), 0);
    recovery_fit(&fit, &map, spectrum, c->lay_ratio > 0);
    out->plain += fit.lay_ratio.value == 1 ? 1 : 0;
    out->seconds += cpu_seconds() - start;
    recovery_count(out, c, &fit, true_plateau(c, generator_modes(generator)));
    map_spectrum_destroy(&spectrum);
    free(whole);
    free(z);
}

static inline void recovery_run(struct recovery *out, const struct recovery_case *c,
                                size_t patches) {
    const struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                      .hurst = c->hurst,
                                      .wavelength_long = c->longest,
                                      .wavelength_rolloff = c->rolloff,
                                      .wavelength_short = c->shortest,
                                      .anisotropy = c->lay_ratio,
                                      .lay_angle = c->lay_degrees * M_PI / 180};
    const struct grid grid = {c->whole, c->ny == 1 ? 1 : c->whole, (double)c->whole,
                              (double)c->whole};
    struct surface_options options = SURFACE_DEFAULTS;
    struct generator *generator = NULL;
    options.amplitudes = c->fixed ? AMPLITUDES_FIXED : AMPLITUDES_RANDOM;
    assert_int_equal(generator_create(&generator, &spectrum, &grid, &options, NULL), 0);
    *out = (struct recovery){.patches = patches};
    for (size_t n = 0; n < patches; n++)
        recovery_measure(out, c, generator, n);
    generator_destroy(&generator);
    out->deviance /= (double)patches;
    out->seconds /= (double)patches;
    for (size_t a = 0; a < RECOVERED; a++) {
        double seen = (double)out->of[a].seen;
        out->of[a].bias /= seen;
        out->of[a].error = sqrt(out->of[a].error / seen);
        out->of[a].width /= seen;
    }
}

static inline void recovery_print(const struct recovery *r, const struct recovery_case *c) {
    printf("%s, %zu x %zu of %zu, H %g, roll-off %g, %g to %g, lay %g at %g (none %zu times): "
           "deviance %.2f, %.1f ms a patch\n",
           c->name, c->nx, c->ny, c->whole, c->hurst, c->rolloff, c->longest, c->shortest,
           c->lay_ratio, c->lay_degrees, r->plain, r->deviance, 1e3 * r->seconds);
    for (size_t a = 0; a < RECOVERED; a++)
        printf("  %-10s inside %3zu of %zu, seen %3zu, bias %+.4f, error %.4f, interval %.4f\n",
               RECOVERED_NAMES[a], r->of[a].inside, r->patches, r->of[a].seen, r->of[a].bias,
               r->of[a].error, r->of[a].width);
}

#endif
