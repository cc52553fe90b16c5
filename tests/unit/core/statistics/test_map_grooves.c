/* Protects: grooves in maps: found with period, angle and depth within the reported errors, not
 * found in random faces with or without a lay, nor in offsets of scan lines, taken out so that the
 * law of the rest is found, and no offsets of scan lines. */
#include "core/map/artefacts/map_artefacts.h"
#include "core/statistics/grooves/groove_extension.h"
#include "core/statistics/grooves/map_grooves.h"
#include "core/statistics/spectra/spectrum_fit.h"
#include "core/surface/grooves/grooves.h"
#include "tests/support/check.h"
#include "tests/support/effort.h"
#include "tests/support/random_part.h"
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SEED = 7 };

static const struct grid GRID = {SIDE, SIDE, SIDE, SIDE};

static void make(struct maker *maker, uint64_t number, double height) {
    const struct random_key key = {SEED, 0, number};
    assert_int_equal(generator_run(maker->generator, key, maker->whole, NULL, NULL), 0);
    for (size_t j = 0; j < SIDE; j++)
        for (size_t i = 0; i < SIDE; i++)
            maker->z[j * SIDE + i] = height * maker->whole[j * WHOLE + i];
}

struct truth {
    enum groove_shape shape;
    double period, angle, depth, phase;
};

static void add(double *z, const struct truth *truth) {
    const struct groove_profile profile = {.shape = truth->shape};
    for (size_t j = 0; j < SIDE; j++)
        for (size_t i = 0; i < SIDE; i++)
            z[j * SIDE + i] +=
                truth->depth * groove_profile_height(&profile, ((double)i * sin(truth->angle) -
                                                                (double)j * cos(truth->angle)) /
                                                                       truth->period +
                                                                   truth->phase);
}

/* Draws period (7 to 11 points), angle and phase, none of them on the grid of the waves. */
static struct truth draw(uint64_t number, enum groove_shape shape, double depth) {
    double u[3];
    random_uniform((struct random_key){SEED, 0, number}, STREAM_GROOVES, 10, 3, u);
    return (struct truth){shape, 7 + 4 * u[0], (u[1] - 0.5) * M_PI, depth, u[2]};
}

static struct map_grooves find(const double *z, enum boundary boundary) {
    const struct measured_map map = {&GRID, z, boundary};
    struct map_grooves out;
    assert_int_equal(map_grooves_find(&out, &map, NULL), 0);
    return out;
}

/* 95 % intervals hold the truth in 38 of 40 sines of depth 1, less three deviations of such a count
 * (tests/validation/core/test_groove_errors.c has more). */
static void errors_hold(void **state) {
    (void)state;
    enum { MAPS = 40, LOW = 34 };
    struct maker maker = maker_create(1);
    int period = 0, angle = 0, depth = 0, found = 0;
    for (uint64_t r = 0; r < MAPS; r++) {
        const struct truth truth = draw(r, GROOVE_SINE, 1);
        make(&maker, r, 1);
        add(maker.z, &truth);
        const struct map_grooves grooves = find(maker.z, BOUNDARY_OPEN);
        if (grooves.families != 1)
            continue;
        const struct map_groove *g = &grooves.family[0];
        found++;
        period += fabs(g->period - truth.period) < 1.96 * g->period_error;
        angle += fabs(remainder(g->angle - truth.angle, M_PI)) < 1.96 * g->angle_error;
        depth += fabs(g->fit.depth - truth.depth) < 1.96 * g->fit.depth_error;
    }
    print_message("[   NOTE   ] of %d maps %d found; period, angle, depth within %d, %d, %d\n",
                  MAPS, found, period, angle, depth);
    assert_true(found == MAPS);
    assert_true(period >= LOW);
    assert_true(angle >= LOW);
    assert_true(depth >= LOW);
    maker_destroy(&maker);
}

/* Shapes with harmonics are distinguished: all but one of 12 of each, as a fold of a saw's
 * harmonics may look like a line of its own. */
static void shapes_are_found(void **state) {
    (void)state;
    enum { MAPS = 12 };
    struct maker maker = maker_create(1);
    for (int shape = GROOVE_ARCS; shape <= GROOVE_SAW; shape++) {
        int right = 0;
        for (uint64_t r = 0; r < MAPS; r++) {
            struct truth truth = draw(r, (enum groove_shape)shape, 1);
            truth.period += 3;
            make(&maker, r, 1);
            add(maker.z, &truth);
            const struct map_grooves grooves = find(maker.z, BOUNDARY_OPEN);
            assert_true(grooves.families >= 1);
            const struct map_groove *g = &grooves.family[0];
            right += g->fit.shape == (enum groove_shape)shape &&
                     fabs(g->period / truth.period - 1) < 0.002 && fabs(g->fit.depth - 1) < 0.1;
        }
        print_message("[   NOTE   ] %s: %d of %d\n", GROOVE_SHAPE_NAMES[shape], right, MAPS);
        assert_true(right >= MAPS - 1);
    }
    maker_destroy(&maker);
}

