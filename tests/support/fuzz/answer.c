#include "tests/support/fuzz/answer.h"
#include "schema/json/json.h"
#include "tests/support/fuzz/fuzz.h"
#include <arpa/inet.h>
#include <errno.h>
#include <expat.h>
#include <strings.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>
#include <zlib.h>

enum { PATIENCE_S = 60, PART = 1 << 16, UNPACKED_MOST = 64 << 20 };
static const char EVENTS[] = "text/event-stream", PROBLEM[] = "application/problem+json";

/* --- over the network --- */

static int connect_to(uint16_t port) {
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons(port)};
    struct timeval patience = {.tv_sec = PATIENCE_S};
    int peer = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    MUST(peer >= 0 && connect(peer, (struct sockaddr *)&address, sizeof address) == 0);
    setsockopt(peer, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    return peer;
}

static bool is_first_event(const char *text) {
    const char *head = strcasestr(text, EVENTS), *body = strstr(text, "\r\n\r\n");
    return head != NULL && body != NULL && head < body && strstr(body + 4, "\n\n") != NULL;
}

/* Who refuses before the body comes need not read it. The caller frees. */
static char *converse(uint16_t port, const char *bytes, size_t size, size_t *length) {
    int peer = connect_to(port);
    size_t room = PART, used = 0;
    char *text = malloc(room);
    MUST(text != NULL);
    *text = '\0';
    for (size_t sent = 0; sent < size;) {
        ssize_t part = send(peer, bytes + sent, size - sent, MSG_NOSIGNAL);
        if (part < 0 && errno != EINTR)
            break;
        sent += part > 0 ? (size_t)part : 0;
    }
    for (ssize_t got = 1; got != 0 && !is_first_event(text);) {
        got = recv(peer, text + used, room - used - 1, 0);
        if (got < 0 && errno == ECONNRESET && used > 0)
            break;
        if (got < 0 && errno != EINTR)
            fprintf(stderr, "to\n%.*s\nno answer came: %s\n", (int)size, bytes, strerror(errno));
        MUST(got >= 0 || errno == EINTR);
        used += got > 0 ? (size_t)got : 0;
        text[used] = '\0';
        if (room - used == 1)
            MUST((text = realloc(text, room *= 2)) != NULL);
    }
    close(peer);
    *length = used;
    return text;
}

/* --- one answer --- */

/* Writes the value of a header; "" without. */
static void read_header(const char *head, const char *name, char *value, size_t size) {
    *value = '\0';
    for (const char *line = strstr(head, "\r\n"); line != NULL; line = strstr(line + 2, "\r\n"))
        if (strncasecmp(line + 2, name, strlen(name)) == 0 && line[2 + strlen(name)] == ':') {
            const char *at = line + 3 + strlen(name) + strspn(line + 3 + strlen(name), " ");
            snprintf(value, size, "%.*s", (int)strcspn(at, "\r\n"), at);
            return;
        }
}

/* Joins chunks in place; the length of what they hold. Nothing may stand behind the last. */
static size_t join_chunks(char *body, size_t size) {
    size_t at = 0, joined = 0;
    for (;;) {
        char *end;
        unsigned long part = strtoul(body + at, &end, 16);
        MUST(end != body + at && strncmp(end, "\r\n", 2) == 0);
        at = (size_t)(end - body) + 2;
        MUST(part <= size - at && size - at - part >= 2);
        memmove(body + joined, body + at, part);
        joined += part;
        at += part + 2;
        if (part == 0)
            break;
    }
    MUST(at == size);
    body[joined] = '\0';
    return joined;
}

static void unpack(struct answer *answer) {
    z_stream stream = {.next_in = (Bytef *)answer->body, .avail_in = (uInt)answer->size};
    size_t room = PART;
    char *text = malloc(room);
    int status = Z_OK;
    MUST(text != NULL && inflateInit2(&stream, 16 + MAX_WBITS) == Z_OK);
    while (status == Z_OK) {
        if (room - stream.total_out == 1)
            MUST(room < UNPACKED_MOST && (text = realloc(text, room *= 2)) != NULL);
        stream.next_out = (Bytef *)text + stream.total_out;
        stream.avail_out = (uInt)(room - stream.total_out - 1);
        status = inflate(&stream, Z_NO_FLUSH);
    }
    MUST(status == Z_STREAM_END && stream.avail_in == 0);
    text[stream.total_out] = '\0';
    free(answer->body);
    answer->body = text;
    answer->size = stream.total_out;
    inflateEnd(&stream);
}

