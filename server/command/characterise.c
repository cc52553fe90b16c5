/* rugo characterise FILE: what a height map in a file is like. */
#include "server/command/command.h"
#include "server/command/map_file.h"
#include "server/command/options.h"
#include "server/show/characterisation.h"
#include <stdlib.h>
#include <string.h>

static const char NAME[] = "characterise";
struct options {
    const char *path;
    double dx; /* 0: not given */
    bool json;
};

static bool read_options(int argc, char **argv, struct options *out) {
    const char *dx = NULL, *format = "text";
    const struct option_row rows[] = {
        {"dx", OPTION_TEXT, &dx}, {"format", OPTION_TEXT, &format}, {NULL, OPTION_FLAG, NULL}};
    if (!options_parse(argc, argv, rows, 1, 1, &out->path))
        return false;
    if (!map_spacing(NAME, dx, &out->dx))
        return false;
    out->json = strcmp(format, "json") == 0;
    if (!out->json && strcmp(format, "text") != 0)
        return usage_error(NAME, "--format %.40s is not json or text", format);
    return true;
}

static int print(const struct options *options, const struct height_map *map, struct error *err) {
    struct characterisation values;
    int status =
        characterise_heights(&values, &map->grid, map->z, map->grid.nx / 2, map->grid.ny / 2, err);
    if (status != 0)
        return status;
    if (!options->json)
        characterisation_print(stdout, &values);
    else if (characterisation_print_json(stdout, &values))
        putchar('\n');
    else
        status = error_memory(err, sizeof values, "the characterisation");
    if (status == 0 && (fflush(stdout) != 0 || ferror(stdout)))
        status = error_set(err, ERROR_SYSTEM, "cannot write to standard output");
    return status;
}

int command_characterise(int argc, char **argv) {
    struct options options = {0};
    struct height_map map = {0};
    struct error err = {0};
    if (!read_options(argc, argv, &options))
        return EXIT_USAGE;
    int status = map_file_read(&map, options.path, options.dx, &err);
    if (status == 0)
        status = print(&options, &map, &err);
    height_map_clear(&map);
    return status == 0 ? EXIT_DONE : command_fail(NAME, &err);
}
