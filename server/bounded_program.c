#include "server/bounded_program.h"
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* Three processes: this one waits for a keeper, which waits for the program. The keeper is made by
 * fork() alone, so that it does nothing but system calls. It is sent SIGTERM when this process
 * dies, by a signal too, and then kills the group of the program. */

struct ending {
    enum bounded_end end;
    int code;
};

/* --- the program's process, until it is the program --- */

static int limit(__rlimit_resource_t resource, uint64_t most) {
    struct rlimit now;
    if (getrlimit(resource, &now) != 0)
        return errno;
    if (now.rlim_max == RLIM_INFINITY || now.rlim_max > most)
        now.rlim_max = most;
    now.rlim_cur = now.rlim_max;
    return setrlimit(resource, &now) == 0 ? 0 : errno;
}

static int set_limits(const struct bounded_program *program) {
    int failure = limit(RLIMIT_CORE, 0);
    if (failure == 0)
        failure = limit(RLIMIT_FSIZE, program->file_bytes);
    if (failure == 0)
        failure = limit(RLIMIT_CPU, program->seconds);
    return failure == 0 ? limit(RLIMIT_AS, program->memory_bytes) : failure;
}

static int set_files(const struct bounded_program *program) {
    if (chdir(program->folder) != 0)
        return errno;
    int input = open("/dev/null", O_RDONLY | O_CLOEXEC);
    int output = open(program->output, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    if (input < 0 || output < 0 || dup2(input, 0) < 0 || dup2(output, 1) < 0 || dup2(output, 2) < 0)
        return errno;
    return 0;
}

/* failed: where a number of errno goes if it does not become the program. */
static _Noreturn void become(const struct bounded_program *program, int failed) {
    sigset_t none;
    sigemptyset(&none);
    (void)setpgid(0, 0);
    (void)signal(SIGPIPE, SIG_DFL);
    (void)signal(SIGXFSZ, SIG_DFL);
    (void)sigprocmask(SIG_SETMASK, &none, NULL);
    int failure = set_files(program);
    if (failure == 0)
        failure = set_limits(program);
    if (failure == 0) {
        (void)execvpe(program->arguments[0], (char *const *)program->arguments,
                      (char *const *)program->environment);
        failure = errno;
    }
    (void)!write(failed, &failure, sizeof failure);
    _exit(127);
}

/* --- the keeper --- */

static int64_t now_ms(void) {
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000;
}

/* Waits until the child has ended, which is then still to be reaped so that its number stays that
 * of its group, or time is up, or the caller has died. Returns SIGCHLD, SIGALRM or SIGTERM. */
static int await(pid_t child, unsigned seconds, const sigset_t *signals) {
    const int64_t until = now_ms() + 1000 * (int64_t)seconds;
    for (;;) {
        siginfo_t ended = {.si_pid = 0};
        if (waitid(P_PID, (id_t)child, &ended, WEXITED | WNOHANG | WNOWAIT) == 0 &&
            ended.si_pid == child)
            return SIGCHLD;
        int64_t left = until - now_ms();
        if (left <= 0)
            return SIGALRM;
        const struct timespec rest = {left / 1000, left % 1000 * 1000000};
        if (sigtimedwait(signals, NULL, &rest) == SIGTERM)
            return SIGTERM;
    }
}

static struct ending ending_of(int state) {
    if (WIFEXITED(state))
        return (struct ending){BOUNDED_EXITED, WEXITSTATUS(state)};
    return (struct ending){BOUNDED_KILLED, WIFSIGNALED(state) ? WTERMSIG(state) : 0};
}

/* Takes the number of errno of a program that was not started; 0 once it was. */
static int started(int file) {
    int failure = 0;
    ssize_t count;
    do
        count = read(file, &failure, sizeof failure);
    while (count < 0 && errno == EINTR);
    return count == (ssize_t)sizeof failure ? failure : 0;
}

static _Noreturn void keep(const struct bounded_program *program, pid_t caller, int answer) {
    struct ending ending = {BOUNDED_LATE, 0};
    sigset_t signals;
    int failed[2], state = 0;
    sigemptyset(&signals);
    sigaddset(&signals, SIGCHLD);
    sigaddset(&signals, SIGTERM);
    if (setpgid(0, 0) != 0 || prctl(PR_SET_PDEATHSIG, SIGTERM) != 0 || getppid() != caller ||
        pipe2(failed, O_CLOEXEC) != 0)
        _exit(1);
    pid_t child = fork();
    if (child < 0)
        _exit(1);
    if (child == 0)
        become(program, failed[1]);
    (void)setpgid(child, child); /* whichever of both is first */
    (void)close(failed[1]);
    const int failure = started(failed[0]);
    const int why = await(child, program->seconds, &signals);
    (void)kill(-child, SIGKILL);
    while (waitpid(child, &state, 0) < 0 && errno == EINTR)
        ;
    if (why == SIGTERM)
        program->abandon(program->folder);
    else if (why == SIGCHLD)
        ending = ending_of(state);
    if (failure != 0)
        ending = (struct ending){BOUNDED_ABSENT, failure};
    (void)!write(answer, &ending, sizeof ending);
    _exit(0);
}

/* --- this process --- */

/* Starts the keeper with all signals blocked, so that none is lost or handled in it. */
static pid_t start(const struct bounded_program *program, const int answer[2]) {
    const pid_t caller = getpid();
    sigset_t all, before;
    sigfillset(&all);
    (void)pthread_sigmask(SIG_SETMASK, &all, &before);
    pid_t keeper = fork();
    if (keeper == 0)
        keep(program, caller, answer[1]);
    int failure = errno;
    (void)pthread_sigmask(SIG_SETMASK, &before, NULL);
    errno = failure;
    return keeper;
}

int bounded_program_run(const struct bounded_program *program, enum bounded_end *end, int *code,
                        struct error *err) {
    struct ending ending;
    int answer[2];
    if (pipe2(answer, O_CLOEXEC) != 0)
        return error_set(err, ERROR_SYSTEM, "cannot start %s: %s", program->arguments[0],
                         strerror(errno));
    pid_t keeper = start(program, answer);
    int failure = keeper < 0 ? errno : 0;
    (void)close(answer[1]);
    ssize_t count = -1;
    while (failure == 0 && (count = read(answer[0], &ending, sizeof ending)) < 0 && errno == EINTR)
        ;
    (void)close(answer[0]);
    while (failure == 0 && waitpid(keeper, NULL, 0) < 0 && errno == EINTR)
        ;
    if (count != (ssize_t)sizeof ending)
        return error_set(err, ERROR_SYSTEM, "cannot start %s: %s", program->arguments[0],
                         failure != 0 ? strerror(failure) : "its keeper has ended");
    *end = ending.end;
    *code = ending.code;
    return 0;
}
