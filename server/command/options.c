#include "server/command/options.h"
#include <ctype.h>
#include <errno.h>
#include <getopt.h>
#include <limits.h>
#include <sched.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS_MOST = 16 };

bool usage_error(const char *command, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    fprintf(stderr, "rugo %s: ", command);
    vfprintf(stderr, format, arguments);
    fprintf(stderr, "; see rugo %s --help\n", command);
    va_end(arguments);
    return false;
}

unsigned processors(void) {
    cpu_set_t set;
    CPU_ZERO(&set);
    int count = sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
    return count > 0 ? (unsigned)count : 1;
}

static bool read_integer(const char *text, int64_t least, int64_t most, int64_t *out) {
    char *end = NULL;
    if (!isdigit((unsigned char)*text)) /* strtoll would skip blanks and signs */
        return false;
    errno = 0;
    long long value = strtoll(text, &end, 10);
    *out = value;
    return !errno && !*end && value >= least && value <= most;
}

static void list_append(const char **list, const char *text) {
    while (*list)
        list++;
    list[0] = text;
    list[1] = NULL;
}

static bool take_value(const char *command, const struct option_row *row, const char *text) {
    int64_t number = 0;
    switch (row->type) {
    case OPTION_FLAG:
        *(bool *)row->value = true;
        return true;
    case OPTION_TEXT:
        *(const char **)row->value = text;
        return true;
    case OPTION_LIST:
        list_append(row->value, text);
        return true;
    case OPTION_COUNT:
        if (!read_integer(text, 1, UINT_MAX, &number))
            return usage_error(command, "--%s %.40s is not a number of at least 1", row->name,
                               text);
        *(unsigned *)row->value = (unsigned)number;
        return true;
    case OPTION_INDEX:
        if (!read_integer(text, 0, INT64_MAX, &number))
            return usage_error(command, "--%s %.40s is not a number of 0 or more", row->name, text);
        *(int64_t *)row->value = number;
        return true;
    }
    return false;
}

/* getopt's own names of the table; a one-letter name becomes a short option. */
static void fill_names(const struct option_row *rows, struct option *names, char *letters) {
    *letters++ = ':'; /* tell a missing argument from an unknown option */
    for (int r = 0; rows[r].name; r++) {
        int argument = rows[r].type == OPTION_FLAG ? no_argument : required_argument;
        *names++ = (struct option){rows[r].name, argument, NULL, 256 + r};
        if (rows[r].name[1] == 0) {
            *letters++ = rows[r].name[0];
            if (argument == required_argument)
                *letters++ = ':';
        }
    }
    *letters = 0;
    *names = (struct option){NULL, 0, NULL, 0};
}

static const struct option_row *find_row(const struct option_row *rows, int code) {
    if (code >= 256)
        return &rows[code - 256];
    for (; rows->name; rows++)
        if (rows->name[0] == code && rows->name[1] == 0)
            return rows;
    return NULL;
}

/* What getopt refused: it keeps a short option in optopt, and the code of a long one that came with
 * a value it does not take. */
static bool refused(char **argv, const struct option_row *rows) {
    if (optopt >= 256)
        return usage_error(argv[0], "--%s takes no value", rows[optopt - 256].name);
    if (optopt)
        return usage_error(argv[0], "unknown option -%c", optopt);
    return usage_error(argv[0], "unknown option %.60s", argv[optind - 1]);
}

bool options_parse(int argc, char **argv, const struct option_row *rows, int least, int most,
                   const char **arguments) {
    struct option names[ROWS_MOST + 1];
    char letters[2 * ROWS_MOST + 2];
    fill_names(rows, names, letters);
    opterr = 0;
    optind = 1;
    for (int code; (code = getopt_long(argc, argv, letters, names, NULL)) != -1;) {
        if (code == '?')
            return refused(argv, rows);
        if (code == ':')
            return usage_error(argv[0], "%.60s needs a value", argv[optind - 1]);
        if (!take_value(argv[0], find_row(rows, code), optarg))
            return false;
    }
    int count = argc - optind;
    if (count < least)
        return usage_error(argv[0], "%s",
                           least == 1 ? "an argument is missing" : "arguments are missing");
    if (count > most)
        return usage_error(argv[0], "unexpected argument %.60s", argv[optind + most]);
    for (int i = 0; i < most; i++)
        arguments[i] = i < count ? argv[optind + i] : NULL;
    return true;
}
