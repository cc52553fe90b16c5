#include "core/instrument/archive/x3p_layout.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { AXIS_FIELDS = X3P_AXIS_Y - X3P_AXIS_X };

static int read_length(double *out, const struct x3p_fields *fields, int field, double otherwise,
                       struct error *err) {
    const char *text = fields->text[field];
    char *stop;
    *out = otherwise;
    if (*text == '\0')
        return 0;
    *out = strtod(text, &stop);
    if (strspn(text, "+-.0123456789eE") != strlen(text) || *stop != '\0' || !isfinite(*out))
        return error_set(err, ERROR_INPUT, "%s is %.40s; allowed: finite numbers", X3P_PATHS[field],
                         text);
    return 0;
}

static int read_count(size_t *out, const struct x3p_fields *fields, int field, struct error *err) {
    const char *text = fields->text[field];
    char *stop;
    unsigned long long count = strtoull(text, &stop, 10);
    if (*text < '0' || *text > '9' || *stop != '\0' || count == 0 || count > (1ULL << 31))
        return error_set(err, ERROR_INPUT, "%s is '%.40s'; allowed: 1 to 2^31", X3P_PATHS[field],
                         text);
    *out = (size_t)count;
    return 0;
}

static size_t bytes_of(char type) {
    return type == 'I' ? 2 : type == 'L' || type == 'F' ? 4 : 8;
}

/* Reads the type of the numbers of an absolute axis. */
static int read_type(struct x3p_axis *axis, const struct x3p_fields *fields, int first,
                     struct error *err) {
    const int field = first + X3P_DATA_X - X3P_AXIS_X;
    const char *text = fields->text[field];
    if (strlen(text) != 1 || strchr("ILFD", *text) == NULL)
        return error_set(err, ERROR_INPUT,
                         "%s is '%.40s'; allowed: I, L, F and D (int16, int32, float32, float64)",
                         X3P_PATHS[field], text);
    axis->type = *text;
    axis->bytes = bytes_of(*text);
    return 0;
}

/* Reads increment and offset. Floating numbers are lengths by themselves; some programs write an
 * increment of 0 for them. */
static int read_scale(struct x3p_axis *axis, const struct x3p_fields *fields, int first,
                      struct error *err) {
    const int field = first + X3P_INCREMENT_X - X3P_AXIS_X;
    bool floating = axis->type == 'F' || axis->type == 'D';
    int status = read_length(&axis->increment, fields, field, 0, err);
    if (status == 0)
        status = read_length(&axis->offset, fields, first + X3P_OFFSET_X - X3P_AXIS_X, 0, err);
    if (status != 0)
        return status;
    if (floating && axis->increment == 0)
        axis->increment = 1;
    if (!(axis->increment > 0))
        return error_set(err, ERROR_INPUT, "%s is '%.40s'; allowed: above 0, in metres",
                         X3P_PATHS[field], fields->text[field]);
    return 0;
}

/* first: the field of its kind. An axis across a profile may have no increment. */
static int read_axis(struct x3p_axis *axis, const struct x3p_fields *fields, int first,
                     bool optional, struct error *err) {
    const char *kind = fields->text[first];
    int status = 0;
    *axis = (struct x3p_axis){0};
    if (strcmp(kind, "A") != 0 && strcmp(kind, "I") != 0)
        return error_set(err, ERROR_INPUT, "%s is '%.40s'; allowed: I and A", X3P_PATHS[first],
                         kind);
    axis->absolute = *kind == 'A';
    if (axis->absolute)
        status = read_type(axis, fields, first, err);
    else if (optional)
        return 0;
    if (status == 0)
        status = read_scale(axis, fields, first, err);
    return status;
}

