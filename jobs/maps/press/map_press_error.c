#include "jobs/maps/press/map_press_error.h"
#include "core/statistics/uncertainty/richardson.h"
#include "jobs/contact/companion/block_error.h"
#include "jobs/contact/contact_errors.h"
#include "jobs/contact/model/model_linear.h"
#include <math.h>
#include <stdlib.h>

enum { SIDE_LEAST = 16 };
/* The area of a linear model after the first order of sideways strain, less that of `full`, is
 * within the sum of these shares: of the area, which is what one mesh knows of edges; of the
 * strain's part; and of the area times the square of the RMS slope. Measured at slopes up to
 * STRAIN_SLOPE_MOST by tests/unit/jobs/maps/test_map_press_error.c. */
static const double STRAIN_MESH = 0.002, STRAIN_SHARE = 0.6, STRAIN_SQUARE = 0.4,
                    STRAIN_SLOPE_MOST = 0.5;

bool map_press_applies(size_t count, const struct press_series *series, size_t m, size_t value,
                       enum error_source source) {
    const struct contact_model *model = series[m].block.model;
    bool complete = true;
    if (value == MEASURE_EDGES_UNKNOWN || value == SLIDING_STICK_UNKNOWN ||
        (value >= MEASURE_PAIRED && value != PRESS_PEAK && value != PRESS_APPROACH))
        return false;
    for (size_t a = 0; CONTACT_MODELS[a] != NULL; a++)
        complete = complete && model->rank >= CONTACT_MODELS[a]->rank;
    for (size_t a = 0; a < count; a++)
        complete = complete && model->rank >= series[a].block.model->rank;
    const bool applies[ERROR_SOURCES] = {[ERROR_DISCRETISATION] = true,
                                         [ERROR_BLOCK] = isfinite(series[m].height),
                                         [ERROR_MODEL] = !complete,
                                         [ERROR_SOLVER] = true};
    return applies[source];
}

/* --- points of the map --- */

static bool side_thins(size_t count, bool periodic) {
    return count >= SIDE_LEAST && !(periodic && count % 2 == 1);
}

static bool thins(const struct map_press *press) {
    bool periodic = press->boundary == PRESS_PERIODIC;
    return side_thins(press->map.nx, periodic) &&
           (grid_is_profile(&press->map) || side_thins(press->map.ny, periodic));
}

/* Takes each point (step 1) or every second one (2) of the map as it was measured, which is the
 * first part of that pressed. */
static int take_points(struct height_map *out, const struct map_press *press,
                       const struct height_map *map, size_t step, struct error *err) {
    const struct grid *grid = &press->map;
    bool profile = grid_is_profile(grid);
    double apart = (double)step;
    size_t nx = (grid->nx + step - 1) / step, ny = profile ? 1 : (grid->ny + step - 1) / step;
    *out = (struct height_map){.grid = {nx, ny, apart * grid_dx(grid) * (double)nx,
                                        profile ? grid->ly : apart * grid_dy(grid) * (double)ny},
                               .z = array_create(nx * ny, sizeof *out->z)};
    if (out->z == NULL)
        return error_memory(err, nx * ny * sizeof *out->z, "points of the map");
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++)
            out->z[j * nx + i] = map->z[step * j * map->grid.nx + step * i];
    return 0;
}

static double area_of(const struct grid *grid) {
    return grid_is_profile(grid) ? grid->lx : grid->lx * grid->ly;
}

/* --- side solves --- */

/* One a model, one a layer, and the half-space. */
enum { SIDES_MOST = 2 * CONTACT_MODELS_MOST + 1 };
/* Blocks over the same or a coarser map, under the same forces. Each is pressed once, and its
 * values are over those of the map. */
struct sides {
    const struct map_press *press;
    struct height_map map; /* owned, as its contact; begun with the first block */
    struct map_press side;
    double wider; /* area of this map over that of the map */
    size_t loads;
    double *pressures; /* owned */
    double *slide;     /* owned: the path of the flat over the RMS height of this map; NULL: none */
    size_t count;
    struct press_series of[SIDES_MOST]; /* whose rows are owned, as their slides */
};