/* Of 200 random faces (a third of them unless all are tried), half of them with a lay of 4, at most
 * 2 have grooves. */
static void random_faces_have_none(void **state) {
    (void)state;
    enum { MOST = 2 };
    const uint64_t maps = cases_of(100);
    size_t found = 0;
    for (int lay = 0; lay < 2; lay++) {
        struct maker maker = maker_create(lay == 0 ? 1 : 4);
        for (uint64_t r = 0; r < maps; r++) {
            make(&maker, r, 1);
            found += find(maker.z, BOUNDARY_OPEN).families;
        }
        maker_destroy(&maker);
    }
    print_message("[   NOTE   ] grooves in %zu of %" PRIu64 " random faces\n", found, 2 * maps);
    assert_true(found <= MOST);
}

/* Honing: two families of arcs, each with its angle. */
static void crossed_families_are_two(void **state) {
    (void)state;
    struct maker maker = maker_create(1);
    for (uint64_t r = 0; r < 5; r++) {
        const struct truth first = draw(r, GROOVE_ARCS, 1);
        struct truth second = first;
        second.angle += 0.9;
        make(&maker, r, 1);
        add(maker.z, &first);
        add(maker.z, &second);
        const struct map_grooves grooves = find(maker.z, BOUNDARY_OPEN);
        assert_int_equal(grooves.families, 2);
        const double apart =
            fabs(remainder(grooves.family[0].angle - grooves.family[1].angle, M_PI));
        check_close(apart, 0.9, 0.01);
    }
    maker_destroy(&maker);
}

/* The law of the rest is that of the random part, whose waves are shorter than the grooves; with
 * them it is none. What is left has no grooves. */
static void the_rest_has_its_law(void **state) {
    (void)state;
    const struct spectrum_fit_request by_the_map = {0};
    struct maker maker = maker_create(1);
    const struct truth truth = {GROOVE_ARCS, 13.7, 0.3, 3, 0.2};
    const struct measured_map map = {&GRID, maker.z, BOUNDARY_OPEN};
    struct map_spectrum *spectrum = NULL;
    struct spectrum_fit with, without;
    make(&maker, 1, 1);
    add(maker.z, &truth);
    assert_int_equal(map_spectrum_create(&spectrum, &map, NULL), 0);
    assert_int_equal(spectrum_fit_measure(spectrum, &by_the_map, &with, NULL), 0);
    map_spectrum_destroy(&spectrum);
    struct map_grooves grooves = find(maker.z, BOUNDARY_OPEN);
    assert_int_equal(grooves.families, 1);
    map_grooves_take(&grooves, &GRID, maker.z);
    assert_int_equal(find(maker.z, BOUNDARY_OPEN).families, 0);
    assert_int_equal(map_spectrum_create(&spectrum, &map, NULL), 0);
    assert_int_equal(spectrum_fit_measure(spectrum, &by_the_map, &without, NULL), 0);
    map_spectrum_destroy(&spectrum);
    assert_true(without.hurst.low < 0.8 && without.hurst.high > 0.8);
    assert_true(without.deviance < without.deviance_limit);
    assert_true(with.deviance > 2 * without.deviance);
    maker_destroy(&maker);
}

/* Of periods so short that the points hold one line all shapes are alike, and a sine is taken. */
static void short_ones_are_sines(void **state) {
    (void)state;
    struct maker maker = maker_create(1);
    for (uint64_t r = 0; r < 4; r++) {
        const struct truth truth = {GROOVE_SINE, 2.7, 0, 0.3, 0.1};
        make(&maker, r, 1);
        add(maker.z, &truth);
        const struct map_grooves grooves = find(maker.z, BOUNDARY_OPEN);
        assert_int_equal(grooves.families, 1);
        assert_int_equal(grooves.family[0].fit.shape, GROOVE_SINE);
    }
    maker_destroy(&maker);
}

