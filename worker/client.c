#include "worker/client.h"
#include "schema/json/json.h"
#include "worker/client_internal.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum {
    CONNECT_MS = 10000,
    TOTAL_MS = 30000,
    QUIET_SECONDS = 60,    /* an answer may wait this long, and pause: curves are merged for it */
    SILENCE_SECONDS = 300, /* a download may wait this long: the server first copies the database */
    REPLY_BYTES_MOST = 256 << 20,
};
/* Curves of many cases with their matrices are larger than any study that the server would take. */
static const struct json_limits REPLY_LIMITS = {REPLY_BYTES_MOST, 32, 20000000};

struct client {
    CURL *curl;
    char *url;           /* scheme://host:port, no slash behind it */
    char *authorisation; /* the header line with the token, or NULL; never printed */
    char detail[CURL_ERROR_SIZE];
    bool lost; /* the last request was sent, at least begun, and has no answer */
};

struct reply {
    long status; /* of HTTP; 0: no answer at all (the connection failed) */
    char *body;  /* owned, NUL-terminated */
    size_t size;
};

/* The body of one reply goes here. */
struct sink {
    CURL *curl;
    struct reply *reply;
    size_t capacity; /* bytes allocated for reply->body */
    FILE *file;      /* takes the body of a 2xx reply instead; NULL: none */
    const char *fault;
};

int client_global_init(struct error *err) {
    CURLcode code = curl_global_init(CURL_GLOBAL_DEFAULT);
    return code != 0 ? error_set(err, ERROR_SYSTEM, "libcurl: %s", curl_easy_strerror(code)) : 0;
}

void client_global_cleanup(void) {
    curl_global_cleanup();
}

/* --- set-up --- */

/* A line break in a token would start another header. */
static bool token_is_valid(const char *token) {
    for (; *token != '\0'; token++)
        if (*token <= ' ' || *token > '~')
            return false;
    return true;
}

static int client_options(struct client *client, const struct client_trust *trust,
                          const struct client_url *where, struct error *err) {
    bool loopback = where->loopback || trust->own;
    CURL *curl = client->curl;
    /* CURLOPT_PROXY "" switches off what the environment names. */
    bool good =
        curl_easy_setopt(curl, CURLOPT_NOSIGNAL, 1L) == CURLE_OK &&
        curl_easy_setopt(curl, CURLOPT_PROTOCOLS_STR, "http,https") == CURLE_OK &&
        curl_easy_setopt(curl, CURLOPT_FOLLOWLOCATION, 0L) == CURLE_OK &&
        curl_easy_setopt(curl, CURLOPT_PATH_AS_IS, 1L) == CURLE_OK &&
        curl_easy_setopt(curl, CURLOPT_HTTP_VERSION, (long)CURL_HTTP_VERSION_1_1) == CURLE_OK &&
        curl_easy_setopt(curl, CURLOPT_CONNECTTIMEOUT_MS, (long)CONNECT_MS) == CURLE_OK &&
        curl_easy_setopt(curl, CURLOPT_TCP_KEEPALIVE, 1L) == CURLE_OK &&
        curl_easy_setopt(curl, CURLOPT_USERAGENT, "rugo") == CURLE_OK &&
        curl_easy_setopt(curl, CURLOPT_ERRORBUFFER, client->detail) == CURLE_OK &&
        (!loopback || curl_easy_setopt(curl, CURLOPT_PROXY, "") == CURLE_OK) &&
        /* a line is slower than zlib, this machine is not */
        (loopback || curl_easy_setopt(curl, CURLOPT_ACCEPT_ENCODING, "gzip") == CURLE_OK);
    return good ? client_trust_set(curl, trust, where, err)
                : error_set(err, ERROR_SYSTEM, "libcurl refuses an option");
}

static int client_fill(struct client *client, const char *url, const char *token,
                       const struct client_trust *trust, const struct client_url *where,
                       struct error *err) {
    size_t length = strlen(url);
    client->url = strdup(url);
    client->curl = curl_easy_init();
    if (client->url == NULL || client->curl == NULL)
        return error_memory(err, length + sizeof *client, "a client");
    if (length > 0 && url[length - 1] == '/')
        client->url[length - 1] = '\0';
    if (token != NULL) {
        size_t size = strlen(token) + sizeof "Authorization: Bearer ";
        client->authorisation = malloc(size);
        if (client->authorisation == NULL)
            return error_memory(err, size, "a header");
        snprintf(client->authorisation, size, "Authorization: Bearer %s", token);
    }
    return client_options(client, trust, where, err);
}