static void sides_clear(struct sides *sides) {
    for (size_t s = 0; s < sides->count; s++) {
        free(sides->of[s].rows);
        free(sides->of[s].slides);
    }
    free(sides->pressures);
    free(sides->slide);
    map_press_clear(&sides->side);
    height_map_clear(&sides->map);
}

/* A map that has no contact leaves errors unknown, which is no failure. */
static int forgive(int status) {
    return status == ERROR_INPUT || status == ERROR_NUMERIC || status == ERROR_STOPPED ? 0 : status;
}

/* Takes the map, or with a step of 2 every second point of it. */
static int sides_begin(struct sides *sides, const struct map_press *press,
                       const struct height_map *map, size_t step, size_t loads,
                       const double *pressures, struct error *err) {
    *sides = (struct sides){.press = press,
                            .side = {.team = press->team},
                            .loads = loads,
                            .pressures = array_create(loads, sizeof *sides->pressures)};
    if (sides->pressures == NULL)
        return error_memory(err, loads * sizeof *pressures, "errors of contact");
    int status = take_points(&sides->map, press, map, step, err);
    if (status == 0)
        status = map_press_begin(&sides->side, &sides->map, press->boundary, err);
    sides->wider = area_of(&sides->side.map) / area_of(&press->map);
    for (size_t l = 0; l < loads; l++)
        sides->pressures[l] = pressures[l] / sides->wider;
    return status;
}

static void convert(const struct sides *sides, struct press_row *row) {
    double height = sides->side.height / sides->press->height;
    double pressure = sides->side.slope / sides->press->slope;
    const double factors[OVER_KINDS] = {[OVER_ONE] = 1,
                                        [OVER_AREA] = sides->wider,
                                        [OVER_PRESSURE] = pressure,
                                        [OVER_HEIGHT] = height,
                                        [OVER_STIFFNESS] = sides->wider * pressure / height,
                                        [OVER_WORK] = sides->wider * pressure * height};
    for (size_t v = 0; v < PRESS_VALUES; v++)
        row->value[v] *= factors[press_measure(v)->over];
}

/* Return how many rows a series has, and one of them: of loads, then of points of its path. */
static size_t rows_of(const struct press_series *series, size_t loads) {
    return loads + (series->slides != NULL ? series->block.slide_count : 0);
}

static struct press_row *row_at(const struct press_series *series, size_t loads, size_t row) {
    return row < loads ? &series->rows[row] : &series->slides[row - loads];
}

/* Lets a side slide along the path of a block, in lengths that are the same. */
static int take_slide(struct sides *sides, struct press_series *side, struct error *err) {
    struct press_block *block = &side->block;
    const size_t count = block->slide_count;
    const double *path = block->slide;
    if (path == NULL)
        return 0;
    if (sides->slide == NULL)
        sides->slide = array_create(count, sizeof *sides->slide);
    side->slides = array_create(count, sizeof *side->slides);
    if (sides->slide == NULL || side->slides == NULL)
        return error_memory(err, count * sizeof *side->slides, "errors of sliding");
    for (size_t i = 0; i < count; i++)
        sides->slide[i] = path[i] * (sides->press->height / sides->side.height);
    block->slide = sides->slide;
    return 0;
}

static int press_side(struct sides *sides, struct press_series *side, struct error *err) {
    /* as the loads themselves: other models take as long as they do */
    sides->side.seconds_most = side->block.model->may_fail ? sides->press->seconds_most : 0;
    int status =
        map_press_loads(&sides->side, sides->map.z, sides->loads, sides->pressures, side, err);
    map_press_release(&sides->side);
    for (size_t l = 0; l < rows_of(side, sides->loads); l++)
        convert(sides, row_at(side, sides->loads, l));
    return forgive(status);
}