/* Grooves along the scan lines, every 2.7 of them, are none of these; offsets are. */
static void grooves_are_no_offsets(void **state) {
    (void)state;
    struct maker maker = maker_create(1);
    for (int offsets = 0; offsets < 2; offsets++) {
        struct map_artefacts artefacts = {.sought = false};
        const struct truth truth = {GROOVE_SINE, 2.7, 0, 0.3, 0.1};
        double offset[SIDE];
        make(&maker, 3, 1);
        random_uniform((struct random_key){SEED, 0, 1}, STREAM_GROOVES, 20, SIDE, offset);
        if (offsets == 0)
            add(maker.z, &truth);
        for (size_t n = 0; n < SIDE * SIDE && offsets == 1; n++)
            maker.z[n] += 0.3 * offset[n / SIDE];
        assert_int_equal(map_artefacts_find_left(&GRID, maker.z, &artefacts, NULL), 0);
        assert_int_equal(artefacts.lines.found, offsets == 1);
        assert_true(artefacts.lines.p_value < 1 || offsets == 0);
    }
    maker_destroy(&maker);
}

/* Adds offsets of that RMS value to lines along an axis (0: rows, 1: columns): white, or each a
 * step from the last, as of an instrument that drifts. */
static void add_offsets(double *z, uint64_t number, int axis, double rms, bool drift) {
    double offset[SIDE], last = 0;
    random_uniform((struct random_key){SEED, 2, number}, STREAM_GROOVES, 20, SIDE, offset);
    for (size_t l = 0; l < SIDE; l++)
        offset[l] = last = rms * sqrt(12) * (offset[l] - 0.5) + (drift ? last : 0);
    for (size_t n = 0; n < SIDE * SIDE; n++)
        z[n] += offset[axis == 0 ? n / SIDE : n % SIDE];
}

/* Offsets of scan lines are waves across them with nothing along them, which a random face has
 * nowhere. They are no grooves but in one of 300, as was tried once; without their test there are
 * grooves in nine of ten. */
static void offsets_are_no_grooves(void **state) {
    (void)state;
    static const double RMS[] = {0.02, 0.2, 1};
    const uint64_t maps = cases_of(60);
    struct maker maker = maker_create(1);
    size_t found = 0;
    for (uint64_t r = 0; r < maps; r++) {
        make(&maker, r, 1);
        add_offsets(maker.z, r, (int)(r % 2), RMS[r % 3], r % 4 > 1);
        found += find(maker.z, BOUNDARY_OPEN).families;
    }
    print_message("[   NOTE   ] grooves in %zu of %" PRIu64 " maps with offsets\n", found, maps);
    assert_true(found <= 1 + maps / 100);
    maker_destroy(&maker);
}

/* Grooves along the lines, also sharp ones, whose harmonics are many of the waves there, are
 * found. They are beside offsets of a tenth of their depth, too, but for saws, whose harmonics fall
 * no faster than those of offsets that drift. */
static void grooves_along_lines_are_found(void **state) {
    (void)state;
    static const double PERIOD[] = {7.3, 12};
    struct maker maker = maker_create(1);
    for (int shape = GROOVE_SINE; shape <= GROOVE_SAW; shape++)
        for (size_t p = 0; p < 4; p++) {
            const struct truth truth = {(enum groove_shape)shape, PERIOD[p / 2],
                                        p % 2 == 0 ? 0 : M_PI / 2, 2, 0.3};
            make(&maker, p, 1);
            add(maker.z, &truth);
            for (int offsets = 0; offsets < (shape == GROOVE_SAW ? 1 : 2); offsets++) {
                if (offsets == 1)
                    add_offsets(maker.z, p, p % 2 == 0 ? 0 : 1, 0.2, false);
                const struct map_grooves grooves = find(maker.z, BOUNDARY_OPEN);
                if (grooves.families != 1 ||
                    fabs(grooves.family[0].period / truth.period - 1) > 0.01)
                    fail_msg("%s every %g, offsets %d: %zu families, every %g",
                             GROOVE_SHAPE_NAMES[shape], truth.period, offsets, grooves.families,
                             grooves.family[0].period);
            }
        }
    maker_destroy(&maker);
}

/* Maps too small for four periods, flat ones and ones with holes. */
static void odd_maps(void **state) {
    (void)state;
    const struct grid small = {15, 128, 15, 128};
    struct maker maker = maker_create(1);
    struct map_grooves grooves;
    make(&maker, 0, 1);
    const struct measured_map few = {&small, maker.z, BOUNDARY_OPEN};
    assert_int_equal(map_grooves_find(&grooves, &few, NULL), 0);
    assert_int_equal(grooves.families, 0);
    memset(maker.z, 0, SIDE * SIDE * sizeof *maker.z);
    assert_int_equal(find(maker.z, BOUNDARY_OPEN).families, 0);
    const struct truth truth = {GROOVE_SINE, 9.3, 1.1, 1, 0.4};
    make(&maker, 2, 1);
    add(maker.z, &truth);
    for (size_t n = 0; n < SIDE * SIDE; n += 31)
        maker.z[n] = NAN;
    grooves = find(maker.z, BOUNDARY_OPEN);
    assert_int_equal(grooves.families, 1);
    check_close(grooves.family[0].period, 9.3, 0.1);
    for (size_t n = 0; n < SIDE * SIDE; n++)
        maker.z[n] = NAN;
    const struct measured_map holes = {&GRID, maker.z, BOUNDARY_OPEN};
    assert_int_equal(map_grooves_find(&grooves, &holes, NULL), ERROR_INPUT);
    maker_destroy(&maker);
}

