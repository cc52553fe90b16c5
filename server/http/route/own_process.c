#include "server/http/route/own_process.h"
#include "server/child.h"
#include "worker/clock.h"
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#ifdef RUGO_SANITIZED
enum { SHADOWED = 1 }; /* sanitizers take terabytes of address space */
#else
enum { SHADOWED = 0 };
#endif

enum { ASK_MS = 100, NICENESS = 10, PART = 65536 };

/* The near ends of its three pipes; -1 once closed. */
struct pipes {
    int input, output, said;
};
struct run {
    const struct own_process *process;
    struct own_process_result *result;
    struct pipes near;
    pid_t child;
    size_t sent, room, said;
};

static void close_end(int *file) {
    if (*file >= 0)
        (void)close(*file);
    *file = -1;
}

/* --- start --- */

/* Before it is sent a byte of what it is to read. */
static int set_limits(const struct run *run) {
    const struct own_process *process = run->process;
    const struct rlimit memory = {process->memory_bytes, process->memory_bytes};
    const struct rlimit time = {process->cpu_seconds, process->cpu_seconds + 1};
    const struct rlimit none = {0, 0};
    (void)setpriority(PRIO_PROCESS, (id_t)run->child, NICENESS);
    bool done = prlimit(run->child, RLIMIT_CPU, &time, NULL) == 0 &&
                prlimit(run->child, RLIMIT_CORE, &none, NULL) == 0 &&
                (SHADOWED || prlimit(run->child, RLIMIT_AS, &memory, NULL) == 0);
    return done ? 0 : errno;
}

static int make_pipes(struct run *run, int far[3]) {
    int *near[3] = {&run->near.input, &run->near.output, &run->near.said};
    for (int n = 0; n < 3; n++) {
        int ends[2];
        if (pipe2(ends, O_CLOEXEC) != 0)
            return errno;
        far[n] = ends[n > 0];
        *near[n] = ends[n == 0];
        int flags = fcntl(*near[n], F_GETFL);
        if (flags < 0 || fcntl(*near[n], F_SETFL, flags | O_NONBLOCK) != 0)
            return errno;
    }
    return 0;
}

static int start(struct run *run) {
    int far[3] = {-1, -1, -1};
    int failure = make_pipes(run, far);
    if (failure == 0)
        failure = child_start("/proc/self/exe", run->process->arguments, far, &run->child);
    for (int n = 0; n < 3; n++)
        close_end(&far[n]);
    return failure != 0 ? failure : set_limits(run);
}

/* --- what goes in and comes out --- */

static bool would_wait(void) {
    return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
}

/* What it does not want to read any more is not sent. */
static void send_input(struct run *run) {
    const struct own_process *process = run->process;
    size_t left = process->input_size - run->sent;
    ssize_t count =
        left > 0 ? write(run->near.input, process->input + run->sent, left < PART ? left : PART)
                 : 0;
    if (count > 0)
        run->sent += (size_t)count;
    if (run->sent == process->input_size || (count < 0 && !would_wait()))
        close_end(&run->near.input);
}

/* Returns 0, ENOMEM, or EFBIG for more than may come. */
static int take_output(struct run *run) {
    struct own_process_result *result = run->result;
    if (result->output_size + 1 >= run->room) {
        size_t room = run->room < PART ? PART : 2 * run->room;
        char *larger = realloc(result->output, room);
        if (larger == NULL)
            return ENOMEM;
        result->output = larger;
        run->room = room;
    }
    ssize_t count = read(run->near.output, result->output + result->output_size,
                         run->room - 1 - result->output_size);
    if (count > 0)
        result->output_size += (size_t)count;
    else if (count == 0 || !would_wait())
        close_end(&run->near.output);
    result->output[result->output_size] = '\0';
    return result->output_size > run->process->output_most ? EFBIG : 0;
}

