/* A realisation of a study as a map: computed when it is asked for, a few at a time, and the same
 * for ever. */
#include "core/map/height_map_file.h"
#include "core/memory_file.h"
#include "jobs/surface/realisation_map.h"
#include "server/http/accept.h"
#include "server/http/route/route.h"
#include "server/show/map/map_png.h"
#include "worker/clock.h"
#include <poll.h>
#include <stdlib.h>
#include <string.h>

enum {
    MAPS_MOST = 2,   /* at a time: one may take seconds */
    TIME_MS = 50000, /* for one: below the minute that clients wait */
};
static const double POINTS_MOST = 1 << 20;

struct map_question {
    const char *id;
    uint64_t case_number, realisation;
    enum map_field field;
    double load;
    bool png;
};

/* Reads the number behind "/NAME/" of the path; false where there is none, or more than digits. */
static bool path_number(const char *path, const char *name, uint64_t *out) {
    const char *at = strstr(path, name);
    char *end;
    if (at == NULL || at[strlen(name)] < '0' || at[strlen(name)] > '9')
        return false;
    at += strlen(name);
    size_t length = strcspn(at, "/");
    *out = strtoull(at, &end, 10);
    return length <= 15 && end == at + length;
}

static void fault(struct exchange *exchange, const char *pointer, const char *detail) {
    struct fault_list faults = {0};
    fault_add(&faults, pointer, "%s", detail);
    answer_problem(exchange, 422, "the query is not valid", &faults);
    fault_list_clear(&faults);
}

/* Why a map would not be waited for any longer. */
struct patience {
    const struct exchange *exchange;
    int64_t until_ms;
    const char *lost; /* static text; NULL while there is some */
};

static int is_lost(void *context) {
    struct patience *patience = context;
    const struct exchange *exchange = patience->exchange;
    struct pollfd peer = {.fd = exchange_socket(exchange), .events = POLLRDHUP};
    if (atomic_load(&exchange->service->stopping))
        patience->lost = "the server ends";
    else if (clock_ms() > patience->until_ms)
        patience->lost = "the map takes longer than the 50 s that it may take here";
    else if (poll(&peer, 1, 0) > 0)
        patience->lost = "the peer has left";
    return patience->lost != NULL;
}

static bool prefers_png(const struct exchange *exchange) {
    const char *accept = exchange_header(exchange, "Accept");
    return accept_quality(accept, "image/png") > accept_quality(accept, "application/octet-stream");
}

/* Returns false after an answer. */
static bool read_question(struct exchange *exchange, const char *id, struct map_question *out) {
    const char *field = exchange_query(exchange, "field"), *load = exchange_query(exchange, "load");
    *out = (struct map_question){.id = id, .png = prefers_png(exchange)};
    if (!path_number(exchange->path, "/cases/", &out->case_number) ||
        !path_number(exchange->path, "/realisations/", &out->realisation)) {
        answer_problem(exchange, 404, "cases and realisations are whole numbers from 0", NULL);
        return false;
    }
    while (field != NULL && out->field < MAP_FIELDS &&
           strcmp(MAP_FIELD_NAMES[out->field], field) != 0)
        out->field++;
    if (out->field == MAP_FIELDS) {
        fault(exchange, "?field", "allowed: height, gap, pressure");
        return false;
    }
    char *end = NULL;
    out->load = load != NULL ? strtod(load, &end) : 0;
    bool good = load != NULL && *end == '\0' && out->load > 0;
    if (out->field != MAP_HEIGHT && !good)
        fault(exchange, "?load", "a load p/(E* h') above 0 is needed for a gap or pressures");
    else if (out->field == MAP_HEIGHT && load != NULL)
        fault(exchange, "?load", "heights have no load");
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
        status = store_status(reader, question->id, &study, err);
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
                           .points_most = POINTS_MOST};
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

static int send_map(struct exchange *exchange, const struct map_question *question,
                    const struct map_order *order, struct error *err) {
    struct grid grid;
    double *z = NULL;
    struct memory_file memory = {0};
    int status = realisation_map(order, &grid, &z, err);
    if (status != 0)
        return status;
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
    answer_header(exchange, "Cache-Control", "private, max-age=604800, immutable");
    answer_header(exchange, "Vary", "Accept, Authorization");
    return 0;
}

void handle_map(struct exchange *exchange, const char *id) {
    struct map_question question;
    struct map_order order = {.kind = NULL};
    struct case_info info = {0};
    struct error err = {0};
    if (!read_question(exchange, id, &question))
        return;
    if (atomic_fetch_add(&exchange->service->maps, 1) >= MAPS_MOST) {
        atomic_fetch_sub(&exchange->service->maps, 1);
        answer_problem(exchange, 503, "too many maps are being computed", NULL);
        return;
    }
    struct patience patience = {.exchange = exchange, .until_ms = clock_ms() + TIME_MS};
    int status = find_case(exchange, &question, &order, &info, &err);
    order.stop = is_lost;
    order.stop_context = &patience;
    if (status == 0)
        status = send_map(exchange, &question, &order, &err);
    if (status == ERROR_STOPPED)
        answer_problem(exchange, 503, patience.lost, NULL);
    else if (status == ERROR_NUMERIC) /* what is asked for is not found: no fault of the server */
        answer_problem(exchange, 422, err.text, NULL);
    else if (status != 0)
        answer_error(exchange, &err);
    case_info_clear(&info);
    atomic_fetch_sub(&exchange->service->maps, 1);
}
