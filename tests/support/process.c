#include "tests/support/process.h"
#include "tests/support/check.h"
#include "tests/support/count_files.h"
#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* They end tests that hang: none is what a machine with other work takes. */
enum { CONVERSATION_SECONDS = 120, TEXT_SECONDS = 120, RUN_SECONDS = 300, ANSWER_MS = 60000 };
enum { ARGUMENTS_MOST = 40 };

const char *rugo(void) {
    const char *path = getenv("RUGO");
    return path ? path : "build/rugo";
}

void sleep_ms(long milliseconds) {
    struct timespec pause = {milliseconds / 1000, milliseconds % 1000 * 1000000};
    nanosleep(&pause, NULL);
}

static void redirect(const char *path, int to) {
    int file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (file < 0 || dup2(file, to) < 0)
        _exit(127);
    close(file);
}

void process_start(struct process *process, const char *name, const char *const *arguments) {
    const char *argv[ARGUMENTS_MOST + 2] = {rugo()};
    size_t count = 1;
    for (; *arguments && count <= ARGUMENTS_MOST; arguments++)
        argv[count++] = *arguments;
    snprintf(process->out, sizeof process->out, "%s.out", name);
    snprintf(process->err, sizeof process->err, "%s.err", name);
    unlink(process->out);
    process->pid = fork();
    assert_true(process->pid >= 0);
    if (process->pid > 0)
        return;
    prctl(PR_SET_PDEATHSIG, SIGKILL); /* no test leaves a process behind, however it ends */
    redirect(process->out, STDOUT_FILENO);
    redirect(process->err, STDERR_FILENO);
    execv(argv[0], (char *const *)(uintptr_t)argv);
    _exit(127);
}