static void take_said(struct run *run) {
    char part[512], *said = run->result->said;
    ssize_t count = read(run->near.said, part, sizeof part);
    if (count == 0 || (count < 0 && !would_wait())) {
        close_end(&run->near.said);
        return;
    }
    size_t room = sizeof run->result->said - 1 - run->said;
    size_t kept = count > 0 && (size_t)count < room ? (size_t)count : count > 0 ? room : 0;
    memcpy(said + run->said, part, kept);
    run->said += kept;
    said[run->said] = '\0';
}

/* Waits for any of the pipes for a while, and does what can be done. */
static int exchange_bytes(struct run *run) {
    struct pollfd files[3] = {{.fd = run->near.input, .events = POLLOUT},
                              {.fd = run->near.output, .events = POLLIN},
                              {.fd = run->near.said, .events = POLLIN}};
    if (poll(files, 3, ASK_MS) <= 0)
        return 0;
    if (files[0].revents != 0)
        send_input(run);
    if (files[2].revents != 0)
        take_said(run);
    return files[1].revents != 0 ? take_output(run) : 0;
}

/* Until it has closed what it prints to: it has ended then, or is about to. */
static int follow(struct run *run) {
    const struct own_process *process = run->process;
    int64_t until = clock_ms() + 1000 * (int64_t)process->wait_seconds, ask = 0;
    while (run->near.output >= 0 || run->near.said >= 0) {
        int failure = exchange_bytes(run);
        if (failure == EFBIG)
            run->result->end = OWN_PROCESS_LARGE;
        else if (failure != 0)
            return failure;
        if (clock_ms() > until)
            run->result->end = OWN_PROCESS_LATE;
        else if (clock_ms() >= ask && process->stop(process->context) != 0)
            run->result->end = OWN_PROCESS_STOPPED;
        if (run->result->end != OWN_PROCESS_DONE)
            return 0;
        ask = clock_ms() >= ask ? clock_ms() + ASK_MS : ask;
    }
    return 0;
}

/* --- the end --- */

static void judge(struct own_process_result *result, int state) {
    if (result->end != OWN_PROCESS_DONE)
        return;
    if (WIFEXITED(state))
        result->status = WEXITSTATUS(state);
    else if (WIFSIGNALED(state) && (WTERMSIG(state) == SIGXCPU || WTERMSIG(state) == SIGKILL))
        result->end = OWN_PROCESS_LATE; /* none but the limit sends these */
    else
        result->end = OWN_PROCESS_BROKEN;
}

/* One that closed what it prints to has a moment to end. */
static void reap(struct run *run, bool kill_first) {
    enum { MOMENT_MS = 2000, PAUSE_MS = 2 };
    int64_t until = clock_ms() + MOMENT_MS;
    int state = 0;
    pid_t ended = 0;
    if (run->child <= 0)
        return;
    while (!kill_first && ended == 0 && clock_ms() < until) {
        ended = waitpid(run->child, &state, WNOHANG);
        if (ended == 0)
            (void)poll(NULL, 0, PAUSE_MS);
    }
    if (ended == 0)
        (void)kill(run->child, SIGKILL);
    while (ended == 0 || (ended < 0 && errno == EINTR))
        ended = waitpid(run->child, &state, 0);
    judge(run->result, state);
}

int own_process_run(const struct own_process *process, struct own_process_result *out,
                    struct error *err) {
    *out = (struct own_process_result){.end = OWN_PROCESS_DONE};
    struct run run = {.process = process, .result = out, .near = {-1, -1, -1}};
    int failure = start(&run);
    if (failure == 0)
        failure = follow(&run);
    close_end(&run.near.input);
    close_end(&run.near.output);
    close_end(&run.near.said);
    reap(&run, failure != 0 || out->end != OWN_PROCESS_DONE);
    size_t length = strlen(out->said);
    while (length > 0 && out->said[length - 1] == '\n')
        out->said[--length] = '\0';
    if (failure == 0)
        return 0;
    free(out->output);
    out->output = NULL;
    if (failure == ENOMEM)
        return error_memory(err, run.room, "the answer of a process");
    return error_set(err, ERROR_SYSTEM, "a process for a peer's file: %s", strerror(failure));
}
