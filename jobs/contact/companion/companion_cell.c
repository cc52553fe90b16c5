/* The error of the finite length of the cell (FORMULAS.md, F15.7). Beside some realisations,
 * surfaces of twice the length_ratio, and of a quarter or half of it, are pressed on a half-space
 * on a coarse mesh. They have random numbers of their own; a rectangle keeps its shape. The change
 * with the length bounds the error. Longer surfaces have the lengths that matter; shorter ones are
 * so cheap that many of them give the change a small statistical error.
 *
 * Such a surface is a function of the seed and its realisation, and cases that share their random
 * numbers share it. All else of it is that of the case. The interval is such that they take about a
 * tenth of the case's time, and that longer ones together are not longer than those of the case. */
#include "core/cost.h"
#include "jobs/contact/companion/companion.h"
#include "jobs/contact/contact_measure.h"
#include <stdlib.h>

/* Time for the surfaces of one length, over that of the case without. */
static const double TIME_SHARE = 0.06;
/* These surfaces may take as much memory as the case's own on a half-space on its finest mesh, or
 * this if that is less. */
static const double BYTES_LEAST = 1e9;
static const double ROUNDING = 1e-9; /* relative: of numbers that should be integers */

struct cell {
    const struct contact_case *one_case;
    const struct companion_plan *plan;
    struct generator *generator; /* owned, as all below */
    struct coarse_solver *halfspace;
    double rms_height; /* of the surfaces */
    double *own, *z;   /* heights as generated, and on the coarse mesh */
};

/* --- the plan --- */

/* Makes the grid of a cell `length` times as long, and as wide, with the same spacing; false where
 * the numbers of points are no integers, or too large. */
static bool scale_grid(const struct grid *grid, double length, struct grid *out) {
    bool profile = grid_is_profile(grid);
    double along_x = length * (double)grid->nx, along_y = profile ? 1 : length * (double)grid->ny;
    if (fmod(along_x, 1) != 0 || fmod(along_y, 1) != 0 || along_x * along_y > SURFACE_POINTS_MOST)
        return false;
    *out = (struct grid){(size_t)along_x, (size_t)along_y, length * grid->lx, length * grid->ly};
    return true;
}

/* Surfaces that are iterated depend on the grid that they are generated on: it is as fine as
 * that of the case. Others are generated on the mesh that they are pressed on, if it holds their
 * waves. */
static bool choose_grids(const struct contact_case *one_case, struct companion_plan *out) {
    struct surface_case *surface = &out->surface;
    const struct contact_level own = coarse_level(one_case);
    out->level = own;
    *surface = one_case->surface;
    surface->length_ratio *= out->length;
    surface->length_ratio_y *= out->length;
    if (!scale_grid(&own.grid, out->length, &out->level.grid) ||
        !scale_grid(&one_case->surface.grid, out->length, &surface->grid))
        return false;
    out->band = surface_case_sampled_band(surface);
    if (!surface_is_iterated(&surface->options) && surface_band_fits(out->band, &out->level.grid)) {
        surface->grid = out->level.grid;
        out->level.stride = 1;
    }
    return out->level.stride > 0 || surface_band_fits(out->band, &out->level.grid);
}

static double cell_seconds(const struct contact_case *one_case, const struct companion_plan *plan) {
    return 1e-9 * cost_generation(&plan->surface.options, NULL) *
               (double)grid_points(&plan->surface.grid) +
           coarse_solver_seconds(one_case, &plan->level.grid);
}

static double cell_bytes(const struct contact_case *one_case, const struct companion_plan *plan) {
    const struct grid *grid = &plan->level.grid;
    (void)one_case;
    return surface_case_bytes(&plan->surface) + 8 * (double)grid_points(grid) +
           coarse_solver_bytes(grid);
}

/* There are no such surfaces if they would have too many points, or take much more memory than the
 * case. */
static bool plan_length(const struct contact_case *one_case, double length, uint64_t least,
                        struct companion_plan *out) {
    double own = surface_case_bytes(&one_case->surface) +
                 coarse_solver_bytes(&contact_case_finest(one_case)->grid);
    out->length = length;
    if (!choose_grids(one_case, out) || cell_bytes(one_case, out) > fmax(BYTES_LEAST, own))
        return false;
    out->series = 1;
    out->due = subset_each(subset_interval(
        cell_seconds(one_case, out), TIME_SHARE * contact_case_least_seconds(one_case), least));
    return true;
}

