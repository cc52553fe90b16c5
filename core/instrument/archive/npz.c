/* NPZ, a zip archive of arrays in NumPy's npy format, each of which may be a map or a profile. */
#include "core/instrument/archive/zip_archive.h"
#include "core/instrument/formats.h"
#include "core/map/height_map_npy.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Bytes at the start of an array that contain its shape. */
enum { START = 4096 + 12 };

/* Returns the length of the name of the array in an entry, "z" of "z.npy"; 0 where it is no
 * array. */
static size_t array_name(const struct zip_archive *zip, size_t entry, const char **name) {
    *name = zip_archive_name(zip, entry);
    size_t length = strlen(*name);
    return length > 4 && strcmp(*name + length - 4, ".npy") == 0 ? length - 4 : 0;
}

static bool npz_owns(const char *data, size_t size) {
    return zip_archive_begins(data, size) && zip_archive_names(data, size, ".npy") &&
           !zip_archive_names(data, size, "main.xml");
}

/* Writes "x, y, z": the arrays that are marked, or all (NULL). */
static void list_names(const struct zip_archive *zip, const bool *marked, char *names,
                       size_t size) {
    size_t used = 0;
    *names = '\0';
    for (size_t entry = 0; entry < zip_archive_entries(zip); entry++) {
        const char *name;
        size_t length = array_name(zip, entry, &name);
        if (length == 0 || (marked != NULL && !marked[entry]))
            continue;
        int more = snprintf(names + used, size - used, "%s%.*s", used > 0 ? ", " : "",
                            (int)(length < 80 ? length : 80), name);
        if (more < 0 || (size_t)more >= size - used)
            break;
        used += (size_t)more;
    }
}

/* "there is no array 'q'; allowed: x, y, z" */
static int refuse_layer(const struct zip_archive *zip, const char *asked, struct error *err) {
    char names[300];
    list_names(zip, NULL, names, sizeof names);
    return error_set(err, ERROR_INPUT, "there is no array '%.40s'; allowed: %s", asked, names);
}

/* Finds an array by its name, or else by its number, from 1. */
static int find_layer(const struct zip_archive *zip, const char *asked, size_t *found,
                      struct error *err) {
    char *stop;
    unsigned long long number = strtoull(asked, &stop, 10);
    bool numbered = *asked >= '0' && *asked <= '9' && *stop == '\0', any = false;
    unsigned long long count = 0;
    for (size_t entry = 0; entry < zip_archive_entries(zip); entry++) {
        const char *name;
        size_t length = array_name(zip, entry, &name);
        if (length == 0)
            continue;
        count++;
        if ((strlen(asked) == length && memcmp(name, asked, length) == 0) ||
            strcmp(name, asked) == 0) {
            *found = entry;
            return 0;
        }
        if (numbered && count == number) {
            *found = entry;
            any = true;
        }
    }
    return any ? 0 : refuse_layer(zip, asked, err);
}

/* Marks the arrays that can be a map of several rows, or where there are none those that can be a
 * profile; *count is their number, *last one of them. */
static int mark_maps(struct zip_archive *zip, bool *marked, size_t *count, size_t *last,
                     struct error *err) {
    char start[START];
    size_t rows = 1;
    struct error fault = {0};
    *count = 0;
    for (size_t entry = 0; entry < zip_archive_entries(zip); entry++) {
        const char *name;
        size_t size = sizeof start, ny, nx;
        marked[entry] = false;
        if (array_name(zip, entry, &name) == 0)
            continue;
        int status = zip_archive_peek(zip, entry, start, &size, err);
        if (status != 0)
            return status;
        if (height_map_npy_shape(start, size, &ny, &nx, &fault) != 0 || (rows > 1 && ny == 1))
            continue;
        for (size_t before = 0; before < entry && rows == 1 && ny > 1; before++)
            marked[before] = false;
        *count = rows == 1 && ny > 1 ? 1 : *count + 1;
        rows = ny > rows ? ny : rows;
        marked[entry] = true;
        *last = entry;
    }
    if (*count > 0)
        return 0;
    return error_set(err, ERROR_INPUT, "no array can be a map%s%.300s",
                     fault.code != 0 ? "; the last: " : "", fault.text);
}

/* Finds the only array that can be a map: nothing says of several which has the heights, as of x, y
 * and z over one grid. */
static int find_only(struct zip_archive *zip, size_t *found, struct error *err) {
    const size_t entries = zip_archive_entries(zip);
    char names[300];
    size_t count = 0;
    bool *marked = array_create(entries > 0 ? entries : 1, sizeof *marked);
    if (marked == NULL)
        return error_memory(err, entries * sizeof *marked, "marks of arrays");
    int status = mark_maps(zip, marked, &count, found, err);
    if (status == 0 && count > 1) {
        list_names(zip, marked, names, sizeof names);
        status = error_set(err, ERROR_INPUT,
                           "%zu arrays can be the map: %s; --layer NAME (layer in studies and "
                           "requests) says which",
                           count, names);
    }
    free(marked);
    return status;
}

static int npz_read(struct height_map *out, const char *data, size_t size,
                    const struct instrument_request *request, struct error *err) {
    const char *asked = request != NULL ? request->layer : NULL;
    struct zip_archive *zip = NULL;
    struct height_map map = {0};
    char *array = NULL;
    size_t entry = 0, bytes = 0;
    int status = zip_archive_open(&zip, data, size, err);
    if (status == 0)
        status = asked != NULL ? find_layer(zip, asked, &entry, err) : find_only(zip, &entry, err);
    if (status == 0)
        status = zip_archive_read(zip, entry, &array, &bytes, err);
    if (status == 0) {
        status = height_map_npy_parse(&map, array, bytes, 1, err);
        if (status != 0)
            error_context(err, "%.80s", zip_archive_name(zip, entry));
    }
    free(array);
    zip_archive_close(&zip);
    if (status != 0)
        height_map_clear(&map);
    else
        *out = map;
    return status;
}

const struct instrument_format INSTRUMENT_NPZ = {"npz", "npz", npz_owns, npz_read};
