/* Protects: a measured surface becomes the parameters of random surfaces like it: the spectrum and
 * the scale of the surface it was cut from, its heights, its size and points; what the study says
 * stands; several maps of one surface have one law, and are kept by name and size; maps that cannot
 * be fitted are refused by name. */
#include "core/random.h"
#include "core/surface/surface.h"
#include "jobs/like/like_case.h"
#include "jobs/like/like_fit.h"
#include "jobs/statistics/statistics_case.h"
#include "schema/json/json.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define DIGEST "00112233445566778899aabbccddeeff00112233445566778899aabbccddeeff"
static const struct like_source SOURCE = {.file = "patch.npy",
                                          .format = "npy",
                                          .prepared = "detrend: plane",
                                          .sha256 = DIGEST,
                                          .bytes = 12,
                                          .detrend = DETREND_PLANE};
enum { NOISE_SEED = 18 };
static const double SHORTEST = 0.004, SLOPE = 0.2; /* metres, and no unit */

/* A quarter of a self-affine surface of known spectrum and slope, less a plane. */
static struct height_map patch_of(bool profile, double anisotropy, uint64_t realisation) {
    enum { SIDE = 256, PROFILE = 2048 };
    size_t n = profile ? PROFILE : SIDE, rows = profile ? 1 : n;
    double length = SHORTEST / 4 * (double)n;
    const struct grid cell = {n, rows, length, length};
    const struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                      .hurst = 0.7,
                                      .wavelength_long = length / 2,
                                      .wavelength_rolloff = length / (anisotropy > 1 ? 24 : 8),
                                      .wavelength_short = SHORTEST,
                                      .anisotropy = anisotropy,
                                      .scale = SCALE_RMS_SLOPE,
                                      .scale_value = SLOPE};
    struct surface_options options = SURFACE_DEFAULTS;
    options.amplitudes = AMPLITUDES_RANDOM;
    struct generator *generator = NULL;
    struct height_map map = {.xy_unit = "m", .z_unit = "m"};
    struct trend trend;
    double *z = calloc(n * rows, sizeof *z);
    assert_non_null(z);
    assert_int_equal(generator_create(&generator, &spectrum, &cell, &options, NULL), 0);
    assert_int_equal(
        generator_run(generator, (struct random_key){7, 0, realisation}, z, NULL, NULL), 0);
    generator_destroy(&generator);
    assert_int_equal(height_map_shape(&map, profile ? 1 : n / 2, n / 2, SHORTEST / 4, NULL), 0);
    map.z = calloc(grid_points(&map.grid), sizeof *map.z);
    assert_non_null(map.z);
    for (size_t j = 0; j < map.grid.ny; j++)
        for (size_t i = 0; i < map.grid.nx; i++)
            map.z[j * map.grid.nx + i] = z[j * n + i];
    free(z);
    assert_int_equal(detrend(&map.grid, map.z, DETREND_PLANE, &trend, NULL), 0);
    return map;
}

static struct height_map patch(bool profile, uint64_t realisation) {
    return patch_of(profile, 1, realisation);
}

static cJSON *fitted_by(const char *surface, const struct height_map *map,
                        const struct like_source *source) {
    cJSON *object = cJSON_Parse(surface);
    struct error err = {0};
    assert_non_null(object);
    if (like_fit(object, map, source, &err) != 0)
        fail_msg("%s", err.text);
    return object;
}

static cJSON *fitted(const char *surface, const struct height_map *map) {
    return fitted_by(surface, map, &SOURCE);
}

static double number(const cJSON *surface, const char *pointer) {
    double value = json_number_at(surface, pointer, NAN);
    if (isnan(value))
        fail_msg("no %s", pointer);
    return value;
}

static void recovers(bool profile) {
    enum { PATCHES = 4 };
    double slope = 0, shortest = 0;
    for (uint64_t r = 0; r < PATCHES; r++) {
        struct height_map map = patch(profile, r);
        cJSON *surface = fitted("{}", &map);
        slope += number(surface, "/rms_slope") / PATCHES;
        shortest += number(surface, "/like/wavelength") / PATCHES;
        double cell = number(surface, "/length_ratio") * number(surface, "/wavelength_ratio") *
                      number(surface, "/points_per_wavelength");
        assert_true(fabs(cell - 2 * (double)map.grid.nx) < 1e-6);
        assert_true(number(surface, "/like/points/0") == (double)map.grid.nx);
        cJSON_Delete(surface);
        height_map_clear(&map);
    }
    print_message("slope %.4f of %g, shortest wave %.5f of %g\n", slope, SLOPE, shortest, SHORTEST);
    assert_true(fabs(slope / SLOPE - 1) < 0.04);
    assert_true(shortest < SHORTEST * 1.02 && shortest > SHORTEST * 0.85);
}

