/* The probe: the cheap model on a coarse mesh. Where blocks of the case are low, each surface is
 * pressed on a half-space and on exact layers of their heights. These pairs have the same surface,
 * and differ by the height alone, of which they estimate the error. All realisations have them, as
 * a few with patches far from each other may make most of the error. */
#include "jobs/contact/companion/block_error.h"
#include "jobs/contact/companion/companion.h"
#include <stdlib.h>
#include <string.h>

static const struct subset EACH = {0, 1, 1};
/* The half-space, and a layer for each model. */
enum { BLOCKS_MOST = CONTACT_MODELS_MOST + 1 };

struct probe {
    const struct companion_plan *plan;
    struct coarse_solver *blocks[BLOCKS_MOST]; /* owned; NULL where same[] is another one */
    size_t same[BLOCKS_MOST];                  /* the first block of that height */
    double rms_height;                         /* of the surfaces */
    double *z;
};

/* Returns the height of a block: number 0 is the half-space, the others are those of the models. */
static double height_of(const struct contact_case *one_case, size_t number) {
    return number == 0 ? INFINITY : one_case->blocks[number - 1].height;
}

static size_t first_of_height(const struct contact_case *one_case, size_t number) {
    size_t first = 0;
    while (height_of(one_case, first) != height_of(one_case, number))
        first++;
    return first;
}

/* Returns whether a block is solved: none before it is as high. */
static bool is_solved(const struct contact_case *one_case, size_t number) {
    return first_of_height(one_case, number) == number;
}

static size_t solved_blocks(const struct contact_case *one_case,
                            const struct companion_plan *plan) {
    size_t count = 0;
    for (size_t b = 0; b < plan->series; b++)
        count += is_solved(one_case, b);
    return count;
}

/* --- the plan --- */

static double probe_bytes(const struct contact_case *one_case, const struct companion_plan *plan) {
    const struct grid *grid = &plan->level.grid;
    return 8 * (double)grid_points(grid) +
           (double)solved_blocks(one_case, plan) * coarse_solver_bytes(one_case, grid);
}

static double probe_seconds(const struct contact_case *one_case,
                            const struct companion_plan *plan) {
    return (double)solved_blocks(one_case, plan) *
           coarse_solver_seconds(one_case, &plan->level.grid);
}

static bool probe_plan(const struct contact_case *one_case, struct companion_plan *out) {
    bool low = false;
    for (size_t m = 0; m < one_case->model_count; m++)
        low = low || block_is_low(contact_case_block_bound(one_case, m));
    if (!low)
        return false;
    out->level = coarse_level(one_case);
    out->series = one_case->model_count + 1;
    out->due = EACH;
    for (size_t b = 1; b < out->series; b++)
        out->pairs[out->pair_count++] = (struct companion_pair){.of = b};
    return true;
}

/* --- one surface --- */

static int probe_create(void *workspace, const struct contact_case *one_case,
                        const struct companion_plan *plan, const struct moments *moments,
                        struct error *err) {
    struct probe *probe = workspace;
    size_t points = grid_points(&plan->level.grid);
    int status = 0;
    probe->plan = plan;
    probe->rms_height = moments->rms_height;
    for (size_t b = 0; b < plan->series && status == 0; b++) {
        probe->same[b] = first_of_height(one_case, b);
        if (is_solved(one_case, b))
            status = coarse_solver_create(&probe->blocks[b], one_case, &plan->level.grid,
                                          height_of(one_case, b), moments, err);
    }
    if (status != 0)
        return status;
    probe->z = array_create(points, sizeof *probe->z);
    return probe->z != NULL ? 0 : error_memory(err, points * sizeof *probe->z, "a surface");
}

static void probe_clear(void *workspace) {
    struct probe *probe = workspace;
    for (size_t b = 0; b < BLOCKS_MOST; b++)
        coarse_solver_destroy(&probe->blocks[b]);
    free(probe->z);
}

static int probe_solve(void *workspace, const struct contact_surface *surface,
                       struct contact_tally *tally, struct companion_tally *out,
                       const struct contact_stopper *stopper, struct error *err) {
    const struct probe *probe = workspace;
    const struct contact_case *one_case = tally->one_case;
    const struct level_source source = {probe->rms_height, surface->key};
    int status = contact_level_sample(&probe->plan->level, &one_case->surface, &source, surface->z,
                                      probe->z, err);
    for (size_t b = 0; b < probe->plan->series && status == 0; b++) {
        double *series = companion_series(one_case, out, b);
        if (probe->blocks[b] != NULL)
            status = coarse_solver_press(probe->blocks[b], probe->z, series, stopper, err);
        else
            memcpy(series, companion_series(one_case, out, probe->same[b]),
                   measure_paired(one_case) * contact_case_slots(one_case) * sizeof *series);
    }
    return status;
}

/* --- the error --- */

static bool probe_applies(const struct contact_case *one_case, size_t model) {
    return isfinite(one_case->blocks[model].height);
}

static bool probe_errors(const struct contact_tally *tally, enum contact_measure measure,
                         size_t model, struct contact_error *out) {
    const struct contact_case *one_case = tally->one_case;
    double bound = contact_case_block_bound(one_case, model);
    for (size_t k = 0; k < contact_case_values(one_case, measure_row(measure)->by); k++) {
        double y = contact_mean(tally, measure, model, one_case->level_count - 1, k).value;
        if (!block_is_low(bound)) {
            out[k] = block_error_high(y, bound);
            continue;
        }
        struct estimate change = contact_tally_pair(tally, COMPANION_PROBE, model, measure, k);
        double block = contact_tally_companion(tally, COMPANION_PROBE, model + 1, measure, k).value;
        out[k] = block_error_low(y, block, change);
    }
    return true;
}

COMPANION_DEFINE(PROBE, "a probe", NULL, ERROR_BLOCK, probe_plan, struct probe, probe_create,
                 probe_clear, probe_bytes, probe_seconds, probe_solve, probe_applies, probe_errors,
                 NULL)
