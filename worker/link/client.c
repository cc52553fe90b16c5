#include "worker/link/client.h"
#include "schema/digest.h"
#include "schema/hex.h"
#include "schema/json/json.h"
#include "worker/clock.h"
#include "worker/link/contact.h"
#include <arpa/inet.h>
#include <curl/curl.h>
#include <errno.h>
#include <nettle/base64.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <time.h>
#include <unistd.h>

/* --- the server: its address, and whether it is trusted --- */

/* By address, or by the one name that stands for it: "127.example.org" is somebody's. */
static bool is_loopback(const char *host) {
    struct in_addr address;
    return strcasecmp(host, "localhost") == 0 || strcmp(host, "[::1]") == 0 ||
           (inet_pton(AF_INET, host, &address) == 1 && ntohl(address.s_addr) >> 24 == 127);
}

/* What a client needs of its URL. */
struct client_url {
    bool tls;
    bool loopback; /* its host is this machine */
};

/* Whether it is HOST:PORT alone, as people type it; a path or the name of a file is none. */
static bool lacks_scheme(const char *url) {
    const char *colon = strrchr(url, ':');
    return strstr(url, "://") == NULL && colon != NULL && colon[1] != '\0' &&
           strspn(colon + 1, "0123456789") == strlen(colon + 1);
}

/* ERROR_INPUT where it is not http(s)://HOST:PORT. */
static int client_url_read(const char *url, struct client_url *out, struct error *err) {
    char *scheme = NULL, *host = NULL, *path = NULL, *user = NULL, *query = NULL;
    char *fragment = NULL;
    CURLU *parts = curl_url();
    if (parts == NULL)
        return error_memory(err, 1, "a URL");
    bool good = curl_url_set(parts, CURLUPART_URL, url, 0) == CURLUE_OK &&
                curl_url_get(parts, CURLUPART_SCHEME, &scheme, 0) == CURLUE_OK &&
                curl_url_get(parts, CURLUPART_HOST, &host, 0) == CURLUE_OK &&
                curl_url_get(parts, CURLUPART_PATH, &path, 0) == CURLUE_OK &&
                curl_url_get(parts, CURLUPART_USER, &user, 0) == CURLUE_NO_USER &&
                curl_url_get(parts, CURLUPART_QUERY, &query, 0) == CURLUE_NO_QUERY &&
                curl_url_get(parts, CURLUPART_FRAGMENT, &fragment, 0) == CURLUE_NO_FRAGMENT &&
                (strcmp(scheme, "http") == 0 || strcmp(scheme, "https") == 0) &&
                strcmp(path, "/") == 0;
    out->tls = good && strcmp(scheme, "https") == 0;
    out->loopback = good && is_loopback(host);
    curl_free(scheme);
    curl_free(host);
    curl_free(path);
    curl_free(user);
    curl_free(query);
    curl_free(fragment);
    curl_url_cleanup(parts);
    return good ? 0
                : error_set(err, ERROR_INPUT,
                            "the server's URL %.200s is not http(s)://HOST:PORT, without user or "
                            "path; HOST:PORT alone is http://",
                            url);
}

/* --- fingerprints --- */

/* Curl reads a pin as sha256// and base64 (RFC 4648, 4). */
static int pin_key(CURL *curl, const char *fingerprint, struct error *err) {
    unsigned char digest[DIGEST_SIZE];
    char pin[sizeof "sha256//" + BASE64_ENCODE_RAW_LENGTH(DIGEST_SIZE)] = "sha256//";
    if (!digest_read(fingerprint, digest))
        return error_set(err, ERROR_INPUT,
                         "the fingerprint %.80s is not sha256: and 64 hexadecimal digits, as rugo "
                         "serve prints it",
                         fingerprint);
    base64_encode_raw(pin + strlen(pin), DIGEST_SIZE, digest);
    /* The key is known: name and authority add nothing to it. */
    bool good = curl_easy_setopt(curl, CURLOPT_PINNEDPUBLICKEY, pin) == CURLE_OK &&
                curl_easy_setopt(curl, CURLOPT_SSL_VERIFYPEER, 0L) == CURLE_OK &&
                curl_easy_setopt(curl, CURLOPT_SSL_VERIFYHOST, 0L) == CURLE_OK;
    return good ? 0 : error_set(err, ERROR_SYSTEM, "libcurl cannot pin a server's key");
}

