#include "server/show/map/press_slip.h"
#include "schema/json/json.h"
#include "server/show/quantity.h"
#include "server/show/table/text_table.h"
#include <math.h>
#include <stdlib.h>

struct slip_column {
    const char *heading, *key, *quantity, *series;
    enum { SLIP_SHARE, SLIP_LENGTH, SLIP_WORK_DONE } kind;
};
static const struct slip_column SLIP_COLUMNS[] = {
    {"stick edges", "stick_edges", "stick_area", "edges", SLIP_SHARE},
    {"stick nodes", "stick_nodes", "stick_area", "nodes", SLIP_SHARE},
    {"coupled", "stick_coupled", "stick_area", "coupled", SLIP_SHARE},
    {"displacement", "tangential_displacement", "tangential_displacement", "", SLIP_LENGTH},
    {"coupled", "tangential_displacement_coupled", "tangential_displacement", "coupled",
     SLIP_LENGTH},
    {"contact coupled", "slip_contact_area", "slip_contact_area", "coupled", SLIP_SHARE},
    {"work a cycle", "slip_work", "slip_work", "", SLIP_WORK_DONE}};
static const struct slip_column SLIDING_COLUMNS[] = {
    {"Q/P", "force", "sliding_force", "", SLIP_SHARE},
    {"stick area", "stick_area", "sliding_stick_area", "", SLIP_SHARE},
    {"stick edges", "stick_edges", "sliding_stick_area", "edges", SLIP_SHARE},
    {"stick load", "stick_load", "sliding_stick_load", "", SLIP_SHARE},
    {"contact area", "contact_area", "sliding_contact_area", "", SLIP_SHARE},
    {"contact edges", "contact_edges", "sliding_contact_area", "edges", SLIP_SHARE},
    {"gap", "mean_gap", "sliding_gap", "", SLIP_LENGTH},
    {"work", "dissipation", "sliding_dissipation", "", SLIP_WORK_DONE}};
enum { SLIP_COLUMNS_MOST = 8 };

/* Both tables: by the share of the load of full slip, and by how far the flat slides. */
static const struct slip_table {
    const struct slip_column *columns;
    size_t count;
    const char *name, *x_key; /* in JSON */
    struct slip_column x;     /* what the columns run over */
} SLIP_TABLES[] = {{SLIP_COLUMNS,
                    sizeof SLIP_COLUMNS / sizeof *SLIP_COLUMNS,
                    "slip",
                    "share",
                    {.heading = "Q/(mu P)", .kind = SLIP_SHARE}},
                   {SLIDING_COLUMNS,
                    sizeof SLIDING_COLUMNS / sizeof *SLIDING_COLUMNS,
                    "sliding",
                    "slid",
                    {.heading = "slid", .kind = SLIP_LENGTH}}};

/* What is printed of one model. */
struct slipping {
    const struct press_report *report;
    const struct press_series *series;
    const struct slip_table *of;
};

static struct slipping slipping_of(const struct press_report *report,
                                   const struct press_series *series) {
    return (struct slipping){report, series, &SLIP_TABLES[series->slides != NULL ? 1 : 0]};
}

/* Returns NULL where the model has no such curve. */
static const struct curve *slip_curve(const struct slipping *slipping, size_t column) {
    const struct case_result *result = slipping->report->result;
    const struct slip_column *of = &slipping->of->columns[column];
    const char *model = contact_model_name(slipping->series->block.model);
    for (size_t c = 0; c < result->curve_count; c++)
        if (same_text(result->curves[c].quantity, of->quantity) &&
            same_text(result->curves[c].series, of->series) &&
            same_text(result->curves[c].model, model))
            return &result->curves[c];
    return NULL;
}

static double number_at(const double *numbers, size_t point) {
    return numbers != NULL ? numbers[point] : (double)NAN;
}

