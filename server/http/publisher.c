#include "server/http/service.h"
#include "worker/aggregate.h"
#include "worker/log.h"
#include <stdlib.h>

struct publisher {
    struct store *store; /* its own handle */
    pthread_t thread;
    pthread_mutex_t mutex; /* guards the two below */
    pthread_cond_t woken;
    bool work, stopping;
};

/* Publishes until nothing is due; a case that fails is left for the next time. */
static void publish_due(struct publisher *publisher) {
    char study[STUDY_ID_SIZE];
    uint64_t case_number, skip = 0;
    struct error err = {0};
    int status;
    while ((status = store_unpublished(publisher->store, skip, study, &case_number, &err)) == 0) {
        pthread_mutex_lock(&publisher->mutex);
        bool stopping = publisher->stopping;
        pthread_mutex_unlock(&publisher->mutex);
        if (stopping)
            return;
        if (aggregate_publish(publisher->store, study, case_number, &err)) {
            struct log_about about = {.study = study};
            log_line(LEVEL_ERROR, &about, "case %llu cannot be published: %s",
                     (unsigned long long)case_number, err.text);
            skip++;
        }
    }
    if (status != ERROR_ABSENT)
        log_line(LEVEL_ERROR, NULL, "publishing: %s", err.text);
}

static void *publisher_thread(void *context) {
    struct publisher *publisher = context;
    pthread_mutex_lock(&publisher->mutex);
    while (!publisher->stopping) {
        if (!publisher->work) {
            pthread_cond_wait(&publisher->woken, &publisher->mutex);
            continue;
        }
        publisher->work = false;
        pthread_mutex_unlock(&publisher->mutex);
        publish_due(publisher);
        pthread_mutex_lock(&publisher->mutex);
    }
    pthread_mutex_unlock(&publisher->mutex);
    return NULL;
}

int publisher_create(struct publisher **out, const char *database, struct error *err) {
    struct publisher *publisher = array_create(1, sizeof *publisher);
    if (!publisher)
        return error_memory(err, sizeof *publisher, "the publisher");
    publisher->work = true; /* an earlier server may have died before it published */
    pthread_mutex_init(&publisher->mutex, NULL);
    pthread_cond_init(&publisher->woken, NULL);
    int status = store_open(&publisher->store, database, NULL, err);
    if (!status && pthread_create(&publisher->thread, NULL, publisher_thread, publisher))
        status = error_set(err, ERROR_SYSTEM, "cannot start the publisher's thread");
    if (status) {
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

void publisher_destroy(struct publisher **publisher) {
    struct publisher *p = *publisher;
    if (!p)
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
