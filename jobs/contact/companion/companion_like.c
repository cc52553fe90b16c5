/* The contact of a measured surface, compared with that of sub-maps of random surfaces
 * (FORMULAS.md, F18.28). Each is mirrored at its sides, so that it repeats without a step, and
 * pressed on a half-space to the loads of the case, on its own points. */
#include "jobs/contact/companion/companion.h"
#include "jobs/like/like_percentile.h"
#include <stdlib.h>
#include <string.h>

static const enum contact_measure KEPT[] = {MEASURE_EDGES, MEASURE_GAP};

struct like {
    struct like_patch *patch;        /* owned, as all below */
    struct coarse_solver *halfspace; /* on the mirrored sub-map */
    double *z;
};

/* --- the plan --- */

/* Returns the grid of a sub-map and its mirror images. */
static struct grid mirrored_grid(const struct contact_case *one_case) {
    const struct like_case *like = &one_case->like;
    double spacing = grid_dx(&one_case->surface.grid) * (double)like->stride;
    size_t nx = 2 * like->nx, ny = like->ny == 1 ? 1 : 2 * like->ny;
    return (struct grid){nx, ny, spacing * (double)nx, spacing * (double)(ny == 1 ? nx : ny)};
}

static bool like_plan(const struct contact_case *one_case, struct companion_plan *out) {
    if (one_case->like_areas == NULL)
        return false;
    out->series = 1;
    out->due = (struct subset){.interval = 1};
    out->level.grid = mirrored_grid(one_case);
    out->kept = KEPT;
    out->kept_count = sizeof KEPT / sizeof *KEPT;
    return true;
}

static double like_bytes(const struct contact_case *one_case, const struct companion_plan *plan) {
    return coarse_solver_bytes(one_case, &plan->level.grid) +
           16.0 * (double)grid_points(&plan->level.grid);
}

static double like_seconds(const struct contact_case *one_case, const struct companion_plan *plan) {
    return coarse_solver_seconds(one_case, &plan->level.grid);
}

/* --- one sub-map --- */

static void mirror(const struct like_case *like, const double *z, double *out) {
    size_t nx = like->nx, ny = like->ny, rows = ny == 1 ? 1 : 2 * ny;
    for (size_t j = 0; j < rows; j++)
        for (size_t i = 0; i < 2 * nx; i++) {
            size_t x = i < nx ? i : 2 * nx - 1 - i, y = j < ny ? j : 2 * ny - 1 - j;
            out[j * 2 * nx + i] = z[y * nx + x];
        }
}

static int fill(struct like *like, const struct contact_case *one_case, const struct grid *grid,
                const struct moments *moments, struct error *err) {
    int status = like_patch_create(&like->patch, &one_case->like, &one_case->surface.grid, err);
    if (status == 0)
        status = coarse_solver_create(&like->halfspace, one_case, grid, INFINITY, moments, err);
    if (status != 0)
        return status;
    like->z = array_create(grid_points(grid), sizeof *like->z);
    return like->z != NULL ? 0
                           : error_memory(err, grid_points(grid) * sizeof *like->z, "a sub-map");
}

static int like_create(void *workspace, const struct contact_case *one_case,
                       const struct companion_plan *plan, const struct moments *moments,
                       struct error *err) {
    return fill(workspace, one_case, &plan->level.grid, moments, err);
}

static void like_clear(void *workspace) {
    struct like *like = workspace;
    like_patch_destroy(&like->patch);
    coarse_solver_destroy(&like->halfspace);
    free(like->z);
}

static int like_solve(void *workspace, const struct contact_surface *surface,
                      struct contact_tally *tally, struct companion_tally *out,
                      const struct contact_stopper *stopper, struct error *err) {
    const struct like *like = workspace;
    const struct contact_case *one_case = tally->one_case;
    const double *piece;
    int status = like_patch_cut(like->patch, surface->key, surface->z, &piece, err);
    if (status != 0)
        return status;
    mirror(&one_case->like, piece, like->z);
    return coarse_solver_press(like->halfspace, like->z, companion_series(one_case, out, 0),
                               stopper, err);
}

static int never(void *context) {
    (void)context;
    return 0;
}

int companion_like_measure(const struct contact_case *one_case, const double *z, double *areas,
                           double *gaps, struct error *err) {
    const struct contact_stopper stopper = {never, NULL};
    const struct grid grid = mirrored_grid(one_case);
    const size_t loads = one_case->load_count, n = contact_case_slots(one_case);
    struct like like = {0};
    struct moments moments;
    double *series = array_create(n, MEASURE_PAIRED * sizeof *series);
    if (series == NULL)
        return error_memory(err, n * MEASURE_PAIRED * sizeof *series, "contact of a map");
    for (size_t a = 0; a < MEASURE_PAIRED * n; a++)
        series[a] = NAN;
    int status =
        spectrum_moments(&one_case->surface.spectrum, &one_case->surface.grid, &moments, err);
    if (status == 0)
        status = fill(&like, one_case, &grid, &moments, err);
    if (status == 0) {
        mirror(&one_case->like, z, like.z);
        status = coarse_solver_press(like.halfspace, like.z, series, &stopper, err);
    }
    if (status == 0) {
        memcpy(areas, series + MEASURE_EDGES * n, loads * sizeof *areas);
        memcpy(gaps, series + MEASURE_GAP * n, loads * sizeof *gaps);
    }
    like_clear(&like);
    free(series);
    return status;
}

