#include "jobs/statistics/statistics_curves.h"
#include "jobs/statistics/statistics_grid_theory.h"
#include "jobs/statistics/statistics_spectra.h"
#include "jobs/statistics/statistics_theory.h"
#include <math.h>
#include <string.h>

/* Theories of summits by bin, of a side. That of both height and t1 is made on demand. */
enum summit_values {
    OF_HEIGHTS,
    OF_HEIGHTS_BELOW,
    OF_MEAN_CURVATURE,
    OF_T1,
    OF_BOTH,
    SUMMIT_VALUES
};

/* What all curves of a case are made from. */
struct statistics_curve_maker {
    const struct statistics_case *one_case;
    const struct statistics_tally *tally;
    const struct summit_theories *theories; /* of summits */
    double *values[SUMMIT_THEORIES_MOST][SIDES][SUMMIT_VALUES];
    enum summit_side side;      /* of the present curves */
    struct case_result *result; /* its arena owns all arrays */
};

static const char PITS[] = "pits"; /* the series */

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

/* Makes the theories of summits of each side. */
static int theories_fill(struct statistics_curve_maker *maker, struct error *err) {
    const struct statistics_case *one_case = maker->one_case;
    size_t n = one_case->height.count, columns = one_case->equivalent.count;
    for (size_t t = 0; t < maker->theories->count; t++)
        for (size_t side = 0; side < maker->tally->sides; side++) {
            const struct summit_theory *theory = &maker->theories->of[t];
            double *room = result_numbers(maker->result, 3 * n + columns);
            double **of = maker->values[t][side];
            if (room == NULL)
                return no_room(err);
            for (size_t a = OF_HEIGHTS; a <= OF_T1; a++)
                of[a] = room + a * n;
            summit_theory_heights(theory, one_case, side == SIDE_PITS, of[OF_HEIGHTS],
                                  of[OF_HEIGHTS_BELOW], of[OF_MEAN_CURVATURE]);
            summit_theory_equivalent(theory, one_case, side == SIDE_PITS, of[OF_T1]);
        }
    return 0;
}

static void add_theory(struct curve *curve, const struct theory *theory) {
    if (theory->name != NULL)
        curve->theories[curve->theory_count++] = *theory;
}

static void add_summit_theories(const struct statistics_curve_maker *maker,
                                enum summit_values values, struct curve *curve) {
    for (size_t t = 0; t < maker->theories->count; t++) {
        const struct theory theory = {maker->theories->of[t].name,
                                      maker->values[t][maker->side][values]};
        add_theory(curve, &theory);
    }
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
        curve.series = PITS;
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
    enum summit_values values;   /* of a histogram of summits */
    const struct theory *theory; /* of another one; NULL: of summits */
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
    if (histogram->theory == NULL)
        add_summit_theories(maker, histogram->values, &curve);
    else
        add_theory(&curve, histogram->theory);
    curve.counted = true;
    curve.underflow = (double)histogram->cells->count[0];
    curve.overflow = (double)histogram->cells->count[bins->count + 1];
    return result_add_curve(maker->result, &curve, err);
}

/* Adds the cumulative probability at the upper edges of the bins. Without a theory of its own it is
 * that of summits. */
static int add_cumulative(struct statistics_curve_maker *maker, const char *quantity,
                          const struct tally *below, const struct tally_total *total,
                          const struct theory *theory, struct error *err) {
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
    if (theory == NULL)
        add_summit_theories(maker, OF_HEIGHTS_BELOW, &curve);
    else
        add_theory(&curve, theory);
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
    add_summit_theories(maker, OF_MEAN_CURVATURE, &curve);
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
    add_summit_theories(maker, OF_BOTH, &curve);
    curve.counted = true;
    curve.underflow = 0;
    curve.overflow = (double)side->total.sum - occupied.inside;
    return result_add_curve(maker->result, &curve, err);
}

static int complete_joint(const struct statistics_case *one_case, const struct surface_basis *basis,
                          const struct summit_theories *theories, const struct curve *curve,
                          const char *name, double *pdf, struct error *err) {
    bool pits = same_text(curve->series, PITS);
    if (strcmp(name, STATISTICS_GRID_THEORY) == 0)
        return statistics_grid_theory_joint(one_case, basis, pdf, err);
    for (size_t t = 0; t < theories->count; t++)
        if (strcmp(name, theories->of[t].name) == 0)
            summit_theory_joint(&theories->of[t], one_case, pits, pdf);
    return 0;
}