static void slope_and_band_are_found_again(void **state) {
    (void)state;
    recovers(false);
    recovers(true);
}

/* What was fitted makes a case of a study, whose sub-maps are as large as the map. */
static void makes_a_case(void **state) {
    (void)state;
    struct height_map map = patch(false, 3);
    cJSON *parameters = cJSON_CreateObject();
    cJSON_AddItemToObject(parameters, "surface", fitted("{\"points_per_wavelength\": 9}", &map));
    struct statistics_case one_case;
    struct error err = {0};
    assert_int_equal(statistics_case_read(&one_case, parameters, NULL, &err), 0);
    const cJSON *table = json_at(parameters, "/surface/spectrum/wave_number");
    assert_int_equal(one_case.surface.spectrum.table_count, cJSON_GetArraySize(table));
    assert_int_equal(one_case.surface.options.amplitudes, AMPLITUDES_RANDOM);
    assert_int_equal(one_case.surface.options.heights.type, HEIGHTS_TABLE);
    assert_int_equal(one_case.like.nx, map.grid.nx);
    assert_true(one_case.like.detrend == DETREND_PLANE);
    assert_false(like_case_is_cut(&one_case.like)); /* 9 points are no multiple of the map's */
    assert_true(one_case.like.measured[PATCH_RMS_SLOPE] > 0.1);
    statistics_case_clear(&one_case);
    cJSON_DeleteItemFromObject(cJSON_GetObjectItem(parameters, "surface"), "points_per_wavelength");
    double points = 2 / number(parameters, "/surface/like/spacing");
    cJSON_AddNumberToObject(cJSON_GetObjectItem(parameters, "surface"), "points_per_wavelength",
                            points);
    assert_int_equal(statistics_case_read(&one_case, parameters, NULL, &err), 0);
    assert_int_equal(one_case.like.stride, 2);
    statistics_case_clear(&one_case);
    cJSON_Delete(parameters);
    height_map_clear(&map);
}

/* Lengths in any unit give the same study, but for the unit. */
static void units_do_not_matter(void **state) {
    (void)state;
    struct height_map map = patch(false, 4);
    cJSON *metres = fitted("{}", &map);
    map.grid.lx *= 1e6;
    map.grid.ly *= 1e6;
    for (size_t i = 0; i < grid_points(&map.grid); i++)
        map.z[i] *= 1e6;
    cJSON *others = fitted("{}", &map);
    static const char *const SAME[] = {"/rms_slope",
                                       "/wavelength_ratio",
                                       "/points_per_wavelength",
                                       "/spectrum/wave_number/3",
                                       "/heights/quantile/5",
                                       "/like/measured/0",
                                       "/like/measured/2",
                                       "/like/measured/10"};
    for (size_t s = 0; s < sizeof SAME / sizeof *SAME; s++)
        assert_true(fabs(number(metres, SAME[s]) / number(others, SAME[s]) - 1) < 1e-9);
    assert_true(
        fabs(number(others, "/like/wavelength") / number(metres, "/like/wavelength") - 1e6) < 1);
    cJSON_Delete(metres);
    cJSON_Delete(others);
    height_map_clear(&map);
}

