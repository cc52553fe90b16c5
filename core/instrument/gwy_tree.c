#include "core/instrument/gwy_tree.h"
#include "core/instrument/little_endian.h"

static void advance(struct gwy_span *span, size_t bytes) {
    span->at += bytes;
    span->size -= bytes;
}

static int ends_early(const struct gwy_span *rest, const char *name, const char *what,
                      struct error *err) {
    return error_set(err, ERROR_INPUT, "'%.60s' at byte %zu: %s does not fit into the file", name,
                     (size_t)(rest->at - rest->file), what);
}

/* A text that ends with 0. */
static int take_text(struct gwy_span *rest, const char *name, const char **out, struct error *err) {
    const char *stop = rest->size > 0 ? memchr(rest->at, 0, rest->size) : NULL;
    if (stop == NULL)
        return ends_early(rest, name, "a text", err);
    *out = rest->at;
    advance(rest, (size_t)(stop - rest->at) + 1);
    return 0;
}

static int take_count(struct gwy_span *rest, const char *name, size_t *out, struct error *err) {
    if (rest->size < 4)
        return ends_early(rest, name, "a count", err);
    *out = (size_t)little_integer(rest->at, 4);
    advance(rest, 4);
    return 0;
}

int gwy_object(struct gwy_span *rest, struct gwy_component *out, struct error *err) {
    const char *name = out->name != NULL ? out->name : "the whole";
    size_t size;
    int status = take_text(rest, name, &out->kind, err);
    if (status == 0)
        status = take_count(rest, name, &size, err);
    if (status != 0)
        return status;
    if (size > rest->size)
        return error_set(err, ERROR_INPUT,
                         "'%.60s' at byte %zu: the object says %zu bytes, %zu are there; the file "
                         "is cut off or damaged",
                         name, (size_t)(rest->at - rest->file), size, rest->size);
    out->value = (struct gwy_span){rest->file, rest->at, size};
    advance(rest, size);
    return 0;
}

/* Bytes of a value of this type; 0 where that depends on the value or there is no such type. */
static size_t value_size(char type) {
    switch (type) {
    case 'b':
    case 'c':
    case 'C':
        return 1;
    case 'i':
    case 'I':
        return 4;
    case 'q':
    case 'Q':
    case 'd':
    case 'D':
        return 8;
    default:
        return 0;
    }
}

static int take_values(struct gwy_span *rest, struct gwy_component *out, struct error *err) {
    size_t size = value_size(out->type);
    if (out->count > rest->size / size)
        return error_set(err, ERROR_INPUT,
                         "'%.60s' at byte %zu: %zu values of %zu bytes, %zu bytes are there; the "
                         "file is cut off or damaged",
                         out->name, (size_t)(rest->at - rest->file), out->count, size, rest->size);
    out->value = (struct gwy_span){rest->file, rest->at, out->count * size};
    advance(rest, out->count * size);
    return 0;
}

/* An array of texts or of objects: each has at least a byte of the file. */
static int take_members(struct gwy_span *rest, struct gwy_component *out, struct error *err) {
    struct gwy_span whole = *rest;
    int status = 0;
    for (size_t member = 0; member < out->count && status == 0; member++) {
        struct gwy_component object = {.name = out->name};
        const char *text;
        status = out->type == 'O' ? gwy_object(rest, &object, err)
                                  : take_text(rest, out->name, &text, err);
    }
    whole.size -= rest->size;
    out->value = whole;
    return status;
}

static int take_string(struct gwy_span *rest, struct gwy_component *out, struct error *err) {
    const char *text;
    struct gwy_span whole = *rest;
    int status = take_text(rest, out->name, &text, err);
    whole.size -= rest->size;
    out->value = whole;
    return status;
}

int gwy_next(struct gwy_span *rest, struct gwy_component *out, struct error *err) {
    *out = (struct gwy_component){.count = 1};
    int status = take_text(rest, "a component", &out->name, err);
    if (status != 0)
        return status;
    if (rest->size < 1)
        return ends_early(rest, out->name, "a type", err);
    out->type = *rest->at;
    advance(rest, 1);
    if (out->type == '\0' || strchr("bciqdsoCIQDSO", out->type) == NULL)
        return error_set(err, ERROR_INPUT,
                         "'%.60s' at byte %zu: there is no type '%c'; allowed: one of bciqdso and "
                         "CIQDSO",
                         out->name, (size_t)(rest->at - rest->file) - 1, out->type);
    if (strchr("CIQDSO", out->type) != NULL)
        status = take_count(rest, out->name, &out->count, err);
    if (status != 0)
        return status;
    if (value_size(out->type) > 0)
        return take_values(rest, out, err);
    if (out->type == 's')
        return take_string(rest, out, err);
    return out->type == 'o' ? gwy_object(rest, out, err) : take_members(rest, out, err);
}

int gwy_find(struct gwy_span object, const char *name, char type, struct gwy_component *out,
             struct error *err) {
    *out = (struct gwy_component){0};
    while (object.size > 0) {
        struct gwy_component component;
        int status = gwy_next(&object, &component, err);
        if (status != 0)
            return status;
        if (component.type == type && strcmp(component.name, name) == 0)
            *out = component;
    }
    return 0;
}
