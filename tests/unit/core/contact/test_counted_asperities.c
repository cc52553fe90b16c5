/* Protects: theories of asperities by counted summits: spheres and ellipses of Hertz's solution at
 * summits whose curvatures are known, by another form of it; and surfaces without summits. Rough
 * surfaces against theory are in tests/validation/jobs/test_contact.c. */
#include "core/contact/counted_asperities.h"
#include "tests/support/drawn_summits.h"

enum { SIDE = 256 };

static struct counted_asperities *create(const struct grid *grid, bool open) {
    struct counted_asperities *asperities = NULL;
    struct error err = {0};
    if (counted_asperities_create(&asperities, grid, open, &err) != 0)
        fail_msg("%s", err.text);
    return asperities;
}

static void take(struct counted_asperities *asperities, const double *z, double height,
                 double slope) {
    struct error err = {0};
    if (counted_asperities_take(asperities, z, height, slope, &err) != 0)
        fail_msg("%s", err.text);
}

/* z = cos x + amplitude cos(steep y): as many equal summits as `steep`, of curvatures 1 and
 * amplitude steep^2. */
static void fill(double *z, double steep, double amplitude) {
    for (size_t j = 0; j < SIDE; j++)
        for (size_t i = 0; i < SIDE; i++)
            z[j * SIDE + i] = cos(2 * M_PI * (double)i / SIDE) +
                              amplitude * cos(2 * M_PI * steep * (double)j / SIDE);
}

/* The load that gives this compression of `summits` equal summits, and its area: by Johnson's
 * ellipses of curvatures 1 and kappa. Second differences of 256 points are off by (2 pi/256)^2/12 a
 * wave, up to 0.1 % of the steepest. */
static void summits_are_hertzs(void **state) {
    (void)state;
    static const struct {
        double steep, amplitude;
    } CASES[] = {{1, 1}, {3, 1.0 / 9}, {2, 1}, {3, 1}};
    const struct grid grid = {SIDE, SIDE, 2 * M_PI, 2 * M_PI};
    const double height = 0.7, slope = 0.3, compression = 0.01;
    struct counted_asperities *asperities = create(&grid, false);
    struct ellipse *ellipses = malloc(ELLIPSES * sizeof *ellipses);
    double *z = malloc(sizeof(double) * SIDE * SIDE);
    assert_non_null(ellipses);
    assert_non_null(z);
    ellipses_tabulate(ellipses);
    for (size_t a = 0; a < sizeof CASES / sizeof *CASES; a++) {
        double steep = CASES[a].steep, amplitude = CASES[a].amplitude;
        double kappa = amplitude * steep * steep, cell = 4 * M_PI * M_PI;
        struct ellipse at = ellipse_at(ellipses, fmax(kappa, 1));
        double sphere = sqrt(2 / (1 + kappa)); /* of all the mean curvature */
        fill(z, steep, amplitude);
        take(asperities, z, height, slope);
        double load = steep * at.load * pow(compression, 1.5) / cell / slope;
        check_relative(counted_asperities_area(asperities, COUNTED_BGT, load),
                       steep * at.area * compression / cell, 0.004);
        load = steep * 4 / 3 * sphere * pow(compression, 1.5) / cell / slope;
        check_relative(counted_asperities_area(asperities, COUNTED_GW, load),
                       steep * M_PI * sphere * sphere * compression / cell, 0.004);
    }
    counted_asperities_destroy(&asperities);
    free(ellipses);
    free(z);
}

static void flat_surfaces_have_none(void **state) {
    (void)state;
    const struct grid grid = {16, 16, 1, 1};
    double z[256] = {0};
    struct counted_asperities *asperities = create(&grid, false);
    take(asperities, z, 1, 1);
    assert_true(isnan(counted_asperities_area(asperities, COUNTED_BGT, 0.1)));
    /* one summit, which alone bears any load */
    z[35] = 1;
    take(asperities, z, 1, 1);
    assert_true(counted_asperities_area(asperities, COUNTED_BGT, 1e-6) > 0);
    assert_true(counted_asperities_area(asperities, COUNTED_BGT, 10) >
                counted_asperities_area(asperities, COUNTED_BGT, 1));
    counted_asperities_destroy(&asperities);
}

/* A map that does not repeat has no summit at its border, from which half of the neighbours lack.
 */
static void borders_of_open_maps(void **state) {
    (void)state;
    static const size_t PLACES[] = {3, 3 * 16, 3 * 16 + 15, 15 * 16 + 3};
    const struct grid grid = {16, 16, 1, 1};
    for (size_t a = 0; a < sizeof PLACES / sizeof *PLACES; a++) {
        double z[256] = {0};
        struct counted_asperities *repeats = create(&grid, false), *ends = create(&grid, true);
        z[PLACES[a]] = 1;
        take(repeats, z, 1, 1);
        take(ends, z, 1, 1);
        assert_true(counted_asperities_area(repeats, COUNTED_BGT, 0.1) > 0);
        assert_true(isnan(counted_asperities_area(ends, COUNTED_BGT, 0.1)));
        z[5 * 16 + 7] = 1;
        take(ends, z, 1, 1);
        assert_true(counted_asperities_area(ends, COUNTED_BGT, 0.1) > 0);
        counted_asperities_destroy(&repeats);
        counted_asperities_destroy(&ends);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(summits_are_hertzs),
        cmocka_unit_test(flat_surfaces_have_none),
        cmocka_unit_test(borders_of_open_maps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
