/* Publishes what is due: cases whose jobs have all ended. */
#ifndef RUGO_WORKER_PUBLISH_PUBLISH_H
#define RUGO_WORKER_PUBLISH_PUBLISH_H

#include "schema/store/store.h"

/* Merges and publishes every case that is due, of all studies, and logs those that cannot be. The
 * store marks these. A fault that may pass, such as a full disk, leaves a case due: counts, which
 * may be NULL, says how many and why. stop (may be NULL) is called between cases; then
 * ERROR_STOPPED. */
int publish_due(struct store *store, bool (*stop)(void *context), void *context,
                struct publish_counts *counts, struct error *err);

#endif