/* --- curves --- */

struct row {
    const char *mean, *percentile, *y_label;
    enum contact_measure measure;
    const double *measured; /* one for each load */
    const char *last[3];    /* scalars at the highest load: mean, measured, percentile */
};

/* Returns the position of the measured value among those of the realisations at a load. */
static struct like_place position_at(const struct contact_tally *tally, const struct row *row,
                                     size_t load, double *scratch) {
    const struct contact_rows *rows = &tally->rows;
    size_t column =
        contact_rows_companion_column(tally->one_case, COMPANION_LIKE, 0, row->measure) + load;
    for (size_t r = 0; r < rows->count; r++)
        scratch[r] = rows->values[r * rows->width + column];
    return like_place_of(rows->count, scratch, row->measured[load]);
}

static int add_curves(const struct contact_tally *tally, const struct row *row, double *scratch,
                      struct case_result *out, struct error *err) {
    const struct contact_case *one_case = tally->one_case;
    size_t n = one_case->load_count;
    double *x = result_numbers(out, 7 * n);
    if (x == NULL)
        return error_memory(err, 7 * n * sizeof *x, "curves");
    double *y = x + n, *standard_error = y + n, *percentile = standard_error + n;
    double *scatter = percentile + n, *measured = scatter + n, *draws = measured + n;
    for (size_t k = 0; k < n; k++) {
        const struct estimate mean =
            contact_tally_companion(tally, COMPANION_LIKE, 0, row->measure, k);
        const struct like_place position = position_at(tally, row, k, scratch);
        x[k] = one_case->loads[k];
        y[k] = mean.value;
        standard_error[k] = mean.standard_error;
        percentile[k] =
            isnan(row->measured[k]) ? (double)NAN : like_percentile(&position, &scatter[k]);
        measured[k] = row->measured[k];
        draws[k] = (double)contact_tally_draws(tally, COMPANION_LIKE, 0, row->measure, k);
    }
    struct curve curve = curve_named(row->mean, "p/(E* h'_rms)", row->y_label);
    curve_set_points(&curve, n, x, y, standard_error);
    curve.effective = draws;
    curve.theories[curve.theory_count++] = (struct theory){"measured", measured};
    int status = result_add_curve(out, &curve, err);
    curve = curve_named(row->percentile, "p/(E* h'_rms)", "percentile of the measured surface");
    curve_set_points(&curve, n, x, percentile, scatter);
    curve.effective = NULL;
    return status == 0 ? result_add_curve(out, &curve, err) : status;
}

static int add_scalar(struct case_result *out, const char *name, struct estimate value,
                      double effective, struct error *err) {
    struct scalar scalar = scalar_named(name, value.value, value.standard_error, NAN);
    scalar.effective = effective;
    return result_add_scalar(out, &scalar, err);
}

/* Adds the values at the highest load as scalars. */
static int add_scalars(const struct contact_tally *tally, const struct row *row, double *scratch,
                       struct case_result *out, struct error *err) {
    size_t last = tally->one_case->load_count - 1;
    const struct estimate mean =
        contact_tally_companion(tally, COMPANION_LIKE, 0, row->measure, last);
    const struct like_place position = position_at(tally, row, last, scratch);
    const double draws = (double)contact_tally_draws(tally, COMPANION_LIKE, 0, row->measure, last);
    struct estimate percentile;
    percentile.value = like_percentile(&position, &percentile.standard_error);
    int status = add_scalar(out, row->last[0], mean, draws, err);
    if (status == 0)
        status = add_scalar(out, row->last[1], (struct estimate){row->measured[last], 0}, 0, err);
    return status == 0 ? add_scalar(out, row->last[2], percentile, 0, err) : status;
}

/* Appends curves of area and gap: the mean over the sub-maps and the value of the map, as
 * "piece_QUANTITY", and "percentile_QUANTITY". Their values at the highest load are also
 * scalars. */
static int like_curves(const struct contact_tally *tally, struct case_result *out,
                       struct error *err) {
    const struct contact_case *one_case = tally->one_case;
    const struct row rows[] = {
        {"piece_contact_area",
         "percentile_contact_area",
         "A/A0 of mirrored pieces",
         MEASURE_EDGES,
         one_case->like_areas,
         {"piece_contact_area_last", "measured_contact_area_last", "percentile_contact_area_last"}},
        {"piece_mean_gap",
         "percentile_mean_gap",
         "mean gap/sqrt(m0) of mirrored pieces",
         MEASURE_GAP,
         one_case->like_gaps,
         {"piece_mean_gap_last", "measured_mean_gap_last", "percentile_mean_gap_last"}}};
    double *scratch = array_create(tally->rows.count + 1, sizeof *scratch);
    if (scratch == NULL)
        return error_memory(err, tally->rows.count * sizeof *scratch, "pieces of surfaces");
    int status = 0;
    for (size_t r = 0; r < sizeof rows / sizeof *rows && status == 0; r++)
        status = add_curves(tally, &rows[r], scratch, out, err);
    for (size_t r = 0; r < sizeof rows / sizeof *rows && status == 0; r++)
        status = add_scalars(tally, &rows[r], scratch, out, err);
    free(scratch);
    return status;
}

COMPANION_DEFINE(LIKE, "sub-maps of surfaces", NULL, ERROR_SOURCES, like_plan, struct like,
                 like_create, like_clear, like_bytes, like_seconds, like_solve, NULL, NULL,
                 like_curves)
