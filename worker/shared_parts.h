/* What the runners of a case share (job_kind.shared_create), made once for each case and process.
 * Threads that work on a case hold it: the first one makes it, the last one destroys it.
 *
 * take -> (one thread makes it, others wait) -> held by n threads -> let go n times ->
 * destroyed. */
#ifndef RUGO_WORKER_SHARED_PARTS_H
#define RUGO_WORKER_SHARED_PARTS_H

#include "jobs/runner.h"
#include "schema/store/store.h"
#include <pthread.h>

struct shared_part; /* one for each case in use */
struct shared_parts {
    pthread_mutex_t lock;
    pthread_cond_t made; /* signalled when a part is made or could not be made */
    struct shared_part *first;
};
int shared_parts_init(struct shared_parts *parts, struct error *err);
/* The caller must have let go of all parts. */
void shared_parts_destroy(struct shared_parts *parts);

/* Puts what the case shares into *out, or NULL for a kind that shares nothing. Waits while another
 * thread makes it; if that thread fails, this one tries. */
int shared_parts_take(struct shared_parts *parts, const struct job_kind *kind, const char *study,
                      uint64_t case_number, const cJSON *parameters, struct shared_part **out,
                      struct error *err);
/* Accepts NULL, and nulls the handle. */
void shared_parts_let_go(struct shared_parts *parts, struct shared_part **handle);
/* Returns NULL for NULL. */
const struct job_shared *shared_part_content(const struct shared_part *part);

#endif
