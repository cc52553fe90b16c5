/* What the runners of a case share (job_kind.shared_create), made once a case and process: the
 * threads that work on a case hold it, the first one makes it, the last one destroys it.
 *
 * take -> (making, others wait) -> held by n threads -> let go n times -> destroyed. */
#ifndef RUGO_WORKER_SHARED_PARTS_H
#define RUGO_WORKER_SHARED_PARTS_H

#include "jobs/kind.h"
#include "schema/store/store.h"
#include <pthread.h>

struct shared_part; /* one a case in use */
struct shared_parts {
    pthread_mutex_t lock;
    pthread_cond_t made; /* a part was made, or could not be */
    struct shared_part *first;
};
int shared_parts_init(struct shared_parts *parts, struct error *err);
/* All parts must have been let go. */
void shared_parts_destroy(struct shared_parts *parts);

/* The part of a case into *out; NULL, and nothing to let go, for a kind that shares nothing. Waits
 * while another thread makes it; where that one failed, tries itself. */
int shared_parts_take(struct shared_parts *parts, const struct job_kind *kind, const char *study,
                      uint64_t case_number, const cJSON *parameters, struct shared_part **out,
                      struct error *err);
/* Accepts NULL, and nulls the handle. */
void shared_parts_let_go(struct shared_parts *parts, struct shared_part **handle);
/* NULL for NULL. */
const struct job_shared *shared_part_content(const struct shared_part *part);

#endif
