#include "core/instrument/little_endian.h"
#include "core/instrument/sdf_header.h"
#include <math.h>

/* Where the fields of the header begin: the mark, the maker and the two dates stand before them,
 * and version 2.0 has counts of 4 bytes. */
enum { COUNTS_AT = 42, VERSION_1_BYTES = 81, VERSION_2_BYTES = 85 };

static int check_plain(const char *name, unsigned char found, struct error *err) {
    if (found == 0)
        return 0;
    return error_set(err, ERROR_INPUT, "%s is %u; allowed: 0, the heights as they are", name,
                     (unsigned)found);
}

static int read_header(struct sdf_header *header, const char *data, size_t size, size_t *begin,
                       struct error *err) {
    size_t wide = data[5] == '2' ? 4 : 2;
    *begin = wide == 4 ? VERSION_2_BYTES : VERSION_1_BYTES;
    if (size < *begin)
        return error_set(err, ERROR_INPUT, "the file has %zu bytes, its header alone has %zu", size,
                         *begin);
    const char *at = data + COUNTS_AT + 2 * wide;
    *header = (struct sdf_header){.points = (size_t)little_integer(data + COUNTS_AT, wide),
                                  .profiles = (size_t)little_integer(data + COUNTS_AT + wide, wide),
                                  .x_scale = little_double(at),
                                  .y_scale = little_double(at + 8),
                                  .z_scale = little_double(at + 16),
                                  .data_type = (unsigned char)at[33],
                                  .bcr = data[1] == 'B'};
    int status = check_plain("Compression", (unsigned char)at[32], err);
    return status == 0 ? check_plain("CheckType", (unsigned char)at[34], err) : status;
}

/* Olympus's programs write two more words, always 5 and 1, behind the header of version 1.0. */
static bool has_more_header(const char *data, size_t size, size_t heights) {
    return data[1] == 'I' && data[5] == '1' && size == VERSION_1_BYTES + 8 + heights &&
           little_integer(data + VERSION_1_BYTES, 4) == 5 &&
           little_integer(data + VERSION_1_BYTES + 4, 4) == 1;
}

static double number_at(const char *at, unsigned type) {
    switch (type) {
    case 3:
        return (double)little_float(at);
    case 4:
        return (double)(int8_t)little_integer(at, 1);
    case 5:
        return (double)(int16_t)little_integer(at, 2);
    case 6:
        return (double)(int32_t)little_integer(at, 4);
    case 7:
        return little_double(at);
    default:
        return (double)little_integer(at, SDF_TYPES[type].bytes);
    }
}

int sdf_binary_read(struct height_map *map, const char *data, size_t size, struct error *err) {
    struct sdf_header header;
    size_t begin;
    int status = read_header(&header, data, size, &begin, err);
    if (status == 0)
        status = sdf_header_check(&header, map, err);
    if (status != 0)
        return status;
    size_t points = header.points * header.profiles, bytes = SDF_TYPES[header.data_type].bytes;
    if (points > (size - begin) / bytes)
        return error_set(err, ERROR_INPUT,
                         "%zu points in %zu profiles of %s need %zu bytes, %zu are there; the file "
                         "is cut off or its counts are wrong",
                         header.points, header.profiles, SDF_TYPES[header.data_type].name,
                         points * bytes, size - begin);
    if (has_more_header(data, size, points * bytes))
        begin += 8;
    map->z = array_create(points, sizeof *map->z);
    if (map->z == NULL)
        return error_memory(err, points * sizeof *map->z, "a height map");
    for (size_t point = 0; point < points; point++) {
        double number = number_at(data + begin + point * bytes, header.data_type);
        map->z[point] = sdf_is_hole(&header, number) ? NAN : number * header.z_scale;
        if (isinf(map->z[point]))
            return error_set(err, ERROR_INPUT,
                             "the height in profile %zu, point %zu is infinite; allowed: numbers, "
                             "and nan for holes",
                             point / header.points + 1, point % header.points + 1);
    }
    return 0;
}
