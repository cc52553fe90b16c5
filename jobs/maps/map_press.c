#include "jobs/maps/map_press.h"
#include "core/full/full.h"
#include "core/statistics/heights/roughness.h"
#include "core/statistics/summits/local_wave.h"
#include <math.h>
#include <stdio.h>

/* Labels of a study's measures stand in MEASURES. */
const struct press_column PRESS_COLUMNS[PRESS_VALUES] = {
    [PRESS_LOAD] = {"p/(E* h')", "load", "p/(E* h'_rms)", MEASURE_OWN, PRESS_PRESSURE, false},
    [PRESS_EDGES] = {"edges", "edges", NULL, MEASURE_EDGES, PRESS_SHARE, true},
    [PRESS_NODES] = {"nodes", "nodes", NULL, MEASURE_NODES, PRESS_SHARE, false},
    [PRESS_LOWER] = {"lower", "nodes_lower", NULL, MEASURE_NODES_LOWER, PRESS_SHARE, false},
    [PRESS_UPPER] = {"upper", "nodes_upper", NULL, MEASURE_NODES_UPPER, PRESS_SHARE, false},
    [PRESS_PERIMETER] = {"perimeter", "perimeter", NULL, MEASURE_PERIMETER, PRESS_SHARE, false},
    [PRESS_PEAK] = {"peak", "peak", "peak p/(E* h'_rms)", MEASURE_OWN, PRESS_PRESSURE, true},
    [PRESS_APPROACH] = {"approach/rms", "approach", "approach/sqrt(m0)", MEASURE_OWN, PRESS_LENGTH,
                        true},
    [PRESS_MEAN_GAP] = {"gap/rms", "mean_gap", NULL, MEASURE_GAP, PRESS_LENGTH, true},
    [PRESS_STIFFNESS] = {"stiffness", "stiffness", NULL, MEASURE_STIFFNESS, PRESS_NUMBER, false},
    [PRESS_PATCHES] = {"patches", "patch_count", NULL, MEASURE_PATCHES, PRESS_NUMBER, false},
    [PRESS_CONTACT_NODES] = {"contact nodes", "contact_nodes", "nodes in contact", MEASURE_OWN,
                             PRESS_NUMBER, false},
    [PRESS_ITERATIONS] = {"iterations", "iterations", NULL, MEASURE_ITERATIONS, PRESS_NUMBER,
                          false},
    [PRESS_VIOLATION] = {"violation", "violation", "largest violation/sqrt(m0)", MEASURE_VIOLATION,
                         PRESS_NUMBER, false}};

static const struct contact_model *model_of(const struct map_press *press) {
    return press->one_case.models[0];
}

void map_press_release(struct map_press *press) {
    patch_finder_destroy(&press->patches);
    area_workspace_destroy(&press->areas);
    if (press->solver != NULL)
        model_of(press)->destroy(&press->solver);
    compliance_destroy(&press->compliance);
    press->state = (struct contact_state){0};
}

void map_press_clear(struct map_press *press) {
    map_press_release(press);
    *press = (struct map_press){0};
}

/* Slopes of maps that do not repeat are those inside of them; maps too small for the polynomials
 * have those between their points. */
static int measure_open(struct map_press *press, const struct height_map *map, struct error *err) {
    const struct measured_map open = {&map->grid, map->z, BOUNDARY_OPEN};
    struct moments moments;
    struct roughness roughness;
    int status = local_moments_measure(&open, &moments, err);
    if (status != 0)
        return status;
    open_roughness_measure(&open, &roughness);
    press->slope = isfinite(moments.rms_slope) ? moments.rms_slope : roughness.rms_slope;
    press->height = roughness.rms_height;
    return 0;
}

static int measure_periodic(struct map_press *press, const struct height_map *map,
                            struct error *err) {
    struct moments moments;
    int status = roughness_spectral(&map->grid, map->z, &moments, err);
    if (status != 0)
        return status;
    press->slope = moments.rms_slope;
    press->height = moments.rms_height;
    return 0;
}

static int measure(struct map_press *press, const struct height_map *map, bool periodic,
                   struct error *err) {
    int status = periodic ? measure_periodic(press, map, err) : measure_open(press, map, err);
    if (status == 0 && !(press->slope > 0))
        return error_set(err, ERROR_INPUT, "the map is flat, so that no load has a meaning");
    return status;
}

/* The case of one load after the other, on one mesh, by one model. */
static void fill_case(struct map_press *press, const struct press_block *asked) {
    const struct contact_model *model = asked->model;
    double lengths = asked->lengths > 0 ? asked->lengths : model->default_height;
    press->one_case = (struct contact_case){
        .model_count = 1,
        .models = {model},
        .blocks = {{.model = model->block,
                    .poisson = asked->poisson,
                    .height = lengths * press->grid.lx,
                    .layer_growth = 1.1,
                    .weighting = GAP_STANDARD}},
        .kinematics = FULL_DEFAULTS.kinematics,
        .transition_depth = FULL_DEFAULTS.transition,
        .level_count = 1,
        .levels = {{.grid = press->grid, .stride = 1}},
        .load_count = 1,
        .nodes = true,
        .edges = true,
        .perimeter = true,
        .stiffness = true,
        .tolerance = model->tolerance > 0 ? model->tolerance : CONTACT_DEFAULTS.tolerance};
}

