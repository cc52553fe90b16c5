/* Server-sent events: a study's progress, until it ends. */
#include "server/command/access/api.h"
#include "server/http/route/route.h"
#include "worker/clock.h"
#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { STREAMS_MOST = 64, POLL_MS = 300, ALIVE_MS = 15000 };
/* A study whose jobs run, and end seldom, is reported whenever so much more of its work is done. */
static const double SHARE_STEP = 0.001;

/* One stream; the library calls next_event on the connection's own thread, which may wait. */
struct event_stream {
    struct exchange *exchange; /* lives as long as the library calls next_event */
    struct service *service;
    int socket; /* the library's */
    char id[SEGMENT_SIZE];
    double revision; /* sent last; -1 at first */
    double share;    /* of the work, sent last */
    int64_t sent_ms;
    bool ended;
    char *pending; /* owned: text not yet taken */
    size_t sent;
};

/* Waits a little; true when the peer has left, which a stream that writes nothing would not notice.
 */
static bool peer_leaves(const struct event_stream *stream) {
    struct pollfd peer = {.fd = stream->socket, .events = POLLRDHUP};
    return poll(&peer, 1, POLL_MS) > 0;
}

static bool has_ended(const cJSON *status) {
    const char *state = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(status, "state"));
    return state == NULL || (strcmp(state, "queued") != 0 && strcmp(state, "running") != 0);
}

/* Returns the text of the next event, or NULL when there is nothing new. */
static char *read_event(struct event_stream *stream) {
    struct store *reader;
    struct error err = {0};
    cJSON *status = NULL;
    char *text = NULL, *event = NULL;
    int code = service_reader(stream->service, &reader, &err);
    if (code == 0)
        code = api_status(reader, stream->id, &status, &err);
    service_give_back(stream->service, reader);
    if (code != 0) {
        stream->ended = true;
        return code == ERROR_ABSENT ? strdup("event: deleted\ndata: {}\n\n") : NULL;
    }
    double revision = cJSON_GetNumberValue(cJSON_GetObjectItemCaseSensitive(status, "revision"));
    double share = cJSON_GetNumberValue(cJSON_GetObjectItemCaseSensitive(status, "share"));
    bool moved = revision != stream->revision || fabs(share - stream->share) >= SHARE_STEP;
    if (moved && (text = json_print(status)) != NULL &&
        asprintf(&event, "event: progress\ndata: %s\n\n", text) < 0)
        event = NULL;
    if (event != NULL) { /* else it is tried again, soon */
        stream->revision = revision;
        stream->share = share;
        stream->ended = has_ended(status);
    }
    free(text);
    cJSON_Delete(status);
    return event;
}

static ssize_t next_event(void *context, uint64_t position, char *buffer, size_t room) {
    struct event_stream *stream = context;
    (void)position;
    while (stream->pending == NULL) {
        exchange_renew(stream->exchange);
        if (stream->ended || atomic_load(&stream->service->stopping))
            return MHD_CONTENT_READER_END_OF_STREAM;
        stream->pending = read_event(stream);
        stream->sent = 0;
        if (stream->pending == NULL && clock_ms() - stream->sent_ms > ALIVE_MS)
            stream->pending = strdup(": alive\n\n");
        if (stream->pending == NULL && !stream->ended)
            stream->ended = peer_leaves(stream);
    }
    exchange_renew(stream->exchange); /* who takes nothing for a whole deadline is cut */
    size_t left = strlen(stream->pending) - stream->sent, part = left < room ? left : room;
    memcpy(buffer, stream->pending + stream->sent, part);
    stream->sent += part;
    stream->sent_ms = clock_ms();
    if (part == left) {
        free(stream->pending);
        stream->pending = NULL;
    }
    return (ssize_t)part;
}

static void stream_free(void *context) {
    struct event_stream *stream = context;
    atomic_fetch_sub(&stream->service->streams, 1);
    free(stream->pending);
    free(stream);
}

void handle_events(struct exchange *exchange, const char *id) {
    struct store *reader;
    struct error err = {0};
    struct study_status status = {0};
    int code = service_reader(exchange->service, &reader, &err);
    if (code == 0)
        code = store_status(reader, id, &status, &err);
    service_give_back(exchange->service, reader);
    study_status_clear(&status);
    struct event_stream *stream = code != 0 ? NULL : calloc(1, sizeof *stream);
    if (stream == NULL) {
        if (code == 0)
            error_memory(&err, sizeof *stream, "a stream");
        answer_error(exchange, &err);
        return;
    }
    stream->exchange = exchange;
    stream->service = exchange->service;
    stream->revision = -1;
    stream->socket = exchange_socket(exchange);
    snprintf(stream->id, sizeof stream->id, "%s", id);
    if (atomic_fetch_add(&exchange->service->streams, 1) >= STREAMS_MOST) {
        stream_free(stream);
        answer_problem(exchange, 503, "too many streams of events are open", NULL);
        return;
    }
    answer_stream(exchange, "text/event-stream", MHD_SIZE_UNKNOWN, next_event, stream, stream_free);
    answer_header(exchange, "Cache-Control", "no-store");
}
