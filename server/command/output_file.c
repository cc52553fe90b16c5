#include "server/command/output_file.h"
#include "core/file/file.h"
#include "core/file/memory_file.h"
#include "core/file/written_file.h"
#include "server/command/rasterise.h"
#include "server/command/tool.h"
#include "server/show/map/map_png.h"
#include "server/show/word_list.h"
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

bool output_file_is_png(const char *path) {
    return file_ends_in(path, ".png");
}

int output_file_check_ending(const char *path, const char *what, const char *const *endings,
                             struct error *err) {
    char allowed[80] = "";
    for (size_t e = 0; endings[e] != NULL; e++) {
        if (file_ends_in(path, endings[e]))
            return 0;
        word_list_append(allowed, sizeof allowed, ", ", endings[e]);
    }
    return error_set(err, ERROR_INPUT, "%s %.200s: its name %s %s", what, path,
                     endings[1] != NULL ? "ends in none of" : "does not end in", allowed);
}

int output_file_check_drawn(const char *path, struct error *err) {
    static const char *const ENDINGS[] = {".svg", ".png", ".pdf", ".eps", NULL};
    return output_file_check_ending(path, "picture", ENDINGS, err);
}

static int write_drawn(const char *path, const char *svg, size_t size, FILE *file,
                       struct error *err) {
    if (output_file_is_png(path))
        return rasterise(svg, size, file, err);
    if (!file_ends_in(path, ".svg"))
        return print_as(file_ends_in(path, ".pdf") ? "pdf" : "eps", svg, size, file, err);
    (void)fwrite(svg, 1, size, file); /* the file remembers a failure */
    return 0;
}

/* Copies a file of tool_file to where it is to be. */
static int publish(const char *path, FILE *made, struct error *err) {
    char block[1 << 14];
    size_t size;
    struct written_file file;
    if (fflush(made) != 0 || ferror(made) != 0 || fseek(made, 0, SEEK_SET) != 0)
        return error_set(err, ERROR_SYSTEM, "%s, in memory: %s", path, strerror(errno));
    int status = written_file_open(&file, path, err);
    if (status != 0)
        return status;
    while ((size = fread(block, 1, sizeof block, made)) > 0)
        (void)fwrite(block, 1, size, file.stream); /* the file remembers a failure */
    if (ferror(made) != 0)
        status = error_set(err, ERROR_SYSTEM, "%s, in memory: %s", path, strerror(errno));
    return written_file_close(&file, status, err);
}

static int write_file(const char *path, const char *svg, size_t size, struct error *err) {
    int status = output_file_check_drawn(path, err);
    FILE *made = status == 0 ? tool_file(err) : NULL;
    if (made == NULL)
        return status != 0 ? status : ERROR_SYSTEM;
    status = write_drawn(path, svg, size, made, err);
    if (status != 0)
        error_context(err, "%s", path);
    else
        status = publish(path, made, err);
    (void)fclose(made);
    return status;
}

int output_file_draw(const char *path, output_drawing *draw, const void *context,
                     struct error *err) {
    struct memory_file memory;
    size_t size = 0;
    if (!memory_file_open(&memory))
        return error_memory(err, 0, "a picture");
    int status = draw(context, memory.file, err);
    char *text = memory_file_close(&memory, &size);
    if (status == 0 && text == NULL)
        status = error_memory(err, 0, "a picture");
    if (status == 0)
        status = write_file(path, text, size, err);
    free(text);
    return status;
}

/* A map in PNG has a pixel a point, which is no drawing of an SVG. */
static int write_pixels(const char *path, const struct map_picture *picture, struct error *err) {
    FILE *made = tool_file(err);
    if (made == NULL)
        return ERROR_SYSTEM;
    int status = map_png(made, picture->grid, picture->z, err);
    if (status == 0)
        status = publish(path, made, err);
    (void)fclose(made);
    return status;
}

static int draw_map(const void *context, FILE *file, struct error *err) {
    return plot_map(context, file, err);
}

int output_file_picture(const char *path, const struct map_picture *picture, struct error *err) {
    return output_file_is_png(path) ? write_pixels(path, picture, err)
                                    : output_file_draw(path, draw_map, picture, err);
}
