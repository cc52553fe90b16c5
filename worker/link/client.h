/* HTTP client of a Rugo server (libcurl): one connection, one thread. */
#ifndef RUGO_WORKER_LINK_CLIENT_H
#define RUGO_WORKER_LINK_CLIENT_H

#include "core/error.h"
#include "schema/study/fault.h"
#include "worker/link/client_trust.h"
#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* Call these once a process, from main, before and after all threads: libcurl's own set-up is not
 * thread-safe. */
int client_global_init(struct error *err);
void client_global_cleanup(void);

struct client;

/* Makes a client. url is http(s)://host:port without path, or host:port alone, which is http://;
 * token may be NULL; trust NULL trusts the system's authorities alone. ERROR_INPUT where the token
 * would cross a network in clear text. */
int client_create(struct client **out, const char *url, const char *token,
                  const struct client_trust *trust, struct error *err);
void client_destroy(struct client **client);

struct request {
    const char *method, *path;   /* "POST", "/v1/studies" */
    const char *body;            /* JSON text or NULL */
    const char *accept;          /* NULL: application/json */
    const char *idempotency_key; /* or NULL */
    struct fault_list *faults;   /* client_json adds those of a refusal; or NULL */
    /* Time limit of the exchange; 0: 30 000, but for a GET as long as a byte comes every minute. */
    long timeout_ms;
    unsigned wait_s;            /* how long the server may wait for what is asked for */
    int (*stop)(void *context); /* called each second: non-zero gives ERROR_STOPPED; or NULL */
    void *context;
};
/* Performs one exchange and parses the body (NULL for a 204). ERROR_SYSTEM without an answer: a
 * later try may succeed. A status >= 400 is an error with the problem's detail and pointers: 404
 * ERROR_ABSENT, 409 ERROR_STATE, 4xx ERROR_INPUT, 5xx ERROR_SYSTEM. */
int client_json(struct client *client, const struct request *request, cJSON **out,
                struct error *err);
enum { KEY_SIZE = 33, KEY_MOST = 200 };
/* Writes a unique key of 128 random bits. */
int key_make(char key[KEY_SIZE], struct error *err);
/* Whether a key is one that a header can repeat: 1 to KEY_MOST visible ASCII characters. */
bool key_is_good(const char *key);
/* Performs a request that changes something. It carries a key (its own, or one made for it), with
 * which it is repeated while answers are lost, within timeout_ms in all. `doubt` ends the message
 * where no answer came in time: it says what may have been done. */
int client_change(struct client *client, const struct request *request, const char *doubt,
                  cJSON **out, struct error *err);
/* Returns the number in a header of the last answer; 0 where it has none. */
uint64_t client_header_number(struct client *client, const char *name);
/* Copies the text of a header of the last answer, cut to size bytes; "" where it has none. */
void client_header_text(struct client *client, const char *name, char *out, size_t size);
/* Writes the body of a 200 to a file. *size, unless NULL, becomes its length; then an answer that
 * does not announce its length is refused before anything is written, and one that has another
 * length afterwards. Without, at most 256 MiB are taken. */
int client_download(struct client *client, const char *path, FILE *file, uint64_t *size,
                    struct error *err);

#endif
