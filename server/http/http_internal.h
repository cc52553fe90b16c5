/* What http.c, which runs the daemon, and exchange.c, which asks it, share. */
#ifndef RUGO_SERVER_HTTP_HTTP_INTERNAL_H
#define RUGO_SERVER_HTTP_HTTP_INTERNAL_H

#include "server/http/guard/connections.h"
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

#endif
