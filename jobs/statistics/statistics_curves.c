#include "jobs/statistics/statistics_curves.h"
#include "jobs/statistics/statistics_grid_theory.h"
#include "jobs/statistics/statistics_spectra.h"
#include "jobs/statistics/statistics_theory.h"
#include <math.h>
#include <string.h>

/* What all curves of a case are made from. */
struct statistics_curve_maker {
    const struct statistics_case *one_case;
    const struct statistics_tally *tally;
    const char *theory_name;       /* of summits; NULL: does not apply */
    enum summit_side side;         /* of the present curves */
    struct case_result *result;    /* its arena owns all arrays */
    double *pdf, *cdf, *curvature; /* theories by bin, of the present curves */
};

static int no_room(struct error *err) {
    return error_set(err, ERROR_MEMORY, "no memory left for curves");
}

/* A curve over n points with room for its numbers. */
struct curve_points {
    double *x, *y, *standard_error, *valueless;
    struct estimate *estimates; /* scratch */
};
static int curve_points_create(struct statistics_curve_maker *maker, size_t n,
                               struct curve_points *out, struct error *err) {
    double *x = result_numbers(maker->result, 4 * n);
    struct estimate *estimates = result_room(maker->result, n, sizeof *estimates);
    if (x == NULL || estimates == NULL)
        return no_room(err);
    *out = (struct curve_points){x, x + n, x + 2 * n, x + 3 * n, estimates};
    return 0;
}

/* Makes room for theories of the heights of the next curves. */
static int theories_create(struct statistics_curve_maker *maker, struct error *err) {
    size_t n = maker->one_case->height.count;
    maker->pdf = result_numbers(maker->result, 3 * n);
    if (maker->pdf == NULL)
        return no_room(err);
    maker->cdf = maker->pdf + n;
    maker->curvature = maker->pdf + 2 * n;
    return 0;
}

static void add_theory(struct curve *curve, const char *name, const double *y) {
    if (name != NULL)
        curve->theories[curve->theory_count++] = (struct theory){name, y};
}

static const char *height_label(void) {
    return "z/sqrt(m0)";
}

static const char *equivalent_label(const struct statistics_curve_maker *maker) {
    return maker->one_case->surface.dimension == 2 ? "-sqrt(3/m4) kappa_m" : "z''/sqrt(m4)";
}

/* Returns a curve of summits; that of pits has a series of its own. */
static struct curve summit_curve(const struct statistics_curve_maker *maker, const char *quantity,
                                 const char *x_label, const char *y_label) {
    struct curve curve = curve_named(quantity, x_label, y_label);
    if (maker->side == SIDE_PITS)
        curve.series = "pits";
    return curve;
}
static const struct summit_tally *side_tally(const struct statistics_curve_maker *maker) {
    return &maker->tally->summits[maker->side];
}

/* A histogram that becomes a density over its bins. */
struct histogram {
    const char *quantity, *x_label;
    const struct bins *bins;
    const struct tally *cells;
    const struct tally_total *total;
    const char *theory_name; /* NULL: none */
    const double *theory;
};

static int add_density(struct statistics_curve_maker *maker, const struct histogram *histogram,
                       struct error *err) {
    const struct bins *bins = histogram->bins;
    double width = bins_width(bins);
    struct curve curve =
        summit_curve(maker, histogram->quantity, histogram->x_label, "probability density");
    struct curve_points points;
    int status = curve_points_create(maker, bins->count, &points, err);
    if (status != 0)
        return status;
    tally_shares(histogram->cells, 1, bins->count, histogram->total, points.estimates);
    for (size_t b = 0; b < bins->count; b++) {
        struct estimate share = points.estimates[b];
        points.x[b] = bins_centre(bins, b);
        points.y[b] = share.value / width;
        points.standard_error[b] = share.standard_error / width;
        points.valueless[b] =
            (double)(histogram->total->realisations - histogram->cells->some[b + 1]);
    }
    curve_set_points(&curve, bins->count, points.x, points.y, points.standard_error);
    curve.valueless = points.valueless;
    add_theory(&curve, histogram->theory_name, histogram->theory);
    curve.counted = true;
    curve.underflow = (double)histogram->cells->count[0];
    curve.overflow = (double)histogram->cells->count[bins->count + 1];
    return result_add_curve(maker->result, &curve, err);
}

