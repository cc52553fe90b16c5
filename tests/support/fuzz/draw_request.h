/* Requests to the service, drawn from its table of routes: a new route, or a new name in a query,
 * is drawn by itself. They are well-formed HTTP; what they ask for may be anything. */
#ifndef RUGO_TESTS_SUPPORT_FUZZ_DRAW_REQUEST_H
#define RUGO_TESTS_SUPPORT_FUZZ_DRAW_REQUEST_H

#include "server/http/route/route.h"
#include "tests/support/fuzz/served.h"

struct drawn_request {
    const struct route *route; /* whose path it has */
    char *bytes;               /* owned */
    size_t size;
    bool head;   /* its answer has no body */
    int64_t job; /* of its path; 0: none */
};
/* No request waits for jobs or asks for a map of a study that is not of the first ones. */
void draw_request(struct choices *choices, struct served *served, struct drawn_request *out);
void drawn_request_clear(struct drawn_request *request);

#endif
