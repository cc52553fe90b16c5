#include "server/command/access/access.h"
#include "core/file/memory_file.h"
#include "core/file/part_file.h"
#include "core/file/plain_text.h"
#include "jobs/kind.h"
#include "schema/result/result_json.h"
#include "schema/study/override.h"
#include "server/command/access/api.h"
#include "server/command/command.h"
#include "server/command/service/token_file.h"
#include "server/show/table/case_table.h"
#include "worker/link/client.h"
#include "worker/link/header_names.h"
#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct access {
    struct store *store; /* one of the two; owned */
    struct client *client;
    const char *server; /* its URL, borrowed */
};

/* Bytes of what may stand for a study in a path: a name has up to 200 characters, of up to 4. */
enum { GIVEN_MOST = 800 };

int access_options_check(const char *command, const struct access_options *options) {
    if (options->database != NULL && options->server != NULL)
        return usage_error(command, "--db and --server exclude each other");
    if (options->token_file != NULL && options->server == NULL)
        return usage_error(command, "--token-file goes with --server");
    if ((options->trust.ca_file != NULL || options->trust.fingerprint != NULL ||
         options->trust.insecure) &&
        options->server == NULL)
        return usage_error(command, "--ca-file, --fingerprint and --insecure go with --server");
    return 0;
}

static const char *environment(const char *name) {
    const char *value = getenv(name);
    return value != NULL && *value != '\0' ? value : NULL;
}

struct client_trust access_trust(const struct access_options *options) {
    struct client_trust trust = options->trust;
    if (trust.ca_file != NULL || trust.fingerprint != NULL)
        return trust;
    trust.ca_file = environment("RUGO_CA_FILE");
    trust.fingerprint = environment("RUGO_FINGERPRINT");
    return trust;
}

static int open_client(struct access *access, const struct access_options *options,
                       enum access_mode mode, struct error *err) {
    char *token = NULL;
    const struct client_trust trust = access_trust(options);
    int status =
        token_read(options->token_file, mode == ACCESS_READ ? ROLE_READ : ROLE_SUBMIT, &token, err);
    if (status == 0)
        status = client_create(&access->client, options->server, token, &trust, err);
    access->server = options->server;
    free(token);
    return status;
}

int access_open(struct access **out, const struct access_options *options, enum access_mode mode,
                struct error *err) {
    struct access *access = array_create(1, sizeof *access);
    if (access == NULL)
        return error_memory(err, sizeof *access, "a store");
    struct store_options store = {.read_only = mode == ACCESS_READ,
                                  .existing = mode != ACCESS_CREATE};
    int status =
        options->server != NULL
            ? open_client(access, options, mode, err)
            : store_open(&access->store, options->database != NULL ? options->database : DATABASE,
                         &store, err);
    if (status != 0) {
        access_close(&access);
        return status;
    }
    *out = access;
    return 0;
}

void access_close(struct access **access) {
    struct due_case damaged;
    if (*access == NULL)
        return;
    if ((*access)->store != NULL && store_found_damage((*access)->store, &damaged))
        fprintf(stderr,
                "rugo: what is published of case %llu of study %s is damaged, and was merged anew "
                "from its results; rugo repair restores it\n",
                (unsigned long long)damaged.case_number, damaged.study);
    store_close(&(*access)->store);
    client_destroy(&(*access)->client);
    free(*access);
    *access = NULL;
}

/* Checks an identifier for a path, whose meaning anything but letters and digits would change. */
static bool is_study_id(const char *id) {
    size_t length = strlen(id);
    return length != 0 && length < STUDY_ID_SIZE && strspn(id, "0123456789abcdef") == length;
}

/* Writes the path of a study, with what is behind its id; ERROR_ABSENT where it is no id. */
static int access_study_path(char *path, size_t size, const char *id, const char *rest,
                             struct error *err) {
    if (!is_study_id(id))
        return error_set(err, ERROR_ABSENT, "there is no study \"%.40s\"", id);
    snprintf(path, size, "/v1/studies/%s%s", id, rest);
    return 0;
}