/* Finds the side solve of a block, or makes it. The values of loads without a solution are NaN. */
static int side_of(struct sides *sides, const struct press_block *block,
                   const struct press_series **out, struct error *err) {
    size_t s = 0;
    while (s < sides->count && (sides->of[s].block.model != block->model ||
                                sides->of[s].block.lengths != block->lengths))
        s++;
    if (s == sides->count) {
        struct press_row *rows = array_create(sides->loads, sizeof *rows);
        if (rows == NULL)
            return error_memory(err, sides->loads * sizeof *rows, "errors of contact");
        sides->of[sides->count++] = (struct press_series){.block = *block, .rows = rows};
        int status = take_slide(sides, &sides->of[s], err);
        if (status == 0)
            status = press_side(sides, &sides->of[s], err);
        if (status != 0)
            return status;
    }
    *out = &sides->of[s];
    return 0;
}

/* --- the sources --- */

/* What the errors of all series are made from. */
struct errors {
    const struct map_press *press;
    const struct height_map *map;
    size_t count, loads;
    const struct press_series *series;
    const double *pressures;
    const struct press_series *coarse[CONTACT_MODELS_MOST]; /* by series; NULL: not known */
};

static bool applies(const struct errors *errors, size_t m, size_t value, enum error_source source) {
    return map_press_applies(errors->count, errors->series, m, value, source);
}

static void put(struct press_row *row, enum error_source source, size_t value, double error,
                double bound) {
    row->error[source][value] =
        isnan(bound) ? (struct press_error){NAN, NAN} : (struct press_error){error, bound};
}

static void solver_errors(const struct errors *errors, size_t m) {
    const struct press_series *series = &errors->series[m];
    for (size_t l = 0; l < rows_of(series, errors->loads); l++)
        for (size_t v = 0; v < PRESS_VALUES; v++)
            if (applies(errors, m, v, ERROR_SOLVER)) {
                struct press_row *row = row_at(series, errors->loads, l);
                const double *value = row->value;
                double nodes = value[PRESS_CONTACT_NODES];
                const struct solver_counts of = {.tolerance = series->tolerance,
                                                 .nodes = nodes,
                                                 .open = (double)grid_points(&errors->press->map) -
                                                         nodes,
                                                 .patches = value[MEASURE_PATCHES]};
                put(row, ERROR_SOLVER, v, 0,
                    contact_errors_solver(press_measure(v)->solver, &of, value[v]));
            }
}

/* Returns the share of a value that no finer mesh takes away. */
static double floor_of(const struct errors *errors, size_t m, size_t value) {
    const struct contact_model *model = errors->series[m].block.model;
    return model->mesh_floor == NULL
               ? 0
               : model->mesh_floor(grid_is_profile(&errors->press->map) ? 1 : 2,
                                   press_measure(value)->field,
                                   errors->press->one_case.transition_depth);
}

/* Returns what the points do not know of a value whatever the coarser ones say: where edges are
 * that the law does not hold of, as of what sticks, and how high the summit is between the points.
 */
static double unknown_of(const struct errors *errors, const struct press_row *row, size_t value) {
    bool by_edges =
        value == MEASURE_EDGES || value == MEASURE_EDGES_STRETCHED || value == MEASURE_PERIMETER;
    return by_edges                          ? row->value[MEASURE_EDGES_UNKNOWN]
           : value == SLIDING_STICK_BY_EDGES ? row->value[SLIDING_STICK_UNKNOWN]
           : value == PRESS_APPROACH         ? errors->press->summit_unknown / errors->press->height
                                             : 0;
}

static void points_error(const struct errors *errors, size_t m) {
    const struct press_series *series = &errors->series[m];
    const size_t loads = errors->loads;
    for (size_t l = 0; l < rows_of(series, loads); l++) {
        const struct press_row *coarse = row_at(errors->coarse[m], loads, l);
        struct press_row *row = row_at(series, loads, l);
        for (size_t v = 0; v < PRESS_VALUES; v++)
            if (applies(errors, m, v, ERROR_DISCRETISATION))
                put(row, ERROR_DISCRETISATION, v, 0,
                    fabs(coarse->value[v] - row->value[v]) +
                        floor_of(errors, m, v) * fabs(row->value[v]) + unknown_of(errors, row, v));
    }
}

