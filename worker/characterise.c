/* rugo characterise FILE: what a height map in a file is like. */
#include "schema/json.h"
#include "server/command.h"
#include "worker/characterisation.h"
#include "worker/height_map.h"
#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char NAME[] = "characterise";
static const size_t FILE_MOST = (size_t)1 << 36; /* bytes; 2^31 points as text fit */

struct options {
    const char *path;
    double dx; /* 0: not given */
    bool json;
};

static int read_options(int argc, char **argv, struct options *out, struct error *err) {
    static const struct option LONG[] = {{"dx", required_argument, NULL, 'd'},
                                         {"format", required_argument, NULL, 'f'},
                                         {NULL, 0, NULL, 0}};
    *out = (struct options){0};
    optind = 1;
    opterr = 0;
    for (int option; (option = getopt_long(argc, argv, ":d:f:", LONG, NULL)) != -1;) {
        char *stop;
        if (option == 'd') {
            out->dx = strtod(optarg, &stop);
            if (stop == optarg || *stop != '\0' || !(out->dx > 0 && isfinite(out->dx)))
                return error_set(err, ERROR_INPUT, "--dx: '%s' is not a number above 0", optarg);
        } else if (option == 'f' && (!strcmp(optarg, "json") || !strcmp(optarg, "text")))
            out->json = !strcmp(optarg, "json");
        else if (option == 'f')
            return error_set(err, ERROR_INPUT, "--format: '%s' is not json or text", optarg);
        else
            return error_set(err, ERROR_INPUT, "unknown or incomplete option '%s'",
                             argv[optind - 1]);
    }
    if (optind != argc - 1)
        return error_set(err, ERROR_INPUT, "wants one FILE");
    out->path = argv[optind];
    return 0;
}

static int print(const struct options *options, const struct height_map *map, struct error *err) {
    cJSON *values;
    int status = characterisation_create(&values, &map->grid, map->z, map->grid.nx / 2,
                                         map->grid.ny / 2, err);
    if (status != 0)
        return status;
    if (options->json) {
        char *text = json_print(values);
        if (text != NULL)
            puts(text);
        else
            status = error_memory(err, sizeof(cJSON), "the characterisation");
        free(text);
    } else
        characterisation_print(stdout, values);
    cJSON_Delete(values);
    if (status == 0 && (fflush(stdout) != 0 || ferror(stdout)))
        status = error_set(err, ERROR_SYSTEM, "cannot write to standard output");
    return status;
}

int command_characterise(int argc, char **argv) {
    struct options options;
    struct height_map map = {0};
    struct error err = {0};
    char *text = NULL;
    size_t size;
    int status = read_options(argc, argv, &options, &err);
    if (status == 0)
        status = file_read(options.path, FILE_MOST, &text, &size, &err);
    if (status == 0) {
        enum height_map_format format = height_map_format_of(options.path);
        if (format == HEIGHT_MAP_FORMATS)
            format = size > 0 && text[0] == '\x93' ? HEIGHT_MAP_NPY : HEIGHT_MAP_CSV;
        status = height_map_parse(&map, format, text, size, options.dx, &err);
        if (status != 0)
            error_context(&err, "%s", options.path);
    }
    free(text);
    if (status == 0)
        status = print(&options, &map, &err);
    height_map_clear(&map);
    return status == 0 ? EXIT_DONE : command_fail(NAME, &err);
}
