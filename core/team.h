/* Threads that share one task, part by part. What a part computes must not depend on who computes
 * it, nor on the order, so that results have the same digits with any number of threads: sums are
 * kept by part, and added in the order of parts.
 *
 * A team belongs to one thread, which works along. It holds no memory but its threads' stacks. */
#ifndef RUGO_CORE_TEAM_H
#define RUGO_CORE_TEAM_H

#include "core/error.h"

struct team;

/* Computes one part of a task; `thread`, below team_threads, names whose scratch it may use. */
typedef void team_work(void *context, size_t part, size_t thread);

/* Starts threads - 1 threads, which take no signals; 1023 at most; where the system gives fewer,
 * the team is smaller. *out is NULL, which is a team of one, for threads of 0 or 1. ERROR_MEMORY.
 */
int team_create(struct team **out, size_t threads, struct error *err);
/* Ends the threads. */
void team_destroy(struct team **team);
/* Returns the number of threads, the owner among them. */
size_t team_threads(const struct team *team);
/* Returns the processor time that its threads have taken so far without the owner's, in seconds. */
double team_cpu_seconds(const struct team *team);
/* Calls work for each part below `parts` once, and returns when all have ended. A team of one works
 * in order. */
void team_share(struct team *team, size_t parts, team_work *work, void *context);

/* Returns the number of parts of `size` items, above 0, that hold so many; the last one may hold
 * fewer. */
size_t team_parts(size_t count, size_t size);
/* Computes items first .. end - 1 of a task; thread as of team_work. */
typedef void team_range_work(void *context, size_t first, size_t end, size_t thread);
/* Calls work for each of those parts once, as team_share does. Part number first/size does not
 * depend on the team. */
void team_share_ranges(struct team *team, size_t count, size_t size, team_range_work *work,
                       void *context);

#endif
