/* Where the service listens, for whom, and its limits. */
#ifndef RUGO_SERVER_HTTP_HTTP_OPTIONS_H
#define RUGO_SERVER_HTTP_HTTP_OPTIONS_H

#include "server/http/guard/certificate.h"
#include <stdint.h>

struct http_options {
    const char *address;      /* numeric; owned by the caller, as are all strings */
    uint16_t port;            /* 0: a free one */
    unsigned connections;     /* most at a time, beside the reserve */
    unsigned per_address;     /* of those, from one address beyond this machine; 0: no limit */
    unsigned deadline_s;      /* for one request */
    const char *const *hosts; /* names of this server beside localhost, NULL-terminated */
    struct certificate *certificate; /* for TLS; NULL: plain HTTP */
};

#endif
