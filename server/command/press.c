/* rugo press FILE: the contact of a height map in a file with a rigid flat. */
#include "core/contact/area.h"
#include "core/contact/contact.h"
#include "core/contact/patches.h"
#include "core/map/detrend.h"
#include "core/statistics/roughness.h"
#include "core/statistics/seam.h"
#include "schema/json/json.h"
#include "schema/study/parameter.h"
#include "server/command/command.h"
#include "server/command/map_file.h"
#include "server/show/text_table.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LOADS_MOST = 1000 };

/* --model may name these. */
static const struct choice MODELS[] = {
    {"halfspace", MODEL_HALFSPACE}, {"layered", MODEL_LAYERED}, {NULL, 0}};

#define DETRENDS "none|mean|plane|quadratic" /* in the order of enum detrend */

struct press_options {
    const char *loads, *output, *model;
    double dx, poisson, lengths; /* dx, height of the block in lengths of the map: 0: not given */
    int detrend, json;
};
#define AT(member) offsetof(struct press_options, member)
static const struct option_row OPTIONS[] = {
    {"dx", 0, OPTION_NUMBER, 0, 0, AT(dx), "D", NULL, MAP_SPACING_HELP},
    {"loads", 0, OPTION_TEXT, 0, 0, AT(loads), "LIST", "0.01,0.02,0.05,0.1,0.2,0.3",
     "rising loads p/(E* h')"},
    {"model", 0, OPTION_TEXT, 0, 0, AT(model), "halfspace|layered", "halfspace",
     "what the block is made of"},
    {"poisson", 0, OPTION_NUMBER, 0, 0.4999, AT(poisson), "NU", "0.3", "Poisson's ratio, layered"},
    {"height", 0, OPTION_NUMBER, 1e-3, 1e3, AT(lengths), "LENGTHS", NULL,
     "height of the block in lengths of the map (infinite; layered 1.5)"},
    {"detrend", 0, OPTION_CHOICE, 0, 0, AT(detrend), DETRENDS, "none",
     "trend taken out of the map first"},
    {"format", 0, OPTION_CHOICE, 0, 0, AT(json), "text|json", "text", "what to print"},
    {"output", 'o', OPTION_TEXT, 0, 0, AT(output), "FILE", NULL,
     "write the pressures p/(E* h') of the last load there, as a map"},
    {0}};

/* The options ask for this. */
struct press_order {
    const char *path, *output;
    struct block block;
    double lengths; /* 0: infinite */
    enum detrend detrend;
    bool json;
    size_t loads;
    double load[LOADS_MOST]; /* p/(E* h'), rising */
};

/* The table has these columns; lengths are over the RMS height, pressures over E* h'. */
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