int client_create(struct client **out, const char *url, const char *token,
                  const struct client_trust *trust, struct error *err) {
    static const struct client_trust NOBODY_ELSE = {0};
    struct client_url where = {0};
    trust = trust != NULL ? trust : &NOBODY_ELSE;
    int status = client_url_read(url, &where, err);
    if (status != 0)
        return status;
    if (token != NULL && !token_is_valid(token))
        return error_set(err, ERROR_INPUT, "the token holds a space or a control character");
    if (token != NULL && !where.tls && !where.loopback && !trust->insecure && !trust->own)
        return error_set(err, ERROR_INPUT,
                         "%.200s would get the token in clear text over the network: use https://, "
                         "or --insecure where the way there is safe without",
                         url);
    struct client *client = calloc(1, sizeof *client);
    if (client == NULL)
        return error_memory(err, sizeof *client, "a client");
    status = client_fill(client, url, token, trust, &where, err);
    if (status != 0) {
        client_destroy(&client);
        return status;
    }
    *out = client;
    return 0;
}

void client_destroy(struct client **client) {
    struct client *gone = *client;
    if (gone == NULL)
        return;
    curl_easy_cleanup(gone->curl);
    if (gone->authorisation != NULL)
        explicit_bzero(gone->authorisation, strlen(gone->authorisation));
    free(gone->authorisation);
    free(gone->url);
    free(gone);
    *client = NULL;
}

static void reply_clear(struct reply *reply) {
    free(reply->body);
    *reply = (struct reply){0};
}

/* --- one exchange --- */

static size_t sink_keep(struct sink *sink, const char *bytes, size_t size) {
    struct reply *reply = sink->reply;
    if (size > REPLY_BYTES_MOST - reply->size) {
        sink->fault = "the reply is larger than 256 MiB";
        return 0;
    }
    size_t needed = reply->size + size + 1;
    if (needed > sink->capacity) {
        size_t capacity = needed < 4096 ? 4096 : needed * 2;
        char *body = realloc(reply->body, capacity);
        if (body == NULL) {
            sink->fault = "no memory left for the reply";
            return 0;
        }
        reply->body = body;
        sink->capacity = capacity;
    }
    memcpy(reply->body + reply->size, bytes, size);
    reply->size += size;
    reply->body[reply->size] = '\0';
    return size;
}

/* Takes a part as CURLOPT_WRITEFUNCTION; fewer bytes than given end the exchange. */
static size_t sink_write(char *bytes, size_t unit, size_t count, void *context) {
    struct sink *sink = context;
    size_t size = unit * count; /* unit is always 1 */
    long status = 0;
    curl_easy_getinfo(sink->curl, CURLINFO_RESPONSE_CODE, &status);
    if (sink->file == NULL || status < 200 || status > 299)
        return sink_keep(sink, bytes, size);
    if (fwrite(bytes, 1, size, sink->file) != size) {
        sink->fault = "the file cannot be written";
        return 0;
    }
    return size;
}

static bool header_add(struct curl_slist **headers, const char *name, const char *value) {
    char line[256];
    int length = snprintf(line, sizeof line, "%s: %s", name, value);
    if (length < 0 || (size_t)length >= sizeof line || strpbrk(line, "\r\n") != NULL)
        return false;
    struct curl_slist *longer = curl_slist_append(*headers, line);
    *headers = longer != NULL ? longer : *headers;
    return longer != NULL;
}

static bool wait_add(struct curl_slist **headers, unsigned seconds) {
    char value[24];
    snprintf(value, sizeof value, "wait=%u", seconds);
    return seconds == 0 || header_add(headers, "Prefer", value);
}

/* As CURLOPT_XFERINFOFUNCTION; how many bytes came and went is nothing to us. */
static int is_stopped(void *context, curl_off_t a, curl_off_t b, curl_off_t c, curl_off_t d) {
    const struct request *request = context;
    (void)(a + b + c + d);
    return request->stop(request->context);
}

static bool headers_make(const struct client *client, const struct request *request,
                         struct curl_slist **headers) {
    if (client->authorisation != NULL) {
        *headers = curl_slist_append(NULL, client->authorisation);
        if (*headers == NULL)
            return false;
    }
    return header_add(headers, "Accept",
                      request->accept != NULL ? request->accept : "application/json") &&
           header_add(headers, "Expect", "") && wait_add(headers, request->wait_s) &&
           (request->body == NULL || header_add(headers, "Content-Type", "application/json")) &&
           (request->idempotency_key == NULL ||
            header_add(headers, "Idempotency-Key", request->idempotency_key));
}

