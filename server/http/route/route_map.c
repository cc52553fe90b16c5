/* A realisation of a study as a map, or its nodes under loads: computed when it is asked for, a few
 * at a time, and the same for ever. */
#include "core/file/memory_file.h"
#include "core/map/height_map_file.h"
#include "core/nodal/node_table.h"
#include "core/nodal/step_folder.h"
#include "jobs/surface/realisation_map.h"
#include "jobs/surface/surface_case.h"
#include "server/http/accept.h"
#include "server/http/route/route.h"
#include "server/show/map/map_png.h"
#include "server/show/quantity.h"
#include "worker/clock.h"
#include <stdlib.h>
#include <string.h>

enum {
    MAPS_MOST = 2,   /* at a time: one may take seconds */
    TIME_MS = 50000, /* for one: below the minute that clients wait */
};
static const double MAP_POINTS_MOST = 1 << 20;
static const double MEMORY_MOST = 0x1p30; /* bytes that nodes may take while they are computed */

struct map_question {
    const char *id;
    uint64_t case_number, realisation;
    enum map_field field;
    double load;
    bool png;
};

/* Returns the segment of the path that names the study. */
static const char *study_segment(const struct exchange *exchange) {
    static const char STUDIES[] = "/v1/studies/";
    return exchange->path + sizeof STUDIES - 1;
}

/* Reads the number behind "/NAME/" of a path below the study, whose own name may be such a one;
 * false where there is none, or more than digits. */
static bool path_number(const struct exchange *exchange, const char *name, uint64_t *out) {
    const char *study = study_segment(exchange), *at = strstr(study + strcspn(study, "/"), name);
    char *end;
    if (at == NULL || at[strlen(name)] < '0' || at[strlen(name)] > '9')
        return false;
    at += strlen(name);
    size_t length = strcspn(at, "/");
    *out = strtoull(at, &end, 10);
    return length <= 15 && end == at + length;
}

/* Why a map would not be waited for any longer. */
struct patience {
    struct exchange *exchange;
    int64_t until_ms;
    const char *lost; /* static text; NULL while there is some */
};

static int is_lost(void *context) {
    struct patience *patience = context;
    if (clock_ms() > patience->until_ms)
        patience->lost = "the map takes longer than the 50 s that it may take here";
    else if (exchange_is_lost(patience->exchange) != 0)
        patience->lost = "the server ends, or the peer has left";
    return patience->lost != NULL;
}

static bool prefers_png(const struct exchange *exchange) {
    const char *accept = exchange_header(exchange, "Accept");
    return accept_quality(accept, "image/png") > accept_quality(accept, "application/octet-stream");
}

/* Reads case and realisation; false after an answer. */
static bool read_path(struct exchange *exchange, struct map_question *out) {
    if (path_number(exchange, "/cases/", &out->case_number) &&
        path_number(exchange, "/realisations/", &out->realisation))
        return true;
    answer_problem(exchange, 404, "cases and realisations are whole numbers from 0", NULL);
    return false;
}

/* Returns false after an answer. */
static bool read_question(struct exchange *exchange, const char *id, struct map_question *out) {
    const char *load = exchange_query(exchange, "load");
    int field = MAP_HEIGHT;
    *out = (struct map_question){.id = id, .png = prefers_png(exchange)};
    if (!read_path(exchange, out) || !query_choice(exchange, "field", MAP_FIELD_NAMES, MAP_FIELDS,
                                                   "height|gap|pressure", &field))
        return false;
    out->field = (enum map_field)field;
    char *end = NULL;
    out->load = load != NULL ? strtod(load, &end) : 0;
    bool good = load != NULL && *end == '\0' && out->load > 0;
    if (out->field != MAP_HEIGHT && !good)
        query_refuse(exchange, "load", "a load p/(E* h') above 0 is needed for a gap or pressures");
    else if (out->field == MAP_HEIGHT && load != NULL)
        query_refuse(exchange, "load", "heights have no load");
    else
        return true;
    return false;
}

