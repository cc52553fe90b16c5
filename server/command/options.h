/* Options of the subcommands: one table a command drives getopt_long. */
#ifndef RUGO_SERVER_COMMAND_OPTIONS_H
#define RUGO_SERVER_COMMAND_OPTIONS_H

#include "core/error.h"
#include <stdbool.h>

enum option_type {
    OPTION_FLAG,  /* bool */
    OPTION_TEXT,  /* const char *, borrowed from argv */
    OPTION_COUNT, /* unsigned, 1 or more */
    OPTION_INDEX, /* int64_t, 0 or more */
    OPTION_LIST   /* const char **: room for argc entries, NULL-terminated; may be given again */
};
struct option_row {
    const char *name; /* without dashes; a name of one letter is a short option */
    enum option_type type;
    void *value;
};

/* Reads argv by the table (ended by a NULL name), with at least `least` and at most `most`
 * arguments left, put into arguments[]. False after a word on standard error: the exit status is
 * EXIT_USAGE. */
bool options_parse(int argc, char **argv, const struct option_row *rows, int least, int most,
                   const char **arguments);
/* "rugo COMMAND: text; see rugo COMMAND --help" on standard error; false. */
__attribute__((format(printf, 2, 3))) bool usage_error(const char *command, const char *format,
                                                       ...);
/* Processors that this process may use, at least 1. */
unsigned processors(void);

#endif
