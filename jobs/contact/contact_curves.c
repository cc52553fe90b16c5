#include "jobs/contact/contact_curves.h"
#include "jobs/contact/contact_errors.h"
#include "jobs/contact/contact_generation_errors.h"
#include "jobs/contact/contact_mean.h"
#include "jobs/contact/contact_theory.h"
#include <math.h>
#include <string.h>

/* All curves of a case are made from this. */
struct contact_curve_maker {
    const struct contact_case *one_case;
    const struct modes *modes;
    const struct contact_tally *tally;
    struct contact_theories theories;
    struct case_result *result;   /* its arena owns all arrays */
    struct contact_error *errors; /* scratch: one a load */
};

static int no_room(struct error *err) {
    return error_set(err, ERROR_MEMORY, "no memory left for curves");
}

/* A curve over the loads is made from this. */
struct row {
    const char *quantity, *series, *y_label;
    enum contact_measure measure;
    double factor; /* y is so many times the measure */
};

static void add_theories(const struct contact_curve_maker *maker, const struct row *row,
                         struct curve *curve) {
    const struct contact_theories *theories = &maker->theories;
    switch (row->measure) {
    case MEASURE_NODES:
    case MEASURE_NODES_LOWER:
    case MEASURE_NODES_UPPER:
    case MEASURE_EDGES:
    case MEASURE_PERIMETER:
        curve->theory_count = theories->area_count;
        memcpy(curve->theories, theories->area, sizeof theories->area);
        break;
    case MEASURE_GAP:
        curve->theory_count = theories->gap_count;
        memcpy(curve->theories, theories->gap, sizeof theories->gap);
        break;
    default:
        break;
    }
}

/* Returns the kinematics of strain; NULL where there is nothing to choose. */
static const char *kinematics_of(const struct contact_case *one_case, size_t model) {
    const struct contact_model *of = one_case->models[model];
    return of->kinematics != NULL ? of->kinematics(one_case) : NULL;
}

/* Makes a curve with the attributes of its model and level. */
static struct curve curve_of(const struct contact_case *one_case, size_t model, size_t level,
                             const char *quantity, const char *x_label, const char *y_label) {
    struct curve curve = curve_named(quantity, x_label, y_label);
    curve.model = contact_model_name(one_case->models[model]);
    curve.kinematics = kinematics_of(one_case, model);
    curve.level = one_case->levels[level].points;
    curve.points = (double)grid_points(&one_case->levels[level].grid);
    return curve;
}

/* The mean of the orders that the levels show; NaN where they show none. */
static double mean_order(size_t n, const struct contact_error *errors) {
    double sum = 0, count = 0;
    for (size_t k = 0; k < n; k++)
        if (!isnan(errors[k].order)) {
            sum += errors[k].order;
            count++;
        }
    return sum / count;
}

/* Of one source, `factor` times that of the measure. */
static int put_errors(struct contact_curve_maker *maker, double factor,
                      const struct contact_error *errors, struct curve_error *out,
                      struct error *err) {
    size_t n = maker->one_case->load_count;
    double *value = result_numbers(maker->result, 3 * n);
    if (value == NULL)
        return no_room(err);
    double *bound = value + n, *standard_error = bound + n;
    for (size_t k = 0; k < n; k++) {
        value[k] = factor * errors[k].value;
        bound[k] = factor * errors[k].bound;
        standard_error[k] = factor * errors[k].standard_error;
    }
    double order = mean_order(n, errors);
    *out = (struct curve_error){.applies = true,
                                .value = value,
                                .bound = bound,
                                .standard_error = standard_error,
                                .order = order,
                                .order_observed = !isnan(order)};
    return 0;
}

/* All sources that bear on a measure; those of the finest level are known. */
static int add_errors(struct contact_curve_maker *maker, const struct row *row, size_t model,
                      size_t level, struct curve *curve, struct error *err) {
    const struct contact_case *one_case = maker->one_case;
    bool finest = level + 1 == one_case->level_count;
    int status = 0;
    for (enum error_source s = 0; s < ERROR_SOURCES && status == 0; s++) {
        curve->errors[s].applies =
            contact_error_applies(maker->tally, row->measure, model, level, s);
        if (finest && contact_errors(maker->tally, row->measure, model, s, maker->errors))
            status = put_errors(maker, row->factor, maker->errors, &curve->errors[s], err);
    }
    return status;
}