/* Finds the case; info is the caller's to clear. */
static int find_case(struct exchange *exchange, const struct map_question *question,
                     struct map_order *order, struct case_info *info, struct error *err) {
    struct store *reader;
    struct study_status study = {0};
    int status = exchange_reader(exchange, &reader, err);
    if (status == 0)
        status = store_status_counted(reader, question->id, &study, err);
    if (status == 0)
        status = store_case(reader, question->id, question->case_number, info, err);
    service_give_back(exchange->service, reader);
    if (status != 0) {
        study_status_clear(&study);
        return status;
    }
    *order =
        (struct map_order){.kind = kind_find(study.kind),
                           .parameters = info->parameters,
                           .key = {study.seed, study_sequence(study.random, question->case_number),
                                   question->realisation},
                           .field = question->field,
                           .load = question->load,
                           .points_most = MAP_POINTS_MOST};
    if (order->kind == NULL)
        status = error_set(err, ERROR_INPUT, "this program knows no kind '%.64s'", study.kind);
    else if (question->case_number >= study.cases)
        status =
            error_set(err, ERROR_ABSENT, "there is no case %llu: the study has %llu",
                      (unsigned long long)question->case_number, (unsigned long long)study.cases);
    else if (study.realisations == 0)
        status = error_set(err, ERROR_INPUT,
                           "a study that asks for an error has realisations of many cells and "
                           "meshes, and none of its own");
    else if (question->realisation >= study.realisations)
        status = error_set(err, ERROR_ABSENT, "there is no realisation %llu: cases have %llu",
                           (unsigned long long)question->realisation,
                           (unsigned long long)study.realisations);
    study_status_clear(&study);
    return status;
}

static int write_map(const struct map_question *question, const struct grid *grid, const double *z,
                     struct memory_file *out, struct error *err) {
    if (!memory_file_open(out))
        return error_memory(err, 0, "a map");
    return question->png ? map_png(out->file, grid, z, err)
                         : height_map_write(out->file, HEIGHT_MAP_NPY, grid, z, err);
}

/* Of an id it is the same for ever; a name, or first digits, may be another study's tomorrow. */
static void may_be_kept(struct exchange *exchange, const char *id) {
    const char *given = study_segment(exchange);
    bool whole = strcspn(given, "/") == strlen(id) && strncmp(given, id, strlen(id)) == 0;
    answer_header(exchange, "Cache-Control",
                  whole ? "private, max-age=604800, immutable" : "private, no-cache");
    answer_header(exchange, "Vary", "Accept, Authorization");
}

static int send_map(struct exchange *exchange, const void *whole, const struct map_order *order,
                    struct error *err) {
    const struct map_question *question = whole;
    struct grid grid;
    double *z = NULL;
    struct memory_file memory = {0};
    int status = realisation_map(order, &grid, &z, err);
    if (status != 0)
        return status;
    if (question->png && question->field == MAP_PRESSURE)
        map_blank_open(&grid, z);
    status = write_map(question, &grid, z, &memory, err);
    free(z);
    size_t size = 0;
    char *bytes = memory_file_close(&memory, &size);
    if (status == 0 && bytes == NULL)
        status = error_memory(err, 0, "a map");
    if (status != 0) {
        free(bytes);
        return status;
    }
    answer_bytes(exchange, question->png ? "image/png" : "application/octet-stream", bytes, size);
    may_be_kept(exchange, question->id);
    return 0;
}

/* What is computed of a realisation, and sent. */
typedef int sender(struct exchange *exchange, const void *question, const struct map_order *order,
                   struct error *err);

/* Finds the case and has it computed and sent, unless too many are computed already. */
static void compute(struct exchange *exchange, const struct map_question *question,
                    const void *whole, sender *send) {
    struct map_order order = {.kind = NULL};
    struct case_info info = {0};
    struct error err = {0};
    if (atomic_fetch_add(&exchange->service->maps, 1) >= MAPS_MOST) {
        atomic_fetch_sub(&exchange->service->maps, 1);
        answer_problem(exchange, 503, "too many maps are being computed", NULL);
        return;
    }
    struct patience patience = {.exchange = exchange, .until_ms = clock_ms() + TIME_MS};
    int status = find_case(exchange, question, &order, &info, &err);
    order.stop = is_lost;
    order.stop_context = &patience;
    if (status == 0)
        status = send(exchange, whole, &order, &err);
    if (status == ERROR_STOPPED)
        answer_problem(exchange, 503, patience.lost, NULL);
    else if (status == ERROR_NUMERIC) /* what is asked for is not found: no fault of the server */
        answer_problem(exchange, 422, err.text, NULL);
    else if (status != 0)
        answer_error(exchange, &err);
    case_info_clear(&info);
    atomic_fetch_sub(&exchange->service->maps, 1);
}

void handle_map(struct exchange *exchange, const char *id) {
    struct map_question question;
    if (read_question(exchange, id, &question))
        compute(exchange, &question, &question, send_map);
}

/* --- nodes --- */

enum { NODE_LOADS_MOST = 1000 };
struct node_question {
    struct map_question realisation;
    const char *model; /* NULL: the most complete one */
    bool vtu;
    size_t load_count; /* 0: all of the case */
    double loads[NODE_LOADS_MOST];
};

