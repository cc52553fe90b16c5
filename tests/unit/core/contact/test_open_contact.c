/* Protects contact in free space: displacements against potentials in closed form, and solutions
 * against dense systems of equations (with the same kernel, and with Love's uniform pressures on
 * rectangles). It tests coatings on long maps and profiles, flat punches, the sides of the map, and
 * refusals, too. */
#include "tests/support/check.h"

#include "core/contact/free_space.h"
#include "core/surface/transform.h"
#include "tests/support/contact_scene.h"
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_sf_bessel.h>
#include <time.h>

static const double EULER = 0.57721566490153286061;

/* A map in free space with its solver. */
struct open_scene {
    struct grid grid;
    struct compliance *compliance;
    struct contact *contact;
    struct area_workspace *areas;
    double *z;
};

static void open_scene_begin(struct open_scene *scene, struct grid grid) {
    struct error err = {0};
    struct contact_options options = CONTACT_DEFAULTS;
    options.tolerance = 1e-12;
    *scene = (struct open_scene){.grid = grid, .z = zeros(grid_points(&grid))};
    if (compliance_create_open(&scene->compliance, &grid, &DEEP, &err) != 0 ||
        contact_create(&scene->contact, scene->compliance, &options, &err) != 0 ||
        area_workspace_create(&scene->areas, scene->compliance, &err) != 0)
        fail_msg("%s", err.text);
}

static struct contact_state open_scene_press(struct open_scene *scene, double pressure) {
    struct error err = {0};
    struct contact_state state;
    if (contact_begin(scene->contact, scene->z, &err) != 0)
        fail_msg("%s", err.text);
    if (contact_press(scene->contact, pressure, &state, &err) != 0)
        fail_msg("%s", err.text);
    return state;
}

static void open_scene_end(struct open_scene *scene) {
    area_workspace_destroy(&scene->areas);
    contact_destroy(&scene->contact);
    compliance_destroy(&scene->compliance);
    free(scene->z);
}

/* Displacements E* of pressures, by the compliance. */
static void displace(const struct compliance *compliance, const double *p, double *u) {
    const struct grid *waved = &compliance->waved;
    struct transform *transform = NULL;
    assert_int_equal(transform_create(&transform, waved, waved->nx / 2, waved->ny / 2, NULL), 0);
    transform_filter_part(transform, compliance->length, 1, compliance->grid.nx,
                          compliance->grid.ny, p, u);
    transform_destroy(&transform);
}

/* Under exp(-r^2/(2 s^2)) the potential of 1/(pi r) is s sqrt(2 pi) exp(-x) I0(x), x = (r/2s)^2. */
static void bell_sinks_as_its_potential(void **state) {
    (void)state;
    static const struct grid GRIDS[] = {
        {64, 64, 64, 64}, {61, 47, 61, 47}, {53, 100, 53, 50}, {120, 40, 40, 40}};
    for (size_t g = 0; g < sizeof GRIDS / sizeof *GRIDS; g++) {
        const struct grid *grid = &GRIDS[g];
        struct compliance *compliance = NULL;
        size_t n = grid_points(grid);
        double *p = zeros(n), *u = zeros(n), s = 2.2, x0 = 0.37 * grid->lx, y0 = 0.5 * grid->ly;
        assert_int_equal(compliance_create_open(&compliance, grid, &DEEP, NULL), 0);
        for (size_t pass = 0; pass < 2; pass++)
            for (size_t j = 0; j < grid->ny; j++)
                for (size_t i = 0; i < grid->nx; i++) {
                    double r =
                        hypot((double)i * grid_dx(grid) - x0, (double)j * grid_dy(grid) - y0);
                    double x = r * r / (4 * s * s), exact;
                    exact = s * sqrt(2 * M_PI) * gsl_sf_bessel_I0_scaled(x);
                    if (pass == 0)
                        p[j * grid->nx + i] = exp(-2 * x);
                    else /* the bell is cut at the sides, where it is exp(-22) or less */
                        check_close(u[j * grid->nx + i], exact, 1e-7);
                    if (pass == 0 && i + 1 == grid->nx && j + 1 == grid->ny)
                        displace(compliance, p, u);
                }
        compliance_destroy(&compliance);
        free(p);
        free(u);
    }
}

/* Of a profile: at the middle of the bell -(2/pi) times the mean of ln(|x|/lx) under it, and far
 * from it as under a line load. */
