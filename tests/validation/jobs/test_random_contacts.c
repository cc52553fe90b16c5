/* Protects random contacts: all distributions of heights, profiles and surfaces, half-spaces,
 * layers and free space, from light loads to full contact. Each is solved in the few steps that
 * sets of nodes take (active_set.h), from 32 to 1024 nodes a side: RUGO_EFFORT=60 presses 3000 of
 * them. And what the tolerance of the solver leaves is within its bound (F15.16), near full contact
 * too. */
#include "core/contact/area.h"
#include "core/contact/contact.h"
#include "core/contact/patches.h"
#include "core/surface/surface.h"
#include "jobs/contact/contact_errors.h"
#include "tests/support/check.h"
#include "tests/support/effort.h"
#include "tests/support/seed.h"
#include <stdlib.h>

enum { LOADS_MOST = 4 };

enum face { FACE_HALFSPACE, FACE_LAYERED, FACE_FREE, FACES };

/* A random contact. */
struct random_contact {
    uint64_t seed;
    enum face face;
    struct grid grid;
    struct block block;
    struct spectrum spectrum;
    struct surface_options options;
    double tolerance;
    size_t load_count;
    bool near_full; /* loads are over the pressure of full contact, else over E* h' */
    double loads[LOADS_MOST];
    double *z; /* grid_points */
    double rms_height, rms_slope;
};

static double uniform(uint64_t *state) {
    return (double)(next_word(state) >> 11) * 0x1p-53;
}

static double between(uint64_t *state, double low, double high) {
    return low + (high - low) * uniform(state);
}

/* Returns one of n values. */
static double one_of(uint64_t *state, size_t n, const double *values) {
    return values[(size_t)(uniform(state) * (double)n)];
}
#define ONE_OF(state, ...)                                                                         \
    one_of(state, sizeof((double[]){__VA_ARGS__}) / sizeof(double), (double[]){__VA_ARGS__})

static void draw_heights(uint64_t *state, struct heights *heights) {
    heights->type =
        (enum heights_type)ONE_OF(state, HEIGHTS_GAUSSIAN, HEIGHTS_WEIBULL_MIN, HEIGHTS_WEIBULL_MAX,
                                  HEIGHTS_LOGNORMAL, HEIGHTS_GAMMA, HEIGHTS_BETA);
    heights->shape =
        heights->type == HEIGHTS_LOGNORMAL ? between(state, 0.1, 1) : between(state, 0.7, 6);
    heights->second = between(state, 1, 5);
}

static void draw_block(uint64_t *state, enum face face, double length, struct block *out) {
    *out = (struct block){.model = face == FACE_LAYERED ? MODEL_LAYERED : MODEL_HALFSPACE,
                          .poisson = ONE_OF(state, 0, 0.3, 0.4999),
                          .height = INFINITY,
                          .layer_growth = between(state, 1.05, 1.3),
                          .weighting = uniform(state) < 0.5 ? GAP_STANDARD : GAP_DUAL};
    if (face == FACE_LAYERED)
        out->height = between(state, 0.2, 3) * length;
}

static int descending(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x < y) - (x > y);
}

/* Loads mostly rise, as those of studies do. */
static void draw_loads(uint64_t *state, struct random_contact *out) {
    out->load_count = 1 + (size_t)(uniform(state) * LOADS_MOST);
    for (size_t k = 0; k < out->load_count; k++)
        out->loads[k] =
            out->near_full ? pow(uniform(state), 0.3) : exp(between(state, log(0.001), log(0.9)));
    if (uniform(state) < 0.2)
        return;
    qsort(out->loads, out->load_count, sizeof *out->loads, descending);
    for (size_t k = 0; k < out->load_count / 2; k++) {
        double swap = out->loads[k];
        out->loads[k] = out->loads[out->load_count - 1 - k];
        out->loads[out->load_count - 1 - k] = swap;
    }
}

