/* A request and its answer, for the routes. */
#ifndef RUGO_SERVER_HTTP_EXCHANGE_H
#define RUGO_SERVER_HTTP_EXCHANGE_H

#include "schema/json/json.h"
#include "schema/study/fault.h"
#include "server/http/service.h"
#include <cjson/cJSON.h>
#include <microhttpd.h>

enum {
    HOST_SIZE = 272, /* a name of DNS has up to 253 characters */
    HEADER_LISTS = 4 /* headers that may come as several lines (exchange.c) */
};

/* Routes fill the answer by the functions below, once. */
struct exchange {
    struct service *service;
    struct http *http;
    struct MHD_Connection *connection;
    struct connection *peer; /* borrowed: its entry among the others */
    const char *method, *path;
    char *body;                  /* NUL-terminated, NULL without one */
    size_t body_size, body_room; /* room without the NUL */
    size_t body_most;            /* bytes that it may have */
    bool has_file;               /* it is a file, which is counted among those (service.h) */
    bool needs_host;             /* HTTP/1.1, where a request names its server */
    bool bad_target;             /* it asks for what has a space or a NUL, not escaped */
    bool slashed_target;         /* its path has an escaped slash */
    char host[HOST_SIZE];        /* that the target names, with its port; "": that of the header */
    char *lists[HEADER_LISTS];   /* owned: the lines of a list as one; NULL: there is one at most */
    int64_t start_ns;

    /* Who asks: the name of the token, "" without; and whether it may change the studies of all. */
    char owner[OWNER_SIZE];
    bool admin;

    unsigned status;               /* 0 until answered */
    struct MHD_Response *response; /* owned until queued */
    struct handed_out *handed_out; /* owned: jobs of a claim, until their answer has arrived */
};

const char *exchange_query(const struct exchange *exchange, const char *name); /* NULL if absent */
/* NULL if absent. Of a list (RFC 9110, 5.3) that came as several lines it is all of them. */
const char *exchange_header(const struct exchange *exchange, const char *name);
/* Takes a line of the head: lines of a list are joined. To be called for each of them, once. */
void exchange_join(struct exchange *exchange, const char *name, const char *value);

int exchange_socket(const struct exchange *exchange);
/* Work for an answer asks this from time to time; context is the exchange. Not 0 once the peer has
 * gone, or the server ends. */
int exchange_is_lost(void *context);
/* Lends a reader of the store, which stops with ERROR_STOPPED once the exchange is lost; to be
 * given back to the service. */
int exchange_reader(struct exchange *exchange, struct store **out, struct error *err);
/* The peer may ask for what it asks for: its connection is not the first to go at the limit. */
void exchange_vouch(struct exchange *exchange);
/* Whether the connection is of the reserve (connections.h), and whether it may ask for anything
 * there all the same. */
bool exchange_is_reserved(const struct exchange *exchange);
bool exchange_takes_turn(struct exchange *exchange);

/* Answers with a document, which it takes. */
void answer_json(struct exchange *exchange, unsigned status, cJSON *document);
/* Answers with a text, which it takes (malloc); a large one in gzip where the peer takes that. */
void answer_text(struct exchange *exchange, unsigned status, const char *type, char *text);
/* Answers with bytes, which it takes (malloc). */
void answer_bytes(struct exchange *exchange, const char *type, char *bytes, size_t size);
/* Answers with static data that outlives the server. */
void answer_static(struct exchange *exchange, const char *type, const char *data, size_t size);
void answer_empty(struct exchange *exchange, unsigned status);
/* Answers 304, in place of an answer that may be made already. It has no length, which would have
 * to be that of the 200 (RFC 9110, 8.6), and as that says that it might be in gzip. */
void answer_unchanged(struct exchange *exchange);
/* Adds a header to the answer. */
void answer_header(struct exchange *exchange, const char *name, const char *value);
/* Makes well-formed UTF-8 of a text, which JSON must be: messages quote what a peer sent as it
 * came, or cut within a character. Accepts NULL. */
void answer_mend(char *text);
/* Answers with a problem as RFC 9457 has it. */
void answer_problem(struct exchange *exchange, unsigned status, const char *detail,
                    const struct fault_list *faults);
/* Answers with the status that an error code stands for, and its text. */
void answer_error(struct exchange *exchange, const struct error *err);
/* Gives the peer the whole deadline again; for streams, each time that it takes a part. */
void exchange_renew(struct exchange *exchange);
/* An answer whose parts read gives as the peer takes them; size may be MHD_SIZE_UNKNOWN. Takes
 * context, to be released by free_context. */
void answer_stream(struct exchange *exchange, const char *type, uint64_t size,
                   MHD_ContentReaderCallback read, void *context,
                   MHD_ContentReaderFreeCallback free_context);
/* Likewise a document of unknown size, in gzip where the peer takes that. */
void answer_document_stream(struct exchange *exchange, const char *type,
                            MHD_ContentReaderCallback read, void *context,
                            MHD_ContentReaderFreeCallback free_context);
/* Whether the peer takes gzip: what distinguishes forms of an answer must know. */
bool answer_is_compressed(const struct exchange *exchange);
/* Whether the name in a Host header is one of the server's. */
bool exchange_host_allowed(const struct exchange *exchange, const char *host);

#endif
