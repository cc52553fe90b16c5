/* Studies over HTTP: submission, progress. */
#include "jobs/clock.h"
#include "jobs/kind.h"
#include "schema/json/field.h"
#include "schema/json/json.h"
#include "schema/study/study.h"
#include "server/command/access/api.h"
#include "server/http/route/route.h"
#include "server/show/summary/plan.h"
#include "server/show/table/contents.h"
#include "worker/link/client.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- changes, through the writer --- */

#ifdef RUGO_SANITIZED
static const double CHECK_SECONDS = 20; /* under sanitizers all takes up to twenty times as long */
#else
static const double CHECK_SECONDS = 1;
#endif

struct submission {
    const struct study *study;
    const char *key;
    cJSON *document;
    bool existing;
};

static int submit_change(struct store *store, void *context, struct error *err) {
    struct submission *submission = context;
    return api_submit(store, submission->study, submission->key, &submission->document,
                      &submission->existing, err);
}

static void submit(struct exchange *exchange, const struct study *study) {
    struct submission submission = {.study = study,
                                    .key = exchange_header(exchange, "Idempotency-Key")};
    struct error err = {0};
    if (writer_do(exchange->service->writer, submit_change, &submission, &err) != 0) {
        cJSON_Delete(submission.document); /* made, but its commit failed */
        answer_error(exchange, &err);
        return;
    }
    char location[64];
    const cJSON *id = cJSON_GetObjectItemCaseSensitive(submission.document, "id");
    snprintf(location, sizeof location, "/v1/studies/%s", cJSON_GetStringValue(id));
    answer_json(exchange, submission.existing ? 200 : 201, submission.document);
    answer_header(exchange, "Location", location);
}

/* Checks that the key is one that an answer can repeat. */
static bool check_key(struct exchange *exchange) {
    const char *key = exchange_header(exchange, "Idempotency-Key");
    if (key == NULL || key_is_good(key))
        return true;
    answer_problem(exchange, 400, "an Idempotency-Key has 1 to 200 visible ASCII characters", NULL);
    return false;
}

static void answer_plan(struct exchange *exchange, const struct study *study) {
    cJSON *document = plan_document(study);
    struct error err = {0};
    if (document != NULL) {
        answer_json(exchange, 200, document);
        return;
    }
    (void)error_memory(&err, 0, "a plan");
    answer_error(exchange, &err);
}

/* How long a study is checked for. */
struct checking {
    struct exchange *exchange;
    double begin, seconds; /* of this thread's CPU time */
    bool too_long;
};

static int checked_enough(void *context) {
    struct checking *checking = context;
    checking->too_long =
        clock_seconds(CLOCK_THREAD_CPUTIME_ID) - checking->begin > checking->seconds;
    return checking->too_long || exchange_is_lost(checking->exchange);
}

static void refuse_unchecked(struct exchange *exchange, const struct checking *checking,
                             const struct error *err) {
    struct fault_list faults = {0};
    if (!checking->too_long) {
        answer_error(exchange, err);
        return;
    }
    fault_add(&faults, "",
              "checking its cases takes more than %g s of this server's time; submit them as "
              "several studies",
              checking->seconds);
    answer_problem(exchange, 422, "the study is not valid", &faults);
    fault_list_clear(&faults);
}

/* Reads the study on the connection's thread: ten thousand cases must not hold up the writer. */
static void with_study(struct exchange *exchange,
                       void (*answer)(struct exchange *exchange, const struct study *study)) {
    struct fault_list faults = {0};
    struct study *study = NULL;
    struct error err = {0};
    if (!check_body(exchange))
        return;
    struct checking checking = {.exchange = exchange,
                                .begin = clock_seconds(CLOCK_THREAD_CPUTIME_ID),
                                .seconds = CHECK_SECONDS};
    int status = kind_read_study_until(&study, exchange->body, exchange->body_size, checked_enough,
                                       &checking, &faults, &err);
    if (status == 0 && (study->owner = strdup(exchange->owner)) == NULL)
        status = error_memory(&err, sizeof exchange->owner, "a study's owner");
    if (status == 0)
        answer(exchange, study);
    else if (status == ERROR_STOPPED)
        refuse_unchecked(exchange, &checking, &err);
    else if (faults.count != 0)
        answer_problem(exchange, 422, "the study is not valid", &faults);
    else if (status == ERROR_INPUT) /* no JSON */
        answer_problem(exchange, 400, err.text, NULL);
    else
        answer_error(exchange, &err);
    study_destroy(&study);
    fault_list_clear(&faults);
}

void handle_study_create(struct exchange *exchange, const char *id) {
    (void)id;
    if (check_key(exchange))
        with_study(exchange, submit);
}

void handle_check(struct exchange *exchange, const char *id) {
    (void)id;
    with_study(exchange, answer_plan);
}

/* A change of a study, which its owner or an admin may make; a study of nobody is anybody's. */
struct study_change {
    const struct exchange *exchange;
    const char *id;
    uint64_t realisations; /* to extend it to */
    bool refused;          /* for whose it is */
    cJSON *document;
    int (*api)(struct store *store, const char *id, cJSON **out, struct error *err);
};

static int check_owner(struct store *store, struct study_change *change, struct error *err) {
    struct study_status now = {0};
    int status = store_status_counted(store, change->id, &now, err);
    if (status != 0)
        return status;
    change->refused = !change->exchange->admin && *now.owner != '\0' &&
                      strcmp(now.owner, change->exchange->owner) != 0;
    if (change->refused)
        status = error_set(err, ERROR_STATE,
                           "study %s is of %s, who may change it, as may a token of the role admin",
                           change->id, now.owner);
    study_status_clear(&now);
    return status;
}