/* Returns the sum of the bounds of a value by all sources that are known; NaN: none is. */
static double bound_at(const struct curve *curve, size_t point) {
    double sum = NAN;
    for (size_t s = 0; s < ERROR_SOURCES; s++) {
        double own = fabs(number_at(curve->errors[s].value, point)) +
                     number_at(curve->errors[s].bound, point);
        if (!isnan(own))
            sum = isnan(sum) ? own : sum + own;
    }
    return sum;
}

/* Returns whether an error of some point is known. */
static bool has_bounds(const struct curve *curve) {
    for (size_t i = 0; i < curve->n; i++)
        if (!isnan(bound_at(curve, i)))
            return true;
    return false;
}

/* Returns the scale to SI units; 0: not known. */
static double slip_scale(const struct press_report *report, const struct slip_column *column) {
    const struct map_press *press = report->press;
    double length = report->metres ? press->height : 0;
    double work = length * report->map_area * press->slope * report->modulus;
    return column->kind == SLIP_LENGTH ? length : column->kind == SLIP_WORK_DONE ? work : 0;
}

/* Heads a column of so many numbers, with its unit where it is known; returns what they are
 * multiplied by. */
static double head_slip(struct text_table *table, const struct press_report *report,
                        const struct slip_column *column, size_t count, const double *numbers) {
    static const char *const BARE[] = {
        [SLIP_SHARE] = "", [SLIP_LENGTH] = "/rms", [SLIP_WORK_DONE] = "/(E* h' rms)"};
    bool profile = grid_is_profile(&report->press->map);
    const char *si = column->kind == SLIP_LENGTH ? "m" : profile ? "J/m" : "J";
    double scale = slip_scale(report, column), most = 0;
    char unit[24];
    if (!(scale > 0)) {
        table_cell(table, "%s%s", column->heading, BARE[column->kind]);
        return 1;
    }
    for (size_t i = 0; i < count; i++)
        most = fmax(most, fabs(numbers[i])); /* NaN: a point without a solution */
    scale /= unit_readable(si, scale * most, unit, sizeof unit);
    table_cell(table, "%s, %s", column->heading, unit);
    return scale;
}

/* The curves of what slips that a model has, NULL where it has none, with the scales of their
 * values, and whether errors of each are known. */
struct slip_curves {
    const struct curve *of[SLIP_COLUMNS_MOST], *first;
    double scales[SLIP_COLUMNS_MOST], x_scale;
    bool bounded[SLIP_COLUMNS_MOST], some;
};

static struct slip_curves slip_curves_of(const struct slipping *slipping) {
    struct slip_curves curves = {.x_scale = 1};
    for (size_t c = 0; c < slipping->of->count; c++) {
        curves.of[c] = slip_curve(slipping, c);
        curves.bounded[c] = curves.of[c] != NULL && has_bounds(curves.of[c]);
        curves.some = curves.some || curves.bounded[c];
        curves.first = curves.first != NULL ? curves.first : curves.of[c];
    }
    return curves;
}

static void head_slips(struct text_table *table, const struct slipping *slipping,
                       struct slip_curves *curves) {
    const struct slip_table *of = slipping->of;
    table->columns = 1;
    for (size_t c = 0; c < of->count; c++)
        table->columns += curves->of[c] != NULL ? 1 + curves->bounded[c] : 0;
    curves->x_scale =
        head_slip(table, slipping->report, &of->x, curves->first->n, curves->first->x);
    for (size_t c = 0; c < of->count; c++) {
        if (curves->of[c] != NULL)
            curves->scales[c] = head_slip(table, slipping->report, &of->columns[c],
                                          curves->of[c]->n, curves->of[c]->y);
        if (curves->bounded[c])
            table_cell(table, "+-");
    }
}

static void fill_slips(struct text_table *table, const struct slipping *slipping,
                       const struct slip_curves *curves, size_t point) {
    table_number(table, curves->first->x[point] * curves->x_scale);
    for (size_t c = 0; c < slipping->of->count; c++) {
        if (curves->of[c] != NULL)
            table_number(table, curves->of[c]->y[point] * curves->scales[c]);
        if (curves->bounded[c])
            table_cell(table, "%.2g", bound_at(curves->of[c], point) * curves->scales[c]);
    }
}