static void the_study_stands(void **state) {
    (void)state;
    struct height_map map = patch(false, 5);
    cJSON *surface = fitted("{\"hurst\": 0.5, \"wavelength_ratio\": 8, \"rms_slope\": 0.05,"
                            " \"points_per_wavelength\": 8, \"length_ratio\": 3,"
                            " \"amplitudes\": \"fixed\", \"heights\": {\"distribution\":"
                            " \"weibull_min\", \"shape\": 2}}",
                            &map);
    assert_null(json_at(surface, "/spectrum"));
    assert_null(json_at(surface, "/heights/quantile"));
    assert_true(number(surface, "/wavelength_ratio") == 8);
    assert_true(number(surface, "/length_ratio") == 3);
    assert_true(number(surface, "/rms_slope") == 0.05);
    assert_string_equal(cJSON_GetStringValue(json_at(surface, "/amplitudes")), "fixed");
    assert_string_equal(cJSON_GetStringValue(json_at(surface, "/like/spectrum")), "given");
    assert_string_equal(cJSON_GetStringValue(json_at(surface, "/like/heights")), "given");
    assert_true(fabs(number(surface, "/like/wavelength") - 2 * SHORTEST) < 1e-12);
    cJSON_Delete(surface);
    height_map_clear(&map);
}

/* A study that names how heights are made, and not which, keeps those of the map. */
static void the_law_of_heights_stands(void **state) {
    (void)state;
    struct height_map map = patch(false, 5);
    cJSON *plain = fitted("{}", &map);
    cJSON *named = fitted("{\"heights\": {\"law\": \"translation\"}}", &map);
    assert_string_equal(cJSON_GetStringValue(json_at(named, "/heights/law")), "translation");
    assert_string_equal(cJSON_GetStringValue(json_at(named, "/like/heights")),
                        cJSON_GetStringValue(json_at(plain, "/like/heights")));
    assert_true(cJSON_Compare(json_at(named, "/heights/quantile"),
                              json_at(plain, "/heights/quantile"), true));
    assert_true(cJSON_Compare(json_at(named, "/heights/probability"),
                              json_at(plain, "/heights/probability"), true));
    cJSON_Delete(plain);
    cJSON_Delete(named);
    height_map_clear(&map);
}

/* The law of the surfaces, and Gaussian heights, by the fitted law. */
static void laws(void **state) {
    (void)state;
    enum { PATCHES = 4 };
    struct like_source source = SOURCE;
    double hurst = 0;
    source.spectrum = LIKE_SPECTRUM_FIT;
    source.heights = LIKE_HEIGHTS_FIT;
    for (uint64_t r = 0; r < PATCHES; r++) {
        struct height_map map = patch(false, r);
        cJSON *surface = fitted_by("{}", &map, &source);
        hurst += number(surface, "/hurst") / PATCHES;
        assert_null(json_at(surface, "/spectrum"));
        assert_true(fabs(number(surface, "/like/wavelength") / SHORTEST - 1) < 0.2);
        assert_true(fabs(number(surface, "/rms_slope") / SLOPE - 1) < 0.3);
        assert_non_null(json_at(surface, "/heights/distribution"));
        assert_true(number(surface, "/like/trusted/0") > number(surface, "/like/trusted/1"));
        cJSON *parameters = cJSON_CreateObject();
        struct statistics_case one_case;
        struct error err = {0};
        cJSON_AddItemToObject(parameters, "surface", surface);
        if (statistics_case_read(&one_case, parameters, NULL, &err) != 0)
            fail_msg("%s", err.text);
        assert_true(like_case_is_cut(&one_case.like));
        assert_int_equal(one_case.surface.grid.nx, 2 * map.grid.nx);
        statistics_case_clear(&one_case);
        cJSON_Delete(parameters);
        height_map_clear(&map);
    }
    print_message("H = %.3f of 0.7\n", hurst);
    assert_true(fabs(hurst - 0.7) < 0.12);
}

static void turn(struct height_map *map) {
    size_t n = map->grid.nx;
    assert_int_equal(map->grid.ny, n);
    for (size_t j = 0; j < n; j++)
        for (size_t i = 0; i < j; i++) {
            double z = map->z[j * n + i];
            map->z[j * n + i] = map->z[i * n + j];
            map->z[i * n + j] = z;
        }
}

static void refused(const struct height_map *map, const char *words);

/* Grooves in any direction become the anisotropy and the angle of the lay; those that do not end
 * are refused. */