static int ask(struct access *access, const char *method, const char *path, const char *body,
               cJSON **out, struct error *err) {
    struct request request = {.method = method, .path = path, .body = body};
    return client_json(access->client, &request, out, err);
}

static int ask_study(struct access *access, const char *method, const char *id, const char *rest,
                     cJSON **out, struct error *err) {
    char path[320];
    int status = access_study_path(path, sizeof path, id, rest, err);
    return status != 0 ? status : ask(access, method, path, NULL, out, err);
}

/* Writes a text as one segment of a path (RFC 3986, 2.1). */
static void escape_segment(const char *text, char *out, size_t size) {
    static const char PLAIN[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_~";
    size_t used = 0;
    for (; *text != '\0' && used + 4 < size; text++)
        if (strchr(PLAIN, *text) != NULL)
            out[used++] = *text;
        else
            used += (size_t)snprintf(out + used, size - used, "%%%02X", (unsigned char)*text);
    out[used] = '\0';
}

/* A server finds what fits, and its answer has the whole id. */
static int find_remote(struct access *access, const char *given, char id[STUDY_ID_SIZE],
                       uint64_t *others, struct error *err) {
    char segment[3 * GIVEN_MOST + 4], path[sizeof segment + 32];
    cJSON *document = NULL;
    bool dots = strcmp(given, ".") == 0 || strcmp(given, "..") == 0; /* steps of a path */
    if (strlen(given) > GIVEN_MOST || strchr(given, '/') != NULL || dots)
        return error_set(err, ERROR_INPUT,
                         "a server finds no study by the name \"%.40s\"; name its id", given);
    escape_segment(given, segment, sizeof segment);
    snprintf(path, sizeof path, "/v1/studies/%s%s", segment, others == NULL ? "?unique=true" : "");
    int status = ask(access, "GET", path, NULL, &document, err);
    if (status == 0 && others != NULL)
        *others = client_header_number(access->client, SAME_NAME_HEADER);
    const char *found = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(document, "id"));
    if (status == 0 && (found == NULL || !is_study_id(found)))
        status = error_set(err, ERROR_SYSTEM, "the server's answer has no id");
    if (status == 0)
        snprintf(id, STUDY_ID_SIZE, "%s", found);
    cJSON_Delete(document);
    return status;
}

static int find(struct access *access, const char *given, char id[STUDY_ID_SIZE], uint64_t *others,
                struct error *err) {
    if (access->client == NULL)
        return store_find(access->store, given, id, others, err);
    if (*given == '\0')
        return error_set(err, ERROR_INPUT, "a study has an id and a name, and neither is empty");
    if (strlen(given) + 1 != STUDY_ID_SIZE || !is_study_id(given))
        return find_remote(access, given, id, others, err);
    snprintf(id, STUDY_ID_SIZE, "%s", given);
    return 0;
}

int access_find(struct access *access, const char *command, const char *given,
                char id[STUDY_ID_SIZE], struct error *err) {
    uint64_t others = 0;
    int status = find(access, given, id, command != NULL ? &others : NULL, err);
    if (status == 0 && others > 0) {
        fprintf(stderr, "rugo %s: %llu studies are named \"", command,
                (unsigned long long)others + 1);
        text_print_plain(stderr, given);
        fprintf(stderr, "\"; this is the newest, %s\n", id);
    }
    return status;
}

int access_status(struct access *access, const char *id, cJSON **out, struct error *err) {
    return access->client != NULL ? ask_study(access, "GET", id, "", out, err)
                                  : api_status(access->store, id, out, err);
}

int access_document(struct access *access, const char *id, cJSON **out, struct error *err) {
    return access->client != NULL ? ask_study(access, "GET", id, "/study", out, err)
                                  : store_document(access->store, id, out, err);
}

enum { PAGE = 100 };

static int list_page(struct access *access, const char *after, cJSON **out, struct error *err) {
    char path[96];
    if (access->client == NULL)
        return api_list(access->store, after, PAGE, out, err);
    snprintf(path, sizeof path, "/v1/studies?limit=%d%s%s", PAGE, *after != '\0' ? "&after=" : "",
             after);
    return ask(access, "GET", path, NULL, out, err);
}

