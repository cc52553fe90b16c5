/* Whether the service can do its work, and if not, why. */
#ifndef RUGO_SERVER_HTTP_HEALTH_H
#define RUGO_SERVER_HTTP_HEALTH_H

#include "core/error.h"
#include <stddef.h>

struct service;

enum { HEALTH_REASONS_MOST = 4 };
struct health {
    size_t count; /* of reasons; 0: all is well */
    struct error reasons[HEALTH_REASONS_MOST];
};
/* Looks at the file, the room on its disk, the writer, and a reader. Never waits for the writer. */
void service_health(struct service *service, struct health *out);

#endif