/* Fills the errors of a load; layer, half-space: NULL for a block that is practically infinite. */
static void block_errors_at(const struct errors *errors, size_t m, double bound,
                            const struct press_row *layer, const struct press_row *half_space,
                            struct press_row *row) {
    for (size_t v = 0; v < PRESS_VALUES; v++) {
        double y = row->value[v];
        struct contact_error error = {.value = NAN, .bound = NAN};
        if (!applies(errors, m, v, ERROR_BLOCK))
            continue;
        if (layer == NULL)
            error = block_error_high(y, bound);
        else
            error =
                block_error_low(y, layer->value[v],
                                (struct estimate){.value = layer->value[v] - half_space->value[v]});
        put(row, ERROR_BLOCK, v, error.value, error.bound);
    }
}

static double bound_of(const struct errors *errors, size_t m) {
    const struct grid *grid = &errors->press->grid;
    double longest = map_press_length(grid);
    const struct press_block *of = &errors->series[m].block;
    const struct block block = {
        .poisson = of->poisson, .height = errors->series[m].height, .coating = of->coating};
    return isfinite(block.height) ? block_bound(&block, longest) : 0;
}

/* Finds the contact of a block on the points of the map, which a series may have already. */
static int own_points(const struct errors *errors, struct sides *sides,
                      const struct press_block *block, const struct press_series **out,
                      struct error *err) {
    for (size_t m = 0; m < errors->count; m++)
        if (errors->series[m].block.model == block->model &&
            errors->series[m].height == block->lengths * map_press_length(&errors->press->grid)) {
            *out = &errors->series[m];
            return 0;
        }
    return side_of(sides, block, out, err);
}

/* Returns the first model of the table that presses exact layers; NULL: it has none. */
static const struct contact_model *exact_model(void) {
    size_t m = 0;
    while (CONTACT_MODELS[m] != NULL && !linear_is_exact(CONTACT_MODELS[m]))
        m++;
    return CONTACT_MODELS[m];
}

static int block_errors(const struct errors *errors, struct sides *sides, size_t m,
                        struct error *err) {
    const struct press_series *series = &errors->series[m];
    double bound = bound_of(errors, m);
    const struct press_series *layer = NULL, *half_space = NULL;
    bool low = block_is_low(bound);
    struct press_block exact = series->block;
    exact.model = exact_model();
    exact.slide = NULL; /* what a low block changes of sliding is not known */
    if (series->block.slide != NULL)
        exact.friction = 0;
    exact.lengths = exact.lengths > 0 ? exact.lengths : series->block.model->default_height;
    if (low && exact.model == NULL)
        return 0;
    int status = low ? own_points(errors, sides, &exact, &layer, err) : 0;
    exact.lengths = INFINITY;
    if (status == 0 && low)
        status = own_points(errors, sides, &exact, &half_space, err);
    for (size_t l = 0; l < errors->loads && status == 0; l++)
        block_errors_at(errors, m, bound, low ? &layer->rows[l] : NULL,
                        low ? &half_space->rows[l] : NULL, &series->rows[l]);
    for (size_t i = errors->loads; i < rows_of(series, errors->loads) && !low && status == 0; i++)
        block_errors_at(errors, m, bound, NULL, NULL, row_at(series, errors->loads, i));
    return status;
}

/* Of a linear model: the area less that after sideways strain, and what the first order leaves. */
static void strain_errors(const struct errors *errors, size_t m) {
    double slope = errors->press->slope;
    for (size_t l = 0; l < errors->loads; l++) {
        struct press_row *row = &errors->series[m].rows[l];
        double edges = row->value[MEASURE_EDGES], now = row->value[MEASURE_EDGES_STRETCHED];
        double rest = (STRAIN_MESH + STRAIN_SQUARE * slope * slope) * edges +
                      STRAIN_SHARE * fabs(edges - now);
        if (isnan(now) || slope > STRAIN_SLOPE_MOST)
            continue;
        put(row, ERROR_MODEL, MEASURE_EDGES, edges - now, rest);
        put(row, ERROR_MODEL, MEASURE_EDGES_STRETCHED, 0, rest);
    }
}