/* Moves the studies of a page to the end of all. */
static void append_studies(cJSON *all, cJSON *page) {
    cJSON *from = cJSON_GetObjectItemCaseSensitive(page, "studies");
    cJSON *to = cJSON_GetObjectItemCaseSensitive(all, "studies");
    for (cJSON *study; from != NULL && (study = cJSON_DetachItemFromArray(from, 0)) != NULL;)
        cJSON_AddItemToArray(to, study);
}

int access_list(struct access *access, cJSON **out, struct error *err) {
    char after[STUDY_ID_SIZE] = "";
    cJSON *all = cJSON_CreateObject();
    int status = all != NULL && cJSON_AddArrayToObject(all, "studies") != NULL
                     ? 0
                     : error_memory(err, 0, "a list of studies");
    for (bool more = status == 0; more;) {
        cJSON *page = NULL;
        status = list_page(access, after, &page, err);
        if (status == 0)
            append_studies(all, page);
        const char *next = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(page, "next"));
        more = status == 0 && next != NULL && is_study_id(next) && strcmp(next, after) != 0;
        if (more)
            snprintf(after, sizeof after, "%s", next);
        cJSON_Delete(page);
    }
    if (status != 0)
        cJSON_Delete(all);
    else
        *out = all;
    return status;
}

enum { REST_SIZE = 200 };

/* cases: "" or "?case=0"; quantity: NULL for all. */
static int results_path(char rest[REST_SIZE], const char *cases, const char *quantity,
                        struct error *err) {
    size_t used = (size_t)snprintf(rest, REST_SIZE, "/curves%s", cases);
    if (quantity == NULL)
        return 0;
    size_t length = strlen(quantity);
    if (length > 64 || strspn(quantity, "abcdefghijklmnopqrstuvwxyz0123456789_") != length)
        return error_set(err, ERROR_INPUT, "the study has no quantity \"%.64s\"", quantity);
    snprintf(rest + used, REST_SIZE - used, "%cquantity=%s", *cases != '\0' ? '&' : '?', quantity);
    return 0;
}

/* Asks a server for curves. */
static int ask_results(struct access *access, const char *id, const char *cases,
                       const char *quantity, struct study_result *out, struct error *err) {
    char rest[REST_SIZE];
    cJSON *document = NULL;
    int status = results_path(rest, cases, quantity, err);
    if (status == 0)
        status = ask_study(access, "GET", id, rest, &document, err);
    if (status == 0)
        status = study_result_read(document, out, err);
    cJSON_Delete(document);
    return status;
}

int access_results(struct access *access, const char *id, const struct result_filter *filter,
                   struct study_result *out, struct error *err) {
    char cases[48] = "";
    if (access->client == NULL)
        return aggregate_study(access->store, id, filter, out, err);
    if (filter->case_number >= 0)
        snprintf(cases, sizeof cases, "?case=%lld", (long long)filter->case_number);
    return ask_results(access, id, cases, filter->part.quantity, out, err);
}

int access_difference(struct access *access, const char *id, const struct comparison *comparison,
                      struct study_result *out, struct error *err) {
    char cases[80];
    if (access->client == NULL)
        return comparison_make(access->store, id, comparison, out, err);
    snprintf(cases, sizeof cases, "?difference=%llu,%llu", (unsigned long long)comparison->minuend,
             (unsigned long long)comparison->subtrahend);
    return ask_results(access, id, cases, comparison->quantity, out, err);
}

int access_report(struct access *access, const char *id, struct study_report *out,
                  struct error *err) {
    cJSON *document = NULL;
    if (access->client == NULL)
        return aggregate_report(access->store, id, out, err);
    int status = ask_study(access, "GET", id, "/report", &document, err);
    if (status == 0)
        status = study_report_read(document, out, err);
    cJSON_Delete(document);
    return status;
}

