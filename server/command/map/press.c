/* rugo press FILE: the contact of a height map in a file with a rigid flat, or with a second map.
 */
#include "core/file.h"
#include "core/nodal/step_folder.h"
#include "jobs/allotment.h"
#include "jobs/maps/map_artefact_words.h"
#include "jobs/maps/map_counter.h"
#include "jobs/maps/map_noise.h"
#include "jobs/maps/map_press_curves.h"
#include "jobs/maps/map_press_error.h"
#include "schema/result/csv.h"
#include "schema/result/result_json.h"
#include "schema/study/parameter.h"
#include "server/command/command.h"
#include "server/command/map/map_file.h"
#include "server/command/map/map_output.h"
#include "server/command/map/press_coating.h"
#include "server/command/map/press_loads.h"
#include "server/command/output_file.h"
#include "server/show/map/map_png.h"
#include "server/show/map/press_print.h"
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

/* Paths; NULL: not wanted. By their endings maps are npy, csv, xyz, or pictures (png, svg); without
 * one npy. */
struct press_paths {
    const char *pressures, *gap, *contact;
    const char *mesh;  /* VTU of the surface with all three */
    const char *steps; /* folder of all loads */
    const char *nodes; /* table of all loads */
};

/* Before anything is computed: ERROR_INPUT for another ending, ERROR_SYSTEM where nothing can be
 * written. */
static int press_files_check(const struct press_paths *paths, struct error *err) {
    const char *const maps[] = {paths->pressures, paths->gap, paths->contact};
    int status = paths->mesh != NULL ? output_file_check(paths->mesh, err) : 0;
    if (status == 0 && paths->nodes != NULL)
        status = output_file_check(paths->nodes, err);
    for (size_t f = 0; f < sizeof maps / sizeof *maps && status == 0; f++)
        if (maps[f] != NULL)
            status = map_output_check(maps[f], err);
    return status;
}

/* What the maps of a load are in. */
struct press_units {
    const char *length, *height; /* of the map */
    bool modulus;                /* pressures are in Pa, else over E* h' */
};

enum press_map { MAP_PRESSURE, MAP_GAP, MAP_CONTACT, MAP_COUNT };

/* Draws pressures blank where there is no contact, and gaps without what the solver leaves below
 * zero in contact. */
static int draw_values(const char *path, enum press_map which, const struct map_picture *labels,
                       const struct grid *grid, const double *values, struct error *err) {
    size_t points = grid_points(grid);
    double *drawn = array_create(points, sizeof *drawn);
    if (drawn == NULL)
        return error_memory(err, points * sizeof *drawn, "a picture");
    for (size_t n = 0; n < points; n++)
        drawn[n] = values[n] < 0 ? 0 : values[n];
    if (which == MAP_PRESSURE)
        map_blank_open(grid, drawn);
    int status = map_output_write(path, labels, grid, drawn, err);
    free(drawn);
    return status;
}

static int write_map(const char *path, enum press_map which, const struct press_units *units,
                     const struct grid *grid, const double *values, struct error *err) {
    static const char *const SUBJECTS[MAP_COUNT] = {"pressure", "gap", "contact"};
    const char *const names[MAP_COUNT] = {units->modulus ? "pressure p" : "pressure p/(E* h')",
                                          "gap", "contact (1) or none (0)"};
    const char *const z_units[MAP_COUNT] = {units->modulus ? "Pa" : "", units->height, ""};
    const struct map_picture labels = {.name = SUBJECTS[which],
                                       .subject = "last load",
                                       .x_label = "x",
                                       .y_label = "y",
                                       .z_label = names[which],
                                       .xy_unit = units->length,
                                       .z_unit = z_units[which],
                                       .note = which == MAP_PRESSURE ? "blank: no contact" : NULL};
    return map_output_is_picture(path) ? draw_values(path, which, &labels, grid, values, err)
                                       : map_output_write(path, &labels, grid, values, err);
}

