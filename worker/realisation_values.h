/* What single realisations have at the points of published curves (the view realisation_points). */
#ifndef RUGO_WORKER_REALISATION_VALUES_H
#define RUGO_WORKER_REALISATION_VALUES_H

#include "schema/store/store.h"

struct job_merger;

/* Returns what store_publish_points asks of a merged case; borrows the merger. */
struct point_texts realisation_values(const struct job_merger *merger);

#endif
