#include "jobs/contact/contact_probe.h"
#include "core/contact/contact.h"
#include "core/cost.h"
#include "jobs/contact/contact_measure.h"
#include "jobs/contact/contact_sample.h"
#include <math.h>
#include <stdlib.h>

enum { ALWAYS = 16, INTERVAL = 4 };
/* The half-space, and a layer a model. */
enum { BLOCKS_MOST = CONTACT_MODELS_MOST + 1 };

struct contact_probe {
    const struct contact_case *one_case;
    double rms_slope, rms_height;
    struct compliance *compliances[BLOCKS_MOST]; /* NULL where same[] is another one */
    struct contact *solvers[BLOCKS_MOST];
    struct area_workspace *areas[BLOCKS_MOST];
    size_t same[BLOCKS_MOST]; /* the first block of that height */
    struct patch_finder *finder;
    double *z;
};

bool contact_probe_due(const struct contact_case *one_case, uint64_t realisation) {
    return contact_case_is_probed(one_case) &&
           (realisation < ALWAYS || realisation % INTERVAL == 0);
}

/* Number 0 is the half-space, the others are those of the models. */
static double height_of(const struct contact_case *one_case, size_t number) {
    return number == 0 ? INFINITY : one_case->blocks[number - 1].height;
}

static size_t first_of_height(const struct contact_case *one_case, size_t number) {
    size_t first = 0;
    while (height_of(one_case, first) != height_of(one_case, number))
        first++;
    return first;
}

static int block_make(struct contact_probe *probe, size_t number, struct error *err) {
    const struct contact_case *one_case = probe->one_case;
    struct block block = {
        .model = MODEL_HALFSPACE, .height = height_of(one_case, number), .layer_growth = 1};
    struct contact_options options = CONTACT_DEFAULTS;
    options.tolerance = one_case->tolerance;
    int status = compliance_create(&probe->compliances[number], &one_case->probe.grid, &block, err);
    if (status == 0)
        status = contact_create(&probe->solvers[number], probe->compliances[number], &options, err);
    if (status == 0)
        status = area_workspace_create(&probe->areas[number], probe->compliances[number], err);
    return status;
}

static int probe_fill(struct contact_probe *probe, struct error *err) {
    const struct contact_case *one_case = probe->one_case;
    size_t points = grid_points(&one_case->probe.grid);
    int status = patch_finder_create(&probe->finder, &one_case->probe.grid, err);
    for (size_t b = 0; b <= one_case->model_count && status == 0; b++) {
        probe->same[b] = first_of_height(one_case, b);
        if (probe->same[b] == b)
            status = block_make(probe, b, err);
    }
    if (status != 0)
        return status;
    probe->z = array_create(points, sizeof *probe->z);
    return probe->z != NULL ? 0 : error_memory(err, points * sizeof *probe->z, "a surface");
}

int contact_probe_create(struct contact_probe **out, const struct contact_case *one_case,
                         const struct moments *moments, struct error *err) {
    *out = NULL;
    if (!contact_case_is_probed(one_case))
        return 0;
    struct contact_probe *probe = array_create(1, sizeof *probe);
    if (probe == NULL)
        return error_memory(err, sizeof *probe, "a probe of block heights");
    probe->one_case = one_case;
    probe->rms_slope = moments->rms_slope;
    probe->rms_height = moments->rms_height;
    int status = probe_fill(probe, err);
    if (status != 0)
        contact_probe_destroy(&probe);
    *out = probe;
    return status;
}

void contact_probe_destroy(struct contact_probe **probe) {
    struct contact_probe *gone = *probe;
    if (gone == NULL)
        return;
    for (size_t b = 0; b < BLOCKS_MOST; b++) {
        area_workspace_destroy(&gone->areas[b]);
        contact_destroy(&gone->solvers[b]);
        compliance_destroy(&gone->compliances[b]);
    }
    patch_finder_destroy(&gone->finder);
    free(gone->z);
    free(gone);
    *probe = NULL;
}

/* All loads of one block, from a surface lifted off. */
static int solve_block(struct contact_probe *probe, size_t number, struct contact_tally *tally,
                       int (*stop)(void *context), void *context, struct error *err) {
    const struct contact_case *one_case = probe->one_case;
    const struct contact_meter meter = {.area = probe->areas[number],
                                        .finder = probe->finder,
                                        .points = (double)grid_points(&one_case->probe.grid),
                                        .rms_slope = probe->rms_slope,
                                        .rms_height = probe->rms_height,
                                        .scaled = true};
    int status = contact_begin(probe->solvers[number], probe->z, err);
    for (size_t k = 0; k < one_case->load_count && status == 0; k++) {
        struct contact_pressed pressed = {.stretch = 1, .open_stretch = 1};
        double values[MEASURE_OWN];
        if (stop(context) != 0)
            return error_set(err, ERROR_STOPPED, "stopped at load %zu of %zu", k,
                             one_case->load_count);
        status = contact_press(probe->solvers[number], one_case->loads[k] * probe->rms_slope,
                               &pressed.state, err);
        if (status != 0)
            return error_context(err, "half-space for the block's height, load %g",
                                 one_case->loads[k]);
        contact_measure(&meter, &pressed, values);
        for (size_t a = 0; a < MEASURE_PAIRED; a++)
            contact_tally_values(
                tally, (enum contact_measure)a)[contact_case_probe_cell(one_case, number, k)] =
                values[a];
    }
    return status;
}

/* What a block has in common with one of the same height. */
static void copy_block(struct contact_probe *probe, size_t number, struct contact_tally *tally) {
    const struct contact_case *one_case = probe->one_case;
    for (size_t a = 0; a < MEASURE_PAIRED; a++) {
        double *values = contact_tally_values(tally, (enum contact_measure)a);
        for (size_t k = 0; k < one_case->load_count; k++)
            values[contact_case_probe_cell(one_case, number, k)] =
                values[contact_case_probe_cell(one_case, probe->same[number], k)];
    }
}

int contact_probe_solve(struct contact_probe *probe, const double *z, struct contact_tally *tally,
                        int (*stop)(void *context), void *context, struct error *err) {
    const struct contact_case *one_case = probe->one_case;
    int status = contact_level_sample(one_case, &one_case->probe, z, probe->z, err);
    for (size_t b = 0; b <= one_case->model_count && status == 0; b++)
        if (probe->same[b] == b)
            status = solve_block(probe, b, tally, stop, context, err);
        else
            copy_block(probe, b, tally);
    return status;
}

static size_t distinct_heights(const struct contact_case *one_case) {
    size_t count = 0;
    for (size_t b = 0; b <= one_case->model_count; b++)
        count += first_of_height(one_case, b) == b;
    return count;
}

double contact_probe_bytes(const struct contact_case *one_case) {
    const struct grid *grid = &one_case->probe.grid;
    const struct block block = {.model = MODEL_HALFSPACE, .height = INFINITY};
    double points = (double)grid_points(grid);
    return contact_case_is_probed(one_case) ? 40 * points + (double)distinct_heights(one_case) *
                                                                (8 * points + contact_bytes(grid) +
                                                                 compliance_bytes(grid, &block))
                                            : 0;
}

double contact_probe_seconds(const struct contact_case *one_case) {
    return contact_case_is_probed(one_case)
               ? (double)distinct_heights(one_case) / INTERVAL *
                     cost_linear_contact(&one_case->probe.grid, one_case->tolerance,
                                         one_case->load_count)
               : 0;
}
