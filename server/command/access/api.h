/* What can be asked of a store, as the JSON documents of openapi.yaml: the one meaning behind the
 * HTTP routes and the commands on a local file. All documents are the caller's to delete. */
#ifndef RUGO_SERVER_COMMAND_ACCESS_API_H
#define RUGO_SERVER_COMMAND_ACCESS_API_H

#include "schema/store/store.h"

/* Queues a study: {id, name, state, cases, jobs, realisations_done}. ERROR_STATE: key used for
 * another study. */
int api_submit(struct store *store, const struct study *study, const char *key, cJSON **out,
               bool *existing, struct error *err);
int api_status(struct store *store, const char *id, cJSON **out, struct error *err);
int api_list(struct store *store, const char *after, size_t limit, cJSON **out, struct error *err);
int api_cancel(struct store *store, const char *id, cJSON **out, struct error *err);
/* {id, name, state: "deleted"}; its rows are left to store_purge. */
int api_delete(struct store *store, const char *id, cJSON **out, struct error *err);
/* Progress with the number of jobs retried. What is due then is left to a publisher. */
int api_retry(struct store *store, const char *id, cJSON **out, struct error *err);
/* Publishes it, too. */
int api_retry_publish(struct store *store, const char *id, cJSON **out, struct error *err);
/* Progress with the number of jobs queued; see store_extend. */
int api_extend(struct store *store, const char *id, uint64_t realisations, cJSON **out,
               struct error *err);
/* {workers: [{name, host, jobs, jobs_last_hour, last_seen}], waiting}: who works on what. */
int api_workers(struct store *store, cJSON **out, struct error *err);

#endif