static int name_authorities(CURL *curl, const char *file, struct error *err) {
    if (access(file, R_OK) != 0)
        return error_set(err, ERROR_INPUT, "%s: %s", file, strerror(errno));
    bool good = curl_easy_setopt(curl, CURLOPT_CAINFO, file) == CURLE_OK &&
                curl_easy_setopt(curl, CURLOPT_CAPATH, NULL) == CURLE_OK;
    return good ? 0 : error_set(err, ERROR_SYSTEM, "libcurl takes no file of authorities");
}

/* Sets which servers curl trusts. ERROR_INPUT names what cannot be used. */
static int client_trust_set(CURL *curl, const struct client_trust *trust,
                            const struct client_url *url, struct error *err) {
    if (trust->ca_file != NULL && trust->fingerprint != NULL)
        return error_set(err, ERROR_INPUT,
                         "authorities and a fingerprint exclude each other: the key is known, or "
                         "an authority signed it");
    if (!url->tls)
        return trust->fingerprint == NULL
                   ? 0
                   : error_set(err, ERROR_INPUT, "a fingerprint goes with https://");
    bool good =
        curl_easy_setopt(curl, CURLOPT_SSLVERSION, (long)CURL_SSLVERSION_TLSv1_2) == CURLE_OK &&
        (!trust->own || (curl_easy_setopt(curl, CURLOPT_SSL_VERIFYPEER, 0L) == CURLE_OK &&
                         curl_easy_setopt(curl, CURLOPT_SSL_VERIFYHOST, 0L) == CURLE_OK));
    if (!good)
        return error_set(err, ERROR_SYSTEM, "libcurl has no TLS");
    if (trust->fingerprint != NULL)
        return pin_key(curl, trust->fingerprint, err);
    return trust->ca_file != NULL ? name_authorities(curl, trust->ca_file, err) : 0;
}

/* Returns advice for a server that curl did not trust; "" for any other failure. */
static const char *client_trust_hint(CURLcode code) {
    switch (code) {
    case CURLE_PEER_FAILED_VERIFICATION:
        return "; --ca-file names its authorities, --fingerprint its key";
    case CURLE_SSL_PINNEDPUBKEYNOTMATCH:
        return "; its key is not that of --fingerprint: nothing was sent";
    case CURLE_SSL_CACERT_BADFILE:
        return "; the file of authorities cannot be used";
    default:
        return "";
    }
}

/* --- one exchange --- */

enum {
    CONNECT_MS = 10000,
    TOTAL_MS = 30000,
    QUIET_SECONDS = 60,    /* longest pause of an answer: curves are merged for it */
    SILENCE_SECONDS = 300, /* longest pause of a download: the server first copies the database */
    REPLY_BYTES_MOST = 256 << 20,
};
/* Curves of many cases with their matrices are larger than any study that the server takes. */
static const struct json_limits REPLY_LIMITS = {REPLY_BYTES_MOST, 32, 20000000};

struct client {
    CURL *curl;
    char *url;           /* scheme://host:port, no slash behind it */
    char *authorisation; /* the header line with the token, or NULL; never printed */
    char detail[CURL_ERROR_SIZE];
    struct contact contact;
    bool lost; /* the last request was at least begun, and has no answer */
};

struct reply {
    long status; /* of HTTP; 0: no answer at all (the connection failed) */
    char *body;  /* owned, NUL-terminated */
    size_t size;
};

