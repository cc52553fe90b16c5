#include "worker/log.h"

#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

/* A line under construction; once it is full, what follows is dropped. */
struct line {
    char *text;
    size_t size, length; /* size leaves room for the newline and the NUL */
};

static void line_byte(struct line *line, char byte) {
    if (line->length < line->size)
        line->text[line->length++] = byte;
}

static void line_text(struct line *line, const char *text) {
    for (; *text != '\0'; text++)
        line_byte(line, *text);
}

__attribute__((format(printf, 2, 3))) static void line_print(struct line *line, const char *format,
                                                             ...) {
    char text[64];
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (length > 0)
        line_text(line, text);
}

/* Adds a value, bare where logfmt allows it, else quoted. Control bytes are escaped, so that no
 * value can start a line of its own. */
static void line_value(struct line *line, const char *value) {
    size_t length = strlen(value);
    bool bare = length > 0;
    for (size_t n = 0; n < length && bare; n++) {
        unsigned char byte = (unsigned char)value[n];
        bare = byte > ' ' && byte != '"' && byte != '=' && byte != '\\' && byte != 0x7f;
    }
    if (bare) {
        line_text(line, value);
        return;
    }
    line_byte(line, '"');
    for (size_t n = 0; n < length; n++) {
        unsigned char byte = (unsigned char)value[n];
        if (byte == '"' || byte == '\\')
            line_print(line, "\\%c", byte);
        else if (byte == '\n')
            line_text(line, "\\n");
        else if (byte < ' ' || byte == 0x7f)
            line_print(line, "\\x%02x", byte);
        else
            line_byte(line, (char)byte);
    }
    line_byte(line, '"');
}

static void line_field(struct line *line, const char *key, const char *value) {
    if (value != NULL) {
        line_print(line, " %s=", key);
        line_value(line, value);
    }
}

static void line_time(struct line *line, int64_t time_ms) {
    time_t seconds = (time_t)(time_ms / 1000);
    struct tm utc = {0};
    char text[32] = "";
    if (gmtime_r(&seconds, &utc) != NULL)
        strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &utc);
    line_print(line, "time=%s.%03dZ", text, (int)(time_ms % 1000));
}

static void line_about(struct line *line, const struct log_about *about) {
    line_field(line, "worker", about->worker);
    line_field(line, "study", about->study);
    if (about->job != 0)
        line_print(line, " job=%lld", (long long)about->job);
    if (about->attempt != 0)
        line_print(line, " attempt=%llu", (unsigned long long)about->attempt);
    line_field(line, "request", about->request);
    if (about->status != 0)
        line_print(line, " status=%ld", about->status);
    if (about->seconds > 0)
        line_print(line, " seconds=%.6f", about->seconds);
}

size_t log_format(char *line, size_t size, int64_t time_ms, enum log_level level,
                  const struct log_about *about, const char *message) {
    static const char *const names[] = {"debug", "info", "warning", "error"};
    if (size < 2)
        return 0;
    struct line made = {line, size - 2, 0};
    line_time(&made, time_ms);
    line_field(&made, "level", names[level]);
    if (about != NULL)
        line_about(&made, about);
    line_field(&made, "msg", message);
    line[made.length++] = '\n';
    line[made.length] = '\0';
    return made.length;
}

/* The process's level, as its standard error is one; set by the command line alone. */
static atomic_int least_level = LEVEL_INFO;

void log_set_least(enum log_level least) {
    atomic_store(&least_level, least);
}

void log_line(enum log_level level, const struct log_about *about, const char *format, ...) {
    if ((int)level < atomic_load(&least_level))
        return;
    char message[LOG_LINE_MOST], line[LOG_LINE_MOST];
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    struct timespec now = {0};
    clock_gettime(CLOCK_REALTIME, &now);
    int64_t time_ms = (int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000;
    size_t size = log_format(line, sizeof line, time_ms, level, about, length < 0 ? "" : message);
    /* standard error is unbuffered and stdio locks it: one write a line */
    (void)fwrite(line, 1, size, stderr);
}
