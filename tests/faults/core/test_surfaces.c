/* Protects: a surface is made, looked at, read and written or refused for want of memory, whichever
 * allocation fails; nothing leaks, and the next attempt gives the same. */
#include "tests/support/check.h"

#include "core/map/height_map_file.h"
#include "core/statistics/heights/roughness.h"
#include "core/statistics/spectra/spectral_band.h"
#include "core/statistics/summits/summits.h"
#include "core/surface/surface.h"
#include "tests/support/failing/each_allocation.h"
#include <gsl/gsl_errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 16, POINTS = SIDE * SIDE };
static const struct grid GRID = {SIDE, SIDE, 1, 1}, FINE = {32, 32, 1, 1};

static struct spectrum spectrum(void) {
    return (struct spectrum){.type = SPECTRUM_SELF_AFFINE,
                             .hurst = 0.8,
                             .wavelength_long = 1,
                             .wavelength_rolloff = 1,
                             .wavelength_short = 0.25,
                             .scale = SCALE_RMS_HEIGHT,
                             .scale_value = 1};
}

/* z is the surface that any later run must give again, once one point of it is not 0. */
struct made {
    enum heights_type heights;
    enum surface_iteration iteration;
    enum surface_amplitudes amplitudes;
    double z[POINTS];
};

static int make_surface(void *context, struct error *err) {
    struct made *made = context;
    struct spectrum shape = spectrum();
    struct surface_options options = SURFACE_DEFAULTS;
    struct generator *generator = NULL;
    double z[POINTS] = {0};
    options.heights = (struct heights){.type = made->heights, .shape = 3};
    options.iteration = made->iteration;
    options.amplitudes = made->amplitudes;
    int status = generator_create(&generator, &shape, &GRID, &options, err);
    if (status == 0)
        status = generator_run(generator, (struct random_key){.seed = 3}, z, NULL, err);
    generator_destroy(&generator);
    if (status == 0 && made->z[1] == 0)
        memcpy(made->z, z, sizeof z);
    if (status == 0)
        assert_memory_equal(made->z, z, sizeof z);
    return status;
}

static void surfaces(void **state) {
    (void)state;
    static struct made gaussian = {.heights = HEIGHTS_GAUSSIAN},
                       weibull = {.heights = HEIGHTS_WEIBULL_MIN},
                       reflections = {.heights = HEIGHTS_WEIBULL_MIN,
                                      .iteration = ITERATION_REFLECTIONS,
                                      .amplitudes = AMPLITUDES_RANDOM};
    each_allocation(&(struct failing_call){.name = "Gaussian", make_surface, &gaussian});
    each_allocation(&(struct failing_call){.name = "Weibull", make_surface, &weibull});
    each_allocation(&(struct failing_call){.name = "reflections", make_surface, &reflections});
}

static int resample(void *context, struct error *err) {
    double *out = context;
    static double z[POINTS];
    for (size_t i = 0; i < POINTS; i++)
        z[i] = cos(2 * M_PI * (double)(i % SIDE) / SIDE);
    int status = surface_resample(&GRID, z, &FINE, out, 4, 4, err);
    if (status == 0)
        check_close(out[16], -1, 1e-12);
    return status;
}

static int make_table(void *context, struct error *err) {
    static const double SAMPLES[] = {3, 1, 4, 1.5, 9, 2.6, 5, 3.5};
    struct height_table *table = NULL;
    (void)context;
    int status = height_table_of_samples(&table, sizeof SAMPLES / sizeof *SAMPLES, SAMPLES, err);
    if (status == 0)
        assert_true(height_table_quantile(table, 0.9) > height_table_quantile(table, 0.1));
    height_table_destroy(&table);
    return status;
}

static void tables_of_heights(void **state) {
    (void)state;
    each_allocation(&(struct failing_call){.name = "a table of heights", make_table, NULL});
}