static void grooves(void **state) {
    (void)state;
    struct height_map map = patch_of(false, 3, 1);
    for (int turned = 0; turned < 2; turned++) {
        cJSON *surface = fitted("{}", &map);
        double found = number(surface, "/anisotropy"), angle = number(surface, "/lay_angle");
        print_message("anisotropy %.3f of 3 at %.2f degrees\n", found, angle);
        assert_true(found > 2.4 && found < 3.6);
        assert_true(fabs(fabs(angle) - 90 * turned) < 5);
        assert_true(fabs(number(surface, "/rms_slope") / SLOPE - 1) < 0.2);
        cJSON_Delete(surface);
        turn(&map);
    }
    for (size_t j = 0; j < map.grid.ny; j++) /* the same in every row: their grooves do not end */
        for (size_t i = 0; i < map.grid.nx; i++)
            map.z[j * map.grid.nx + i] = sin(0.8 * (double)j) + sin(0.21 * (double)(j * j));
    refused(&map, "as those of grooves that do not end");
    height_map_clear(&map);
}

/* Of a saw a grid with fewer points than the map holds fewer harmonics, whichever side is steep:
 * the study leaves the others out, and its surfaces can be made. */
static void saws_on_coarse_grids(void **state) {
    (void)state;
    static const double PERIOD = 12; /* points of the map */
    size_t left_out = 0;
    for (int side = -1; side <= 1; side += 2) {
        struct height_map map = patch(false, 3);
        for (size_t point = 0; point < grid_points(&map.grid); point++) {
            const size_t row = point / map.grid.nx;
            const double t = (double)row / PERIOD;
            map.z[point] += side * 6 * SLOPE * SHORTEST * (t - floor(t));
        }
        struct like_source source = SOURCE;
        source.spectrum = LIKE_SPECTRUM_FIT;
        cJSON *parameters = cJSON_CreateObject(), *surface = fitted_by("{}", &map, &source);
        char coarse[60];
        snprintf(coarse, sizeof coarse, "{\"points_per_wavelength\": %.9g}",
                 number(surface, "/points_per_wavelength") / 1.9);
        cJSON_Delete(surface);
        surface = fitted_by(coarse, &map, &source);
        cJSON_AddItemToObject(parameters, "surface", surface);
        struct statistics_case one_case;
        struct error err = {0};
        if (statistics_case_read(&one_case, parameters, NULL, &err) != 0)
            fail_msg("%s", err.text);
        statistics_case_clear(&one_case);
        const cJSON *amplitudes = json_at(parameters, "/surface/grooves/amplitudes");
        print_message("side %d: %d harmonics\n", side, cJSON_GetArraySize(amplitudes));
        if (amplitudes != NULL) {
            /* a period has six points or seven; without the limit there were five harmonics */
            assert_in_range(cJSON_GetArraySize(amplitudes), 1, 3);
            left_out++;
        }
        cJSON_Delete(parameters);
        height_map_clear(&map);
    }
    assert_int_equal(left_out, 1); /* the other one is a saw by name */
}

/* Sub-maps that are compared with a noisy map have as much noise: here those of a level surface. */
static void noise_is_in_sub_maps(cJSON *surface, double rms) {
    const struct random_key keys[] = {{NOISE_SEED, 0, 0}, {NOISE_SEED, 0, 1}};
    struct like_patch *patch = NULL;
    struct statistics_case one_case;
    struct error err = {0};
    const double *heights;
    double first = 0, square = 0;
    cJSON *parameters = cJSON_CreateObject();
    cJSON_AddItemToObject(parameters, "surface", cJSON_Duplicate(surface, true));
    assert_int_equal(statistics_case_read(&one_case, parameters, NULL, &err), 0);
    const struct like_case *like = &one_case.like;
    const size_t points = like->nx * like->ny;
    double *level = calloc(grid_points(&one_case.surface.grid), sizeof *level);
    assert_non_null(level);
    assert_int_equal(like_patch_create(&patch, like, &one_case.surface.grid, &err), 0);
    for (size_t k = 0; k < 2; k++) {
        assert_int_equal(like_patch_cut(patch, keys[k], level, &heights, &err), 0);
        assert_true(heights[0] != first); /* that of each realisation is its own */
        first = heights[0];
    }
    for (size_t n = 0; n < points; n++)
        square += heights[n] * heights[n] / (double)points;
    const double noise = sqrt(square) * number(surface, "/like/wavelength");
    print_message("noise of sub-maps %.4g, of the map %.4g\n", noise, rms);
    assert_true(fabs(noise / rms - 1) < 0.05); /* it is fitted, and 1 % by the number of points */
    like_patch_destroy(&patch);
    free(level);
    statistics_case_clear(&one_case);
    cJSON_Delete(parameters);
}

