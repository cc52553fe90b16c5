#include "jobs/contact/contact_cell.h"
#include "core/cost.h"
#include "jobs/contact/contact_probe.h"
#include "jobs/contact/contact_sample.h"
#include <math.h>
#include <stdlib.h>

/* Sequences of cases have not this bit. */
static const uint64_t OWN_SEQUENCE = UINT64_C(1) << 63;
/* Of the time that the case takes without: what goes into these surfaces, and into the probe on the
 * case's own ones. */
static const double LONGER_SHARE = 0.1, PROBE_SHARE = 0.03;
static const uint64_t INTERVAL_MOST = 1 << 20;
/* These surfaces may take as much memory as the rest of the case, or this where that is more. */
static const double BYTES_LEAST = 1e9;

struct contact_cell {
    const struct contact_case *one_case;
    struct generator *generator; /* owned, as all below */
    struct contact_coarse *halfspace;
    double *own, *z; /* heights as generated, and on the coarse mesh */
};

/* --- the choice --- */

static struct grid longer_grid(const struct grid *grid) {
    size_t ny = grid_is_profile(grid) ? 1 : CONTACT_LONGER * grid->ny;
    return (struct grid){CONTACT_LONGER * grid->nx, ny, CONTACT_LONGER * grid->lx,
                         CONTACT_LONGER * grid->ly};
}

/* Surfaces that are not Gaussian depend on the grid that they are generated on: it is as fine as
 * that of the case. Others are generated where they are needed, if that holds their waves. */
static bool choose_grids(const struct contact_case *one_case, struct contact_longer *out) {
    struct surface_case *surface = &out->surface;
    out->level = one_case->probe;
    out->level.grid = longer_grid(&one_case->probe.grid);
    *surface = one_case->surface;
    surface->length_ratio *= CONTACT_LONGER;
    surface->grid = longer_grid(&one_case->surface.grid);
    out->band = surface_case_exact(surface) ? surface_case_band(surface) : surface->grid.nx / 2;
    if (surface->options.heights.type == HEIGHTS_GAUSSIAN && out->level.grid.nx > 2 * out->band) {
        surface->grid = out->level.grid;
        out->level.stride = 1;
    }
    double points = (double)surface->grid.nx * (double)surface->grid.ny;
    return points <= SURFACE_POINTS_MOST &&
           (out->level.stride > 0 || out->level.grid.nx > 2 * out->band);
}

static double surface_seconds(const struct contact_case *one_case) {
    const struct surface_case *surface = &one_case->longer.surface;
    return 1e-9 * cost_generation(&surface->options) * (double)grid_points(&surface->grid) +
           contact_coarse_seconds(one_case, &one_case->longer.level.grid);
}

/* Returns the least power of two, at least `least`, as many times less than which it may take. */
static uint64_t interval_of(double seconds, double allowed, uint64_t least) {
    uint64_t interval = least;
    while (interval < INTERVAL_MOST && !(seconds <= (double)interval * allowed))
        interval *= 2;
    return interval;
}

void contact_cell_choose(struct contact_case *one_case) {
    double seconds = contact_case_plain_seconds(one_case);
    bool probed = contact_case_is_probed(one_case);
    if (!probed)
        contact_probe_choose(one_case);
    if (!choose_grids(one_case, &one_case->longer) ||
        contact_cell_bytes(one_case) > fmax(BYTES_LEAST, contact_case_plain_bytes(one_case))) {
        one_case->longer = (struct contact_longer){0};
        if (!probed)
            one_case->probe = (struct contact_level){0};
        return;
    }
    uint64_t equal_length = one_case->surface.dimension == 1 ? 2 : 4;
    one_case->longer.interval =
        interval_of(surface_seconds(one_case), LONGER_SHARE * seconds, equal_length);
    one_case->probe_interval = 1;
    one_case->probe_interval =
        interval_of(contact_probe_seconds(one_case), PROBE_SHARE * seconds, 1);
}

bool contact_cell_due(const struct contact_case *one_case, uint64_t realisation) {
    return contact_case_has_longer(one_case) &&
           contact_probe_turn(one_case->longer.interval, realisation);
}

/* --- one surface --- */

