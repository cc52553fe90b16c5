#include "server/http/writer.h"
#include "worker/clock.h"
#include "worker/quiet_thread.h"
#include <errno.h>
#include <pthread.h>
#include <sched.h>
#include <semaphore.h>
#include <stdlib.h>

/* A posted change lives on its poster's stack. Each has its semaphore: whoever is woken need not
 * queue for the mutex, which the writer holds just then. */
struct post {
    store_change *change;
    void *context;
    struct error error;
    int status;
    sem_t ended;
    struct post *next;
};

struct writer {
    struct store *store; /* borrowed */
    pthread_t thread;
    pthread_mutex_t mutex; /* guards all below */
    pthread_cond_t posted;
    struct post *first, **last;
    bool stopping;
    void (*due)(void *context); /* may be NULL */
    void *due_context;
    void (*changed)(void *context); /* may be NULL */
    void *changed_context;
    int64_t changes; /* of the store, when `changed` was last called */
    struct writer_figures figures;
    int64_t since_ms;     /* when it began what it does; 0: nothing */
    struct error failure; /* of the last commit; code 0: none */
};

enum { BATCH_MOST = 256, PROBE_MS = 2000 };

/* Of the store itself, rather than of what was asked for. */
static void note_failure(struct error *failure, int status, const struct error *error) {
    if (status == ERROR_SYSTEM || status == ERROR_MEMORY || status == ERROR_LIMIT)
        *failure = *error;
}

/* Without changes, sees whether writing works. *failure: why the store took nothing. */
static void run_batch(struct store *store, struct post *const *batch, size_t count,
                      struct error *failure) {
    struct error error = {0};
    int status = store_begin(store, &error);
    if (status == 0 && count == 0)
        status = store_probe(store, &error);
    for (size_t i = 0; status == 0 && i < count; i++) {
        batch[i]->status = batch[i]->change(store, batch[i]->context, &batch[i]->error);
        note_failure(failure, batch[i]->status, &batch[i]->error);
    }
    if (status == 0)
        status = store_commit(store, &error);
    note_failure(failure, status, &error);
    for (size_t i = 0; status != 0 && i < count; i++) {
        batch[i]->status = status;
        batch[i]->error = error;
    }
}

/* Calls back where a case is due. The question reads one row, which is little beside a commit. */
static void report_due(struct writer *writer) {
    bool due = false;
    if (writer->due != NULL && store_is_due(writer->store, &due, NULL) == 0 && due)
        writer->due(writer->due_context);
}

static void report_change(struct writer *writer) {
    int64_t changes = store_changes(writer->store);
    if (writer->changed != NULL && changes != writer->changes)
        writer->changed(writer->changed_context);
    writer->changes = changes;
}

static size_t take_batch(struct writer *writer, struct post **batch) {
    size_t count = 0;
    while (writer->first != NULL && count < BATCH_MOST) {
        batch[count++] = writer->first;
        writer->first = writer->first->next;
    }
    if (writer->first == NULL)
        writer->last = &writer->first;
    return count;
}

/* Returns true, with nothing posted, when it is time to see whether writing works again. */
static bool wait_for_posts(struct writer *writer) {
    int64_t probe_ms = clock_ms() + PROBE_MS;
    while (writer->first == NULL && !writer->stopping) {
        if (writer->failure.code == 0)
            pthread_cond_wait(&writer->posted, &writer->mutex);
        else if (clock_ms() < probe_ms)
            clock_cond_wait(&writer->posted, &writer->mutex, probe_ms);
        else
            return true;
    }
    return false;
}

static void *writer_thread(void *context) {
    struct writer *writer = context;
    struct post *batch[BATCH_MOST];
    pthread_mutex_lock(&writer->mutex);
    for (;;) {
        bool probe = wait_for_posts(writer);
        /* Those who were just answered come back with the next: let them, and commit more at once.
         */
        pthread_mutex_unlock(&writer->mutex);
        sched_yield();
        pthread_mutex_lock(&writer->mutex);
        size_t count = take_batch(writer, batch);
        if (count == 0 && !probe)
            break;
        struct error failure = {0};
        writer->since_ms = clock_ms();
        pthread_mutex_unlock(&writer->mutex);
        run_batch(writer->store, batch, count, &failure);
        report_due(writer);
        report_change(writer);
        pthread_mutex_lock(&writer->mutex);
        writer->since_ms = 0;
        writer->failure = failure;
        writer->figures.changes += count;
        writer->figures.commits += count > 0;
        pthread_mutex_unlock(&writer->mutex);
        for (size_t i = 0; i < count; i++)
            sem_post(&batch[i]->ended);
        pthread_mutex_lock(&writer->mutex);
    }
    pthread_mutex_unlock(&writer->mutex);
    return NULL;
}

int writer_create(struct writer **out, struct store *store, struct error *err) {
    struct writer *writer = array_create(1, sizeof *writer);
    if (writer == NULL)
        return error_memory(err, sizeof *writer, "the writer");
    writer->store = store;
    writer->last = &writer->first;
    pthread_mutex_init(&writer->mutex, NULL);
    if (clock_cond_init(&writer->posted) != 0 ||
        quiet_thread_start(&writer->thread, writer_thread, writer) != 0) {
        free(writer);
        return error_set(err, ERROR_SYSTEM, "cannot start the writer's thread");
    }
    *out = writer;
    return 0;
}

void writer_destroy(struct writer **writer) {
    struct writer *w = *writer;
    if (w == NULL)
        return;
    pthread_mutex_lock(&w->mutex);
    w->stopping = true;
    pthread_cond_signal(&w->posted);
    pthread_mutex_unlock(&w->mutex);
    pthread_join(w->thread, NULL);
    pthread_mutex_destroy(&w->mutex);
    pthread_cond_destroy(&w->posted);
    free(w);
    *writer = NULL;
}

void writer_on_due(struct writer *writer, void (*due)(void *context), void *context) {
    pthread_mutex_lock(&writer->mutex);
    writer->due_context = context;
    writer->due = due;
    pthread_mutex_unlock(&writer->mutex);
}

void writer_on_change(struct writer *writer, void (*changed)(void *context), void *context) {
    pthread_mutex_lock(&writer->mutex);
    writer->changed_context = context;
    writer->changed = changed;
    pthread_mutex_unlock(&writer->mutex);
}

int writer_do(struct writer *writer, store_change *change, void *context, struct error *err) {
    struct post post = {.change = change, .context = context};
    sem_init(&post.ended, 0, 0);
    pthread_mutex_lock(&writer->mutex);
    bool taken = !writer->stopping;
    if (taken) {
        *writer->last = &post;
        writer->last = &post.next;
        pthread_cond_signal(&writer->posted);
    }
    pthread_mutex_unlock(&writer->mutex);
    if (taken)
        while (sem_wait(&post.ended) != 0 && errno == EINTR)
            continue;
    else
        post.status = error_set(&post.error, ERROR_SYSTEM, "the server is ending");
    sem_destroy(&post.ended);
    if (post.status != 0 && err != NULL)
        *err = post.error;
    return post.status;
}

void writer_figures(struct writer *writer, struct writer_figures *out) {
    pthread_mutex_lock(&writer->mutex);
    *out = writer->figures;
    pthread_mutex_unlock(&writer->mutex);
}

void writer_state(struct writer *writer, struct writer_state *out) {
    pthread_mutex_lock(&writer->mutex);
    out->busy_ms = writer->since_ms != 0 ? clock_ms() - writer->since_ms : 0;
    out->failure = writer->failure;
    pthread_mutex_unlock(&writer->mutex);
}
