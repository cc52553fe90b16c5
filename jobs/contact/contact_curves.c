#include "jobs/contact/contact_curves.h"
#include "jobs/contact/contact_errors.h"
#include "jobs/contact/contact_theory.h"
#include <math.h>
#include <stdlib.h>

/* What all curves of a case are made from, and room for one at a time. */
struct workshop {
    const struct contact_case *study;
    const struct modes *modes;
    const struct contact_tally *tally;
    struct contact_theories theories;
    cJSON *curves;
    double *x, *y, *standard_error; /* owned: the larger of loads and bins, as all below */
    double *discretisation, *discretisation_error, *model, *model_error;
    double *valueless, *pdf;
};
enum { COLUMNS = 9 };

static void columns_of(struct workshop *shop, double **columns[COLUMNS]) {
    double **const all[COLUMNS] = {&shop->x,
                                   &shop->y,
                                   &shop->standard_error,
                                   &shop->discretisation,
                                   &shop->discretisation_error,
                                   &shop->model,
                                   &shop->model_error,
                                   &shop->valueless,
                                   &shop->pdf};
    for (size_t a = 0; a < COLUMNS; a++)
        columns[a] = all[a];
}

static int workshop_create(struct workshop *shop, const struct moments *moments,
                           struct error *err) {
    const struct contact_case *study = shop->study;
    size_t loads = study->load_count, bins = study->pressure.count;
    size_t rows = loads > bins ? loads : bins;
    double **columns[COLUMNS];
    columns_of(shop, columns);
    for (size_t a = 0; a < COLUMNS; a++) {
        *columns[a] = array_create(rows, sizeof(double));
        if (*columns[a] == NULL)
            return error_memory(err, rows * sizeof(double), "curves");
    }
    shop->curves = cJSON_CreateArray();
    if (shop->curves == NULL)
        return error_memory(err, sizeof(cJSON), "curves");
    return contact_theories_create(&shop->theories, study, shop->modes, moments, err);
}

static void workshop_clear(struct workshop *shop) {
    double **columns[COLUMNS];
    columns_of(shop, columns);
    for (size_t a = 0; a < COLUMNS; a++)
        free(*columns[a]);
    cJSON_Delete(shop->curves);
    contact_theories_clear(&shop->theories);
}

/* A curve over the loads. */
struct row {
    const char *quantity, *series, *y_label;
    enum contact_measure measure;
    double factor; /* y is so many times the measure */
};

/* Finest minus limit. */
static void put_discretisation(struct workshop *shop, const struct row *row, size_t model,
                               struct curve_errors *errors) {
    struct contact_extrapolation rule = contact_extrapolate(shop->tally, row->measure, model);
    double factor = rule.factor * row->factor;
    for (size_t k = 0; k < shop->study->load_count; k++) {
        struct estimate change = contact_tally_level(shop->tally, row->measure, model, k);
        shop->discretisation[k] = -factor * change.value;
        shop->discretisation_error[k] = factor * change.standard_error;
    }
    errors->discretisation = shop->discretisation;
    errors->discretisation_standard_error = shop->discretisation_error;
    errors->order = rule.order;
    errors->order_known = rule.observed;
}

/* Of a model against the most complete one, on the same realisations: of the limits where levels
 * tell them, or else of the finest level, whose own error is then in it. */
static void put_model(struct workshop *shop, const struct row *row, size_t model,
                      struct curve_errors *errors) {
    size_t complete = contact_case_complete(shop->study);
    bool limits = shop->study->level_count > 1;
    double factor = 0, best = 0;
    if (limits) {
        factor = contact_extrapolate(shop->tally, row->measure, model).factor;
        best = contact_extrapolate(shop->tally, row->measure, complete).factor;
    }
    for (size_t k = 0; k < shop->study->load_count; k++) {
        struct estimate difference = contact_tally_model(shop->tally, row->measure, model, k);
        double own = 0, other = 0;
        if (limits) {
            own = factor * contact_tally_level(shop->tally, row->measure, model, k).value;
            other = best * contact_tally_level(shop->tally, row->measure, complete, k).value;
        }
        shop->model[k] = row->factor * (difference.value + own - other);
        shop->model_error[k] = row->factor * difference.standard_error;
    }
    errors->model = shop->model;
    errors->model_standard_error = shop->model_error;
}

