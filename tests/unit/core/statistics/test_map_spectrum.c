/* Protects: the 95 % bands of spectral densities hold the mean of many surfaces 95 times in 100,
 * over rings and along lines, of periodic maps and of sub-maps; densities are those of roughness.h
 * and windowed_psd.h to the last bit, and along lines add up to the mean square; leakage takes
 * nothing away and adds nothing; maps of few points, and of holes, are measured or refused. */
#include "core/statistics/heights/roughness.h"
#include "core/statistics/spectra/map_spectrum.h"
#include "core/statistics/spectra/spectrum_leakage.h"
#include "core/statistics/spectra/windowed_psd.h"
#include "tests/support/check.h"
#include "tests/support/cut.h"
#include <string.h>

enum { WHOLE = 160, PIECE = 64, SURFACES = 60, RINGS = PIECE };

static struct map_spectrum *measured(const struct grid *grid, const double *z,
                                     enum boundary boundary) {
    struct map_spectrum *spectrum = NULL;
    const struct measured_map map = {grid, z, boundary};
    assert_int_equal(map_spectrum_create(&spectrum, &map, NULL), 0);
    return spectrum;
}

/* Densities and bands of one map: its rings, and its lines along both axes. */
struct bands {
    size_t count[3];
    double density[3][RINGS], low[3][RINGS], high[3][RINGS];
};

static void bands_fill(struct bands *bands, const struct map_spectrum *spectrum) {
    double wave_number[RINGS];
    bands->count[0] = spectrum->rings - 1;
    assert_true(bands->count[0] <= RINGS);
    for (size_t r = 0; r + 1 < spectrum->rings; r++) {
        bands->density[0][r] = spectrum->density[r + 1];
        map_spectrum_band(spectrum, r + 1, &bands->low[0][r], &bands->high[0][r]);
    }
    for (int axis = 0; axis < 2; axis++) {
        bands->count[axis + 1] = line_psd_count(spectrum, axis);
        assert_int_equal(bands->count[axis + 1], PIECE / 2 - 1);
        line_psd_measure(spectrum, axis, wave_number, bands->density[axis + 1],
                         bands->low[axis + 1], bands->high[axis + 1]);
        check_relative(wave_number[4], 2 * M_PI * 5 / PIECE, 1e-14);
    }
}

/* Surfaces with random amplitudes and waves of 4 points and longer, or sub-maps of such; waves that
 * are shorter have leakage alone, and are left out. */
static void covers(enum boundary boundary) {
    size_t side = boundary == BOUNDARY_OPEN ? WHOLE : PIECE, inside[3] = {0}, told[3] = {0};
    const struct grid grid = {side, side, (double)side, (double)side};
    const struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                      .hurst = 0.7,
                                      .wavelength_long = (double)side,
                                      .wavelength_rolloff = 16,
                                      .wavelength_short = 4};
    struct surface_options options = SURFACE_DEFAULTS;
    struct generator *generator = NULL;
    struct bands *bands = calloc(SURFACES, sizeof *bands);
    double *z = malloc(grid_points(&grid) * sizeof *z);
    options.amplitudes = AMPLITUDES_RANDOM;
    assert_non_null(bands);
    assert_non_null(z);
    assert_int_equal(generator_create(&generator, &spectrum, &grid, &options, NULL), 0);
    for (size_t n = 0; n < SURFACES; n++) {
        struct grid piece;
        assert_int_equal(generator_run(generator, (struct random_key){5, 0, n}, z, NULL, NULL), 0);
        double *part = cut(&grid, z, 0, 0, PIECE, PIECE, &piece);
        struct map_spectrum *found = measured(&piece, part, boundary);
        bands_fill(&bands[n], found);
        map_spectrum_destroy(&found);
        free(part);
    }
    for (size_t kind = 0; kind < 3; kind++)
        for (size_t r = 1; r < bands[0].count[kind] && r < PIECE / 4 - 2; r++) {
            double mean = 0;
            for (size_t n = 0; n < SURFACES; n++)
                mean += bands[n].density[kind][r] / SURFACES;
            for (size_t n = 0; n < SURFACES; n++, told[kind]++)
                inside[kind] += bands[n].low[kind][r] <= mean && mean <= bands[n].high[kind][r];
        }
    for (size_t kind = 0; kind < 3; kind++) {
        double share = (double)inside[kind] / (double)told[kind];
        check_close(share, 0.95, 0.025);
    }
    generator_destroy(&generator);
    free(bands);
    free(z);
}