int access_health(struct access *access, cJSON **out, struct error *err) {
    return ask(access, "GET", "/healthz", NULL, out, err);
}

static int download(struct access *access, const char *path, struct error *err) {
    struct part_file part;
    int status = part_file_create(&part, path, err);
    if (status != 0)
        return status;
    int copy = dup(part.file);
    FILE *file = copy >= 0 ? fdopen(copy, "wb") : NULL;
    if (file == NULL) {
        if (copy >= 0)
            close(copy);
        status = error_set(err, ERROR_SYSTEM, "%s: %s", path, strerror(errno));
    } else {
        uint64_t size = 0;
        status = client_download(access->client, "/v1/snapshot", file, &size, err);
        if (fclose(file) != 0 && status == 0)
            status = error_set(err, ERROR_SYSTEM, "%s: %s", path, strerror(errno));
        if (status == 0)
            status = store_file_check(part.file, size, err);
        if (status != 0)
            error_context(err, "no snapshot of %.200s", access->server);
    }
    if (status == 0)
        status = part_file_publish(&part, err);
    part_file_destroy(&part);
    return status;
}

int access_snapshot(struct access *access, const char *path, struct error *err) {
    return access->client != NULL
               ? download(access, path, err)
               : store_snapshot(access->store, path, stop_is_requested, NULL, err);
}

/* Changes of a store, local or of a server. */

/* Sends a study with a key, so that it is queued once however often it is sent. */
static int send_study(struct access *access, const struct submission *submission, const char *body,
                      cJSON **out, struct fault_list *faults, struct error *err) {
    char key[KEY_SIZE], doubt[320];
    int status = submission->key == NULL ? key_make(key, err) : 0;
    const struct request request = {.method = "POST",
                                    .path = "/v1/studies",
                                    .body = body,
                                    .faults = faults,
                                    .idempotency_key =
                                        submission->key != NULL ? submission->key : key,
                                    .timeout_ms = 1000 * (long)submission->timeout_s};
    if (status != 0)
        return status;
    snprintf(doubt, sizeof doubt,
             "the study may have been queued; rugo status --server %.100s shows it, and the same "
             "command with --key %.60s queues it once",
             access->server, request.idempotency_key);
    return client_change(access->client, &request, doubt, out, err);
}

/* A server has no --set: the changes are made before the study is sent. */
static int submit_remote(struct access *access, const struct submission *submission, cJSON **out,
                         struct fault_list *faults, struct error *err) {
    const char *const *change = submission->overrides;
    cJSON *document = NULL;
    int status = json_parse(submission->text, submission->size, NULL, &document, err);
    for (; status == 0 && change != NULL && *change != NULL; change++)
        status = override_apply(document, *change, err);
    char *body = status != 0 ? NULL : json_print(document);
    cJSON_Delete(document);
    if (status == 0 && body == NULL)
        status = error_memory(err, submission->size, "a study");
    if (status == 0)
        status = send_study(access, submission, body, out, faults, err);
    free(body);
    return status;
}

int access_submit(struct access *access, const struct submission *submission, cJSON **out,
                  struct fault_list *faults, struct error *err) {
    bool existing;
    struct study *study = NULL;
    if (access->client != NULL)
        return submit_remote(access, submission, out, faults, err);
    int status = kind_read_study(&study, submission->text, submission->size, submission->overrides,
                                 faults, err);
    if (status == 0)
        status = api_submit(access->store, study, submission->key, out, &existing, err);
    study_destroy(&study);
    return status;
}

/* Asks for a change of a study; `done` says what may have become of it where no answer comes. */
static int ask_change(struct access *access, const struct request *request, const char *id,
                      const char *done, cJSON **out, struct error *err) {
    char doubt[320];
    snprintf(
        doubt, sizeof doubt,
        "study %s may have been %s; rugo status --server %.120s %s shows it, and the same command "
        "may be repeated",
        id, done, access->server, id);
    return client_change(access->client, request, doubt, out, err);
}

