#include "core/map/height_map_npy.h"
#include <ctype.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static const char MAGIC[] = "\x93NUMPY";
enum { MAGIC_SIZE = 6, HEADER_MOST = 4096 };

static uint64_t little_endian(const char *at, size_t bytes) {
    uint64_t word = 0;
    for (size_t a = 0; a < bytes; a++)
        word |= (uint64_t)(unsigned char)at[a] << (8 * a);
    return word;
}

/* Text behind 'key': in the header's dictionary; NULL where it is not. */
static const char *value_behind(const char *header, const char *key) {
    const char *at = strstr(header, key);
    if (at == NULL)
        return NULL;
    at += strlen(key);
    while (*at == ' ')
        at++;
    if (*at++ != ':')
        return NULL;
    while (*at == ' ')
        at++;
    return at;
}

static const char *read_extent(const char *at, size_t *extent) {
    char *stop;
    while (*at == ' ')
        at++;
    if (!isdigit((unsigned char)*at))
        return NULL;
    unsigned long long value = strtoull(at, &stop, 10);
    *extent = value < SIZE_MAX ? (size_t)value : SIZE_MAX;
    while (*stop == ' ')
        stop++;
    return stop;
}

/* (n,) or (ny, nx), with an optional comma at the end. */
static bool read_shape(const char *at, size_t *ny, size_t *nx) {
    if (at == NULL || *at != '(' || (at = read_extent(at + 1, nx)) == NULL)
        return false;
    *ny = 1;
    if (*at == ')')
        return false; /* (n) is a number in Python */
    if (*at++ != ',')
        return false;
    while (*at == ' ')
        at++;
    if (*at == ')')
        return true;
    *ny = *nx;
    at = read_extent(at, nx);
    if (at != NULL && *at == ',')
        for (at++; *at == ' ';)
            at++;
    return at != NULL && *at == ')';
}

/* The header's text into header[HEADER_MOST], and where the data start. */
static int read_header(const char *data, size_t size, char *header, size_t *start,
                       struct error *err) {
    if (size < MAGIC_SIZE + 4 || memcmp(data, MAGIC, MAGIC_SIZE) != 0)
        return error_set(err, ERROR_INPUT,
                         "this is no npy file: its first bytes are not \\x93NUMPY");
    unsigned major = (unsigned char)data[MAGIC_SIZE];
    if (major < 1 || major > 2)
        return error_set(err, ERROR_INPUT, "npy version %u is not read, only 1 and 2", major);
    size_t field = major == 1 ? 2 : 4;
    *start = MAGIC_SIZE + 2 + field;
    size_t length = size >= *start ? (size_t)little_endian(data + MAGIC_SIZE + 2, field) : 0;
    if (length == 0 || length >= HEADER_MOST || length > size - *start)
        return error_set(err, ERROR_INPUT, "the npy header is cut short or longer than %d bytes",
                         HEADER_MOST);
    memcpy(header, data + *start, length);
    header[length] = '\0';
    *start += length;
    return 0;
}

static int read_heights(double *z, size_t n, const char *data, size_t width, struct error *err) {
    for (size_t a = 0; a < n; a++) {
        uint64_t bits = little_endian(data + a * width, width);
        if (width == 4) {
            uint32_t half = (uint32_t)bits;
            float single;
            memcpy(&single, &half, sizeof single);
            z[a] = (double)single;
        } else
            memcpy(&z[a], &bits, sizeof bits);
        if (isinf(z[a]))
            return error_set(err, ERROR_INPUT, "height %zu is not finite", a);
        if (isnan(z[a]))
            z[a] = NAN; /* one of many */
    }
    return 0;
}

int height_map_npy_parse(struct height_map *map, const char *data, size_t size, double dx,
                         struct error *err) {
    char header[HEADER_MOST];
    size_t start = 0, nx, ny;
    int status = read_header(data, size, header, &start, err);
    if (status != 0)
        return status;
    const char *type = value_behind(header, "'descr'");
    const char *order = value_behind(header, "'fortran_order'");
    if (type == NULL || (strncmp(type, "'<f8'", 5) != 0 && strncmp(type, "'<f4'", 5) != 0))
        return error_set(err, ERROR_INPUT, "the npy type must be '<f8' or '<f4', not %.20s",
                         type != NULL ? type : "absent");
    if (order == NULL || strncmp(order, "False", 5) != 0)
        return error_set(err, ERROR_INPUT, "the npy file must be in C order");
    if (!read_shape(value_behind(header, "'shape'"), &ny, &nx))
        return error_set(err, ERROR_INPUT, "the npy shape must be (n,) or (ny, nx)");
    status = height_map_shape(map, ny, nx, dx, err);
    if (status != 0)
        return status;
    size_t width = type[3] == '8' ? 8 : 4, n = nx * ny;
    if (size - start != n * width)
        return error_set(err, ERROR_INPUT,
                         "%zu by %zu heights take %zu bytes; the npy file has %zu", ny, nx,
                         n * width, size - start);
    map->z = array_create(n, sizeof *map->z);
    if (map->z == NULL)
        return error_memory(err, n * sizeof *map->z, "a height map");
    return read_heights(map->z, n, data + start, width, err);
}

void height_map_npy_write(FILE *file, const struct grid *grid, const double *z) {
    char header[128];
    int length =
        grid_is_profile(grid)
            ? snprintf(header, sizeof header,
                       "{'descr': '<f8', 'fortran_order': False, 'shape': (%zu,), }", grid->nx)
            : snprintf(header, sizeof header,
                       "{'descr': '<f8', 'fortran_order': False, 'shape': (%zu, %zu), }", grid->ny,
                       grid->nx);
    const int whole = 128 - MAGIC_SIZE - 4; /* header padded so that the data start at byte 128 */
    fwrite(MAGIC, 1, MAGIC_SIZE, file);
    fwrite("\x01\x00", 1, 2, file);
    fputc(whole, file);
    fputc(0, file);
    fprintf(file, "%s%*s\n", header, whole - 1 - length, "");
    for (size_t a = 0; a < grid_points(grid); a++) {
        unsigned char word[8];
        uint64_t bits;
        memcpy(&bits, &z[a], sizeof bits);
        for (int b = 0; b < 8; b++)
            word[b] = (unsigned char)(bits >> (8 * b));
        fwrite(word, 1, sizeof word, file);
    }
}
