/* The subcommands of `rugo`. Each sits in the file of its name; commands.c has the table. */
#ifndef RUGO_SERVER_COMMAND_COMMAND_H
#define RUGO_SERVER_COMMAND_COMMAND_H

#include "core/rugo.h"
#include "schema/result/result.h"
#include "schema/study/fault.h"
#include "schema/study/study.h"
#include "server/command/exit_status.h"
#include "server/command/options.h"
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>

#define PROGRAM_VERSION RUGO_VERSION
#define DATABASE "rugo.db" /* where no other is named */
#define LOG_LEVEL_HELP "the least that is logged on standard error"
#define SET_HELP "change the study, e.g. --set realisations=100"

enum { ARGUMENTS_MOST = 17, WORKERS_MOST = 4096, SECONDS_MOST = 31536000 };

struct command {
    const char *name, *arguments, *summary;
    int least, most; /* arguments beside the options, at most ARGUMENTS_MOST */
    const struct option_row *options;
    size_t options_size; /* of the struct that their offsets are of */
    /* Returns an exit status. */
    int (*run)(const void *options, const char *const *arguments);
};
extern const struct command *const COMMANDS[]; /* all, ended by NULL */
extern const struct command COMMAND_RUN, COMMAND_CHECK, COMMAND_SUBMIT, COMMAND_STATUS,
    COMMAND_WAIT, COMMAND_CURVES, COMMAND_REPORT, COMMAND_SNAPSHOT, COMMAND_RESTORE, COMMAND_CANCEL,
    COMMAND_RETRY, COMMAND_EXTEND, COMMAND_DELETE, COMMAND_SERVE, COMMAND_WORK, COMMAND_GENERATE,
    COMMAND_CHARACTERISE, COMMAND_CONVERT, COMMAND_PRESS, COMMAND_THEORY, COMMAND_PLOT,
    COMMAND_SHOW, COMMAND_TABLE, COMMAND_HELP, COMMAND_CERTIFICATE, COMMAND_TOKEN, COMMAND_VERIFY,
    COMMAND_REPAIR, COMMAND_HEALTH, COMMAND_PRUNE, COMMAND_EXPORT;

extern const struct command COMMAND_SLURM, COMMAND_SLURM_PILOTS;

/* Set by SIGINT and SIGTERM once signals_catch was called; a second one ends the program at once.
 */
extern atomic_int stop_requested;
/* The same for functions that ask now and then; context: none. */
bool stop_is_requested(void *context);
void signals_catch(void);

/* Prints "rugo COMMAND: text" to standard error and gives the exit status of an error code. */
int command_fail(const char *command, const struct error *err);
/* Prints what is wrong in a file likewise: "FILE: pointer: detail", one a line. */
int command_fail_faults(const char *file, const struct fault_list *faults);
/* Returns the exit status of a command that reads a file; where it failed, prints what is wrong in
 * the file, or else the error. */
int command_end(const char *command, int status, const char *file, const struct fault_list *faults,
                const struct error *err);
/* Prints "rugo COMMAND: no results: error" to standard error where a result has an error. */
void command_warn_missing(const char *command, const struct case_result *result);
/* What was printed to standard output must arrive: ERROR_SYSTEM with the reason when it did not. To
 * be called right after printing, while errno has it. */
int output_flush(struct error *err);
/* Prints a JSON document as one line; NULL: out of memory. */
int output_document(const cJSON *document, struct error *err);
/* The study in a file, read and checked with these changes (--set); errors name the file. path
 * NULL: a study of statistics that has nothing but the changes. */
int study_file_read(struct study **out, const char *path, const char *const *overrides,
                    struct fault_list *faults, struct error *err);

#endif
