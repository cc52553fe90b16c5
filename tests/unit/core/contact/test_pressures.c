/* Protects how much area bears which pressure: waves and spheres whose distributions are known in
 * closed form, light loads down to patches of one node, full contact, and states without contact.
 */
#include "tests/support/check.h"

#include "core/contact/pressures.h"
#include "core/surface/surface.h"
#include "tests/support/contact_scene.h"

enum { BINS = 20, PLACES = 64 };

/* Of the state of a scene, by its area by edges; all checks of any distribution. */
static void share(const struct scene *scene, const struct bins *bins, double unit, double *shares) {
    struct pressures *pressures;
    struct error err = {0};
    double area = scene_area(scene).edges, sum = 0, moment = 0, width = bins_width(bins);
    if (pressures_create(&pressures, scene->areas, &err) != 0 ||
        pressures_share(pressures, &scene->state, area, bins, unit, shares, &err) != 0)
        fail_msg("%s", err.text);
    pressures_destroy(&pressures);
    pressures_destroy(&pressures);
    for (size_t b = 0; b < bins->count + 2; b++) {
        assert_true(shares[b] >= 0 && shares[b] <= 1);
        sum += shares[b];
        moment += b > 0 ? shares[b] * bins_centre(bins, b - 1) : 0;
    }
    check_relative(sum, area, 1e-12);
    /* Pressures are within half a bin of its centre. */
    if (bins->low == 0 && shares[bins->count + 1] == 0)
        check_close(moment * unit, scene->state.pressure, width * unit / 2 * area);
}

/* --- known distributions --- */

/* Fraction of the cell of Westergaard's wave, pressed to r of full contact, where the pressure is
 * above P times twice that of full contact (F11.2). */
static double westergaard_above(double r, double P) {
    double square = 1 - r, u = (1 + r - sqrt(square * square + 4 * P * P)) / 2;
    return 2 / M_PI * asin(sqrt(fmax(0, u)));
}

/* Adds the shares of a wave at many positions, and those of the nodes. */
static void wave_shares(size_t points, double r, const struct bins *bins, double *sums,
                        double *by_nodes) {
    struct scene scene;
    double shares[BINS + 2];
    scene_open(&scene, (struct grid){points, 1, 1, 1}, DEEP, 1e-10);
    for (size_t place = 0; place < PLACES; place++) {
        scene_begin_wave(&scene, (double)place / PLACES);
        scene_press(&scene, r * M_PI);
        share(&scene, bins, 2 * M_PI, shares);
        for (size_t b = 0; b < BINS + 2; b++)
            sums[b] += shares[b] / PLACES;
        for (size_t i = 0; i < points; i++)
            if (scene.state.p[i] > 0)
                by_nodes[bins_find(bins, scene.state.p[i] / (2 * M_PI))] +=
                    1.0 / PLACES / (double)points;
    }
    scene_close(&scene);
}

/* The lowest bins are near what is known, nearer on a finer grid, where those by nodes are far off;
 * and so is the area below each pressure. */
static void waves_bear_the_known_pressures(void **state) {
    (void)state;
    static const double RATIO[] = {0.1, 0.2, 0.4, 0.6, 0.8};
    static const struct {
        size_t points;
        double first, below;
    } CASES[] = {{16, 0.2, 0.03}, {32, 0.12, 0.012}, {64, 0.05, 0.005}};
    for (size_t c = 0; c < 3; c++)
        for (size_t a = 0; a < sizeof RATIO / sizeof *RATIO; a++) {
            double r = RATIO[a], sums[BINS + 2] = {0}, nodes[BINS + 2] = {0}, sum = 0;
            struct bins bins = {0, 1.05 * sqrt(r), BINS};
            wave_shares(CASES[c].points, r, &bins, sums, nodes);
            for (size_t b = 0; b < BINS; b++) {
                double low = (double)b * bins_width(&bins), high = low + bins_width(&bins);
                double known = westergaard_above(r, low) - westergaard_above(r, high);
                sum += sums[b + 1];
                check_close(sum, westergaard_above(r, 0) - westergaard_above(r, high),
                            CASES[c].below);
                if (b < 3)
                    check_relative(sums[b + 1], known, CASES[c].first);
                assert_true(b > 0 || nodes[b + 1] > 2 * known);
            }
        }
}

/* A light double sine is Hertz's: on patches of radius 3 to 4 points the area rises as the square
 * of the pressure, up to the largest. */
