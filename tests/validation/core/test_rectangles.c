/* Protects contact on rectangular cells: a square surface repeated along a side is the same surface
 * on a cell twice or three times as long. So a half-space, a low block, layers and the finite
 * elements of the full model must give the same pressures, area, gap and stiffness on both. A cell
 * that lies along x or along y is one cell, too. Unequal sides would show where a kernel, a layer,
 * a preconditioner or a law of areas takes one side for the other. */
#include "tests/support/check.h"

#include "core/full/full.h"
#include "core/surface/surface.h"
#include "tests/support/contact_scene.h"

static const struct block LOW = {.model = MODEL_HALFSPACE, .poisson = 0.3, .height = 0.2};
static const struct block LAYERED = {
    .model = MODEL_LAYERED, .poisson = 0.3, .height = 1.5, .layer_growth = 1.1};
static const struct block LAYERED_DUAL = {.model = MODEL_LAYERED,
                                          .poisson = 0.3,
                                          .height = 1.5,
                                          .layer_growth = 1.2,
                                          .weighting = GAP_DUAL};

/* How often the unit square is repeated. */
struct tiling {
    size_t along_x, along_y;
};
static const struct tiling TILINGS[] = {{2, 1}, {1, 2}, {3, 1}, {1, 3}, {3, 2}};
enum { TILING_COUNT = sizeof TILINGS / sizeof *TILINGS };

static struct grid tiled(size_t n, struct tiling tiling) {
    return (struct grid){tiling.along_x * n, tiling.along_y * n, (double)tiling.along_x,
                         (double)tiling.along_y};
}

/* Rough heights of the unit square, of two to eight waves a side; slope: RMS. */
static double *square_surface(size_t n, double slope, uint64_t seed) {
    const struct grid grid = {n, n, 1, 1};
    struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                .hurst = 0.8,
                                .wavelength_long = 0.5,
                                .wavelength_rolloff = 0.5,
                                .wavelength_short = 0.125,
                                .scale = SCALE_RMS_SLOPE,
                                .scale_value = slope};
    struct generator *generator = NULL;
    struct error err = {0};
    double *z = zeros(n * n);
    if (generator_create(&generator, &spectrum, &grid, &SURFACE_DEFAULTS, &err) != 0 ||
        generator_run(generator, (struct random_key){.seed = seed}, z, NULL, &err) != 0)
        fail_msg("%s", err.text);
    generator_destroy(&generator);
    return z;
}

static void repeat(const double *square, size_t n, const struct grid *grid, double *z) {
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t i = 0; i < grid->nx; i++)
            z[j * grid->nx + i] = square[j % n * n + i % n];
}

/* Pressures of the square at every image of its nodes. */
static double largest_difference(const double *square, size_t n, const struct grid *grid,
                                 const double *p) {
    double most = 0;
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t i = 0; i < grid->nx; i++)
            most = fmax(most, fabs(p[j * grid->nx + i] - square[j % n * n + i % n]));
    return most;
}

/* Edges are found where pressures vanish, which multiplies what the solver leaves. */
static void check_states(const struct scene *one, const struct scene *other, double load) {
    size_t n = one->grid.nx;
    double images = (double)scene_points(other) / (double)scene_points(one);
    struct contact_area area = scene_area(one), again = scene_area(other);
    check_close(largest_difference(one->state.p, n, &other->grid, other->state.p), 0, 1e-8 * load);
    check_relative(other->state.mean_gap, one->state.mean_gap, 1e-9);
    check_relative(other->state.stiffness, one->state.stiffness, 1e-7);
    check_relative((double)other->state.nodes, images * (double)one->state.nodes, 0);
    check_relative(again.nodes, area.nodes, 1e-13);
    check_relative(again.lower, area.lower, 1e-13);
    check_relative(again.upper, area.upper, 1e-13);
    check_relative(again.edges, area.edges, 1e-7);
    check_relative(again.perimeter, area.perimeter, 1e-7);
    check_relative(again.mean_gap, area.mean_gap, 1e-8);
}

static void linear_models_see_a_tiled_square(void **state) {
    (void)state;
    enum { N = 32 };
    static const struct block *const BLOCKS[] = {&DEEP, &LOW, &LAYERED, &LAYERED_DUAL};
    static const double LOADS[] = {0.003, 0.03, 0.2};
    double *square = square_surface(N, 1, 11);
    for (size_t b = 0; b < 4; b++)
        for (size_t t = 0; t < TILING_COUNT; t++) {
            struct scene one, other;
            scene_open(&one, (struct grid){N, N, 1, 1}, *BLOCKS[b], 1e-12);
            scene_open(&other, tiled(N, TILINGS[t]), *BLOCKS[b], 1e-12);
            memcpy(one.z, square, N * N * sizeof *square);
            repeat(square, N, &other.grid, other.z);
            scene_begin(&one);
            scene_begin(&other);
            for (size_t k = 0; k < 3; k++) {
                scene_press(&one, LOADS[k]);
                scene_press(&other, LOADS[k]);
                check_states(&one, &other, LOADS[k]);
            }
            scene_close(&one);
            scene_close(&other);
        }
    free(square);
}