/* Draws one with sides of about 2^doublings nodes at most. */
static void draw(uint64_t seed, double doublings, struct random_contact *out) {
    uint64_t state = seed;
    *out = (struct random_contact){.seed = seed, .options = SURFACE_DEFAULTS};
    bool profile = uniform(&state) < 0.3;
    size_t n = (size_t)exp2(between(&state, 5, doublings));
    out->face = (enum face)(uniform(&state) * FACES);
    double length = (double)n / ONE_OF(&state, 2, 3, 4, 6, 8, 16);
    double longest = fmax(2, length / ONE_OF(&state, 1, 1, 2, 4, 8));
    out->grid = (struct grid){n, profile ? 1 : n, length, length};
    out->spectrum = (struct spectrum){.type = SPECTRUM_SELF_AFFINE,
                                      .hurst = between(&state, 0.1, 1),
                                      .wavelength_long = longest,
                                      .wavelength_rolloff = longest,
                                      .wavelength_short = 1,
                                      .scale = SCALE_RMS_SLOPE,
                                      .scale_value = 1};
    draw_heights(&state, &out->options.heights);
    out->options.max_iterations = 50;
    if (uniform(&state) < 0.3)
        out->options.amplitudes = AMPLITUDES_RANDOM;
    draw_block(&state, out->face, length, &out->block);
    out->near_full = out->face != FACE_FREE && uniform(&state) < 0.5;
    out->tolerance = ONE_OF(&state, 1e-4, 1e-8);
    draw_loads(&state, out);
}

static void generate(struct random_contact *of) {
    struct error err = {0};
    struct generator *generator = NULL;
    struct moments moments;
    size_t points = grid_points(&of->grid);
    of->z = array_create(points, sizeof *of->z);
    assert_non_null(of->z);
    if (generator_create(&generator, &of->spectrum, &of->grid, &of->options, &err) != 0 ||
        generator_run(generator, (struct random_key){of->seed, 0, 0}, of->z, NULL, &err) != 0)
        fail_msg("contact of seed %" PRIu64 ": %s", of->seed, err.text);
    modes_moments(generator_modes(generator), &moments);
    generator_destroy(&generator);
    double squares = 0;
    for (size_t i = 0; i < points; i++)
        squares += of->z[i] * of->z[i];
    of->rms_height = sqrt(squares / (double)points);
    of->rms_slope = moments.rms_slope;
}

enum value { VALUE_EDGES, VALUE_GAP, VALUE_NODES, VALUE_STIFFNESS, VALUE_PATCHES, VALUES };
static const enum measure_solver SOLVERS[VALUES] = {SOLVER_SMOOTH, SOLVER_GAP, SOLVER_COUNTED,
                                                    SOLVER_STIFFNESS, SOLVER_PATCHES};

/* What a load gives. */
struct load_values {
    double value[VALUES]; /* gap over the RMS height */
    size_t nodes, iterations;
};

static void take_values(const struct random_contact *of, struct area_workspace *areas,
                        struct patch_finder *patches, const struct contact_state *state,
                        struct load_values *out) {
    struct contact_area area;
    struct patches found;
    contact_area(areas, state, &area);
    patches_find(patches, state->p, &found, NULL);
    *out = (struct load_values){.value = {[VALUE_EDGES] = area.edges,
                                          [VALUE_GAP] = area.mean_gap / of->rms_height,
                                          [VALUE_NODES] = area.nodes,
                                          [VALUE_STIFFNESS] = state->stiffness,
                                          [VALUE_PATCHES] = (double)found.count},
                                .nodes = state->nodes,
                                .iterations = state->iterations};
}

