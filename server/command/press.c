/* rugo press FILE: the contact of a height map in a file with a rigid flat. */
#include "schema/study/parameter.h"
#include "server/command/command.h"
#include "server/command/map_file.h"
#include "server/command/press_error.h"
#include "server/command/press_files.h"
#include "server/command/press_loads.h"
#include "server/command/press_print.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --model may name these. */
static const struct choice MODELS[] = {
    {"halfspace", PRESS_HALFSPACE}, {"layered", PRESS_LAYERED}, {"full", PRESS_FULL}, {NULL, 0}};

enum asked { ASKED_AUTO, ASKED_OPEN, ASKED_MIRRORED, ASKED_PERIODIC };
#define BOUNDARIES "auto|open|mirrored|periodic" /* in this order */

/* Below so many nodes in contact areas and pressures are told roughly. */
enum { CONTACT_NODES_FEW = 50 };

struct press_options {
    const char *model;
    double lengths; /* height of the block in lengths of the map, 0: not given */
    int boundary, json, without_error;
    struct press_words words;
    struct press_paths paths;
    struct map_options map;
};
#define AT(member) offsetof(struct press_options, member)
static const struct option_row OPTIONS[] = {
    MAP_OPTION_ROWS(struct press_options, map),
    {"boundary", 0, OPTION_CHOICE, 0, 0, AT(boundary), BOUNDARIES, "auto",
     "open: in free space; mirrored: with its mirror images; auto: periodic where its seam is no "
     "rougher than its inside, else open"},
    {"loads", 0, OPTION_TEXT, 0, 0, AT(words.loads), "LIST", NULL,
     "rising loads p/(E* h') (0.01,0.02,0.05,0.1,0.2,0.3)"},
    {"pressure", 0, OPTION_TEXT, 0, 0, AT(words.pressure), "LIST", NULL,
     "in place of it: rising nominal pressures, such as 1MPa,2MPa"},
    {"force", 0, OPTION_TEXT, 0, 0, AT(words.force), "LIST", NULL,
     "in place of it: rising forces on the map, such as 10mN (of a profile 10N/m)"},
    {"modulus", 0, OPTION_TEXT, 0, 0, AT(words.modulus), "E", NULL,
     "Young's modulus of the block, such as 210GPa: results in physical units"},
    {"effective-modulus", 0, OPTION_TEXT, 0, 0, AT(words.effective_modulus), "E*", NULL,
     "in place of it: E* = E/(1 - nu^2), or that of two elastic bodies"},
    {"model", 0, OPTION_TEXT, 0, 0, AT(model), "halfspace|layered|full", "halfspace",
     "what the block is made of"},
    {"poisson", 0, OPTION_NUMBER, 0, 0.4999, AT(words.poisson), "NU", "0.3",
     "Poisson's ratio, of meshes and for --modulus"},
    {"height", 0, OPTION_NUMBER, 1e-3, 1e3, AT(lengths), "LENGTHS", NULL,
     "height of the block in lengths of the map (infinite; layered, full 1.5)"},
    {"error", 0, OPTION_CHOICE, 0, 0, AT(without_error), "points|none", "points",
     "tell what every second point alone changes, for a third more time at most"},
    {"format", 0, OPTION_CHOICE, 0, 0, AT(json), "text|json", "text", "what to print"},
    {"output", 'o', OPTION_TEXT, 0, 0, AT(paths.pressures), "FILE", NULL,
     "write the pressures of the last load (p/(E* h'), with a modulus Pa) as npy, csv, xyz, png or "
     "svg"},
    {"gap", 0, OPTION_TEXT, 0, 0, AT(paths.gap), "FILE", NULL, "the gaps, likewise"},
    {"contact", 0, OPTION_TEXT, 0, 0, AT(paths.contact), "FILE", NULL,
     "where there is contact (1, else 0), likewise"},
    {"vtu", 0, OPTION_TEXT, 0, 0, AT(paths.mesh), "FILE.vtu", NULL,
     "the surface with all three on it, for ParaView"},
    {0}};

/* The options ask for this. */
struct press_order {
    const char *path;
    const struct press_options *options;
    struct press_block block;
    struct press_loads loads;
    struct preparation_record record;
};

/* --- the map --- */

static enum press_boundary boundary_of(const struct press_order *order) {
    if (order->options->boundary == ASKED_MIRRORED)
        return PRESS_MIRRORED;
    return order->record.boundary == BOUNDARY_OPEN ? PRESS_OPEN : PRESS_PERIODIC;
}

/* A map is taken as periodic where the option says so; here it is told what that does. */
static void warn_of_seam(const struct press_order *order) {
    const struct seam *seam = &order->record.seam;
    if (order->options->boundary == ASKED_PERIODIC && seam_is_rough(seam))
        fprintf(
            stderr,
            "rugo press: warning: %s: contact takes the map as periodic, and its seam is rougher "
            "than the roughest place inside: %.3g times across x, %.3g times across y\n",
            order->path, seam->x, seam->y);
}

static int read_map(struct height_map *map, struct press_order *order, struct error *err) {
    static const int ASKED[] = {[ASKED_AUTO] = ASK_BOUNDARY_AUTO,
                                [ASKED_OPEN] = ASK_BOUNDARY_OPEN,
                                [ASKED_MIRRORED] = ASK_BOUNDARY_OPEN,
                                [ASKED_PERIODIC] = ASK_BOUNDARY_PERIODIC};
    struct map_options options = order->options->map;
    options.words.boundary = ASKED[order->options->boundary];
    int status = map_options_read(map, &order->record, order->path, &options, err);
    struct error holes = {0};
    if (status == 0 && height_map_check_whole(map, &holes) != 0)
        return error_set(err, ERROR_INPUT, "%s: %s; --fill fills them", order->path, holes.text);
    if (status == 0)
        status = press_loads_of_map(&order->loads, map, err);
    if (status != 0)
        return status;
    order->block.boundary = boundary_of(order);
    warn_of_seam(order);
    return 0;
}