/* Collects the body of one reply. */
struct sink {
    CURL *curl;
    struct reply *reply;
    size_t capacity; /* bytes allocated for reply->body */
    FILE *file;      /* takes the body of a 200 instead; NULL: none */
    bool exact;      /* such a body has the length that was announced, or is not taken */
    uint64_t size;   /* of what the file has taken */
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

/* Refuses line breaks, as one in a token would start another header. */
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
    /* CURLOPT_PROXY "" ignores proxies of the environment. */
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

static int create(struct client **out, const char *url, const char *token,
                  const struct client_trust *trust, struct error *err) {
    struct client_url where = {0};
    int status = client_url_read(url, &where, err);
    if (status != 0)
        return status;
    if (token != NULL && !token_is_valid(token))
        return error_set(err, ERROR_INPUT, "the token holds a space or a control character");
    if (token != NULL && !where.tls && !where.loopback && !trust->insecure && !trust->own)
        return error_set(err, ERROR_INPUT,
                         "%.200s would get the token in clear text over the network: use https://, "
                         "or --insecure where the connection is safe without",
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

int client_create(struct client **out, const char *url, const char *token,
                  const struct client_trust *trust, struct error *err) {
    static const struct client_trust NOBODY_ELSE = {0};
    char *whole = NULL;
    if (lacks_scheme(url) && asprintf(&whole, "http://%s", url) < 0)
        return error_memory(err, strlen(url), "a URL");
    int status =
        create(out, whole != NULL ? whole : url, token, trust != NULL ? trust : &NOBODY_ELSE, err);
    free(whole);
    return status;
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

/* Returns whether the file may take so many bytes more. */
static bool sink_has_room(struct sink *sink, size_t size) {
    curl_off_t announced = -1;
    if (sink->exact)
        curl_easy_getinfo(sink->curl, CURLINFO_CONTENT_LENGTH_DOWNLOAD_T, &announced);
    if (sink->exact && announced < 0)
        sink->fault = "the answer does not say how long it is";
    else if (sink->exact ? size > (uint64_t)announced - sink->size
                         : size > REPLY_BYTES_MOST - sink->size)
        sink->fault =
            sink->exact ? "more came than was announced" : "the reply is larger than 256 MiB";
    return sink->fault == NULL;
}

/* Receives a part of the body, as a CURLOPT_WRITEFUNCTION; to return fewer bytes than given ends
 * the exchange. */
static size_t sink_write(char *bytes, size_t unit, size_t count, void *context) {
    struct sink *sink = context;
    size_t size = unit * count; /* unit is always 1 */
    long status = 0;
    curl_easy_getinfo(sink->curl, CURLINFO_RESPONSE_CODE, &status);
    if (sink->file == NULL || status != 200)
        return sink_keep(sink, bytes, size);
    if (!sink_has_room(sink, size))
        return 0;
    sink->size += size;
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

/* Asks whether to stop, as a CURLOPT_XFERINFOFUNCTION; the byte counts are not used. */
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
        curl_easy_setopt(curl, CURLOPT_HTTPGET, 1L) == CURLE_OK &&
        /* the length that is announced for what is compressed is not that of the file */
        (!sink->exact || curl_easy_setopt(curl, CURLOPT_ACCEPT_ENCODING, NULL) == CURLE_OK);
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
    if (sink->fault != NULL) { /* of what a stranger sends, only that it is one is of interest */
        int status = contact_judge(&client->contact, client->curl, client->url, err);
        if (status != 0)
            return status;
    }
    if (code != 0) {
        long sent = 0;
        client->lost =
            curl_easy_getinfo(client->curl, CURLINFO_REQUEST_SIZE, &sent) == CURLE_OK && sent > 0;
        const char *detail = client->detail[0] != '\0' ? client->detail : curl_easy_strerror(code);
        const char *hint = client_trust_hint(code);
        if (*hint == '\0')
            hint = contact_fault(&client->contact, client->curl, client->url, code);
        /* another try at a server whose identity is wrong does not help */
        return error_set(err, *hint != '\0' ? ERROR_INPUT : ERROR_SYSTEM, "%s: %s%s", client->url,
                         sink->fault != NULL ? sink->fault : detail, hint);
    }
    curl_easy_getinfo(client->curl, CURLINFO_RESPONSE_CODE, &sink->reply->status);
    /* a proxy reports so that the server did not answer it */
    client->lost = sink->reply->status == 502 || sink->reply->status == 504;
    return contact_judge(&client->contact, client->curl, client->url, err);
}

/* sink says what takes the body of a 200, if not reply, which is empty after a failure. */
static int exchange(struct client *client, const struct request *request, struct sink *sink,
                    struct reply *reply, struct error *err) {
    *reply = (struct reply){0};
    client->lost = false;
    sink->curl = client->curl;
    sink->reply = reply;
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
        status = request_options(client->curl, request, url, headers, sink)
                     ? perform(client, sink, err)
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
    case 408: /* the server's deadline or limit of requests: a later try may succeed */
    case 429:
        return ERROR_SYSTEM;
    default:
        return status >= 400 && status < 500 ? ERROR_INPUT : ERROR_SYSTEM;
    }
}

/* Appends "; POINTER: DETAIL" of each fault that is not in text yet; faults (or NULL) gets all. */
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

/* Turns a reply without success into an error with the text of its problem document, if any. */
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
    struct sink sink = {.file = NULL};
    int status = exchange(client, request, &sink, &reply, err);
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
        if (status == ERROR_INPUT) { /* the reply is wrong, not the request */
            err->code = status = ERROR_SYSTEM;
            error_context(err, "the server's answer");
        }
    }
    reply_clear(&reply);
    if (status == 0)
        *out = value;
    return status;
}

uint64_t client_header_number(struct client *client, const char *name) {
    struct curl_header *header = NULL;
    if (curl_easy_header(client->curl, name, 0, CURLH_HEADER, -1, &header) != CURLHE_OK)
        return 0;
    return strtoull(header->value, NULL, 10);
}

void client_header_text(struct client *client, const char *name, char *out, size_t size) {
    struct curl_header *header = NULL;
    bool found = curl_easy_header(client->curl, name, 0, CURLH_HEADER, -1, &header) == CURLHE_OK;
    snprintf(out, size, "%s", found ? header->value : "");
}

int client_download(struct client *client, const char *path, FILE *file, uint64_t *size,
                    struct error *err) {
    struct request request = {.method = "GET", .path = path, .accept = "*/*"};
    struct sink sink = {.file = file, .exact = size != NULL};
    struct reply reply;
    int status = exchange(client, &request, &sink, &reply, err);
    if (status == 0 && reply.status != 200)
        status = reply_error(&reply, NULL, err);
    if (status == 0 && size != NULL)
        *size = sink.size;
    reply_clear(&reply);
    return status;
}

/* Returns whether the last request of a client may have been done although no answer came. */
static bool client_lost_answer(const struct client *client) {
    return client->lost;
}

/* Requests that change something, repeated until they are answered. */

enum {
    CHANGE_MS = 30000,
    FIRST_PAUSE_MS = 200,
    PAUSE_MOST_MS = 2000,
    LEFT_LEAST_MS = 50, /* too little time for another request */
};

int key_make(char key[KEY_SIZE], struct error *err) {
    return hex_random(key, KEY_SIZE - 1, err);
}

bool key_is_good(const char *key) {
    size_t length = 0;
    while (key[length] > ' ' && key[length] < 0x7f)
        length++;
    return length != 0 && length <= KEY_MOST && key[length] == '\0';
}

static void pause_ms(int64_t milliseconds) {
    const struct timespec pause = {milliseconds / 1000, milliseconds % 1000 * 1000000};
    nanosleep(&pause, NULL);
}

/* A request that was done although its answer was lost is refused when repeated: the study that it
 * deleted is absent, one that it cancelled has ended so. Returns 0 for these; any other refusal is
 * returned. */
static int read_refusal(struct client *client, const struct request *request, cJSON **out,
                        struct error *err) {
    bool deletes = strcmp(request->method, "DELETE") == 0;
    const struct request question = {.method = "GET", .path = request->path};
    struct error ignored;
    int refusal = err->code;
    if (deletes && refusal == ERROR_ABSENT && strchr(request->path, '?') != NULL)
        return 0;
    if (!deletes || refusal != ERROR_STATE || client_json(client, &question, out, &ignored) != 0)
        return refusal;
    const char *state = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(*out, "state"));
    if (state != NULL && strcmp(state, "cancelled") == 0)
        return 0;
    cJSON_Delete(*out);
    *out = NULL;
    return refusal;
}