/* Heights at x points from the middle of a row of the cell, of the steepest step between them. */
static double steepest(const double *row, size_t first, size_t last) {
    double most = 0;
    for (size_t i = first; i < last; i++)
        most = fmax(most, fabs(row[i + 1] - row[i]));
    return most;
}

/* On a cell of twice the sides, and on finer grids of it, grooves are those of the map within it
 * and go on without a step to where it repeats, though their periods do not fit. */
static void they_go_on_beyond_the_map(void **state) {
    (void)state;
    enum { CELL = 2 * SIDE, FINE = 3 * CELL };
    static const struct grid CELLS = {CELL, CELL, CELL, CELL}, FINER = {FINE, FINE, CELL, CELL};
    static const enum groove_shape SHAPES[] = {GROOVE_SINE, GROOVE_ARCS, GROOVE_HARMONICS};
    struct maker maker = maker_create(1);
    double *cell = malloc(CELL * CELL * sizeof *cell), *fine = malloc(FINE * FINE * sizeof *fine);
    assert_non_null(cell);
    assert_non_null(fine);
    for (size_t s = 0; s < sizeof SHAPES / sizeof *SHAPES; s++) {
        const struct truth truth = {SHAPES[s] == GROOVE_HARMONICS ? GROOVE_SINE : SHAPES[s], 9.3,
                                    1.1, 1, 0.3};
        make(&maker, s, 0.3);
        add(maker.z, &truth);
        if (SHAPES[s] == GROOVE_HARMONICS) { /* a shape without a name */
            const struct truth third = {GROOVE_SINE, 9.3 / 3, 1.1, 0.7, 0.1};
            add(maker.z, &third);
        }
        const struct map_grooves grooves = find(maker.z, BOUNDARY_OPEN);
        assert_int_equal(grooves.families, 1);
        assert_int_equal(grooves.family[0].fit.shape, SHAPES[s]);
        assert_true(fabs(remainder(2 * grooves.family[0].lines.mx, 1)) > 0.1);
        memset(cell, 0, CELL * CELL * sizeof *cell);
        memset(fine, 0, FINE * FINE * sizeof *fine);
        assert_int_equal(groove_extension_add(&grooves, &GRID, &CELLS, 1, cell, NULL), 0);
        assert_int_equal(groove_extension_add(&grooves, &GRID, &FINER, 1, fine, NULL), 0);
        memset(maker.z, 0, SIDE * SIDE * sizeof *maker.z);
        map_grooves_take(&grooves, &GRID, maker.z);
        for (size_t j = 0; j < CELL; j++)
            for (size_t i = 0; i < CELL; i++) {
                if (i < SIDE && j < SIDE)
                    assert_true(fabs(cell[j * CELL + i] + maker.z[j * SIDE + i]) < 1e-9);
                assert_true(fabs(cell[j * CELL + i] - fine[3 * j * FINE + 3 * i]) < 1e-9);
            }
        for (size_t j = 0; j < FINE; j += 17) {
            const double *row = fine + j * FINE;
            assert_true(fabs(row[0] - row[FINE - 1]) < 1.2 * steepest(row, 0, FINE - 1));
            assert_true(steepest(row, FINE / 2, FINE - 1) < 1.3 * steepest(row, 0, FINE / 2));
        }
        const double beyond = groove_extension_period(&grooves.family[0], &GRID);
        assert_true(fabs(beyond - 9.3) > 0.01 && fabs(beyond - 9.3) < 9.3 * 9.3 / SIDE);
    }
    free(cell);
    free(fine);
    maker_destroy(&maker);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(they_go_on_beyond_the_map),
        cmocka_unit_test(errors_hold),
        cmocka_unit_test(shapes_are_found),
        cmocka_unit_test(random_faces_have_none),
        cmocka_unit_test(crossed_families_are_two),
        cmocka_unit_test(the_rest_has_its_law),
        cmocka_unit_test(short_ones_are_sines),
        cmocka_unit_test(grooves_are_no_offsets),
        cmocka_unit_test(offsets_are_no_grooves),
        cmocka_unit_test(grooves_along_lines_are_found),
        cmocka_unit_test(odd_maps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
