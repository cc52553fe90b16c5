#include "jobs/maps/press/map_press_curves.h"
#include "jobs/maps/press/map_press_error.h"
#include "jobs/notes.h"
#include <math.h>
#include <stdio.h>

/* What the curves are made from. */
struct curve_maker {
    const struct map_press *press;
    size_t count, loads;
    const struct press_series *series;
    struct case_result *out;
};

static int no_room(size_t points, struct error *err) {
    return error_memory(err, 3 * points * sizeof(double), "a curve of contact");
}

static bool by_slip(size_t value) {
    return press_measure(value)->by == BY_SLIP;
}

static bool by_sliding(size_t value) {
    return press_measure(value)->by == BY_SLIDING;
}

/* Return the number of points of a curve, 0 where the model has none, and the row of a point: by
 * slip loads fall from the one below the highest. */
static size_t points_of(const struct curve_maker *maker, size_t m, size_t value) {
    const struct press_series *series = &maker->series[m];
    if (by_sliding(value))
        return series->slides != NULL ? series->block.slide_count : 0;
    return maker->loads - (by_slip(value) ? 1 : 0);
}

static const struct press_row *row_of(const struct curve_maker *maker, size_t m, size_t value,
                                      size_t point) {
    const struct press_series *series = &maker->series[m];
    if (by_sliding(value))
        return &series->slides[point];
    return &series->rows[by_slip(value) ? maker->loads - 2 - point : point];
}

/* Returns what a curve runs over at a point. */
static double x_of(const struct curve_maker *maker, size_t m, size_t value, size_t point) {
    const struct press_series *series = &maker->series[m];
    const double highest = series->rows[maker->loads - 1].value[PRESS_LOAD];
    double load = row_of(maker, m, value, point)->value[PRESS_LOAD];
    const struct contact_case path = {.slide = series->block.slide,
                                      .slide_count = series->block.slide_count,
                                      .slide_steps = series->block.slide_steps};
    if (by_sliding(value))
        return contact_case_slid(&path, point);
    return by_slip(value) ? 1 - load / highest : load;
}

/* Adds an error that is known at some load. */
static int put_error(const struct curve_maker *maker, size_t m, size_t value,
                     enum error_source source, struct curve_error *out, struct error *err) {
    size_t known = 0, points = points_of(maker, m, value);
    out->applies = map_press_applies(maker->count, maker->series, m, value, source);
    out->order = NAN;
    for (size_t i = 0; i < points && out->applies; i++)
        known += isnan(row_of(maker, m, value, i)->error[source][value].bound) ? 0 : 1;
    if (known == 0)
        return 0;
    double *numbers = result_numbers(maker->out, 3 * points);
    if (numbers == NULL)
        return no_room(points, err);
    for (size_t i = 0; i < points; i++) {
        const struct press_row *row = row_of(maker, m, value, i);
        numbers[i] = row->error[source][value].value;
        numbers[points + i] = row->error[source][value].bound;
        numbers[2 * points + i] = NAN; /* one map has no statistical error */
    }
    out->value = numbers;
    out->bound = numbers + points;
    out->standard_error = numbers + 2 * points;
    return 0;
}

/* Appends a curve, whose label is NULL for want of memory. */
static int append(const struct curve_maker *maker, size_t m, size_t value, struct curve *curve,
                  struct error *err) {
    const struct press_series *series = &maker->series[m];
    const struct contact_model *model = series->block.model;
    const size_t points = points_of(maker, m, value);
    double *x = result_numbers(maker->out, 3 * points + 1);
    if (x == NULL || curve->y_label == NULL)
        return no_room(points, err);
    for (size_t i = 0; i < points; i++) {
        x[i] = x_of(maker, m, value, i);
        x[points + i] = row_of(maker, m, value, i)->value[value];
        x[2 * points + i] = NAN;
    }
    if (press_measure(value)->by != BY_LOAD)
        curve->pressure = series->rows[maker->loads - 1].value[PRESS_LOAD];
    curve->model = contact_model_name(model);
    if (model->kinematics != NULL)
        curve->kinematics = model->kinematics(&maker->press->one_case);
    curve->points = (double)grid_points(&maker->press->grid);
    curve_set_points(curve, points, x, x + points, x + 2 * points);
    int status = 0;
    for (enum error_source s = 0; s < ERROR_SOURCES && status == 0; s++)
        status = put_error(maker, m, value, s, &curve->errors[s], err);
    return status == 0 ? result_add_curve(maker->out, curve, err) : status;
}