static int write_mesh(const char *path, const struct nodal_step *step, struct error *err) {
    struct nodal_step face = *step;
    FILE *file;
    int status = file_open(&file, path, err);
    if (status != 0)
        return status;
    face.mesh = NULL; /* the surface, whatever the model */
    status = step_vtu(file, &face, err);
    return file_close(file, path, status, err);
}

/* Writes the files of the last load. */
static int write_last(const struct press_paths *paths, const struct nodal_step *step,
                      const struct press_units *units, struct error *err) {
    const char *const list[MAP_COUNT] = {paths->pressures, paths->gap, paths->contact};
    const double *const values[MAP_COUNT] = {step->p, step->gap, step->contact};
    int status = 0;
    for (enum press_map f = 0; f < MAP_COUNT && status == 0; f++)
        if (list[f] != NULL)
            status = write_map(list[f], f, units, &step->grid, values[f], err);
    if (status == 0 && paths->mesh != NULL)
        status = write_mesh(paths->mesh, step, err);
    return status;
}

/* The files of the first model, which are written load by load. */
struct press_files {
    const struct press_paths *paths;
    const struct press_loads *loads;
    const double *z; /* heights as they are pressed */
    struct press_units units;
    struct step_folder folder;
    struct contact_step step;
};

/* Writes the part of the map that was measured: pressures are over E* h', with a modulus in Pa,
 * gaps in the map's length, contact is 1 or 0. */
static int write_load(void *context, const struct map_press *press, size_t load,
                      struct error *err) {
    struct press_files *files = context;
    const struct press_loads *loads = files->loads;
    bool last = load + 1 == loads->count;
    int status =
        map_press_step(press, files->z, loads->value[load], loads->modulus, &files->step, err);
    if (status == 0)
        status = step_folder_put(&files->folder, &files->step.step, err);
    if (status == 0 && last)
        status = write_last(files->paths, &files->step.step, &files->units, err);
    return status;
}

static bool are_asked(const struct press_paths *paths) {
    return paths->pressures != NULL || paths->gap != NULL || paths->contact != NULL ||
           paths->mesh != NULL || paths->steps != NULL || paths->nodes != NULL;
}

enum asked { ASKED_AUTO, ASKED_OPEN, ASKED_MIRRORED, ASKED_PERIODIC };
#define BOUNDARIES "auto|open|mirrored|periodic" /* in this order */
enum coupling { COUPLING_NONE, COUPLING_FRICTIONLESS, COUPLING_FRICTIONAL };
#define COUPLINGS "none|frictionless|frictional" /* in this order */

/* From so many points on threads share the work. */
enum { POINTS_SHARED = 1 << 15 };

/* With fewer nodes in contact, areas and pressures are rough. */
enum { CONTACT_NODES_FEW = 50 };

