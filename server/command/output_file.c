#include "server/command/output_file.h"
#include "server/command/rasterise.h"
#include "server/show/map/map_png.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int output_file_check(const char *path, struct error *err) {
    const char *slash = strrchr(path, '/');
    size_t length = slash == NULL ? 0 : slash == path ? 1 : (size_t)(slash - path);
    char *folder = length == 0 ? strdup(".") : strndup(path, length);
    if (folder == NULL)
        return error_memory(err, length, "a path");
    bool writable = access(access(path, F_OK) == 0 ? path : folder, W_OK) == 0;
    int status =
        writable ? 0 : error_set(err, ERROR_SYSTEM, "cannot write %s: %s", path, strerror(errno));
    free(folder);
    return status;
}

int output_file_open(FILE **file, const char *path, struct error *err) {
    *file = fopen(path, "wb");
    return *file != NULL
               ? 0
               : error_set(err, ERROR_SYSTEM, "cannot open %s: %s", path, strerror(errno));
}

int output_file_close(FILE *file, const char *path, int status, struct error *err) {
    bool failed = ferror(file) != 0;
    if ((fclose(file) != 0 || failed) && status == 0)
        status = error_set(err, ERROR_SYSTEM, "cannot write %s: %s", path, strerror(errno));
    return status;
}

bool output_file_is_png(const char *path) {
    size_t length = strlen(path);
    return length > 4 && strcmp(path + length - 4, ".png") == 0;
}

int output_file_picture(const char *path, const struct map_picture *picture, struct error *err) {
    FILE *file;
    int status = output_file_open(&file, path, err);
    if (status != 0)
        return status;
    status = output_file_is_png(path) ? map_png(file, picture->grid, picture->z, err)
                                      : plot_map(picture, file, err);
    return output_file_close(file, path, status, err);
}

int output_file_drawn(const char *path, const char *svg, size_t size, struct error *err) {
    FILE *file;
    int status = output_file_open(&file, path, err);
    if (status != 0)
        return status;
    if (output_file_is_png(path))
        status = rasterise(svg, size, file, err);
    else
        (void)fwrite(svg, 1, size, file); /* the file remembers a failure */
    status = output_file_close(file, path, status, err);
    if (status != 0)
        (void)unlink(path);
    return status;
}
