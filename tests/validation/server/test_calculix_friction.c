/* Protects friction at finite strain: where CalculiX is installed, it drags blocks of the model
 * full as far, and finds the same tangential force and the same nodes that stick.
 *
 * The block is pressed without friction; then its far side moves along, and towards the flat as
 * far as under a constant load by Rugo. CalculiX has a penalty in place of contact without
 * penetration, and a tangential stiffness in place of stick. It holds each node of the far side
 * along the face, where Rugo holds their mean: the block is so high that little of the pressures is
 * left there. (Two thirds as high, forces differ by 0.6 % of the friction.) RUGO_TABLE=1 drags
 * three profiles, as RUGO_EFFORT does, and prints the figures of METHODS.md. */
#include "core/full/file/mesh_inp.h"
#include "core/full/friction/friction.h"
#include "tests/support/check.h"
#include "tests/support/effort.h"
#include "tests/support/process.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

enum { NODES = 128, WAVES = 8, STEPS = 6, PARTS = 4 };
static const double MU = 0.3, LOAD = 0.1, LENGTH = 8;

/* Waves with a spectrum of H = 0.8, 16 points to the shortest. */
struct profile {
    double slope, phase, poisson; /* RMS slope */
};
static const struct profile PROFILES[] = {{0.1, 1, 0.3}, {0.1, 2, 0}, {0.25, 3, 0.3}};
enum { PROFILE_COUNT = sizeof PROFILES / sizeof *PROFILES };

/* After a step. */
struct dragged {
    double along, down; /* of the far side since the end of pressing */
    double force;       /* Q/P */
    size_t touching, stuck;
};

