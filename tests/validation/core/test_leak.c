/* Protects: the leak of gaps with known flow (layers, checkerboards, waves), its order, the leak of
 * a pressed rough surface as a direct solution of the same equations has it, and how much of the
 * area is in contact where the free space closes. */
#include "tests/support/check.h"

#include "core/quantity/leak.h"
#include "core/surface/surface.h"
#include "tests/support/contact_scene.h"
#include "tests/support/seed.h"
#include <suitesparse/cholmod.h>

static struct leak_result measure(struct grid grid, const double *gap, const double *p) {
    struct leak *leak = NULL;
    struct leak_result result = {0};
    struct error err = {0};
    if (leak_create(&leak, &grid, &LEAK_DEFAULTS, &err) != 0 ||
        leak_measure(leak, gap, p, &result, &err) != 0)
        fail_msg("%s", err.text);
    leak_destroy(&leak);
    return result;
}

/* --- gaps with known flow --- */

/* Columns of any gaps: along them mean(g^3), across them 1/mean(g^-3), over mean(g)^3, with
 * harmonic means exactly. 1e-9: the solver's tolerance is 1e-10. */
static void layers_in_series_and_in_parallel(void **state) {
    (void)state;
    enum { NX = 75, NY = 18 };
    static const struct grid GRID = {NX, NY, 2, 0.7}, TURNED = {NY, NX, 0.7, 2};
    static double gap[NX * NY], turned[NX * NY];
    double mean = 0, cubes = 0, inverses = 0;
    uint64_t words = seed_or(5);
    for (size_t i = 0; i < NX; i++) {
        double g = exp(3 * ldexp((double)(next_word(&words) >> 11), -53));
        for (size_t j = 0; j < NY; j++)
            gap[j * NX + i] = turned[i * NY + j] = g;
        mean += g / NX;
        cubes += g * g * g / NX;
        inverses += 1 / (g * g * g) / NX;
    }
    double scale = pow(mean, -3);
    struct leak_result one = measure(GRID, gap, NULL), other = measure(TURNED, turned, NULL);
    check_relative(one.x.harmonic, scale / inverses, 1e-9);
    check_relative(one.y.harmonic, scale * cubes, 1e-9);
    check_relative(one.y.arithmetic, scale * cubes, 1e-9);
    check_relative(other.y.harmonic, scale / inverses, 1e-9);
    check_relative(other.x.arithmetic, scale * cubes, 1e-9);
    assert_true(one.x.arithmetic > one.x.value && one.x.value > one.x.harmonic);
}

/* Waves a (1 - cos): <(1 - cos)^3> = 5/2 along the valleys, which points of equal distance have
 * exactly; the crests touch and close the cell across. */
static void waves_conduct_along_their_valleys(void **state) {
    (void)state;
    enum { N = 48 };
    static const struct grid GRID = {N, N, 1, 1};
    static double gap[N * N];
    for (size_t i = 0; i < (size_t)N * N; i++)
        gap[i] = i % N == 0 ? 0 : 1 - cos(2 * M_PI * (double)(i % N) / N);
    struct leak_result result = measure(GRID, gap, NULL);
    check_relative(result.y.value, 2.5, 1e-9);
    assert_false(result.x.open);
}

/* An endless checkerboard of a and b has sqrt(a b) (Keller 1964). Its ends run through the middle
 * of squares. The corners are singular: with 32 nodes a square 4 : 1 is 1 % off at most. */
static void checkerboards_have_the_geometric_mean(void **state) {
    (void)state;
    enum { SQUARE = 32, N = 4 * SQUARE };
    static const struct grid GRID = {N, N, 1, 1};
    static double gap[N * N];
    for (size_t j = 0; j < N; j++)
        for (size_t i = 0; i < N; i++) {
            size_t a = (i + SQUARE / 2) / SQUARE + (j + SQUARE / 2) / SQUARE;
            gap[j * N + i] = a % 2 == 0 ? cbrt(4) : 1;
        }
    struct leak_result result = measure(GRID, gap, NULL);
    double scale = pow(result.mean_gap, 3);
    check_relative(scale * result.x.value, 2, 0.01);
    check_relative(scale * result.y.value, 2, 0.01);
    assert_true(scale * result.x.harmonic < 2 && scale * result.x.arithmetic > 2);
}