static const struct curve_theory *theories_of(const struct workshop *shop, const struct row *row) {
    switch (row->measure) {
    case MEASURE_NODES:
    case MEASURE_NODES_LOWER:
    case MEASURE_NODES_UPPER:
    case MEASURE_EDGES:
    case MEASURE_PERIMETER:
        return shop->theories.area;
    case MEASURE_GAP:
        return shop->theories.gap;
    default:
        return NULL;
    }
}

/* Of strain; NULL where there is nothing to choose. */
static const char *kinematics_of(const struct contact_case *study, size_t model) {
    const struct contact_model *of = study->models[model];
    return of->kinematics != NULL ? of->kinematics(study) : NULL;
}

static bool append(struct workshop *shop, const struct row *row, size_t model, size_t level) {
    const struct contact_case *study = shop->study;
    struct curve curve = {.quantity = row->quantity,
                          .series = row->series,
                          .model = study->models[model]->name,
                          .kinematics = kinematics_of(study, model),
                          .level = study->levels[level].points,
                          .points = (double)grid_points(&study->levels[level].grid),
                          .x_label = "p/(E* h'_rms)",
                          .y_label = row->y_label,
                          .n = study->load_count,
                          .x = study->loads,
                          .y = shop->y,
                          .standard_error = shop->standard_error};
    double factor = row->factor;
    if (row->measure == MEASURE_WORK)
        factor *= curve.points;
    for (size_t k = 0; k < study->load_count; k++) {
        size_t cell = contact_case_cell(study, model, level, k);
        struct estimate mean = contact_tally_mean(shop->tally, row->measure, cell);
        shop->y[k] = factor * mean.value;
        shop->standard_error[k] = factor * mean.standard_error;
        shop->valueless[k] = (double)contact_tally_valueless(shop->tally, row->measure, cell);
    }
    if (row->measure == MEASURE_STIFFNESS || study->models[model]->may_fail)
        curve.valueless = shop->valueless;
    const struct curve_theory *theories = theories_of(shop, row);
    for (size_t a = 0; theories != NULL && a < CURVE_THEORIES_MOST; a++)
        curve.theories[a] = theories[a];
    if (level + 1 == study->level_count && row->measure < MEASURE_PAIRED) {
        if (study->level_count > 1)
            put_discretisation(shop, row, model, &curve.errors);
        if (study->model_count > 1 && model != contact_case_complete(study))
            put_model(shop, row, model, &curve.errors);
    }
    return curve_append(shop->curves, &curve);
}

/* Every level of a model, the finest first. */
static bool append_model(struct workshop *shop, const struct row *row, size_t model) {
    bool done = true;
    for (size_t l = shop->study->level_count; l > 0 && done; l--)
        done = append(shop, row, model, l - 1);
    return done;
}

static bool append_row(struct workshop *shop, const struct row *row) {
    bool done = true;
    for (size_t m = 0; m < shop->study->model_count && done; m++)
        done = append_model(shop, row, m);
    return done;
}

static bool append_areas(struct workshop *shop) {
    static const struct row EDGES = {"contact_area", "edges", "A/A0", MEASURE_EDGES, 1};
    static const struct row NODES[] = {
        {"contact_area", "nodes", "A/A0", MEASURE_NODES, 1},
        {"contact_area", "nodes_lower", "A/A0", MEASURE_NODES_LOWER, 1},
        {"contact_area", "nodes_upper", "A/A0", MEASURE_NODES_UPPER, 1}};
    static const struct row PERIMETER = {"contact_area", "perimeter", "A/A0", MEASURE_PERIMETER, 1};
    const struct contact_case *study = shop->study;
    bool done = !study->edges || append_row(shop, &EDGES);
    for (size_t a = 0; a < sizeof NODES / sizeof *NODES && study->nodes && done; a++)
        done = append_row(shop, &NODES[a]);
    return done && (!study->perimeter || append_row(shop, &PERIMETER));
}

