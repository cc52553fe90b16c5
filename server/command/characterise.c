/* rugo characterise FILE: what a height map in a file is like. */
#include "server/command/command.h"
#include "server/command/map_file.h"
#include "server/command/output_file.h"
#include "server/show/map_characterisation.h"
#include <stdlib.h>
#include <string.h>

struct characterise_options {
    double dx; /* 0: not given */
    struct map_request request;
    int json;
    const char *picture; /* NULL: none */
};
#define AT(member) offsetof(struct characterise_options, member)
static const struct option_row OPTIONS[] = {
    {"dx", 0, OPTION_NUMBER, 0, 0, AT(dx), "D", NULL, MAP_SPACING_HELP},
    {"boundary", 0, OPTION_CHOICE, 0, 0, AT(request.boundary), MAP_BOUNDARIES, "auto",
     "whether the map repeats; auto: where its seam is no rougher than its inside"},
    {"detrend", 0, OPTION_CHOICE, 0, 0, AT(request.detrend), MAP_DETRENDS, "auto",
     "trend taken out first; auto: a plane, of an open map"},
    {"format", 0, OPTION_CHOICE, 0, 0, AT(json), "text|json", "text", "what to print"},
    {"picture", 0, OPTION_TEXT, 0, 0, AT(picture), "FILE.svg|FILE.png", NULL,
     "draw the map as it was measured, without its trend, with its summits marked"},
    {0}};

static int print(const struct characterise_options *options, const struct characterisation *found,
                 struct error *err) {
    int status = 0;
    if (options->json == 0)
        characterisation_print(stdout, found);
    else if (characterisation_print_json(stdout, found))
        putchar('\n');
    else
        status = error_memory(err, sizeof *found, "the characterisation");
    if (status == 0 && (fflush(stdout) != 0 || ferror(stdout) != 0))
        status = error_set(err, ERROR_SYSTEM, "cannot write to standard output");
    return status;
}

static int draw(const char *path, const char *name, const struct height_map *map,
                enum boundary boundary, struct error *err) {
    const struct map_picture picture = {.name = name,
                                        .subject = boundary == BOUNDARY_OPEN ? "open" : "periodic",
                                        .x_label = "x",
                                        .y_label = "y",
                                        .z_label = "z",
                                        .grid = &map->grid,
                                        .z = map->z,
                                        .boundary = boundary};
    return output_file_picture(path, &picture, err);
}

static int run(const void *values, const char *const *arguments) {
    const struct characterise_options *options = values;
    struct height_map map = {0};
    struct characterisation found = {0};
    struct error err = {0};
    enum boundary boundary = BOUNDARY_PERIODIC;
    int status = map_file_read(&map, arguments[0], options->dx, &err);
    if (status == 0) {
        status = map_characterise(&found, &map, &options->request, &boundary, &err);
        if (status != 0)
            error_context(&err, "%s", arguments[0]);
    }
    if (status == 0 && options->picture != NULL)
        status = draw(options->picture, arguments[0], &map, boundary, &err);
    if (status == 0)
        status = print(options, &found, &err);
    characterisation_clear(&found);
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
