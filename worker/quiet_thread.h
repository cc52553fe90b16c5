/* Threads that leave the signals that end a program to its main thread, whose wait they cut short.
 * A signal is else handled by any thread of the process. */
#ifndef RUGO_WORKER_QUIET_THREAD_H
#define RUGO_WORKER_QUIET_THREAD_H

#include <pthread.h>
#include <signal.h>

/* Starts a thread with SIGTERM, SIGINT and SIGHUP blocked; returns what pthread_create returns. */
int quiet_thread_start(pthread_t *thread, void *(*run)(void *), void *context);
/* Threads that a library starts in between are quiet, too: blocks these signals for the calling
 * thread and fills in its mask of before, and sets that again. */
void quiet_threads_begin(sigset_t *before);
void quiet_threads_end(const sigset_t *before);

#endif
