/* Real processes for system tests: start, watch, kill; and plain HTTP over a socket. A failure
 * fails the test. */
#ifndef RUGO_TESTS_SUPPORT_PROCESS_H
#define RUGO_TESTS_SUPPORT_PROCESS_H

#include <stdbool.h>
#include <stddef.h>
#include <sys/types.h>

/* The executable under test: $RUGO, or build/rugo. */
const char *rugo(void);

struct process {
    pid_t pid;             /* 0: none */
    char out[64], err[64]; /* files in the test's folder that take its output */
};
/* Starts rugo with the arguments (NULL-terminated, without the program's name); output goes to
 * files NAME.out and NAME.err. */
void process_start(struct process *process, const char *name, const char *const *arguments);
/* Waits for its end (at most `seconds`, then the test fails); exit status, or 128 + the signal. */
int process_wait(struct process *process, int seconds);
/* Waits until there is a file of such a name (glob), a minute at most, or the process has ended. */
void process_wait_for_file(const struct process *process, const char *pattern);
/* Start and wait. */
int run_rugo(const char *name, const char *const *arguments);
/* Runs a line of the shell, in which $RUGO is the executable, and returns its exit status likewise;
 * output goes to shell.out and shell.err. */
int run_shell(const char *line);
/* Runs a line that succeeds, or one that fails with these words on standard error. */
void check_shell(const char *line);
void check_shell_refused(const char *line, const char *words);
/* Checks how many studies a store has. */
void check_study_count(const char *database, const char *count);
void process_kill(struct process *process, int signal_number);
/* Contents of a file of the test's folder; the caller frees. */
char *slurp(const char *path);
/* The same from a text on, which must be there. */
char *slurp_from(const char *path, const char *text);
void spit(const char *path, const char *text);
/* Likewise, of mode 600, as files of tokens must be. */
void spit_secret(const char *path, const char *text);
bool contains(const char *path, const char *text);
/* Waits until a file contains a text, two minutes at most. */
void wait_for_text(const char *path, const char *text);
void sleep_ms(long milliseconds);

/* Starts `rugo serve` on a free port with further arguments; the port. */
unsigned serve_start(struct process *process, const char *const *more);

/* A port for servers that end and come back to it: below those that the system gives to whoever
 * wants any, so that no other test gets it meanwhile. */
unsigned free_port(void);

/* One exchange over a new connection: sends the bytes, reads to the end (Connection: close is up to
 * the caller). The caller frees. */
char *http_raw(unsigned port, const char *bytes, size_t size);
/* The same for a reply that may hold NULs. */
char *http_bytes(unsigned port, const char *bytes, size_t size, size_t *length);
/* A request with Connection: close; status and body (caller frees; NULL where not wanted). */
int http_exchange(unsigned port, const char *method, const char *path, const char *headers,
                  const char *body, char **answer);
struct http_request {
    const char *method, *path, *headers, *body; /* headers, each with its line break; or NULL */
};
/* The same where a server may be slow, stopped or gone: the status is 0 where no answer begins
 * within so many milliseconds. */
int http_try(unsigned port, long milliseconds, const struct http_request *request, char **answer);
/* An open connection to the port. */
int http_connect(unsigned port);

#endif
