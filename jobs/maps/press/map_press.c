#include "jobs/maps/press/map_press.h"
#include "core/full/full.h"
#include "core/statistics/heights/roughness.h"
#include "core/statistics/summits/local_wave.h"
#include "jobs/clock.h"
#include "jobs/contact/model/model_linear.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define OWN(value) [PRESS_##value - PRESS_LOAD]
static const struct measure OWN_MEASURES[PRESS_VALUES - PRESS_LOAD] = {
    OWN(LOAD) = {.quantity = "load", .y_label = "p/(E* h'_rms)", .over = OVER_PRESSURE},
    OWN(PEAK) = {.quantity = "peak",
                 .y_label = "peak p/(E* h'_rms)",
                 .order = 1,
                 .solver = SOLVER_SMOOTH,
                 .field = FIELD_PRESSURE,
                 .over = OVER_PRESSURE},
    OWN(APPROACH) = {.quantity = "approach",
                     .y_label = "approach/sqrt(m0)",
                     .order = 2,
                     .solver = SOLVER_SMOOTH,
                     .field = FIELD_GAP,
                     .over = OVER_HEIGHT},
    OWN(CONTACT_NODES) = {.quantity = "contact_nodes", .y_label = "nodes in contact"},
    OWN(VIOLATION) = {.quantity = "violation", .y_label = "largest violation/sqrt(m0)"},
    OWN(BGT_COUNTED) = {.quantity = "asperity_area",
                        .series = "bgt_counted",
                        .y_label = "A/A0 of counted summits",
                        .over = OVER_AREA},
    OWN(GW_COUNTED) = {.quantity = "asperity_area",
                       .series = "gw_counted",
                       .y_label = "A/A0 of counted summits",
                       .over = OVER_AREA}};
#undef OWN

const struct measure *press_measure(size_t value) {
    return value < PRESS_LOAD ? measure_row(value) : &OWN_MEASURES[value - PRESS_LOAD];
}

const struct press_column PRESS_COLUMNS[PRESS_COLUMN_COUNT] = {
    {"p/(E* h')", "load", PRESS_LOAD, false, false},
    {"edges", "edges", MEASURE_EDGES, true, true},
    {"stretched", "edges_stretched", MEASURE_EDGES_STRETCHED, false, false},
    {"nodes", "nodes", MEASURE_NODES, false, false},
    {"lower", "nodes_lower", MEASURE_NODES_LOWER, false, false},
    {"upper", "nodes_upper", MEASURE_NODES_UPPER, false, false},
    {"perimeter", "perimeter", MEASURE_PERIMETER, false, false},
    {"plastic", "plastic_area", PLASTIC_AREA, false, true},
    {"plastic load", "plastic_load", PLASTIC_LOAD, false, true},
    {"peak", "peak", PRESS_PEAK, true, true},
    {"approach/rms", "approach", PRESS_APPROACH, false, true},
    {"gap/rms", "mean_gap", MEASURE_GAP, false, true},
    {"stiffness", "stiffness", MEASURE_STIFFNESS, false, false},
    {"tangential", "tangential_stiffness", FRICTION_MEASURE, false, false},
    {"left/rms", "permanent_approach", UNLOAD_APPROACH, false, true},
    {"conductance", "conductance", CONDUCTANCE_MEASURE, false, true},
    {"leak x", "leak_x", LEAK_ALONG_X, false, true},
    {"leak y", "leak_y", LEAK_ALONG_Y, false, true},
    {"patches", "patch_count", MEASURE_PATCHES, true, false},
    {"contact nodes", "contact_nodes", PRESS_CONTACT_NODES, false, false},
    {"iterations", "iterations", MEASURE_ITERATIONS, false, false},
    {"violation", "violation", PRESS_VIOLATION, false, false},
    {"bgt counted", "bgt_counted", PRESS_BGT_COUNTED, false, false},
    {"gw counted", "gw_counted", PRESS_GW_COUNTED, false, false}};

static const struct contact_model *model_of(const struct map_press *press) {
    return press->one_case.models[0];
}