struct press_options {
    const char *model;
    const char *coating; /* NULL: none */
    const char *counter; /* file of a second map; NULL: the flat is smooth */
    double lengths;      /* height of the block in lengths of the map, 0: not given */
    double tolerance;    /* likewise */
    int boundary, format, without_error, along_y;
    int coupling; /* enum coupling */
    bool leak;
    unsigned threads; /* 0: as many processors as are allotted */
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
    {"hardness", 0, OPTION_TEXT, 0, 0, AT(words.hardness), "H", NULL,
     "pressure at which the block yields, such as 2GPa; without it, it is elastic"},
    {"friction", 0, OPTION_NUMBER, 1e-3, 10, AT(words.friction), "MU", NULL,
     "coefficient of friction: what sticks, and how far the face gives, as a tangential load rises "
     "under the highest load; loads below it are added"},
    {"direction", 0, OPTION_CHOICE, 0, 0, AT(along_y), "x|y", "x", "of the tangential load"},
    {"coupling", 0, OPTION_CHOICE, 0, 0, AT(coupling), COUPLINGS, "none",
     "with --friction: also solve slip with pressures and tractions coupled, after pressing the "
     "map "
     "without friction or with it"},
    {"resistivity", 0, OPTION_TEXT, 0, 0, AT(words.resistivity), "RHO[,RHO]", NULL,
     "electric resistivity of both bodies, or of each, in ohm m: the conductance of the contact"},
    {"conductivity", 0, OPTION_TEXT, 0, 0, AT(words.conductivity), "K[,K]", NULL,
     "in place of it: thermal conductivity in W/(m K)"},
    {"leak", 0, OPTION_FLAG, 0, 0, AT(leak), NULL, NULL,
     "what leaks through the gap along x and y, over that of a uniform gap of the same mean"},
    {"model", 0, OPTION_MODELS, 0, 0, AT(model), "MODEL", "halfspace",
     "what the block is made of; of several, with commas between, the differences to the most "
     "complete one are errors of the others"},
    {"poisson", 0, OPTION_NUMBER, 0, 0.4999, AT(words.poisson), "NU", "0.3",
     "Poisson's ratio, of meshes, of coated blocks and for --modulus"},
    {"coating", 0, OPTION_TEXT, 0, 0, AT(coating), "T,E[,NU]", NULL,
     "a layer of another material on the block (halfspace, layered): its thickness, such as 200nm, "
     "its modulus over that of the block or in Pa, and its ratio of Poisson (the block's): "
     "200nm,0.5 or 1um,4GPa,0.4"},
    {"counter", 0, OPTION_TEXT, 0, 0, AT(counter), "FILE", NULL,
     "a second map, prepared as the first, that it is pressed on, turned over about y (halfspace, "
     "layered); --effective-modulus for two elastic bodies"},
    {"height", 0, OPTION_NUMBER, 1e-3, 1e3, AT(lengths), "LENGTHS", NULL,
     "height of the block in lengths of the map (infinite; of meshes 1.5)"},
    {"tolerance", 0, OPTION_NUMBER, 1e-12, 1e-2, AT(tolerance), "T", NULL,
     "of the solutions (of linear models 1e-8, as the pressures of one map are its result; 1e-4 "
     "takes two thirds of the time)"},
    {"error", 0, OPTION_CHOICE, 0, 0, AT(without_error), "points|none", "points",
     "estimate errors by source, by every second point for a third more time at most, and of a low "
     "--height by an infinite block"},
    {"threads", 0, OPTION_COUNT, 0, WORKERS_MOST, AT(threads), "N", "0",
     "that share the work, with the same digits; 0: as many processors as are allotted"},
    {"format", 0, OPTION_CHOICE, 0, 0, AT(format), "text|json|curves|csv", "text",
     "what to print; curves, csv: as those of a study's case, with what the model alone tells"},
    {"output", 'o', OPTION_TEXT, 0, 0, AT(paths.pressures), "FILE", NULL,
     "write the pressures of the last load (p/(E* h'), with a modulus Pa) as npy, csv, xyz, png or "
     "svg"},
    {"gap", 0, OPTION_TEXT, 0, 0, AT(paths.gap), "FILE", NULL, "the gaps, likewise"},
    {"contact", 0, OPTION_TEXT, 0, 0, AT(paths.contact), "FILE", NULL,
     "where there is contact (1, else 0), likewise"},
    {"vtu", 0, OPTION_TEXT, 0, 0, AT(paths.mesh), "FILE.vtu", NULL,
     "the surface with all three on it, for ParaView"},
    {"steps", 0, OPTION_TEXT, 0, 0, AT(paths.steps), "DIR", NULL,
     "all loads of the first model: step-1.vtu ..., the surface or the meshed block, and "
     "steps.pvd"},
    {"nodes", 0, OPTION_TEXT, 0, 0, AT(paths.nodes), "FILE.csv", NULL,
     "gap, pressure and status of each node and load of the first model"},
    {0}};

enum { FORMAT_TEXT, FORMAT_JSON, FORMAT_CURVES, FORMAT_CSV };