static void bell_of_a_profile_sinks_as_its_potential(void **state) {
    (void)state;
    const struct grid grid = {201, 1, 100.5, 1};
    struct compliance *compliance = NULL;
    double *p = zeros(201), *u = zeros(201), s = 2.5, load = s * sqrt(2 * M_PI);
    assert_int_equal(compliance_create_open(&compliance, &grid, &DEEP, NULL), 0);
    for (size_t i = 0; i < 201; i++)
        p[i] = exp(-pow(((double)i - 60) / 2 / s, 2) / 2);
    displace(compliance, p, u);
    check_close(u[60], -2 * load / M_PI * (log(s / 100.5) - (EULER + log(2)) / 2), 1e-10);
    /* The next term of the far field is (s/x)^2/2. */
    double far = 70;
    check_close(u[200], -2 * load / M_PI * (log(far / 100.5) - pow(s / far, 2) / 2), 1e-4);
    compliance_destroy(&compliance);
    free(p);
    free(u);
}

/* --- coatings --- */

static struct block coated(double thickness, double modulus) {
    struct block block = DEEP;
    block.coating = (struct coating){thickness, modulus, DEEP.poisson};
    return block;
}

/* Fills u with the displacements E* on a grid, whose first rows bear these pressures. */
static void displace_coated(struct grid grid, const struct block *block, size_t n, const double *p,
                            double *u) {
    struct compliance *compliance = NULL;
    struct error err = {0};
    double *all = zeros(grid_points(&grid)), *moved = zeros(grid_points(&grid));
    memcpy(all, p, n * sizeof *p);
    if (compliance_create_open(&compliance, &grid, block, &err) != 0)
        fail_msg("%s", err.text);
    displace(compliance, all, moved);
    memcpy(u, moved, n * sizeof *u);
    compliance_destroy(&compliance);
    free(all);
    free(moved);
}

/* Adds a bell of pressure that the grid resolves. */
static void add_bell(const struct grid *grid, double x, double y, double *p) {
    for (size_t i = 0; i < grid_points(grid); i++) {
        const size_t column = i % grid->nx, row = i / grid->nx;
        double across = (double)column - x, along = (double)row - y;
        p[i] += exp(-(across * across + along * along) / (2 * 2.2 * 2.2));
    }
}

/* A long narrow map has displacements of its own rows on a square one, which is padded far more. */
static void narrow_coated_maps_are_rows_of_wide_ones(void **state) {
    (void)state;
    enum { LONG = 512, ROWS = 32, NODES = LONG * ROWS };
    static const double THICKNESS[] = {0.5, 5, 300}, MODULUS[] = {5, 0.2, 3};
    const struct grid strip = {LONG, ROWS, LONG, ROWS}, square = {LONG, LONG, LONG, LONG};
    double *p = zeros(NODES), *narrow = zeros(NODES), *wide = zeros(NODES);
    add_bell(&strip, 20, 15, p);
    add_bell(&strip, 490, 17, p);
    for (size_t b = 0; b < sizeof MODULUS / sizeof *MODULUS; b++) {
        const struct block block = coated(THICKNESS[b], MODULUS[b]);
        displace_coated(strip, &block, NODES, p, narrow);
        displace_coated(square, &block, NODES, p, wide);
        double most = 0, deepest = largest(NODES, wide);
        for (size_t i = 0; i < NODES; i++)
            most = fmax(most, fabs(narrow[i] - wide[i]));
        printf("t %g, E1/E2 %g: %.1e of %g\n", THICKNESS[b], MODULUS[b], most, deepest);
        assert_true(most <= 1e-7 * deepest);
    }
    free(p);
    free(narrow);
    free(wide);
}

/* The cost of a coating grows with the points and the logarithm of the sides' ratio: with the
 * square of the ratio this would take minutes. */
static void long_coated_maps_are_cheap(void **state) {
    (void)state;
    const struct block block = coated(2, 5);
    const struct grid grid = {4096, 8, 4096, 8};
    struct compliance *compliance = NULL;
    clock_t begun = clock();
    assert_int_equal(compliance_create_open(&compliance, &grid, &block, NULL), 0);
    double seconds = (double)(clock() - begun) / CLOCKS_PER_SEC;
    printf("4096 x 8 points with a coating: %.2f s of CPU time\n", seconds);
    assert_true(seconds < 20);
    compliance_destroy(&compliance);
}