void map_press_release(struct map_press *press) {
    contact_quantities_clear(&press->quantities);
    patch_finder_destroy(&press->patches);
    area_workspace_destroy(&press->areas);
    if (press->solver != NULL)
        model_of(press)->destroy(&press->solver);
    compliance_destroy(&press->compliance);
    press->state = (struct contact_state){0};
}

void map_press_clear(struct map_press *press) {
    map_press_release(press);
    counted_asperities_destroy(&press->asperities);
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

/* How far the summit rises above the highest point along an axis, and by how much more it may. */
struct rise {
    double by, most;
};

/* Returns the height above `here` at which the line that falls to `before` on one side meets the
 * one through the two points on the other side. */
static double lines_meet(double before, double here, double after, double beyond) {
    double up = here - before, down = after - beyond;
    double at = up + down > 0 ? (after + down - here) / (up + down) : 0;
    return at > 0 ? up * fmin(at, 1) : 0;
}

/* z: five heights along the axis, the highest in the middle. The parabola through three of them
 * has the summit of a smooth face, whose bend is alike at the next points; a face that bends at the
 * top alone is a cone there, and rises to where its sides meet. */
static struct rise rise_along(const double z[5]) {
    double bend = 2 * z[2] - z[1] - z[3], beside = z[1] + z[3] - (z[0] + z[2] + z[4] + z[2]) / 2;
    if (!(bend > 0))
        return (struct rise){0, 0};
    double sharp = fmin(fmax(1 - beside / bend, 0), 1);
    double cone = fmax(lines_meet(z[1], z[2], z[3], z[4]), lines_meet(z[3], z[2], z[1], z[0]));
    return (struct rise){(z[3] - z[1]) * (z[3] - z[1]) / (8 * bend), sharp * cone};
}

/* Adds what the axis says whose points are `step` apart, `count` of them; top is number `at` of
 * these. Within two points of a side of an open map there are too few. */
static void add_rise(const double *z, size_t top, size_t at, size_t count, size_t step, bool open,
                     struct rise *sum) {
    double five[5];
    if (count == 1 || (open && (at < 2 || at + 2 >= count)))
        return;
    for (size_t a = 0; a < 5; a++)
        five[a] = z[top - at * step + (at + a + count - 2) % count * step];
    struct rise along = rise_along(five);
    sum->by += along.by;
    sum->most += along.most;
}

/* Finds the rise of the summit above the highest point, of which the first counts. */
static void find_summit(struct map_press *press, const struct height_map *map, bool open) {
    const size_t nx = map->grid.nx, ny = map->grid.ny;
    struct rise sum = {0, 0};
    size_t top = 0;
    for (size_t p = 1; p < nx * ny; p++)
        top = map->z[p] > map->z[top] ? p : top;
    add_rise(map->z, top, top % nx, nx, 1, open, &sum);
    add_rise(map->z, top, top / nx, ny, nx, open, &sum);
    press->summit = sum.by;
    press->summit_unknown = sum.by + sum.most;
}

static int measure(struct map_press *press, const struct height_map *map, bool periodic,
                   struct error *err) {
    int status = periodic ? measure_periodic(press, map, err) : measure_open(press, map, err);
    if (status == 0 && !(press->slope > 0))
        return error_set(err, ERROR_INPUT, "the map is flat, so that no load has a meaning");
    return status;
}

static double tolerance_of(const struct press_block *asked) {
    if (asked->tolerance > 0)
        return asked->tolerance;
    return asked->model->tolerance > 0 ? asked->model->tolerance : CONTACT_DEFAULTS.tolerance;
}

/* Asks for what slips: where the flat slides along a path, or by lighter loads. */
static void ask_friction(struct contact_case *one_case, const struct map_press *press,
                         const struct press_block *asked) {
    one_case->friction = asked->friction;
    one_case->slip_pressing = asked->pressing;
    one_case->slip_angle = asked->angle;
    if (asked->slide != NULL) {
        one_case->slide = asked->slide;
        one_case->slide_count = asked->slide_count;
        one_case->slide_steps = asked->slide_steps;
        contact_quantities_ask(one_case, SLIDING_MEASURE);
        contact_quantities_ask(one_case, SLIDING_EDGES_MEASURE);
        return;
    }
    one_case->slip_measured = press->boundary != PRESS_OPEN && !grid_is_profile(&press->grid);
    one_case->unloads = asked->hardness > 0;
    contact_quantities_ask(one_case, FRICTION_MEASURE);
    if (asked->coupled)
        contact_quantities_ask(one_case, COUPLING_MEASURE);
}

struct contact_case map_press_case(const struct map_press *press, const struct grid *grid,
                                   const struct press_block *block) {
    const struct contact_model *model = block->model;
    double lengths = block->lengths > 0 ? block->lengths : model->default_height;
    struct contact_case out = {.surface = {.dimension = grid_is_profile(grid) ? 1 : 2,
                                           .spectrum = {.scale = SCALE_RMS_SLOPE}},
                               .two_faces = block->two_faces,
                               .model_count = 1,
                               .models = {model},
                               .blocks = {{.model = model->block,
                                           .poisson = block->poisson,
                                           .height = lengths * map_press_length(grid),
                                           .layer_growth = 1.1,
                                           .weighting = block->weighting,
                                           .coating = block->coating}},
                               .kinematics = block->kinematics,
                               .current_areas = block->current_areas,
                               .normal_gaps = block->normal_gaps,
                               .transition_depth = block->transition > 0 ? block->transition
                                                                         : FULL_DEFAULTS.transition,
                               .rms_slope = press->slope,
                               .rms_height = press->height,
                               .level_count = 1,
                               .levels = {{.grid = *grid, .stride = 1}},
                               .load_count = 1,
                               .nodes = true,
                               .edges = true,
                               .perimeter = true,
                               .stiffness = true,
                               .tangent = true,
                               .tolerance = tolerance_of(block)};
    if (block->hardness > 0) {
        out.yield = block->hardness;
        out.hardness = block->hardness / press->slope;
        contact_quantities_ask(&out, HARDNESS_MEASURE);
    }
    if (block->friction > 0)
        ask_friction(&out, press, block);
    if (out.unloads)
        contact_quantities_ask(&out, UNLOAD_MEASURE);
    if (block->conducts)
        contact_quantities_ask(&out, CONDUCTANCE_MEASURE);
    if (block->leaks)
        contact_quantities_ask(&out, LEAK_MEASURE);
    return out;
}

static int solver_create(struct map_press *press, struct error *err) {
    const struct contact_case *one_case = &press->one_case;
    const struct grid *grid = &press->grid;
    const bool open = press->boundary == PRESS_OPEN;
    int status = open ? compliance_create_open(&press->compliance, grid, one_case->blocks, err)
                      : compliance_create(&press->compliance, grid, one_case->blocks, err);
    if (status == 0)
        status = model_of(press)->create(&press->solver, one_case, 0, press->compliance, err);
    if (status == 0)
        status = area_workspace_create(&press->areas, press->compliance, err);
    if (status == 0)
        status = area_workspace_set_team(press->areas, press->team, err);
    if (status == 0 && model_of(press)->set_team != NULL)
        status = model_of(press)->set_team(press->solver, press->team, err);
    if (status == 0)
        status = patch_finder_create(&press->patches, grid, err);
    if (status == 0 && press->boundary != PRESS_PERIODIC)
        patch_finder_open(press->patches, press->map.nx, press->map.ny);
    const struct quantity_scene scene = {.one_case = one_case,
                                         .grid = *grid,
                                         .block = one_case->blocks[0],
                                         .exact = linear_is_exact(model_of(press)),
                                         .open = open,
                                         .slides = model_of(press)->slides};
    return status == 0 ? contact_quantities_create(&press->quantities, &scene, err) : status;
}

/* Writes "halfspace", or "a or b": the models that press a map that does not repeat. */
static void write_free_models(char *text, size_t size) {
    size_t used = 0;
    for (size_t m = 0; CONTACT_MODELS[m] != NULL && used < size; m++)
        if (CONTACT_MODELS[m]->free_space)
            used += (size_t)snprintf(text + used, size - used, "%s%s", used > 0 ? " or " : "",
                                     CONTACT_MODEL_CHOICES[m].name);
}

int map_press_check(enum press_boundary boundary, const struct contact_model *model,
                    struct error *err) {
    char others[80] = "";
    if (boundary != PRESS_OPEN || model->free_space)
        return 0;
    write_free_models(others, sizeof others);
    return error_set(err, ERROR_INPUT,
                     "the map does not repeat, and --model %s needs a block that does: "
                     "--boundary mirrored or periodic makes it one, or --model %s",
                     contact_model_name(model), others);
}

static int count_summits(struct map_press *press, const struct height_map *map, struct error *err) {
    int status = counted_asperities_create(&press->asperities, &map->grid,
                                           press->boundary == PRESS_OPEN, err);
    return status != 0 ? status
                       : counted_asperities_take(press->asperities, map->z, press->height,
                                                 press->slope, err);
}

int map_press_begin(struct map_press *press, struct height_map *map, enum press_boundary boundary,
                    struct error *err) {
    press->map = map->grid;
    press->boundary = boundary;
    press->copies = 1;
    int status = measure(press, map, boundary == PRESS_PERIODIC, err);
    if (status == 0 && boundary == PRESS_MIRRORED) {
        status = height_map_mirror(map, err);
        press->copies = grid_is_profile(&map->grid) ? 2 : 4;
    }
    press->grid = map->grid;
    if (status == 0)
        find_summit(press, map, boundary == PRESS_OPEN);
    return status == 0 && !grid_is_profile(&map->grid) ? count_summits(press, map, err) : status;
}

static int is_over(void *context) {
    const struct map_press *press = context;
    return press->seconds_most > 0 &&
           clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - press->began > press->seconds_most;
}

/* Adds what makes a face fit that cannot be meshed. */
static void advise(struct error *err) {
    struct error found = *err;
    error_fill(err, found.code,
               "%.300s; --filter S=LENGTH makes the map less steep, a larger --height the block "
               "higher",
               found.text);
}

int map_press_lift(struct map_press *press, const double *z, const struct press_block *block,
                   struct error *err) {
    double facts[MODEL_FACTS_MOST];
    const struct contact_model *model = block->model;
    int status = map_press_check(press->boundary, model, err);
    if (status == 0 && block->coupled && press->boundary == PRESS_OPEN)
        status = error_set(err, ERROR_INPUT,
                           "the map does not repeat, and slip is coupled in cells that do: "
                           "--boundary mirrored or periodic makes it one");
    if (status != 0)
        return status;
    map_press_release(press);
    press->began = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
    press->one_case = map_press_case(press, &press->grid, block);
    if (model->face_fits != NULL)
        status = model->face_fits(press->one_case.blocks, press->slope, press->height, err);
    if (status == 0)
        status = solver_create(press, err);
    if (status == 0) {
        status = model->begin(press->solver, z, is_over, press, facts, err);
        if (status == ERROR_INPUT && model->face_fits != NULL)
            advise(err);
    }
    press->full_contact = NAN;
    if (status == 0 && press->boundary != PRESS_OPEN && model->full_pressure != NULL)
        press->full_contact = model->full_pressure(press->solver);
    return status;
}

/* --- loads --- */

static double largest(size_t n, const double *p) {
    double most = 0;
    for (size_t i = 0; i < n; i++)
        most = fmax(most, p[i]);
    return most;
}

/* The factor from a measure of the cell that is pressed to that of the map. Patches are found in
 * the map alone, and their areas are over that of the cell. */
static double cell_factor(const struct map_press *press, enum measure_cell cell) {
    const double factors[CELL_KINDS] = {[CELL_SAME] = 1,
                                        [CELL_GROWS] = 1,
                                        [CELL_SHRINKS] = press->copies,
                                        [CELL_UNLIMITED] = press->copies,
                                        [CELL_POINT] = (double)grid_points(&press->grid)};
    return factors[cell];
}

static struct measure_context context_of(struct map_press *press) {
    return (struct measure_context){.one_case = &press->one_case,
                                    .area = press->areas,
                                    .finder = press->patches,
                                    .quantities = &press->quantities,
                                    .points = (double)grid_points(&press->grid),
                                    .rms_slope = press->slope,
                                    .rms_height = press->height,
                                    .scaled = true,
                                    .free_space = press->boundary == PRESS_OPEN};
}

static int measure_load(struct map_press *press, const struct contact_pressed *pressed,
                        double *value, struct error *err) {
    const struct measure_context context = context_of(press);
    const struct contact_state *state = &press->state;
    int status = contact_measure(&context, pressed, value, err);
    if (status != 0)
        return status;
    value[PRESS_VIOLATION] = value[MEASURE_VIOLATION];
    for (size_t m = 0; m < MEASURE_OWN; m++)
        value[m] *= cell_factor(press, measure_row(m)->cell);
    for (size_t m = 0; m < MODEL_MEASURES_MOST; m++)
        value[MEASURE_OWN + m] = pressed->own[m];
    value[PRESS_PEAK] = largest(grid_points(&press->grid), state->p) / press->slope;
    value[PRESS_APPROACH] = (state->approach + press->summit) / press->height;
    value[PRESS_CONTACT_NODES] = (double)state->nodes / press->copies;
    if (press->asperities != NULL && !contact_case_is_coated(&press->one_case)) {
        double load = value[PRESS_LOAD];
        value[PRESS_BGT_COUNTED] = counted_asperities_area(press->asperities, COUNTED_BGT, load);
        value[PRESS_GW_COUNTED] = counted_asperities_area(press->asperities, COUNTED_GW, load);
    }
    return 0;
}

/* Makes the row of a load without a solution. */
static void empty_row(const struct map_press *press, double pressure, struct press_row *row) {
    for (size_t v = 0; v < PRESS_VALUES; v++) {
        row->value[v] = NAN;
        for (size_t s = 0; s < ERROR_SOURCES; s++)
            row->error[s][v] = (struct press_error){NAN, NAN};
    }
    row->value[PRESS_LOAD] = pressure / press->slope;
}

int map_press_load(struct map_press *press, double pressure, struct press_row *row,
                   struct error *err) {
    struct contact_pressed pressed = contact_not_pressed();
    empty_row(press, pressure, row);
    int status = model_of(press)->press(press->solver, pressure, &pressed, err);
    if (status != 0)
        return status;
    press->state = pressed.state;
    return measure_load(press, &pressed, row->value, err);
}

/* What is made of all loads together: its values by measure and load, or point of the path. */
struct back_values {
    struct contact_case one_case; /* of all loads */
    size_t loads, stride;
    double *of; /* owned: [measure * stride + load] of all measures, and the loads behind */
};

static int take_values(struct back_values *values, const struct press_row *rows,
                       struct error *err) {
    const size_t stride = contact_case_slots(&values->one_case);
    const size_t count = (MEASURE_PAIRED + 1) * stride;
    values->stride = stride;
    values->of = array_create(count, sizeof *values->of);
    if (values->of == NULL)
        return error_memory(err, count * sizeof *values->of, "slip");
    values->one_case.loads = values->of + MEASURE_PAIRED * stride;
    for (size_t a = 0; a < count; a++)
        values->of[a] = NAN;
    for (size_t l = 0; l < values->loads; l++) {
        values->one_case.loads[l] = rows[l].value[PRESS_LOAD];
        for (size_t v = 0; v < MEASURE_PAIRED; v++)
            values->of[v * stride + l] = rows[l].value[v];
    }
    return 0;
}

/* Returns them to the rows of the loads, and those by sliding to those of the path. */
static void give_values(const struct back_values *values, struct press_series *series) {
    const struct press_row *last = &series->rows[values->loads - 1];
    for (size_t v = 0; v < MEASURE_PAIRED; v++) {
        bool slides = press_measure(v)->by == BY_SLIDING;
        for (size_t l = 0; l < values->loads; l++)
            series->rows[l].value[v] = slides ? NAN : values->of[v * values->stride + l];
        for (size_t i = 0; slides && series->slides != NULL && i < values->one_case.slide_count;
             i++)
            series->slides[i].value[v] = values->of[v * values->stride + i];
    }
    for (size_t i = 0; series->slides != NULL && i < values->one_case.slide_count; i++) {
        series->slides[i].value[PRESS_CONTACT_NODES] = last->value[PRESS_CONTACT_NODES];
        series->slides[i].value[MEASURE_PATCHES] = last->value[MEASURE_PATCHES];
    }
}

static int complete_loads(struct map_press *press, const double *z, size_t loads,
                          struct press_series *series, struct error *err) {
    struct measure_context context = context_of(press);
    struct back_values values = {.one_case = press->one_case, .loads = loads};
    values.one_case.load_count = loads;
    values.one_case.slip_load = loads - 1;
    int status = take_values(&values, series->rows, err);
    if (status != 0)
        return status;
    context.one_case = &values.one_case;
    context.stop = is_over;
    context.stop_context = press;
    status =
        contact_quantities_complete(&press->quantities, &context, z, values.stride, values.of, err);
    give_values(&values, series);
    free(values.of);
    return status;
}

/* Lets the loads fall again, and fills what is made of all loads together. */
static int press_back(struct map_press *press, const double *z, size_t loads,
                      const double *pressures, struct press_series *series, struct error *err) {
    const struct measure_context context = context_of(press);
    int status = 0;
    for (size_t l = loads - 1; press->one_case.unloads && l-- > 0 && status == 0;) {
        struct contact_pressed pressed = contact_not_pressed();
        status = model_of(press)->press(press->solver, pressures[l], &pressed, err);
        if (status == 0)
            contact_quantities_measure_falling(&press->one_case, &context, &pressed.state, 1,
                                               series->rows[l].value);
    }
    return status != 0 || !(press->one_case.friction > 0)
               ? status
               : complete_loads(press, z, loads, series, err);
}

static struct press_mesh mesh_of(const struct map_press *press) {
    if (model_of(press)->block_of == NULL || press->solver == NULL)
        return (struct press_mesh){0};
    const struct mesh *mesh = model_of(press)->block_of(press->solver).mesh;
    return (struct press_mesh){.nodes = mesh->nodes,
                               .elements = mesh->elements,
                               .layers = mesh->layers,
                               .slope = mesh->slope,
                               .quality = mesh->quality};
}

int map_press_loads(struct map_press *press, const double *z, size_t loads, const double *pressures,
                    struct press_series *series, struct error *err) {
    int status = map_press_lift(press, z, &series->block, err);
    series->height = press->one_case.blocks[0].height;
    series->tolerance = press->one_case.tolerance;
    series->full_contact = press->full_contact;
    if (status == 0)
        series->mesh = mesh_of(press);
    for (size_t i = 0; series->slides != NULL && i < series->block.slide_count; i++)
        empty_row(press, pressures[loads - 1], &series->slides[i]);
    for (size_t l = 0; l < loads; l++) {
        if (status == 0)
            status = map_press_load(press, pressures[l], &series->rows[l], err);
        if (status == 0 && press->watch != NULL)
            status = press->watch->solved(press->watch->context, press, l, err);
        if (status != 0)
            empty_row(press, pressures[l], &series->rows[l]);
    }
    if (status == 0)
        status = press_back(press, z, loads, pressures, series, err);
    return status == ERROR_STOPPED
               ? error_set(err, ERROR_STOPPED, "it took more than %g s of CPU time",
                           press->seconds_most)
               : status;
}

int map_press_step(const struct map_press *press, const double *z, double load, double modulus,
                   const char *length, struct contact_step *out, struct error *err) {
    const struct contact_step_order order = {.model = model_of(press),
                                             .solver = press->solver,
                                             .grid = press->map,
                                             .row = press->grid.nx,
                                             .z = z,
                                             .load = load,
                                             .unit = modulus > 0 ? 1 / modulus : press->slope,
                                             .unit_name = modulus > 0 ? "Pa" : "E* h'",
                                             .lengths =
                                                 *length != '\0' ? length : "the map's unit"};
    return contact_step_fill(out, &order, &press->state, err);
}
