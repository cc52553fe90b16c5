/* Protects random scenes of the model full: profiles and surfaces, all laws of strain, both
 * weightings, ratios of Poisson up to 0.4999, slopes up to 1, friction up to 1, loads from 0.001 to
 * 0.9 E* h', up and down, paths of the flat that turn. Each load and each step along the face ends
 * with a state that holds together, or with an error that says what failed and what was reached; no
 * scene takes longer than its limit. RUGO_SCENES=2000 presses so many, RUGO_TABLE=1 prints each. */
#include "core/full/face.h"
#include "core/full/friction/friction.h"
#include "tests/support/check.h"
#include "tests/support/effort.h"
#include "tests/support/hard_scene.h"
#include "tests/support/seed.h"
#include <float.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { LOADS_MOST = 4, LEGS_MOST = 3, SCENES = 12 };
/* Seconds of CPU time of a scene, asked between iterations, and by the clock at all. */
enum { SECONDS_MOST = 60, CLOCK_MOST = 600 };
/* Iterations of the linear equations that end a surface with friction, whose folds may take long: 6
 * s of one of 12 x 12 nodes. */
enum { LINEAR_MOST = 15000 };

struct random_full {
    uint64_t seed;
    struct grid grid;
    struct block block;
    struct full_options options;
    struct friction_options friction; /* coefficient 0: none */
    double slope;                     /* RMS */
    double hurst, noise;
    size_t load_count, leg_count, leg_steps;
    double loads[LOADS_MOST]; /* mean pressures, E* */
    double legs[LEGS_MOST];   /* displacements where the flat turns, over that of full slip */
    bool traction;            /* legs are tractions, over friction times pressure */
    double *z;
    double started; /* CPU seconds */
};

/* What came of scenes. */
struct count {
    size_t loads, loads_failed, steps, steps_failed, unmeshed;
    double slowest;
    uint64_t slowest_seed;
};

static double cpu_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int is_late(void *context) {
    const struct random_full *of = context;
    return cpu_seconds() - of->started > SECONDS_MOST;
}

/* --- drawing --- */

static double uniform(void *state) {
    return (double)(next_word(state) >> 11) * 0x1p-53;
}

static double between(uint64_t *state, double low, double high) {
    return low + (high - low) * uniform(state);
}

static bool happens(uint64_t *state, double share) {
    return uniform(state) < share;
}

static size_t below(uint64_t *state, size_t n) {
    return (size_t)(uniform(state) * (double)n);
}

static void draw_block(uint64_t *state, struct random_full *of) {
    const bool profile = grid_is_profile(&of->grid);
    static const double POISSON[] = {0, 0.3, 0.45, 0.4999};
    of->block = (struct block){.model = MODEL_LAYERED,
                               .poisson = happens(state, 0.5) ? POISSON[below(state, 4)]
                                                              : between(state, 0, 0.4999),
                               .height = of->grid.lx * exp(between(state, log(0.3), log(3))),
                               .layer_growth = between(state, 1.05, 1.4),
                               .weighting = happens(state, 0.5) ? GAP_DUAL : GAP_STANDARD};
    of->options = FULL_DEFAULTS;
    of->options.kinematics = (enum kinematics)below(state, 4);
    of->options.transition = happens(state, 0.2) ? INFINITY : between(state, 1, 10);
    of->options.tolerance = happens(state, 0.5) ? 1e-9 : 1e-5;
    bool factored = happens(state, 0.1) && profile && of->block.poisson <= 0.45;
    of->options.solver = factored ? SOLVER_FACTORED : SOLVER_ITERATED;
    of->options.current_areas = happens(state, 0.2);
    of->options.normal_gaps = happens(state, 0.2);
}

static void draw_path(uint64_t *state, struct random_full *of) {
    of->friction.coefficient = happens(state, 0.4) ? 0 : between(state, 0.01, 1);
    of->friction.press_steps = happens(state, 0.3) ? 1 + below(state, 5) : 0;
    if (!grid_is_profile(&of->grid))
        of->friction.limit = (struct full_limit){.seconds = LINEAR_MOST, .linear = 1};
    of->traction = happens(state, 0.2);
    of->leg_count = 1 + below(state, LEGS_MOST);
    of->leg_steps = 2 + below(state, 6);
    for (size_t leg = 0; leg < of->leg_count; leg++)
        of->legs[leg] = of->traction ? between(state, -0.99, 0.99) : between(state, -1.5, 1.5);
    of->load_count = 1 + below(state, LOADS_MOST);
    double unit = of->slope > 0 ? of->slope : 0.1;
    bool rises = happens(state, 0.8);
    for (size_t k = 0; k < of->load_count; k++) {
        of->loads[k] = unit * exp(between(state, log(0.001), log(0.9)));
        for (size_t l = k; rises && l > 0 && of->loads[l] < of->loads[l - 1]; l--) {
            double swap = of->loads[l];
            of->loads[l] = of->loads[l - 1];
            of->loads[l - 1] = swap;
        }
    }
}