static int change_study(struct store *store, void *context, struct error *err) {
    struct study_change *change = context;
    int status = check_owner(store, change, err);
    if (status != 0)
        return status;
    return change->api != NULL
               ? change->api(store, change->id, &change->document, err)
               : api_extend(store, change->id, change->realisations, &change->document, err);
}

static void refuse_extension(struct exchange *exchange, const struct fault_list *faults) {
    answer_problem(exchange, 422, "the extension is not valid", faults);
}

static void answer_change(struct exchange *exchange, struct study_change change) {
    struct fault_list faults = {0};
    struct error err = {0};
    change.exchange = exchange;
    if (writer_do(exchange->service->writer, change_study, &change, &err) == 0) {
        answer_json(exchange, 200, change.document);
        return;
    }
    cJSON_Delete(change.document); /* made, but its commit failed */
    if (change.refused)
        answer_problem(exchange, 403, err.text, NULL);
    else if (change.api == NULL && err.code == ERROR_INPUT) {
        fault_add(&faults, "/realisations", "%s", err.text);
        refuse_extension(exchange, &faults);
    } else
        answer_error(exchange, &err);
    fault_list_clear(&faults);
}

/* With results, the study itself goes; the publisher takes its rows away. */
void handle_study_cancel(struct exchange *exchange, const char *id) {
    const char *results = exchange_query(exchange, "results");
    if (!query_true(exchange, "results", "to delete the study"))
        return;
    if (results != NULL) {
        answer_change(exchange, (struct study_change){.id = id, .api = api_delete});
        publisher_wake(exchange->service->publisher);
        return;
    }
    answer_change(exchange, (struct study_change){.id = id, .api = api_cancel});
}

void handle_study_retry(struct exchange *exchange, const char *id) {
    answer_change(exchange, (struct study_change){.id = id, .api = api_retry});
}

static void read_extension(const cJSON *body, uint64_t *realisations, struct fault_list *faults) {
    const cJSON *given = field_at(body, "realisations");
    char pointer[80], allowed[48], text[48];
    snprintf(allowed, sizeof allowed, "an integer in [1, %d]", STUDY_REALISATIONS_MOST);
    for (const cJSON *member = cJSON_IsObject(body) ? body->child : NULL; member != NULL;
         member = member->next)
        if (strcmp(member->string, "realisations") != 0) {
            snprintf(pointer, sizeof pointer, "/%.64s", member->string);
            fault_add(faults, pointer, "unknown name; allowed: realisations");
        }
    if (given == NULL) {
        fault_add(faults, "/realisations", "missing: %s", allowed);
        return;
    }
    double number = cJSON_IsNumber(given) ? given->valuedouble : 0;
    if (number >= 1 && number <= STUDY_REALISATIONS_MOST && number == floor(number)) {
        *realisations = (uint64_t)number;
        return;
    }
    json_describe(given, text, sizeof text);
    fault_add(faults, "/realisations", "%s is not %s", text, allowed);
}

void handle_study_extend(struct exchange *exchange, const char *id) {
    struct study_change change = {.id = id};
    struct fault_list faults = {0};
    cJSON *body = body_json(exchange);
    if (body == NULL)
        return;
    read_extension(body, &change.realisations, &faults);
    cJSON_Delete(body);
    if (faults.count == 0)
        answer_change(exchange, change);
    else
        refuse_extension(exchange, &faults);
    fault_list_clear(&faults);
}

/* --- questions, to a reader --- */

void handle_study_list(struct exchange *exchange, const char *id) {
    (void)id;
    struct store *reader;
    struct error err = {0};
    cJSON *document = NULL;
    int64_t limit = 100;
    if (!query_number(exchange, "limit", 1, 1000, &limit))
        return;
    int status = exchange_reader(exchange, &reader, &err);
    if (status == 0)
        status =
            api_list(reader, exchange_query(exchange, "after"), (size_t)limit, &document, &err);
    service_give_back(exchange->service, reader);
    if (status != 0)
        answer_error(exchange, &err);
    else
        answer_json(exchange, 200, document);
}

static void answer_question(struct exchange *exchange, const char *id,
                            int (*ask)(struct store *store, const char *id, cJSON **out,
                                       struct error *err)) {
    struct store *reader;
    struct error err = {0};
    cJSON *document = NULL;
    int status = exchange_reader(exchange, &reader, &err);
    if (status == 0)
        status = ask(reader, id, &document, &err);
    service_give_back(exchange->service, reader);
    if (status != 0)
        answer_error(exchange, &err);
    else
        answer_json(exchange, 200, document);
}

void handle_study(struct exchange *exchange, const char *id) {
    if (!query_true(exchange, "unique", "to refuse a name that several studies have"))
        return;
    answer_question(exchange, id, api_status);
}

void handle_document(struct exchange *exchange, const char *id) {
    answer_question(exchange, id, store_document);
}

void handle_contents(struct exchange *exchange, const char *id) {
    answer_question(exchange, id, contents_document);
}

static int ask_workers(struct store *store, const char *id, cJSON **out, struct error *err) {
    (void)id;
    return api_workers(store, out, err);
}

void handle_workers(struct exchange *exchange, const char *id) {
    answer_question(exchange, id, ask_workers);
}
