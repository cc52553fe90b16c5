#include "jobs/contact/contact_like.h"
#include "jobs/like_percentile.h"
#include <math.h>
#include <stdlib.h>

struct contact_like {
    const struct contact_case *one_case;
    struct like_patch *patch;         /* owned, as all below */
    struct contact_coarse *halfspace; /* on the mirrored piece */
    double *z;
};

/* Of a piece and its mirror images. */
static struct grid mirrored_grid(const struct contact_case *one_case) {
    const struct like_case *like = &one_case->like;
    double spacing = grid_dx(&one_case->surface.grid) * (double)like->stride;
    size_t nx = 2 * like->nx, ny = like->ny == 1 ? 1 : 2 * like->ny;
    return (struct grid){nx, ny, spacing * (double)nx, spacing * (double)(ny == 1 ? nx : ny)};
}

static void mirror(size_t nx, size_t ny, const double *z, double *out) {
    size_t rows = ny == 1 ? 1 : 2 * ny;
    for (size_t j = 0; j < rows; j++)
        for (size_t i = 0; i < 2 * nx; i++) {
            size_t x = i < nx ? i : 2 * nx - 1 - i, y = j < ny ? j : 2 * ny - 1 - j;
            out[j * 2 * nx + i] = z[y * nx + x];
        }
}

static int like_fill(struct contact_like *like, const struct moments *moments, struct error *err) {
    const struct contact_case *one_case = like->one_case;
    const struct grid grid = mirrored_grid(one_case);
    int status = like_patch_create(&like->patch, &one_case->like, &one_case->surface.grid, err);
    if (status == 0)
        status = contact_coarse_create(&like->halfspace, one_case, &grid, INFINITY, moments, err);
    if (status != 0)
        return status;
    like->z = array_create(grid_points(&grid), sizeof *like->z);
    return like->z != NULL ? 0 : error_memory(err, grid_points(&grid) * sizeof(double), "a piece");
}

static int create(struct contact_like **out, const struct contact_case *one_case,
                  const struct moments *moments, struct error *err) {
    struct contact_like *like = array_create(1, sizeof *like);
    if (like == NULL)
        return error_memory(err, sizeof *like, "pieces of surfaces");
    like->one_case = one_case;
    int status = like_fill(like, moments, err);
    if (status != 0)
        contact_like_destroy(&like);
    *out = like;
    return status;
}

int contact_like_create(struct contact_like **out, const struct contact_case *one_case,
                        const struct moments *moments, struct error *err) {
    *out = NULL;
    return contact_case_has_like(one_case) ? create(out, one_case, moments, err) : 0;
}

void contact_like_destroy(struct contact_like **like) {
    struct contact_like *gone = *like;
    if (gone == NULL)
        return;
    like_patch_destroy(&gone->patch);
    contact_coarse_destroy(&gone->halfspace);
    free(gone->z);
    free(gone);
    *like = NULL;
}

int contact_like_solve(struct contact_like *like, const double *z, struct contact_tally *tally,
                       const struct contact_stopper *stopper, struct error *err) {
    const struct contact_case *one_case = like->one_case;
    const double *piece;
    int status = like_patch_cut(like->patch, z, &piece, err);
    if (status != 0)
        return status;
    mirror(one_case->like.nx, one_case->like.ny, piece, like->z);
    return contact_coarse_solve(like->halfspace, like->z, contact_case_like_cell(one_case, 0),
                                tally, stopper, err);
}

static int never(void *context) {
    (void)context;
    return 0;
}

/* In the cells of the case's first model, of a tally that nobody else sees. */
int contact_like_measure(const struct contact_case *one_case, const double *z, double *areas,
                         double *gaps, struct error *err) {
    struct contact_like *like = NULL;
    struct contact_tally tally = {0};
    struct moments moments;
    const struct contact_stopper stopper = {never, NULL};
    size_t cell = contact_case_cell(one_case, 0, 0, 0);
    int status =
        spectrum_moments(&one_case->surface.spectrum, &one_case->surface.grid, &moments, err);
    if (status == 0)
        status = contact_tally_create(&tally, one_case, err);
    if (status != 0)
        return status;
    status = create(&like, one_case, &moments, err);
    if (status == 0) {
        mirror(one_case->like.nx, one_case->like.ny, z, like->z);
        status = contact_coarse_solve(like->halfspace, like->z, cell, &tally, &stopper, err);
    }
    for (size_t k = 0; k < one_case->load_count && status == 0; k++) {
        areas[k] = contact_tally_values(&tally, MEASURE_EDGES)[cell + k];
        gaps[k] = contact_tally_values(&tally, MEASURE_GAP)[cell + k];
    }
    contact_like_destroy(&like);
    contact_tally_clear(&tally);
    return status;
}