static void draw_heights(uint64_t *state, struct random_full *of) {
    size_t points = grid_points(&of->grid);
    double highest = 0;
    of->z = array_create(points, sizeof *of->z);
    assert_non_null(of->z);
    double slope = fill_waves(&of->grid, of->hurst, of->noise, uniform, state, of->z);
    for (size_t i = 0; i < points; i++) {
        of->z[i] *= slope > 0 ? of->slope / slope : 0;
        highest = fmax(highest, fabs(of->z[i]));
    }
    /* mostly such that valleys do not reach through the block */
    if (happens(state, 0.95))
        of->block.height = fmax(of->block.height, 4 * highest);
}

static void draw(uint64_t seed, struct random_full *of) {
    uint64_t state = seed;
    *of = (struct random_full){.seed = seed};
    /* mostly small, which fold and fail as large ones do */
    bool profile = happens(&state, 0.85);
    double large = pow(uniform(&state), 2);
    size_t nx = profile ? 16 + (size_t)(49 * large) : 8 + (size_t)(9 * large);
    size_t ny = profile ? 1 : happens(&state, 0.7) ? nx : 8 + below(&state, 4);
    of->grid = (struct grid){nx, ny, (double)nx, (double)ny};
    of->slope = happens(&state, 0.05) ? 0 : between(&state, 0, 1);
    of->hurst = between(&state, 0.2, 1);
    of->noise = happens(&state, 0.7) ? 0 : exp(between(&state, log(1e-3), log(0.3)));
    draw_block(&state, of);
    draw_path(&state, of);
    draw_heights(&state, of);
}

/* --- judging --- */

static void check(const struct random_full *of, bool holds, const char *what) {
    if (!holds)
        fail_msg("scene of seed %" PRIu64 ": %s", of->seed, what);
}

static double largest_of(size_t n, const double *values) {
    double most = 0;
    for (size_t i = 0; i < n; i++)
        most = fmax(most, fabs(values[i]));
    return most;
}

static bool all_finite(size_t n, const double *values) {
    bool finite = true;
    for (size_t i = 0; i < n; i++)
        finite = finite && isfinite(values[i]);
    return finite;
}

/* An error that is no fault: no equilibrium, with what was asked and reached. */
static void check_note(const struct random_full *of, int status, const struct error *err) {
    if (status == ERROR_STOPPED)
        fail_msg("scene of seed %" PRIu64 " took more than %d s: %s", of->seed, SECONDS_MOST,
                 err->text);
    if (status != ERROR_NUMERIC)
        fail_msg("scene of seed %" PRIu64 ": error %d: %s", of->seed, status, err->text);
    check(of, strstr(err->text, "mean pressure of") != NULL, "a note without the load");
    check(of, strstr(err->text, "reached up to") != NULL || strstr(err->text, "followed") != NULL,
          "a note without what was reached");
}

/* Pressures of the mean asked, none below 0 nor where the gap is open. reach: of forces. */
static void check_pressures(const struct random_full *of, const double *p, const double *gap,
                            double pressure, size_t nodes, double reach) {
    size_t n = grid_points(&of->grid), touching = 0;
    double sum = 0;
    check(of, all_finite(n, p) && all_finite(n, gap), "pressures or gaps are not finite");
    for (size_t i = 0; i < n; i++) {
        check(of, p[i] >= 0, "a pressure below 0");
        touching += p[i] > 0;
        sum += p[i];
        if (of->block.weighting == GAP_DUAL)
            check(of, p[i] > 0 ? fabs(gap[i]) <= reach : gap[i] >= -reach,
                  "a gap under pressure, or the face in the flat");
    }
    check(of, touching == nodes && nodes > 0, "the nodes in contact are others");
    check_close(sum / (double)n, pressure, reach);
}