static bool append_others(struct workshop *shop) {
    bool surface = shop->study->surface.dimension == 2;
    double waves = pow(shop->study->surface.length_ratio, shop->study->surface.dimension);
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
    bool done = true;
    for (size_t a = 0; a < sizeof rows / sizeof *rows && done; a++)
        done = append_row(shop, &rows[a]);
    return done;
}

/* Curves that a model alone has. */
static bool append_own(struct workshop *shop, size_t m) {
    const struct contact_model *model = shop->study->models[m];
    bool done = true;
    for (size_t a = 0; a < model->curve_count && done; a++) {
        const struct model_curve *own = &model->curves[a];
        enum contact_measure measure = (enum contact_measure)(MEASURE_OWN + own->measure);
        const struct row row = {own->quantity, NULL, own->y_label, measure, 1};
        done = append_model(shop, &row, m);
    }
    return done;
}

/* Density over the nominal area: its integral is the fraction in contact, its first moment the
 * load. Under- and overflow in undeformed areas of nodes. */
static bool append_pressures(struct workshop *shop, size_t model, size_t at) {
    const struct contact_case *study = shop->study;
    const struct bins *bins = &study->pressure;
    double load = study->loads[study->pdf_loads[at]], width = bins_width(bins);
    double units = (double)contact_tally_units(study, model);
    size_t cell = contact_case_cell(study, model, study->level_count - 1, study->pdf_loads[at]);
    const uint64_t *count =
        shop->tally->pressures.count + contact_tally_pressure_cell(shop->tally, model, at);
    for (size_t b = 0; b < bins->count; b++) {
        struct estimate share = contact_tally_pressure(shop->tally, model, at, b + 1);
        shop->x[b] = bins_centre(bins, b);
        shop->y[b] = share.value / width;
        shop->standard_error[b] = share.standard_error / width;
        shop->valueless[b] = (double)contact_tally_valueless(shop->tally, MEASURE_NODES, cell);
    }
    bool theory = contact_theory_pressures(study, shop->modes, load, shop->pdf);
    return curve_append(
        shop->curves,
        &(struct curve){.quantity = "contact_pressure_pdf",
                        .model = study->models[model]->name,
                        .kinematics = kinematics_of(study, model),
                        .level = contact_case_finest(study)->points,
                        .points = (double)grid_points(&contact_case_finest(study)->grid),
                        .pressure = load,
                        .x_label = "local p/(E* h'_rms)",
                        .y_label = "probability density",
                        .n = bins->count,
                        .x = shop->x,
                        .y = shop->y,
                        .standard_error = shop->standard_error,
                        .theories = {{theory ? "persson" : NULL, shop->pdf}},
                        .valueless = study->models[model]->may_fail ? shop->valueless : NULL,
                        .counted = true,
                        .underflow = (double)count[0] / units,
                        .overflow = (double)count[bins->count + 1] / units});
}

static bool append_all(struct workshop *shop) {
    const struct contact_case *study = shop->study;
    bool done = append_areas(shop) && append_others(shop);
    for (size_t m = 0; m < study->model_count && done; m++)
        done = append_own(shop, m);
    for (size_t m = 0; m < study->model_count; m++)
        for (size_t a = 0; a < study->pdf_count && done; a++)
            done = append_pressures(shop, m, a);
    return done;
}

int contact_curves(const struct contact_case *study, const struct modes *modes,
                   const struct moments *moments, const struct contact_tally *tally, cJSON **out,
                   struct error *err) {
    struct workshop shop = {.study = study, .modes = modes, .tally = tally};
    int status = workshop_create(&shop, moments, err);
    if (status == 0 && !append_all(&shop))
        status = error_memory(err, contact_case_cells(study) * 10 * sizeof(cJSON), "curves");
    if (status == 0) {
        *out = shop.curves;
        shop.curves = NULL;
    }
    workshop_clear(&shop);
    return status;
}