static void read_body(struct answer *answer, const struct drawn_request *request) {
    char length[32], coding[32], chunked[32];
    read_header(answer->head, "Content-Length", length, sizeof length);
    read_header(answer->head, "Content-Encoding", coding, sizeof coding);
    read_header(answer->head, "Transfer-Encoding", chunked, sizeof chunked);
    MUST(*length == '\0' || *chunked == '\0');
    if (request->head || answer->status == 204 || answer->status == 304) {
        MUST(answer->size == 0);
        return;
    }
    if (strncmp(answer->type, EVENTS, strlen(EVENTS)) == 0)
        return;
    if (*length != '\0')
        MUST(strtoull(length, NULL, 10) == answer->size);
    if (*chunked != '\0')
        answer->size = join_chunks(answer->body, answer->size);
    if (*coding != '\0') {
        MUST(strcmp(coding, "gzip") == 0);
        unpack(answer);
    }
}

void answer_of(struct answer *out, uint16_t port, const struct drawn_request *request) {
    size_t size = 0;
    char *text = converse(port, request->bytes, request->size, &size);
    char *end = strstr(text, "\r\n\r\n");
    MUST(strncmp(text, "HTTP/1.1 ", 9) == 0 && end != NULL);
    *out = (struct answer){.status = strtol(text + 9, NULL, 10), .head = text};
    out->size = size - (size_t)(end + 4 - text);
    out->body = malloc(out->size + 1);
    MUST(out->body != NULL);
    memcpy(out->body, end + 4, out->size + 1);
    end[2] = '\0';
    read_header(text, "Content-Type", out->type, sizeof out->type);
    read_header(text, "ETag", out->etag, sizeof out->etag);
    read_body(out, request);
}

void answer_clear(struct answer *answer) {
    free(answer->head);
    free(answer->body);
    *answer = (struct answer){.status = 0};
}

/* --- what every answer is --- */

static bool is_text(const cJSON *object, const char *name, bool may_be_empty) {
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, name));
    return text != NULL && (may_be_empty || *text != '\0');
}

/* Each fault of the list has a pointer, which is "" for the whole, and says what is wrong with
 * it. */
static bool names_places(const cJSON *errors) {
    const cJSON *one;
    bool good = cJSON_GetArraySize(errors) > 0;
    cJSON_ArrayForEach(one, errors) good =
        good && is_text(one, "pointer", true) && is_text(one, "detail", false);
    return good;
}

/* Of a body that is not valid the pointer is listed; a text about a query, a file, or a name that
 * several studies have, says it. */
static bool is_problem(const cJSON *document, long status, const struct route *route) {
    const cJSON *told = cJSON_GetObjectItemCaseSensitive(document, "status");
    const cJSON *errors = cJSON_GetObjectItemCaseSensitive(document, "errors");
    const char *detail = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(document, "detail"));
    bool listed = strcmp(route->method, "POST") == 0 && route->handler != handle_characterise &&
                  detail != NULL && strstr(detail, "may be each of") == NULL;
    return cJSON_IsNumber(told) && (long)told->valuedouble == status &&
           is_text(document, "type", false) && is_text(document, "title", false) &&
           is_text(document, "detail", false) &&
           (errors == NULL ? status != 422 || !listed : names_places(errors));
}

static bool is_xml(const char *text, size_t size) {
    XML_Parser parser = XML_ParserCreate(NULL);
    MUST(parser != NULL);
    bool good = XML_Parse(parser, text, (int)size, 1) == XML_STATUS_OK;
    XML_ParserFree(parser);
    return good;
}

static bool is_json(const struct answer *answer, const struct route *route) {
    const struct json_limits limits = {UNPACKED_MOST, 64, 10000000};
    cJSON *document = NULL;
    bool problem = strcmp(answer->type, PROBLEM) == 0;
    bool good = json_parse(answer->body, answer->size, &limits, &document, &(struct error){0}) == 0;
    good = good && (!problem || is_problem(document, answer->status, route));
    cJSON_Delete(document);
    return good;
}

static bool has_content(const struct answer *answer, const struct route *route) {
    if (strcmp(answer->type, PROBLEM) == 0 || strcmp(answer->type, "application/json") == 0)
        return is_json(answer, route);
    if (answer->status >= 400)
        return false; /* a page of the library's own */
    return strcmp(answer->type, "image/svg+xml") != 0 || is_xml(answer->body, answer->size);
}

void answer_judge(const struct answer *answer, const struct drawn_request *request) {
    long status = answer->status;
    bool bare = request->head || status == 204 || status == 304;
    bool good = status >= 200 && status < 500 && (bare || has_content(answer, request->route));
    if (!good)
        fprintf(stderr, "to\n%.*s\ncame\n%s\n%.4000s\n", (int)request->size, request->bytes,
                answer->head, answer->body);
    MUST(good);
}