static bool request_options(CURL *curl, const struct request *request, const char *url,
                            struct curl_slist *headers, struct sink *sink) {
    bool post = strcmp(request->method, "POST") == 0;
    const char *body = request->body != NULL ? request->body : "";
    bool change = strcmp(request->method, "GET") != 0;
    long total = request->timeout_ms != 0 || !change ? request->timeout_ms : TOTAL_MS;
    long silence = sink->file != NULL ? SILENCE_SECONDS : total == 0 ? QUIET_SECONDS : 0;
    bool good =
        curl_easy_setopt(curl, CURLOPT_URL, url) == CURLE_OK &&
        curl_easy_setopt(curl, CURLOPT_HTTPHEADER, headers) == CURLE_OK &&
        curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, sink_write) == CURLE_OK &&
        curl_easy_setopt(curl, CURLOPT_WRITEDATA, sink) == CURLE_OK &&
        curl_easy_setopt(curl, CURLOPT_TIMEOUT_MS, sink->file != NULL ? 0L : total) == CURLE_OK &&
        curl_easy_setopt(curl, CURLOPT_LOW_SPEED_LIMIT, silence != 0 ? 1L : 0L) == CURLE_OK &&
        curl_easy_setopt(curl, CURLOPT_LOW_SPEED_TIME, silence) == CURLE_OK &&
        curl_easy_setopt(curl, CURLOPT_NOPROGRESS, request->stop == NULL ? 1L : 0L) == CURLE_OK &&
        curl_easy_setopt(curl, CURLOPT_XFERINFOFUNCTION, is_stopped) == CURLE_OK &&
        curl_easy_setopt(curl, CURLOPT_XFERINFODATA, (const void *)request) == CURLE_OK &&
        curl_easy_setopt(curl, CURLOPT_HTTPGET, 1L) == CURLE_OK;
    if (good && post) {
        good = curl_easy_setopt(curl, CURLOPT_POST, 1L) == CURLE_OK &&
               curl_easy_setopt(curl, CURLOPT_POSTFIELDS, body) == CURLE_OK &&
               curl_easy_setopt(curl, CURLOPT_POSTFIELDSIZE_LARGE, (curl_off_t)strlen(body)) ==
                   CURLE_OK;
    }
    return good && curl_easy_setopt(curl, CURLOPT_CUSTOMREQUEST, request->method) == CURLE_OK;
}

static int perform(struct client *client, struct sink *sink, struct error *err) {
    client->detail[0] = '\0';
    CURLcode code = curl_easy_perform(client->curl);
    if (code == CURLE_ABORTED_BY_CALLBACK)
        return error_set(err, ERROR_STOPPED, "stopped");
    if (code != 0) {
        long sent = 0;
        client->lost =
            curl_easy_getinfo(client->curl, CURLINFO_REQUEST_SIZE, &sent) == CURLE_OK && sent > 0;
        const char *detail = client->detail[0] != '\0' ? client->detail : curl_easy_strerror(code);
        const char *hint = client_trust_hint(code);
        /* asking a server again that is another than it should be does not help */
        return error_set(err, *hint != '\0' ? ERROR_INPUT : ERROR_SYSTEM, "%s: %s%s", client->url,
                         sink->fault != NULL ? sink->fault : detail, hint);
    }
    curl_easy_getinfo(client->curl, CURLINFO_RESPONSE_CODE, &sink->reply->status);
    /* a proxy says so of a server that it has no answer of */
    client->lost = sink->reply->status == 502 || sink->reply->status == 504;
    return 0;
}

