/* What workers say, drawn: messages that are right, and such as lie. */
#ifndef RUGO_TESTS_SUPPORT_FUZZ_DRAW_MESSAGE_H
#define RUGO_TESTS_SUPPORT_FUZZ_DRAW_MESSAGE_H

#include "tests/support/fuzz/served.h"

struct message_drawing {
    const char *verb; /* the last part of the path of a worker's request, or "claim", or "report" */
    const struct claimed_job *job; /* of the path; NULL: none */
    bool odd;                      /* may lie, and have any value anywhere */
};
/* The caller frees. */
char *draw_message(struct choices *choices, struct served *served,
                   const struct message_drawing *drawing);

#endif