/* Presses to all loads, with so many iterations each at most. values: NULL where none are asked. */
static int press(const struct random_contact *of, double tolerance, size_t iterations,
                 struct load_values *values, struct error *err) {
    struct compliance *compliance = NULL;
    struct contact *contact = NULL;
    struct area_workspace *areas = NULL;
    struct patch_finder *patches = NULL;
    struct contact_state state;
    struct contact_options options = CONTACT_DEFAULTS;
    options.tolerance = tolerance;
    options.max_iterations = iterations;
    int status = of->face == FACE_FREE
                     ? compliance_create_open(&compliance, &of->grid, &of->block, err)
                     : compliance_create(&compliance, &of->grid, &of->block, err);
    if (status == 0)
        status = contact_create(&contact, compliance, &options, err);
    if (status == 0 && values != NULL)
        status = area_workspace_create(&areas, compliance, err);
    if (status == 0 && values != NULL)
        status = patch_finder_create(&patches, &of->grid, err);
    if (status == 0)
        status = contact_begin(contact, of->z, err);
    for (size_t k = 0; status == 0 && k < of->load_count; k++) {
        double unit = of->near_full ? contact_full_pressure(contact) : of->rms_slope;
        status = contact_press(contact, of->loads[k] * unit, &state, err);
        if (status == 0 && values != NULL)
            take_values(of, areas, patches, &state, &values[k]);
    }
    patch_finder_destroy(&patches);
    area_workspace_destroy(&areas);
    contact_destroy(&contact);
    compliance_destroy(&compliance);
    return status;
}

/* Sets take 5 to 60 steps. Steps that follow a set which does not converge take more. */
enum { STEPS_MOST = 120 };

static void sets_solve_random_contacts(void **state) {
    (void)state;
    uint64_t seeds = seed_of_now();
    for (size_t a = 0; a < 50 * effort(); a++) {
        struct random_contact of;
        struct error err = {0};
        /* beyond the first 50, one in 25 is large */
        draw(next_word(&seeds), a > 50 && a % 25 == 0 ? 10 : 6.5, &of);
        generate(&of);
        if (press(&of, of.tolerance, STEPS_MOST, NULL, &err) != 0)
            fail_msg("contact of seed %" PRIu64 ", %zu x %zu nodes, face %d: %s", of.seed,
                     of.grid.nx, of.grid.ny, of.face, err.text);
        free(of.z);
    }
}

/* Counts values of a load by whether they are within the bound of the solver. */
static void count_bounds(const struct random_contact *of, const struct load_values *loose,
                         const struct load_values *exact, size_t within[VALUES],
                         size_t beyond[VALUES]) {
    double points = (double)grid_points(&of->grid), nodes = (double)loose->nodes;
    const struct solver_counts counts = {of->tolerance, nodes, points - nodes,
                                         loose->value[VALUE_PATCHES]};
    for (size_t v = 0; v < VALUES; v++) {
        double value = loose->value[v], truth = exact->value[v];
        if (!isfinite(truth) && !isfinite(value))
            continue;
        double bound = contact_errors_solver(SOLVERS[v], &counts, value);
        size_t *count = fabs(value - truth) <= bound + 1e-9 * fabs(truth) ? within : beyond;
        count[v]++;
    }
}

/* Of each value, over 40 contacts with some loads each, 1 % of those within their bounds and three
 * more may lie beyond. */
static void tolerances_leave_what_they_say(void **state) {
    (void)state;
    uint64_t seeds = seed_or(20);
    size_t within[VALUES] = {0}, beyond[VALUES] = {0};
    for (size_t a = 0; a < 40 * effort(); a++) {
        struct random_contact of;
        struct load_values loose[LOADS_MOST] = {0}, exact[LOADS_MOST] = {0};
        struct error err = {0};
        draw(next_word(&seeds), 6, &of);
        of.tolerance = 1e-4;
        generate(&of);
        if (press(&of, of.tolerance, CONTACT_DEFAULTS.max_iterations, loose, &err) != 0 ||
            press(&of, 1e-12, CONTACT_DEFAULTS.max_iterations, exact, &err) != 0)
            fail_msg("contact of seed %" PRIu64 ": %s", of.seed, err.text);
        for (size_t k = 0; k < of.load_count; k++)
            count_bounds(&of, &loose[k], &exact[k], within, beyond);
        free(of.z);
    }
    for (size_t v = 0; v < VALUES; v++) {
        printf("value %zu: %zu within, %zu beyond\n", v, within[v], beyond[v]);
        assert_true(within[v] > 50 * effort());
        assert_true((double)beyond[v] <= 3 + 0.01 * (double)within[v]);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sets_solve_random_contacts),
        cmocka_unit_test(tolerances_leave_what_they_say),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