static void check_pressed(const struct random_full *of, struct full *full,
                          const struct contact_state *state, const struct full_report *report) {
    const struct mesh *mesh = full_mesh(full);
    size_t n = grid_points(&of->grid);
    double reach = 100 * of->options.tolerance * largest_of(n, state->p) + 1e-12 * (double)n;
    check_pressures(of, state->p, state->gap, state->pressure, state->nodes, reach);
    check(of, isfinite(state->mean_gap), "a mean gap that is not finite");
    check(of, state->stiffness >= 0 && isinf(state->stiffness) == (state->nodes == n),
          "a stiffness below 0, or infinite out of full contact");
    check(of, all_finite(mesh_degrees_of_freedom(mesh), full_displacement(full)),
          "displacements that are not finite");
    check(of, !face_folds(mesh, full_displacement(full)), "a face that folds");
    check(of, report->stretch > 0 && report->open_stretch > 0, "cells without area");
    check(of, fabs(report->balance) <= reach / state->pressure, "forces do not balance");
    check(of, report->residual <= of->options.tolerance * 1.0001 || state->pressure < 1e-6,
          "forces that are left");
}

/* Tractions within friction. */
static void check_tractions(const struct random_full *of, const struct friction_state *state,
                            double reach) {
    size_t n = grid_points(&of->grid);
    double sum = 0, across = 0;
    check(of, all_finite(n, state->q), "tractions are not finite");
    for (size_t i = 0; i < n; i++) {
        double y = state->q_across != NULL ? state->q_across[i] : 0;
        check(of,
              hypot(state->q[i], y) <=
                  of->friction.coefficient * state->p[i] * (1 + 1e-6) + 4 * reach,
              "a traction beyond friction");
        check(of, state->p[i] > 0 ? isfinite(state->slip[i]) : isnan(state->slip[i]),
              "slip out of contact, or none in it");
        sum += state->q[i];
        across += y;
    }
    check_close(sum / (double)n, state->traction, reach);
    check_close(across / (double)n, 0, reach);
}

static void check_slid(const struct random_full *of, const struct friction_state *state,
                       double pressure, double *dissipation, double *displacement) {
    size_t n = grid_points(&of->grid);
    double reach = 100 * of->options.tolerance * largest_of(n, state->p) + 1e-12 * (double)n;
    check_pressures(of, state->p, state->gap, pressure, state->nodes, reach);
    check_tractions(of, state, reach);
    check(of, state->stuck <= state->nodes && state->nodes <= n, "more sticks than touches");
    check(of, state->stick_load >= 0 && state->stick_load <= 1 + 1e-12, "shares beyond 0 to 1");
    check(of,
          isfinite(state->mean_gap) && isfinite(state->sliding) && isfinite(state->work) &&
              isfinite(state->energy) && isfinite(state->pressing_work),
          "works or displacements that are not finite");
    check(of, fabs(state->traction) <= of->friction.coefficient * pressure * (1 + 1e-6) + 4 * reach,
          "more traction than friction");
    /* By trapezoids a step in which nodes turn back may take less than nothing: that much is let
     * pass, of what friction takes over the step. */
    double step = fabs(state->displacement - *displacement);
    double fall = reach * (fabs(state->displacement) + 1) + 0.01 * *dissipation +
                  0.05 * of->friction.coefficient * pressure * step;
    if (!(state->dissipation >= *dissipation - fall))
        fail_msg("scene of seed %" PRIu64 ": dissipation falls from %g to %g (work %g)", of->seed,
                 *dissipation, state->dissipation, state->work);
    *dissipation = state->dissipation;
    *displacement = state->displacement;
}

/* --- pressing and dragging --- */

static const char *profile_or_surface(const struct random_full *of) {
    return grid_is_profile(&of->grid) ? "profile" : "surface";
}

/* Presses to all loads. After one that fails the state before it is still there. */
static void press(const struct random_full *of, struct full *full, struct count *count,
                  bool prints) {
    struct contact_state state;
    struct full_report report;
    for (size_t k = 0; k < of->load_count; k++) {
        struct error err = {0};
        int status = full_press(full, of->loads[k], &state, &report, &err);
        count->loads++;
        if (status == 0) {
            check_pressed(of, full, &state, &report);
            continue;
        }
        check_note(of, status, &err);
        count->loads_failed++;
        if (prints)
            printf("  load %g: %s\n", of->loads[k], err.text);
        double reached = report.reached;
        check(of, reached >= 0 && isfinite(reached), "no load was reached");
        status = reached > 0 ? full_press(full, reached, &state, &report, &err) : 0;
        if (status != 0 && strstr(err.text, "unstable") == NULL)
            fail_msg("scene of seed %" PRIu64 ": the load that was reached fails: %s", of->seed,
                     err.text);
        if (reached > 0 && status == 0)
            check_pressed(of, full, &state, &report);
        return;
    }
}