/* A smooth gap on grids of n, 2 n, 4 n: what harmonic and arithmetic means change by falls to a
 * quarter (second order; 2 % for terms of fourth order), and the limit lies between them. The best
 * estimate, made for pressed surfaces, is within the bracket, too. */
static void smooth_gaps_converge_to_second_order(void **state) {
    (void)state;
    enum { LEVELS = 4, MOST = 256 };
    static double gap[MOST * MOST];
    double harmonic[LEVELS], arithmetic[LEVELS], value[LEVELS];
    for (size_t l = 0; l < LEVELS; l++) {
        size_t n = (size_t)MOST >> (LEVELS - 1 - l);
        struct grid grid = {n, n, 1, 1};
        for (size_t j = 0; j < n; j++)
            for (size_t i = 0; i < n; i++) {
                double x = 2 * M_PI * ((double)i + 0.5) / (double)n;
                double y = 2 * M_PI * ((double)j + 0.5) / (double)n;
                gap[j * n + i] = 1 + 0.4 * cos(x + 0.3) * sin(y) + 0.3 * sin(x - 2 * y);
            }
        struct leak_result result = measure(grid, gap, NULL);
        harmonic[l] = result.x.harmonic;
        arithmetic[l] = result.x.arithmetic;
        value[l] = result.x.value;
        assert_true(harmonic[l] < value[l] && value[l] < arithmetic[l]);
    }
    check_close((harmonic[2] - harmonic[1]) / (harmonic[3] - harmonic[2]), 4, 0.08);
    check_close((arithmetic[2] - arithmetic[1]) / (arithmetic[3] - arithmetic[2]), 4, 0.08);
    double limit = harmonic[3] + (harmonic[3] - harmonic[2]) / 3;
    check_relative(arithmetic[3] + (arithmetic[3] - arithmetic[2]) / 3, limit, 1e-5);
    for (size_t l = 0; l < LEVELS; l++)
        assert_true(harmonic[l] < limit && limit < arithmetic[l]);
}

/* --- a direct solution --- */

/* The network of a direction, by a labelling and a factorisation of its own. Node (i, j) is i
 * across and j along. */
struct direct {
    size_t nx, ny;
    double along;
    bool harmonic;
    double
        *cube; /* owned; 0 of closed nodes and, after mark, of those that an end does not reach */
    bool *reached;
};

static double face(const struct direct *d, size_t a, size_t b) {
    double k = d->cube[a], l = d->cube[b];
    if (k == 0 || l == 0)
        return 0;
    return d->harmonic ? 2 / (1 / k + 1 / l) : (k + l) / 2;
}

/* Neighbours of node (i, j): left, right, below, above; itself where there is none. */
static void neighbours(const struct direct *d, size_t i, size_t j, size_t *out) {
    size_t nx = d->nx, row = j * nx, a = row + i;
    out[0] = i > 0 ? a - 1 : a;
    out[1] = i + 1 < nx ? a + 1 : a;
    out[2] = (j > 0 ? row - nx : (d->ny - 1) * nx) + i;
    out[3] = (j + 1 < d->ny ? row + nx : 0) + i;
}

/* Reaches free nodes from those reached. Returns whether there are any. */
static bool reach_further(struct direct *d) {
    bool any = false;
    for (size_t j = 0; j < d->ny; j++)
        for (size_t i = 0; i < d->nx; i++) {
            size_t a = j * d->nx + i, next[4];
            neighbours(d, i, j, next);
            for (size_t k = 0; k < 4 && d->cube[a] > 0 && !d->reached[a]; k++)
                if (d->reached[next[k]])
                    d->reached[a] = any = true;
        }
    return any;
}

/* Closes the free nodes without a path to a column. */
static void mark(struct direct *d, size_t column) {
    size_t n = d->nx * d->ny;
    memset(d->reached, 0, n * sizeof *d->reached);
    for (size_t j = 0; j < d->ny; j++)
        d->reached[j * d->nx + column] = d->cube[j * d->nx + column] > 0;
    while (reach_further(d))
        ;
    for (size_t a = 0; a < n; a++)
        d->cube[a] = d->reached[a] ? d->cube[a] : 0;
}

