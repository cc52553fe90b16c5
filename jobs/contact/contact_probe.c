#include "jobs/contact/contact_probe.h"
#include "jobs/contact/contact_sample.h"
#include "jobs/contact/model_linear.h"
#include <math.h>
#include <stdlib.h>

enum { PROBE_POINTS = 4, ALWAYS = 16, INTERVAL = 4 };
enum { FIRST = 32, FIRST_INTERVAL = 8 };
static const uint64_t INTERVAL_MOST = 1 << 20;
/* The half-space, and a layer a model. */
enum { BLOCKS_MOST = CONTACT_MODELS_MOST + 1 };

struct contact_probe {
    const struct contact_case *one_case;
    struct contact_coarse *blocks[BLOCKS_MOST]; /* owned; NULL where same[] is another one, or the
                                                   twin of the half-space stands for it */
    size_t same[BLOCKS_MOST];                   /* the first block of that height */
    double *z;
};

struct contact_level contact_probe_level(const struct contact_case *one_case) {
    struct contact_level level = one_case->levels[0];
    bool even = level.grid.nx % 2 == 0 && (grid_is_profile(&level.grid) || level.grid.ny % 2 == 0);
    if (level.stride == 0 || !even || level.points < 2 * PROBE_POINTS)
        return level;
    level.points /= 2;
    level.stride *= 2;
    level.grid.nx /= 2;
    if (!grid_is_profile(&level.grid))
        level.grid.ny /= 2;
    return level;
}

uint64_t contact_probe_interval(double seconds, double allowed, uint64_t least) {
    uint64_t interval = least;
    while (interval < INTERVAL_MOST && !(seconds <= (double)interval * allowed))
        interval *= 2;
    return interval;
}

bool contact_probe_turn(uint64_t interval, uint64_t realisation) {
    if (realisation < FIRST && interval > FIRST_INTERVAL)
        interval = FIRST_INTERVAL;
    return realisation % interval == 0;
}

bool contact_probe_due(const struct contact_case *one_case, uint64_t realisation) {
    if (one_case->low_blocks)
        return realisation < ALWAYS || realisation % INTERVAL == 0;
    return contact_case_is_probed(one_case) &&
           contact_probe_turn(one_case->probe_interval, realisation);
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

size_t contact_probe_twin(const struct contact_case *one_case) {
    size_t m = 0;
    while (m < one_case->model_count &&
           (one_case->models[m]->press != linear_press ||
            one_case->blocks[m].model != MODEL_HALFSPACE || isfinite(one_case->blocks[m].height)))
        m++;
    return one_case->probe.grid.nx == one_case->levels[0].grid.nx ? m : one_case->model_count;
}

static bool has_twin(const struct contact_case *one_case) {
    return contact_probe_twin(one_case) < one_case->model_count;
}

static int probe_fill(struct contact_probe *probe, const struct moments *moments,
                      struct error *err) {
    const struct contact_case *one_case = probe->one_case;
    size_t points = grid_points(&one_case->probe.grid);
    int status = 0;
    for (size_t b = 0; b < contact_case_probe_blocks(one_case) && status == 0; b++) {
        probe->same[b] = first_of_height(one_case, b);
        if (probe->same[b] == b && (b > 0 || !has_twin(one_case)))
            status = contact_coarse_create(&probe->blocks[b], one_case, &one_case->probe.grid,
                                           height_of(one_case, b), moments, err);
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
        return error_memory(err, sizeof *probe, "a probe");
    probe->one_case = one_case;
    int status = probe_fill(probe, moments, err);
    if (status != 0)
        contact_probe_destroy(&probe);
    *out = probe;
    return status;
}

void contact_probe_destroy(struct contact_probe **probe) {
    struct contact_probe *gone = *probe;
    if (gone == NULL)
        return;
    for (size_t b = 0; b < BLOCKS_MOST; b++)
        contact_coarse_destroy(&gone->blocks[b]);
    free(gone->z);
    free(gone);
    *probe = NULL;
}

/* The twin tells areas undeformed and as they are under load, the probe only undeformed. */
static void copy_twin(const struct contact_case *one_case, struct contact_tally *tally) {
    size_t to = contact_case_probe_cell(one_case, 0, 0);
    contact_coarse_copy(one_case, contact_case_cell(one_case, contact_probe_twin(one_case), 0, 0),
                        to, tally);
    for (size_t k = 0; k < one_case->load_count; k++)
        contact_tally_values(tally, MEASURE_EDGES_STRETCHED)[to + k] =
            contact_tally_values(tally, MEASURE_EDGES)[to + k];
}

int contact_probe_solve(struct contact_probe *probe, const double *z, struct contact_tally *tally,
                        const struct contact_stopper *stopper, struct error *err) {
    const struct contact_case *one_case = probe->one_case;
    int status = contact_level_sample(one_case, &one_case->probe, z, probe->z, err);
    for (size_t b = 0; b < contact_case_probe_blocks(one_case) && status == 0; b++) {
        size_t cell = contact_case_probe_cell(one_case, b, 0);
        if (probe->blocks[b] != NULL)
            status = contact_coarse_solve(probe->blocks[b], probe->z, cell, tally, stopper, err);
        else if (b == 0)
            copy_twin(one_case, tally);
        else
            contact_coarse_copy(one_case, contact_case_probe_cell(one_case, probe->same[b], 0),
                                cell, tally);
    }
    return status;
}

/* Counts the blocks that are solved. */
static size_t solved_blocks(const struct contact_case *one_case) {
    size_t count = 0;
    for (size_t b = 0; b < contact_case_probe_blocks(one_case); b++)
        count += first_of_height(one_case, b) == b && (b > 0 || !has_twin(one_case));
    return count;
}

double contact_probe_bytes(const struct contact_case *one_case) {
    const struct grid *grid = &one_case->probe.grid;
    return contact_case_is_probed(one_case)
               ? 8 * (double)grid_points(grid) +
                     (double)solved_blocks(one_case) * contact_coarse_bytes(grid)
               : 0;
}

double contact_probe_seconds(const struct contact_case *one_case) {
    if (!contact_case_is_probed(one_case))
        return 0;
    double interval = one_case->low_blocks ? INTERVAL : (double)one_case->probe_interval;
    return (double)solved_blocks(one_case) / interval *
           contact_coarse_seconds(one_case, &one_case->probe.grid);
}
