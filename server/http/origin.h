/* What pictures and tables over HTTP are made of: a study of the service's store. */
#ifndef RUGO_SERVER_HTTP_ORIGIN_H
#define RUGO_SERVER_HTTP_ORIGIN_H

#include "server/http/service.h"
#include "server/show/picture_source.h"

struct origin {
    struct service *service;
    const char *id;
};
/* Borrows the origin. A reader of the store is lent for each question. */
struct picture_source origin_source(const struct origin *origin);

#endif