/* --- curves --- */

struct row {
    const char *mean, *percentile, *y_label;
    enum contact_measure measure;
    const double *measured; /* one a load */
    const char *last[3];    /* scalars at the highest load: mean, measured, percentile */
};

/* Of the realisations that have one, the values of a load. */
static struct like_place place_at(const struct contact_tally *tally, const struct row *row,
                                  size_t load, double *scratch) {
    const struct contact_rows *rows = &tally->rows;
    size_t column = contact_rows_like_column(tally->one_case, row->measure) + load;
    for (size_t r = 0; r < rows->count; r++)
        scratch[r] = rows->values[r * rows->width + column];
    return like_place_of(rows->count, scratch, row->measured[load]);
}

static int add_curves(const struct contact_tally *tally, const struct row *row, double *scratch,
                      struct case_result *out, struct error *err) {
    const struct contact_case *one_case = tally->one_case;
    size_t n = one_case->load_count;
    double *x = result_numbers(out, 6 * n);
    if (x == NULL)
        return error_memory(err, 6 * n * sizeof *x, "curves");
    double *y = x + n, *standard_error = y + n, *percentile = standard_error + n;
    double *scatter = percentile + n, *measured = scatter + n;
    for (size_t k = 0; k < n; k++) {
        const struct estimate mean =
            contact_tally_mean(tally, row->measure, contact_case_like_cell(one_case, k));
        const struct like_place place = place_at(tally, row, k, scratch);
        x[k] = one_case->loads[k];
        y[k] = mean.value;
        standard_error[k] = mean.standard_error;
        percentile[k] =
            isnan(row->measured[k]) ? (double)NAN : like_percentile(&place, &scatter[k]);
        measured[k] = row->measured[k];
    }
    struct curve curve = curve_named(row->mean, "p/(E* h'_rms)", row->y_label);
    curve_set_points(&curve, n, x, y, standard_error);
    curve.theories[curve.theory_count++] = (struct theory){"measured", measured};
    int status = result_add_curve(out, &curve, err);
    curve = curve_named(row->percentile, "p/(E* h'_rms)", "percentile of the measured surface");
    curve_set_points(&curve, n, x, percentile, scatter);
    return status == 0 ? result_add_curve(out, &curve, err) : status;
}

static int add_scalar(struct case_result *out, const char *name, double value,
                      double standard_error, struct error *err) {
    const struct scalar scalar = scalar_named(name, value, standard_error, NAN);
    return result_add_scalar(out, &scalar, err);
}

/* At the highest load, beside the other scalars. */
static int add_scalars(const struct contact_tally *tally, const struct row *row, double *scratch,
                       struct case_result *out, struct error *err) {
    size_t last = tally->one_case->load_count - 1;
    const struct estimate mean =
        contact_tally_mean(tally, row->measure, contact_case_like_cell(tally->one_case, last));
    const struct like_place place = place_at(tally, row, last, scratch);
    double scatter, percentile = like_percentile(&place, &scatter);
    int status = add_scalar(out, row->last[0], mean.value, mean.standard_error, err);
    if (status == 0)
        status = add_scalar(out, row->last[1], row->measured[last], 0, err);
    return status == 0 ? add_scalar(out, row->last[2], percentile, scatter, err) : status;
}

int contact_like_curves(const struct contact_tally *tally, struct case_result *out,
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
    if (!contact_case_has_like(one_case))
        return 0;
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

double contact_like_bytes(const struct contact_case *one_case) {
    const struct grid grid = mirrored_grid(one_case);
    return contact_case_has_like(one_case)
               ? contact_coarse_bytes(&grid) + 16.0 * (double)grid_points(&grid)
               : 0;
}

double contact_like_seconds(const struct contact_case *one_case) {
    const struct grid grid = mirrored_grid(one_case);
    return contact_case_has_like(one_case) ? contact_coarse_seconds(one_case, &grid) : 0;
}