static bool plan_longer(const struct contact_case *one_case, struct companion_plan *out) {
    return plan_length(one_case, 2, one_case->surface.dimension == 1 ? 2 : 4, out);
}

static bool holds_waves(const struct contact_case *one_case, double length) {
    const double waves[] = {length * one_case->surface.length_ratio,
                            length * one_case->surface.length_ratio_y};
    for (size_t side = 0; side < 2; side++)
        if (!(waves[side] >= 1 && fabs(waves[side] - round(waves[side])) <= ROUNDING * waves[side]))
            return false;
    return true;
}

/* Takes a quarter or half, whichever first holds whole longest waves. */
static bool plan_shorter(const struct contact_case *one_case, struct companion_plan *out) {
    double length = holds_waves(one_case, 0.25) ? 0.25 : 0.5;
    return holds_waves(one_case, length) && plan_length(one_case, length, 1, out);
}

/* --- one surface --- */

static int cell_create(void *workspace, const struct contact_case *one_case,
                       const struct companion_plan *plan, const struct moments *moments,
                       struct error *err) {
    struct cell *cell = workspace;
    const struct surface_case *surface = &plan->surface;
    size_t points = grid_points(&surface->grid), coarse = grid_points(&plan->level.grid);
    struct moments own;
    (void)moments; /* of the case's length */
    cell->one_case = one_case;
    cell->plan = plan;
    int status = generator_create(&cell->generator, &surface->spectrum, &surface->grid,
                                  &surface->options, err);
    if (status != 0)
        return status;
    modes_moments(generator_modes(cell->generator), &own);
    cell->rms_height = own.rms_height;
    status =
        coarse_solver_create(&cell->halfspace, one_case, &plan->level.grid, INFINITY, &own, err);
    if (status != 0)
        return status;
    cell->own = array_create(points, sizeof *cell->own);
    cell->z = array_create(coarse, sizeof *cell->z);
    return cell->own != NULL && cell->z != NULL
               ? 0
               : error_memory(err, (points + coarse) * sizeof *cell->z,
                              "a surface of another length");
}

static void cell_clear(void *workspace) {
    struct cell *cell = workspace;
    generator_destroy(&cell->generator);
    coarse_solver_destroy(&cell->halfspace);
    free(cell->own);
    free(cell->z);
}

/* Scales the values of a series to cells as large as the case's. Patches are counted on the area of
 * the case's own cell, and shares are of that area. */
static void scale_measures(const struct cell *cell, double *series) {
    double cells = pow(cell->plan->length, cell->one_case->surface.dimension);
    for (size_t a = 0; a < MEASURE_PAIRED; a++)
        for (size_t k = 0; k < cell->one_case->load_count; k++)
            series[a * cell->one_case->load_count + k] *= measure_factor(MEASURES[a].cell, cells);
}

/* Sequences of cases have none of the bits by which these differ from them. */
static int cell_solve(void *workspace, const struct contact_surface *surface,
                      struct contact_tally *tally, struct companion_tally *out,
                      const struct contact_stopper *stopper, struct error *err) {
    const struct cell *cell = workspace;
    const struct companion_plan *plan = cell->plan;
    struct random_key key = surface->key;
    double *series = companion_series(tally->one_case, out, 0);
    key.sequence ^= UINT64_C(1) << (plan->length > 1 ? 63 : 62);
    int status = generator_run(cell->generator, key, cell->own, NULL, err);
    if (status == 0)
        status = contact_level_sample(&plan->level, &plan->surface, cell->rms_height, cell->own,
                                      cell->z, err);
    if (status == 0)
        status = coarse_solver_press(cell->halfspace, cell->z, series, stopper, err);
    if (status == 0)
        scale_measures(cell, series);
    return status;
}

/* --- the error --- */

/* Values are not monotone in the length, and some of their errors fall slower than 1/L: doubling
 * the length is assumed to leave this share of an error. Measured by
 * tests/validation/jobs/test_contact_cells.c. */
static const double LEFT = 0.7;

/* Returns the mean on another length less that on the case's own, over the latter. */
static struct estimate change_of(const struct contact_tally *tally, enum contact_measure measure,
                                 enum companion_name length, size_t load) {
    if (!contact_case_has(tally->one_case, length))
        return (struct estimate){NAN, NAN};
    struct estimate own = contact_tally_controlled(tally, COMPANION_PROBE, 0, measure, load);
    struct estimate other =
        contact_tally_several(contact_tally_companion(tally, length, 0, measure, load));
    return (struct estimate){(other.value - own.value) / own.value,
                             fabs(hypot(own.standard_error, other.standard_error) / own.value)};
}

