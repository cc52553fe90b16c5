/* Options of the subcommands: one table a command is what parses, helps, and makes the man page. */
#ifndef RUGO_SERVER_COMMAND_OPTIONS_H
#define RUGO_SERVER_COMMAND_OPTIONS_H

#include "jobs/contact/model/model.h"
#include <stdbool.h>
#include <stddef.h>

enum option_type { /* what a value becomes; where it has no default and is not given: */
                   OPTION_FLAG,     /* bool; false */
                   OPTION_TEXT,     /* const char *, borrowed from argv or the table; NULL */
                   OPTION_OPTIONAL, /* likewise; the default where it is given without a number
                                       behind it, NULL where it is not given */
                   OPTION_MODELS,   /* const char *, names that models_find reads; NULL */
                   OPTION_COUNT,    /* unsigned in [low, high]; 0 */
                   OPTION_INDEX,    /* int64_t, 0 or more; -1 */
                   OPTION_PAIR,     /* int64_t[2], each 0 or more, given as "1 0" or "1,0"; -1 */
                   OPTION_NUMBER,   /* double in [low, high], or above low where high is 0; 0 */
                   OPTION_CHOICE,   /* int, the number of the word in argument ("text|json"); 0 */
                   OPTION_LIST, /* const char **, owned, NULL-terminated; may be given again; empty
                                 */
};
struct option_row {
    const char *name; /* without dashes; NULL ends a table */
    char letter;      /* of the short form; 0: none */
    enum option_type type;
    double low, high;
    size_t at;            /* offset of the value in the command's struct of options */
    const char *argument; /* what help calls the value; NULL for a flag */
    const char *standard; /* the default, as it would be typed; NULL: none */
    const char *help;
};

/* Writes what help calls the value: "N", the names of models with | between, "" of a flag. */
void option_argument(const struct option_row *row, char *text, size_t size);

/* Defaults, then what argv gives, into *values (zeros at first). What is left of argv, at least
 * `least` and at most `most` arguments, goes into arguments[], NULL where absent;
 * `named` is what help calls them. 0, or an exit status after a word on standard error;
 * options_clear is due in both cases. */
int options_parse(int argc, char **argv, const struct option_row *rows, void *values, int least,
                  int most, const char *named, const char **arguments);
void options_clear(const struct option_row *rows, void *values);

/* "rugo COMMAND: text; see rugo COMMAND --help" on standard error; EXIT_USAGE. */
__attribute__((format(printf, 2, 3))) int usage_error(const char *command, const char *format, ...);

/* Finds the models of a text of their names with commas between, each once; false where it is not
 * that. positions: in CONTACT_MODELS. */
bool models_find(const char *text, int positions[CONTACT_MODELS_MOST], size_t *count);

#endif
