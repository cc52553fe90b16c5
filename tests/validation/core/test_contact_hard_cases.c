/* Protects the contact solver against the cases that break others: a named catalogue of surfaces,
 * each under loads from next to none to far beyond full contact, in profiles and surfaces, in all
 * models; random small problems against a solver that tries every set of nodes in contact; and odd
 * loads. Each must end in a solution, checked by the independent judge of contact_scene.h. Problems
 * are drawn anew each time, RUGO_EFFORT times as many. */
#include "tests/support/check.h"

#include "core/random.h"
#include "core/surface/surface.h"
#include "tests/support/contact_scene.h"
#include "tests/support/effort.h"
#include "tests/support/seed.h"

/* Numbers of one stream, in order. */
struct draw {
    struct random_key key;
    uint64_t next;
};

static double draw_uniform(struct draw *draw) {
    double u = 0;
    random_uniform(draw->key, STREAM_PHASES, draw->next++, 1, &u);
    return u;
}

static size_t draw_below(struct draw *draw, size_t n) {
    return (size_t)(draw_uniform(draw) * (double)n);
}

/* --- the catalogue --- */

/* Height at (x, y) in [0, 1) of node (i, j); y is 0 in a profile, whose cosine factor is then 1. */
struct contact_place {
    double x, y;
    size_t i, j, at;
    const struct grid *grid;
};

static double height_wave(const struct contact_place *p) {
    return cos(2 * M_PI * p->x) * cos(2 * M_PI * p->y);
}
static double height_wrapped_wave(const struct contact_place *p) {
    return cos(2 * M_PI * (p->x + 0.013)) + (p->grid->ny > 1 ? cos(2 * M_PI * (p->y + 0.01)) : 0);
}
static double height_two_equal_summits(const struct contact_place *p) {
    size_t n = p->grid->nx;
    return p->j == 0 && (p->i == n / 4 || p->i == n / 4 + n / 2) ? 1 : 0;
}
static double height_two_equal_waves(const struct contact_place *p) {
    return cos(4 * M_PI * p->x) * cos(2 * M_PI * p->y);
}
static double height_checkerboard(const struct contact_place *p) {
    return (p->i + p->j) % 2 ? 1 : -1;
}
static double height_white_noise(const struct contact_place *p) {
    struct draw draw = {{.seed = 7}, p->at};
    return draw_uniform(&draw);
}
static double height_checkerboard_and_noise(const struct contact_place *p) {
    return height_checkerboard(p) + 1e-6 * height_white_noise(p);
}
static double height_step(const struct contact_place *p) {
    return p->x < 0.5 ? 1 : 0;
}
static double height_saw(const struct contact_place *p) {
    return p->x + 0.3 * p->y;
}
static double height_spike(const struct contact_place *p) {
    return p->at == 5 ? 1 : 0;
}
static double height_hole(const struct contact_place *p) {
    return p->at == 5 ? -1 : 0;
}
static double height_giant_spike_on_noise(const struct contact_place *p) {
    return (p->at == 5 ? 1e9 : 0) + height_white_noise(p);
}
static double height_row_of_plateaus(const struct contact_place *p) {
    return p->i % 6 < 3 && p->j % 6 < 3 ? 1 : 0;
}
static double height_ties(const struct contact_place *p) {
    return floor(3 * height_white_noise(p));
}
static double height_flat_but_for_rounding(const struct contact_place *p) {
    return 1 + 1e-13 * height_white_noise(p);
}
/* Weibull maximum of shape 1: bounded above, and densest there. */
static double height_densest_at_top(const struct contact_place *p) {
    return log(1e-9 + height_white_noise(p)) < -3 ? log(1e-9 + height_white_noise(p)) : -3;
}
static double height_steep_powers(const struct contact_place *p) {
    return pow(height_white_noise(p), 20);
}
static double height_all_sizes(const struct contact_place *p) {
    return exp(-60 * height_white_noise(p));
}
static double height_wave_and_ripple(const struct contact_place *p) {
    return height_wave(p) + 1e-3 * height_checkerboard(p);
}