static int complete_curve(const struct statistics_case *one_case, const struct surface_basis *basis,
                          const struct summit_theories *theories, struct case_result *result,
                          struct curve *curve, struct error *err) {
    for (size_t t = 0; t < curve->theory_count; t++) {
        if (curve->theories[t].y != NULL || curve->columns != one_case->equivalent.count ||
            curve->n != one_case->height.count)
            continue;
        double *pdf = result_numbers(result, curve->n * curve->columns);
        if (pdf == NULL)
            return no_room(err);
        int status =
            complete_joint(one_case, basis, theories, curve, curve->theories[t].name, pdf, err);
        if (status != 0)
            return status;
        curve->theories[t].y = pdf;
    }
    return 0;
}

static bool has_joint(const struct case_result *result) {
    for (size_t a = 0; a < result->curve_count; a++)
        if (result->curves[a].columns > 0)
            return true;
    return false;
}

int statistics_curves_complete(const struct statistics_case *one_case,
                               const struct surface_basis *basis, struct case_result *result,
                               struct error *err) {
    struct summit_theories theories;
    if (!has_joint(result))
        return 0;
    int status = summit_theories_create(&theories, one_case, basis, err);
    for (size_t a = 0; a < result->curve_count && status == 0; a++)
        status = complete_curve(one_case, basis, &theories, result, &result->curves[a], err);
    summit_theories_clear(&theories);
    return status;
}

/* --- all curves --- */

static int add_heights(struct statistics_curve_maker *maker, struct error *err) {
    const struct statistics_case *one_case = maker->one_case;
    const struct statistics_tally *tally = maker->tally;
    const char *name = one_case->surface.heights_name;
    size_t n = one_case->height.count;
    double *pdf = result_numbers(maker->result, 2 * n), *cdf = pdf + n;
    if (pdf == NULL)
        return no_room(err);
    int status = statistics_theory_heights(one_case, pdf, cdf, err);
    const struct theory density = {name, pdf}, below = {name, cdf};
    const struct histogram heights = {.quantity = "height_pdf",
                                      .x_label = height_label(),
                                      .bins = &one_case->height,
                                      .cells = &tally->height,
                                      .total = &tally->points,
                                      .theory = &density};
    if (status == 0)
        status = add_density(maker, &heights, err);
    if (status == 0)
        status =
            add_cumulative(maker, "height_cdf", &tally->height_below, &tally->points, &below, err);
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
    const struct histogram heights = {.quantity = "summit_height_pdf",
                                      .x_label = height_label(),
                                      .bins = &maker->one_case->height,
                                      .cells = &tally->height,
                                      .total = &tally->total,
                                      .values = OF_HEIGHTS};
    return add_density(maker, &heights, err);
}

static int add_summit_cumulative(struct statistics_curve_maker *maker, struct error *err) {
    const struct summit_tally *tally = side_tally(maker);
    return add_cumulative(maker, "summit_height_cdf", &tally->below, &tally->total, NULL, err);
}

static int add_equivalent(struct statistics_curve_maker *maker, struct error *err) {
    const struct summit_tally *tally = side_tally(maker);
    const struct histogram curvatures = {.quantity = "summit_curvature_pdf",
                                         .x_label = equivalent_label(maker),
                                         .bins = &maker->one_case->equivalent,
                                         .cells = &tally->equivalent,
                                         .total = &tally->total,
                                         .values = OF_T1};
    return add_density(maker, &curvatures, err);
}

/* The first is the main curve of reports: errors of grids bear on summits. */
static add_curve_function *const OF_SUMMITS[] = {add_summit_density, add_summit_cumulative,
                                                 add_curvature, add_equivalent, add_joint};

int statistics_curves(const struct statistics_case *one_case, const struct modes *modes,
                      const struct summit_theories *theories, const struct statistics_tally *tally,
                      struct case_result *out, struct error *err) {
    struct statistics_curve_maker maker = {
        .one_case = one_case, .tally = tally, .theories = theories, .result = out};
    int status = theories_fill(&maker, err);
    for (size_t a = 0; a < sizeof OF_SUMMITS / sizeof *OF_SUMMITS && status == 0; a++)
        status = add_sides(&maker, OF_SUMMITS[a], err);
    if (status == 0)
        status = add_heights(&maker, err);
    return status != 0 ? status : spectra_curves(one_case, modes, tally, out, err);
}
