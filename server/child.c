#include "server/child.h"
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

static int set_files(posix_spawn_file_actions_t *actions, const int files[3]) {
    int failure = 0;
    for (int n = 0; n < 3 && failure == 0; n++)
        failure = files[n] < 0
                      ? posix_spawn_file_actions_addopen(actions, n, "/dev/null", O_RDWR, 0)
                      : posix_spawn_file_actions_adddup2(actions, files[n], n);
#if defined(__GLIBC__) && __GLIBC_PREREQ(2, 34)
    if (failure == 0)
        failure = posix_spawn_file_actions_addclosefrom_np(actions, 3);
#endif
    return failure;
}

/* In a process group of its own; this program ignores two signals (server/command/main.c). */
static int set_attributes(posix_spawnattr_t *attributes) {
    sigset_t blocked, ignored;
    sigemptyset(&blocked);
    sigemptyset(&ignored);
    sigaddset(&ignored, SIGPIPE);
    sigaddset(&ignored, SIGXFSZ);
    int failure = posix_spawnattr_setsigmask(attributes, &blocked);
    if (failure == 0)
        failure = posix_spawnattr_setsigdefault(attributes, &ignored);
    if (failure == 0)
        failure = posix_spawnattr_setpgroup(attributes, 0);
    if (failure == 0)
        failure = posix_spawnattr_setflags(
            attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
    return failure;
}

int child_start(const char *program, const char *const *arguments, const int files[3],
                pid_t *child) {
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    int failure = posix_spawnattr_init(&attributes);
    if (failure != 0)
        return failure;
    failure = posix_spawn_file_actions_init(&actions);
    if (failure == 0) {
        failure = set_attributes(&attributes);
        if (failure == 0)
            failure = set_files(&actions, files);
        if (failure == 0)
            failure = posix_spawnp(child, program, &actions, &attributes, (char *const *)arguments,
                                   environ);
        posix_spawn_file_actions_destroy(&actions);
    }
    posix_spawnattr_destroy(&attributes);
    return failure;
}

int child_wait(pid_t child, int *state) {
    while (waitpid(child, state, 0) < 0)
        if (errno != EINTR)
            return errno;
    return 0;
}