/* The options ask for this. */
struct press_order {
    const char *path;
    const struct press_options *options;
    enum press_boundary boundary;
    size_t model_count;
    struct press_block blocks[CONTACT_MODELS_MOST]; /* one a model */
    struct press_loads loads;
    struct preparation_record record;
};

/* --- the map --- */

static enum press_boundary boundary_of(const struct press_order *order) {
    if (order->options->boundary == ASKED_MIRRORED)
        return PRESS_MIRRORED;
    return order->record.boundary == BOUNDARY_OPEN ? PRESS_OPEN : PRESS_PERIODIC;
}

/* A map is taken as periodic where the option says so; this warns of the jumps at its seam. */
static void warn_of_seam(const struct press_order *order, const char *path,
                         const struct preparation_record *record) {
    const struct seam *seam = &record->seam;
    if (order->options->boundary == ASKED_PERIODIC && seam_is_rough(seam))
        fprintf(
            stderr,
            "rugo press: warning: %s: contact takes the map as periodic, and its seam is rougher "
            "than the roughest place inside: %.3g times across x, %.3g times across y\n",
            path, seam->x, seam->y);
}

/* Gives the blocks the coating, whose thickness is in the map's lengths. */
static int take_coating(struct press_order *order, const struct height_map *map,
                        struct error *err) {
    const struct press_options *options = order->options;
    struct coating coating;
    int status = press_coating_parse(&coating, options->coating, &options->words, map, err);
    for (size_t m = 0; m < order->model_count && status == 0; m++) {
        const struct contact_model *model = order->blocks[m].model;
        order->blocks[m].coating = coating;
        if (options->coating != NULL && !model->coatings)
            status = error_set(err, ERROR_INPUT, "--coating %.60s: the model %s has no coatings",
                               options->coating, contact_model_name(model));
    }
    return status;
}

/* Reads and prepares a map that is to be pressed. */
static int read_whole(struct height_map *map, struct preparation_record *record, const char *path,
                      const struct press_order *order, const struct map_options *options,
                      struct error *err) {
    struct error holes = {0};
    int status = map_options_read(map, record, path, options, err);
    if (status == 0 && height_map_check_whole(map, &holes) != 0)
        return error_set(err, ERROR_INPUT, "%s: %s; --fill fills them", path, holes.text);
    if (status == 0)
        warn_of_seam(order, path, record);
    return status;
}

/* Notes the second face in the record of the first, and warns where they are no independent
 * faces. */
static void note_counter(struct press_order *order, const struct map_counter *counter) {
    const char *path = order->options->counter;
    const struct map_correlation *facing = &counter->facing, *held = &counter->as_held;
    struct preparation_record *record = &order->record;
    preparation_note(record, "counter face", "%.100s, turned over about y", path);
    if (counter->cropped)
        preparation_note(record, "both faces", "cropped to %zu by %zu points", counter->nx,
                         counter->ny);
    preparation_note(record, "correlation", "%.3f, of independent faces 0 +- %.3f", facing->value,
                     facing->deviation);
    if (counter->cropped)
        fprintf(stderr,
                "rugo press: %s, %s: cropped to the first %zu by %zu points, which both have\n",
                order->path, path, counter->nx, counter->ny);
    if (map_correlation_stands_out(facing))
        fprintf(stderr,
                "rugo press: warning: %s, %s: the faces are correlated by %.3g as they are "
                "pressed, where independent ones are by 0 +- %.2g\n",
                order->path, path, facing->value, facing->deviation);
    if (map_correlation_stands_out(held))
        fprintf(stderr,
                "rugo press: warning: %s, %s: the files hold heights with a correlation of %.3g, "
                "where independent faces have 0 +- %.2g; are they of one face?\n",
                order->path, path, held->value, held->deviation);
}

