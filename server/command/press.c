/* rugo press FILE: the contact of a height map in a file with a rigid flat. */
#include "core/contact/area.h"
#include "core/contact/contact.h"
#include "core/contact/patches.h"
#include "core/statistics/roughness.h"
#include "schema/json/json.h"
#include "server/command/command.h"
#include "server/command/map_file.h"
#include "server/command/options.h"
#include "server/show/text_table.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char NAME[] = "press";
enum { LOADS_MOST = 1000 };

struct options {
    const char *path, *output;
    double dx; /* 0: not given */
    struct block block;
    double lengths; /* height of the block in lengths of the map; 0: not given */
    bool json;
    size_t loads;
    double load[LOADS_MOST]; /* p/(E* h'), rising */
};

/* A number of the range; *out is kept where text is NULL. */
static bool read_number(const char *name, const char *text, double low, double high, double *out) {
    if (text == NULL)
        return true;
    char *stop;
    double value = strtod(text, &stop);
    if (stop == text || *stop != '\0' || !(value >= low && value <= high))
        return usage_error(NAME, "--%s %.40s is not a number in [%g, %g]", name, text, low, high);
    *out = value;
    return true;
}

static bool read_loads(struct options *out, const char *text) {
    const char *at = text;
    for (char *stop;; at = stop + 1) {
        double load = strtod(at, &stop);
        double last = out->loads > 0 ? out->load[out->loads - 1] : 0;
        if (stop == at || !(load > last && isfinite(load)) || out->loads == LOADS_MOST)
            return usage_error(NAME, "--loads %.40s: not up to %d rising numbers above 0", text,
                               LOADS_MOST);
        out->load[out->loads++] = load;
        if (*stop == '\0')
            return true;
        if (*stop != ',')
            return usage_error(NAME, "--loads %.40s: a comma is missing", text);
    }
}

static bool read_model(struct options *out, const char *model) {
    out->block.model = strcmp(model, "layered") == 0 ? MODEL_LAYERED : MODEL_HALFSPACE;
    if (out->block.model == MODEL_HALFSPACE && strcmp(model, "halfspace") != 0)
        return usage_error(NAME, "--model %.40s is not halfspace or layered", model);
    if (out->lengths == 0 && out->block.model == MODEL_LAYERED)
        out->lengths = 1.5;
    return true;
}

static bool read_options(int argc, char **argv, struct options *out) {
    const char *dx = NULL, *format = "text", *loads = "0.01,0.02,0.05,0.1,0.2,0.3";
    const char *model = "halfspace", *poisson = NULL, *height = NULL;
    const struct option_row rows[] = {
        {"dx", OPTION_TEXT, &dx},         {"loads", OPTION_TEXT, &loads},
        {"model", OPTION_TEXT, &model},   {"poisson", OPTION_TEXT, &poisson},
        {"height", OPTION_TEXT, &height}, {"format", OPTION_TEXT, &format},
        {"o", OPTION_TEXT, &out->output}, {"output", OPTION_TEXT, &out->output},
        {NULL, OPTION_FLAG, NULL}};
    out->block = (struct block){.poisson = 0.3, .layer_growth = 1.1, .weighting = GAP_STANDARD};
    if (!options_parse(argc, argv, rows, 1, 1, &out->path) || !map_spacing(NAME, dx, &out->dx) ||
        !read_loads(out, loads) ||
        !read_number("poisson", poisson, 0, 0.4999, &out->block.poisson) ||
        !read_number("height", height, 1e-3, 1e3, &out->lengths) || !read_model(out, model))
        return false;
    out->json = strcmp(format, "json") == 0;
    if (!out->json && strcmp(format, "text") != 0)
        return usage_error(NAME, "--format %.40s is not json or text", format);
    return true;
}

/* What is told of a load; lengths over the RMS height, pressures over E* h'. */
enum column {
    LOAD,
    EDGES,
    NODES,
    LOWER,
    UPPER,
    PERIMETER,
    MEAN_GAP,
    STIFFNESS,
    PATCHES,
    ITERATIONS,
    VIOLATION,
    COLUMNS
};
static const char *const COLUMN_NAMES[COLUMNS] = {
    "p/(E* h')", "edges",     "nodes",   "lower",      "upper",    "perimeter",
    "gap/rms",   "stiffness", "patches", "iterations", "violation"};
static const char *const COLUMN_KEYS[COLUMNS] = {
    "load",     "edges",     "nodes",       "nodes_lower", "nodes_upper", "perimeter",
    "mean_gap", "stiffness", "patch_count", "iterations",  "violation"};

struct press {
    struct compliance *compliance;
    struct contact *contact;
    struct area_workspace *areas;
    struct patch_finder *patches;
    double slope, height;      /* RMS, of the map */
    double (*values)[COLUMNS]; /* owned, a row a load */
    double *pressure;          /* owned, the map's points: of the last load, over E* h' */
};

static void press_clear(struct press *press) {
    patch_finder_destroy(&press->patches);
    area_workspace_destroy(&press->areas);
    contact_destroy(&press->contact);
    compliance_destroy(&press->compliance);
    free(press->values);
    free(press->pressure);
}