static int solver_create(struct map_press *press, bool open, struct error *err) {
    const struct contact_case *one_case = &press->one_case;
    const struct grid *grid = &press->grid;
    int status = open ? compliance_create_open(&press->compliance, grid, one_case->blocks, err)
                      : compliance_create(&press->compliance, grid, one_case->blocks, err);
    if (status == 0)
        status = model_of(press)->create(&press->solver, one_case, 0, press->compliance, err);
    if (status == 0)
        status = area_workspace_create(&press->areas, press->compliance, err);
    if (status == 0)
        status = patch_finder_create(&press->patches, grid, err);
    if (status == 0 && open)
        patch_finder_open(press->patches);
    return status;
}

/* Writes "halfspace", or "a or b": the models that press a map that does not repeat. */
static void write_free_models(char *text, size_t size) {
    size_t used = 0;
    for (size_t m = 0; CONTACT_MODELS[m] != NULL && used < size; m++)
        if (CONTACT_MODELS[m]->free_space)
            used += (size_t)snprintf(text + used, size - used, "%s%s", used > 0 ? " or " : "",
                                     CONTACT_MODEL_CHOICES[m].name);
}

static int refuse_open(const struct contact_model *model, struct error *err) {
    char others[80] = "";
    write_free_models(others, sizeof others);
    return error_set(err, ERROR_INPUT,
                     "the map does not repeat, and --model %s needs a block that does: "
                     "--boundary mirrored or periodic makes it one, or --model %s",
                     contact_model_name(model), others);
}

int map_press_begin(struct map_press *press, struct height_map *map,
                    const struct press_block *block, struct error *err) {
    const bool open = block->boundary == PRESS_OPEN;
    double facts[MODEL_FACTS_MOST];
    press->map = map->grid;
    press->copies = 1;
    if (open && !block->model->free_space)
        return refuse_open(block->model, err);
    int status = measure(press, map, block->boundary == PRESS_PERIODIC, err);
    if (status == 0 && block->boundary == PRESS_MIRRORED) {
        status = height_map_mirror(map, err);
        press->copies = grid_is_profile(&map->grid) ? 2 : 4;
    }
    press->grid = map->grid;
    fill_case(press, block);
    if (status == 0)
        status = solver_create(press, open, err);
    if (status == 0)
        status = block->model->begin(press->solver, map->z, NULL, NULL, facts, err);
    press->full_contact = NAN;
    if (status == 0 && !open && block->model->full_pressure != NULL)
        press->full_contact = block->model->full_pressure(press->solver);
    return status;
}

/* --- loads --- */

static double largest(size_t n, const double *p) {
    double most = 0;
    for (size_t i = 0; i < n; i++)
        most = fmax(most, p[i]);
    return most;
}

/* The factor from a measure of the cell that is pressed to that of the map. */
static double cell_factor(const struct map_press *press, enum measure_cell cell) {
    if (cell == CELL_POINT)
        return (double)grid_points(&press->grid);
    /* the largest patch of each copy is that of the map */
    return measure_factor(cell == CELL_UNLIMITED ? CELL_SHRINKS : cell, press->copies);
}

static void measure_load(struct map_press *press, const struct contact_pressed *pressed,
                         struct press_row *row) {
    const struct measure_context context = {.one_case = &press->one_case,
                                            .area = press->areas,
                                            .finder = press->patches,
                                            .points = (double)grid_points(&press->grid),
                                            .rms_slope = press->slope,
                                            .rms_height = press->height};
    const struct contact_state *state = &press->state;
    contact_measure(&context, pressed, row->measured);
    for (size_t m = 0; m < MEASURE_OWN; m++)
        row->measured[m] *= cell_factor(press, MEASURES[m].cell);
    for (size_t c = 0; c < PRESS_VALUES; c++)
        if (PRESS_COLUMNS[c].measure != MEASURE_OWN)
            row->value[c] = row->measured[PRESS_COLUMNS[c].measure];
    row->value[PRESS_PEAK] = largest(grid_points(&press->grid), state->p) / press->slope;
    row->value[PRESS_APPROACH] = state->approach / press->height;
    row->value[PRESS_CONTACT_NODES] = (double)state->nodes / press->copies;
}

int map_press_load(struct map_press *press, double pressure, struct press_row *row,
                   struct error *err) {
    struct contact_pressed pressed = {.stretch = 1, .open_stretch = NAN, .reached = NAN};
    for (size_t m = 0; m < MODEL_MEASURES_MOST; m++)
        pressed.own[m] = NAN;
    int status = model_of(press)->press(press->solver, pressure, &pressed, err);
    if (status != 0)
        return status;
    press->state = pressed.state;
    measure_load(press, &pressed, row);
    row->value[PRESS_LOAD] = pressure / press->slope;
    for (size_t c = 0; c < PRESS_VALUES; c++)
        row->error[c] = NAN;
    for (size_t m = 0; m < MODEL_MEASURES_MOST; m++)
        row->own[m] = pressed.own[m];
    return 0;
}

