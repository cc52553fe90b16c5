/* What pictures and tables over HTTP are made of: a study of the service's store. */
#ifndef RUGO_SERVER_HTTP_ORIGIN_H
#define RUGO_SERVER_HTTP_ORIGIN_H

#include "server/http/http.h"
#include "server/show/picture_source.h"

struct origin {
    struct exchange *exchange; /* which asks */
    const char *id;
};
/* Borrows the origin. A reader of the store is lent for each question, until
 * the exchange is lost. */
struct picture_source origin_source(const struct origin *origin);

#endif