/* Says what is done under which load. */
static void print_what(FILE *file, const struct slipping *slipping,
                       const struct slip_curves *curves) {
    const struct press_block *block = &slipping->series->block;
    const struct map_press *press = slipping->report->press;
    const char *errors = curves->some ? "; +- errors that are known" : "";
    if (slipping->series->slides != NULL) {
        fprintf(file, "\nthe flat slides under p/(E* h') = %.4g, friction %.4g%s%s\n\n",
                curves->first->pressure, block->friction,
                block->pressing ? ", which acts while the map is pressed, too" : "", errors);
        return;
    }
    fprintf(file, "\ntangential load Q along %s under p/(E* h') = %.4g, friction %.4g%s\n\n",
            block->angle > 0 ? "y" : "x", curves->first->pressure, block->friction, errors);
    if (press->boundary == PRESS_OPEN && !grid_is_profile(&press->map))
        fprintf(file,
                "stiffness along the face over that across: %.4g, as where no direction has longer "
                "waves; else between %.4g and 1\n\n",
                (1 - block->poisson) / (1 - block->poisson / 2), 1 - block->poisson);
}

void press_slip_print(FILE *file, const struct press_report *report,
                      const struct press_series *series) {
    const struct slipping slipping = slipping_of(report, series);
    struct slip_curves curves = slip_curves_of(&slipping);
    struct text_table table = {0};
    if (curves.first == NULL || curves.first->n == 0)
        return;
    head_slips(&table, &slipping, &curves);
    for (size_t i = 0; i < curves.first->n; i++)
        fill_slips(&table, &slipping, &curves, i);
    print_what(file, &slipping, &curves);
    table_print(&table, file);
    table_clear(&table);
}

/* --- JSON --- */

/* Adds a curve and the sums of the bounds of its errors. */
static bool add_curve(cJSON *out, const char *name, const struct curve *curve) {
    char key[48];
    if (!cJSON_AddItemToObject(out, name, json_numbers(curve->y, curve->n)))
        return false;
    double *bounds = array_create(curve->n, sizeof *bounds);
    for (size_t i = 0; i < curve->n && bounds != NULL; i++)
        bounds[i] = bound_at(curve, i);
    snprintf(key, sizeof key, "%s_error", name);
    bool complete =
        bounds != NULL && cJSON_AddItemToObject(out, key, json_numbers(bounds, curve->n));
    free(bounds);
    return complete;
}

/* Adds what the friction is. */
static bool add_friction(cJSON *out, const struct slipping *slipping) {
    const struct press_block *block = &slipping->series->block;
    if (cJSON_AddNumberToObject(out, "friction", block->friction) == NULL)
        return false;
    if (slipping->series->slides != NULL)
        return cJSON_AddStringToObject(out, "pressing",
                                       block->pressing ? "frictional" : "frictionless") != NULL;
    return cJSON_AddStringToObject(out, "direction", block->angle > 0 ? "y" : "x") != NULL;
}

bool press_slip_add(cJSON *document, const struct press_report *report,
                    const struct press_series *series) {
    const struct slipping slipping = slipping_of(report, series);
    if (!(series->block.friction > 0))
        return true;
    cJSON *out = cJSON_AddObjectToObject(document, slipping.of->name);
    bool complete = out != NULL && add_friction(out, &slipping);
    for (size_t c = 0; c < slipping.of->count && complete; c++) {
        const struct curve *curve = slip_curve(&slipping, c);
        if (curve == NULL)
            continue;
        if (!cJSON_HasObjectItem(out, "load"))
            complete =
                cJSON_AddItemToObject(out, "load", json_number(curve->pressure)) &&
                cJSON_AddItemToObject(out, slipping.of->x_key, json_numbers(curve->x, curve->n));
        complete = complete && add_curve(out, slipping.of->columns[c].key, curve);
    }
    return complete;
}