/* Adds the cumulative probability at the upper edges of the bins. */
static int add_cumulative(struct statistics_curve_maker *maker, const char *quantity,
                          const struct tally *below, const struct tally_total *total,
                          const char *theory_name, struct error *err) {
    const struct bins *bins = &maker->one_case->height;
    struct curve curve = summit_curve(maker, quantity, height_label(), "cumulative probability");
    struct curve_points points;
    int status = curve_points_create(maker, bins->count, &points, err);
    if (status != 0)
        return status;
    tally_shares(below, 1, bins->count, total, points.estimates);
    for (size_t b = 0; b < bins->count; b++) {
        struct estimate share = points.estimates[b];
        points.x[b] = bins->low + (double)(b + 1) * bins_width(bins);
        points.y[b] = share.value;
        points.standard_error[b] = share.standard_error;
    }
    curve_set_points(&curve, bins->count, points.x, points.y, points.standard_error);
    add_theory(&curve, theory_name, maker->cdf);
    return result_add_curve(maker->result, &curve, err);
}

static int add_curvature(struct statistics_curve_maker *maker, struct error *err) {
    const struct bins *bins = &maker->one_case->height;
    const struct summit_tally *tally = side_tally(maker);
    bool surface = maker->one_case->surface.dimension == 2;
    struct curve curve = summit_curve(maker, "summit_mean_curvature", height_label(),
                                      surface ? "kappa_m/sqrt(m4)" : "-z''/sqrt(m4)");
    struct curve_points points;
    int status = curve_points_create(maker, bins->count, &points, err);
    if (status != 0)
        return status;
    tally_sums_ratios_pooled(&tally->curvature, &tally->height, 1, bins->count, points.estimates);
    for (size_t b = 0; b < bins->count; b++) {
        struct estimate mean = points.estimates[b];
        points.x[b] = bins_centre(bins, b);
        points.y[b] = mean.value;
        points.standard_error[b] = mean.standard_error;
        points.valueless[b] = (double)(tally->total.realisations - tally->height.some[b + 1]);
    }
    curve_set_points(&curve, bins->count, points.x, points.y, points.standard_error);
    curve.valueless = points.valueless;
    curve.counted = true;
    curve.underflow = (double)tally->height.count[0];
    curve.overflow = (double)tally->height.count[bins->count + 1];
    add_theory(&curve, maker->theory_name, maker->curvature);
    return result_add_curve(maker->result, &curve, err);
}

/* --- the joint density of summit heights and curvatures --- */

/* The occupied cells of a matrix, and how many summits lie inside of it. */
struct joint_cells {
    size_t count;
    uint32_t *cells;
    double *y, *standard_error, inside;
    struct estimate *row; /* scratch */
};

static int joint_cells_create(struct statistics_curve_maker *maker, struct joint_cells *out,
                              struct error *err) {
    const struct statistics_case *one_case = maker->one_case;
    const struct tally *tally = &side_tally(maker)->joint;
    size_t all = one_case->height.count * one_case->equivalent.count, count = 0;
    for (size_t cell = 0; cell < all; cell++)
        count += tally->count[summit_joint_cell(one_case, cell)] > 0;
    double *y = result_numbers(maker->result, 2 * count);
    *out = (struct joint_cells){
        .cells = result_room(maker->result, count + 1, sizeof *out->cells),
        .y = y,
        .standard_error = y + count,
        .row = result_room(maker->result, one_case->equivalent.count, sizeof *out->row)};
    return out->cells != NULL && y != NULL && out->row != NULL ? 0 : no_room(err);
}

