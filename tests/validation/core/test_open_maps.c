/* Protects: a sub-map has the parameters of the inside of its surface: 512 x 512 points of 1024 x
 * 1024, 8 a shortest wave, H = 0.2 and 0.8, with and without a tilt. The inside is known by the
 * exact derivatives, and the refined summits, of the periodic whole at the same positions.
 * Differences are compared with the scatter of the four quarters of the whole, each of which is
 * such a sub-map. Taken as periodic, as a control, the sub-maps are far off. */
#include "core/map/preparation/detrend.h"
#include "core/statistics/heights/roughness.h"
#include "core/statistics/summits/local_wave.h"
#include "core/statistics/summits/open_summits.h"
#include "core/statistics/summits/refined.h"
#include "core/statistics/uncertainty/seam.h"
#include "core/surface/surface.h"
#include "core/surface/transform.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

enum { WHOLE = 1024, PIECE = 512, MODES = 128, QUARTERS = 4 };

static const struct grid GRID = {WHOLE, WHOLE, WHOLE, WHOLE}, PART = {PIECE, PIECE, PIECE, PIECE};

/* What is compared. */
enum { SLOPE, CURVATURE, ALPHA, SUMMITS, VALUES };
static const char *const NAMES[VALUES] = {"RMS slope", "RMS curvature", "alpha", "summit density"};

static double *heights_create(size_t points) {
    double *z = malloc(points * sizeof *z);
    assert_non_null(z);
    return z;
}

static double *surface_create(double hurst) {
    const struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                      .hurst = hurst,
                                      .wavelength_long = (double)WHOLE / 8,
                                      .wavelength_rolloff = (double)WHOLE / 8,
                                      .wavelength_short = (double)WHOLE / MODES};
    struct generator *generator = NULL;
    double *z = heights_create(grid_points(&GRID));
    assert_int_equal(generator_create(&generator, &spectrum, &GRID, &SURFACE_DEFAULTS, NULL), 0);
    assert_int_equal(generator_run(generator, (struct random_key){5, 0, 0}, z, NULL, NULL), 0);
    generator_destroy(&generator);
    return z;
}

/* The exact derivative of order p along x and q along y, p + q even or 1. */
static void derive(const double *z, int p, int q, double *out) {
    struct transform *transform = NULL;
    assert_int_equal(transform_create(&transform, &GRID, MODES, MODES, NULL), 0);
    transform_forward(transform, z);
    double complex *mode = transform_spectrum(transform), unit = p + q == 1 ? I : -1;
    for (size_t mx = 0; mx <= MODES; mx++)
        for (size_t row = 0; row < WHOLE; row++) {
            double kx = 2 * M_PI * (double)mx / WHOLE;
            double ky = 2 * M_PI * (row <= WHOLE / 2 ? (double)row : (double)row - WHOLE) / WHOLE;
            mode[mx * WHOLE + row] *= unit * pow(kx, p) * pow(ky, q);
        }
    transform_inverse(transform, out);
    transform_destroy(&transform);
}

/* The corner of a quarter. */
static size_t corner_x(int quarter) {
    return quarter % 2 == 0 ? 100 : 100 + PIECE;
}
static size_t corner_y(int quarter) {
    return quarter < 2 ? 60 : 60 + PIECE;
}

/* Adds up f(x) over a quarter, periodic. */
static double quarter_mean(const double *z, int quarter) {
    double total = 0;
    for (size_t j = 0; j < PIECE; j++)
        for (size_t i = 0; i < PIECE; i++)
            total += z[(corner_y(quarter) + j) % WHOLE * WHOLE + (corner_x(quarter) + i) % WHOLE];
    return total / (PIECE * PIECE);
}

static void square(double *z) {
    for (size_t point = 0; point < grid_points(&GRID); point++)
        z[point] *= z[point];
}

static void insides_of_summits(const double *z, double inside[QUARTERS][VALUES]) {
    struct refined *refined = NULL;
    struct summit_list list = {0};
    assert_int_equal(refined_create(&refined, &GRID, MODES, MODES, NULL), 0);
    assert_int_equal(refined_find(refined, z, &list, NULL), 0);
    for (int quarter = 0; quarter < QUARTERS; quarter++) {
        size_t count = 0;
        for (size_t s = 0; s < list.count; s++) {
            double x = fmod(list.summits[s].x - (double)corner_x(quarter) + WHOLE, WHOLE);
            double y = fmod(list.summits[s].y - (double)corner_y(quarter) + WHOLE, WHOLE);
            count += x < PIECE && y < PIECE ? 1 : 0;
        }
        inside[quarter][SUMMITS] = (double)count / (PIECE * PIECE);
    }
    summit_list_clear(&list);
    refined_destroy(&refined);
}

