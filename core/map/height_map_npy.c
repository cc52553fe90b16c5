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

static uint64_t big_endian(const char *at, size_t bytes) {
    uint64_t word = 0;
    for (size_t a = 0; a < bytes; a++)
        word = word << 8 | (uint64_t)(unsigned char)at[a];
    return word;
}

/* Returns the text after 'key': in the header's dictionary, whose keys have quotes of either kind;
 * NULL where there is no such key. */
static const char *value_behind(const char *header, const char *key) {
    char single[32], twofold[32];
    snprintf(single, sizeof single, "'%s'", key);
    snprintf(twofold, sizeof twofold, "\"%s\"", key);
    const char *at = strstr(header, single);
    if (at == NULL)
        at = strstr(header, twofold);
    if (at == NULL)
        return NULL;
    at += strlen(single);
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

/* Reads (n,) or (ny, nx), with an optional comma at the end. */
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

/* Copies the header's text to header[HEADER_MOST], and finds where the data start. */
static int read_header(const char *data, size_t size, char *header, size_t *start,
                       struct error *err) {
    if (size < MAGIC_SIZE + 4 || memcmp(data, MAGIC, MAGIC_SIZE) != 0)
        return error_set(err, ERROR_INPUT,
                         "this is no npy file: its first bytes are not \\x93NUMPY");
    unsigned major = (unsigned char)data[MAGIC_SIZE];
    if (major < 1 || major > 3)
        return error_set(err, ERROR_INPUT, "npy version %u is not read; allowed: 1, 2 and 3",
                         major);
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

/* --- numbers --- */

/* Type of the words of a file: 'f', 'i' or 'u' of 1 to 8 bytes. */
struct word {
    char kind;
    size_t bytes;
    bool big_endian;
};

/* Reads '<f8' and the like, in quotes of either kind; = is the order of the machine that reads. */
static bool read_type(const char *at, struct word *word) {
    static const char KINDS[] = "f2 f4 f8 i1 i2 i4 i8 u1 u2 u4 u8";
    const uint16_t one = 1;
    char quote = *at;
    bool native_big = *(const unsigned char *)&one == 0;
    if ((quote != '\'' && quote != '"') || strchr("<>=|", at[1]) == NULL || at[1] == '\0')
        return false;
    const char name[3] = {at[2], at[2] != '\0' ? at[3] : '\0', '\0'};
    if (strlen(name) != 2 || strchr("fiu", name[0]) == NULL || strstr(KINDS, name) == NULL ||
        at[4] != quote)
        return false;
    *word = (struct word){name[0], (size_t)(name[1] - '0'), at[1] == '>'};
    word->big_endian = word->big_endian || (at[1] == '=' && native_big);
    return true;
}

/* IEEE 754 binary16. */
static double half_number(uint64_t bits) {
    int exponent = (int)(bits >> 10 & 31);
    double fraction = (double)(bits & 1023) / 1024, size;
    if (exponent == 31)
        size = fraction > 0 ? (double)NAN : (double)INFINITY;
    else
        size = exponent > 0 ? ldexp(1 + fraction, exponent - 15) : ldexp(fraction, -14);
    return (bits & 0x8000) != 0 ? -size : size;
}

static double float_number(uint64_t bits, size_t bytes) {
    const uint32_t low = (uint32_t)bits;
    float single;
    double number;
    if (bytes == 2)
        return half_number(bits);
    memcpy(&single, &low, sizeof single);
    memcpy(&number, &bits, sizeof number);
    return bytes == 4 ? (double)single : number;
}

static double read_word(const struct word *word, const char *at) {
    uint64_t bits = word->big_endian ? big_endian(at, word->bytes) : little_endian(at, word->bytes);
    if (word->kind == 'f')
        return float_number(bits, word->bytes);
    uint64_t sign = (uint64_t)0x80 << (8 * ((word->bytes - 1) & 7));
    if (word->kind == 'u' || (bits & sign) == 0)
        return (double)bits;
    return -(double)(sign - (bits & (sign - 1))); /* two's complement */
}

/* The words of the file run along rows, or along columns where it is in Fortran's order. */
static int read_heights(struct height_map *map, const char *data, const struct word *word,
                        bool fortran, struct error *err) {
    size_t nx = map->grid.nx, ny = map->grid.ny;
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++) {
            size_t at = fortran ? i * ny + j : j * nx + i;
            double z = read_word(word, data + at * word->bytes);
            if (isinf(z))
                return error_set(err, ERROR_INPUT,
                                 "row %zu, column %zu: the height is not finite; allowed: finite "
                                 "numbers, and NaN for holes",
                                 j + 1, i + 1);
            map->z[j * nx + i] = isnan(z) ? (double)NAN : z; /* one of many */
        }
    return 0;
}

/* Returns how much of a header the name of the type is, with its quotes; of a type of several
 * fields the beginning. */
static int type_length(const char *type) {
    enum { MOST = 20 };
    if (type == NULL || (*type != '\'' && *type != '"'))
        return MOST;
    const char *end = strchr(type + 1, *type);
    return end != NULL && end - type < MOST ? (int)(end - type) + 1 : MOST;
}

static int check_type(const char *type, const char *order, struct word *word, bool *fortran,
                      struct error *err) {
    static const struct word NONE = {0};
    *word = NONE;
    if (type == NULL || !read_type(type, word))
        return error_set(err, ERROR_INPUT,
                         "the npy type %.*s is not read; allowed: f2, f4, f8, and i and u of 1, "
                         "2, 4 or 8 bytes, as '<f8'",
                         type_length(type), type != NULL ? type : "is absent, which");
    *fortran = order != NULL && strncmp(order, "True", 4) == 0;
    if (!*fortran && (order == NULL || strncmp(order, "False", 5) != 0))
        return error_set(err, ERROR_INPUT, "the npy header must say fortran_order, True or False");
    return 0;
}

/* Contents of a header. */
struct npy {
    size_t start, nx, ny; /* bytes before the heights */
    struct word word;
    bool fortran;
};

static int read_layout(struct npy *npy, const char *data, size_t size, struct error *err) {
    char header[HEADER_MOST];
    int status = read_header(data, size, header, &npy->start, err);
    if (status == 0)
        status = check_type(value_behind(header, "descr"), value_behind(header, "fortran_order"),
                            &npy->word, &npy->fortran, err);
    if (status != 0)
        return status;
    if (!read_shape(value_behind(header, "shape"), &npy->ny, &npy->nx))
        return error_set(err, ERROR_INPUT, "the npy shape must be (n,) or (ny, nx)");
    return 0;
}

int height_map_npy_shape(const char *data, size_t size, size_t *ny, size_t *nx, struct error *err) {
    struct npy npy = {0};
    struct height_map map;
    int status = read_layout(&npy, data, size, err);
    if (status == 0)
        status = height_map_shape(&map, npy.ny, npy.nx, 1, err);
    *ny = npy.ny;
    *nx = npy.nx;
    return status;
}

int height_map_npy_parse(struct height_map *map, const char *data, size_t size, double dx,
                         struct error *err) {
    struct npy npy = {0};
    int status = read_layout(&npy, data, size, err);
    if (status == 0)
        status = height_map_shape(map, npy.ny, npy.nx, dx, err);
    if (status != 0)
        return status;
    const size_t ny = npy.ny, nx = npy.nx, start = npy.start;
    size_t n = nx * ny;
    if (size - start != n * npy.word.bytes)
        return error_set(err, ERROR_INPUT,
                         "%zu rows of %zu heights take %zu bytes; the npy file has %zu", ny, nx,
                         n * npy.word.bytes, size - start);
    map->z = array_create(n, sizeof *map->z);
    if (map->z == NULL)
        return error_memory(err, n * sizeof *map->z, "a height map");
    return read_heights(map, data + start, &npy.word, npy.fortran, err);
}

/* --- writing --- */

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