static void joint_cells_fill(const struct statistics_curve_maker *maker, double area,
                             struct joint_cells *out) {
    const struct statistics_case *one_case = maker->one_case;
    const struct summit_tally *side = side_tally(maker);
    size_t columns = one_case->equivalent.count;
    for (size_t row = 0; row < one_case->height.count; row++) {
        size_t first = summit_joint_cell(one_case, row * columns);
        tally_shares(&side->joint, first, columns, &side->total, out->row);
        for (size_t b = 0; b < columns; b++) {
            uint64_t n = side->joint.count[first + b];
            if (n == 0)
                continue;
            out->y[out->count] = out->row[b].value / area;
            out->standard_error[out->count] = out->row[b].standard_error / area;
            out->cells[out->count++] = (uint32_t)(row * columns + b);
            out->inside += (double)n;
        }
    }
}

/* Adds the cells that have summits; their theory is made on demand. */
static int add_joint(struct statistics_curve_maker *maker, struct error *err) {
    const struct bins *height = &maker->one_case->height;
    const struct bins *equivalent = &maker->one_case->equivalent;
    const struct summit_tally *side = side_tally(maker);
    double area = bins_width(height) * bins_width(equivalent);
    double *axes = result_numbers(maker->result, height->count + equivalent->count);
    struct joint_cells occupied;
    if (axes == NULL)
        return no_room(err);
    int status = joint_cells_create(maker, &occupied, err);
    if (status != 0)
        return status;
    for (size_t b = 0; b < height->count; b++)
        axes[b] = bins_centre(height, b);
    for (size_t b = 0; b < equivalent->count; b++)
        axes[height->count + b] = bins_centre(equivalent, b);
    joint_cells_fill(maker, area, &occupied);
    struct curve curve =
        summit_curve(maker, "summit_joint_pdf", height_label(), "probability density");
    curve_set_points(&curve, height->count, axes, occupied.y, occupied.standard_error);
    curve.columns = equivalent->count;
    curve.x2 = axes + height->count;
    curve.x2_label = equivalent_label(maker);
    curve.cells = occupied.cells;
    curve.cell_count = occupied.count;
    curve.empty_y = side->total.sum == 0 ? (double)NAN : 0;
    curve.empty_standard_error = tally_empty_bound(&side->joint, &side->total) / area;
    add_theory(&curve, maker->theory_name, NULL);
    curve.counted = true;
    curve.underflow = 0;
    curve.overflow = (double)side->total.sum - occupied.inside;
    return result_add_curve(maker->result, &curve, err);
}

static int complete_joint(const struct statistics_case *one_case, const struct surface_basis *basis,
                          const char *theory, double *pdf, struct error *err) {
    if (strcmp(theory, STATISTICS_GRID_THEORY) == 0)
        return statistics_grid_theory_joint(one_case, basis, pdf, err);
    statistics_theory_joint(one_case, basis->moments.nayak_alpha, pdf);
    return 0;
}

int statistics_curves_complete(const struct statistics_case *one_case,
                               const struct surface_basis *basis, struct case_result *result,
                               struct error *err) {
    for (size_t a = 0; a < result->curve_count; a++) {
        struct curve *curve = &result->curves[a];
        for (size_t t = 0; t < curve->theory_count; t++) {
            if (curve->theories[t].y != NULL || curve->columns != one_case->equivalent.count ||
                curve->n != one_case->height.count)
                continue;
            double *pdf = result_numbers(result, curve->n * curve->columns);
            if (pdf == NULL)
                return no_room(err);
            int status = complete_joint(one_case, basis, curve->theories[t].name, pdf, err);
            if (status != 0)
                return status;
            curve->theories[t].y = pdf;
        }
    }
    return 0;
}

/* --- all curves --- */

