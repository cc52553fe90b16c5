/* Protects: what is expected of sub-maps of random surfaces is what they have in the mean: the
 * densities of their rings under the window and their mean squares, with each trend taken out, also
 * with an oblique lay, unlike sides and of profiles. Bounds are 5 standard errors of the means,
 * which one of a million values exceeds, and 0.3 % for what continuous waves leave. */
#include "tests/support/check.h"

#include "core/statistics/heights/roughness.h"
#include "core/surface/surface.h"
#include "jobs/like/like_expectation.h"
#include "tests/support/effort.h"
#include <stdlib.h>
#include <string.h>

static const double ERRORS = 5, WAVES = 0.003;

struct scene {
    const char *name;
    size_t nx, ny; /* of the map, of which the cell is twice as large */
    enum detrend kind;
    double ratio, degrees; /* of a lay */
};

/* Sums of a value and of its square. */
struct mean {
    double sum, squares;
};
static void mean_add(struct mean *mean, double value) {
    mean->sum += value;
    mean->squares += value * value;
}

static void check_mean(const struct scene *scene, const char *what, size_t n,
                       const struct mean *mean, double count, double expected) {
    double found = mean->sum / count;
    double error = sqrt((mean->squares / count - found * found) / (count - 1));
    if (fabs(found - expected) < ERRORS * error + WAVES * expected)
        return;
    print_error("%s, %s %zu: %g +- %g, expected %g\n", scene->name, what, n, found, error,
                expected);
    fail();
}

static void check(const struct scene *scene) {
    enum { RINGS_MOST = 64 };
    const size_t surfaces = effort() < 3 ? 300 : 3000, nx = 2 * scene->nx;
    const size_t ny = scene->ny == 1 ? 1 : 2 * scene->ny;
    const struct grid cell = {nx, ny, (double)nx, (double)ny};
    const struct grid grid = {scene->nx, scene->ny, (double)scene->nx, (double)scene->ny};
    const double wave_number[] = {0.01, 0.3, 3.1}, density[] = {50, 50, 0.03};
    const struct spectrum spectrum = {.type = SPECTRUM_TABLE,
                                      .anisotropy = scene->ratio,
                                      .lay_angle = scene->degrees * M_PI / 180,
                                      .table_count = 3,
                                      .table_wave_number = wave_number,
                                      .table_density = density,
                                      .scale = SCALE_RMS_SLOPE,
                                      .scale_value = 0.2};
    const struct lay lay = {.ratio = scene->ratio > 0 ? scene->ratio : 1,
                            .angle = spectrum.lay_angle};
    struct surface_options options = SURFACE_DEFAULTS;
    struct generator *generator = NULL;
    struct mean rings[RINGS_MOST] = {{0}}, squares[3] = {{0}};
    double *whole = malloc(grid_points(&cell) * sizeof *whole), expected[RINGS_MOST];
    double *z = malloc(grid_points(&grid) * sizeof *z), expected_squares[3] = {0};
    static struct like_waves waves[LIKE_WAVES];
    struct like_expectation *expectation = NULL;
    size_t count = 0;
    assert_non_null(whole);
    assert_non_null(z);
    options.amplitudes = AMPLITUDES_RANDOM;
    assert_int_equal(generator_create(&generator, &spectrum, &cell, &options, NULL), 0);
    for (size_t n = 0; n < surfaces; n++) {
        const struct measured_map map = {&grid, z, BOUNDARY_OPEN};
        struct map_spectrum *circles = NULL, *ellipses = NULL;
        struct roughness roughness;
        struct trend trend;
        assert_int_equal(generator_run(generator, (struct random_key){5, 0, n}, whole, NULL, NULL),
                         0);
        for (size_t j = 0; j < grid.ny; j++)
            memcpy(z + j * grid.nx, whole + j * nx, grid.nx * sizeof *z);
        assert_int_equal(detrend(&grid, z, scene->kind, &trend, NULL), 0);
        open_roughness_measure(&map, &roughness);
        mean_add(&squares[0], roughness.rms_height * roughness.rms_height);
        mean_add(&squares[1], roughness.rms_slope * roughness.rms_slope);
        mean_add(&squares[2], roughness.rms_curvature * roughness.rms_curvature);
        assert_int_equal(map_spectrum_create(&circles, &map, NULL), 0);
        if (!lay_is_plain(&lay))
            assert_int_equal(map_spectrum_create_along(&ellipses, circles, &lay, NULL), 0);
        const struct map_spectrum *of = ellipses != NULL ? ellipses : circles;
        count = of->rings;
        assert_true(count <= RINGS_MOST);
        for (size_t r = 1; r < count; r++)
            mean_add(&rings[r], of->density[r]);
        if (n == 0) {
            assert_int_equal(like_expectation_create(&expectation, of, scene->kind, &cell, NULL),
                             0);
            assert_int_equal(like_expectation_rings(expectation, &spectrum, expected, NULL), 0);
            assert_int_equal(like_expectation_waves(expectation, &spectrum, waves, NULL), 0);
            like_expectation_destroy(&expectation);
        }
        map_spectrum_destroy(&ellipses);
        map_spectrum_destroy(&circles);
    }
    const double last = 0.9 * wave_number[2] * fmin(grid.lx, scene->ny == 1 ? grid.lx : grid.ly);
    for (size_t r = 1; r < count && 2 * M_PI * (double)r < last; r++)
        if (expected[r] > 0) /* small ellipses may have no wave */
            check_mean(scene, "ring", r, &rings[r], (double)surfaces, expected[r]);
    for (size_t n = 0; n < LIKE_WAVES; n++)
        for (size_t m = 0; m < 3; m++)
            expected_squares[m] += waves[n].squares[m];
    for (size_t m = 0; m < 3; m++)
        check_mean(scene, "square", m, &squares[m], (double)surfaces, expected_squares[m]);
    generator_destroy(&generator);
    free(whole);
    free(z);
}

static void sub_maps_have_what_is_expected(void **state) {
    (void)state;
    static const struct scene SCENES[] = {
        {"mean", 48, 48, DETREND_MEAN, 0, 0},           {"plane", 48, 48, DETREND_PLANE, 0, 0},
        {"quadratic", 48, 64, DETREND_QUADRATIC, 0, 0}, {"lay", 64, 64, DETREND_PLANE, 2, 30},
        {"profile", 128, 1, DETREND_PLANE, 0, 0},
    };
    for (size_t n = 0; n < sizeof SCENES / sizeof *SCENES; n++)
        check(&SCENES[n]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sub_maps_have_what_is_expected),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
