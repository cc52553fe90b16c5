/* A study behind an access, as pictures and tables ask for it. */
#ifndef RUGO_SERVER_COMMAND_ACCESS_ACCESS_SOURCE_H
#define RUGO_SERVER_COMMAND_ACCESS_ACCESS_SOURCE_H

#include "server/command/access/access.h"
#include "server/show/plot/picture_source.h"

struct access_origin {
    struct access *access;
    const char *id;
};
/* The source borrows the origin. */
struct picture_source access_source(const struct access_origin *origin);

#endif