static void put(cholmod_triplet *matrix, size_t row, size_t column, double value) {
    ((int *)matrix->i)[matrix->nnz] = (int)row;
    ((int *)matrix->j)[matrix->nnz] = (int)column;
    ((double *)matrix->x)[matrix->nnz++] = value;
}

/* The balance of a node: without conductances its pressure is 0. */
static void put_node(const struct direct *d, size_t i, size_t j, cholmod_triplet *entries,
                     double *load) {
    size_t a = j * d->nx + i, next[4];
    neighbours(d, i, j, next);
    put(entries, a, a, d->cube[a] == 0 ? 1 : 0);
    if (i == 0 || i + 1 == d->nx)
        put(entries, a, a, 2 * d->cube[a]);
    if (i == 0)
        load[a] = 2 * d->cube[a];
    for (size_t k = 0; k < 4; k++) {
        double c = next[k] != a ? face(d, a, next[k]) * (k < 2 ? 1 : d->along) : 0;
        put(entries, a, a, c);
        if (next[k] < a)
            put(entries, a, next[k], -c);
    }
}

/* Returns the flow into the first column. */
static double solve(const struct direct *d) {
    size_t n = d->nx * d->ny;
    cholmod_common common;
    cholmod_start(&common);
    cholmod_triplet *entries = cholmod_allocate_triplet(n, n, 9 * n, -1, CHOLMOD_REAL, &common);
    cholmod_dense *load = cholmod_zeros(n, 1, CHOLMOD_REAL, &common);
    for (size_t j = 0; j < d->ny; j++)
        for (size_t i = 0; i < d->nx; i++)
            put_node(d, i, j, entries, load->x);
    cholmod_sparse *matrix = cholmod_triplet_to_sparse(entries, 0, &common);
    cholmod_factor *factor = cholmod_analyze(matrix, &common);
    assert_true(cholmod_factorize(matrix, factor, &common) && common.status == CHOLMOD_OK);
    cholmod_dense *pressure = cholmod_solve(CHOLMOD_A, factor, load, &common);
    double flow = 0;
    for (size_t j = 0; j < d->ny; j++)
        flow += 2 * d->cube[j * d->nx] * (1 - ((double *)pressure->x)[j * d->nx]);
    cholmod_free_dense(&pressure, &common);
    cholmod_free_factor(&factor, &common);
    cholmod_free_sparse(&matrix, &common);
    cholmod_free_dense(&load, &common);
    cholmod_free_triplet(&entries, &common);
    cholmod_finish(&common);
    return flow;
}

static double solve_direction(const struct grid *grid, const double *gap, const double *p,
                              bool along_x, bool harmonic) {
    size_t n = grid_points(grid), nx = along_x ? grid->nx : grid->ny, ny = n / nx;
    double ratio = grid_dx(grid) / grid_dy(grid), mean = 0;
    struct direct d = {nx,       ny,       along_x ? ratio * ratio : 1 / (ratio * ratio),
                       harmonic, zeros(n), calloc(n, sizeof(bool))};
    assert_non_null(d.reached);
    for (size_t a = 0; a < n; a++) {
        size_t at = along_x ? a : a % nx * grid->nx + a / nx;
        double g = p[at] > 0 ? 0 : fmax(gap[at], 0);
        d.cube[a] = g * g * g;
        mean += g / (double)n;
    }
    mark(&d, 0);
    mark(&d, nx - 1);
    double flow = solve(&d);
    free(d.cube);
    free(d.reached);
    return flow * (double)nx / (double)ny / pow(mean, 3);
}

static void random_heights(struct scene *scene, double longest, double shortest, uint64_t seed) {
    struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                .hurst = 0.8,
                                .wavelength_long = longest,
                                .wavelength_rolloff = longest,
                                .wavelength_short = shortest,
                                .scale = SCALE_RMS_SLOPE,
                                .scale_value = 1};
    struct generator *generator = NULL;
    struct error err = {0};
    if (generator_create(&generator, &spectrum, &scene->grid, &SURFACE_DEFAULTS, &err) != 0 ||
        generator_run(generator, (struct random_key){.seed = seed}, scene->z, NULL, &err) != 0)
        fail_msg("%s", err.text);
    generator_destroy(&generator);
    scene_begin(scene);
}