/* Displacements of a coated profile are relative to the distance lx, too: under a coating that is
 * far thicker they are those of a half-space of its material, and without a difference in modulus
 * those without a coating. */
static void coated_profiles_have_the_same_reference(void **state) {
    (void)state;
    static const double MODULI[] = {0.1, 1, 10};
    enum { NODES = 200 };
    const struct grid grid = {NODES, 1, 50, 1};
    double *p = zeros(NODES), *bare = zeros(NODES), *u = zeros(NODES), most = 0;
    add_bell(&grid, 40, 0, p);
    displace_coated(grid, &DEEP, NODES, p, bare);
    for (size_t m = 0; m < sizeof MODULI / sizeof *MODULI; m++) {
        const struct block block = coated(1e4 * grid.lx, MODULI[m]);
        displace_coated(grid, &block, NODES, p, u);
        for (size_t i = 0; i < NODES; i++)
            most = fmax(most, fabs(MODULI[m] * u[i] - bare[i]));
    }
    printf("reference: %.1e of %g\n", most, bare[40]);
    assert_true(most <= 1e-7 * bare[40]);
    free(p);
    free(bare);
    free(u);
}

/* --- dense systems of equations --- */

/* Displacement E* at x, y of a pressure of 1 on dx by dy around the origin (Love 1929). */
static double love(double x, double y, double dx, double dy) {
    double sum = 0;
    for (int side = -1; side <= 1; side += 2) {
        double a = x + side * dx / 2, b = y + side * dy / 2;
        double y_up = y + dy / 2, y_down = y - dy / 2, x_up = x + dx / 2, x_down = x - dx / 2;
        sum += side * a * (asinh(y_up / fabs(a)) - asinh(y_down / fabs(a)));
        sum += side * b * (asinh(x_up / fabs(b)) - asinh(x_down / fabs(b)));
    }
    return sum / M_PI;
}

/* The contact of a map by equations for the nodes in contact, written out, and an active set. */
struct dense {
    struct grid grid;
    double *kernel; /* by distance in columns and rows */
    double *p;
    double level; /* of the flat: the gap is level + u - z */
    size_t nodes;
};

static double kernel_at(const struct dense *dense, size_t a, size_t b) {
    size_t nx = dense->grid.nx, i = a % nx > b % nx ? a % nx - b % nx : b % nx - a % nx;
    return dense->kernel[(a / nx > b / nx ? a / nx - b / nx : b / nx - a / nx) * nx + i];
}

static void dense_solve(struct dense *dense, const size_t *set, const double *z, double force) {
    size_t n = dense->nodes + 1;
    gsl_matrix *matrix = gsl_matrix_calloc(n, n);
    gsl_vector *right = gsl_vector_alloc(n), *x = gsl_vector_alloc(n);
    gsl_permutation *order = gsl_permutation_alloc(n);
    int sign;
    for (size_t a = 0; a + 1 < n; a++) {
        for (size_t b = 0; b + 1 < n; b++)
            gsl_matrix_set(matrix, a, b, kernel_at(dense, set[a], set[b]));
        gsl_matrix_set(matrix, a, n - 1, 1);
        gsl_matrix_set(matrix, n - 1, a, 1);
        gsl_vector_set(right, a, z[set[a]]);
    }
    gsl_vector_set(right, n - 1, force);
    gsl_linalg_LU_decomp(matrix, order, &sign);
    gsl_linalg_LU_solve(matrix, order, right, x);
    memset(dense->p, 0, grid_points(&dense->grid) * sizeof *dense->p);
    for (size_t a = 0; a + 1 < n; a++)
        dense->p[set[a]] = gsl_vector_get(x, a);
    dense->level = gsl_vector_get(x, n - 1);
    gsl_matrix_free(matrix);
    gsl_vector_free(right);
    gsl_vector_free(x);
    gsl_permutation_free(order);
}

static double dense_gap(const struct dense *dense, const double *z, size_t a) {
    double gap = dense->level - z[a];
    for (size_t b = 0; b < grid_points(&dense->grid); b++)
        gap += dense->p[b] != 0 ? kernel_at(dense, a, b) * dense->p[b] : 0;
    return gap;
}