/* --- the result --- */

/* Returns the label of a measure of the map, which is the cell. */
static const char *label_of(const struct measure *measure, struct case_result *out) {
    return measure_label(measure, UNIT_CELL, 0, out);
}

/* Starts a curve over the loads, whose y the caller fills; its label is NULL for want of memory. */
static int curve_begin(struct case_result *out, const struct map_press *press, size_t loads,
                       const struct press_row *rows, struct curve *curve, double **y,
                       struct error *err) {
    double *x = result_numbers(out, 3 * loads);
    if (x == NULL || curve->y_label == NULL)
        return error_memory(err, 3 * loads * sizeof *x, "a curve of contact");
    *y = x + loads;
    for (size_t l = 0; l < loads; l++) {
        x[l] = rows[l].value[PRESS_LOAD];
        x[2 * loads + l] = NAN; /* one map has no statistical error */
    }
    curve->model = contact_model_name(model_of(press));
    curve->points = (double)grid_points(&press->grid);
    curve_set_points(curve, loads, x, *y, x + 2 * loads);
    return 0;
}

static int append_column(struct case_result *out, const struct map_press *press, size_t loads,
                         const struct press_row *rows, enum press_value value, struct error *err) {
    const struct press_column *column = &PRESS_COLUMNS[value];
    const struct measure *of = &MEASURES[column->measure];
    const bool studied = column->measure != MEASURE_OWN && of->quantity != NULL;
    const char *label = studied ? label_of(of, out) : column->y_label;
    struct curve curve = curve_named(studied ? of->quantity : column->key, "p/(E* h'_rms)", label);
    double *y = NULL;
    int status = curve_begin(out, press, loads, rows, &curve, &y, err);
    double *bound = status == 0 && column->uncertain ? result_numbers(out, 3 * loads) : NULL;
    if (status == 0 && column->uncertain && bound == NULL)
        status = error_memory(err, 3 * loads * sizeof *bound, "errors of contact");
    for (size_t l = 0; l < loads && status == 0; l++) {
        y[l] = rows[l].value[value];
        if (bound != NULL) {
            bound[l] = rows[l].error[value];
            bound[loads + l] = isnan(bound[l]) ? (double)NAN : 0;
            bound[2 * loads + l] = NAN;
        }
    }
    if (bound != NULL)
        curve.errors[ERROR_DISCRETISATION] =
            (struct curve_error){.applies = true,
                                 .value = bound + loads,
                                 .bound = bound,
                                 .standard_error = bound + 2 * loads,
                                 .order = NAN};
    if (studied)
        curve.series = of->series;
    return status == 0 ? result_add_curve(out, &curve, err) : status;
}

static bool is_column(enum contact_measure measure) {
    size_t c = 0;
    while (c < PRESS_VALUES && PRESS_COLUMNS[c].measure != measure)
        c++;
    return c < PRESS_VALUES;
}

/* A measure that studies show and that is no column. */
static int append_measure(struct case_result *out, const struct map_press *press, size_t loads,
                          const struct press_row *rows, enum contact_measure measure,
                          struct error *err) {
    const struct measure *of = &MEASURES[measure];
    double *y = NULL;
    if (of->quantity == NULL || is_column(measure) || !of->shown(&press->one_case, 0))
        return 0;
    struct curve curve = curve_named(of->quantity, "p/(E* h'_rms)", label_of(of, out));
    int status = curve_begin(out, press, loads, rows, &curve, &y, err);
    for (size_t l = 0; l < loads && status == 0; l++)
        y[l] = rows[l].measured[measure];
    curve.series = of->series;
    return status == 0 ? result_add_curve(out, &curve, err) : status;
}

static int append_own(struct case_result *out, const struct map_press *press, size_t loads,
                      const struct press_row *rows, const struct model_curve *own,
                      struct error *err) {
    struct curve curve = curve_named(own->quantity, "p/(E* h'_rms)", own->y_label);
    double *y = NULL;
    int status = curve_begin(out, press, loads, rows, &curve, &y, err);
    for (size_t l = 0; l < loads && status == 0; l++)
        y[l] = rows[l].own[own->measure];
    return status == 0 ? result_add_curve(out, &curve, err) : status;
}

int map_press_result(struct case_result *out, const struct map_press *press, size_t loads,
                     const struct press_row *rows, struct error *err) {
    const struct contact_model *model = model_of(press);
    int status = 0;
    out->realisations = 1;
    for (enum press_value c = 0; c < PRESS_VALUES && status == 0; c++)
        status = append_column(out, press, loads, rows, c, err);
    for (size_t m = 0; m < MEASURE_OWN && status == 0; m++)
        status = append_measure(out, press, loads, rows, MEASURE_CURVES[m], err);
    for (size_t c = 0; c < model->curve_count && status == 0; c++)
        status = append_own(out, press, loads, rows, &model->curves[c], err);
    return status;
}