/* Puts the reason of the last failure first. */
static int add_doubt(struct error *err, long total_ms, const char *doubt) {
    char reason[160];
    snprintf(reason, sizeof reason, "%.159s", err->text);
    return error_set(err, ERROR_SYSTEM, "%s; no answer within %g s: %s", reason,
                     1e-3 * (double)total_ms, doubt);
}

int client_change(struct client *client, const struct request *request, const char *doubt,
                  cJSON **out, struct error *err) {
    char key[KEY_SIZE];
    struct request again = *request;
    long total_ms = request->timeout_ms != 0 ? request->timeout_ms : CHANGE_MS;
    int64_t pause = FIRST_PAUSE_MS, until_ms = clock_ms() + total_ms;
    bool lost = false;
    *out = NULL;
    if (again.idempotency_key == NULL) {
        int status = key_make(key, err);
        if (status != 0)
            return status;
        again.idempotency_key = key;
    }
    for (;;) {
        again.timeout_ms = (long)(until_ms - clock_ms());
        int status = client_json(client, &again, out, err);
        if (lost && (status == ERROR_ABSENT || status == ERROR_STATE))
            return read_refusal(client, &again, out, err);
        /* a request that may have been taken is repeated even while the server is away */
        lost = lost || (status != 0 && client_lost_answer(client));
        if (status == 0 || !lost || status != ERROR_SYSTEM)
            return status;
        if (until_ms - clock_ms() < pause + LEFT_LEAST_MS)
            return add_doubt(err, total_ms, doubt);
        pause_ms(pause);
        pause = 2 * pause < PAUSE_MOST_MS ? 2 * pause : PAUSE_MOST_MS;
    }
}