int process_wait(struct process *process, int seconds) {
    int status = 0;
    for (int tries = 0; waitpid(process->pid, &status, WNOHANG) == 0; tries++) {
        if (tries > 100 * seconds) {
            kill(process->pid, SIGKILL);
            print_error("%s did not end within %d s\n", process->out, seconds);
            fail();
        }
        sleep_ms(10);
    }
    process->pid = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void process_wait_for_file(const struct process *process, const char *pattern) {
    siginfo_t end = {0};
    for (int tries = 0; count_files(pattern) == 0 && end.si_pid == 0; tries++) {
        assert_true(tries < 120000);
        usleep(500);
        assert_int_equal(waitid(P_PID, (id_t)process->pid, &end, WEXITED | WNOHANG | WNOWAIT), 0);
    }
}

int run_rugo(const char *name, const char *const *arguments) {
    struct process process;
    process_start(&process, name, arguments);
    return process_wait(&process, RUN_SECONDS);
}

int run_shell(const char *line) {
    char command[600];
    int length = snprintf(command, sizeof command, "RUGO='%s'; { %s ; } >shell.out 2>shell.err",
                          rugo(), line);
    assert_true(length > 0 && (size_t)length < sizeof command);
    int status = system(command);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void check_shell(const char *line) {
    if (run_shell(line) != 0) {
        char *said = slurp("shell.err");
        fail_msg("%s: %s", line, said);
    }
}

void check_shell_refused(const char *line, const char *words) {
    assert_int_not_equal(run_shell(line), 0);
    if (!contains("shell.err", words)) {
        char *said = slurp("shell.err");
        fail_msg("%s: no '%s' in: %s", line, words, said);
    }
}

void check_study_count(const char *database, const char *count) {
    char line[200];
    snprintf(line, sizeof line, "test \"$($RUGO status --db %s | tail -n +2 | wc -l)\" = %s",
             database, count);
    if (run_shell(line) != 0)
        fail_msg("%s has not %s studies", database, count);
}

void process_kill(struct process *process, int signal_number) {
    if (process->pid)
        kill(process->pid, signal_number);
}

char *slurp(const char *path) {
    FILE *file = fopen(path, "rb");
    size_t size = 0, room = 1 << 16;
    char *text = malloc(room);
    assert_true(file && text);
    while ((size += fread(text + size, 1, room - size - 1, file)) + 1 == room)
        assert_non_null(text = realloc(text, room *= 2));
    text[size] = 0;
    fclose(file);
    return text;
}

char *slurp_from(const char *path, const char *text) {
    char *whole = slurp(path), *from = strstr(whole, text);
    assert_non_null(from);
    memmove(whole, from, strlen(from) + 1);
    return whole;
}

void spit(const char *path, const char *text) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

void spit_secret(const char *path, const char *text) {
    spit(path, text);
    assert_int_equal(chmod(path, 0600), 0);
}

bool contains(const char *path, const char *text) {
    if (access(path, R_OK))
        return false;
    char *all = slurp(path);
    bool found = strstr(all, text) != NULL;
    free(all);
    return found;
}

void wait_for_text(const char *path, const char *text) {
    for (int tries = 0; !contains(path, text); tries++) {
        if (tries > 100 * TEXT_SECONDS) {
            print_error("\"%s\" did not come in %s\n", text, path);
            fail();
        }
        sleep_ms(10);
    }
}

unsigned serve_start(struct process *process, const char *const *more) {
    const char *arguments[ARGUMENTS_MOST + 1] = {"serve", "--listen", "127.0.0.1:0"};
    size_t count = 3;
    for (; more && *more; more++)
        arguments[count++] = *more;
    process_start(process, "serve", arguments);
    wait_for_text(process->out, "\n");
    char *line = slurp(process->out);
    unsigned port = 0;
    assert_int_equal(sscanf(line, "listening on http://127.0.0.1:%u", &port), 1);
    free(line);
    return port;
}

unsigned free_port(void) {
    enum { LEAST = 20000, MOST = 32000 };
    static unsigned asked;
    for (unsigned tries = 0; tries < MOST - LEAST; tries++) {
        unsigned port = LEAST + ((unsigned)getpid() + 101 * asked++) % (MOST - LEAST);
        struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons((uint16_t)port)};
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        int file = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        assert_true(file >= 0);
        bool is_free = bind(file, (struct sockaddr *)&address, sizeof address) == 0;
        close(file);
        if (is_free)
            return port;
    }
    fail_msg("no port is free");
    return 0;
}

/* -1 where nobody listens. */
static int connect_within(unsigned port, long milliseconds) {
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons((uint16_t)port)};
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    int connection = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    struct timeval limit = {.tv_sec = milliseconds / 1000, .tv_usec = milliseconds % 1000 * 1000};
    if (connection < 0)
        return -1;
    setsockopt(connection, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    setsockopt(connection, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
    if (connect(connection, (struct sockaddr *)&address, sizeof address) == 0)
        return connection;
    close(connection);
    return -1;
}

int http_connect(unsigned port) {
    int connection = connect_within(port, ANSWER_MS);
    assert_true(connection >= 0);
    return connection;
}

/* Sends, reads to the end and closes; *length (or NULL) is that of the reply. A stream that does
 * not end fails the test. */
static char *converse(int connection, const char *bytes, size_t size, size_t *length) {
    /* A server that refuses early stops reading: what it answered still counts. */
    for (size_t sent = 0; sent < size;) {
        ssize_t part = send(connection, bytes + sent, size - sent, MSG_NOSIGNAL);
        if (part <= 0)
            break;
        sent += (size_t)part;
    }
    size_t used = 0, room = 1 << 16;
    char *text = malloc(room);
    assert_non_null(text);
    time_t until = time(NULL) + CONVERSATION_SECONDS;
    for (ssize_t part; (part = recv(connection, text + used, room - used - 1, 0)) > 0;) {
        used += (size_t)part;
        assert_true(time(NULL) < until);
        if (used + 1 == room)
            assert_non_null(text = realloc(text, room *= 2));
    }
    text[used] = 0;
    close(connection);
    if (length != NULL)
        *length = used;
    return text;
}

char *http_raw(unsigned port, const char *bytes, size_t size) {
    return http_bytes(port, bytes, size, NULL);
}

char *http_bytes(unsigned port, const char *bytes, size_t size, size_t *length) {
    return converse(http_connect(port), bytes, size, length);
}

/* Takes the lengths of the chunks out of a body, in place. */
static void join_chunks(char *body) {
    char *to = body, *from = body;
    const char *end = body + strlen(body);
    for (size_t size; (size = strtoul(from, &from, 16)) > 0;) {
        if (size + 2 > (size_t)(end - from))
            break;
        memmove(to, from + 2, size);
        to += size;
        from += 2 + size;
    }
    *to = '\0';
}

int http_try(unsigned port, long milliseconds, const struct http_request *request, char **answer) {
    char *text = NULL;
    size_t size = request->body ? strlen(request->body) : 0;
    assert_true(asprintf(&text,
                         "%s %s HTTP/1.1\r\nHost: 127.0.0.1:%u\r\nConnection: close\r\n%s"
                         "Content-Length: %zu\r\n\r\n%s",
                         request->method, request->path, port,
                         request->headers ? request->headers : "", size,
                         request->body ? request->body : "") > 0);
    int connection = connect_within(port, milliseconds), status = 0;
    char *reply = connection < 0 ? strdup("") : converse(connection, text, strlen(text), NULL);
    free(text);
    sscanf(reply, "HTTP/1.1 %d", &status);
    if (answer) {
        char *start = strstr(reply, "\r\n\r\n");
        *answer = strdup(start ? start + 4 : "");
        const char *chunked = strstr(reply, "\r\nTransfer-Encoding: chunked\r\n");
        if (chunked != NULL && chunked < start)
            join_chunks(*answer);
    }
    free(reply);
    return status;
}

int http_exchange(unsigned port, const char *method, const char *path, const char *headers,
                  const char *body, char **answer) {
    return http_try(port, ANSWER_MS, &(struct http_request){method, path, headers, body}, answer);
}