/* Reads the second face and adds it to the map. It repeats where both do. */
static int take_counter(struct press_order *order, struct height_map *map,
                        const struct map_options *options, struct error *err) {
    const char *path = order->options->counter;
    struct map_options own = *options;
    struct preparation_record record = {0};
    struct height_map counter = {0};
    struct map_counter sum;
    own.name = NULL;
    for (size_t m = 0; m < order->model_count; m++)
        if (!order->blocks[m].model->counter_faces)
            return error_set(err, ERROR_INPUT,
                             "--counter %.60s: the model %s has the shape of one rough face", path,
                             contact_model_name(order->blocks[m].model));
    int status = read_whole(&counter, &record, path, order, &own, err);
    if (status == 0 && record.boundary == BOUNDARY_OPEN &&
        order->record.boundary != record.boundary) {
        order->record.boundary = BOUNDARY_OPEN;
        order->record.boundary_by = record.boundary_by;
    }
    bool periodic = order->record.boundary == BOUNDARY_PERIODIC;
    if (status == 0)
        status = map_counter_add(map, &counter, periodic, &sum, err);
    if (status == 0)
        note_counter(order, &sum);
    else
        error_context(err, "--counter %.60s", path);
    height_map_clear(&counter);
    for (size_t m = 0; m < order->model_count; m++)
        order->blocks[m].two_faces = true;
    return status;
}

static int read_map(struct height_map *map, struct press_order *order, struct error *err) {
    static const int ASKED[] = {[ASKED_AUTO] = ASK_BOUNDARY_AUTO,
                                [ASKED_OPEN] = ASK_BOUNDARY_OPEN,
                                [ASKED_MIRRORED] = ASK_BOUNDARY_OPEN,
                                [ASKED_PERIODIC] = ASK_BOUNDARY_PERIODIC};
    struct map_options options = order->options->map;
    options.words.boundary = ASKED[order->options->boundary];
    int status = read_whole(map, &order->record, order->path, order, &options, err);
    if (status == 0 && order->options->counter != NULL)
        status = take_counter(order, map, &options, err);
    if (status == 0)
        status = press_loads_of_map(&order->loads, map, err);
    if (status != 0)
        return status;
    order->boundary = boundary_of(order);
    status = take_coating(order, map, err);
    for (size_t m = 0; m < order->model_count && status == 0; m++)
        status = map_press_check(order->boundary, order->blocks[m].model, err);
    return status == 0 ? 0 : error_context(err, "%s", order->path);
}

/* --- the loads --- */

static void warn_of_few_nodes(const struct press_order *order, const struct press_row *row) {
    double nodes = row->value[PRESS_CONTACT_NODES];
    if (nodes < CONTACT_NODES_FEW)
        fprintf(stderr,
                "rugo press: warning: %s: at p/(E* h') = %.3g only %.3g %s in contact, so that "
                "areas and pressures are rough there\n",
                order->path, row->value[PRESS_LOAD], nodes, nodes > 1 ? "points are" : "point is");
}

/* Slopes with noise in them are no measure of loads; press takes the map as it is. Of larger maps
 * the spectrum would take longer than a load. */
static int warn_of_noise(const struct press_order *order, const struct height_map *map,
                         struct error *err) {
    enum { POINTS_SEEN = 1 << 20 };
    const struct measured_map measured = {&map->grid, map->z, order->record.boundary};
    struct map_noise noise;
    if (grid_points(&map->grid) > POINTS_SEEN || order->record.window_power < 1)
        return 0;
    int status = map_noise_measure(&noise, &measured, err);
    if (status == 0 && noise.governs)
        fprintf(stderr,
                "rugo press: warning: %s: noise governs the slopes, whose RMS is %.3g with it and "
                "%.3g without; --denoise takes it out (`rugo characterise` shows it)\n",
                order->path, noise.slope, noise.without);
    return status;
}

/* So are those that hold what the instrument left. */
static void warn_of_artefacts(const struct press_order *order, const struct height_map *map) {
    char sentences[ARTEFACT_SENTENCES_MOST][ARTEFACT_SENTENCE_SIZE];
    const size_t count =
        map_artefact_sentences(sentences, &order->record.artefacts, &map->grid, map->z_unit, true);
    for (size_t n = 0; n < count; n++)
        fprintf(stderr, "rugo press: warning: %s: %s\n", order->path, sentences[n]);
}

