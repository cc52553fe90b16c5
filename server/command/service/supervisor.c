#include "server/command/service/supervisor.h"
#include "worker/clock.h"
#include "worker/quiet_thread.h"
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

void supervisor_tell(const char *assignments) {
    const char *path = getenv("NOTIFY_SOCKET");
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    size_t length = path != NULL ? strlen(path) : 0;
    if (length < 2 || length >= sizeof address.sun_path || (*path != '/' && *path != '@'))
        return;
    memcpy(address.sun_path, path, length);
    if (*path == '@')
        address.sun_path[0] = '\0'; /* a name that is no file */
    int file = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (file < 0)
        return;
    (void)sendto(file, assignments, strlen(assignments), MSG_NOSIGNAL | MSG_DONTWAIT,
                 (const struct sockaddr *)&address,
                 (socklen_t)(offsetof(struct sockaddr_un, sun_path) + length));
    close(file);
}

int64_t supervisor_interval_ms(void) {
    const char *microseconds = getenv("WATCHDOG_USEC"), *process = getenv("WATCHDOG_PID");
    if (microseconds == NULL || (process != NULL && strtoll(process, NULL, 10) != getpid()))
        return 0;
    int64_t time = strtoll(microseconds, NULL, 10);
    return time < 2000 ? 0 : time / 2000;
}

static void *watch(void *context) {
    struct watchdog *watchdog = context;
    int64_t interval_ms = supervisor_interval_ms();
    pthread_mutex_lock(&watchdog->lock);
    while (!watchdog->ending) {
        pthread_mutex_unlock(&watchdog->lock);
        watchdog->touch(watchdog->context);
        supervisor_tell("WATCHDOG=1");
        int64_t until = clock_ms() + interval_ms;
        pthread_mutex_lock(&watchdog->lock);
        while (!watchdog->ending && clock_ms() < until)
            clock_cond_wait(&watchdog->changed, &watchdog->lock, until);
    }
    pthread_mutex_unlock(&watchdog->lock);
    return NULL;
}

int watchdog_start(struct watchdog *watchdog, struct error *err) {
    watchdog->ending = false;
    if (supervisor_interval_ms() == 0)
        return 0;
    if (clock_cond_init(&watchdog->changed) != 0)
        return error_set(err, ERROR_SYSTEM, "cannot make a condition");
    pthread_mutex_init(&watchdog->lock, NULL);
    watchdog->started = quiet_thread_start(&watchdog->thread, watch, watchdog) == 0;
    if (watchdog->started)
        return 0;
    pthread_mutex_destroy(&watchdog->lock);
    pthread_cond_destroy(&watchdog->changed);
    return error_set(err, ERROR_SYSTEM, "cannot start the thread of the watchdog");
}

void watchdog_stop(struct watchdog *watchdog) {
    if (!watchdog->started)
        return;
    pthread_mutex_lock(&watchdog->lock);
    watchdog->ending = true;
    pthread_cond_signal(&watchdog->changed);
    pthread_mutex_unlock(&watchdog->lock);
    pthread_join(watchdog->thread, NULL);
    pthread_mutex_destroy(&watchdog->lock);
    pthread_cond_destroy(&watchdog->changed);
    watchdog->started = false;
}
