#include "schema/result/result.h"
#include <cjson/cJSON.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#define SOURCE_KEYS(word)                                                                          \
    .name = (word), .key = word "_error", .bound_key = word "_bound",                              \
    .standard_error_key = word "_standard_error"
const struct error_source_row ERROR_SOURCE_ROWS[ERROR_SOURCES] = {
    [ERROR_DISCRETISATION] = {SOURCE_KEYS("discretisation"), .order_key = "discretisation_order",
                              .order_from_key = "discretisation_order_from"},
    [ERROR_CELL] = {SOURCE_KEYS("cell"), .bound_has_interval = true},
    [ERROR_BLOCK] = {SOURCE_KEYS("block")},
    [ERROR_MODEL] = {.name = "model",
                     .key = "model_error",
                     .bound_key = "model_bound",
                     .standard_error_key = "model_error_standard_error"},
    [ERROR_SOLVER] = {SOURCE_KEYS("solver")},
    [ERROR_MISSING] = {SOURCE_KEYS("missing")},
    [ERROR_PATCH] = {SOURCE_KEYS("patch"), .bound_has_interval = true},
};

bool error_is_unresolved(enum error_source source, double value, double bound,
                         double standard_error) {
    static const double DEVIATIONS = 1.96, MOST = 0.5;
    return ERROR_SOURCE_ROWS[source].bound_has_interval && value != 0 && fabs(value) <= bound &&
           DEVIATIONS * standard_error > MOST * bound;
}

const struct curve_attribute CURVE_ATTRIBUTES[CURVE_ATTRIBUTE_COUNT] = {
    {"series", offsetof(struct curve, series), ATTRIBUTE_TEXT, true, 1},
    {"model", offsetof(struct curve, model), ATTRIBUTE_TEXT, false, 2},
    {"level", offsetof(struct curve, level), ATTRIBUTE_NUMBER, false, 4},
    {"points", offsetof(struct curve, points), ATTRIBUTE_NUMBER, false, 0},
    {"kinematics", offsetof(struct curve, kinematics), ATTRIBUTE_TEXT, false, 3},
    {"pressure", offsetof(struct curve, pressure), ATTRIBUTE_NUMBER, true, 5},
};

const struct curve_attribute *curve_column(size_t n) {
    for (size_t a = 0; a < CURVE_ATTRIBUTE_COUNT; a++)
        if (CURVE_ATTRIBUTES[a].column == n + 1)
            return &CURVE_ATTRIBUTES[a];
    return NULL;
}

struct scalar scalar_named(const char *name, double value, double standard_error, double theory) {
    return (struct scalar){.name = name,
                           .value = value,
                           .standard_error = standard_error,
                           .theory = theory,
                           .grid = NAN,
                           .law_difference = NAN,
                           .law_standard_error = NAN};
}

struct curve curve_named(const char *quantity, const char *x_label, const char *y_label) {
    struct curve curve = {.quantity = quantity,
                          .x_label = x_label,
                          .y_label = y_label,
                          .series = "",
                          .level = NAN,
                          .points = NAN,
                          .pressure = NAN};
    for (size_t s = 0; s < ERROR_SOURCES; s++)
        curve.errors[s].order = NAN;
    return curve;
}

void curve_set_points(struct curve *curve, size_t n, const double *x, const double *y,
                      const double *standard_error) {
    curve->n = n;
    curve->x = x;
    curve->y = y;
    curve->standard_error = standard_error;
}

const char *curve_attribute_text(const struct curve *curve, const struct curve_attribute *row) {
    if (row->type != ATTRIBUTE_TEXT)
        return NULL;
    return *(const char *const *)((const char *)curve + row->offset);
}

double curve_attribute_number(const struct curve *curve, const struct curve_attribute *row) {
    if (row->type != ATTRIBUTE_NUMBER)
        return NAN;
    return *(const double *)((const char *)curve + row->offset);
}

void curve_set_attribute(struct curve *curve, const struct curve_attribute *row, const char *text,
                         double number) {
    if (row->type == ATTRIBUTE_TEXT)
        memcpy((char *)curve + row->offset, &text, sizeof text);
    else
        memcpy((char *)curve + row->offset, &number, sizeof number);
}

/* --- memory --- */

/* Arrays are cut from chunks; one that is larger than a chunk has a chunk of its own. */
enum { CHUNK_BYTES = 16384, ALIGNMENT = 16 };
struct chunk {
    struct chunk *next;
    size_t used, size;
    _Alignas(ALIGNMENT) unsigned char room[];
};
struct arena {
    struct chunk *first;
};

static struct chunk *chunk_add(struct arena *arena, size_t bytes) {
    size_t size = bytes > CHUNK_BYTES ? bytes : CHUNK_BYTES;
    if (size > SIZE_MAX - sizeof(struct chunk))
        return NULL;
    struct chunk *chunk = calloc(1, sizeof *chunk + size);
    if (chunk == NULL)
        return NULL;
    chunk->size = size;
    chunk->next = arena->first;
    arena->first = chunk;
    return chunk;
}