static const struct surface_case {
    const char *name;
    double (*height)(const struct contact_place *place);
} SURFACES[] = {
    {"one wave: first touch by one node", height_wave},
    {"a patch that wraps around", height_wrapped_wave},
    {"two equal summits", height_two_equal_summits},
    {"two equal waves", height_two_equal_waves},
    {"checkerboard", height_checkerboard},
    {"white noise", height_white_noise},
    {"checkerboard and a little noise", height_checkerboard_and_noise},
    {"a step", height_step},
    {"a saw", height_saw},
    {"a single spike", height_spike},
    {"a single hole", height_hole},
    {"a giant spike on noise", height_giant_spike_on_noise},
    {"equal plateaus", height_row_of_plateaus},
    {"heights with ties", height_ties},
    {"flat but for rounding", height_flat_but_for_rounding},
    {"a plateau that touches at once", height_densest_at_top},
    {"steep summits", height_steep_powers},
    {"heights of all sizes", height_all_sizes},
    {"a wave and a ripple", height_wave_and_ripple},
};

static const struct block_case {
    const char *name;
    struct block block;
} BLOCKS[] = {
    {"half-space", {.model = MODEL_HALFSPACE, .height = INFINITY}},
    {"thin half-space", {.model = MODEL_HALFSPACE, .height = 0.01}},
    {"layered", {.model = MODEL_LAYERED, .poisson = 0.3, .height = 1.5, .layer_growth = 1.1}},
    {"layered, dual, nu 0",
     {.model = MODEL_LAYERED,
      .poisson = 0,
      .height = 1.5,
      .layer_growth = 1.3,
      .weighting = GAP_DUAL}},
    {"layered, thinner than a wave, nu 0.4999",
     {.model = MODEL_LAYERED, .poisson = 0.4999, .height = 0.03, .layer_growth = 1}},
    {"layered, dual, thin, nu 0.49",
     {.model = MODEL_LAYERED,
      .poisson = 0.49,
      .height = 0.1,
      .layer_growth = 1,
      .weighting = GAP_DUAL}},
};

static const struct grid GRIDS[] = {{2, 1, 1, 1},   {3, 1, 1, 1},  {37, 1, 1, 1},  {64, 1, 1, 1},
                                    {12, 12, 1, 1}, {13, 7, 1, 1}, {8, 16, 1, 0.1}};

static void fill(struct scene *scene, double (*height)(const struct contact_place *)) {
    const struct grid *grid = &scene->grid;
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t i = 0; i < grid->nx; i++) {
            struct contact_place place = {.x = (double)i / (double)grid->nx,
                                          .y = (double)j / (double)grid->ny,
                                          .i = i,
                                          .j = j,
                                          .at = j * grid->nx + i,
                                          .grid = grid};
            scene->z[place.at] = height(&place);
        }
    scene_begin(scene);
}

/* As fractions of the load of full contact: rising by factors of 1e6, falling as far, around full
 * contact by one rounding error, up and down. */
static const double LOADS[] = {1e-300, 1e-18, 1e-12, 1e-6, 1,         1e-8,     0.5,
                               1e-300, 1e-3,  100,   0.9,  0.999,     0.1,      0.3,
                               0.01,   1e-16, 0.7,   1e-4, 1 - 1e-16, 1 - 1e-12};

static void press_all(struct scene *scene, const char *surface, const char *block) {
    double full = contact_full_pressure(scene->contact);
    for (size_t a = 0; a < sizeof LOADS / sizeof *LOADS; a++) {
        struct error err = {0};
        double load = LOADS[a] * (full > 0 ? full : 1);
        if (contact_press(scene->contact, load, &scene->state, &err) != 0)
            fail_msg("%s, %s, %zu x %zu, load %g of full contact: %s", surface, block,
                     scene->grid.nx, scene->grid.ny, LOADS[a], err.text);
        check_contact(scene);
    }
}

static void every_case_ends_in_a_solution(void **state) {
    (void)state;
    for (size_t b = 0; b < sizeof BLOCKS / sizeof *BLOCKS; b++)
        for (size_t g = 0; g < sizeof GRIDS / sizeof *GRIDS; g++) {
            struct scene scene;
            scene_open(&scene, GRIDS[g], BLOCKS[b].block, g % 2 ? 1e-12 : 1e-10);
            for (size_t s = (b + g) % case_step(); s < sizeof SURFACES / sizeof *SURFACES;
                 s += case_step()) {
                fill(&scene, SURFACES[s].height);
                press_all(&scene, SURFACES[s].name, BLOCKS[b].name);
            }
            scene_close(&scene);
        }
}

