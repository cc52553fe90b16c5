/* What can be asked of a store, as the JSON documents of interface.md: the one meaning behind the
 * HTTP routes and the commands on a local file. All documents are the caller's to delete. */
#ifndef RUGO_SERVER_API_H
#define RUGO_SERVER_API_H

#include "schema/store.h"

/* Reads, checks and queues a study: {id, name, state, cases, jobs}. ERROR_INPUT with faults filled
 * for an invalid one (nothing queued), without faults for malformed text; ERROR_STATE: key used for
 * another. */
int api_submit(struct store *store, const char *text, size_t size, const char *const *overrides,
               const char *key, cJSON **out, bool *existing, struct fault_list *faults,
               struct error *err);
int api_status(struct store *store, const char *id, cJSON **out, struct error *err);
int api_list(struct store *store, const char *after, size_t limit, cJSON **out, struct error *err);
int api_cancel(struct store *store, const char *id, cJSON **out, struct error *err);
int api_retry(struct store *store, const char *id, cJSON **out, struct error *err);

#endif
