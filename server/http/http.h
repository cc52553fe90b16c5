/* The HTTP side: connections with deadlines, bounded bodies, and one exchange at a time for the
 * routes. */
#ifndef RUGO_SERVER_HTTP_HTTP_H
#define RUGO_SERVER_HTTP_HTTP_H

#include "server/http/http_options.h"
#include "server/http/service.h"

struct http;

int http_start(struct http **out, struct service *service, const struct http_options *options,
               struct error *err);
uint16_t http_port(const struct http *http);
/* Takes no more connections, lets running requests end (1.2 s at most), closes. Handlers that
 * do not ask exchange_is_lost hold it up. */
void http_stop(struct http **http);

#endif