/* The difference to the most complete model in the limit of two meshes, as in studies. */
static void difference_errors(const struct errors *errors, size_t m, size_t complete) {
    const struct press_series *series = &errors->series[m];
    const size_t loads = errors->loads;
    if (errors->coarse[m] == NULL || errors->coarse[complete] == NULL)
        return;
    for (size_t l = 0; l < rows_of(series, loads); l++)
        for (size_t v = 0; v < PRESS_VALUES; v++) {
            if (!applies(errors, m, v, ERROR_MODEL))
                continue;
            struct press_row *row = row_at(series, loads, l);
            const struct press_row *coarse = row_at(errors->coarse[m], loads, l),
                                   *other = row_at(errors->coarse[complete], loads, l);
            double fine = row->value[v] - row_at(&errors->series[complete], loads, l)->value[v];
            const struct mesh_changes changes = {fine - (coarse->value[v] - other->value[v]), NAN,
                                                 2, NAN};
            struct mesh_error error = mesh_error(&changes, press_measure(v)->order);
            double floors = floor_of(errors, m, v) + floor_of(errors, complete, v);
            put(row, ERROR_MODEL, v, fine - error.error,
                error.bound + floors * fabs(row->value[v]));
        }
}

static size_t complete_of(size_t count, const struct press_series *series) {
    size_t complete = 0;
    for (size_t m = 1; m < count; m++)
        if (series[m].block.model->rank > series[complete].block.model->rank)
            complete = m;
    return complete;
}

/* Presses every second point. */
static int coarse_errors(struct errors *errors, struct sides *sides, struct error *err) {
    size_t complete = complete_of(errors->count, errors->series);
    int status =
        sides_begin(sides, errors->press, errors->map, 2, errors->loads, errors->pressures, err);
    for (size_t m = 0; m < errors->count && status == 0; m++) {
        status = side_of(sides, &errors->series[m].block, &errors->coarse[m], err);
        if (status == 0)
            points_error(errors, m);
    }
    for (size_t m = 0; m < errors->count && status == 0; m++)
        if (m != complete)
            difference_errors(errors, m, complete);
    return forgive(status);
}

/* Presses pairs of blocks, where some are low. */
static int all_block_errors(const struct errors *errors, struct sides *sides, struct error *err) {
    bool low = false;
    for (size_t m = 0; m < errors->count; m++)
        low = low || block_is_low(bound_of(errors, m));
    int status = low ? sides_begin(sides, errors->press, errors->map, 1, errors->loads,
                                   errors->pressures, err)
                     : 0;
    for (size_t m = 0; m < errors->count && status == 0; m++)
        status = block_errors(errors, sides, m, err);
    return forgive(status);
}

int map_press_error(const struct map_press *press, const struct height_map *map, size_t count,
                    const struct press_series *series, size_t loads, const double *pressures,
                    struct error *err) {
    struct errors errors = {.press = press,
                            .map = map,
                            .count = count,
                            .loads = loads,
                            .series = series,
                            .pressures = pressures};
    struct sides coarse = {.count = 0}, own = {.count = 0};
    for (size_t m = 0; m < count; m++)
        solver_errors(&errors, m);
    if (map_press_applies(count, series, complete_of(count, series), MEASURE_EDGES, ERROR_MODEL))
        strain_errors(&errors, complete_of(count, series));
    int status = thins(press) ? coarse_errors(&errors, &coarse, err) : 0;
    sides_clear(&coarse);
    if (status == 0)
        status = all_block_errors(&errors, &own, err);
    sides_clear(&own);
    return status;
}