/* file: NULL, or takes the body of a 2xx reply. reply is empty after a failure. */
static int exchange(struct client *client, const struct request *request, FILE *file,
                    struct reply *reply, struct error *err) {
    *reply = (struct reply){0};
    client->lost = false;
    struct sink sink = {.curl = client->curl, .reply = reply, .file = file};
    struct curl_slist *headers = NULL;
    size_t size = strlen(client->url) + strlen(request->path) + 1;
    char *url = malloc(size);
    int status = 0;
    if (url == NULL || !headers_make(client, request, &headers)) {
        status = error_memory(err, size, "a request");
    } else if (request->path[0] != '/' || strpbrk(request->path, " \t\r\n") != NULL) {
        status = error_set(err, ERROR_INPUT, "'%s' is no path of a request", request->path);
    } else {
        snprintf(url, size, "%s%s", client->url, request->path);
        status = request_options(client->curl, request, url, headers, &sink)
                     ? perform(client, &sink, err)
                     : error_set(err, ERROR_SYSTEM, "libcurl refuses a request");
    }
    curl_slist_free_all(headers);
    free(url);
    if (status == 0 && reply->body == NULL && (reply->body = calloc(1, 1)) == NULL)
        status = error_memory(err, 1, "a reply");
    if (status != 0)
        reply_clear(reply);
    return status;
}

/* --- answers as errors --- */

static int status_code(long status) {
    switch (status) {
    case 404:
        return ERROR_ABSENT;
    case 409:
        return ERROR_STATE;
    case 408: /* the server's own deadline, or its limit of requests: later it may do */
    case 429:
        return ERROR_SYSTEM;
    default:
        return status >= 400 && status < 500 ? ERROR_INPUT : ERROR_SYSTEM;
    }
}

/* Appends "; POINTER: DETAIL" of each fault that text does not tell; faults (or NULL) gets all. */
static void append_faults(const cJSON *problem, char *text, size_t size,
                          struct fault_list *faults) {
    const cJSON *fault;
    cJSON_ArrayForEach(fault, cJSON_GetObjectItemCaseSensitive(problem, "errors")) {
        const char *pointer =
            cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(fault, "pointer"));
        const char *detail =
            cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(fault, "detail"));
        size_t length = strlen(text);
        if (pointer == NULL || detail == NULL)
            continue;
        if (*pointer != '\0' || strcmp(detail, text) != 0)
            snprintf(text + length, size - length, "; %s: %s", pointer, detail);
        if (faults != NULL)
            fault_add(faults, pointer, "%s", detail);
    }
}

/* Turns a reply that is no success into an error with the words of its problem document, if any. */
static int reply_error(const struct reply *reply, struct fault_list *faults, struct error *err) {
    cJSON *problem = NULL;
    char text[sizeof err->text];
    struct error ignored;
    const char *detail = NULL;
    if (json_parse(reply->body, reply->size, NULL, &problem, &ignored) == 0) {
        detail = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(problem, "detail"));
        if (detail == NULL)
            detail = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(problem, "title"));
        if (detail == NULL) /* of /healthz */
            detail = cJSON_GetStringValue(
                cJSON_GetArrayItem(cJSON_GetObjectItemCaseSensitive(problem, "reasons"), 0));
    }
    if (detail != NULL) {
        snprintf(text, sizeof text, "%s", detail);
        append_faults(problem, text, sizeof text, faults);
    } else {
        snprintf(text, sizeof text, "the server answered with status %ld", reply->status);
    }
    cJSON_Delete(problem);
    return error_set(err, status_code(reply->status), "%s", text);
}

int client_json(struct client *client, const struct request *request, cJSON **out,
                struct error *err) {
    struct reply reply;
    int status = exchange(client, request, NULL, &reply, err);
    if (status != 0)
        return status;
    cJSON *value = NULL;
    if (reply.status < 200 || reply.status > 299) {
        status = reply_error(&reply, request->faults, err);
    } else if (reply.size == 0 && reply.status != 204) { /* cut off within the headers, too */
        client->lost = true;
        status = error_set(err, ERROR_SYSTEM, "the server's answer is empty");
    } else if (reply.size > 0) {
        status = json_parse(reply.body, reply.size, &REPLY_LIMITS, &value, err);
        if (status == ERROR_INPUT) { /* what came is wrong, not what was asked */
            err->code = status = ERROR_SYSTEM;
            error_context(err, "the server's answer");
        }
    }
    reply_clear(&reply);
    if (status == 0)
        *out = value;
    return status;
}

int client_download(struct client *client, const char *path, FILE *file, struct error *err) {
    struct request request = {.method = "GET", .path = path, .accept = "*/*"};
    struct reply reply;
    int status = exchange(client, &request, file, &reply, err);
    if (status == 0 && (reply.status < 200 || reply.status > 299))
        status = reply_error(&reply, NULL, err);
    reply_clear(&reply);
    return status;
}

bool client_lost_answer(const struct client *client) {
    return client->lost;
}
