#include "jobs/contact/contact_cell.h"
#include "core/cost.h"
#include "jobs/contact/contact_probe.h"
#include "jobs/contact/contact_sample.h"
#include <stdlib.h>

/* Sequences of cases have none of these bits. */
static const uint64_t OWN_SEQUENCE[CONTACT_LENGTHS] = {
    [LENGTH_LONGER] = UINT64_C(1) << 63, [LENGTH_SHORTER] = UINT64_C(1) << 62};
/* Of the time that the case takes without: what goes into these surfaces, and into the probe on the
 * case's own ones. */
static const double TIME_SHARE[CONTACT_LENGTHS] = {[LENGTH_LONGER] = 0.06, [LENGTH_SHORTER] = 0.06};
static const double PROBE_SHARE = 0.02;
/* These surfaces may take as much memory as the case's own on a half-space on its finest mesh, or
 * this where that is more. */
static const double BYTES_LEAST = 1e9;
static const double ROUNDING = 1e-9; /* relative: numbers that are meant to be integers */

/* Surfaces of one length; all owned. */
struct cell_bench {
    struct generator *generator; /* NULL: there are none */
    struct contact_coarse *halfspace;
    double *own, *z; /* heights as generated, and on the coarse mesh */
};
struct contact_cell {
    const struct contact_case *one_case;
    struct cell_bench benches[CONTACT_LENGTHS];
};

static bool has_any(const struct contact_case *one_case) {
    return contact_case_has_length(one_case, LENGTH_LONGER) ||
           contact_case_has_length(one_case, LENGTH_SHORTER);
}

/* --- the choice --- */

/* The grid of a cell `length` times as long, and wide, of the same distances; false where its
 * points are no integers, or too many. */
static bool scale_grid(const struct grid *grid, double length, struct grid *out) {
    bool profile = grid_is_profile(grid);
    double along_x = length * (double)grid->nx, along_y = profile ? 1 : length * (double)grid->ny;
    if (fmod(along_x, 1) != 0 || fmod(along_y, 1) != 0 || along_x * along_y > SURFACE_POINTS_MOST)
        return false;
    *out = (struct grid){(size_t)along_x, (size_t)along_y, length * grid->lx, length * grid->ly};
    return true;
}

/* Surfaces that are not Gaussian depend on the grid that they are generated on: it is as fine as
 * that of the case. Others are generated where they are needed, if that holds their waves. */
static bool choose_grids(const struct contact_case *one_case, struct contact_surfaces *out) {
    struct surface_case *surface = &out->surface;
    out->level = one_case->probe;
    *surface = one_case->surface;
    surface->length_ratio *= out->length;
    surface->length_ratio_y *= out->length;
    if (!scale_grid(&one_case->probe.grid, out->length, &out->level.grid) ||
        !scale_grid(&one_case->surface.grid, out->length, &surface->grid))
        return false;
    out->band = surface_case_own_band(surface);
    if (surface->options.heights.type == HEIGHTS_GAUSSIAN &&
        surface_band_fits(out->band, &out->level.grid)) {
        surface->grid = out->level.grid;
        out->level.stride = 1;
    }
    return out->level.stride > 0 || surface_band_fits(out->band, &out->level.grid);
}

static double surface_seconds(const struct contact_case *one_case, enum contact_length length) {
    const struct contact_surfaces *surfaces = &one_case->lengths[length];
    return 1e-9 * cost_generation(&surfaces->surface.options, NULL) *
               (double)grid_points(&surfaces->surface.grid) +
           contact_coarse_seconds(one_case, &surfaces->level.grid);
}

static double surface_bytes(const struct contact_surfaces *surfaces) {
    const struct grid *grid = &surfaces->level.grid;
    return surface_case_bytes(&surfaces->surface) + 8 * (double)grid_points(grid) +
           contact_coarse_bytes(grid);
}

static bool holds_waves(const struct contact_case *one_case, double length) {
    const double waves[] = {length * one_case->surface.length_ratio,
                            length * one_case->surface.length_ratio_y};
    for (size_t side = 0; side < 2; side++)
        if (!(waves[side] >= 1 && fabs(waves[side] - round(waves[side])) <= ROUNDING * waves[side]))
            return false;
    return true;
}

/* Returns a quarter or half, whichever first holds whole longest waves; 0 where neither does. */
static double shorter_length(const struct contact_case *one_case) {
    if (holds_waves(one_case, 0.25))
        return 0.25;
    return holds_waves(one_case, 0.5) ? 0.5 : 0;
}

static void choose_length(struct contact_case *one_case, enum contact_length length, double factor,
                          uint64_t least) {
    struct contact_surfaces surfaces = {.length = factor};
    double own = surface_case_bytes(&one_case->surface) +
                 contact_coarse_bytes(&contact_case_finest(one_case)->grid);
    if (factor == 0 || !choose_grids(one_case, &surfaces) ||
        surface_bytes(&surfaces) > fmax(BYTES_LEAST, own))
        return;
    one_case->lengths[length] = surfaces;
    one_case->lengths[length].interval =
        contact_probe_interval(surface_seconds(one_case, length),
                               TIME_SHARE[length] * contact_case_least_seconds(one_case), least);
}

void contact_cell_choose(struct contact_case *one_case) {
    bool probed = contact_case_is_probed(one_case);
    if (!probed)
        one_case->probe = contact_probe_level(one_case);
    choose_length(one_case, LENGTH_LONGER, 2, one_case->surface.dimension == 1 ? 2 : 4);
    choose_length(one_case, LENGTH_SHORTER, shorter_length(one_case), 1);
    if (!probed && !has_any(one_case)) {
        one_case->probe = (struct contact_level){0};
        return;
    }
    one_case->probe_interval = 1;
    one_case->probe_interval = contact_probe_interval(
        contact_probe_seconds(one_case), PROBE_SHARE * contact_case_least_seconds(one_case), 1);
}