/* Equal summits share the load, to rounding times the condition of the problem. */
static void symmetry_is_kept(void **state) {
    (void)state;
    static const struct grid grids[] = {{64, 1, 1, 1}, {16, 16, 1, 1}};
    for (size_t g = 0; g < 2; g++)
        for (size_t b = 0; b < sizeof BLOCKS / sizeof *BLOCKS; b++) {
            struct scene scene;
            scene_open(&scene, grids[g], BLOCKS[b].block, 1e-12);
            fill(&scene, height_two_equal_waves);
            double full = contact_full_pressure(scene.contact);
            for (double load = 1e-8; load < 1; load *= 7) {
                scene_press(&scene, load * full);
                double most = largest(scene_points(&scene), scene.state.p);
                size_t half = grids[g].nx / 2;
                for (size_t i = 0; i < scene_points(&scene); i++)
                    if (i % (2 * half) < half)
                        check_close(scene.state.p[i], scene.state.p[i + half], 1e-9 * most);
            }
            scene_close(&scene);
        }
}

/* --- random problems --- */

enum { NODES_MOST = 9, SIZE = NODES_MOST + 1 };

/* x of a x = b by elimination with the largest pivot; false where a is singular. */
static bool solve(size_t n, double a[SIZE][SIZE], double *x) {
    for (size_t k = 0; k < n; k++) {
        size_t pivot = k;
        for (size_t i = k; i < n; i++)
            pivot = fabs(a[i][k]) > fabs(a[pivot][k]) ? i : pivot;
        if (!(fabs(a[pivot][k]) > 0))
            return false;
        for (size_t j = 0; j < n; j++) {
            double swap = a[k][j];
            a[k][j] = a[pivot][j];
            a[pivot][j] = swap;
        }
        double swap = x[k];
        x[k] = x[pivot];
        x[pivot] = swap;
        for (size_t i = k + 1; i < n; i++) {
            double factor = a[i][k] / a[k][k];
            for (size_t j = k; j < n; j++)
                a[i][j] -= factor * a[k][j];
            x[i] -= factor * x[k];
        }
    }
    for (size_t k = n; k-- > 0;) {
        for (size_t j = k + 1; j < n; j++)
            x[k] -= a[k][j] * x[j];
        x[k] /= a[k][k];
    }
    return true;
}

/* Pressures where the gap is 0 in this set of nodes and the load is in balance; returns how far
 * they are from a solution: the largest negative pressure times compliance, or penetration. */
static double try_set(const struct scene *scene, double response[SIZE][SIZE], const double *z,
                      double pressure, size_t set, double *p) {
    size_t n = scene_points(scene), m = 0, node[NODES_MOST];
    double a[SIZE][SIZE], x[SIZE], worst = 0;
    for (size_t i = 0; i < n; i++)
        if (set >> i & 1)
            node[m++] = i;
    for (size_t i = 0; i < m; i++) {
        for (size_t j = 0; j < m; j++)
            a[i][j] = response[node[i]][node[j]];
        a[i][m] = a[m][i] = 1;
        x[i] = z[node[i]];
    }
    a[m][m] = 0;
    x[m] = pressure * (double)n;
    if (!solve(m + 1, a, x))
        return INFINITY;
    memset(p, 0, n * sizeof *p);
    for (size_t i = 0; i < m; i++) {
        p[node[i]] = x[i];
        worst = fmax(worst, -x[i] * response[0][0]);
    }
    for (size_t b = 0; b < n; b++) {
        double gap = x[m] - z[b];
        for (size_t c = 0; c < n; c++)
            gap += response[b][c] * p[c];
        worst = fmax(worst, -gap);
    }
    return worst;
}

static void check_by_every_set(struct scene *scene) {
    size_t nx = scene->grid.nx, n = scene_points(scene);
    double *unit = scene_response(scene), *weighted = zeros(n), *z = zeros(n);
    double response[SIZE][SIZE] = {{0}}, p[NODES_MOST] = {0}, best[NODES_MOST] = {0},
           least = INFINITY;
    scene_weigh(scene, unit, weighted);
    scene_weigh(scene, scene->z, z);
    for (size_t b = 0; b < n; b++)
        for (size_t a = 0; a < n; a++) {
            size_t i = (b % nx + nx - a % nx) % nx;
            size_t j = (b / nx + scene->grid.ny - a / nx) % scene->grid.ny;
            response[b][a] = weighted[j * nx + i];
        }
    for (size_t set = 1; set < (size_t)1 << n; set++) {
        double worst = try_set(scene, response, z, scene->state.pressure, set, p);
        if (worst < least) {
            least = worst;
            memcpy(best, p, sizeof p);
        }
    }
    /* Gaps are right to 1e-12 of the heights, pressures to that times the stiffness: compared by
     * the displacements that they make. */
    double highest = largest(n, z);
    assert_true(least <= 1e-9 * highest);
    for (size_t i = 0; i < n; i++)
        check_close(scene->state.p[i] * unit[0], best[i] * unit[0],
                    1e-9 * (highest + largest(n, best) * unit[0]));
    free(weighted);
    free(z);
}

