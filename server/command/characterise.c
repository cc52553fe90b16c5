/* rugo characterise FILE: what a height map in a file is like. */
#include "server/command/command.h"
#include "server/command/map_file.h"
#include "server/show/characterisation.h"
#include <stdlib.h>
#include <string.h>

struct characterise_options {
    double dx; /* 0: not given */
    int json;
};
#define AT(member) offsetof(struct characterise_options, member)
static const struct option_row OPTIONS[] = {
    {"dx", 0, OPTION_NUMBER, 0, 0, AT(dx), "D", NULL, MAP_SPACING_HELP},
    {"format", 0, OPTION_CHOICE, 0, 0, AT(json), "text|json", "text", "what to print"},
    {0}};

static int print(const struct characterise_options *options, const struct height_map *map,
                 struct error *err) {
    struct characterisation values;
    int status =
        characterise_heights(&values, &map->grid, map->z, map->grid.nx / 2, map->grid.ny / 2, err);
    if (status != 0)
        return status;
    if (options->json == 0)
        characterisation_print(stdout, &values);
    else if (characterisation_print_json(stdout, &values))
        putchar('\n');
    else
        status = error_memory(err, sizeof values, "the characterisation");
    if (status == 0 && (fflush(stdout) != 0 || ferror(stdout) != 0))
        status = error_set(err, ERROR_SYSTEM, "cannot write to standard output");
    return status;
}

static int run(const void *values, const char *const *arguments) {
    const struct characterise_options *options = values;
    struct height_map map = {0};
    struct error err = {0};
    int status = map_file_read(&map, arguments[0], options->dx, &err);
    if (status == 0)
        status = print(options, &map, &err);
    height_map_clear(&map);
    return status == 0 ? EXIT_DONE : command_fail("characterise", &err);
}

const struct command COMMAND_CHARACTERISE = {
    .name = "characterise",
    .arguments = "FILE",
    .summary = "parameters and summits of a height map in a file",
    .least = 1,
    .most = 1,
    .options = OPTIONS,
    .options_size = sizeof(struct characterise_options),
    .run = run,
};
