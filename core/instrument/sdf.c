/* Surface data files, SDF: ISO 25178-71, versions 1.0 and 2.0, and the proposal BCR 1.0. */
#include "core/instrument/formats.h"
#include "core/instrument/layers.h"
#include "core/instrument/sdf_header.h"
#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

const struct sdf_type SDF_TYPES[SDF_TYPE_COUNT] = {
    {"unsigned 8 bit", 1, 0, UINT8_MAX},        {"unsigned 16 bit", 2, 0, UINT16_MAX},
    {"unsigned 32 bit", 4, 0, UINT32_MAX},      {"float", 4, -FLT_MAX, FLT_MAX},
    {"signed 8 bit", 1, INT8_MIN, INT8_MAX},    {"signed 16 bit", 2, INT16_MIN, INT16_MAX},
    {"signed 32 bit", 4, INT32_MIN, INT32_MAX}, {"double", 8, -DBL_MAX, DBL_MAX},
};

static int check_scale(const char *name, double scale, struct error *err) {
    if (scale > 0 && isfinite(scale))
        return 0;
    return error_set(err, ERROR_INPUT, "%s is %g; allowed: metres above 0", name, scale);
}

int sdf_header_check(const struct sdf_header *header, struct height_map *map, struct error *err) {
    int status = height_map_shape(map, header->profiles, header->points, 1, err);
    if (status == 0)
        status = check_scale("Xscale", header->x_scale, err);
    if (status == 0 && header->profiles > 1) /* a profile has no use for it */
        status = check_scale("Yscale", header->y_scale, err);
    if (status == 0)
        status = check_scale("Zscale", header->z_scale, err);
    if (status == 0 && header->data_type >= SDF_TYPE_COUNT)
        status = error_set(err, ERROR_INPUT, "DataType is %u; allowed: 0 to 7", header->data_type);
    if (status != 0)
        return status;
    double y_scale = header->profiles > 1 ? header->y_scale : header->x_scale;
    map->grid.lx = header->x_scale * (double)header->points;
    map->grid.ly = y_scale * (double)header->profiles;
    memcpy(map->xy_unit, "m", 2);
    memcpy(map->z_unit, "m", 2);
    return grid_check(&map->grid, err);
}

bool sdf_is_hole(const struct sdf_header *header, double number) {
    const struct sdf_type *type = &SDF_TYPES[header->data_type];
    bool real = type->bytes == 8 || type->lowest == -FLT_MAX;
    if (isnan(number) || (type->lowest < 0 && number == type->lowest))
        return true;
    return number == type->highest && (real || header->bcr || type->lowest == 0);
}

static bool is_mark(const char *data, size_t size, char kind) {
    static const char *const NAMES[] = {"ISO-1.0", "ISO-2.0", "BCR-1.0", "BCR-0.0"};
    for (size_t name = 0; name < 4; name++)
        if (size >= 8 && data[0] == kind && memcmp(data + 1, NAMES[name], 7) == 0)
            return true;
    return false;
}

/* Any version is of this format; one that is not known is refused by its name. */
static bool owns(const char *data, size_t size) {
    return size >= 8 && (data[0] == 'a' || data[0] == 'b') &&
           (memcmp(data + 1, "ISO-", 4) == 0 || memcmp(data + 1, "BCR-", 4) == 0);
}

static int read_sdf(struct height_map *out, const char *data, size_t size,
                    const struct instrument_request *request, struct error *err) {
    struct height_map map = {0};
    int status;
    if (layer_check_only(request->layer, err) != 0)
        return ERROR_INPUT;
    if (is_mark(data, size, 'a'))
        status = sdf_text_read(&map, data, size, err);
    else if (is_mark(data, size, 'b'))
        status = sdf_binary_read(&map, data, size, err);
    else
        status = error_set(
            err, ERROR_INPUT,
            "this is no surface data file that is read: it begins with '%.8s'; "
            "allowed: aISO-1.0, bISO-1.0, aISO-2.0, bISO-2.0, aBCR-1.0, bBCR-1.0, aBCR-0.0",
            data);
    if (status == 0)
        *out = map;
    else
        height_map_clear(&map);
    return status;
}

const struct instrument_format INSTRUMENT_SDF = {"sdf", "sdf", owns, read_sdf};