/* Adds white noise of a share of the RMS height; returns its RMS. */
static double add_white(struct height_map *map, double share) {
    const size_t points = grid_points(&map->grid);
    double *white = calloc(points, sizeof *white), square = 0;
    assert_non_null(white);
    random_uniform((struct random_key){3, 0, 0}, STREAM_HEIGHTS, 0, points, white);
    for (size_t n = 0; n < points; n++)
        square += map->z[n] * map->z[n] / (double)points;
    for (size_t n = 0; n < points; n++)
        map->z[n] += share * sqrt(12 * square) * (white[n] - 0.5); /* a mean square of 1/12 */
    free(white);
    return share * sqrt(square);
}

/* Of several maps the first is compared with sub-maps, which have its noise. */
static void noise_of_the_first_of_several(void **state) {
    (void)state;
    struct height_map maps[2] = {patch(false, 2), patch(false, 3)};
    const struct like_source sources[2] = {SOURCE, SOURCE};
    struct error err = {0};
    const double rms = add_white(&maps[0], 0.05);
    cJSON *surface = cJSON_CreateObject();
    if (like_fit_together(surface, 2, maps, sources, &err) != 0)
        fail_msg("%s", err.text);
    const double noise = number(surface, "/like/noise") * number(surface, "/like/wavelength");
    print_message("noise %.4g of %.4g\n", noise, rms);
    assert_true(fabs(noise / rms - 1) < 0.05);
    cJSON_Delete(surface);
    for (size_t m = 0; m < 2; m++)
        height_map_clear(&maps[m]);
}

/* Noise in a map is not in its surfaces: their slope is that of the map without it. */
static void noise_stays_out(void **state) {
    (void)state;
    static const double NOISE = 0.05; /* of the RMS height */
    struct height_map map = patch(false, 2);
    cJSON *clean = fitted("{}", &map);
    const double rms = add_white(&map, NOISE);
    cJSON *noisy = fitted("{}", &map);
    double slope = number(noisy, "/rms_slope"), without = number(clean, "/rms_slope");
    print_message("slope %.4f of %.4f\n", slope, without);
    assert_true(fabs(slope / without - 1) < 0.03);
    noise_is_in_sub_maps(noisy, rms);
    assert_null(json_at(clean, "/like/noise"));
    assert_non_null(strstr(
        cJSON_GetStringValue(json_at(cJSON_GetObjectItem(noisy, "like"), "/prepared")), "noise"));
    assert_null(strstr(
        cJSON_GetStringValue(json_at(cJSON_GetObjectItem(clean, "like"), "/prepared")), "noise"));
    cJSON_Delete(noisy);
    cJSON_Delete(clean);
    height_map_clear(&map);
}

/* Surfaces have no bow: of a map with one as high as its roughness it is said, with the remedy. */
static void a_bow_is_named(void **state) {
    (void)state;
    struct height_map map = patch_of(false, 1.1, 2);
    const size_t nx = map.grid.nx, points = grid_points(&map.grid);
    double square = 0;
    for (size_t n = 0; n < points; n++)
        square += map.z[n] * map.z[n] / (double)points;
    for (int bent = 0; bent < 2; bent++) {
        for (size_t n = 0; n < points && bent; n++) {
            const double x = 2 * ((double)(n % nx) + 0.5) / (double)nx - 1;
            map.z[n] += sqrt(5 * square) * (3 * x * x - 1) / 2;
        }
        struct like_source source = SOURCE;
        source.off_stated = true;
        cJSON *surface = fitted_by("{}", &map, &source);
        const char *prepared = cJSON_GetStringValue(json_at(surface, "/like/prepared"));
        print_message("prepared: %s\n", prepared);
        assert_int_equal(strstr(prepared, "a bow is left in the map") != NULL, bent);
        assert_int_equal(strstr(prepared, "\"detrend\": \"quadratic\"") != NULL, bent);
        cJSON_Delete(surface);
    }
    cJSON *surface = cJSON_CreateObject();
    struct error err = {0};
    assert_int_equal(like_fit(surface, &map, &SOURCE, &err), ERROR_INPUT);
    print_message("%s\n", err.text);
    assert_non_null(strstr(err.text, "a bow is left in the map"));
    assert_non_null(strstr(err.text, "no smooth spectrum"));
    cJSON_Delete(surface);
    height_map_clear(&map);
}

