/* What dispatcher.c, which the worker threads call, dispatcher_thread.c and dispatcher_report.c,
 * which are the dispatcher's own thread, share. */
#ifndef RUGO_WORKER_DISPATCHER_INTERNAL_H
#define RUGO_WORKER_DISPATCHER_INTERNAL_H

#include "worker/backoff.h"
#include "worker/clock.h"
#include "worker/dispatcher_options.h"
#include "worker/report.h"
#include "worker/source.h"
#include <stdatomic.h>

enum lease_state {
    LEASE_STOCK,   /* claimed, not begun */
    LEASE_RUNNING, /* a thread has it */
    LEASE_ENDED,   /* to be reported */
    LEASE_GONE,    /* to be freed by the dispatcher's thread */
};
/* The dispatcher's lock protects all fields but the atomic ones. */
struct lease {
    struct claimed_job job; /* owned */
    enum lease_state state;
    int64_t due_ms;   /* time of the next heartbeat, while in stock or running; NEVER: of none */
    bool give_back;   /* of a running one: it is released while it runs */
    int64_t begun_ms; /* when a thread took it */
    int64_t ended_ms;
    struct job_end end; /* of an ended one; owned */
    size_t bytes;       /* of its result, as sent */
    atomic_bool lost;
    atomic_uint_fast64_t done;
    struct lease *next;
};

struct dispatcher {
    struct dispatcher_options options;
    struct source *source; /* the thread's own */
    int64_t report_ms;     /* most time between two heartbeats of a running job */
    pthread_t thread;
    pthread_mutex_t lock;  /* guards all below */
    pthread_cond_t news;   /* for the dispatcher's thread */
    pthread_cond_t offers; /* for the worker threads */
    struct lease *leases;  /* owned, in the order of claims */
    size_t stock, ended;   /* how many are in these states */
    size_t ended_bytes;    /* of their results */
    double job_seconds;    /* by the clock, of a job, as measured of late; 0: not known */
    unsigned waiting;      /* threads that wait for an offer */
    uint64_t vain;         /* claims so far that found nothing */
    bool idle;             /* the last claim found nothing */
    bool due, publishing;  /* cases are to be published; a thread is at it */
    bool postponed;        /* the last time, some could not be and stayed due */
    bool drained, closing;
    atomic_bool ending;   /* read without the lock by claims that wait */
    struct backoff pause; /* between claims that find nothing */
    int64_t claim_ms;     /* not before */
    struct backoff away;  /* between requests without an answer */
    int64_t away_ms;      /* no claim and no result before */
    int status;           /* of the first error that waiting cannot cure */
    struct error err;
};

static const int64_t NEVER = INT64_MAX;

/* The thread's body. */
void *dispatcher_thread_main(void *context);

/* These are called by the dispatcher's thread, which holds the lock; it is released meanwhile. */
/* Returns when the next report is due; NEVER where there is none. */
int64_t dispatcher_report_ms(const struct dispatcher *dispatcher, int64_t now_ms);
void dispatcher_report(struct dispatcher *dispatcher);
/* Notes that there was no answer, or that there was one. */
void dispatcher_note_away(struct dispatcher *dispatcher, const char *what, const struct error *err);
void dispatcher_note_answer(struct dispatcher *dispatcher);

/* Returns the time between two heartbeats. */
int64_t lease_interval_ms(const struct dispatcher *dispatcher, const struct lease *lease);
/* Makes a report of a lease in stock, or running, due: it has ended. The caller holds the lock. */
void lease_end(struct dispatcher *dispatcher, struct lease *lease, enum report_verb verb);

#endif
