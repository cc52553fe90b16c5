/* What the files of the client share; nobody else includes this. */
#ifndef RUGO_WORKER_CLIENT_INTERNAL_H
#define RUGO_WORKER_CLIENT_INTERNAL_H

#include "core/error.h"
#include "worker/client_trust.h"
#include <curl/curl.h>

/* What of a URL must be known before a request. */
struct client_url {
    bool tls;
    bool loopback; /* its host is this machine */
};
/* ERROR_INPUT where it is not http(s)://HOST:PORT. */
int client_url_read(const char *url, struct client_url *out, struct error *err);
/* Tells curl whom to believe. ERROR_INPUT names what cannot be used. */
int client_trust_set(CURL *curl, const struct client_trust *trust, const struct client_url *url,
                     struct error *err);
/* What helps where curl did not believe a server; "" for any other failure. */
const char *client_trust_hint(CURLcode code);

/* Whether the last request of a client may have been taken, and no answer came. */
struct client;
bool client_lost_answer(const struct client *client);

#endif
