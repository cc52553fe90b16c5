/* What the routes of the HTTP service share: the store's one writer and its readers, the publisher,
 * tokens and counters. Safe from many threads. */
#ifndef RUGO_SERVER_HTTP_SERVICE_H
#define RUGO_SERVER_HTTP_SERVICE_H

#include "server/http/guard/tokens.h"
#include "server/http/writer.h"
#include <pthread.h>
#include <stdatomic.h>
#include <sys/types.h>

enum { READERS_KEPT = 16, STATUS_CLASSES = 6 };

struct service {
    const char *database; /* borrowed */
    struct store *store;  /* the writer's */
    struct writer *writer;
    struct publisher *publisher;
    struct checker *checker;   /* of results that come in */
    struct waiting_room *room; /* of claims that wait for jobs */
    struct tokens *tokens;     /* NULL: everyone may do everything (loopback only) */
    int64_t started_ms;        /* clock_ms */
    int64_t lease_ms;          /* of a silent worker */
    size_t map_bytes;          /* of the largest file of a map that is taken; 0: none is */
    atomic_bool stopping;
    bool convert; /* whether Gwyddion converts files of peers */

    pthread_mutex_t mutex; /* guards the readers kept */
    struct store *readers[READERS_KEPT];
    size_t reader_count;

    /* for /metrics */
    atomic_uint_fast64_t answers[STATUS_CLASSES]; /* by hundreds of the status */
    atomic_uint_fast64_t nanoseconds;             /* spent on answers */
    atomic_int_fast64_t connections, streams;     /* open now */
    atomic_uint_fast64_t crowded_out;             /* connections, for want of room */
    atomic_int_fast64_t snapshots;                /* being sent */
    atomic_int_fast64_t maps;                     /* being computed */
    atomic_int_fast64_t files;                    /* of peers, being sent or looked at */
};

int service_open(struct service *service, const char *database, int64_t lease_ms,
                 struct error *err);
void service_close(struct service *service);

/* Lends a read-only handle to one thread at a time, which gives it back, unless the store is not
 * the one that was opened (store_check_names). stop, which may be NULL,
 * is asked while it reads (store_set_stop). */
int service_reader(struct service *service, struct store **out, struct error *err);
int service_reader_until(struct service *service, int (*stop)(void *context), void *context,
                         struct store **out, struct error *err);
void service_give_back(struct service *service, struct store *reader);

/* Writes where copies of the store are made for those who asked for one. */
enum { SNAPSHOT_PATH_SIZE = 4096 };
int service_snapshot_path(const struct service *service, char path[SNAPSHOT_PATH_SIZE],
                          struct error *err);

/* Makes the Prometheus text; the caller frees it. */
int service_metrics(struct service *service, char **out, struct error *err);

/* The publisher merges and publishes, on a thread of its own, every case that is due, and takes
 * deleted studies out of the file when none is; the store itself says which. It begins with what an
 * earlier process left, and sleeps until it is woken. */
int publisher_create(struct publisher **out, const char *database, struct error *err);
void publisher_destroy(struct publisher **publisher);
void publisher_wake(struct publisher *publisher);
/* Has a published case that was found damaged published anew. */
void publisher_mend(struct publisher *publisher, const struct due_case *damaged);

#endif