static int append(struct contact_curve_maker *maker, const struct row *row, size_t model,
                  size_t level, struct error *err) {
    const struct contact_case *one_case = maker->one_case;
    struct curve curve =
        curve_of(one_case, model, level, row->quantity, "p/(E* h'_rms)", row->y_label);
    size_t n = one_case->load_count;
    double *x = result_numbers(maker->result, 4 * n), factor = row->factor;
    if (x == NULL)
        return no_room(err);
    double *y = x + n, *standard_error = y + n, *valueless = standard_error + n;
    if (row->measure == MEASURE_WORK)
        factor *= curve.points;
    for (size_t k = 0; k < n; k++) {
        size_t cell = contact_case_cell(one_case, model, level, k);
        struct estimate mean = contact_mean(maker->tally, row->measure, model, level, k);
        x[k] = one_case->loads[k];
        y[k] = factor * mean.value;
        standard_error[k] = factor * mean.standard_error;
        valueless[k] = (double)contact_tally_valueless(maker->tally, row->measure, cell);
    }
    curve.series = row->series != NULL ? row->series : "";
    curve_set_points(&curve, n, x, y, standard_error);
    if (row->measure == MEASURE_STIFFNESS || one_case->models[model]->may_fail)
        curve.valueless = valueless;
    add_theories(maker, row, &curve);
    int status = add_errors(maker, row, model, level, &curve, err);
    return status != 0 ? status : result_add_curve(maker->result, &curve, err);
}

/* Appends every level of a model, the finest first. */
static int append_model(struct contact_curve_maker *maker, const struct row *row, size_t model,
                        struct error *err) {
    int status = 0;
    for (size_t l = maker->one_case->level_count; l > 0 && status == 0; l--)
        status = append(maker, row, model, l - 1, err);
    return status;
}

static int append_rows(struct contact_curve_maker *maker, size_t count, const struct row *rows,
                       struct error *err) {
    int status = 0;
    for (size_t a = 0; a < count && status == 0; a++)
        for (size_t m = 0; m < maker->one_case->model_count && status == 0 &&
                           (rows[a].measure != MEASURE_STIFFNESS || maker->one_case->stiffness);
             m++)
            status = append_model(maker, &rows[a], m, err);
    return status;
}

static int append_areas(struct contact_curve_maker *maker, struct error *err) {
    static const struct row EDGES = {"contact_area", "edges", "A/A0", MEASURE_EDGES, 1};
    static const struct row NODES[] = {
        {"contact_area", "nodes", "A/A0", MEASURE_NODES, 1},
        {"contact_area", "nodes_lower", "A/A0", MEASURE_NODES_LOWER, 1},
        {"contact_area", "nodes_upper", "A/A0", MEASURE_NODES_UPPER, 1}};
    static const struct row STRETCHED = {"contact_area", "edges_stretched", "A/A0",
                                         MEASURE_EDGES_STRETCHED, 1};
    static const struct row PERIMETER = {"contact_area", "perimeter", "A/A0", MEASURE_PERIMETER, 1};
    const struct contact_case *one_case = maker->one_case;
    int status = append_rows(maker, one_case->edges ? 1 : 0, &EDGES, err);
    for (size_t m = 0; m < one_case->model_count && status == 0; m++)
        if (one_case->edges && contact_case_has_scale(one_case) &&
            !contact_case_stretches(one_case, m))
            status = append_model(maker, &STRETCHED, m, err);
    if (status == 0)
        status = append_rows(maker, one_case->nodes ? sizeof NODES / sizeof *NODES : 0, NODES, err);
    return status != 0 ? status : append_rows(maker, one_case->perimeter ? 1 : 0, &PERIMETER, err);
}

static int append_others(struct contact_curve_maker *maker, struct error *err) {
    const struct surface_case *own = &maker->one_case->surface;
    bool surface = own->dimension == 2;
    double waves = pow(surface_case_mean_side(own), own->dimension);
    const struct row rows[] = {
        {"mean_gap", NULL, "mean gap/sqrt(m0)", MEASURE_GAP, 1},
        {"stiffness", NULL, "K sqrt(m0)/(E* h'_rms)", MEASURE_STIFFNESS, 1},
        {"patch_count", "cell", "patches in the cell", MEASURE_PATCHES, 1},
        {"patch_count", "wave", surface ? "patches per lambda_l^2" : "patches per lambda_l",
         MEASURE_PATCHES, 1 / waves},
        {"patch_mean_area", NULL, "mean patch/cell", MEASURE_PATCH_MEAN, 1},
        {"patch_largest_area", NULL, "largest patch/cell", MEASURE_PATCH_LARGEST, 1},
        {"iterations", NULL, "iterations", MEASURE_ITERATIONS, 1},
        {"work", NULL, "points x transforms", MEASURE_WORK, 1}};
    return append_rows(maker, sizeof rows / sizeof *rows, rows, err);
}

