/* rugo press FILE: the contact of a height map in a file with a rigid flat, or with a second map.
 */
#include "core/map/length_unit.h"
#include "jobs/allotment.h"
#include "jobs/maps/map_counter.h"
#include "jobs/maps/press/map_press_curves.h"
#include "jobs/maps/press/map_press_error.h"
#include "schema/study/parameter.h"
#include "server/command/command.h"
#include "server/command/map/map_file.h"
#include "server/command/map/press/press_coating.h"
#include "server/command/map/press/press_face.h"
#include "server/command/map/press/press_files.h"
#include "server/command/map/press/press_loads.h"
#include "server/command/map/press/press_path.h"
#include "server/command/map/press/press_room.h"
#include "server/command/map/press/press_warnings.h"
#include "server/show/map/press_print.h"
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

enum asked { ASKED_AUTO, ASKED_OPEN, ASKED_MIRRORED, ASKED_PERIODIC };
#define BOUNDARIES "auto|open|mirrored|periodic" /* in this order */
enum coupling { COUPLING_NONE, COUPLING_FRICTIONLESS, COUPLING_FRICTIONAL };
#define COUPLINGS "none|frictionless|frictional"                /* in this order */
#define KINEMATICS "hencky|st_venant_kirchhoff|small|neo_hooke" /* as KINEMATICS_CHOICES */

/* From so many points on threads share the work. */
enum { POINTS_SHARED = 1 << 15 };

/* With fewer nodes in contact, areas and pressures are rough. */
enum { CONTACT_NODES_FEW = 50 };

/* From so many seconds on, as estimated, each load is named on standard error. */
static const double SECONDS_WATCHED = 10;
/* The most that the model full slides with. */
static const double SLIDING_FRICTION_MOST = 1;