/* Until the bounds of all loads are known, an error holds the changes to both lengths in its order
 * and its bound. */
static double *change_at(struct contact_error *error, enum companion_name length) {
    return length == COMPANION_LONGER ? &error->order : &error->bound;
}

/* Returns the largest change of the loads around one: of those near it, and of its neighbours if
 * the sign changes in between. */
static double change_around(const struct contact_case *one_case, struct contact_error *errors,
                            enum companion_name length, size_t load) {
    double most = 0, own = *change_at(&errors[load], length);
    for (size_t k = 0; k < one_case->load_count; k++) {
        double change = *change_at(&errors[k], length);
        bool next = k + 1 >= load && k <= load + 1;
        if ((next && change * own < 0) || contact_error_near(one_case->loads, k, load))
            most = fmax(most, fabs(change));
    }
    return isnan(own) ? own : most;
}

/* A bound of the error at a load by one length. It includes the statistical error of the change of
 * few surfaces, which totals do not count otherwise. least: the part of the change beyond that. */
struct verdict {
    double bound, least, standard_error; /* NaN: not known */
};

static struct verdict judge(const struct contact_tally *tally, enum contact_measure measure,
                            enum companion_name length, size_t load, double y,
                            struct contact_error *errors) {
    const struct contact_case *one_case = tally->one_case;
    if (!contact_case_has(one_case, length))
        return (struct verdict){NAN, NAN, NAN};
    double scale = contact_error_left(one_case->companions[length].length, LEFT) * fabs(y);
    double change = scale * change_around(one_case, errors, length, load);
    double standard_error = scale * change_of(tally, measure, length, load).standard_error;
    return (struct verdict){hypot(change, standard_error), fmax(0, change - standard_error),
                            standard_error};
}

/* The change on shorter cells is known precisely but says nothing about longer cells. Its bound is
 * used where it is smaller, but not below the part of the change on longer cells that exceeds its
 * statistical error. */
static struct verdict weigh(struct verdict longer, struct verdict shorter) {
    if (isnan(longer.bound) || shorter.bound >= longer.bound)
        return isnan(longer.bound) ? shorter : longer;
    if (isnan(shorter.bound))
        return longer;
    if (shorter.bound >= longer.least)
        return shorter;
    longer.bound = longer.least;
    return longer;
}

static bool cell_applies(const struct contact_case *one_case, size_t model) {
    (void)one_case, (void)model;
    return true;
}

/* The relative change of a half-space on a coarse mesh stands for that of other models and meshes.
 * As the sign of the error is not known, the bound is on both sides. */
static bool cell_errors(const struct contact_tally *tally, enum contact_measure measure,
                        size_t model, struct contact_error *out) {
    const struct contact_case *one_case = tally->one_case;
    size_t n = one_case->load_count, finest = one_case->level_count - 1;
    bool any = false;
    for (size_t k = 0; k < n; k++) {
        out[k] = (struct contact_error){.value = NAN};
        *change_at(&out[k], COMPANION_LONGER) =
            change_of(tally, measure, COMPANION_LONGER, k).value;
        *change_at(&out[k], COMPANION_SHORTER) =
            change_of(tally, measure, COMPANION_SHORTER, k).value;
    }
    for (size_t k = 0; k < n; k++) {
        double y = contact_mean(tally, measure, model, finest, k).value;
        struct verdict of = weigh(judge(tally, measure, COMPANION_LONGER, k, y, out),
                                  judge(tally, measure, COMPANION_SHORTER, k, y, out));
        out[k].value = of.bound;
        out[k].standard_error = of.standard_error;
    }
    for (size_t k = 0; k < n; k++) {
        bool known = !isnan(out[k].value);
        out[k].bound = out[k].value;
        out[k].value = known ? 0 : (double)NAN;
        out[k].order = NAN;
        any = any || known;
    }
    return any;
}

COMPANION_DEFINE(LONGER, "a longer cell", "/contact/cell_error", ERROR_CELL, plan_longer,
                 struct cell, cell_create, cell_clear, cell_bytes, cell_seconds, cell_solve,
                 cell_applies, cell_errors, NULL)
COMPANION_DEFINE(SHORTER, "a shorter cell", "/contact/cell_error", ERROR_CELL, plan_shorter,
                 struct cell, cell_create, cell_clear, cell_bytes, cell_seconds, cell_solve,
                 cell_applies, cell_errors, NULL)