static int press_create(struct press *press, const struct press_order *order,
                        const struct height_map *map, struct error *err) {
    const struct grid *grid = &map->grid;
    struct block block = order->block;
    struct moments moments;
    block.height = order->lengths > 0 ? order->lengths * grid->lx : INFINITY;
    *press = (struct press){0};
    press->values = array_create(order->loads, sizeof *press->values);
    press->pressure = array_create(grid_points(grid), sizeof *press->pressure);
    if (press->values == NULL || press->pressure == NULL)
        return error_memory(err, grid_points(grid) * sizeof(double), "pressures");
    int status = roughness_spectral(grid, map->z, &moments, err);
    if (status == 0 && !(moments.rms_slope > 0))
        return error_set(err, ERROR_INPUT, "%s: the map is flat, so that no load has a meaning",
                         order->path);
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
    contact_area(press->areas, &state, &area);
    patches_find(press->patches, state.p, &patches, NULL);
    const double values[COLUMNS] = {
        [LOAD] = load,
        [EDGES] = area.edges,
        [NODES] = area.nodes,
        [LOWER] = area.lower,
        [UPPER] = area.upper,
        [PERIMETER] = area.perimeter,
        [MEAN_GAP] = area.mean_gap / press->height,
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

static void print_table(const struct press *press, const struct press_order *order) {
    struct text_table table = {.columns = COLUMNS};
    for (size_t c = 0; c < COLUMNS; c++)
        table_cell(&table, "%s", COLUMN_NAMES[c]);
    for (size_t l = 0; l < order->loads; l++)
        for (size_t c = 0; c < COLUMNS; c++)
            table_number(&table, press->values[l][c]);
    printf("RMS slope %.4g, RMS height %.4g; full contact at p/(E* h') = %.4g\n\n", press->slope,
           press->height, contact_full_pressure(press->contact) / press->slope);
    table_print(&table, stdout);
    table_clear(&table);
}

static int print_json(const struct press *press, const struct press_order *order,
                      struct error *err) {
    double column[LOADS_MOST];
    cJSON *document = cJSON_CreateObject();
    bool complete =
        cJSON_AddItemToObject(document, "rms_slope", json_number(press->slope)) &&
        cJSON_AddItemToObject(document, "rms_height", json_number(press->height)) &&
        cJSON_AddItemToObject(document, "full_contact",
                              json_number(contact_full_pressure(press->contact) / press->slope));
    for (size_t c = 0; c < COLUMNS && complete; c++) {
        for (size_t l = 0; l < order->loads; l++)
            column[l] = press->values[l][c];
        complete =
            cJSON_AddItemToObject(document, COLUMN_KEYS[c], json_numbers(column, order->loads));
    }
    int status =
        complete ? output_document(document, err) : error_memory(err, sizeof(cJSON), "the contact");
    cJSON_Delete(document);
    return status;
}

static int write_pressures(const struct press *press, const struct press_order *order,
                           struct error *err) {
    enum height_map_format format = height_map_format_of(order->output);
    FILE *file = fopen(order->output, "wb");
    if (file == NULL)
        return error_set(err, ERROR_SYSTEM, "cannot open %s: %s", order->output, strerror(errno));
    int status = height_map_write(file, format == HEIGHT_MAP_FORMATS ? HEIGHT_MAP_NPY : format,
                                  &press->compliance->grid, press->pressure, err);
    if (fclose(file) != 0 && status == 0)
        status =
            error_set(err, ERROR_SYSTEM, "cannot write %s: %s", order->output, strerror(errno));
    return status;
}

/* Takes the trend out of the map, and tells of a seam: contact takes every map as periodic. */
static int prepare_map(struct height_map *map, const struct press_order *order, struct error *err) {
    struct trend trend;
    struct seam seam;
    int status = height_map_check_whole(map, err);
    if (status == 0)
        status = detrend(&map->grid, map->z, order->detrend, &trend, err);
    if (status == 0)
        status = seam_measure(&map->grid, map->z, &seam, err);
    if (status != 0)
        return error_context(err, "%s", order->path);
    if (seam_is_rough(&seam))
        fprintf(
            stderr,
            "rugo press: warning: %s: contact takes the map as periodic, and its seam is rougher "
            "than the roughest place inside: %.3g times across x, %.3g times across y\n",
            order->path, seam.x, seam.y);
    return 0;
}

static int press_map(const struct press_order *order, const struct height_map *map,
                     struct error *err) {
    struct press press;
    int status = press_create(&press, order, map, err);
    if (status == 0)
        status = contact_begin(press.contact, map->z, err);
    for (size_t l = 0; status == 0 && l < order->loads; l++)
        status = press_load(&press, order->load[l], press.values[l], err);
    if (status == 0 && order->output != NULL)
        status = write_pressures(&press, order, err);
    if (status == 0 && order->json)
        status = print_json(&press, order, err);
    else if (status == 0) {
        print_table(&press, order);
        status = output_flush(err);
    }
    press_clear(&press);
    return status;
}

static int run(const void *values, const char *const *arguments) {
    const struct press_options *options = values;
    struct press_order order = {
        .path = arguments[0],
        .output = options->output,
        .lengths = options->lengths,
        .detrend = (enum detrend)options->detrend,
        .json = options->json == 1,
        .block = {.poisson = options->poisson, .layer_growth = 1.1, .weighting = GAP_STANDARD}};
    struct height_map map = {0};
    struct error err = {0};
    const struct choice *model = choice_find(MODELS, options->model);
    if (model == NULL)
        return usage_error("press", "--model %.40s is not halfspace or layered", options->model);
    if (!rising_numbers(options->loads, LOADS_MOST, order.load, &order.loads))
        return usage_error("press", "--loads %.40s: not up to %d rising numbers above 0",
                           options->loads, LOADS_MOST);
    order.block.model = (enum block_model)model->value;
    if (order.block.model == MODEL_LAYERED && !(options->lengths > 0))
        order.lengths = 1.5;
    int status = map_file_read(&map, order.path, options->dx, &err);
    if (status == 0)
        status = prepare_map(&map, &order, &err);
    if (status == 0)
        status = press_map(&order, &map, &err);
    height_map_clear(&map);
    return status == 0 ? EXIT_DONE : command_fail("press", &err);
}

const struct command COMMAND_PRESS = {
    .name = "press",
    .arguments = "FILE",
    .summary = "contact of a height map in a file, periodic, with a rigid flat",
    .least = 1,
    .most = 1,
    .options = OPTIONS,
    .options_size = sizeof(struct press_options),
    .run = run,
};