static void spheres_bear_the_known_pressures(void **state) {
    (void)state;
    enum { POINTS = 48, LOW = 12 };
    struct scene scene;
    double sums[LOW + 2] = {0}, shares[LOW + 2], load = 0.005, area = 0, below = 0;
    double fraction = M_PI * pow(3 * load / (8 * M_PI), 2.0 / 3), top = 1.5 * load / fraction;
    struct bins bins = {0, 1.2 * top, LOW};
    scene_open(&scene, (struct grid){POINTS, POINTS, 1, 1}, DEEP, 1e-10);
    for (size_t place = 0; place < PLACES; place++) {
        double x = 0.618033988749895 * (double)place, y = 0.7548776662466927 * (double)place;
        for (size_t k = 0; k < scene_points(&scene); k++) {
            size_t row = k / POINTS;
            scene.z[k] = cos(2 * M_PI * ((double)(k % POINTS) + x) / POINTS) *
                         cos(2 * M_PI * ((double)row + y) / POINTS);
        }
        scene_begin(&scene);
        scene_press(&scene, load * sqrt(2) * M_PI);
        share(&scene, &bins, sqrt(2) * M_PI, shares);
        for (size_t b = 0; b < LOW + 2; b++) {
            sums[b] += shares[b] / PLACES;
            area += shares[b] / PLACES;
        }
    }
    for (size_t b = 0; b < 10; b++) {
        double high = (double)(b + 1) / 10, low = (double)b / 10;
        double known = high * high - low * low;
        below += sums[b + 1];
        check_relative(sums[b + 1] / area, known, 0.22);
        check_close(below / area, high * high, 0.035);
    }
    scene_close(&scene);
}

/* --- any contact --- */

/* Presses a rough surface from patches of one node to full contact. */
static void press_rough(struct grid grid, struct block block, uint64_t realisation) {
    struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                .hurst = 0.8,
                                .wavelength_long = 1,
                                .wavelength_rolloff = 1,
                                .wavelength_short = 8.0 / (double)grid.nx,
                                .scale = SCALE_RMS_SLOPE,
                                .scale_value = 1};
    static const struct bins BINS_USED[] = {{0, 8, 200}, {0.1, 0.5, 3}};
    struct scene scene;
    struct generator *generator;
    struct error err = {0};
    scene_open(&scene, grid, block, 1e-9);
    if (generator_create(&generator, &spectrum, &grid, &SURFACE_DEFAULTS, &err) != 0 ||
        generator_run(generator, (struct random_key){.seed = 3, .realisation = realisation},
                      scene.z, NULL, &err) != 0)
        fail_msg("%s", err.text);
    scene_begin(&scene);
    for (double load = 1e-6; load < 20; load *= 3) {
        double shares[202] = {0};
        scene_press(&scene, load);
        for (size_t a = 0; a < 2; a++)
            share(&scene, &BINS_USED[a], 1, shares);
    }
    generator_destroy(&generator);
    scene_close(&scene);
}

static void any_contact_bears_its_load(void **state) {
    (void)state;
    static const struct block BLOCKS[] = {
        {MODEL_HALFSPACE, 0.3, INFINITY, 1, GAP_STANDARD, {0, 0, 0}},
        {MODEL_LAYERED, 0.3, 1.5, 1.3, GAP_STANDARD, {0, 0, 0}},
        {MODEL_LAYERED, 0.4999, 1.5, 1.1, GAP_DUAL, {0, 0, 0}}};
    static const struct grid GRIDS[] = {{64, 1, 1, 1}, {32, 32, 1, 1}, {32, 16, 1, 1}};
    for (size_t a = 0; a < 3; a++)
        for (size_t b = 0; b < 3; b++)
            for (uint64_t r = 0; r < 4; r++)
                press_rough(GRIDS[a], BLOCKS[b], r);
}

/* Without edges pressures are those of the nodes. */
static void full_contact_has_no_edges(void **state) {
    (void)state;
    struct scene scene;
    struct bins bins = {0, 20, 40};
    double shares[42], nodes[42] = {0};
    scene_open(&scene, (struct grid){16, 16, 1, 1}, DEEP, 1e-10);
    for (size_t k = 0; k < 256; k++)
        scene.z[k] = cos(2 * M_PI * (double)(k % 16) / 16 + 0.1);
    scene_begin(&scene);
    scene_press(&scene, 1.5 * M_PI);
    for (size_t k = 0; k < 256; k++)
        nodes[bins_find(&bins, scene.state.p[k])] += 1.0 / 256;
    share(&scene, &bins, 1, shares);
    for (size_t b = 0; b < 42; b++)
        check_close(shares[b], nodes[b], 1e-14);
    scene_press(&scene, 0);
    share(&scene, &bins, 1, shares);
    for (size_t b = 0; b < 42; b++)
        assert_true(shares[b] == 0);
    scene_close(&scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(waves_bear_the_known_pressures),
        cmocka_unit_test(spheres_bear_the_known_pressures),
        cmocka_unit_test(any_contact_bears_its_load),
        cmocka_unit_test(full_contact_has_no_edges),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