static void bands_of_periodic_maps(void **state) {
    (void)state;
    covers(BOUNDARY_PERIODIC);
}

static void bands_of_pieces(void **state) {
    (void)state;
    covers(BOUNDARY_OPEN);
}

static void densities_are_those_of_before(void **state) {
    (void)state;
    const struct grid grid = {64, 48, 16, 12};
    double *z = whole_surface(&grid, 0.6, 3), wave_number[RINGS], density[RINGS];
    for (enum boundary boundary = BOUNDARY_PERIODIC; boundary <= BOUNDARY_OPEN; boundary++) {
        const struct measured_map map = {&grid, z, boundary};
        struct map_spectrum *spectrum = measured(&grid, z, boundary);
        assert_true(spectrum->bins <= RINGS && spectrum->bins == radial_bins(&grid));
        assert_int_equal(boundary == BOUNDARY_OPEN
                             ? windowed_psd_measure(&map, wave_number, density, NULL)
                             : psd_measure(&grid, z, wave_number, density, NULL),
                         0);
        assert_memory_equal(spectrum->density, density, spectrum->bins * sizeof *density);
        assert_memory_equal(spectrum->wave_number, wave_number, spectrum->bins * sizeof *density);
        map_spectrum_destroy(&spectrum);
    }
    free(z);
}

/* The waves of the surface have 4 points or more, none along one axis alone is left out. */
static void lines_add_up(void **state) {
    (void)state;
    const struct grid grid = {64, 64, 8, 8};
    const struct spectrum law = {.type = SPECTRUM_SELF_AFFINE,
                                 .hurst = 0.3,
                                 .wavelength_long = 2,
                                 .wavelength_rolloff = 2,
                                 .wavelength_short = 0.5};
    struct generator *generator = NULL;
    double z[64 * 64], wave_number[64], density[64], low[64], high[64];
    assert_int_equal(generator_create(&generator, &law, &grid, &SURFACE_DEFAULTS, NULL), 0);
    assert_int_equal(generator_run(generator, (struct random_key){1, 0, 0}, z, NULL, NULL), 0);
    const struct modes *modes = generator_modes(generator);
    struct map_spectrum *spectrum = measured(&grid, z, BOUNDARY_PERIODIC);
    line_psd_measure(spectrum, 1, wave_number, density, low, high);
    for (size_t m = 1; m <= 4; m++) { /* against the sum of its modes */
        double total = 0;
        for (size_t mx = 0; mx <= modes->mode_x; mx++)
            total += modes_weight(&grid, mx) * modes_power(modes, mx, (long)m);
        check_relative(density[m - 1], total * 8 / (2 * M_PI), 1e-10);
        check_relative(wave_number[m - 1], 2 * M_PI * (double)m / 8, 1e-14);
        assert_true(low[m - 1] < density[m - 1] && density[m - 1] < high[m - 1]);
    }
    map_spectrum_destroy(&spectrum);
    generator_destroy(&generator);
}

/* A constant density stays what it is. */
static void leakage_keeps_a_constant(void **state) {
    (void)state;
    static const struct grid GRIDS[] = {
        {160, 160, 160, 160}, {48, 96, 24, 96}, {200, 1, 200, 1}, {7, 9, 7, 9}};
    for (size_t g = 0; g < sizeof GRIDS / sizeof *GRIDS; g++)
        for (enum boundary boundary = BOUNDARY_PERIODIC; boundary <= BOUNDARY_OPEN; boundary++) {
            double *z = calloc(grid_points(&GRIDS[g]), sizeof *z);
            assert_non_null(z);
            z[3] = 1;
            struct map_spectrum *spectrum = measured(&GRIDS[g], z, boundary);
            struct spectrum_leakage *leakage = NULL;
            size_t last = spectrum->rings - 1;
            assert_int_equal(spectrum_leakage_create(&leakage, spectrum, 1, last, NULL), 0);
            double *density = malloc(leakage->nodes * sizeof *density);
            double *expected = malloc(last * sizeof *expected);
            assert_true(density != NULL && expected != NULL && last >= 3);
            for (size_t a = 0; a < leakage->nodes; a++)
                density[a] = 2.5;
            spectrum_leakage_apply(leakage, density, expected);
            for (size_t r = 0; r < last; r++)
                check_relative(expected[r], 2.5, 2e-3);
            free(density);
            free(expected);
            spectrum_leakage_destroy(&leakage);
            map_spectrum_destroy(&spectrum);
            free(z);
        }
}