/* Nodes without pressure leave the set and nodes through the flat enter it until neither is. */
static void dense_press(struct dense *dense, const double *z, double force) {
    size_t n = grid_points(&dense->grid), changes = 1;
    size_t *set = array_create(n, sizeof *set);
    bool *in = array_create(n, sizeof *in);
    if (set == NULL || in == NULL)
        abort();
    for (size_t a = 0; a < n; a++)
        in[a] = z[a] > 0.7;
    for (size_t round = 0; changes > 0; round++) {
        assert_true(round < 50);
        dense->nodes = changes = 0;
        for (size_t a = 0; a < n; a++)
            if (in[a])
                set[dense->nodes++] = a;
        assert_true(dense->nodes > 0 && dense->nodes < 600);
        dense_solve(dense, set, z, force);
        for (size_t a = 0; a < n; a++) {
            bool touches = in[a] ? dense->p[a] > 0 : dense_gap(dense, z, a) < 0;
            changes += touches != in[a];
            in[a] = touches;
        }
    }
    free(set);
    free(in);
}

/* Three hills, one of which the side of the map cuts, on a map of 32 by 32 points. */
static void fill_hills(struct open_scene *scene) {
    static const double X[] = {9, 22, 31}, Y[] = {12, 20, 5}, HIGH[] = {1, 0.9, 0.95};
    const struct grid *grid = &scene->grid;
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t i = 0; i < grid->nx; i++)
            for (size_t hill = 0; hill < 3; hill++) {
                double x = (double)i - X[hill], y = (double)j * grid_dy(grid) - Y[hill];
                scene->z[j * grid->nx + i] += HIGH[hill] * exp(-(x * x + y * y) / 50);
            }
}

static void solutions_are_those_of_dense_equations(void **state) {
    (void)state;
    static const struct grid GRIDS[] = {{32, 32, 32, 32}, {32, 40, 32, 32}};
    for (size_t g = 0; g < 2; g++) {
        struct open_scene scene;
        open_scene_begin(&scene, GRIDS[g]);
        fill_hills(&scene);
        size_t n = grid_points(&scene.grid);
        struct dense dense = {.grid = scene.grid, .kernel = zeros(n), .p = zeros(n)};
        struct contact_state solved = open_scene_press(&scene, 0.005);
        double *unit = zeros(n);
        unit[0] = 1;
        displace(scene.compliance, unit, dense.kernel);
        dense_press(&dense, scene.z, 0.005 * (double)n);
        double most = largest(n, dense.p), highest = largest(n, scene.z);
        assert_int_equal(solved.nodes, dense.nodes);
        assert_true(dense.nodes > 50);
        for (size_t a = 0; a < n; a++)
            check_close(solved.p[a], dense.p[a], 1e-8 * most);
        for (size_t a = 0; a < n; a += 7)
            check_close(solved.gap[a], dense_gap(&dense, scene.z, a), 1e-9);
        check_close(solved.approach, highest - dense.level, 1e-10);
        /* Uniform pressures on rectangles are another discretisation. */
        for (size_t a = 0; a < n; a++) {
            size_t row = a / 32;
            dense.kernel[a] =
                love((double)(a % 32), (double)row * grid_dy(&scene.grid), 1, grid_dy(&scene.grid));
        }
        dense_press(&dense, scene.z, 0.005 * (double)n);
        check_relative((double)solved.nodes, (double)dense.nodes, 0.05);
        check_relative(largest(n, solved.p), largest(n, dense.p), 0.02);
        check_relative(solved.approach, highest - dense.level, 0.005);
        free(unit);
        free(dense.kernel);
        free(dense.p);
        open_scene_end(&scene);
    }
}

/* --- flat punches, and the sides of the map --- */

/* All nodes of a flat map bear the load, at a stiffness that no load changes. */
static void flat_map_is_a_punch(void **state) {
    (void)state;
    struct open_scene scene;
    open_scene_begin(&scene, (struct grid){48, 48, 2, 2});
    struct contact_state solved = open_scene_press(&scene, 0.01);
    struct contact_area area;
    contact_area(scene.areas, &solved, &area);
    assert_int_equal(solved.nodes, 48 * 48);
    check_close(area.edges, 1, 1e-12);
    check_close(area.lower, 1, 1e-12);
    check_relative(solved.stiffness * solved.approach, 0.01, 1e-4);
    /* The stiffness of a square punch of side 2 a is 1.15 times 2 a E*. */
    check_relative(solved.stiffness * 4 / 2, 1.15, 0.01);
    assert_true(solved.p[0] > 3 * solved.p[24 * 48 + 24]);
    open_scene_end(&scene);
}

