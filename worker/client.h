/* HTTP client of a Rugo server (libcurl): one connection, one thread. */
#ifndef RUGO_WORKER_CLIENT_H
#define RUGO_WORKER_CLIENT_H

#include "core/error.h"
#include "schema/study/fault.h"
#include <cjson/cJSON.h>
#include <stdio.h>

/* Once a process, from main, before and after all threads: libcurl's own set-up is not thread-safe.
 */
int client_global_init(struct error *err);
void client_global_cleanup(void);

struct client;

/* Makes a client; url is http(s)://host:port without path, token may be NULL. */
int client_create(struct client **out, const char *url, const char *token, struct error *err);
void client_destroy(struct client **client);

struct request {
    const char *method, *path;   /* "POST", "/v1/studies" */
    const char *body;            /* JSON text or NULL */
    const char *accept;          /* NULL: application/json */
    const char *idempotency_key; /* or NULL */
    struct fault_list *faults;   /* client_json adds those of a refusal; or NULL */
    long timeout_ms;             /* 0: 30 000 */
};
/* One exchange; parses the body (NULL for a 204). ERROR_SYSTEM without an answer: try again later.
 * A status >= 400 is an error with the problem's detail and pointers: 404 ERROR_ABSENT, 409
 * ERROR_STATE, 4xx ERROR_INPUT, 5xx ERROR_SYSTEM. */
int client_json(struct client *client, const struct request *request, cJSON **out,
                struct error *err);
/* Streams a body to a file (snapshot). */
int client_download(struct client *client, const char *path, FILE *file, struct error *err);

#endif
