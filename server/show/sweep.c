#include "server/show/sweep.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

bool sweep_same(const struct case_result *a, const struct case_result *b, const char *pointer) {
    return parameter_same(result_parameter(a, pointer), result_parameter(b, pointer));
}

/* --- the parameters --- */

static bool is_named(const char *pointer, const char *name) {
    return strcmp(pointer, name) == 0 || strcmp(pointer + 1, name) == 0 ||
           strcmp(last_name(pointer), name) == 0;
}

/* Returns the pointer of a parameter: of those that are swept first. */
static const char *find_pointer(const struct shown_cases *shown, const char *name) {
    for (size_t n = 0; n < shown->varied_count; n++)
        if (is_named(shown->varied[n], name))
            return shown->varied[n];
    for (size_t c = 0; c < shown->count; c++)
        for (size_t p = 0; p < shown->list[c]->parameter_count; p++)
            if (is_named(shown->list[c]->parameters[p].pointer, name))
                return shown->list[c]->parameters[p].pointer;
    return NULL;
}

/* Returns NaN for a case without the parameter, or where it is a word. */
static double number_at(const struct case_result *one, const char *pointer) {
    const struct result_parameter *value = result_parameter(one, pointer);
    return value != NULL && value->text == NULL ? value->number : (double)NAN;
}

/* Counts the numbers that a parameter has in these cases. */
static size_t count_numbers(const struct shown_cases *shown, const char *pointer) {
    size_t count = 0;
    for (size_t c = 0; c < shown->count; c++) {
        double number = number_at(shown->list[c], pointer);
        bool met = isnan(number);
        for (size_t before = 0; before < c && !met; before++)
            met = number == number_at(shown->list[before], pointer);
        count += !met;
    }
    return count;
}

static int choose_x(struct sweep *sweep, const char *name, struct error *err) {
    const struct shown_cases *shown = &sweep->shown;
    size_t most = 1;
    if (name != NULL) {
        sweep->x = find_pointer(shown, name);
        if (sweep->x == NULL || count_numbers(shown, sweep->x) == 0)
            return error_set(err, ERROR_INPUT, "x: \"%.60s\" is no number of the study's cases",
                             name);
        return 0;
    }
    for (size_t n = 0; n < shown->varied_count; n++) {
        size_t numbers = count_numbers(shown, shown->varied[n]);
        if (numbers > most) {
            most = numbers;
            sweep->x = shown->varied[n];
        }
    }
    if (sweep->x == NULL)
        return error_set(err, ERROR_INPUT, "x: the study sweeps no number; name one of its cases");
    return 0;
}

static int choose_colour(struct sweep *sweep, const char *name, struct error *err) {
    const struct shown_cases *shown = &sweep->shown;
    if (name == NULL)
        return 0;
    for (size_t n = 0; n < shown->varied_count; n++)
        if (is_named(shown->varied[n], name) && strcmp(shown->varied[n], sweep->x) != 0)
            sweep->colour = shown->varied[n];
    if (sweep->colour == NULL)
        return error_set(err, ERROR_INPUT, "colour: \"%.60s\" is not swept beside %.60s", name,
                         last_name(sweep->x));
    return 0;
}

/* --- the points --- */

/* Returns whether two cases differ by nothing but x. */
static bool same_line(const struct sweep *sweep, const struct case_result *a,
                      const struct case_result *b) {
    for (size_t n = 0; n < sweep->shown.varied_count; n++)
        if (strcmp(sweep->shown.varied[n], sweep->x) != 0 &&
            !sweep_same(a, b, sweep->shown.varied[n]))
            return false;
    return true;
}

static void add_point(struct sweep *sweep, const struct case_result *one, const char *name) {
    const struct scalar *scalar = result_scalar(one, name);
    double x = number_at(one, sweep->x);
    if (scalar == NULL || !isfinite(scalar->value) || !isfinite(x)) {
        sweep->left_out++;
        return;
    }
    struct sweep_point *point = &sweep->points[sweep->count];
    *point = (struct sweep_point){one, scalar, x, sweep->line_count};
    for (size_t p = 0; p < sweep->count; p++)
        if (same_line(sweep, sweep->points[p].one, one)) {
            point->line = sweep->points[p].line;
            break;
        }
    sweep->line_count += point->line == sweep->line_count;
    sweep->count++;
}

static int compare(const void *a, const void *b) {
    const struct sweep_point *one = a, *other = b;
    if (one->line != other->line)
        return one->line < other->line ? -1 : 1;
    return (one->x > other->x) - (one->x < other->x);
}

int sweep_make(struct sweep *out, const struct study_result *study,
               const struct sweep_request *request, struct error *err) {
    *out = (struct sweep){.points = array_create(study->case_count, sizeof *out->points)};
    int status = 0;
    if (out->points == NULL || !shown_of_results(study, &out->shown))
        status = error_memory(err, study->case_count * sizeof *out->points, "a sweep");
    if (status == 0)
        status = choose_x(out, request->x, err);
    if (status == 0)
        status = choose_colour(out, request->colour, err);
    for (size_t c = 0; c < study->case_count && status == 0; c++)
        add_point(out, &study->cases[c], request->scalar);
    if (status == 0 && out->count == 0)
        status = error_set(err, ERROR_ABSENT, "no case has a value of \"%.60s\"", request->scalar);
    if (status == 0)
        qsort(out->points, out->count, sizeof *out->points, compare);
    else
        sweep_clear(out);
    return status;
}

void sweep_clear(struct sweep *sweep) {
    free(sweep->points);
    shown_clear(&sweep->shown);
    *sweep = (struct sweep){0};
}

const struct sweep_point *sweep_line(const struct sweep *sweep, size_t line, size_t *count) {
    size_t first = 0, end;
    while (first < sweep->count && sweep->points[first].line < line)
        first++;
    for (end = first; end < sweep->count && sweep->points[end].line == line;)
        end++;
    *count = end - first;
    return sweep->points + first;
}

void sweep_label(const struct sweep *sweep, const struct sweep_point *point, char *out,
                 size_t size) {
    size_t used = 0;
    *out = '\0';
    for (size_t n = 0; n < sweep->shown.varied_count && used < size; n++) {
        const char *pointer = sweep->shown.varied[n], *comma = used > 0 ? ", " : "";
        const struct result_parameter *value = result_parameter(point->one, pointer);
        if (value == NULL || strcmp(pointer, sweep->x) == 0)
            continue;
        int more = value->text != NULL
                       ? snprintf(out + used, size - used, "%s%s", comma, value->text)
                       : snprintf(out + used, size - used, "%s%s %.5g", comma, last_name(pointer),
                                  value->number);
        used += more > 0 ? (size_t)more : 0;
    }
}