/* From hardly any contact to where one direction has closed, on grids with several levels. 1e-6: a
 * direct solution loses the digits by which conductances differ. */
static void pressed_surfaces_agree_with_a_direct_solution(void **state) {
    (void)state;
    static const struct grid GRIDS[] = {{128, 90, 1, 0.9}, {101, 97, 1, 0.97}};
    static const double LOADS[] = {0.02, 0.15, 0.24};
    size_t compared = 0;
    for (size_t g = 0; g < sizeof GRIDS / sizeof *GRIDS; g++) {
        const struct grid *grid = &GRIDS[g];
        struct scene scene;
        scene_open(&scene, *grid, DEEP, 1e-10);
        random_heights(&scene, 0.5, 0.1, 20 + g);
        for (size_t l = 0; l < sizeof LOADS / sizeof *LOADS; l++) {
            scene_press(&scene, LOADS[l]);
            const double *gap = scene.state.gap, *p = scene.state.p;
            struct leak_result result = measure(*grid, gap, p);
            const struct leak_direction *const directions[] = {&result.x, &result.y};
            for (size_t k = 0; k < 2; k++) {
                double harmonic = solve_direction(grid, gap, p, k == 0, true);
                double arithmetic = solve_direction(grid, gap, p, k == 0, false);
                assert_true(directions[k]->open == (harmonic > 0));
                check_relative(directions[k]->harmonic, harmonic, 1e-6);
                check_relative(directions[k]->arithmetic, arithmetic, 1e-6);
                compared += directions[k]->open;
            }
        }
        scene_close(&scene);
    }
    assert_true(compared >= 9);
}

/* --- percolation --- */

/* Share of nodes in contact where x closes, to 1/100 of the area. */
static double closing_area(struct scene *scene, struct leak *leak) {
    double low = 0.1, high = 0.5, area = 0;
    for (int step = 0; step < 6; step++) {
        struct leak_result result;
        struct error err = {0};
        double load = (low + high) / 2;
        scene_press(scene, load);
        if (leak_measure(leak, scene->state.gap, scene->state.p, &result, &err) != 0)
            fail_msg("%s", err.text);
        area = (double)scene->state.nodes / (double)scene_points(scene);
        *(result.x.open ? &low : &high) = load;
    }
    return area;
}

/* Free space closes along x at about 0.43 of the area by nodes. With H = 0.8 and cells of two to
 * eight longest waves it is 0.41 to 0.43 without the mesh's error, and nodes count 0.01 to 0.02
 * more. One cell of two waves scatters by 0.06, the mean of six by 0.025: 0.08 is three of those.
 */
static void free_space_closes_below_half_of_the_area(void **state) {
    (void)state;
    enum { N = 64, SURFACES = 6 };
    static const struct grid GRID = {N, N, 1, 1};
    struct scene scene;
    struct leak *leak = NULL;
    double mean = 0;
    uint64_t seed = seed_or(100);
    assert_int_equal(leak_create(&leak, &GRID, &LEAK_DEFAULTS, NULL), 0);
    scene_open(&scene, GRID, DEEP, 1e-8);
    for (size_t s = 0; s < SURFACES; s++) {
        random_heights(&scene, 0.5, 0.125, seed + s);
        mean += closing_area(&scene, leak) / SURFACES;
    }
    check_close(mean, 0.43, 0.08);
    scene_close(&scene);
    leak_destroy(&leak);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layers_in_series_and_in_parallel),
        cmocka_unit_test(waves_conduct_along_their_valleys),
        cmocka_unit_test(checkerboards_have_the_geometric_mean),
        cmocka_unit_test(smooth_gaps_converge_to_second_order),
        cmocka_unit_test(pressed_surfaces_agree_with_a_direct_solution),
        cmocka_unit_test(free_space_closes_below_half_of_the_area),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