static double cpu_seconds(int who) {
    struct rusage usage;
    getrusage(who, &usage);
    return (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
           1e-6 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

static void fill(const struct profile *profile, double z[NODES]) {
    double square = 0;
    for (int k = 1; k <= WAVES; k++)
        square += pow(k, -0.6) / 2;
    for (size_t i = 0; i < NODES; i++) {
        z[i] = 0;
        for (int k = 1; k <= WAVES; k++) {
            double wave = 2 * M_PI * k / LENGTH;
            z[i] += profile->slope / sqrt(square) * pow(k, -0.3) / wave *
                    cos(wave * LENGTH * (double)i / NODES + profile->phase * k * k);
        }
    }
}

static struct dragged state_of(const struct friction_state *state) {
    return (struct dragged){.along = state->displacement,
                            .down = state->pressing_work / state->pressure,
                            .force = state->traction / state->pressure,
                            .touching = state->nodes,
                            .stuck = state->stuck};
}

/* Presses and drags by Rugo, to full slip about: the shear of the block and half of that. */
static void drag(const struct grid *grid, const struct block *block,
                 const struct full_options *options, const double *z, double pressure,
                 struct dragged out[STEPS]) {
    const struct friction_options with = {.coefficient = MU};
    struct friction *friction;
    struct friction_state state;
    struct error err = {0};
    const double most = 1.5 * MU * pressure * block->height * 2 / (1 - block->poisson);
    if (friction_create(&friction, grid, block, options, &with, &err) != 0 ||
        friction_begin(friction, z, &err) != 0 ||
        friction_press(friction, pressure, &state, &err) != 0)
        fail_msg("%s", err.text);
    for (size_t part = 1; part <= PARTS * STEPS; part++) {
        if (friction_drag(friction, most * (double)part / (PARTS * STEPS), &state, &err) != 0)
            fail_msg("%s", err.text);
        if (part % PARTS == 0)
            out[part / PARTS - 1] = state_of(&state);
    }
    friction_destroy(&friction);
}

/* --- CalculiX --- */

/* Writes the block as it is pressed, then a step for each drag. */
static void write_model(const struct grid *grid, const struct block *block,
                        const struct full_options *options, const double *z, double pressure,
                        const struct dragged *steps) {
    struct full *full;
    struct contact_state state;
    struct error err = {0};
    FILE *file = fopen("pressed.inp", "w");
    assert_non_null(file);
    if (full_create(&full, grid, block, options, &err) != 0 || full_begin(full, z, &err) != 0 ||
        full_press(full, pressure, &state, NULL, &err) != 0)
        fail_msg("%s", err.text);
    const struct mesh *mesh = full_mesh(full);
    const double *u = full_displacement(full);
    const struct inp_step pressed = {-u[mesh_vertical(mesh, mesh_far_side(mesh))], pressure};
    const struct inp_model model = {.mesh = mesh,
                                    .material = material_of(block->poisson, options->kinematics),
                                    .step_count = 1,
                                    .steps = &pressed};
    assert_int_equal(mesh_inp(file, "lx", &model, &err), 0);
    assert_int_equal(fclose(file), 0);
    file = fopen("steps.inp", "w");
    assert_non_null(file);
    for (size_t k = 0; k < STEPS; k++)
        fprintf(file,
                "*STEP, NLGEOM, INC=1000\n*STATIC\n0.25, 1., 1e-6\n%s*BOUNDARY\nFAR_OWN, 2, 2, "
                "%.12g\nFAR_OWN, 1, 1, %.12g\n*NODE PRINT, NSET=FAR, TOTALS=ONLY\nRF\n*CONTACT "
                "PRINT\nCSTR\n*END STEP\n",
                k == 0 ? "*CHANGE FRICTION, INTERACTION=HARD\n*FRICTION\n0.3, 1600.\n" : "",
                -pressed.displacement - steps[k].down, -steps[k].along);
    assert_int_equal(fclose(file), 0);
    full_destroy(&full);
    check_shell("sed '/^[*]CONTACT PAIR/i *FRICTION\\n1e-6, 1600.' pressed.inp > dragged.inp && "
                "cat steps.inp "
                ">> dragged.inp");
}

/* Returns where the block of a quantity at the end of a step begins in what CalculiX printed. */
static const char *block_at(const char *text, const char *what, size_t step) {
    char end[20];
    snprintf(end, sizeof end, "0.%zu000000E+01\n", step);
    for (const char *at = text; (at = strstr(at, what)) != NULL; at += strlen(what)) {
        const char *line = at + strcspn(at, "\n");
        if (line > at + strlen(end) && strncmp(line + 1 - strlen(end), end, strlen(end)) == 0)
            return line + 1;
    }
    fail_msg("no %s at the end of step %zu", what, step);
    return "";
}

/* Reads what CalculiX printed of the front sheet, whose points have the numbers of nodes from 1. */
static struct dragged read_step(const char *text, size_t step) {
    struct dragged out = {.touching = 0};
    double along, down, pressure, tangential;
    size_t number;
    int used;
    assert_int_equal(sscanf(block_at(text, "total force (fx,fy,fz) for set FAR", step), "%lf %lf",
                            &along, &down),
                     2);
    out.force = fabs(along / down);
    const char *at = block_at(text, "contact stress (slave node,press,tang1,tang2)", step);
    double other;
    while (sscanf(at, " %zu %lf %lf %lf%n", &number, &pressure, &tangential, &other, &used) == 4) {
        bool touches = number <= NODES && pressure > 1e-7;
        out.touching += touches;
        out.stuck += touches && hypot(tangential, other) < MU * pressure * (1 - 1e-3);
        at += used;
    }
    return out;
}

/* Compares a step. Measured: forces differ by 0.03 % of the friction at most, sets by a node. */
static void compare(const struct dragged *own, const struct dragged *other) {
    check_close(other->force, own->force, 0.001 * MU);
    assert_true(labs((long)other->touching - (long)own->touching) <= 1);
    assert_true(labs((long)other->stuck - (long)own->stuck) <= 1);
}

static void press_profile(const struct profile *profile, bool prints) {
    const struct grid grid = {NODES, 1, LENGTH, 1};
    const double pressure = LOAD * profile->slope;
    double z[NODES];
    struct dragged own[STEPS];
    struct full_options options = FULL_DEFAULTS;
    const struct block block = {.model = MODEL_LAYERED,
                                .poisson = profile->poisson,
                                .height = 1.5 * LENGTH,
                                .layer_growth = 1.1,
                                .weighting = GAP_DUAL};
    size_t slips = 0;
    options.kinematics = KINEMATICS_ST_VENANT;
    fill(profile, z);
    double start = cpu_seconds(RUSAGE_SELF);
    drag(&grid, &block, &options, z, pressure, own);
    double seconds = cpu_seconds(RUSAGE_SELF) - start;
    write_model(&grid, &block, &options, z, pressure, own);
    start = cpu_seconds(RUSAGE_CHILDREN);
    check_shell("ccx dragged");
    double others = cpu_seconds(RUSAGE_CHILDREN) - start;
    char *text = slurp("dragged.dat");
    if (prints)
        printf("slope %g, nu %g: CPU %.2f s, CalculiX %.1f s\n", profile->slope, profile->poisson,
               seconds, others);
    for (size_t k = 0; k < STEPS; k++) {
        const struct dragged other = read_step(text, k + 2);
        if (prints)
            printf("dragged by %.4f: Q/P %.5f, CalculiX %.5f; stuck %zu, %zu; touching %zu, %zu\n",
                   own[k].along, own[k].force, other.force, own[k].stuck, other.stuck,
                   own[k].touching, other.touching);
        compare(&own[k], &other);
        slips += own[k].stuck > 0 && own[k].stuck < own[k].touching;
    }
    assert_true(slips >= 2);
    free(text);
}

static void calculix_drags_the_same(void **state) {
    (void)state;
    const bool prints = getenv("RUGO_TABLE") != NULL;
    if (run_shell("command -v ccx") != 0) {
        print_message("ccx (Debian's calculix-ccx) is not installed\n");
        skip();
    }
    for (size_t p = 0; p < (prints || every_case() ? PROFILE_COUNT : 1); p++)
        press_profile(&PROFILES[p], prints);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(calculix_drags_the_same)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