/* Surfaces are alike all over: of a map whose parts are not it is said. */
static void parts_that_differ_are_named(void **state) {
    (void)state;
    struct height_map map = patch_of(false, 1.1, 2); /* whose waves are short enough for parts */
    const char *const words = "parts of the map differ";
    for (int rougher = 0; rougher < 2; rougher++) {
        for (size_t n = grid_points(&map.grid) / 2; n < grid_points(&map.grid) && rougher; n++)
            map.z[n] *= 2;
        cJSON *surface = fitted("{}", &map);
        const char *prepared = cJSON_GetStringValue(json_at(surface, "/like/prepared"));
        print_message("prepared: %s\n", prepared);
        assert_int_equal(strstr(prepared, words) != NULL, rougher);
        cJSON_Delete(surface);
    }
    height_map_clear(&map);
}

static void refused(const struct height_map *map, const char *words) {
    cJSON *surface = cJSON_CreateObject();
    struct error err = {0};
    assert_int_equal(like_fit(surface, map, &SOURCE, &err), ERROR_INPUT);
    if (strstr(err.text, words) == NULL)
        fail_msg("\"%s\" lacks \"%s\"", err.text, words);
    cJSON_Delete(surface);
}

/* A bow of ten times the roughness is a wave longer than the map, which no sub-map less its plane
 * has: the surfaces are refused, or made by one who asks, and say what is off. */
static void what_stays_off_is_refused_or_stated(void **state) {
    (void)state;
    struct height_map map = patch(false, 8);
    struct like_source source = SOURCE;
    const struct grid *grid = &map.grid;
    double square = 0;
    for (size_t n = 0; n < grid_points(grid); n++)
        square += map.z[n] * map.z[n] / (double)grid_points(grid);
    for (size_t n = 0; n < grid_points(grid); n++) {
        double x = (double)(n % grid->nx) / (double)grid->nx - 0.5;
        map.z[n] += 40 * sqrt(square) * x * x;
    }
    refused(&map, "\"off\": \"stated\"");
    source.off_stated = true;
    cJSON *surface = fitted_by("{}", &map, &source);
    const char *prepared = cJSON_GetStringValue(json_at(surface, "/like/prepared"));
    assert_non_null(prepared);
    print_message("%s\n", prepared);
    assert_non_null(strstr(prepared, "RMS height of the surfaces: -"));
    cJSON_Delete(surface);
    height_map_clear(&map);
}

static void maps_that_cannot_be_fitted(void **state) {
    (void)state;
    struct height_map map = patch(false, 6);
    double ly = map.grid.ly;
    map.grid.ly *= 1.001;
    refused(&map, "resample");
    map.grid.ly = ly;
    strcpy(map.z_unit, "V");
    refused(&map, "z_unit");
    strcpy(map.z_unit, "m");
    for (size_t i = 0; i < grid_points(&map.grid); i++)
        map.z[i] = 1;
    refused(&map, "flat");
    height_map_clear(&map);
    assert_int_equal(height_map_shape(&map, 5, 5, 1, NULL), 0);
    map.z = calloc(25, sizeof *map.z);
    assert_non_null(map.z);
    for (size_t i = 0; i < 25; i++)
        map.z[i] = sin((double)(i * i));
    refused(&map, "too small");
    height_map_clear(&map);
}