static void few_points(void **state) {
    (void)state;
    const double z[12] = {0, 1, 3, 2, 7, 5, 4, 4, 1, 0, 2, 9};
    static const size_t SIZES[][2] = {{2, 1}, {3, 1}, {2, 2}, {2, 6}, {6, 2}, {3, 4}, {12, 1}};
    for (size_t n = 0; n < sizeof SIZES / sizeof *SIZES; n++)
        for (enum boundary boundary = BOUNDARY_PERIODIC; boundary <= BOUNDARY_OPEN; boundary++) {
            const struct grid grid = {SIZES[n][0], SIZES[n][1], 5, 4};
            double wave_number[12], density[12], low[12], high[12];
            struct map_spectrum *spectrum = measured(&grid, z, boundary);
            assert_true(spectrum->rings >= 1 && spectrum->rings <= spectrum->bins);
            for (size_t r = 1; r < spectrum->rings; r++) {
                map_spectrum_band(spectrum, r, &low[0], &high[0]);
                assert_true(low[0] <= spectrum->density[r] && spectrum->density[r] <= high[0]);
            }
            for (int axis = 0; axis < 2; axis++)
                line_psd_measure(spectrum, axis, wave_number, density, low, high);
            map_spectrum_destroy(&spectrum);
        }
}

/* A long profile by its parts: the mean of their densities, whose error falls with their number. */
static void long_profiles(void **state) {
    (void)state;
    enum { PIECES = 3, POINTS = PIECES * PROFILE_PIECE + 100 };
    const struct grid grid = {POINTS, 1, POINTS * 0.5, 1};
    const struct grid piece = {PROFILE_PIECE, 1, PROFILE_PIECE * 0.5, 1};
    double *z = malloc(POINTS * sizeof *z), mean[3] = {0}, freedom = 0;
    assert_non_null(z);
    for (size_t point = 0; point < POINTS; point++)
        z[point] = sin(0.3 * (double)point) + (double)(point * point % 101) / 50;
    for (size_t p = 0; p < PIECES; p++) {
        struct map_spectrum *part = measured(&piece, z + p * PROFILE_PIECE, BOUNDARY_OPEN);
        for (size_t r = 0; r < 3; r++)
            mean[r] += part->density[50 * r + 40] / PIECES;
        freedom = part->freedom[90];
        map_spectrum_destroy(&part);
    }
    const struct measured_map profile = {&grid, z, BOUNDARY_PERIODIC};
    struct map_spectrum *spectrum = NULL;
    assert_int_equal(profile_spectrum_create(&spectrum, &profile, NULL), 0);
    for (size_t r = 0; r < 3; r++)
        check_relative(spectrum->density[50 * r + 40], mean[r], 1e-12);
    assert_true(spectrum->freedom[90] > 2.5 * freedom);
    map_spectrum_destroy(&spectrum);
    for (size_t point = 0; point < POINTS; point++)
        z[point] = NAN;
    struct error err = {0};
    assert_int_equal(profile_spectrum_create(&spectrum, &profile, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "only holes"));
    free(z);
}

static void holes(void **state) {
    (void)state;
    const struct grid grid = {16, 16, 16, 16};
    double z[256];
    struct error err = {0};
    struct map_spectrum *spectrum = NULL;
    for (size_t point = 0; point < 256; point++)
        z[point] = NAN;
    const struct measured_map open = {&grid, z, BOUNDARY_OPEN};
    assert_int_equal(map_spectrum_create(&spectrum, &open, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "only holes"));
    for (size_t point = 5; point < 256; point++)
        z[point] = (double)(point * point % 17);
    const struct measured_map periodic = {&grid, z, BOUNDARY_PERIODIC};
    assert_int_equal(map_spectrum_create(&spectrum, &periodic, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "holes"));
    assert_null(spectrum);
    spectrum = measured(&grid, z, BOUNDARY_OPEN);
    double with = spectrum->freedom[3];
    map_spectrum_destroy(&spectrum);
    for (size_t point = 0; point < 5; point++)
        z[point] = 1;
    spectrum = measured(&grid, z, BOUNDARY_OPEN);
    check_relative(with / spectrum->freedom[3], 251. / 256, 1e-4);
    map_spectrum_destroy(&spectrum);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bands_of_periodic_maps),
        cmocka_unit_test(bands_of_pieces),
        cmocka_unit_test(densities_are_those_of_before),
        cmocka_unit_test(lines_add_up),
        cmocka_unit_test(leakage_keeps_a_constant),
        cmocka_unit_test(few_points),
        cmocka_unit_test(long_profiles),
        cmocka_unit_test(holes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
