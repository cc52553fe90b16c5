/* What http.c, which starts and stops the daemon, and exchange.c, which it calls, share. */
#ifndef RUGO_SERVER_HTTP_HTTP_INTERNAL_H
#define RUGO_SERVER_HTTP_HTTP_INTERNAL_H

#include "server/http/connections.h"
#include "server/http/http_options.h"
#include "server/http/service.h"
#include <microhttpd.h>

struct http {
    struct service *service;
    struct http_options options;
    struct MHD_Daemon *daemon;
    uint16_t port;
    struct connections *connections;
    pthread_t watchdog;
    pthread_mutex_t mutex; /* guards requests, stopping and ending */
    pthread_cond_t changed;
    unsigned requests; /* being answered */
    bool stopping;     /* http_stop waits for the requests */
    bool ending;
    atomic_size_t bodies; /* bytes that running requests with larger bodies may bring */
};

/* These are for the library, which calls them on the connection's thread; context is the http. */
enum MHD_Result exchange_on_request(void *context, struct MHD_Connection *connection,
                                    const char *path, const char *method, const char *version,
                                    const char *data, size_t *size, void **slot);
void exchange_on_completed(void *context, struct MHD_Connection *connection, void **slot,
                           enum MHD_RequestTerminationCode code);

#endif