struct pressed {
    struct grid grid;
    struct full *full;
    struct contact_state state;
    struct full_report report;
    double *z;
};

static void full_open(struct pressed *p, struct grid grid, const struct block *block,
                      const double *square, size_t n) {
    struct full_options options = FULL_DEFAULTS;
    struct error err = {0};
    options.tolerance = 1e-11;
    *p = (struct pressed){.grid = grid};
    p->z = zeros(grid_points(&grid));
    repeat(square, n, &grid, p->z);
    if (full_create(&p->full, &grid, block, &options, &err) != 0 ||
        full_begin(p->full, p->z, &err) != 0)
        fail_msg("%s", err.text);
}

static void full_close(struct pressed *p) {
    full_destroy(&p->full);
    free(p->z);
}

/* Steep enough for finite strain to matter, and columns widen below. */
static void full_model_sees_a_tiled_square(void **state) {
    (void)state;
    enum { N = 16 };
    static const double LOADS[] = {0.004, 0.03};
    double *square = square_surface(N, 0.2, 12);
    for (size_t t = 0; t < 3; t++) {
        struct pressed one, other;
        full_open(&one, (struct grid){N, N, 1, 1}, &LAYERED_DUAL, square, N);
        full_open(&other, tiled(N, TILINGS[t]), &LAYERED_DUAL, square, N);
        for (size_t k = 0; k < 2; k++) {
            struct error err = {0};
            if (full_press(one.full, LOADS[k], &one.state, &one.report, &err) != 0 ||
                full_press(other.full, LOADS[k], &other.state, &other.report, &err) != 0)
                fail_msg("%s", err.text);
            double images = (double)grid_points(&other.grid) / (double)grid_points(&one.grid);
            check_close(largest_difference(one.state.p, N, &other.grid, other.state.p), 0,
                        1e-8 * LOADS[k]);
            check_relative((double)other.state.nodes, images * (double)one.state.nodes, 0);
            check_relative(other.state.mean_gap, one.state.mean_gap, 1e-9);
            check_relative(other.state.stiffness, one.state.stiffness, 1e-7);
            check_relative(other.report.stretch, one.report.stretch, 1e-8);
        }
        full_close(&one);
        full_close(&other);
    }
    free(square);
}

/* Ridges along y: a profile, however wide the cell, and along x the same on the turned cell. */
static void ridges_are_a_profile(void **state) {
    (void)state;
    enum { N = 64 };
    static const struct block *const BLOCKS[] = {&DEEP, &LOW};
    double *square = square_surface(N, 1, 13);
    for (size_t b = 0; b < 2; b++) {
        struct scene line, wide, turned;
        scene_open(&line, (struct grid){N, 1, 1, 1}, *BLOCKS[b], 1e-12);
        scene_open(&wide, (struct grid){N, N / 4, 1, 0.25}, *BLOCKS[b], 1e-12);
        scene_open(&turned, (struct grid){N / 4, N, 0.25, 1}, *BLOCKS[b], 1e-12);
        for (size_t i = 0; i < N; i++)
            for (size_t j = 0; j < N / 4; j++) {
                line.z[i] = square[i];
                wide.z[j * N + i] = square[i];
                turned.z[i * (N / 4) + j] = square[i];
            }
        scene_begin(&line);
        scene_begin(&wide);
        scene_begin(&turned);
        for (double load = 0.01; load < 0.5; load *= 5) {
            scene_press(&line, load);
            scene_press(&wide, load);
            scene_press(&turned, load);
            double area = scene_area(&line).nodes;
            check_relative(scene_area(&wide).nodes, area, 1e-13);
            check_relative(scene_area(&turned).nodes, area, 1e-13);
            check_relative(wide.state.mean_gap, line.state.mean_gap, 1e-9);
            check_relative(turned.state.mean_gap, line.state.mean_gap, 1e-9);
        }
        scene_close(&line);
        scene_close(&wide);
        scene_close(&turned);
    }
    free(square);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(linear_models_see_a_tiled_square),
        cmocka_unit_test(full_model_sees_a_tiled_square),
        cmocka_unit_test(ridges_are_a_profile),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