struct press_options {
    const char *model;
    const char *coating; /* NULL: none */
    const char *counter; /* file of a second map; NULL: the flat is smooth */
    double lengths;      /* height of the block in longer sides of the map, 0: not given */
    double tolerance;    /* likewise */
    int boundary, format, without_error, along_y;
    int coupling; /* enum coupling */
    int kinematics, weighting;
    int current_areas, normal_gaps; /* 0: over the flat, vertical */
    double transition, seconds_most;
    bool leak, estimate;
    const char *slide_to;
    unsigned slide_steps;
    unsigned threads; /* 0: as many processors as are allotted */
    struct press_words words;
    struct press_paths paths;
    struct map_options map;
};
#define AT(member) offsetof(struct press_options, member)
static const struct option_row OPTIONS[] = {
    MAP_OPTION_ROWS(struct press_options, map),
    MAP_EXTEND_ROW(struct press_options, map),
    {"boundary", 0, OPTION_CHOICE, 0, 0, AT(boundary), BOUNDARIES, "auto",
     "open: in free space; mirrored: with its mirror images; auto: periodic where its seam is no "
     "rougher than its inside, else open, or mirrored for a model that needs a map that repeats"},
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
     "pressure at which the block yields, such as 2GPa; without it, it is elastic; loads also fall "
     "again, where a coating of more than about 3 times the modulus may end it"},
    {"friction", 0, OPTION_NUMBER, 1e-3, 10, AT(words.friction), "MU", NULL,
     "coefficient of friction: what sticks, and how far the face gives, as a tangential load rises "
     "under the highest load (loads below it are added); the model full drags the flat along x "
     "(--slide-to), with up to 1"},
    {"direction", 0, OPTION_CHOICE, 0, 0, AT(along_y), "x|y", "x", "of the tangential load"},
    {"coupling", 0, OPTION_CHOICE, 0, 0, AT(coupling), COUPLINGS, "none",
     "with --friction: also solve slip with pressures and tractions coupled, after pressing the "
     "map without friction or with it; the model full always does, and presses without it unless "
     "frictional"},
    {"slide-to", 0, OPTION_TEXT, 0, 0, AT(slide_to), "LIST", NULL,
     "with --friction and the model full: how far the flat slides over the face, over the RMS "
     "height (4 MU); several values are points at which it turns"},
    {"slide-steps", 0, OPTION_COUNT, 1, 999, AT(slide_steps), "N", NULL,
     "points of its curves from one turn to the next (30)"},
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
     "height of the block in lengths of the map, of a rectangle the longer side (infinite; of "
     "meshes 1.5)"},
    {"kinematics", 0, OPTION_CHOICE, 0, 0, AT(kinematics), KINEMATICS, "hencky",
     "of the model full: finite strain by Hencky's law, St. Venant and Kirchhoff's or "
     "neo-Hooke's, or small strain on the rough geometry"},
    {"gap-weighting", 0, OPTION_CHOICE, 0, 0, AT(weighting), "standard|dual", "standard",
     "of meshes: the gap of a node is that over its neighbours, too, or at it alone"},
    {"areas", 0, OPTION_CHOICE, 0, 0, AT(current_areas), "flat|current", "flat",
     "of the model full: what areas and mean gaps are over, the flat grid or the face as it stands "
     "under load, with its slopes"},
    {"gap-direction", 0, OPTION_CHOICE, 0, 0, AT(normal_gaps), "vertical|normal", "vertical",
     "of the model full: direction in which gaps are measured, vertical or along the face's "
     "normal"},
    {"transition-depth", 0, OPTION_NUMBER, 1, 1e9, AT(transition), "WIDTHS", "8",
     "of the model full: depth from which columns of elements are twice as wide, and twice again; "
     "1e9: all as wide as those of the face"},
    {"estimate", 0, OPTION_FLAG, 0, 0, AT(estimate), NULL, NULL,
     "print what the model full would take, and press nothing"},
    {"limit", 0, OPTION_NUMBER, 0, 1e9, AT(seconds_most), "SECONDS", "3600",
     "of CPU time for the model full: a map that is estimated to take more is refused, and where "
     "it takes more in the end the loads so far are kept; 0: none"},
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
    {"vtu", 0, OPTION_TEXT, 0, 0, AT(paths.face), "FILE.vtu", NULL,
     "the surface with all three on it, for ParaView"},
    {"mesh", 0, OPTION_TEXT, 0, 0, AT(paths.mesh), "FILE.vtu|FILE.msh|FILE.inp", NULL,
     "the block of the model full under the last load: .vtu with displacements and stresses, .msh "
     "for Gmsh, .inp for CalculiX and Abaqus with a step a load; the model is named first"},
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
    bool slides;                                    /* a model has friction at finite strain */
    struct press_path slide;                        /* owned; of the flat, where one does */
    struct press_loads loads;
    struct preparation_record record;
};

/* --- the map --- */

static bool needs_periodic(const struct press_order *order) {
    bool needs = false;
    for (size_t m = 0; m < order->model_count; m++)
        needs = needs || !order->blocks[m].model->free_space;
    return needs;
}

/* A map that was found to be open is mirrored for models that need one that repeats. */
static enum press_boundary boundary_of(const struct press_order *order) {
    const int asked = order->options->boundary;
    if (asked == ASKED_MIRRORED)
        return PRESS_MIRRORED;
    if (order->record.boundary != BOUNDARY_OPEN)
        return PRESS_PERIODIC;
    return asked == ASKED_AUTO && needs_periodic(order) ? PRESS_MIRRORED : PRESS_OPEN;
}

static const char *boundary_by(const struct press_order *order) {
    if (order->options->boundary != ASKED_AUTO && order->options->map.words.extend == NULL)
        return "option";
    return order->boundary == PRESS_MIRRORED ? "model" : order->record.boundary_by;
}

/* A map is taken as periodic where the option says so; this warns of the jumps at its seam. Sides
 * of fewer than SEAM_POINTS points have no inside to compare them with. */
