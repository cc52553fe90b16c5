#include "server/http/service.h"
#include "worker/clock.h"
#include "worker/log.h"
#include "worker/publish/publish.h"
#include "worker/quiet_thread.h"
#include <stdlib.h>

/* Between attempts at cases whose publishing failed for a reason that may pass. */
enum { RETRY_FIRST_MS = 60000, RETRY_MOST_MS = 3600000 };
enum { DAMAGED_MOST = 16 }; /* cases at a time; others are found again when they are read again */

struct publisher {
    struct store *store; /* its own handle */
    pthread_t thread;
    pthread_mutex_t mutex; /* guards all below */
    pthread_cond_t woken;
    bool work, stopping;
    struct due_case damaged[DAMAGED_MOST]; /* to be published anew */
    size_t damaged_count;
};

static bool is_stopping(void *context) {
    struct publisher *publisher = context;
    pthread_mutex_lock(&publisher->mutex);
    bool stopping = publisher->stopping;
    pthread_mutex_unlock(&publisher->mutex);
    return stopping;
}

/* Publishes all that is due; returns true when cases stay due that are to be tried again. */
static bool publish_all(struct publisher *publisher) {
    struct error err = {0};
    struct publish_counts counts = {0};
    int status = publish_due(publisher->store, is_stopping, publisher, &counts, &err);
    if (status != 0 && status != ERROR_STOPPED)
        log_line(LEVEL_ERROR, NULL, "publishing: %s", err.text);
    return status != 0 || counts.postponed > 0;
}

/* Takes one case that was found damaged back. */
static bool take_damaged(struct publisher *publisher, struct due_case *out) {
    pthread_mutex_lock(&publisher->mutex);
    bool any = publisher->damaged_count > 0;
    if (any)
        *out = publisher->damaged[--publisher->damaged_count];
    pthread_mutex_unlock(&publisher->mutex);
    return any;
}

/* Makes cases that were found damaged due again. */
static void unpublish_damaged(struct publisher *publisher) {
    struct due_case damaged;
    while (take_damaged(publisher, &damaged)) {
        struct log_about about = {.study = damaged.study};
        struct error err = {0};
        log_line(LEVEL_WARNING, &about,
                 "what is published of case %llu is damaged, and is made anew",
                 (unsigned long long)damaged.case_number);
        if (store_unpublish(publisher->store, &damaged, &err) != 0)
            log_line(LEVEL_ERROR, &about, "publishing anew: %s", err.text);
    }
}

static bool has_work(void *context) {
    struct publisher *publisher = context;
    pthread_mutex_lock(&publisher->mutex);
    bool work = publisher->work || publisher->stopping;
    pthread_mutex_unlock(&publisher->mutex);
    return work;
}

/* Takes deleted studies out of the file, until there is something to publish; returns true where
 * that failed, and is to be tried again. */
static bool purge(struct publisher *publisher) {
    struct error err = {0};
    int status = store_purge(publisher->store, has_work, publisher, &err);
    if (status != 0 && status != ERROR_STOPPED)
        log_line(LEVEL_ERROR, NULL, "deleting: %s", err.text);
    return status != 0 && status != ERROR_STOPPED;
}

/* Sleeps until there is work; with cases left, at most until the time to try them again. */
static void wait_for_work(struct publisher *publisher, int64_t retry_ms) {
    pthread_mutex_lock(&publisher->mutex);
    while (!publisher->work && !publisher->stopping && clock_ms() < retry_ms)
        if (retry_ms == INT64_MAX)
            pthread_cond_wait(&publisher->woken, &publisher->mutex);
        else
            clock_cond_wait(&publisher->woken, &publisher->mutex, retry_ms);
    publisher->work = false;
    pthread_mutex_unlock(&publisher->mutex);
}

static void *publisher_thread(void *context) {
    struct publisher *publisher = context;
    int64_t pause_ms = RETRY_FIRST_MS;
    while (!is_stopping(publisher)) {
        unpublish_damaged(publisher);
        bool left = publish_all(publisher);
        left = purge(publisher) || left;
        wait_for_work(publisher, left ? clock_ms() + pause_ms : INT64_MAX);
        pause_ms = !left                          ? RETRY_FIRST_MS
                   : pause_ms < RETRY_MOST_MS / 2 ? 2 * pause_ms
                                                  : RETRY_MOST_MS;
    }
    return NULL;
}

int publisher_create(struct publisher **out, const char *database, struct error *err) {
    struct publisher *publisher = array_create(1, sizeof *publisher);
    if (publisher == NULL)
        return error_memory(err, sizeof *publisher, "the publisher");
    pthread_mutex_init(&publisher->mutex, NULL);
    if (clock_cond_init(&publisher->woken) != 0) {
        free(publisher);
        return error_set(err, ERROR_SYSTEM, "cannot make a condition");
    }
    int status = store_open(&publisher->store, database, NULL, err);
    if (status == 0 && quiet_thread_start(&publisher->thread, publisher_thread, publisher) != 0)
        status = error_set(err, ERROR_SYSTEM, "cannot start the publisher's thread");
    if (status != 0) {
        store_close(&publisher->store);
        free(publisher);
        return status;
    }
    *out = publisher;
    return 0;
}

void publisher_wake(struct publisher *publisher) {
    pthread_mutex_lock(&publisher->mutex);
    publisher->work = true;
    pthread_cond_signal(&publisher->woken);
    pthread_mutex_unlock(&publisher->mutex);
}

void publisher_mend(struct publisher *publisher, const struct due_case *damaged) {
    pthread_mutex_lock(&publisher->mutex);
    if (publisher->damaged_count < DAMAGED_MOST)
        publisher->damaged[publisher->damaged_count++] = *damaged;
    publisher->work = true;
    pthread_cond_signal(&publisher->woken);
    pthread_mutex_unlock(&publisher->mutex);
}

void publisher_destroy(struct publisher **publisher) {
    struct publisher *p = *publisher;
    if (p == NULL)
        return;
    pthread_mutex_lock(&p->mutex);
    p->stopping = true;
    pthread_cond_signal(&p->woken);
    pthread_mutex_unlock(&p->mutex);
    pthread_join(p->thread, NULL);
    store_close(&p->store);
    pthread_mutex_destroy(&p->mutex);
    pthread_cond_destroy(&p->woken);
    free(p);
    *publisher = NULL;
}
