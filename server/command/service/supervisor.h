/* Reports the state of this process to whoever started it, where that is systemd or speaks its
 * protocol (sd_notify(3)): texts such as "READY=1" in datagrams to the socket that NOTIFY_SOCKET
 * names. The protocol is kept stable for programs without libsystemd, of which no static archive
 * exists. */
#ifndef RUGO_SERVER_COMMAND_SERVICE_SUPERVISOR_H
#define RUGO_SERVER_COMMAND_SERVICE_SUPERVISOR_H

#include "core/error.h"
#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>

/* Sends assignments, one a line; does nothing where nobody listens, and never waits. */
void supervisor_tell(const char *assignments);
/* How often "WATCHDOG=1" is due, half the time after which its absence ends this process; 0: nobody
 * watches. */
int64_t supervisor_interval_ms(void);

/* Reports on a thread of its own that the process lives. */
struct watchdog {
    void (*touch)(void *context); /* what must go on: returns when it does, and else never */
    void *context;
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t changed;
    bool started, ending; /* ending under the lock */
};
/* The caller has filled touch and context. Does nothing where nobody watches. */
int watchdog_start(struct watchdog *watchdog, struct error *err);
/* Returns when touch has. */
void watchdog_stop(struct watchdog *watchdog);

#endif
