/* The subcommands of `rugo`. Each sits in the file of its name; main.c has the table. */
#ifndef RUGO_SERVER_COMMAND_COMMAND_H
#define RUGO_SERVER_COMMAND_COMMAND_H

#include "schema/study/fault.h"
#include "schema/study/study.h"
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>

enum { EXIT_DONE = 0, EXIT_FAILED = 1, EXIT_USAGE = 2, EXIT_INTERRUPTED = 130 };

struct command {
    const char *name, *arguments, *summary;
    int (*run)(int argc, char **argv); /* argv[0] is the command; returns an exit status */
    const char *help;                  /* options, one a line */
};
int command_run(int argc, char **argv);
int command_check(int argc, char **argv);
int command_submit(int argc, char **argv);
int command_status(int argc, char **argv);
int command_curves(int argc, char **argv);
int command_report(int argc, char **argv);
int command_snapshot(int argc, char **argv);
int command_cancel(int argc, char **argv);
int command_retry(int argc, char **argv);
int command_serve(int argc, char **argv);
int command_work(int argc, char **argv);
int command_generate(int argc, char **argv);
int command_characterise(int argc, char **argv);
int command_press(int argc, char **argv);

/* Set by SIGINT and SIGTERM once signals_catch was called; the second SIGINT ends at once. */
extern atomic_int stop_requested;
void signals_catch(void);

/* Prints "rugo COMMAND: text" to standard error and gives the exit status of an error code. */
int command_fail(const char *command, const struct error *err);
/* The same for what is wrong in a file: "FILE: pointer: detail", one a line. */
int command_fail_faults(const char *file, const struct fault_list *faults);
/* What was printed to standard output must arrive: ERROR_SYSTEM with the reason when it did not.
 * To be called right after printing, while errno tells of it. */
int output_flush(struct error *err);
/* Prints a JSON document as one line; NULL: out of memory. */
int output_document(const cJSON *document, struct error *err);
/* The file's bytes, NUL-terminated; "-" is standard input. Caller frees. */
int file_read(const char *path, size_t limit, char **text, size_t *size, struct error *err);
/* The study in a file, read and checked with these changes (--set); errors name the file. */
int study_file_read(struct study **out, const char *path, const char *const *overrides,
                    struct fault_list *faults, struct error *err);
/* The token of --token-file (its first line) or of RUGO_TOKEN; *token NULL where neither. Caller
 * frees. */
int token_read(const char *token_file, char **token, struct error *err);

#endif