void *result_room(struct case_result *result, size_t count, size_t size) {
    if (size > 0 && count > (SIZE_MAX - ALIGNMENT) / size)
        return NULL;
    size_t bytes = (count * size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    if (result->arena == NULL)
        result->arena = array_create(1, sizeof *result->arena);
    if (result->arena == NULL)
        return NULL;
    struct chunk *chunk = result->arena->first;
    if (chunk == NULL || chunk->size - chunk->used < bytes)
        chunk = chunk_add(result->arena, bytes);
    if (chunk == NULL)
        return NULL;
    void *room = chunk->room + chunk->used;
    chunk->used += bytes;
    return room;
}

double *result_numbers(struct case_result *result, size_t n) {
    return result_room(result, n > 0 ? n : 1, sizeof(double));
}

const char *result_text(struct case_result *result, const char *text) {
    if (text == NULL)
        return NULL;
    size_t size = strlen(text) + 1;
    char *copy = result_room(result, size, 1);
    return copy != NULL ? memcpy(copy, text, size) : NULL;
}

void result_clear(struct case_result *result) {
    struct chunk *chunk = result->arena != NULL ? result->arena->first : NULL;
    while (chunk != NULL) {
        struct chunk *next = chunk->next;
        free(chunk);
        chunk = next;
    }
    free(result->arena);
    free(result->curves);
    free(result->scalars);
    *result = (struct case_result){0};
}

void study_result_clear(struct study_result *study) {
    for (size_t c = 0; c < study->case_count; c++)
        result_clear(&study->cases[c]);
    free(study->cases);
    free(study->id);
    free(study->name);
    free(study->kind);
    free(study->state);
    free(study->random);
    cJSON_Delete(study->swept);
    cJSON_Delete(study->provenance);
    *study = (struct study_result){0};
}

/* --- filling --- */

/* Returns the list with room for one more entry. It doubles at each power of two from 16 on. */
static void *list_grow(void *list, size_t count, size_t size) {
    if (count != 0 && (count < 16 || (count & (count - 1)) != 0))
        return list;
    size_t capacity = count == 0 ? 16 : 2 * count;
    return capacity > SIZE_MAX / size ? NULL : realloc(list, capacity * size);
}

bool curve_is_partial(const struct curve *curve) {
    return curve->valueless != NULL && (!curve->counted || curve->errors[ERROR_MISSING].applies);
}

int result_add_curve(struct case_result *result, const struct curve *curve, struct error *err) {
    struct curve *curves = list_grow(result->curves, result->curve_count, sizeof *curves);
    if (curves == NULL)
        return error_memory(err, sizeof *curves, "a curve");
    result->curves = curves;
    curves[result->curve_count++] = *curve;
    return 0;
}

int result_add_scalar(struct case_result *result, const struct scalar *scalar, struct error *err) {
    struct scalar *scalars = list_grow(result->scalars, result->scalar_count, sizeof *scalars);
    if (scalars == NULL)
        return error_memory(err, sizeof *scalars, "a scalar");
    result->scalars = scalars;
    scalars[result->scalar_count++] = *scalar;
    return 0;
}

void result_sampled(struct case_result *result, uint64_t realisations) {
    for (size_t a = 0; a < result->curve_count; a++)
        result->curves[a].sampled = realisations;
    for (size_t s = 0; s < result->scalar_count; s++)
        result->scalars[s].sampled = realisations;
}

void result_keep(struct case_result *result, const char *quantity, bool scalars_only) {
    size_t kept = 0;
    for (size_t a = 0; a < result->curve_count; a++)
        if (!scalars_only &&
            (quantity == NULL || strcmp(result->curves[a].quantity, quantity) == 0))
            result->curves[kept++] = result->curves[a];
    result->curve_count = kept;
}

/* --- finding --- */

const struct scalar *result_scalar(const struct case_result *result, const char *name) {
    for (size_t s = 0; s < result->scalar_count; s++)
        if (strcmp(result->scalars[s].name, name) == 0)
            return &result->scalars[s];
    return NULL;
}

const struct curve *result_curve(const struct case_result *result, const char *quantity) {
    for (size_t a = 0; a < result->curve_count; a++)
        if (strcmp(result->curves[a].quantity, quantity) == 0)
            return &result->curves[a];
    return NULL;
}

const struct result_parameter *result_parameter(const struct case_result *result,
                                                const char *pointer) {
    for (size_t p = 0; p < result->parameter_count; p++)
        if (strcmp(result->parameters[p].pointer, pointer) == 0)
            return &result->parameters[p];
    return NULL;
}

bool same_text(const char *a, const char *b) {
    return a == NULL || b == NULL ? a == b : strcmp(a, b) == 0;
}

bool same_number(double a, double b) {
    return a == b || (isnan(a) && isnan(b));
}

bool curve_same_series(const struct curve *a, const struct curve *b) {
    bool same = strcmp(a->quantity, b->quantity) == 0;
    for (size_t n = 0; n < CURVE_ATTRIBUTE_COUNT && same; n++) {
        const struct curve_attribute *row = &CURVE_ATTRIBUTES[n];
        if (row->separates_series)
            same = same_text(curve_attribute_text(a, row), curve_attribute_text(b, row)) &&
                   same_number(curve_attribute_number(a, row), curve_attribute_number(b, row));
    }
    return same;
}