static int press_create(struct press *press, const struct options *options,
                        const struct height_map *map, struct error *err) {
    const struct grid *grid = &map->grid;
    struct block block = options->block;
    struct moments moments;
    block.height = options->lengths > 0 ? options->lengths * grid->lx : INFINITY;
    *press = (struct press){0};
    press->values = array_create(options->loads, sizeof *press->values);
    press->pressure = array_create(grid_points(grid), sizeof *press->pressure);
    if (press->values == NULL || press->pressure == NULL)
        return error_memory(err, grid_points(grid) * sizeof(double), "pressures");
    int status = roughness_spectral(grid, map->z, &moments, err);
    if (status == 0 && !(moments.rms_slope > 0))
        return error_set(err, ERROR_INPUT, "%s: the map is flat, so that no load has a meaning",
                         options->path);
    press->slope = moments.rms_slope;
    press->height = moments.rms_height;
    if (status == 0)
        status = compliance_create(&press->compliance, grid, &block, err);
    if (status == 0)
        status = contact_create(&press->contact, press->compliance, &CONTACT_DEFAULTS, err);
    if (status == 0)
        status = area_workspace_create(&press->areas, press->compliance, err);
    if (status == 0)
        status = patch_finder_create(&press->patches, grid, err);
    return status;
}

static int press_load(struct press *press, double load, double *row, struct error *err) {
    struct contact_state state;
    struct contact_area area;
    struct patches patches;
    int status = contact_press(press->contact, load * press->slope, &state, err);
    if (status != 0)
        return status;
    contact_area(press->areas, state.p, state.opening, &area);
    patches_find(press->patches, state.p, &patches, NULL);
    const double values[COLUMNS] = {
        [LOAD] = load,
        [EDGES] = area.edges,
        [NODES] = area.nodes,
        [LOWER] = area.lower,
        [UPPER] = area.upper,
        [PERIMETER] = area.perimeter,
        [MEAN_GAP] = state.mean_gap / press->height,
        [STIFFNESS] = isfinite(state.stiffness) ? state.stiffness * press->height / press->slope
                                                : (double)NAN,
        [PATCHES] = (double)patches.count,
        [ITERATIONS] = (double)state.iterations,
        [VIOLATION] = state.violation,
    };
    memcpy(row, values, sizeof values);
    for (size_t i = 0; i < grid_points(&press->compliance->grid); i++)
        press->pressure[i] = state.p[i] / press->slope;
    return 0;
}

static void print_table(const struct press *press, const struct options *options) {
    struct text_table table = {.columns = COLUMNS};
    for (size_t c = 0; c < COLUMNS; c++)
        table_cell(&table, "%s", COLUMN_NAMES[c]);
    for (size_t l = 0; l < options->loads; l++)
        for (size_t c = 0; c < COLUMNS; c++)
            table_number(&table, press->values[l][c]);
    printf("RMS slope %.4g, RMS height %.4g; full contact at p/(E* h') = %.4g\n\n", press->slope,
           press->height, contact_full_pressure(press->contact) / press->slope);
    table_print(&table, stdout);
    table_clear(&table);
}

static int print_json(const struct press *press, const struct options *options, struct error *err) {
    double column[LOADS_MOST];
    cJSON *document = cJSON_CreateObject();
    bool complete =
        cJSON_AddItemToObject(document, "rms_slope", json_number(press->slope)) &&
        cJSON_AddItemToObject(document, "rms_height", json_number(press->height)) &&
        cJSON_AddItemToObject(document, "full_contact",
                              json_number(contact_full_pressure(press->contact) / press->slope));
    for (size_t c = 0; c < COLUMNS && complete; c++) {
        for (size_t l = 0; l < options->loads; l++)
            column[l] = press->values[l][c];
        complete =
            cJSON_AddItemToObject(document, COLUMN_KEYS[c], json_numbers(column, options->loads));
    }
    int status =
        complete ? output_document(document, err) : error_memory(err, sizeof(cJSON), "the contact");
    cJSON_Delete(document);
    return status;
}

static int write_pressures(const struct press *press, const struct options *options,
                           struct error *err) {
    enum height_map_format format = height_map_format_of(options->output);
    FILE *file = fopen(options->output, "wb");
    if (file == NULL)
        return error_set(err, ERROR_SYSTEM, "cannot open %s: %s", options->output, strerror(errno));
    int status = height_map_write(file, format == HEIGHT_MAP_FORMATS ? HEIGHT_MAP_NPY : format,
                                  &press->compliance->grid, press->pressure, err);
    if (fclose(file) != 0 && status == 0)
        status =
            error_set(err, ERROR_SYSTEM, "cannot write %s: %s", options->output, strerror(errno));
    return status;
}

static int press_map(const struct options *options, const struct height_map *map,
                     struct error *err) {
    struct press press;
    int status = press_create(&press, options, map, err);
    if (status == 0)
        status = contact_begin(press.contact, map->z, err);
    for (size_t l = 0; status == 0 && l < options->loads; l++)
        status = press_load(&press, options->load[l], press.values[l], err);
    if (status == 0 && options->output != NULL)
        status = write_pressures(&press, options, err);
    if (status == 0 && options->json)
        status = print_json(&press, options, err);
    else if (status == 0) {
        print_table(&press, options);
        status = output_flush(err);
    }
    press_clear(&press);
    return status;
}

int command_press(int argc, char **argv) {
    struct options options = {0};
    struct height_map map = {0};
    struct error err = {0};
    if (!read_options(argc, argv, &options))
        return EXIT_USAGE;
    int status = map_file_read(&map, options.path, options.dx, &err);
    if (status == 0)
        status = press_map(&options, &map, &err);
    height_map_clear(&map);
    return status == 0 ? EXIT_DONE : command_fail(NAME, &err);
}