static int cell_fill(struct contact_cell *cell, struct error *err) {
    const struct contact_longer *longer = &cell->one_case->longer;
    const struct surface_case *surface = &longer->surface;
    struct moments moments;
    size_t points = grid_points(&surface->grid), coarse = grid_points(&longer->level.grid);
    int status = generator_create(&cell->generator, &surface->spectrum, &surface->grid,
                                  &surface->options, err);
    if (status != 0)
        return status;
    modes_moments(generator_modes(cell->generator), &moments);
    status = contact_coarse_create(&cell->halfspace, cell->one_case, &longer->level.grid, INFINITY,
                                   &moments, err);
    if (status != 0)
        return status;
    cell->own = array_create(points, sizeof *cell->own);
    cell->z = array_create(coarse, sizeof *cell->z);
    return cell->own != NULL && cell->z != NULL
               ? 0
               : error_memory(err, (points + coarse) * sizeof *cell->z, "a longer surface");
}

int contact_cell_create(struct contact_cell **out, const struct contact_case *one_case,
                        struct error *err) {
    *out = NULL;
    if (!contact_case_has_longer(one_case))
        return 0;
    struct contact_cell *cell = array_create(1, sizeof *cell);
    if (cell == NULL)
        return error_memory(err, sizeof *cell, "a probe of the cell's length");
    cell->one_case = one_case;
    int status = cell_fill(cell, err);
    if (status != 0)
        contact_cell_destroy(&cell);
    *out = cell;
    return status;
}

void contact_cell_destroy(struct contact_cell **cell) {
    struct contact_cell *gone = *cell;
    if (gone == NULL)
        return;
    generator_destroy(&gone->generator);
    contact_coarse_destroy(&gone->halfspace);
    free(gone->own);
    free(gone->z);
    free(gone);
    *cell = NULL;
}

static int press(struct contact_cell *cell, struct random_key key, struct contact_tally *tally,
                 const struct contact_stopper *stopper, struct error *err) {
    const struct contact_case *one_case = cell->one_case;
    const struct contact_longer *longer = &one_case->longer;
    key.sequence ^= OWN_SEQUENCE;
    int status = generator_run(cell->generator, key, cell->own, NULL, err);
    if (status == 0)
        status = contact_sample(&longer->surface.grid, longer->band, &longer->level, cell->own,
                                cell->z, err);
    return status != 0
               ? status
               : contact_coarse_solve(cell->halfspace, cell->z,
                                      contact_case_longer_cell(one_case, 0), tally, stopper, err);
}

/* Measures that grow with the cell are told of one as long as the case's. The largest patch of a
 * cell has no limit in long ones. */
static void scale_patches(const struct contact_case *one_case, struct contact_tally *tally) {
    double cells = pow(CONTACT_LONGER, one_case->surface.dimension);
    for (size_t k = 0; k < one_case->load_count; k++) {
        size_t cell = contact_case_longer_cell(one_case, k);
        contact_tally_values(tally, MEASURE_PATCHES)[cell] /= cells;
        contact_tally_values(tally, MEASURE_PATCH_MEAN)[cell] *= cells;
        contact_tally_values(tally, MEASURE_PATCH_LARGEST)[cell] = NAN;
    }
}

int contact_cell_solve(struct contact_cell *cell, struct random_key key,
                       struct contact_tally *tally, const struct contact_stopper *stopper,
                       struct error *err) {
    struct error reason = {0};
    int status = press(cell, key, tally, stopper, &reason);
    if (status == ERROR_NUMERIC) /* no surface: cells are left without values */
        return 0;
    if (status != 0)
        return error_set(err, status, "%s", reason.text);
    scale_patches(cell->one_case, tally);
    return 0;
}

double contact_cell_bytes(const struct contact_case *one_case) {
    const struct contact_longer *longer = &one_case->longer;
    if (!contact_case_has_longer(one_case))
        return 0;
    return surface_case_bytes(&longer->surface) + 8 * (double)grid_points(&longer->level.grid) +
           contact_coarse_bytes(&longer->level.grid);
}

double contact_cell_seconds(const struct contact_case *one_case) {
    return contact_case_has_longer(one_case)
               ? surface_seconds(one_case) / (double)one_case->longer.interval
               : 0;
}