static int read_axes(struct x3p_layout *layout, const struct x3p_fields *fields,
                     struct error *err) {
    for (int axis = 0; axis < X3P_AXES; axis++) {
        int first = X3P_AXIS_X + axis * AXIS_FIELDS;
        bool optional = axis == X3P_Y && layout->ny == 1 && !layout->list;
        int status = read_axis(&layout->axes[axis], fields, first, optional, err);
        if (status != 0)
            return status;
        layout->absolute += layout->axes[axis].absolute ? 1 : 0;
        layout->record += layout->axes[axis].bytes;
    }
    if (!layout->axes[X3P_Z].absolute)
        return error_set(err, ERROR_INPUT, "%s is I; allowed: A, heights are absolute",
                         X3P_PATHS[X3P_AXIS_Z]);
    if (layout->list && layout->absolute != X3P_AXES)
        return error_set(err, ERROR_INPUT,
                         "a list of points has an incremental axis; allowed: absolute ones");
    return 0;
}

/* Reads the counts of a matrix. SizeZ counts its layers, and may be absent where there is one. */
static int read_matrix(struct x3p_layout *layout, const struct x3p_fields *fields, size_t most,
                       struct error *err) {
    bool layered = *fields->text[X3P_SIZE_Z] != '\0';
    layout->layers = 1;
    int status = read_count(&layout->nx, fields, X3P_SIZE_X, err);
    if (status == 0)
        status = read_count(&layout->ny, fields, X3P_SIZE_Y, err);
    if (status == 0 && layered)
        status = read_count(&layout->layers, fields, X3P_SIZE_Z, err);
    if (status != 0)
        return status;
    if (layout->nx > most / layout->ny || layout->nx * layout->ny > most / layout->layers)
        return error_set(err, ERROR_INPUT,
                         "MatrixDimension says %zu x %zu x %zu points; the file has room for at "
                         "most %zu",
                         layout->nx, layout->ny, layout->layers, most);
    layout->n = layout->nx * layout->ny * layout->layers;
    return 0;
}

static int read_list(struct x3p_layout *layout, const struct x3p_fields *fields, size_t most,
                     struct error *err) {
    int status = read_count(&layout->n, fields, X3P_LIST, err);
    if (status == 0 && layout->n > most)
        status = error_set(err, ERROR_INPUT,
                           "ListDimension says %zu points; the file has room for at most %zu",
                           layout->n, most);
    layout->list = true;
    layout->nx = layout->n;
    layout->ny = layout->layers = 1;
    return status;
}

/* Checks that the kind of feature agrees with the counts. */
static int check_feature(const struct x3p_layout *layout, const struct x3p_fields *fields,
                         struct error *err) {
    const char *feature = fields->text[X3P_FEATURE];
    double down = 0;
    if (strcmp(feature, "SUR") != 0 && strcmp(feature, "PRF") != 0 && strcmp(feature, "PCL") != 0)
        return error_set(err, ERROR_INPUT, "Record1/FeatureType is '%.40s'; allowed: SUR, PRF, PCL",
                         feature);
    if (strcmp(feature, "PCL") == 0 && !layout->list)
        return error_set(err, ERROR_INPUT,
                         "a cloud of points (PCL) is a matrix; allowed: a list (ListDimension)");
    if (strcmp(feature, "PRF") == 0 && layout->ny != 1)
        return error_set(err, ERROR_INPUT, "a profile (PRF) has SizeY %zu; allowed: 1", layout->ny);
    int status = read_length(&down, fields, X3P_ROTATION_33, 1, err);
    if (status == 0 && down < 0)
        status =
            error_set(err, ERROR_INPUT,
                      "%s is %.40s: the rotation turns the surface upside down; allowed: 0 to 1",
                      X3P_PATHS[X3P_ROTATION_33], fields->text[X3P_ROTATION_33]);
    return status;
}

int x3p_layout_read(struct x3p_layout *out, const struct x3p_fields *fields, size_t most,
                    struct error *err) {
    struct x3p_layout layout = {0};
    bool list = *fields->text[X3P_LIST] != '\0';
    if (list && *fields->text[X3P_SIZE_X] != '\0')
        return error_set(err, ERROR_INPUT,
                         "Record3 has both a MatrixDimension and a ListDimension");
    int status =
        list ? read_list(&layout, fields, most, err) : read_matrix(&layout, fields, most, err);
    if (status == 0)
        status = read_axes(&layout, fields, err);
    if (status == 0)
        status = check_feature(&layout, fields, err);
    if (status == 0)
        *out = layout;
    return status;
}
