/* Answers of the service, read as they come and judged. */
#ifndef RUGO_TESTS_SUPPORT_FUZZ_ANSWER_H
#define RUGO_TESTS_SUPPORT_FUZZ_ANSWER_H

#include "tests/support/fuzz/draw_request.h"

struct answer {
    long status;
    char *head, *body; /* owned, NUL-terminated; the body as it was before gzip and chunks */
    size_t size;       /* of the body */
    char type[SERVED_TEXT_SIZE], etag[SERVED_TEXT_SIZE]; /* "" without */
};

/* Sends the request on a connection of its own, and reads to its end: one whole answer, and nothing
 * behind it. Of a stream of events the first is enough. Ends the process where it is otherwise. */
void answer_of(struct answer *out, uint16_t port, const struct drawn_request *request);
/* Ends the process, with the request and its answer, unless the answer is what any request gets.
 * That is a status that is no failure of the server's, and a document that can be read. A problem
 * must say what is wrong, and of content that is not valid, where. */
void answer_judge(const struct answer *answer, const struct drawn_request *request);
void answer_clear(struct answer *answer);

#endif