static double map_area(const struct map_press *press) {
    const struct grid *grid = &press->map;
    return grid_is_profile(grid) ? grid->lx : grid->lx * grid->ly;
}

/* The map under all loads, by each model. */
struct pressed {
    struct map_press press;
    double *pressures;      /* mean, in E*; owned, as the rows */
    struct press_row *rows; /* all loads of the first model, then those of the next */
    struct press_series series[CONTACT_MODELS_MOST];
};

static void pressed_clear(struct pressed *pressed) {
    struct team *team = pressed->press.team;
    map_press_clear(&pressed->press);
    team_destroy(&team);
    free(pressed->pressures);
    free(pressed->rows);
}

/* Loads without a solution are no failure where another model has them, and no file needs them. */
static int keep_others(const struct press_order *order, size_t m, int status, struct error *err) {
    const struct contact_model *model = order->blocks[m].model;
    bool files = m == 0 && are_asked(&order->options->paths);
    if (status != ERROR_NUMERIC || order->model_count == 1 || !model->may_fail || files)
        return error_context(err, "%s", order->path);
    fprintf(stderr, "rugo press: warning: %s: model %s has no values from a load on: %s\n",
            order->path, contact_model_name(model), err->text);
    *err = (struct error){0};
    return 0;
}

static int press_loads(const struct press_order *order, struct pressed *pressed,
                       const struct height_map *map, size_t m, struct error *err) {
    struct press_series *series = &pressed->series[m];
    size_t loads = order->loads.count;
    *series = (struct press_series){.block = order->blocks[m], .rows = pressed->rows + m * loads};
    int status = map_press_loads(&pressed->press, map->z, loads, pressed->pressures, series, err);
    return status != 0 ? keep_others(order, m, status, err) : 0;
}

/* Presses by the first model, and writes its files. */
static int press_first(const struct press_order *order, struct pressed *pressed,
                       const struct height_map *map, struct error *err) {
    const struct press_paths *paths = &order->options->paths;
    struct press_files files = {.paths = paths,
                                .loads = &order->loads,
                                .z = map->z,
                                .units = {map->xy_unit, map->z_unit, order->loads.modulus > 0}};
    const struct press_watch watch = {write_load, &files};
    int status = step_folder_open(&files.folder, paths->steps, paths->nodes, err);
    if (status == 0) {
        pressed->press.watch = are_asked(paths) ? &watch : NULL;
        status = press_loads(order, pressed, map, 0, err);
        pressed->press.watch = NULL;
    }
    status = step_folder_close(&files.folder, status, err);
    contact_step_clear(&files.step);
    if (status == 0)
        warn_of_few_nodes(order, &pressed->series[0].rows[0]);
    return status;
}

static int print_json(const struct press_report *report, struct error *err) {
    cJSON *document = press_document(report);
    int status = document != NULL ? output_document(document, err)
                                  : error_memory(err, sizeof(cJSON), "the contact");
    cJSON_Delete(document);
    return status;
}

/* As those of a study with one case. Returns false when out of memory. */
static bool print_curves(const struct press_report *report, int format) {
    const struct study_result study = {.case_count = 1, .cases = report->result};
    if (format == FORMAT_CSV)
        return csv_print(stdout, &study);
    return result_print(stdout, report->result) && putchar('\n') != EOF;
}

static int print(const struct press_report *report, int format, struct error *err) {
    if (format == FORMAT_JSON)
        return print_json(report, err);
    if (format == FORMAT_TEXT)
        press_print_table(stdout, report);
    else if (!print_curves(report, format))
        return error_memory(err, sizeof *report->result, "the curves");
    return output_flush(err);
}

