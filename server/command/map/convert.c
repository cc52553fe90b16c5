/* rugo convert FILE OUT: a height map in a file, prepared, into another file. */
#include "core/file/written_file.h"
#include "server/command/command.h"
#include "server/command/map/map_file.h"

struct convert_options {
    struct map_options map;
};
static const struct option_row OPTIONS[] = {
    MAP_OPTION_ROWS_DETREND(struct convert_options, map, "none"),
    MAP_EXTEND_ROW(struct convert_options, map),
    MAP_BOUNDARY_ROW(struct convert_options, map),
    {0}};

/* Lines that readers of text leave out, but for those that know these keys. */
static void write_header(FILE *file, enum height_map_format format, const struct height_map *map,
                         const struct preparation_record *record) {
    const char *gap = *map->xy_unit != '\0' ? " " : "";
    for (size_t step = 0; step < record->count; step++)
        fprintf(file, "# done: %s, %s\n", record->steps[step].name, record->steps[step].text);
    if (format == HEIGHT_MAP_CSV) {
        fprintf(file, "# dx: %.17g%s%s\n", grid_dx(&map->grid), gap, map->xy_unit);
        fprintf(file, "# dy: %.17g%s%s\n", grid_dy(&map->grid), gap, map->xy_unit);
    } else if (*map->xy_unit != '\0')
        fprintf(file, "# xy unit: %s\n", map->xy_unit);
    if (*map->z_unit != '\0')
        fprintf(file, "# z unit: %s\n", map->z_unit);
}

static int write_map(const char *path, const struct height_map *map,
                     const struct preparation_record *record, struct error *err) {
    const enum height_map_format format = height_map_format_of(path);
    struct written_file file;
    int status = written_file_open(&file, path, err);
    if (status != 0)
        return status;
    if (format != HEIGHT_MAP_NPY)
        write_header(file.stream, format, map, record);
    status = height_map_write(file.stream, format, &map->grid, map->z, err);
    if (status != 0)
        error_context(err, "%s", path);
    return written_file_close(&file, status, err);
}

static int print(const struct height_map *map, const struct preparation_record *record,
                 struct error *err) {
    const struct grid *grid = &map->grid;
    for (size_t step = 0; step < record->count; step++)
        printf("%s: %s\n", record->steps[step].name, record->steps[step].text);
    printf("written: %zu by %zu points, %.10g by %.10g%s%s apart, heights%s%s\n", grid->nx,
           grid->ny, grid_dx(grid), grid_dy(grid), *map->xy_unit != '\0' ? " " : "", map->xy_unit,
           *map->z_unit != '\0' ? " in " : "", map->z_unit);
    if (height_map_unit_note(map) != NULL)
        printf("%s\n", height_map_unit_note(map));
    return output_flush(err);
}

static int run(const void *values, const char *const *arguments) {
    const struct convert_options *options = values;
    struct preparation_record record = {0};
    struct height_map map = {0};
    struct error err = {0};
    if (height_map_format_of(arguments[1]) == HEIGHT_MAP_FORMATS)
        return usage_error("convert", "%.60s: allowed are files that end in .npy, .csv or .xyz",
                           arguments[1]);
    struct map_options asked = options->map;
    if (asked.words.extend != NULL && asked.words.detrend == ASK_DETREND_NONE)
        asked.words.detrend = ASK_DETREND_AUTO; /* a law that repeats has no plane */
    int status = map_options_read_any(&map, &record, arguments[0], &asked, &err);
    if (status == 0)
        status = write_map(arguments[1], &map, &record, &err);
    if (status == 0)
        status = print(&map, &record, &err);
    height_map_clear(&map);
    return status == 0 ? EXIT_DONE : command_fail("convert", &err);
}

const struct command COMMAND_CONVERT = {
    .name = "convert",
    .arguments = "FILE OUT.npy|OUT.csv|OUT.xyz",
    .summary = "a height map in a file, prepared, into another file",
    .least = 2,
    .most = 2,
    .options = OPTIONS,
    .options_size = sizeof(struct convert_options),
    .run = run,
};
