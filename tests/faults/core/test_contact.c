/* Protects: a block is pressed, and areas, patches and fits found, or refused for want of memory,
 * whichever allocation fails; nothing leaks, and the same press succeeds afterwards. */
#include "tests/support/check.h"

#include "core/contact/area.h"
#include "core/contact/contact.h"
#include "core/contact/patches.h"
#include "core/full/file/mesh_vtu.h"
#include "core/full/friction/friction.h"
#include "core/full/full.h"
#include "core/statistics/fit.h"
#include "tests/support/failing/each_allocation.h"
#include "tests/support/failing/failing_allocator.h"
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 8, POINTS = SIDE * SIDE };
static const struct grid GRID = {SIDE, SIDE, 1, 1}, LINE = {16, 1, 1, 1};
static const struct block DEEP = {.model = MODEL_HALFSPACE, .poisson = 0.3, .height = INFINITY};
static const struct block MESHED = {
    .model = MODEL_LAYERED, .poisson = 0.3, .height = 1, .layer_growth = 1.5};

static void heights(const struct grid *grid, double amplitude, double *z) {
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t i = 0; i < grid->nx; i++)
            z[j * grid->nx + i] = amplitude * (cos(2 * M_PI * (double)i / (double)grid->nx) +
                                               cos(2 * M_PI * (double)j / (double)grid->ny));
}

struct block_fault {
    const struct grid *grid;
    struct block block;
    bool open;
    double hardness; /* 0: none */
};
struct pressed_fault {
    struct compliance *compliance;
    struct contact *contact;
    struct area_workspace *areas;
    struct patch_finder *finder;
};

static int press_once(struct pressed_fault *p, const struct block_fault *pressed,
                      struct error *err) {
    double z[POINTS];
    struct contact_state state;
    struct contact_area area;
    struct patches patches;
    const struct grid *grid = pressed->grid;
    struct contact_options options = CONTACT_DEFAULTS;
    if (pressed->hardness > 0)
        options.hardness = pressed->hardness;
    heights(grid, 0.1, z);
    int status = pressed->open ? compliance_create_open(&p->compliance, grid, &pressed->block, err)
                               : compliance_create(&p->compliance, grid, &pressed->block, err);
    if (status == 0)
        status = contact_create(&p->contact, p->compliance, &options, err);
    if (status == 0)
        status = area_workspace_create(&p->areas, p->compliance, err);
    if (status == 0)
        status = patch_finder_create(&p->finder, grid, err);
    if (status == 0)
        status = contact_begin(p->contact, z, err);
    if (status == 0)
        status = contact_press(p->contact, 0.05, &state, err);
    if (status != 0)
        return status;
    contact_area(p->areas, &state, &area);
    patches_find(p->finder, state.p, &patches, NULL);
    assert_int_equal(patches.count, 1);
    assert_true(area.edges > 0);
    return 0;
}

static int press(void *context, struct error *err) {
    struct pressed_fault p = {0};
    int status = press_once(&p, context, err);
    patch_finder_destroy(&p.finder);
    area_workspace_destroy(&p.areas);
    contact_destroy(&p.contact);
    compliance_destroy(&p.compliance);
    return status;
}

static void linear_models(void **state) {
    (void)state;
    struct block_fault deep = {&LINE, DEEP, false, 0}, meshed = {&GRID, MESHED, false, 0};
    struct block_fault open = {&GRID, DEEP, true, 0}, soft = {&GRID, DEEP, false, 0.15};
    each_allocation(&(struct failing_call){.name = "half-space", press, &deep});
    each_allocation(&(struct failing_call){.name = "layered", press, &meshed});
    each_allocation(&(struct failing_call){.name = "free space", press, &open});
    struct block_fault coated = {&LINE, DEEP, true, 0};
    coated.block.coating = (struct coating){0.1, 4, 0.2};
    each_allocation(&(struct failing_call){.name = "coated", press, &coated});
    each_allocation(&(struct failing_call){.name = "hardness", press, &soft});
}

struct solid_case {
    struct grid grid;
    enum equation_solver solver;
};

static int write_mesh(struct full *full, struct error *err) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    if (file == NULL)
        return error_set(err, ERROR_MEMORY, "no stream");
    int status = mesh_vtu(file, "a block", full_mesh(full), NULL, err);
    /* Where the C library cannot close it for want of memory, it says so by no text alone. */
    if ((fclose(file) != 0 || text == NULL) && status == 0)
        status = error_set(err, ERROR_MEMORY, "a short stream");
    free(text);
    return status;
}

static int press_solid(void *context, struct error *err) {
    const struct solid_case *solid = context;
    struct full_options options = FULL_DEFAULTS;
    struct full *full = NULL;
    struct contact_state state;
    double z[POINTS];
    options.solver = solid->solver;
    heights(&solid->grid, 0.02, z);
    int status = full_create(&full, &solid->grid, &MESHED, &options, err);
    if (status == 0)
        status = full_begin(full, z, err);
    if (status == 0)
        status = full_press(full, 0.02, &state, NULL, err);
    if (status == 0) {
        assert_true(state.nodes > 0);
        /* A press again, from a state that stands. */
        status = full_press(full, 0.03, &state, NULL, err);
    }
    if (status == 0)
        status = write_mesh(full, err);
    full_destroy(&full);
    return status;
}