static int add_heights(struct statistics_curve_maker *maker, struct error *err) {
    const struct statistics_case *one_case = maker->one_case;
    const struct statistics_tally *tally = maker->tally;
    const char *name = one_case->surface.heights_name;
    int status = theories_create(maker, err);
    if (status == 0)
        status = statistics_theory_heights(one_case, maker->pdf, maker->cdf, err);
    const struct histogram heights = {"height_pdf",   height_label(), &one_case->height,
                                      &tally->height, &tally->points, name,
                                      maker->pdf};
    if (status == 0)
        status = add_density(maker, &heights, err);
    if (status == 0)
        status =
            add_cumulative(maker, "height_cdf", &tally->height_below, &tally->points, name, err);
    return status;
}

/* Adds a curve of each side, next to each other as curves of one quantity must be. */
typedef int add_curve_function(struct statistics_curve_maker *maker, struct error *err);
static int add_sides(struct statistics_curve_maker *maker, add_curve_function *add,
                     struct error *err) {
    int status = 0;
    for (size_t side = 0; side < maker->tally->sides && status == 0; side++) {
        maker->side = (enum summit_side)side;
        status = add(maker, err);
    }
    maker->side = SIDE_SUMMITS;
    return status;
}

static int add_summit_density(struct statistics_curve_maker *maker, struct error *err) {
    const struct summit_tally *tally = side_tally(maker);
    const struct histogram heights = {"summit_height_pdf", height_label(), &maker->one_case->height,
                                      &tally->height,      &tally->total,  maker->theory_name,
                                      maker->pdf};
    return add_density(maker, &heights, err);
}

static int add_summit_cumulative(struct statistics_curve_maker *maker, struct error *err) {
    const struct summit_tally *tally = side_tally(maker);
    return add_cumulative(maker, "summit_height_cdf", &tally->below, &tally->total,
                          maker->theory_name, err);
}

static int add_summit_heights(struct statistics_curve_maker *maker, double alpha,
                              struct error *err) {
    int status = theories_create(maker, err);
    if (status != 0)
        return status;
    if (maker->theory_name != NULL)
        statistics_theory_summits(maker->one_case, alpha, maker->pdf, maker->cdf, maker->curvature);
    status = add_sides(maker, add_summit_density, err);
    if (status == 0)
        status = add_sides(maker, add_summit_cumulative, err);
    return status != 0 ? status : add_sides(maker, add_curvature, err);
}

static int add_equivalent(struct statistics_curve_maker *maker, struct error *err) {
    const struct summit_tally *tally = side_tally(maker);
    const struct histogram curvatures = {"summit_curvature_pdf",
                                         equivalent_label(maker),
                                         &maker->one_case->equivalent,
                                         &tally->equivalent,
                                         &tally->total,
                                         maker->theory_name,
                                         maker->pdf};
    return add_density(maker, &curvatures, err);
}

static int add_summit_curvatures(struct statistics_curve_maker *maker, struct error *err) {
    maker->pdf = result_numbers(maker->result, maker->one_case->equivalent.count);
    if (maker->pdf == NULL)
        return no_room(err);
    if (maker->theory_name != NULL)
        statistics_theory_equivalent(maker->one_case, maker->pdf);
    return add_sides(maker, add_equivalent, err);
}

int statistics_curves(const struct statistics_case *one_case, const struct modes *modes,
                      const struct moments *moments, const struct statistics_tally *tally,
                      struct case_result *out, struct error *err) {
    bool applies = statistics_theory_applies(one_case, moments);
    struct statistics_curve_maker maker = {.one_case = one_case,
                                           .tally = tally,
                                           .result = out,
                                           .theory_name =
                                               applies ? statistics_theory_name(one_case) : NULL};
    /* the first is the main curve of reports: errors of grids and generation bear on summits */
    int status = add_summit_heights(&maker, moments->nayak_alpha, err);
    if (status == 0)
        status = add_summit_curvatures(&maker, err);
    if (status == 0)
        status = add_sides(&maker, add_joint, err);
    if (status == 0)
        status = add_heights(&maker, err);
    return status != 0 ? status : spectra_curves(one_case, modes, tally, out, err);
}