static int change_study(struct access *access, const char *method, const char *id, const char *rest,
                        const char *done, cJSON **out, struct error *err) {
    char path[320];
    const struct request request = {.method = method, .path = path};
    int status = access_study_path(path, sizeof path, id, rest, err);
    return status != 0 ? status : ask_change(access, &request, id, done, out, err);
}

int access_cancel(struct access *access, const char *id, cJSON **out, struct error *err) {
    return access->client != NULL ? change_study(access, "DELETE", id, "", "cancelled", out, err)
                                  : api_cancel(access->store, id, out, err);
}

int access_retry(struct access *access, const char *id, cJSON **out, struct error *err) {
    return access->client != NULL ? change_study(access, "POST", id, "/retry", "retried", out, err)
                                  : api_retry_publish(access->store, id, out, err);
}

int access_delete(struct access *access, const char *id, cJSON **out, struct error *err) {
    if (access->client != NULL)
        return change_study(access, "DELETE", id, "?results=true", "deleted", out, err);
    int status = api_delete(access->store, id, out, err);
    if (status == 0 && (status = store_purge(access->store, NULL, NULL, err)) != 0) {
        cJSON_Delete(*out);
        *out = NULL;
    }
    return status;
}

int access_extend(struct access *access, const char *id, uint64_t realisations, cJSON **out,
                  struct error *err) {
    char path[320], body[64];
    if (access->client == NULL)
        return api_extend(access->store, id, realisations, out, err);
    snprintf(body, sizeof body, "{\"realisations\":%llu}", (unsigned long long)realisations);
    const struct request request = {.method = "POST", .path = path, .body = body};
    int status = access_study_path(path, sizeof path, id, "/extend", err);
    return status != 0 ? status : ask_change(access, &request, id, "extended", out, err);
}

/* A table of a study, local or of a server. */

/* Writes a query's value so that nothing in it has a meaning (RFC 3986, 2.1). */
static void put_escaped(FILE *file, const char *value) {
    static const char PLAIN[] = "-._~:@,/=";
    for (; *value != '\0'; value++)
        if (isalnum((unsigned char)*value) || strchr(PLAIN, *value) != NULL)
            fputc(*value, file);
        else
            fprintf(file, "%%%02X", (unsigned)(unsigned char)*value);
}

/* Makes the path of a table; the caller frees. NULL when out of memory. */
static char *table_path(const char *id, const struct table_request *request, int format) {
    struct memory_file path;
    if (!memory_file_open(&path))
        return NULL;
    fprintf(path.file, "/v1/studies/%s/table?format=%s", id, TABLE_FORMAT_NAMES[format]);
    if (request->columns != NULL) {
        fputs("&columns=", path.file);
        put_escaped(path.file, request->columns);
    }
    for (size_t w = 0; request->where != NULL && request->where[w] != NULL; w++) {
        fputs(w == 0 ? "&where=" : ",", path.file);
        put_escaped(path.file, request->where[w]);
    }
    return memory_file_close(&path, NULL);
}

/* A table is made of a study of a store. */
struct origin {
    struct store *store;
    const char *id;
};

static int results(const void *context, const struct result_filter *filter,
                   struct study_result *out, struct error *err) {
    const struct origin *origin = context;
    return aggregate_study(origin->store, origin->id, filter, out, err);
}

static int download_table(struct access *access, const char *id,
                          const struct table_request *request, int format, FILE *file,
                          struct error *err) {
    char *path = table_path(id, request, format);
    int status = path != NULL ? client_download(access->client, path, file, NULL, err)
                              : error_memory(err, 0, "a request");
    free(path);
    return status;
}

int access_table(struct access *access, const char *id, const struct table_request *request,
                 int format, FILE *file, struct error *err) {
    const struct origin origin = {access->store, id};
    const struct picture_source source = {.context = &origin, .results = results};
    struct case_table table = {0};
    if (access->client != NULL)
        return download_table(access, id, request, format, file, err);
    int status = case_table_make(&table, &source, request, err);
    if (status == 0)
        status = case_table_print(&table, format, file, err);
    case_table_clear(&table);
    return status;
}