static void full_model(void **state) {
    (void)state;
    struct solid_case cases[] = {
        {LINE, SOLVER_ITERATED}, {LINE, SOLVER_FACTORED}, {{4, 4, 1, 1}, SOLVER_ITERATED}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++)
        /* The factorisation has more than one ordering of the unknowns. */
        each_allocation(&(struct failing_call){.name = "full",
                                               press_solid,
                                               &cases[c],
                                               .also = ERROR_SYSTEM,
                                               .may_succeed = cases[c].solver == SOLVER_FACTORED});
}

static int drag_solid(void *context, struct error *err) {
    static const struct friction_options FRICTION = {.coefficient = 0.3, .press_steps = 1};
    struct friction *friction = NULL;
    struct friction_state state;
    double z[POINTS];
    const struct grid *grid = context;
    heights(grid, 0.02, z);
    int status = friction_create(&friction, grid, &MESHED, &FULL_DEFAULTS, &FRICTION, err);
    if (status == 0)
        status = friction_begin(friction, z, err);
    if (status == 0)
        status = friction_press(friction, 0.02, &state, err);
    if (status == 0)
        status = friction_load(friction, 0.003, &state, err);
    if (status == 0)
        check_close(state.traction, 0.003, 1e-10);
    friction_destroy(&friction);
    return status;
}

/* UMFPACK tries again with less memory. */
static void friction(void **state) {
    (void)state;
    struct grid line = LINE, surface = GRID;
    each_allocation(&(struct failing_call){
        .name = "friction", drag_solid, .context = &line, .may_succeed = true});
    each_allocation(&(struct failing_call){
        .name = "friction of a surface", drag_solid, .context = &surface, .may_succeed = true});
}

/* Iterations that are too few for the usual steps, so that overhangs begin. */
struct careful_case {
    const char *name;
    size_t max_iterations;
    bool rubs;
};

/* Presses with allocation n of what overhangs take and all behind it failing; with friction drags
 * so after a press that has them. Returns whether one failed. */
static bool fail_careful(const struct careful_case *with, uint64_t n) {
    static const struct grid SMALL = {4, 4, 1, 1};
    static const struct friction_options FRICTION = {.coefficient = 0.3, .press_steps = 1};
    struct full_options options = FULL_DEFAULTS;
    struct friction *friction = NULL;
    struct full *full = NULL;
    struct contact_state pressed;
    struct friction_state dragged;
    struct error err = {0};
    double z[POINTS];
    options.max_iterations = with->max_iterations;
    options.least_step = 1;
    options.tolerance = 1e-4;
    heights(&SMALL, 0.02, z);
    int status = with->rubs ? friction_create(&friction, &SMALL, &MESHED, &options, &FRICTION, &err)
                            : full_create(&full, &SMALL, &MESHED, &options, &err);
    if (status == 0)
        status = with->rubs ? friction_begin(friction, z, &err) : full_begin(full, z, &err);
    if (status == 0 && with->rubs)
        status = friction_press(friction, 0.02, &dragged, &err);
    if (status != 0)
        fail_msg("%s", err.text);
    failing_arm(n, UINT64_MAX);
    status = with->rubs ? friction_load(friction, 0.0055, &dragged, &err)
                        : full_press(full, 0.02, &pressed, NULL, &err);
    const bool failed = failing_disarm().failed > 0;
    if (failed && (status != ERROR_MEMORY || strstr(err.text, "cannot allocate") != err.text))
        fail_msg("%s, allocation %" PRIu64 " failed: %d, %s", with->name, n, status, err.text);
    friction_destroy(&friction);
    full_destroy(&full);
    return failed;
}

/* It is not "no equilibrium", for which studies drop the load and go on. */
static void overhangs_without_memory(void **state) {
    (void)state;
    static const struct careful_case CASES[] = {{"a press", 2, false}, {"a drag", 3, true}};
    enum { STEP = 4 };
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        uint64_t n = 0;
        while (fail_careful(&CASES[c], n))
            n += STEP;
        print_message("%s: about %" PRIu64 " allocations\n", CASES[c].name, n);
        assert_true(n > 0);
    }
}

static int fit_all(void *context, struct error *err) {
    static const double LOAD[] = {0.01, 0.02, 0.03, 0.1}, FRACTION[] = {0.02, 0.04, 0.06, 0.2};
    struct fit fit;
    (void)context;
    int status = fit_light_load(4, LOAD, FRACTION, &fit, err);
    if (status == 0)
        status = fit_power_law(4, LOAD, FRACTION, &fit, err);
    if (status == 0)
        status = fit_erf(4, LOAD, FRACTION, &fit, err);
    return status;
}

static void fits(void **state) {
    (void)state;
    each_allocation(&(struct failing_call){.name = "fits", fit_all, NULL});
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(linear_models), cmocka_unit_test(full_model),
        cmocka_unit_test(friction),      cmocka_unit_test(overhangs_without_memory),
        cmocka_unit_test(fits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