static void resampling(void **state) {
    (void)state;
    static double out[4 * POINTS];
    each_allocation(&(struct failing_call){.name = "resampling", resample, out});
}

struct look {
    enum summit_stencil stencil;
    enum summit_curvature curvature;
};

static int find_summits(void *context, struct error *err) {
    const struct look *look = context;
    struct summit_finder *finder = NULL;
    struct summit_list list = {0};
    double z[POINTS];
    for (size_t i = 0; i < POINTS; i++) {
        size_t row = i / SIDE;
        z[i] =
            cos(4 * M_PI * ((double)(i % SIDE) + 0.2) / SIDE) * cos(4 * M_PI * (double)row / SIDE);
    }
    int status = summit_finder_create(&finder, &GRID, look->stencil, look->curvature, 4, 4, err);
    if (status == 0)
        status = summits_find(finder, z, &list, err);
    if (status == 0)
        assert_int_equal(list.count, 8);
    summit_list_clear(&list);
    summit_finder_destroy(&finder);
    return status;
}

static void summits(void **state) {
    (void)state;
    struct look looks[] = {{SUMMITS_NINE_POINT, CURVATURE_FINITE_DIFFERENCE},
                           {SUMMITS_FIVE_POINT, CURVATURE_SPECTRAL},
                           {SUMMITS_REFINED, CURVATURE_SPECTRAL}};
    for (size_t a = 0; a < 3; a++)
        each_allocation(&(struct failing_call){.name = "summits", find_summits, &looks[a]});
}

static int measure(void *context, struct error *err) {
    const double *z = context;
    double x[POINTS], y[POINTS];
    struct moments moments;
    int status = roughness_spectral(&GRID, z, &moments, err);
    if (status == 0)
        status = psd_measure(&GRID, z, x, y, err);
    if (status == 0)
        status = acf_measure(&GRID, z, x, y, err);
    return status;
}

static int measure_band(void *context, struct error *err) {
    (void)context;
    struct spectral_band *band = NULL;
    int status = spectral_band_create(&band, &GRID, 4, 4, err);
    spectral_band_destroy(&band);
    return status;
}

static void bands(void **state) {
    (void)state;
    each_allocation(&(struct failing_call){.name = "a band", measure_band, NULL});
}

static void roughness(void **state) {
    (void)state;
    static double z[POINTS] = {1, 2, 3};
    each_allocation(&(struct failing_call){.name = "roughness", measure, z});
}

/* Written to memory and read again. */
static int cross_file(void *context, struct error *err) {
    const enum height_map_format *format = context;
    static const double Z[] = {0.1, 2, -3, 4e-5, 5, 6e300};
    struct grid grid = {3, 2, 3, 2};
    struct height_map map = {0};
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    if (file == NULL)
        return error_set(err, ERROR_MEMORY, "no stream");
    int status = height_map_write(file, *format, &grid, Z, err);
    /* Where the C library cannot close it for want of memory, it says so by no text alone. */
    if ((fclose(file) != 0 || text == NULL) && status == 0)
        status = error_set(err, ERROR_MEMORY, "a short stream");
    if (status == 0)
        status = height_map_parse(&map, *format, text, size, 1, err);
    if (status == 0)
        assert_memory_equal(map.z, Z, sizeof Z);
    height_map_clear(&map);
    free(text);
    return status;
}

static void files(void **state) {
    (void)state;
    for (enum height_map_format format = 0; format < HEIGHT_MAP_FORMATS; format++)
        /* The stream's own memory fails as a write does. */
        each_allocation(&(struct failing_call){
            .name = HEIGHT_MAP_NAMES[format], cross_file, &format, .also = ERROR_SYSTEM});
}

int main(void) {
    gsl_set_error_handler_off(); /* as the program does */
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(surfaces),   cmocka_unit_test(tables_of_heights),
        cmocka_unit_test(resampling), cmocka_unit_test(summits),
        cmocka_unit_test(roughness),  cmocka_unit_test(bands),
        cmocka_unit_test(files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
