/* Protects: the seam distinguishes maps that repeat from sub-maps cut out of them, with spikes,
 * too.
 */
#include "core/statistics/uncertainty/seam.h"
#include "tests/support/check.h"
#include "tests/support/cut.h"
#include "tests/support/seed.h"

static struct seam seam_of(const struct grid *grid, const double *z) {
    struct seam seam = {NAN, NAN};
    assert_int_equal(seam_measure(grid, z, &seam, NULL), 0);
    return seam;
}

/* The seam of a periodic map is its roughest position at random, and by little (F18.3). */
static void periodic_maps_have_none(void **state) {
    (void)state;
    const struct grid grids[] = {{128, 128, 128, 128}, {256, 1, 256, 1}};
    for (size_t g = 0; g < 2; g++) {
        size_t maps = 40;
        for (size_t r = 0; r < maps; r++) {
            double *z = whole_surface(&grids[g], r % 2 == 0 ? 0.2 : 0.8, r);
            struct seam seam = seam_of(&grids[g], z);
            assert_false(seam_is_rough(&seam));
            free(z);
        }
    }
}

/* Differences that are small at the seam at random are rare even in profiles, whose seam is one
 * point. */
static void pieces_have_one(void **state) {
    (void)state;
    const struct grid grids[] = {{128, 128, 128, 128}, {256, 1, 256, 1}};
    for (size_t g = 0; g < 2; g++) {
        size_t smooth = 0, maps = 40;
        for (size_t r = 0; r < maps; r++) {
            struct grid piece;
            double *z = whole_surface(&grids[g], r % 2 == 0 ? 0.2 : 0.8, r);
            double *part = cut(&grids[g], z, 3, 0, 100, g == 0 ? 90 : 1, &piece);
            struct seam seam = seam_of(&piece, part);
            smooth += seam_is_rough(&seam) ? 0 : 1;
            if (g == 0)
                assert_true(seam.x > 2 && seam.y > 2);
            free(z);
            free(part);
        }
        assert_true(smooth <= (g == 0 ? 0 : 4));
    }
}

/* One spike in each third column, 15 times the RMS height, leaves the seam of a sub-map as rough as
 * it was, and that of a map that repeats as smooth. */
static void spikes_hide_no_seam(void **state) {
    (void)state;
    const struct grid grid = {128, 128, 128, 128};
    for (size_t r = 0; r < 10; r++) {
        struct grid piece;
        double *z = whole_surface(&grid, 0.8, r);
        double *part = cut(&grid, z, 3, 0, 100, 90, &piece);
        double square = 0;
        for (size_t n = 0; n < 128 * 128; n++)
            square += z[n] * z[n] / (128 * 128);
        for (size_t n = 0; n < 30; n++) {
            part[n * 3 * 101 % 9000] += 15 * sqrt(square);
            z[n * 3 * 131 % (128 * 128)] += 15 * sqrt(square);
        }
        struct seam open = seam_of(&piece, part), whole = seam_of(&grid, z);
        assert_true(open.x > 1.5 && open.y > 1.5);
        assert_false(seam_is_rough(&whole));
        free(z);
        free(part);
    }
}

/* First differences detect a step: at the seam it is 10, inside 1. */
static void a_tilt_is_a_step(void **state) {
    (void)state;
    double z[11 * 10];
    const struct grid grid = {11, 10, 11, 10};
    for (size_t point = 0; point < 110; point++)
        z[point] = (double)(point % 11);
    struct seam seam = seam_of(&grid, z);
    assert_true(seam.x >= 10);
    assert_true(seam.y == 0);
}

static void odd_maps(void **state) {
    (void)state;
    double z[100] = {0};
    const struct grid grid = {10, 10, 1, 1}, short_one = {8, 1, 1, 1};
    struct seam seam = seam_of(&grid, z);
    assert_true(seam.x == 0 && seam.y == 0); /* flat */
    assert_true(isinf(seam_of(&short_one, z).x));
    for (size_t j = 0; j < 10; j++)
        z[j * 10] = NAN; /* nothing to compare across x */
    seam = seam_of(&grid, z);
    assert_true(isinf(seam.x) && seam.y == 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(periodic_maps_have_none),
        cmocka_unit_test(pieces_have_one),
        cmocka_unit_test(spikes_hide_no_seam),
        cmocka_unit_test(a_tilt_is_a_step),
        cmocka_unit_test(odd_maps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
