/* Protects: where skewed heights hide the sharp end of a spectrum, their normal scores show it,
 * with the law before it; Gaussian heights, and waves that an instrument took, have no such end. */
#include "core/map/preparation/detrend.h"
#include "core/surface/surface.h"
#include "jobs/maps/map_characterisation.h"
#include "tests/support/check.h"
#include <math.h>
#include <stdlib.h>

enum { SIDE = 768, PATCH = 384 };
static const double SHORTEST = 4; /* points */

/* Exponential heights, or those of the other sign, by the probability of a Gaussian one. */
static double translated(enum heights_type type, double g) {
    double sign = type == HEIGHTS_WEIBULL_MAX ? -1 : 1;
    return type == HEIGHTS_GAUSSIAN ? g : -sign * log(erfc(sign * g * M_SQRT1_2) / 2);
}

/* A patch of a Gaussian field that is translated to these heights, less a plane. blurred: over
 * three points, as by an instrument. */
static struct height_map patch(enum heights_type type, bool blurred) {
    const struct grid grid = {SIDE, SIDE, SIDE, SIDE};
    const struct spectrum law = {.type = SPECTRUM_SELF_AFFINE,
                                 .hurst = 0.5,
                                 .wavelength_long = SIDE / 6.,
                                 .wavelength_rolloff = SIDE / 6.,
                                 .wavelength_short = SHORTEST,
                                 .scale = SCALE_RMS_SLOPE,
                                 .scale_value = 0.1};
    struct surface_options options = SURFACE_DEFAULTS;
    struct generator *generator = NULL;
    struct height_map map = {.z = NULL};
    double *z = calloc(SIDE * SIDE, sizeof *z), square = 0;
    assert_non_null(z);
    options.amplitudes = AMPLITUDES_RANDOM;
    assert_int_equal(generator_create(&generator, &law, &grid, &options, NULL), 0);
    assert_int_equal(generator_run(generator, (struct random_key){2, 0, 0}, z, NULL, NULL), 0);
    generator_destroy(&generator);
    for (size_t n = 0; n < SIDE * SIDE; n++)
        square += z[n] * z[n] / (SIDE * SIDE);
    for (size_t n = 0; n < SIDE * SIDE; n++)
        z[n] = translated(type, z[n] / sqrt(square));
    assert_int_equal(height_map_shape(&map, PATCH, PATCH, 1, NULL), 0);
    map.z = calloc(PATCH * PATCH, sizeof *map.z);
    assert_non_null(map.z);
    for (size_t j = 0; j < PATCH; j++)
        for (size_t i = 0; i < PATCH; i++) {
            const double *at = z + (j + 2) * SIDE + i + 2;
            double sum = 0;
            for (int a = -1; a <= 1; a++)
                for (int b = -1; b <= 1; b++)
                    sum += at[a * SIDE + b] * (2 - abs(a)) * (2 - abs(b)) / 16;
            map.z[j * PATCH + i] = blurred ? sum : *at;
        }
    free(z);
    struct trend trend;
    assert_int_equal(detrend(&map.grid, map.z, DETREND_PLANE, &trend, NULL), 0);
    return map;
}

static void characterise(struct map_characterisation *found, struct height_map *map) {
    const struct preparation_record record = {.boundary = BOUNDARY_OPEN, .window_power = 1};
    const struct spectrum_fit_request all = {0};
    *found = (struct map_characterisation){0};
    assert_int_equal(map_characterise(found, map, &record, &all, MAP_WHOLE, NULL), 0);
    height_map_clear(map);
}

static void scores_show_the_sharp_end(void **state) {
    (void)state;
    static const enum heights_type TYPES[] = {HEIGHTS_WEIBULL_MIN, HEIGHTS_WEIBULL_MAX};
    for (size_t t = 0; t < 2; t++) {
        static struct map_characterisation found;
        struct height_map map = patch(TYPES[t], false);
        characterise(&found, &map);
        const struct map_spectra *spectra = &found.spectra;
        assert_int_equal(spectra->fit.to_end, SPECTRUM_END_LOW_PASS);
        assert_true(spectra->has_scores);
        check_relative(spectra->scores_end, SHORTEST, 0.02);
        print_message("H = %.3f [%.3f, %.3f], end %.4g\n", spectra->scores.hurst.value,
                      spectra->scores.hurst.low, spectra->scores.hurst.high, spectra->scores_end);
        check_close(spectra->scores.hurst.value, 0.5, 0.06); /* two standard errors of a patch */
        map_characterisation_clear(&found);
    }
}

static void others_have_none(void **state) {
    (void)state;
    static struct map_characterisation found;
    struct height_map gaussian = patch(HEIGHTS_GAUSSIAN, false);
    characterise(&found, &gaussian);
    assert_int_equal(found.spectra.fit.to_end, SPECTRUM_END_CUTOFF);
    assert_false(found.spectra.has_scores);
    map_characterisation_clear(&found);
    static const enum heights_type TYPES[] = {HEIGHTS_GAUSSIAN, HEIGHTS_WEIBULL_MIN};
    for (size_t t = 0; t < 2; t++) {
        struct height_map blurred = patch(TYPES[t], true);
        characterise(&found, &blurred);
        assert_int_equal(found.spectra.fit.to_end, SPECTRUM_END_LOW_PASS);
        assert_false(found.spectra.has_scores);
        map_characterisation_clear(&found);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scores_show_the_sharp_end),
        cmocka_unit_test(others_have_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