/* Drags the flat along a leg, in even steps. Returns false where a step has no solution. */
static bool drag_leg(const struct random_full *of, struct friction *friction, double from,
                     double to, double pressure, double *dissipation, double *displacement,
                     struct count *count, bool prints) {
    struct friction_state state;
    for (size_t step = 1; step <= of->leg_steps; step++) {
        struct error err = {0};
        double at = from + (to - from) * (double)step / (double)of->leg_steps;
        int status = of->traction ? friction_load(friction, at, &state, &err)
                                  : friction_drag(friction, at, &state, &err);
        count->steps++;
        if (status != 0) {
            check_note(of, status, &err);
            count->steps_failed++;
            if (prints)
                printf("  step to %g: %s\n", at, err.text);
            return false;
        }
        check_slid(of, &state, pressure, dissipation, displacement);
    }
    return true;
}

static void slide(const struct random_full *of, struct count *count, bool prints) {
    struct friction *friction;
    struct friction_state state;
    struct error err = {0};
    double pressure = of->loads[of->load_count - 1], dissipation = 0, displacement = 0, from = 0;
    double unit = of->friction.coefficient * pressure;
    unit *= of->traction ? 1 : of->block.height * 2 / (1 - of->block.poisson) + of->grid.lx / 4;
    if (friction_create(&friction, &of->grid, &of->block, &of->options, &of->friction, &err) != 0 ||
        friction_begin(friction, of->z, &err) != 0)
        fail_msg("scene of seed %" PRIu64 ": %s", of->seed, err.text);
    friction_set_stop(friction, is_late, (void *)of);
    int status = friction_press(friction, pressure, &state, &err);
    count->steps++;
    if (status == 0)
        check_slid(of, &state, pressure, &dissipation, &displacement);
    else {
        check_note(of, status, &err);
        count->steps_failed++;
        if (prints)
            printf("  pressed with friction: %s\n", err.text);
    }
    for (size_t leg = 0; status == 0 && leg < of->leg_count; leg++) {
        double to = unit * of->legs[leg];
        if (!drag_leg(of, friction, from, to, pressure, &dissipation, &displacement, count, prints))
            break;
        from = to;
    }
    friction_destroy(&friction);
}

static void run(struct random_full *of, struct count *count, bool prints) {
    struct full *full = NULL;
    struct error err = {0};
    of->started = cpu_seconds();
    if (full_create(&full, &of->grid, &of->block, &of->options, &err) != 0)
        fail_msg("scene of seed %" PRIu64 ": %s", of->seed, err.text);
    full_set_stop(full, is_late, of);
    int status = full_begin(full, of->z, &err);
    if (status == 0) {
        press(of, full, count, prints);
        if (of->friction.coefficient > 0)
            slide(of, count, prints);
    } else {
        check(of, status == ERROR_INPUT && strlen(err.text) > 0, "a face is refused for nothing");
        count->unmeshed++;
    }
    full_destroy(&full);
    double seconds = cpu_seconds() - of->started;
    if (prints)
        printf("seed %" PRIu64 ", %s %zu x %zu, slope %.3f, nu %.4f, law %d, height %.3g, mu %.3f, "
               "transition %.3g, loads %zu to %.3g: %.2f s%s%s\n",
               of->seed, profile_or_surface(of), of->grid.nx, of->grid.ny, of->slope,
               of->block.poisson, of->options.kinematics, of->block.height,
               of->friction.coefficient, of->options.transition, of->load_count,
               of->loads[of->load_count - 1], seconds, status != 0 ? ": " : "",
               status != 0 ? err.text : "");
    if (seconds > count->slowest) {
        count->slowest = seconds;
        count->slowest_seed = of->seed;
    }
}

static void scenes_end_with_a_state_or_a_reason(void **state) {
    (void)state;
    const char *asked = getenv("RUGO_SCENES");
    uint64_t seeds = seed_or(33),
             scenes = asked != NULL ? strtoull(asked, NULL, 10) : SCENES * effort();
    struct count count = {0};
    bool prints = getenv("RUGO_TABLE") != NULL;
    for (uint64_t scene = 0; scene < scenes; scene++) {
        struct random_full of;
        draw(scenes == 1 ? seeds : next_word(&seeds), &of);
        alarm(CLOCK_MOST); /* ends the program */
        run(&of, &count, prints);
        free(of.z);
    }
    alarm(0);
    printf("%" PRIu64 " scenes, %zu faces refused; %zu loads, %zu without equilibrium; %zu steps, "
           "%zu without; the slowest took %.1f s (seed %" PRIu64 ")\n",
           scenes, count.unmeshed, count.loads, count.loads_failed, count.steps, count.steps_failed,
           count.slowest, count.slowest_seed);
    if (scenes >= SCENES) {
        assert_true(count.loads > scenes && count.steps > scenes);
        assert_true(count.loads_failed * 4 < count.loads);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(scenes_end_with_a_state_or_a_reason)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