/* Returns whether the model shows a value. */
static bool is_shown(const struct curve_maker *maker, size_t m, size_t value) {
    const struct measure *of = press_measure(value);
    struct contact_case one_case = maker->press->one_case;
    one_case.models[0] = maker->series[m].block.model;
    one_case.blocks[0].height = maker->series[m].height;
    if (by_sliding(value) && maker->series[m].slides == NULL)
        return false;
    return of->shown == NULL || of->shown(&one_case, 0);
}

static const char *const RUNS_OVER[] = {
    [BY_LOAD] = "p/(E* h'_rms)", [BY_SLIP] = "Q/(mu P)", [BY_SLIDING] = "sliding/sqrt(m0)"};

/* Appends a value of each model that shows it; its cell is the map. */
static int append_value(const struct curve_maker *maker, size_t value, struct error *err) {
    const struct measure *of = press_measure(value);
    const char *label = measure_label(of, UNIT_CELL, 0, maker->out);
    int status = 0;
    for (size_t m = 0; m < maker->count && status == 0; m++) {
        struct curve curve = curve_named(of->quantity, RUNS_OVER[of->by], label);
        if (of->series != NULL)
            curve.series = of->series;
        if (is_shown(maker, m, value))
            status = append(maker, m, value, &curve, err);
    }
    return status;
}

static bool is_column(size_t value) {
    size_t c = 0;
    while (c < PRESS_COLUMN_COUNT && PRESS_COLUMNS[c].value != value)
        c++;
    return c < PRESS_COLUMN_COUNT;
}

static int append_own(const struct curve_maker *maker, size_t m, struct error *err) {
    const struct contact_model *model = maker->series[m].block.model;
    int status = 0;
    for (size_t c = 0; c < model->curve_count && status == 0; c++) {
        const struct model_curve *own = &model->curves[c];
        struct curve curve = curve_named(own->quantity, "p/(E* h'_rms)", own->y_label);
        status = append(maker, m, MEASURE_OWN + own->measure, &curve, err);
    }
    return status;
}

/* Adds why models have no values, as notes on the one realisation. */
static int append_notes(const struct curve_maker *maker, struct error *err) {
    struct notes notes = {.count = 0};
    for (size_t m = 0; m < maker->count; m++) {
        const struct press_series *series = &maker->series[m];
        char text[NOTE_SIZE];
        if (series->note[0] == '\0')
            continue;
        snprintf(text, sizeof text, "model %.40s: %s", contact_model_name(series->block.model),
                 series->note);
        notes_add(&notes, 0, text);
    }
    return notes_result(&notes, maker->out, err);
}

/* What curves are over, in the units of the map. */
static int append_scales(const struct curve_maker *maker, struct error *err) {
    const struct scalar height = scalar_named("rms_height", maker->press->height, NAN, NAN);
    const struct scalar slope = scalar_named("rms_slope", maker->press->slope, NAN, NAN);
    int status = result_add_scalar(maker->out, &height, err);
    return status != 0 ? status : result_add_scalar(maker->out, &slope, err);
}

int map_press_result(struct case_result *out, const struct map_press *press, size_t count,
                     const struct press_series *series, size_t loads, struct error *err) {
    const struct curve_maker maker = {press, count, loads, series, out};
    int status = 0;
    out->realisations = 1;
    for (size_t c = 0; c < PRESS_COLUMN_COUNT && status == 0; c++)
        status = append_value(&maker, PRESS_COLUMNS[c].value, err);
    for (size_t a = 0; a < MEASURE_OWN && status == 0; a++)
        if (measure_row(MEASURE_CURVES[a])->quantity != NULL && !is_column(MEASURE_CURVES[a]))
            status = append_value(&maker, MEASURE_CURVES[a], err);
    for (size_t m = 0; m < count && status == 0; m++)
        status = append_own(&maker, m, err);
    if (status == 0)
        status = append_scales(&maker, err);
    return status == 0 ? append_notes(&maker, err) : status;
}

const struct curve *map_press_curve(const struct case_result *result,
                                    const struct press_column *column, const char *model) {
    const struct measure *of = press_measure(column->value);
    for (size_t c = 0; c < result->curve_count; c++) {
        const struct curve *curve = &result->curves[c];
        if (same_text(curve->quantity, of->quantity) && same_text(curve->model, model) &&
            same_text(curve->series, of->series != NULL ? of->series : ""))
            return curve;
    }
    return NULL;
}
