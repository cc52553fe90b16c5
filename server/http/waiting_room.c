#include "server/http/waiting_room.h"
#include "schema/store/store.h"
#include "worker/clock.h"
#include "worker/quiet_thread.h"
#include <poll.h>
#include <pthread.h>
#include <stdlib.h>

enum {
    TICK_MS = 1000,
    WOKEN_AT_A_TIME = 16, /* their claims are one commit */
};

/* One that waits lives on its own stack. */
struct waiter {
    int socket;
    uint64_t seen; /* the call that it was last woken for */
    bool woken, gone;
    pthread_cond_t changed;
    struct waiter *next, **link;
};

struct waiting_room {
    struct store *store; /* the thread's own handle */
    pthread_t thread;
    pthread_mutex_t mutex; /* guards all below */
    pthread_cond_t news;   /* for the thread */
    struct waiter *first, **last;
    size_t count;
    uint64_t calls; /* rises whenever jobs may have appeared */
    bool changed;   /* the store, since the thread asked it */
    bool passed;    /* somebody found nothing: the next ones may */
    bool ending;
};

static void call(struct waiter *waiter, uint64_t number) {
    waiter->seen = number;
    waiter->woken = true;
    pthread_cond_signal(&waiter->changed);
}

/* Wakes those who came first and were not woken for this call. The caller holds the mutex. */
static void call_next(struct waiting_room *room) {
    size_t left = WOKEN_AT_A_TIME;
    for (struct waiter *one = room->first; one != NULL && left > 0; one = one->next) {
        if (one->woken || one->seen == room->calls)
            continue;
        call(one, room->calls);
        left--;
    }
}

/* Lets those go whose peers have gone. The caller holds the mutex. */
static void look_for_gone(struct waiting_room *room) {
    for (struct waiter *one = room->first; one != NULL; one = one->next) {
        struct pollfd peer = {.fd = one->socket, .events = POLLRDHUP};
        if (poll(&peer, 1, 0) > 0) {
            one->gone = true;
            pthread_cond_signal(&one->changed);
        }
    }
}

static bool jobs_wait(struct waiting_room *room) {
    bool wait = false;
    return store_jobs_wait(room->store, &wait, NULL) == 0 && wait;
}

static void *waiting_room_thread(void *context) {
    struct waiting_room *room = context;
    int64_t tick_ms = clock_ms() + TICK_MS;
    pthread_mutex_lock(&room->mutex);
    while (!room->ending) {
        bool tick = clock_ms() >= tick_ms, asked = room->changed || tick;
        if (room->count == 0 || !(asked || room->passed)) {
            room->changed = room->changed && room->count > 0;
            tick_ms = tick ? clock_ms() + TICK_MS : tick_ms;
            clock_cond_wait(&room->news, &room->mutex, tick_ms);
            continue;
        }
        room->changed = room->passed = false;
        if (tick) {
            look_for_gone(room);
            tick_ms = clock_ms() + TICK_MS;
        }
        pthread_mutex_unlock(&room->mutex);
        bool wait = jobs_wait(room);
        pthread_mutex_lock(&room->mutex);
        room->calls += asked && wait;
        if (wait)
            call_next(room);
    }
    for (struct waiter *one = room->first; one != NULL; one = one->next)
        pthread_cond_signal(&one->changed);
    pthread_mutex_unlock(&room->mutex);
    return NULL;
}

int waiting_room_create(struct waiting_room **out, const char *database, struct error *err) {
    struct waiting_room *room = array_create(1, sizeof *room);
    if (room == NULL)
        return error_memory(err, sizeof *room, "a waiting room");
    room->last = &room->first;
    pthread_mutex_init(&room->mutex, NULL);
    if (clock_cond_init(&room->news) != 0) {
        free(room);
        return error_set(err, ERROR_SYSTEM, "cannot make a condition");
    }
    const struct store_options options = {.read_only = true};
    int status = store_open(&room->store, database, &options, err);
    if (status == 0 && quiet_thread_start(&room->thread, waiting_room_thread, room) != 0)
        status = error_set(err, ERROR_SYSTEM, "cannot start the waiting room's thread");
    if (status != 0) {
        store_close(&room->store);
        free(room);
        return status;
    }
    *out = room;
    return 0;
}

void waiting_room_end(struct waiting_room *room) {
    pthread_mutex_lock(&room->mutex);
    room->ending = true;
    pthread_cond_signal(&room->news);
    pthread_mutex_unlock(&room->mutex);
}

void waiting_room_destroy(struct waiting_room **room) {
    struct waiting_room *gone = *room;
    if (gone == NULL)
        return;
    waiting_room_end(gone);
    pthread_join(gone->thread, NULL);
    store_close(&gone->store);
    pthread_cond_destroy(&gone->news);
    pthread_mutex_destroy(&gone->mutex);
    free(gone);
    *room = NULL;
}

void waiting_room_wake(struct waiting_room *room) {
    pthread_mutex_lock(&room->mutex);
    room->changed = true;
    if (room->count > 0)
        pthread_cond_signal(&room->news);
    pthread_mutex_unlock(&room->mutex);
}

static void enter(struct waiting_room *room, struct waiter *waiter) {
    waiter->link = room->last;
    *room->last = waiter;
    room->last = &waiter->next;
    room->count++;
}

static void leave(struct waiting_room *room, struct waiter *waiter) {
    *waiter->link = waiter->next;
    if (waiter->next != NULL)
        waiter->next->link = waiter->link;
    else
        room->last = waiter->link;
    room->count--;
}

bool waiting_room_wait(struct waiting_room *room, int socket, int64_t until_ms, uint64_t *seen) {
    struct waiter waiter = {.socket = socket, .seen = *seen};
    if (clock_cond_init(&waiter.changed) != 0)
        return false;
    pthread_mutex_lock(&room->mutex);
    enter(room, &waiter);
    room->passed |= *seen != 0;  /* it was woken in vain */
    room->changed |= *seen == 0; /* what came before it was here, none was there to hear */
    pthread_cond_signal(&room->news);
    while (!waiter.woken && !waiter.gone && !room->ending && clock_ms() < until_ms)
        clock_cond_wait(&waiter.changed, &room->mutex, until_ms);
    leave(room, &waiter);
    bool woken = waiter.woken && !room->ending;
    *seen = waiter.seen;
    pthread_mutex_unlock(&room->mutex);
    pthread_cond_destroy(&waiter.changed);
    return woken;
}