static void warn_of_seam(const struct press_order *order, const char *path, const struct grid *grid,
                         const struct preparation_record *record) {
    const struct seam seam = {grid->nx < SEAM_POINTS ? 0 : record->seam.x,
                              grid->ny < SEAM_POINTS ? 0 : record->seam.y};
    if (order->options->boundary == ASKED_PERIODIC && seam_is_rough(&seam))
        fprintf(
            stderr,
            "rugo press: warning: %s: contact takes the map as periodic, and its seam is rougher "
            "than the roughest place inside: %.3g times across x, %.3g times across y\n",
            path, seam.x, seam.y);
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
        warn_of_seam(order, path, &map->grid, record);
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

/* An extended map repeats, and a number is one draw. */
static int check_extension(const struct press_options *options, struct error *err) {
    if (options->map.words.extend == NULL)
        return 0;
    if (options->boundary == ASKED_MIRRORED)
        return error_set(err, ERROR_INPUT,
                         "--extend makes a map that repeats, and --boundary mirrored another; "
                         "allowed: one of them");
    if (options->counter != NULL)
        return error_set(err, ERROR_INPUT,
                         "--extend %.60s with --counter: both faces would go on by the same draw; "
                         "rugo convert --extend writes each with its own",
                         options->map.words.extend);
    return 0;
}

static int read_map(struct height_map *map, struct press_order *order, struct error *err) {
    static const int ASKED[] = {[ASKED_AUTO] = ASK_BOUNDARY_AUTO,
                                [ASKED_OPEN] = ASK_BOUNDARY_OPEN,
                                [ASKED_MIRRORED] = ASK_BOUNDARY_OPEN,
                                [ASKED_PERIODIC] = ASK_BOUNDARY_PERIODIC};
    struct map_options options = order->options->map;
    options.words.boundary = ASKED[order->options->boundary];
    int status = check_extension(order->options, err);
    if (status == 0)
        status = read_whole(map, &order->record, order->path, order, &options, err);
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

static double map_area(const struct map_press *press) {
    const struct grid *grid = &press->map;
    return grid_is_profile(grid) ? grid->lx : grid->lx * grid->ly;
}

/* The map under all loads, by each model. */
struct pressed {
    struct map_press press;
    double *pressures;        /* mean, in E*; owned, as the next */
    double *loads;            /* the same in E* h' */
    struct press_row *rows;   /* all loads of the first model, then those of the next */
    struct press_row *slides; /* likewise, of the path; NULL: none */
    struct press_series series[CONTACT_MODELS_MOST];
    double seconds[CONTACT_MODELS_MOST]; /* of models with a mesh, as estimated; 0: not known */
};

static void pressed_clear(struct pressed *pressed) {
    struct team *team = pressed->press.team;
    map_press_clear(&pressed->press);
    team_destroy(&team);
    free(pressed->pressures);
    free(pressed->loads);
    free(pressed->rows);
    free(pressed->slides);
}

/* Returns how many loads of a series have values, which come first. */
static size_t solved_of(const struct press_series *series, size_t loads) {
    size_t solved = 0;
    while (solved < loads && !isnan(series->rows[solved].value[MEASURE_NODES]))
        solved++;
    return solved;
}

/* Loads without a solution are no failure where the model, or another one, has some: a note has
 * the reason. Files are those of the loads before. */
static int keep_loads(const struct press_order *order, struct press_series *series, size_t m,
                      int status, struct error *err) {
    const struct contact_model *model = order->blocks[m].model;
    const size_t loads = order->loads.count, solved = solved_of(series, loads);
    bool needed = order->model_count == 1 || (m == 0 && press_paths_ask(&order->options->paths));
    bool ended = status == ERROR_NUMERIC || status == ERROR_STOPPED;
    if (!ended || !model->may_fail || (solved == 0 && needed))
        return error_context(err, "%s", order->path);
    if (solved == loads)
        snprintf(series->note, sizeof series->note, "the path of the flat ends: %.300s", err->text);
    else
        snprintf(series->note, sizeof series->note, "no values from p/(E* h') = %.4g on: %.300s",
                 series->rows[solved].value[PRESS_LOAD], err->text);
    fprintf(stderr, "rugo press: warning: %s: model %s: %s\n", order->path,
            contact_model_name(model), series->note);
    *err = (struct error){0};
    return 0;
}

static double seconds_of(const struct rusage *usage) {
    const struct timeval *user = &usage->ru_utime, *system = &usage->ru_stime;
    return (double)(user->tv_sec + system->tv_sec) +
           1e-6 * (double)(user->tv_usec + system->tv_usec);
}

/* What happens after each load of a model. */
struct press_follow {
    const struct press_order *order;
    struct press_files *files; /* of the first model; NULL: none */
    size_t m;
    bool shown; /* on standard error */
};

static int follow_load(void *context, const struct map_press *press, size_t load,
                       struct error *err) {
    const struct press_follow *follow = context;
    const struct press_order *order = follow->order;
    struct rusage usage = {0};
    getrusage(RUSAGE_SELF, &usage);
    if (follow->shown)
        fprintf(stderr, "rugo press: %s: model %s: load %zu of %zu, %.3g s of CPU time so far\n",
                order->path, contact_model_name(order->blocks[follow->m].model), load + 1,
                order->loads.count, seconds_of(&usage));
    return follow->files != NULL ? press_files_write(follow->files, press, load, err) : 0;
}

static int press_loads(const struct press_order *order, struct pressed *pressed,
                       const struct height_map *map, size_t m, struct press_files *files,
                       struct error *err) {
    struct map_press *press = &pressed->press;
    struct press_series *series = &pressed->series[m];
    const size_t loads = order->loads.count, points = order->slide.count;
    struct press_follow follow = {order, files, m, pressed->seconds[m] > SECONDS_WATCHED};
    const struct press_watch watch = {follow_load, &follow};
    *series = (struct press_series){.block = order->blocks[m],
                                    .rows = pressed->rows + m * loads,
                                    .slides = points > 0 ? pressed->slides + m * points : NULL};
    press->watch = &watch;
    press->seconds_most = order->blocks[m].model->may_fail ? order->options->seconds_most : 0;
    int status = map_press_loads(press, map->z, loads, pressed->pressures, series, err);
    press->watch = NULL;
    return status != 0 ? keep_loads(order, series, m, status, err) : 0;
}

/* Presses by the first model, and writes its files. */
static int press_first(const struct press_order *order, struct pressed *pressed,
                       const struct height_map *map, struct error *err) {
    struct press_files files = {.paths = &order->options->paths,
                                .loads = &order->loads,
                                .z = map->z,
                                .units = {map->xy_unit, map->z_unit, order->loads.modulus > 0}};
    int status = press_files_open(&files, err);
    if (status == 0)
        status = press_loads(order, pressed, map, 0, &files, err);
    status = press_files_close(&files, status, err);
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

static int print(const struct press_report *report, int format, struct error *err) {
    if (format == FORMAT_JSON)
        return print_json(report, err);
    if (format == FORMAT_TEXT)
        press_print_table(stdout, report);
    else if (!press_print_curves(stdout, report, format == FORMAT_CSV))
        return error_memory(err, sizeof *report->result, "the curves");
    return output_flush(err);
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
                                        .boundary_by = boundary_by(order),
                                        .model_count = order->model_count,
                                        .series = pressed->series,
                                        .modulus = order->loads.modulus,
                                        .resistivity = order->loads.resistivity,
                                        .heat = order->loads.heat,
                                        .metres = length_unit_is_metre(map->xy_unit),
                                        .unit_note = height_map_unit_note(map),
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

/* Fills the mean pressures of all loads, which are below the hardness. */
static int find_pressures(const struct press_order *order, struct pressed *pressed,
                          struct error *err) {
    const struct press_loads *loads = &order->loads;
    const struct map_press *press = &pressed->press;
    for (size_t l = 0; l < loads->count; l++) {
        double mean = press_loads_mean(loads, l, press->slope, map_area(press));
        pressed->pressures[l] = mean;
        pressed->loads[l] = mean / press->slope;
        if (loads->hardness > 0 && !(mean < loads->hardness))
            return error_set(err, ERROR_INPUT,
                             "load %zu, p/(E* h') = %.4g, is a mean pressure of %.4g Pa, and "
                             "nothing bears the --hardness, %s, or more",
                             l + 1, pressed->loads[l], mean * loads->modulus,
                             order->options->words.hardness);
    }
    return 0;
}

static int press_models(const struct press_order *order, struct pressed *pressed,
                        const struct height_map *map, struct error *err) {
    const struct map_press *press = &pressed->press;
    size_t loads = order->loads.count;
    int status = 0;
    for (size_t m = 0; m < order->model_count && status == 0; m++)
        status = m == 0 ? press_first(order, pressed, map, err)
                        : press_loads(order, pressed, map, m, NULL, err);
    map_press_release(&pressed->press);
    pressed->press.seconds_most = order->options->seconds_most;
    if (status == 0 && order->options->without_error == 0)
        status = map_press_error(press, map, order->model_count, pressed->series, loads,
                                 pressed->pressures, err);
    return status == 0 ? report(order, pressed, map, err) : status;
}

/* Prints what it would take, or presses. */
static int press_or_estimate(const struct press_order *order, struct pressed *pressed,
                             const struct height_map *map, struct error *err) {
    const struct press_options *options = order->options;
    const struct press_room_order room = {.press = &pressed->press,
                                          .blocks = order->blocks,
                                          .model_count = order->model_count,
                                          .goals = {order->loads.count, pressed->loads},
                                          .seconds_most = options->seconds_most,
                                          .with_errors = options->without_error == 0};
    int status = find_pressures(order, pressed, err);
    if (status == 0 && options->estimate) {
        press_room_print(stdout, &room);
        return output_flush(err);
    }
    if (status == 0)
        status = press_room_check(&room, err);
    for (size_t m = 0; m < order->model_count; m++)
        pressed->seconds[m] = press_room_seconds(&room, m);
    return status != 0 ? error_context(err, "%s", order->path)
                       : press_models(order, pressed, map, err);
}

/* Makes room for all values. */
static int pressed_create(struct pressed *pressed, const struct press_order *order,
                          struct error *err) {
    const size_t loads = order->loads.count, points = order->slide.count;
    const size_t count = order->model_count * (loads + points);
    pressed->pressures = array_create(loads, sizeof *pressed->pressures);
    pressed->loads = array_create(loads, sizeof *pressed->loads);
    pressed->rows = array_create(order->model_count * loads, sizeof *pressed->rows);
    if (points > 0)
        pressed->slides = array_create(order->model_count * points, sizeof *pressed->slides);
    return pressed->pressures != NULL && pressed->loads != NULL && pressed->rows != NULL &&
                   (points == 0 || pressed->slides != NULL)
               ? 0
               : error_memory(err, count * sizeof *pressed->rows, "the loads");
}

static int press_map(const struct press_order *order, struct height_map *map, struct error *err) {
    struct pressed pressed = {.pressures = NULL};
    unsigned threads = order->options->threads;
    int status = pressed_create(&pressed, order, err);
    if (status == 0)
        status = map_press_begin(&pressed.press, map, order->boundary, err);
    if (status != 0)
        error_context(err, "%s", order->path);
    else if (grid_points(&map->grid) >= POINTS_SHARED)
        status = team_create(&pressed.press.team, threads > 0 ? threads : allotment_threads(), err);
    if (status == 0)
        status = press_or_estimate(order, &pressed, map, err);
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
        if (!order->slides && (model->elements || isfinite(height)))
            return error_set(err, ERROR_INPUT,
                             "--coupling: it is that of an infinite half-space, and the block of "
                             "the model %s has a height; leave one of them out",
                             contact_model_name(model));
    }
    return 0;
}

/* Checks friction, and reads the path of the flat where a model slides. */
static int order_friction(struct press_order *order, struct error *err) {
    const struct press_options *options = order->options;
    const double friction = options->words.friction;
    if (!order->slides && (options->slide_to != NULL || options->slide_steps > 0))
        return error_set(err, ERROR_INPUT,
                         "--%s belongs to --friction with a model that slides at finite strain, "
                         "such as --model full",
                         options->slide_to != NULL ? "slide-to" : "slide-steps");
    if (options->coupling != COUPLING_NONE && check_coupling(order, err) != 0)
        return ERROR_INPUT;
    if (friction > 0 && options->coating != NULL)
        return error_set(err, ERROR_INPUT,
                         "--friction and --coating: how a coating gives tangentially is not known "
                         "from its contact");
    if (!order->slides)
        return 0;
    if (friction > SLIDING_FRICTION_MOST)
        return error_set(err, ERROR_INPUT, "--friction %g; allowed with the model full: (0, %g]",
                         friction, SLIDING_FRICTION_MOST);
    int status =
        press_path_parse(&order->slide, options->slide_to, options->slide_steps, friction, err);
    for (size_t m = 0; m < order->model_count && status == 0; m++) {
        order->blocks[m].slide = order->slide.at;
        order->blocks[m].slide_count = order->slide.count;
        order->blocks[m].slide_steps = order->slide.steps;
    }
    return status;
}

/* Finds the models, and reads the loads, to which friction by lighter ones adds some. */
static int order_loads(struct press_order *order, struct error *err) {
    const struct press_options *options = order->options;
    struct press_words words = options->words;
    int positions[CONTACT_MODELS_MOST];
    if (!models_find(options->model, positions, &order->model_count))
        return error_set(err, ERROR_INPUT, "there is no model %.40s", options->model);
    for (size_t m = 0; m < order->model_count; m++) {
        order->blocks[m].model = CONTACT_MODELS[positions[m]];
        order->slides = order->slides || (words.friction > 0 && order->blocks[m].model->slides);
    }
    if (order->slides)
        words.friction = 0;
    return press_loads_parse(&order->loads, &words, err);
}

/* Checks what the files of a mesh need. */
static int check_mesh(const struct press_order *order, struct error *err) {
    const struct press_options *options = order->options;
    const struct contact_model *first = order->blocks[0].model;
    if (options->paths.mesh != NULL && first->block_of == NULL)
        return error_set(err, ERROR_INPUT,
                         "--mesh: the model %s, the first, has no mesh; --model full has",
                         contact_model_name(first));
    return 0;
}

/* Sets the models and their blocks. */
static int order_models(struct press_order *order, struct error *err) {
    const struct press_options *options = order->options;
    for (size_t m = 0; m < order->model_count; m++)
        order->blocks[m] =
            (struct press_block){.model = order->blocks[m].model,
                                 .poisson = options->words.poisson,
                                 .lengths = options->lengths,
                                 .tolerance = options->tolerance,
                                 .hardness = order->loads.hardness,
                                 .conducts = order->loads.resistivity > 0,
                                 .friction = options->words.friction,
                                 .angle = options->along_y ? M_PI / 2 : 0,
                                 .coupled = options->coupling != COUPLING_NONE,
                                 .pressing = options->coupling == COUPLING_FRICTIONAL,
                                 .kinematics = (enum kinematics)options->kinematics,
                                 .weighting = (enum gap_weighting)options->weighting,
                                 .transition = options->transition,
                                 .current_areas = options->current_areas != 0,
                                 .normal_gaps = options->normal_gaps != 0,
                                 .leaks = options->leak};
    if (press_face_check(order->blocks, order->model_count, err) != 0 ||
        press_options_check(order->blocks, order->model_count, err) != 0 ||
        order_friction(order, err) != 0)
        return err->code;
    if (order->loads.resistivity > 0 && options->coating != NULL)
        return error_set(err, ERROR_INPUT,
                         "--%s and --coating: what passes a coating is not known from its contact",
                         order->loads.heat ? "conductivity" : "resistivity");
    for (size_t m = 0; m < order->model_count && order->loads.hardness > 0; m++)
        if (!order->blocks[m].model->yields)
            return error_set(err, ERROR_INPUT,
                             "--hardness: the model %s does not yield; leave one of them out",
                             contact_model_name(order->blocks[m].model));
    return check_mesh(order, err);
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
        status = order_loads(order, &err);
    }
    if (status == 0)
        status = order_models(order, &err);
    if (status == 0)
        status = press_files_check(&options->paths, &err);
    if (status == 0)
        status = read_map(&map, order, &err);
    if (status == 0)
        status = press_warn(order->path, &map, &order->record, &err);
    if (status == 0)
        status = press_map(order, &map, &err);
    height_map_clear(&map);
    if (order != NULL)
        press_path_clear(&order->slide);
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