/* Two fine maps and one of every third point. */
static void several_maps_have_one_law(void **state) {
    (void)state;
    enum { MAPS = 3 };
    struct height_map maps[MAPS] = {patch(false, 3), patch(false, 4), patch(false, 5)};
    struct like_source sources[MAPS] = {SOURCE, SOURCE, SOURCE};
    struct error err = {0};
    const struct grid grid = maps[2].grid;
    const size_t n = grid.nx / 3;
    for (size_t p = 0; p < n * n; p++)
        maps[2].z[p] = maps[2].z[p / n * 3 * grid.nx + p % n * 3];
    const double side = 3 * (double)n * grid_dx(&grid);
    maps[2].grid = (struct grid){n, n, side, side};
    sources[1].file = "other.sdf";
    sources[2].file = "coarse.gwy";
    sources[0].uncertainty = LIKE_UNCERTAINTY_POSTERIOR;
    cJSON *parameters = cJSON_CreateObject();
    cJSON *surface = cJSON_AddObjectToObject(parameters, "surface");
    if (like_fit_together(surface, MAPS, maps, sources, &err) != 0)
        fail_msg("%s", err.text);
    print_message("H %.3f, slope %.4f, shortest wave %.5f\n", number(surface, "/hurst"),
                  number(surface, "/rms_slope"), number(surface, "/like/wavelength"));
    assert_true(fabs(number(surface, "/hurst") - 0.7) < 0.15);
    assert_true(fabs(number(surface, "/rms_slope") / SLOPE - 1) < 0.1);
    assert_true(fabs(number(surface, "/like/wavelength") / SHORTEST - 1) < 0.05);
    const char *others = cJSON_GetStringValue(json_at(surface, "/like/others"));
    assert_non_null(others);
    assert_non_null(strstr(others, "other.sdf, SHA-256 " DIGEST ", 12 bytes, npy, prepared by"));
    assert_non_null(strstr(others, "coarse.gwy"));
    assert_string_equal(cJSON_GetStringValue(json_at(surface, "/like/spectrum")), "fit");
    assert_string_equal(cJSON_GetStringValue(json_at(surface, "/heights/distribution")),
                        "quantiles");
    struct statistics_case one;
    if (statistics_case_read(&one, parameters, NULL, &err) != 0)
        fail_msg("%s", err.text);
    assert_int_equal(one.like.map_count, MAPS);
    assert_int_equal(one.like.maps[2].nx, n);
    assert_true(fabs(one.like.maps[2].spacing / one.like.maps[0].spacing - 3) < 1e-9);
    assert_true(one.like.maps[0].trusted.longest > one.like.maps[0].spacing);
    statistics_case_clear(&one);
    cJSON_Delete(parameters);
    /* the longest wave that a study names */
    surface = cJSON_Parse("{\"wavelength_ratio\": 8, \"heights\": {\"distribution\": "
                          "\"gaussian\"}}");
    if (like_fit_together(surface, MAPS, maps, sources, &err) != 0)
        fail_msg("%s", err.text);
    assert_true(number(surface, "/wavelength_ratio") == 8);
    assert_true(number(surface, "/rms_slope") < SLOPE);
    cJSON_Delete(surface);
    surface = cJSON_CreateObject();
    sources[0].heights = LIKE_HEIGHTS_FIT;
    assert_int_equal(like_fit_together(surface, MAPS, maps, sources, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "quantiles, gaussian"));
    sources[0].heights = LIKE_HEIGHTS_GAUSSIAN;
    sources[1].detrend = DETREND_MEAN;
    assert_int_equal(like_fit_together(surface, MAPS, maps, sources, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "without one trend"));
    /* a map with grooves, whichever it is */
    sources[1].detrend = sources[0].detrend;
    for (size_t p = 0; p < grid_points(&maps[1].grid); p++)
        maps[1].z[p] += 6 * SLOPE * SHORTEST * sin(2 * M_PI * (double)(p % 16) / 16);
    assert_int_equal(like_fit_together(surface, MAPS, maps, sources, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "other.sdf: the map has grooves"));
    cJSON_Delete(surface);
    for (size_t m = 0; m < MAPS; m++)
        height_map_clear(&maps[m]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slope_and_band_are_found_again),
        cmocka_unit_test(makes_a_case),
        cmocka_unit_test(units_do_not_matter),
        cmocka_unit_test(the_study_stands),
        cmocka_unit_test(the_law_of_heights_stands),
        cmocka_unit_test(what_stays_off_is_refused_or_stated),
        cmocka_unit_test(several_maps_have_one_law),
        cmocka_unit_test(maps_that_cannot_be_fitted),
        cmocka_unit_test(laws),
        cmocka_unit_test(grooves),
        cmocka_unit_test(saws_on_coarse_grids),
        cmocka_unit_test(noise_stays_out),
        cmocka_unit_test(noise_of_the_first_of_several),
        cmocka_unit_test(a_bow_is_named),
        cmocka_unit_test(parts_that_differ_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