/* Appends the curves that a model alone has. */
static int append_own(struct contact_curve_maker *maker, size_t m, struct error *err) {
    const struct contact_model *model = maker->one_case->models[m];
    int status = 0;
    for (size_t a = 0; a < model->curve_count && status == 0; a++) {
        const struct model_curve *own = &model->curves[a];
        enum contact_measure measure = (enum contact_measure)(MEASURE_OWN + own->measure);
        const struct row row = {own->quantity, NULL, own->y_label, measure, 1};
        status = append_model(maker, &row, m, err);
    }
    return status;
}

/* What the density of pressures, x and y of the curve, owes to its surfaces. */
static int put_generation(struct contact_curve_maker *maker, size_t model, size_t at,
                          struct curve *curve, struct error *err) {
    size_t n = curve->n;
    double *none = result_numbers(maker->result, 3 * n);
    if (none == NULL)
        return no_room(err);
    if (contact_generation_pressures(maker->tally, model, at, curve->x, curve->y, maker->errors,
                                     none + n, none + 2 * n))
        curve->errors[ERROR_GENERATION] = (struct curve_error){.applies = true,
                                                               .value = none,
                                                               .bound = none + n,
                                                               .standard_error = none + 2 * n,
                                                               .order = NAN};
    return 0;
}

/* Density over the nominal area: its integral is the fraction in contact by edges, its first moment
 * the load. Under- and overflow in undeformed areas of nodes. */
static int append_pressures(struct contact_curve_maker *maker, size_t model, size_t at,
                            struct error *err) {
    const struct contact_case *one_case = maker->one_case;
    const struct bins *bins = &one_case->pressure;
    size_t n = bins->count, finest = one_case->level_count - 1;
    double load = one_case->loads[one_case->pdf_loads[at]], width = bins_width(bins);
    double parts = (double)CONTACT_AREA_PARTS;
    size_t cell = contact_case_cell(one_case, model, finest, one_case->pdf_loads[at]);
    const uint64_t *count = maker->tally->pressures.count +
                            contact_tally_pressure_cell(maker->tally, model, finest, at);
    double *x = result_numbers(maker->result, 8 * n);
    struct estimate *shares = result_room(maker->result, 2 * n, sizeof *shares);
    if (x == NULL || shares == NULL)
        return no_room(err);
    double *y = x + n, *standard_error = y + n, *valueless = standard_error + n;
    double *pdf = valueless + n, *none = pdf + n, *bound = none + n, *chance = bound + n;
    contact_tally_pressure_shares(maker->tally, model, finest, at, shares);
    for (size_t b = 0; b < n; b++) {
        x[b] = bins_centre(bins, b);
        y[b] = shares[b].value / width;
        standard_error[b] = shares[b].standard_error / width;
        valueless[b] = (double)contact_tally_valueless(maker->tally, MEASURE_NODES, cell);
    }
    struct curve curve = curve_of(one_case, model, finest, "contact_pressure_pdf",
                                  "local p/(E* h'_rms)", "probability density");
    curve.pressure = load;
    for (enum error_source s = 0; s < ERROR_SOURCES; s++)
        curve.errors[s].applies =
            contact_error_applies(maker->tally, MEASURE_NODES, model, finest, s);
    if (contact_errors_pressures(maker->tally, model, at, shares, shares + n, bound, chance)) {
        curve.errors[ERROR_DISCRETISATION] = (struct curve_error){
            .applies = true, .value = none, .bound = bound, .standard_error = chance, .order = NAN};
    }
    curve_set_points(&curve, n, x, y, standard_error);
    if (contact_theory_pressures(one_case, maker->modes, load, pdf))
        curve.theories[curve.theory_count++] = (struct theory){"persson", pdf};
    if (one_case->models[model]->may_fail)
        curve.valueless = valueless;
    curve.counted = true;
    curve.underflow = (double)count[0] / parts;
    curve.overflow = (double)count[n + 1] / parts;
    int status = put_generation(maker, model, at, &curve, err);
    return status != 0 ? status : result_add_curve(maker->result, &curve, err);
}

int contact_curves(const struct contact_case *one_case, const struct modes *modes,
                   const struct moments *moments, const struct contact_tally *tally,
                   struct case_result *out, struct error *err) {
    struct contact_curve_maker maker = {
        .one_case = one_case, .modes = modes, .tally = tally, .result = out};
    maker.errors = result_room(out, one_case->load_count, sizeof *maker.errors);
    if (maker.errors == NULL)
        return no_room(err);
    int status = contact_theories_make(&maker.theories, one_case, modes, moments, out, err);
    if (status == 0)
        status = append_areas(&maker, err);
    if (status == 0)
        status = append_others(&maker, err);
    for (size_t m = 0; m < one_case->model_count && status == 0; m++)
        status = append_own(&maker, m, err);
    for (size_t m = 0; m < one_case->model_count; m++)
        for (size_t a = 0; a < one_case->pdf_count && status == 0; a++)
            status = append_pressures(&maker, m, a, err);
    return status;
}
