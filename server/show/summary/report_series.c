#include "server/show/summary/report_series.h"
#include "server/show/summary/summary_cells.h"
#include <math.h>
#include <string.h>

void errors_of(const struct curve_report *curve, double errors[ERROR_COLUMNS]) {
    errors[0] = curve != NULL ? curve->statistical : (double)NAN;
    for (int source = 0; source < ERROR_SOURCES; source++)
        errors[1 + source] = curve != NULL ? curve->errors[source] : (double)NAN;
    errors[TOTAL_COLUMN] = curve != NULL ? curve->total : (double)NAN;
    errors[LAW_COLUMN] = curve != NULL ? curve->law : (double)NAN;
}

static bool same_place(const struct curve *a, const struct curve *b) {
    return same_text(a->model, b->model) && same_text(a->kinematics, b->kinematics) &&
           same_text(a->series, b->series) && same_number(a->level, b->level);
}

static struct report_series *find_series(struct series_list *list, const struct curve *place) {
    for (size_t s = 0; s < list->count; s++)
        if (same_place(list->rows[s].place, place))
            return &list->rows[s];
    if (list->count == SERIES_MOST)
        return NULL;
    list->rows[list->count] = (struct report_series){.place = place};
    return &list->rows[list->count++];
}

static void add_curve(struct report_series *series, const struct case_report *one,
                      const struct curve_report *curve) {
    double errors[ERROR_COLUMNS];
    errors_of(curve, errors);
    series->cpu_seconds += curve->cpu_seconds;
    series->realisations += (double)one->about.realisations;
    series->valueless += fmax(curve->valueless, 0);
    series->cases++;
    for (size_t e = 0; e < ERROR_COLUMNS; e++)
        if (!isnan(errors[e])) {
            series->squares[e] += errors[e] * errors[e];
            series->known[e]++;
        }
}

void series_add_case(struct series_list *list, const struct case_report *one) {
    for (size_t a = 0; a < one->curve_count && one->main != NULL; a++) {
        const struct curve *place = &one->curves[a].place;
        if (strcmp(place->quantity, one->main->place.quantity) != 0 || place->model == NULL ||
            is_bracket(place->series))
            continue;
        struct report_series *series = find_series(list, place);
        if (series != NULL)
            add_curve(series, one, &one->curves[a]);
    }
}

double series_error(const struct report_series *series, size_t column) {
    return series->known[column] > 0 ? sqrt(series->squares[column] / (double)series->known[column])
                                     : (double)NAN;
}
