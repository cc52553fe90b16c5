#include "core/instrument/gwy_field.h"
#include "core/instrument/little_endian.h"

static int need(struct gwy_span object, const char *name, char type, struct gwy_component *out,
                struct error *err) {
    int status = gwy_find(object, name, type, out, err);
    if (status == 0 && out->name == NULL)
        status = error_set(err, ERROR_INPUT, "the data field has no '%s'", name);
    return status;
}

static int read_resolution(struct gwy_span object, const char *name, size_t *out,
                           struct error *err) {
    struct gwy_component found;
    int status = need(object, name, 'i', &found, err);
    if (status != 0)
        return status;
    uint64_t count = little_integer(found.value.at, 4);
    if (count < 1 || count > INT32_MAX)
        return error_set(err, ERROR_INPUT, "%s is %d; allowed: 1 and above", name,
                         (int)(int32_t)(uint32_t)count);
    *out = (size_t)count;
    return 0;
}

static int read_length(struct gwy_span object, const char *name, double *out, struct error *err) {
    struct gwy_component found;
    int status = need(object, name, 'd', &found, err);
    if (status == 0)
        *out = little_double(found.value.at);
    return status;
}

int gwy_unit_read(struct gwy_span object, const char *name, const char **out, struct error *err) {
    struct gwy_component unit, text = {0};
    int status = gwy_find(object, name, 'o', &unit, err);
    if (status == 0 && unit.name != NULL)
        status = gwy_find(unit.value, "unitstr", 's', &text, err);
    *out = status == 0 && text.name != NULL ? text.value.at : "";
    return status;
}

int gwy_field_read(struct gwy_span object, struct gwy_field *out, struct error *err) {
    struct gwy_component data;
    struct gwy_field field = {0};
    int status = read_resolution(object, "xres", &field.grid.nx, err);
    if (status == 0)
        status = read_resolution(object, "yres", &field.grid.ny, err);
    if (status == 0)
        status = read_length(object, "xreal", &field.grid.lx, err);
    if (status == 0)
        status = read_length(object, "yreal", &field.grid.ly, err);
    if (status == 0)
        status = gwy_unit_read(object, "si_unit_xy", &field.xy_unit, err);
    if (status == 0)
        status = gwy_unit_read(object, "si_unit_z", &field.z_unit, err);
    if (status == 0)
        status = need(object, "data", 'D', &data, err);
    if (status != 0)
        return status;
    if (data.count / field.grid.nx != field.grid.ny || data.count % field.grid.nx != 0)
        return error_set(err, ERROR_INPUT,
                         "xres %zu and yres %zu do not make the %zu numbers of "
                         "the data field",
                         field.grid.nx, field.grid.ny, data.count);
    field.numbers = data.value.at;
    *out = field;
    return 0;
}