/* Returns false after an answer. */
static bool read_nodes(struct exchange *exchange, const char *id, struct node_question *out) {
    static const char *const FORMATS[] = {"csv", "vtu"};
    const char *load = exchange_query(exchange, "load");
    int format = 0;
    out->realisation.id = id;
    out->model = exchange_query(exchange, "model");
    if (!read_path(exchange, &out->realisation) ||
        !query_choice(exchange, "format", FORMATS, 2, "csv|vtu", &format))
        return false;
    out->vtu = format != 0;
    if (load != NULL && !rising_numbers(load, NODE_LOADS_MOST, out->loads, &out->load_count))
        query_refuse(exchange, "load", "rising loads p/(E* h') above 0, with commas between");
    else if (out->vtu && out->load_count != 1)
        query_refuse(exchange, "load", "a VTU file has one load: give it");
    else
        return true;
    return false;
}

/* Where steps are written while they are computed. */
struct node_writer {
    FILE *file;
    bool vtu;
};

static int put_step(void *context, const struct nodal_step *step, size_t number, size_t count,
                    struct error *err) {
    const struct node_writer *writer = context;
    double rows = (double)count * (double)grid_points(&step->grid);
    if (rows > MAP_POINTS_MOST)
        return error_set(err, ERROR_INPUT,
                         "%zu loads of %zu nodes; allowed here: %.0f rows. rugo generate --nodes "
                         "and --steps have no such limit",
                         count, grid_points(&step->grid), MAP_POINTS_MOST);
    return writer->vtu ? step_vtu(writer->file, step, err)
                       : node_table_put(writer->file, number == 0, step, err);
}

static int check_memory(const struct map_order *order, const void *one_case, struct error *err) {
    struct study_cost cost = {0};
    if (order->kind->press_steps == NULL)
        return error_set(err, ERROR_INPUT, "a study of kind %s has no contact",
                         order->kind->study.name);
    order->kind->estimate(one_case, &cost);
    return cost.memory_bytes <= MEMORY_MOST
               ? 0
               : error_set(err, ERROR_INPUT,
                           "the case takes %.3g GiB; allowed here: %.0f GiB. rugo generate "
                           "--nodes and --steps have no such limit",
                           cost.memory_bytes / 0x1p30, MEMORY_MOST / 0x1p30);
}

static int press_nodes(const struct node_question *question, const struct map_order *order,
                       FILE *file, struct error *err) {
    struct node_writer writer = {file, question->vtu};
    const struct steps_sink sink = {put_step, &writer};
    struct surface_report report;
    double *z = NULL;
    void *one_case = NULL;
    int status = kind_case_create(&one_case, order->kind, order->parameters, NULL, err);
    if (status != 0)
        return status;
    status = check_memory(order, one_case, err);
    if (status == 0) {
        struct surface_case stopped = *order->kind->surface(one_case);
        stopped.options.stop = order->stop;
        stopped.options.stop_context = order->stop_context;
        status = realisation_surface(&stopped, order->key, &z, &report, err);
    }
    const struct steps_order steps = {.z = z,
                                      .key = order->key,
                                      .model = question->model,
                                      .load_count = question->load_count,
                                      .loads = question->loads,
                                      .stop = order->stop,
                                      .stop_context = order->stop_context};
    if (status == 0)
        status = order->kind->press_steps(one_case, &steps, &sink, err);
    free(z);
    kind_case_destroy(order->kind, &one_case);
    return status;
}

static int send_nodes(struct exchange *exchange, const void *whole, const struct map_order *order,
                      struct error *err) {
    const struct node_question *question = whole;
    struct memory_file memory = {0};
    if (!memory_file_open(&memory))
        return error_memory(err, 0, "nodes");
    int status = press_nodes(question, order, memory.file, err);
    char *text = memory_file_close(&memory, NULL);
    if (status == 0 && text == NULL)
        status = error_memory(err, 0, "nodes");
    if (status != 0) {
        free(text);
        return status;
    }
    answer_text(exchange, 200, question->vtu ? "application/xml" : "text/csv; charset=utf-8", text);
    may_be_kept(exchange, question->realisation.id);
    return 0;
}

void handle_nodes(struct exchange *exchange, const char *id) {
    struct node_question *question = array_create(1, sizeof *question);
    struct error err = {0};
    if (question == NULL) {
        error_memory(&err, sizeof *question, "a query");
        answer_error(exchange, &err);
    } else if (read_nodes(exchange, id, question))
        compute(exchange, &question->realisation, question, send_nodes);
    free(question);
}