static double seconds_of(const struct rusage *usage) {
    const struct timeval *user = &usage->ru_utime, *system = &usage->ru_stime;
    return (double)(user->tv_sec + system->tv_sec) +
           1e-6 * (double)(user->tv_usec + system->tv_usec);
}

static int report(const struct press_order *order, const struct pressed *pressed,
                  const struct height_map *map, struct error *err) {
    static const char *const BOUNDARY_NAMES[] = {"open", "mirrored", "periodic"};
    const struct map_press *press = &pressed->press;
    struct case_result result = {0};
    struct rusage usage = {0};
    getrusage(RUSAGE_SELF, &usage);
    const struct press_report report = {.press = press,
                                        .record = &order->record,
                                        .boundary = BOUNDARY_NAMES[order->boundary],
                                        .boundary_by = order->options->boundary != ASKED_AUTO
                                                           ? "option"
                                                           : order->record.boundary_by,
                                        .model_count = order->model_count,
                                        .series = pressed->series,
                                        .modulus = order->loads.modulus,
                                        .resistivity = order->loads.resistivity,
                                        .heat = order->loads.heat,
                                        .metres = strcmp(map->xy_unit, "m") == 0,
                                        .map_area = map_area(press),
                                        .loads = order->loads.count,
                                        .with_errors = order->options->without_error == 0,
                                        .cpu_seconds = seconds_of(&usage),
                                        .peak_bytes = 1024. * (double)usage.ru_maxrss,
                                        .result = &result};
    int status = map_press_result(&result, press, order->model_count, pressed->series,
                                  order->loads.count, err);
    if (status == 0)
        status = print(&report, order->options->format, err);
    result_clear(&result);
    return status;
}

/* Fills the mean pressures of all loads, over E*, which are below the hardness. */
static int find_pressures(const struct press_order *order, struct pressed *pressed,
                          struct error *err) {
    const struct press_loads *loads = &order->loads;
    const struct map_press *press = &pressed->press;
    for (size_t l = 0; l < loads->count; l++) {
        double mean = press_loads_mean(loads, l, press->slope, map_area(press));
        pressed->pressures[l] = mean;
        if (loads->hardness > 0 && !(mean < loads->hardness))
            return error_set(err, ERROR_INPUT,
                             "%s: load %zu, p/(E* h') = %.4g, is a mean pressure of %.4g Pa, and "
                             "nothing bears the --hardness, %s, or more",
                             order->path, l + 1, mean / press->slope, mean * loads->modulus,
                             order->options->words.hardness);
    }
    return 0;
}

static int press_models(const struct press_order *order, struct pressed *pressed,
                        const struct height_map *map, struct error *err) {
    const struct map_press *press = &pressed->press;
    size_t loads = order->loads.count;
    int status = find_pressures(order, pressed, err);
    for (size_t m = 0; m < order->model_count && status == 0; m++)
        status = m == 0 ? press_first(order, pressed, map, err)
                        : press_loads(order, pressed, map, m, err);
    map_press_release(&pressed->press);
    if (status == 0 && order->options->without_error == 0)
        status = map_press_error(press, map, order->model_count, pressed->series, loads,
                                 pressed->pressures, err);
    return status == 0 ? report(order, pressed, map, err) : status;
}

static int press_map(const struct press_order *order, struct height_map *map, struct error *err) {
    size_t loads = order->loads.count, count = order->model_count * loads;
    struct pressed pressed = {.pressures = array_create(loads, sizeof *pressed.pressures),
                              .rows = array_create(count, sizeof *pressed.rows)};
    unsigned threads = order->options->threads;
    int status = pressed.pressures == NULL || pressed.rows == NULL
                     ? error_memory(err, count * sizeof *pressed.rows, "the loads")
                     : map_press_begin(&pressed.press, map, order->boundary, err);
    if (status != 0)
        error_context(err, "%s", order->path);
    else if (grid_points(&map->grid) >= POINTS_SHARED)
        status = team_create(&pressed.press.team, threads > 0 ? threads : allotment_threads(), err);
    if (status == 0)
        status = press_models(order, &pressed, map, err);
    pressed_clear(&pressed);
    return status;
}

