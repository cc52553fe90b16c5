/* Protects: two measured maps are summed face to face, cropped to what both have, and their
 * correlation stands out where they are of one face alone. */
#include "core/surface/surface.h"
#include "jobs/maps/map_counter.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

static struct height_map map_of(size_t nx, size_t ny, uint64_t realisation) {
    struct height_map map = {.grid = {nx, ny, (double)nx, (double)ny}};
    const struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                      .hurst = 0.5,
                                      .wavelength_long = 16,
                                      .wavelength_rolloff = 16,
                                      .wavelength_short = 4};
    struct generator *generator = NULL;
    map.z = malloc(nx * ny * sizeof *map.z);
    assert_non_null(map.z);
    assert_int_equal(generator_create(&generator, &spectrum, &map.grid, &SURFACE_DEFAULTS, NULL),
                     0);
    assert_int_equal(
        generator_run(generator, (struct random_key){1, 0, realisation}, map.z, NULL, NULL), 0);
    generator_destroy(&generator);
    return map;
}

/* The second map is turned over about y; what is larger is cropped to the first points of both. */
static void sum_face_to_face(void **state) {
    (void)state;
    struct height_map one = map_of(64, 48, 0), other = map_of(48, 64, 1);
    struct height_map first = map_of(64, 48, 0), second = map_of(48, 64, 1);
    struct map_counter counter;
    assert_int_equal(map_counter_add(&one, &other, false, &counter, NULL), 0);
    assert_true(counter.cropped && counter.nx == 48 && counter.ny == 48);
    assert_true(one.grid.nx == 48 && one.grid.ny == 48 && one.grid.lx == 48 && one.grid.ly == 48);
    for (size_t j = 0; j < 48; j++)
        for (size_t i = 0; i < 48; i++)
            check_close(one.z[j * 48 + i], first.z[j * 64 + i] + second.z[j * 48 + 47 - i], 1e-15);
    height_map_clear(&one);
    height_map_clear(&other);
    height_map_clear(&first);
    height_map_clear(&second);
}

/* Over pairs of independent maps the correlation over its deviation has the mean square 1: within 5
 * of its standard deviations. Few stand out; a map and itself do, and so do a face and its cast. */
static void correlation(void **state) {
    (void)state;
    enum { PAIRS = 200 };
    double sum = 0;
    size_t out = 0;
    for (uint64_t pair = 0; pair < PAIRS; pair++) {
        struct height_map one = map_of(64, 64, 2 * pair), other = map_of(64, 64, 2 * pair + 1);
        struct map_counter counter;
        assert_int_equal(map_counter_add(&one, &other, true, &counter, NULL), 0);
        assert_false(counter.cropped);
        sum += pow(counter.facing.value / counter.facing.deviation, 2);
        out += map_correlation_stands_out(&counter.facing);
        height_map_clear(&one);
        height_map_clear(&other);
    }
    print_message("mean square %.3f, %zu of %d stand out\n", sum / PAIRS, out, PAIRS);
    check_close(sum / PAIRS, 1, 5 * sqrt(2.0 / PAIRS));
    assert_true(out <= 5);
    struct height_map same = map_of(64, 64, 3), again = map_of(64, 64, 3);
    struct map_counter counter;
    assert_int_equal(map_counter_add(&same, &again, true, &counter, NULL), 0);
    check_close(counter.as_held.value, 1, 1e-12);
    assert_true(map_correlation_stands_out(&counter.as_held));
    height_map_clear(&same);
    same = map_of(64, 64, 3); /* `again` is turned over by now, and is so again */
    assert_int_equal(map_counter_add(&same, &again, true, &counter, NULL), 0);
    check_close(counter.facing.value, 1, 1e-12);
    assert_true(map_correlation_stands_out(&counter.facing));
    height_map_clear(&same);
    height_map_clear(&again);
}

static void refused(const char *words, struct height_map *one, struct height_map *other,
                    bool periodic) {
    struct map_counter counter;
    struct error err = {0};
    assert_int_equal(map_counter_add(one, other, periodic, &counter, &err), ERROR_INPUT);
    if (strstr(err.text, words) == NULL)
        fail_msg("%s: %s", words, err.text);
    height_map_clear(one);
    height_map_clear(other);
}

static void what_does_not_fit(void **state) {
    (void)state;
    struct height_map one = map_of(32, 32, 0), other = map_of(32, 32, 1);
    other.grid.lx = 33;
    refused("--resample", &one, &other, true);
    one = map_of(32, 32, 0);
    other = map_of(64, 32, 1);
    refused("no common cell", &one, &other, true);
    one = map_of(32, 32, 0);
    other = map_of(32, 32, 1);
    strcpy(other.z_unit, "m");
    refused("--z-unit", &one, &other, true);
    one = map_of(32, 32, 0);
    other = map_of(32, 1, 1);
    refused("a profile and a surface", &one, &other, true);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sum_face_to_face),
        cmocka_unit_test(correlation),
        cmocka_unit_test(what_does_not_fit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