static void random_scene(struct draw *draw, struct scene *scene, struct grid grid) {
    struct block block = BLOCKS[draw_below(draw, sizeof BLOCKS / sizeof *BLOCKS)].block;
    static const double tolerances[] = {1e-8, 1e-10, 1e-12};
    scene_open(scene, grid, block, tolerances[draw_below(draw, 3)]);
    size_t kind = draw_below(draw, 5);
    for (size_t i = 0; i < scene_points(scene); i++) {
        double u = draw_uniform(draw);
        double heights[] = {u, floor(3 * u), pow(u, 15), u < 0.5 ? 0 : 1 - 1e-12 * u,
                            (double)((i % grid.nx + i / grid.nx) % 2) + 1e-6 * u};
        scene->z[i] = heights[kind];
    }
    scene_begin(scene);
}

static void small_problems_by_every_set(void **state) {
    (void)state;
    struct draw draw = {{.seed = seed_of_now()}, 0};
    static const struct grid grids[] = {{2, 1, 1, 1}, {3, 1, 1, 1}, {5, 1, 1, 1}, {9, 1, 1, 1},
                                        {2, 2, 1, 1}, {3, 3, 1, 1}, {2, 4, 1, 1}, {4, 2, 1, 3}};
    for (size_t a = 0; a < cases_of(64); a++) {
        struct scene scene;
        random_scene(&draw, &scene, grids[a % 8]);
        double full = contact_full_pressure(scene.contact);
        for (size_t b = 0; b < 3 && full > 0; b++) {
            scene_press(&scene, full * draw_uniform(&draw));
            check_contact(&scene);
            if (scene.tolerance == 1e-12)
                check_by_every_set(&scene);
        }
        scene_close(&scene);
    }
}

/* Larger ones, some of which make the usual steps stall. */
static void random_problems(void **state) {
    (void)state;
    struct draw draw = {{.seed = seed_of_now(), .sequence = 1}, 0};
    for (size_t a = 0; a < cases_of(24); a++) {
        struct grid grid = {2 + draw_below(&draw, 40), 1 + draw_below(&draw, 40), 1, 1};
        struct scene scene;
        random_scene(&draw, &scene, grid);
        double full = contact_full_pressure(scene.contact);
        double highest = largest(scene_points(&scene), scene.z);
        for (size_t b = 0; b < 6 && full > 0; b++) {
            scene_press(&scene, full * pow(10, -8 * draw_uniform(&draw)));
            /* Displacements are no larger than twice the heights. */
            check_state(&scene, (2 * scene.tolerance + 1e-12) * highest);
        }
        scene_close(&scene);
    }
}

/* Careful steps, which follow a stall, reach the solution by themselves. */
static void careful_steps_converge(void **state) {
    (void)state;
    struct draw draw = {{.seed = seed_of_now(), .sequence = 2}, 0};
    for (size_t a = 0; a < cases_of(24); a++) {
        struct grid grid = {2 + draw_below(&draw, 40), 1 + draw_below(&draw, 40), 1, 1};
        struct scene scene;
        random_scene(&draw, &scene, grid);
        size_t n = scene_points(&scene);
        double full = contact_full_pressure(scene.contact);
        struct contact_options options = {.tolerance = scene.tolerance,
                                          .max_iterations = 5000,
                                          .stall_iterations = 0,
                                          .hardness = INFINITY};
        struct contact *careful = NULL;
        struct error err = {0};
        if (contact_create(&careful, scene.compliance, &options, &err) != 0 ||
            contact_begin(careful, scene.z, &err) != 0)
            fail_msg("%s", err.text);
        for (size_t b = 0; b < 3 && full > 0; b++) {
            double load = full * pow(10, -8 * draw_uniform(&draw)), highest = largest(n, scene.z);
            scene_press(&scene, load);
            double gap = scene.state.mean_gap;
            if (contact_press(careful, load, &scene.state, &err) != 0)
                fail_msg("%zu x %zu: %s", grid.nx, grid.ny, err.text);
            double reach = (2 * scene.tolerance + 1e-12) * highest;
            check_state(&scene, reach);
            check_close(scene.state.mean_gap, gap, 10 * reach);
        }
        contact_destroy(&careful);
        scene_close(&scene);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_case_ends_in_a_solution), cmocka_unit_test(symmetry_is_kept),
        cmocka_unit_test(small_problems_by_every_set),   cmocka_unit_test(random_problems),
        cmocka_unit_test(careful_steps_converge),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