/* Checks what the coupling of tractions and pressures excludes. */
static int check_coupling(const struct press_order *order, struct error *err) {
    if (!(order->options->words.friction > 0))
        return error_set(err, ERROR_INPUT, "--coupling: nothing slips unless --friction is given");
    if (order->loads.hardness > 0)
        return error_set(err, ERROR_INPUT,
                         "--coupling and --hardness: a block that yields has none");
    for (size_t m = 0; m < order->model_count; m++) {
        const struct contact_model *model = order->blocks[m].model;
        const double height =
            order->blocks[m].lengths > 0 ? order->blocks[m].lengths : model->default_height;
        if (model->elements || isfinite(height))
            return error_set(err, ERROR_INPUT,
                             "--coupling: it is that of an infinite half-space, and the block of "
                             "the model %s has a height; leave one of them out",
                             contact_model_name(model));
    }
    return 0;
}

/* Sets the models and their blocks. */
static int order_models(struct press_order *order, struct error *err) {
    const struct press_options *options = order->options;
    int positions[CONTACT_MODELS_MOST];
    if (!models_find(options->model, positions, &order->model_count))
        return error_set(err, ERROR_INPUT, "there is no model %.40s", options->model);
    for (size_t m = 0; m < order->model_count; m++)
        order->blocks[m] =
            (struct press_block){.model = CONTACT_MODELS[positions[m]],
                                 .poisson = options->words.poisson,
                                 .lengths = options->lengths,
                                 .tolerance = options->tolerance,
                                 .hardness = order->loads.hardness,
                                 .conducts = order->loads.resistivity > 0,
                                 .friction = options->words.friction,
                                 .angle = options->along_y ? M_PI / 2 : 0,
                                 .coupled = options->coupling != COUPLING_NONE,
                                 .pressing = options->coupling == COUPLING_FRICTIONAL,
                                 .leaks = options->leak};
    if (options->coupling != COUPLING_NONE && check_coupling(order, err) != 0)
        return ERROR_INPUT;
    if (order->loads.resistivity > 0 && options->coating != NULL)
        return error_set(err, ERROR_INPUT,
                         "--%s and --coating: what passes a coating is not known from its contact",
                         order->loads.heat ? "conductivity" : "resistivity");
    if (options->words.friction > 0 && options->coating != NULL)
        return error_set(err, ERROR_INPUT,
                         "--friction and --coating: how a coating gives tangentially is not known "
                         "from its contact");
    for (size_t m = 0; m < order->model_count && options->words.friction > 0; m++)
        if (order->blocks[m].model->block_of != NULL)
            return error_set(err, ERROR_INPUT,
                             "--friction: the model %s has none; leave one of them out",
                             contact_model_name(order->blocks[m].model));
    for (size_t m = 0; m < order->model_count && order->loads.hardness > 0; m++)
        if (!order->blocks[m].model->yields)
            return error_set(err, ERROR_INPUT,
                             "--hardness: the model %s does not yield; leave one of them out",
                             contact_model_name(order->blocks[m].model));
    return 0;
}

static int run(const void *values, const char *const *arguments) {
    const struct press_options *options = values;
    struct error err = {0};
    struct press_order *order = array_create(1, sizeof *order);
    struct height_map map = {0};
    int status = order == NULL ? error_memory(&err, sizeof *order, "the loads") : 0;
    if (status == 0) {
        order->path = arguments[0];
        order->options = options;
        status = press_loads_parse(&order->loads, &options->words, &err);
    }
    if (status == 0)
        status = order_models(order, &err);
    if (status == 0)
        status = press_files_check(&options->paths, &err);
    if (status == 0)
        status = read_map(&map, order, &err);
    if (status == 0)
        warn_of_artefacts(order, &map);
    if (status == 0)
        status = warn_of_noise(order, &map, &err);
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