/* Hills on both sides would be one, did the map repeat. */
static void sides_do_not_meet(void **state) {
    (void)state;
    struct open_scene scene;
    struct patch_finder *finder = NULL;
    struct patches patches;
    struct contact_area area, turned;
    open_scene_begin(&scene, (struct grid){64, 64, 64, 64});
    for (size_t j = 0; j < 64; j++)
        for (size_t i = 0; i < 64; i++) {
            double x = fmin((double)i, 63 - (double)i), y = (double)j - 32;
            scene.z[j * 64 + i] = -(x * x + y * y) / 400;
        }
    struct contact_state solved = open_scene_press(&scene, 0.002);
    contact_area(scene.areas, &solved, &area);
    assert_int_equal(patch_finder_create(&finder, &scene.grid, NULL), 0);
    patches_find(finder, solved.p, &patches, NULL);
    assert_int_equal(patches.count, 1);
    patch_finder_open(finder, 64, 64);
    patches_find(finder, solved.p, &patches, NULL);
    assert_int_equal(patches.count, 2);
    const size_t both = patches.largest;
    patch_finder_open(finder, 40, 32); /* a quarter of the hill that is at the left */
    patches_find(finder, solved.p, &patches, NULL);
    assert_int_equal(patches.count, 1);
    assert_true(patches.largest > both / 4 && patches.largest < both / 2 + 1);
    assert_true(area.lower < area.edges && area.edges < area.upper);
    check_relative(area.edges, area.nodes, 0.05);
    /* The same map with rows for columns. */
    for (size_t j = 0; j < 64; j++)
        for (size_t i = 0; i < j; i++) {
            double kept = scene.z[j * 64 + i];
            scene.z[j * 64 + i] = scene.z[i * 64 + j];
            scene.z[i * 64 + j] = kept;
        }
    solved = open_scene_press(&scene, 0.002);
    contact_area(scene.areas, &solved, &turned);
    check_relative(turned.edges, area.edges, 1e-9);
    check_relative(turned.perimeter, area.perimeter, 1e-9);
    patch_finder_destroy(&finder);
    open_scene_end(&scene);
}

/* A hill in the middle of the map has the pressures that it has anywhere else. */
static void place_in_the_map_does_not_matter(void **state) {
    (void)state;
    double peak[2], approach[2];
    for (size_t place = 0; place < 2; place++) {
        struct open_scene scene;
        open_scene_begin(&scene, (struct grid){80, 50, 80, 50});
        for (size_t j = 0; j < 50; j++)
            for (size_t i = 0; i < 80; i++) {
                double x = (double)i - (place == 0 ? 40 : 12),
                       y = (double)j - (place == 0 ? 25 : 36);
                scene.z[j * 80 + i] = fmax(-2, -(x * x + y * y) / 200);
            }
        struct contact_state solved = open_scene_press(&scene, 1e-3);
        peak[place] = largest(4000, solved.p);
        approach[place] = solved.approach;
        open_scene_end(&scene);
    }
    check_relative(peak[1], peak[0], 1e-6);
    check_relative(approach[1], approach[0], 1e-6);
}

static void other_blocks_are_refused(void **state) {
    (void)state;
    struct compliance *compliance = NULL;
    struct error err = {0};
    struct grid grid = {16, 16, 1, 1};
    struct block block = {.model = MODEL_LAYERED, .poisson = 0.3, .height = 1, .layer_growth = 1.1};
    assert_int_equal(compliance_create_open(&compliance, &grid, &block, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "pressed on a half-space alone"));
    block = DEEP;
    block.height = 2;
    assert_int_equal(compliance_create_open(&compliance, &grid, &block, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "block height 2 under a map that does not repeat"));
    assert_null(compliance);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bell_sinks_as_its_potential),
        cmocka_unit_test(bell_of_a_profile_sinks_as_its_potential),
        cmocka_unit_test(narrow_coated_maps_are_rows_of_wide_ones),
        cmocka_unit_test(long_coated_maps_are_cheap),
        cmocka_unit_test(coated_profiles_have_the_same_reference),
        cmocka_unit_test(solutions_are_those_of_dense_equations),
        cmocka_unit_test(flat_map_is_a_punch),
        cmocka_unit_test(sides_do_not_meet),
        cmocka_unit_test(place_in_the_map_does_not_matter),
        cmocka_unit_test(other_blocks_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
