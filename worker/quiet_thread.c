#include "worker/quiet_thread.h"

int quiet_thread_start(pthread_t *thread, void *(*run)(void *), void *context) {
    sigset_t before;
    quiet_threads_begin(&before);
    int failure = pthread_create(thread, NULL, run, context);
    quiet_threads_end(&before);
    return failure;
}

void quiet_threads_begin(sigset_t *before) {
    sigset_t ends;
    sigemptyset(&ends);
    sigaddset(&ends, SIGTERM);
    sigaddset(&ends, SIGINT);
    sigaddset(&ends, SIGHUP);
    pthread_sigmask(SIG_BLOCK, &ends, before);
}

void quiet_threads_end(const sigset_t *before) {
    pthread_sigmask(SIG_SETMASK, before, NULL);
}
