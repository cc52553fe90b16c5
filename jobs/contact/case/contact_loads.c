#include "jobs/contact/case/contact_loads.h"
#include "schema/json/field.h"
#include "schema/json/json.h"
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

double contact_load(double to, size_t k, size_t count) {
    char text[40];
    if (k + 1 == count)
        return to;
    /* The quotient is within 3.4e-16 of the decimal, and decimals of 15 digits are at least 1e-15
     * apart, both relative: so the nearest one is the decimal. */
    snprintf(text, sizeof text, "%.15g", to * (double)(k + 1) / (double)count);
    return strtod(text, NULL);
}

size_t contact_loads_turns(const double *turns, size_t count) {
    double before = 0, from = 0;
    for (size_t a = 0; a < count; a++) {
        if (turns[a] == from || (a > 0 && (turns[a] > from) == (from > before)))
            return a;
        before = from;
        from = turns[a];
    }
    return count;
}

void contact_loads_path(const double *turns, size_t count, size_t steps, double *path) {
    path[0] = 0;
    for (size_t a = 0; a < count; a++) {
        double from = a > 0 ? turns[a - 1] : 0;
        for (size_t k = 0; k < steps; k++)
            path[a * steps + k + 1] =
                k + 1 < steps ? from + contact_load(turns[a] - from, k, steps) : turns[a];
    }
}

static cJSON *list_of(double to, size_t count) {
    cJSON *list = cJSON_CreateArray();
    bool done = list != NULL;
    for (size_t k = 0; k < count && done; k++)
        done = list_put(list, cJSON_CreateNumber(contact_load(to, k, count)));
    return fields_finish(list, done);
}

/* Returns the object of that name, made where there is none. */
static cJSON *object_in(cJSON *parent, const char *name) {
    cJSON *object = cJSON_GetObjectItemCaseSensitive(parent, name);
    return object != NULL ? object : cJSON_AddObjectToObject(parent, name);
}

int contact_loads_fill(const cJSON *document, cJSON *parameters, struct error *err) {
    const char *unit = cJSON_GetStringValue(json_at(parameters, "/contact/pressures/unit"));
    if (json_at(parameters, "/contact/pressures/values") != NULL)
        return 0; /* with it "to" and "steps" are a fault of the case */
    if (unit != NULL && strcmp(unit, "Pa") == 0 &&
        json_at(parameters, "/contact/pressures/to") == NULL)
        return 0; /* likewise */
    double to = json_number_at(parameters, "/contact/pressures/to", CONTACT_LOAD_HIGHEST);
    double steps = json_number_at(parameters, "/contact/pressures/steps", CONTACT_LOADS);
    cJSON *contact = object_in(parameters, "contact");
    cJSON *pressures = contact != NULL ? object_in(contact, "pressures") : NULL;
    cJSON *list = pressures != NULL ? list_of(to, (size_t)steps) : NULL;
    if (!field_put(pressures, "values", list))
        return error_memory(err, (size_t)steps * sizeof to, "loads");
    cJSON_DeleteItemFromObjectCaseSensitive(pressures, "steps");
    if (!cJSON_IsArray(json_at(document, "/contact/pressures/to")))
        cJSON_DeleteItemFromObjectCaseSensitive(pressures, "to");
    return 0;
}

enum { TENTHS = 10, HALVES = 3 };
_Static_assert(TENTHS - 1 + HALVES + 1 == CONTACT_LOADS_ADDED, "tenths, halves and the held load");
/* A load of the study that is so near to one that would be added stands for it: in shares of the
 * held load, of a half, and rounding errors of a decimal. */
static const double NEAR = 0.02, NEAR_HALF = 0.3, ROUNDING = 1e-9;

/* Puts a load among rising ones, unless one is within `reach`; returns the position of that one or
 * its own. */
static size_t put_load(double *loads, size_t *count, double load, double reach) {
    size_t at = 0;
    for (size_t k = 0; k < *count; k++)
        if (fabs(loads[k] - load) <= reach)
            return k;
    while (at < *count && loads[at] < load)
        at++;
    memmove(loads + at + 1, loads + at, (*count - at) * sizeof *loads);
    loads[at] = load;
    (*count)++;
    return at;
}

size_t contact_loads_hold(double *loads, size_t *count, double held) {
    return put_load(loads, count, held, ROUNDING * held);
}

size_t contact_loads_add(double *loads, size_t *count, double held) {
    double load = held / TENTHS;
    for (size_t tenth = 1; tenth < TENTHS; tenth++)
        put_load(loads, count, contact_load(held, tenth - 1, TENTHS), NEAR * held);
    for (size_t half = 0; half < HALVES; half++) {
        load /= 2;
        put_load(loads, count, load, NEAR_HALF * load);
    }
    return contact_loads_hold(loads, count, held);
}