/* --- the loads --- */

static void warn_of_few_nodes(const struct press_order *order, const double *values) {
    if (values[PRESS_CONTACT_NODES] < CONTACT_NODES_FEW)
        fprintf(stderr,
                "rugo press: warning: %s: at p/(E* h') = %.3g only %.3g %s in contact, so that "
                "areas and pressures are rough there\n",
                order->path, values[PRESS_LOAD], values[PRESS_CONTACT_NODES],
                values[PRESS_CONTACT_NODES] > 1 ? "points are" : "point is");
}

/* What is found, a row a load. */
struct pressed_loads {
    double *pressures; /* mean, in E* */
    double (*values)[PRESS_VALUES], (*errors)[PRESS_VALUES];
};

static double map_area(const struct press *press) {
    const struct grid *grid = &press->map;
    return grid_is_profile(grid) ? grid->lx : grid->lx * grid->ly;
}

/* One load after the other, and the files of the last one. */
static int press_loads(const struct press_order *order, struct press *press,
                       const struct height_map *map, struct pressed_loads *loads,
                       struct error *err) {
    double modulus = order->loads.modulus;
    int status = 0;
    for (size_t l = 0; status == 0 && l < order->loads.count; l++) {
        loads->pressures[l] = press_loads_mean(&order->loads, l, press->slope, map_area(press));
        status = press_load(press, loads->pressures[l], loads->values[l], err);
    }
    if (status != 0)
        return status;
    warn_of_few_nodes(order, loads->values[0]);
    return press_files_write(&order->options->paths, press, map->z,
                             modulus > 0 ? modulus * press->slope : 1, modulus > 0 ? "Pa" : "E* h'",
                             err);
}

static int report(const struct press_order *order, const struct press *press,
                  const struct height_map *map, const struct pressed_loads *loads,
                  struct error *err) {
    static const char *const BOUNDARY_NAMES[] = {"open", "mirrored", "periodic"};
    const struct press_report report = {
        .press = press,
        .record = &order->record,
        .boundary = BOUNDARY_NAMES[order->block.boundary],
        .boundary_by =
            order->options->boundary != ASKED_AUTO ? "option" : order->record.boundary_by,
        .model = order->options->model,
        .modulus = order->loads.modulus,
        .metres = strcmp(map->xy_unit, "m") == 0,
        .map_area = map_area(press),
        .loads = order->loads.count,
        .values = loads->values,
        .errors = order->options->without_error == 0 ? loads->errors : NULL};
    return order->options->json == 1 ? press_print_json(&report, err)
                                     : press_print_table(&report, err);
}

static int press_map(struct press_order *order, struct height_map *map, struct error *err) {
    struct press press = {0};
    size_t count = order->loads.count;
    struct pressed_loads loads = {.pressures = array_create(count, sizeof *loads.pressures),
                                  .values = array_create(count, sizeof *loads.values),
                                  .errors = array_create(count, sizeof *loads.errors)};
    int status = loads.pressures == NULL || loads.values == NULL || loads.errors == NULL
                     ? error_memory(err, count * 2 * sizeof *loads.values, "the loads")
                     : press_begin(&press, map, &order->block, err);
    if (status != 0)
        error_context(err, "%s", order->path);
    if (status == 0)
        status = press_loads(order, &press, map, &loads, err);
    press_release(&press);
    if (status == 0 && order->options->without_error == 0)
        status = press_error(&press, map, &order->block, count, loads.pressures, loads.values,
                             loads.errors, err);
    if (status == 0)
        status = report(order, &press, map, &loads, err);
    free(loads.pressures);
    free(loads.values);
    free(loads.errors);
    return status;
}

static int run(const void *values, const char *const *arguments) {
    const struct press_options *options = values;
    struct error err = {0};
    const struct choice *model = choice_find(MODELS, options->model);
    if (model == NULL)
        return usage_error("press", "--model %.40s is not halfspace, layered or full",
                           options->model);
    struct press_order *order = array_create(1, sizeof *order);
    struct height_map map = {0};
    int status = order == NULL ? error_memory(&err, sizeof *order, "the loads") : 0;
    if (status == 0) {
        order->path = arguments[0];
        order->options = options;
        order->block = (struct press_block){.model = (enum press_model)model->value,
                                            .poisson = options->words.poisson,
                                            .lengths = options->lengths};
        status = press_loads_parse(&order->loads, &options->words, &err);
        if (status == 0)
            status = press_files_check(&options->paths, &err);
    }
    if (status == 0)
        status = read_map(&map, order, &err);
    if (status == 0)
        status = press_map(order, &map, &err);
    height_map_clear(&map);
    free(order);
    return status == 0 ? EXIT_DONE : command_fail("press", &err);
}

const struct command COMMAND_PRESS = {
    .name = "press",
    .arguments = "FILE",
    .summary = "contact of a height map in a file with a rigid flat",
    .least = 1,
    .most = 1,
    .options = OPTIONS,
    .options_size = sizeof(struct press_options),
    .run = run,
};