static void insides(const double *z, double inside[QUARTERS][VALUES]) {
    static const int ORDERS[][2] = {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {0, 2}};
    double *work = heights_create(grid_points(&GRID)), *sum = heights_create(grid_points(&GRID));
    double means[5][QUARTERS], curvature[QUARTERS];
    memset(sum, 0, grid_points(&GRID) * sizeof *sum);
    for (size_t d = 0; d < 5; d++) {
        if (d == 0)
            memcpy(work, z, grid_points(&GRID) * sizeof *work);
        else
            derive(z, ORDERS[d][0], ORDERS[d][1], work);
        for (size_t point = 0; point < grid_points(&GRID) && d >= 3; point++)
            sum[point] += work[point] / 2;
        for (int quarter = 0; quarter < QUARTERS; quarter++)
            curvature[quarter] = d == 0 ? quarter_mean(work, quarter) : 0;
        square(work);
        for (int quarter = 0; quarter < QUARTERS; quarter++)
            means[d][quarter] = quarter_mean(work, quarter) - pow(curvature[quarter], 2);
    }
    square(sum);
    for (int quarter = 0; quarter < QUARTERS; quarter++) {
        double m2 = (means[1][quarter] + means[2][quarter]) / 2;
        double m4 = (means[3][quarter] + means[4][quarter]) / 2;
        inside[quarter][SLOPE] = sqrt(2 * m2);
        inside[quarter][CURVATURE] = sqrt(quarter_mean(sum, quarter));
        inside[quarter][ALPHA] = means[0][quarter] * m4 / (m2 * m2);
    }
    insides_of_summits(z, inside);
    free(work);
    free(sum);
}

static double *piece_create(const double *z, int quarter, bool tilted) {
    double *piece = heights_create(grid_points(&PART));
    for (size_t j = 0; j < PIECE; j++)
        for (size_t i = 0; i < PIECE; i++)
            piece[j * PIECE + i] =
                z[(corner_y(quarter) + j) % WHOLE * WHOLE + (corner_x(quarter) + i) % WHOLE] +
                (tilted ? 4 + 0.05 * (double)i - 0.02 * (double)j : 0);
    return piece;
}

/* Measures as `characterise` does a map that it finds to be open. */
static void piece_measure(double *piece, double *values) {
    const struct measured_map map = {&PART, piece, BOUNDARY_OPEN};
    struct summit_list list = {0};
    struct moments moments;
    struct trend trend;
    struct seam seam;
    double searched;
    assert_int_equal(seam_measure(&PART, piece, &seam, NULL), 0);
    assert_true(seam.x > SEAM_LIMIT && seam.y > SEAM_LIMIT);
    assert_int_equal(detrend(&PART, piece, DETREND_PLANE, &trend, NULL), 0);
    assert_int_equal(local_moments_measure(&map, &moments, NULL), 0);
    assert_int_equal(open_summits_find(&map, SUMMITS_REFINED, &list, &searched, NULL), 0);
    values[SLOPE] = moments.rms_slope;
    values[CURVATURE] = moments.rms_curvature;
    values[ALPHA] = moments.nayak_alpha;
    values[SUMMITS] = (double)list.count / searched;
    summit_list_clear(&list);
}

/* Between two quarters of one surface. */
static double scatter_of(double inside[QUARTERS][VALUES], int value) {
    double mean = 0, variance = 0;
    for (int quarter = 0; quarter < QUARTERS; quarter++)
        mean += inside[quarter][value] / QUARTERS;
    for (int quarter = 0; quarter < QUARTERS; quarter++)
        variance += pow(inside[quarter][value] - mean, 2) / (QUARTERS - 1);
    return sqrt(variance);
}

static void pieces_tell_of_the_inside(void **state) {
    (void)state;
    static const double HURST[] = {0.2, 0.8};
    for (size_t h = 0; h < 2; h++) {
        double *z = surface_create(HURST[h]), inside[QUARTERS][VALUES];
        insides(z, inside);
        for (int quarter = 0; quarter < QUARTERS; quarter++)
            for (int tilted = 0; tilted < 2; tilted++) {
                double *piece = piece_create(z, quarter, tilted == 1), found[VALUES];
                struct moments periodic;
                assert_int_equal(roughness_spectral(&PART, piece, &periodic, NULL), 0);
                assert_true(periodic.rms_curvature > 1.5 * inside[quarter][CURVATURE]);
                piece_measure(piece, found);
                for (int value = 0; value < VALUES; value++) {
                    double scatter = scatter_of(inside, value), expected = inside[quarter][value];
                    print_message("H %.1f quarter %d tilt %d %s: %.5g, inside %.5g, scatter %.2g, "
                                  "off %+.2f of it\n",
                                  HURST[h], quarter, tilted, NAMES[value], found[value], expected,
                                  scatter, (found[value] - expected) / scatter);
                    check_close(found[value], expected, scatter);
                }
                free(piece);
            }
        free(z);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(pieces_tell_of_the_inside)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
