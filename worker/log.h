/* Log lines in logfmt on standard error, for workers and server alike:
 *
 *     time=2026-01-31T12:00:00.123Z level=info worker=host-17-0 study=… job=4 attempt=1 msg="job
 *     done"
 *
 * A line is one write, so that lines of several threads and processes do not mix. Text from outside
 * is quoted and escaped, and cut at LOG_LINE_MOST. Callers pass no tokens. */
#ifndef RUGO_WORKER_LOG_H
#define RUGO_WORKER_LOG_H

#include <stddef.h>
#include <stdint.h>

enum { LOG_LINE_MOST = 1024 };
enum log_level { LEVEL_DEBUG, LEVEL_INFO, LEVEL_WARNING, LEVEL_ERROR };
#define LOG_LEVELS "debug|info|warning|error" /* in the order of the numbers */

/* The subject of a line. Fields left zero are left out; all are borrowed. */
struct log_about {
    const char *worker, *study;
    int64_t job;
    uint64_t attempt;
    const char *request; /* "POST /v1/jobs/claim" */
    long status;         /* HTTP status of the answer */
    double seconds;      /* how long it took */
};

/* Leaves out lines below this level from now on, in the whole process; LEVEL_INFO at first. */
void log_set_least(enum log_level least);
/* Writes one line; about may be NULL. A failure to write is ignored, as there is nowhere to report
 * it. */
__attribute__((format(printf, 3, 4))) void
log_line(enum log_level level, const struct log_about *about, const char *format, ...);
/* Writes the line with its newline into line[0..size), always NUL-terminated, and returns its
 * length. time_ms: since 1970. */
size_t log_format(char *line, size_t size, int64_t time_ms, enum log_level level,
                  const struct log_about *about, const char *message);

#endif