bool contact_cell_due(const struct contact_case *one_case, enum contact_length length,
                      uint64_t realisation) {
    return contact_case_has_length(one_case, length) &&
           contact_probe_turn(one_case->lengths[length].interval, realisation);
}

/* --- one surface --- */

static int bench_fill(struct cell_bench *bench, const struct contact_case *one_case,
                      enum contact_length length, struct error *err) {
    const struct contact_surfaces *surfaces = &one_case->lengths[length];
    const struct surface_case *surface = &surfaces->surface;
    struct moments moments;
    size_t points = grid_points(&surface->grid), coarse = grid_points(&surfaces->level.grid);
    int status = generator_create(&bench->generator, &surface->spectrum, &surface->grid,
                                  &surface->options, err);
    if (status != 0)
        return status;
    modes_moments(generator_modes(bench->generator), &moments);
    status = contact_coarse_create(&bench->halfspace, one_case, &surfaces->level.grid, INFINITY,
                                   &moments, err);
    if (status != 0)
        return status;
    bench->own = array_create(points, sizeof *bench->own);
    bench->z = array_create(coarse, sizeof *bench->z);
    return bench->own != NULL && bench->z != NULL
               ? 0
               : error_memory(err, (points + coarse) * sizeof *bench->z,
                              "a surface of another length");
}

int contact_cell_create(struct contact_cell **out, const struct contact_case *one_case,
                        struct error *err) {
    *out = NULL;
    if (!has_any(one_case))
        return 0;
    struct contact_cell *cell = array_create(1, sizeof *cell);
    if (cell == NULL)
        return error_memory(err, sizeof *cell, "a probe of the cell's length");
    cell->one_case = one_case;
    int status = 0;
    for (enum contact_length l = 0; l < CONTACT_LENGTHS && status == 0; l++)
        if (contact_case_has_length(one_case, l))
            status = bench_fill(&cell->benches[l], one_case, l, err);
    if (status != 0)
        contact_cell_destroy(&cell);
    *out = cell;
    return status;
}

void contact_cell_destroy(struct contact_cell **cell) {
    struct contact_cell *gone = *cell;
    if (gone == NULL)
        return;
    for (size_t l = 0; l < CONTACT_LENGTHS; l++) {
        generator_destroy(&gone->benches[l].generator);
        contact_coarse_destroy(&gone->benches[l].halfspace);
        free(gone->benches[l].own);
        free(gone->benches[l].z);
    }
    free(gone);
    *cell = NULL;
}

/* Measures that grow with the cell are told of one as long as the case's. The largest patch of a
 * cell has no limit in long ones. */
static void scale_patches(const struct contact_case *one_case, enum contact_length length,
                          struct contact_tally *tally) {
    double cells = pow(one_case->lengths[length].length, one_case->surface.dimension);
    for (size_t k = 0; k < one_case->load_count; k++) {
        size_t cell = contact_case_length_cell(one_case, length, k);
        contact_tally_values(tally, MEASURE_PATCHES)[cell] /= cells;
        contact_tally_values(tally, MEASURE_PATCH_MEAN)[cell] *= cells;
        contact_tally_values(tally, MEASURE_PATCH_LARGEST)[cell] = NAN;
    }
}

static int press(struct contact_cell *cell, enum contact_length length, struct random_key key,
                 struct contact_tally *tally, const struct contact_stopper *stopper,
                 struct error *err) {
    const struct contact_case *one_case = cell->one_case;
    const struct contact_surfaces *surfaces = &one_case->lengths[length];
    struct cell_bench *bench = &cell->benches[length];
    key.sequence ^= OWN_SEQUENCE[length];
    int status = generator_run(bench->generator, key, bench->own, NULL, err);
    if (status == 0)
        status = contact_sample(&surfaces->surface.grid, surfaces->band, &surfaces->level,
                                bench->own, bench->z, err);
    if (status == 0)
        status = contact_coarse_solve(bench->halfspace, bench->z,
                                      contact_case_length_cell(one_case, length, 0), tally, stopper,
                                      err);
    if (status == 0)
        scale_patches(one_case, length, tally);
    return status;
}

int contact_cell_solve(struct contact_cell *cell, struct random_key key,
                       struct contact_tally *tally, const struct contact_stopper *stopper,
                       struct error *err) {
    for (enum contact_length l = 0; l < CONTACT_LENGTHS; l++) {
        struct error reason = {0};
        int status = contact_cell_due(cell->one_case, l, key.realisation)
                         ? press(cell, l, key, tally, stopper, &reason)
                         : 0;
        if (status != 0 && status != ERROR_NUMERIC) /* no surface: its cells stay empty */
            return error_set(err, status, "%s", reason.text);
    }
    return 0;
}

double contact_cell_bytes(const struct contact_case *one_case) {
    double bytes = 0;
    for (enum contact_length l = 0; l < CONTACT_LENGTHS; l++)
        if (contact_case_has_length(one_case, l))
            bytes += surface_bytes(&one_case->lengths[l]);
    return bytes;
}

double contact_cell_seconds(const struct contact_case *one_case) {
    double seconds = 0;
    for (enum contact_length l = 0; l < CONTACT_LENGTHS; l++)
        if (contact_case_has_length(one_case, l))
            seconds += surface_seconds(one_case, l) / (double)one_case->lengths[l].interval;
    return seconds;
}
