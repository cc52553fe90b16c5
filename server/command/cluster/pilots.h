/* The pilots of a folder or server: their name, and their script in a work folder. */
#ifndef RUGO_SERVER_COMMAND_CLUSTER_PILOTS_H
#define RUGO_SERVER_COMMAND_CLUSTER_PILOTS_H

#include "core/error.h"
#include "server/command/cluster/slurm_folder.h"
#include "server/command/cluster/slurm_jobs.h"
#include "server/command/options.h"
#include <stdio.h>

/* The batch script of pilots: workers that Slurm starts. */

/* What each pilot asks of Slurm, as given; NULL where Slurm is to choose. */
struct pilot_options {
    unsigned tasks, cpus; /* processes of a pilot, on one node; processors of each */
    const char *time, *partition, *account, *program;
    const char **sbatch; /* further options of sbatch, a line each */
    unsigned idle_s;
};
/* The rows of its options, where it is the member `pilot` of the command's struct. */
#define PILOT_ROW(options, name, type, high, member, argument, standard, help)                     \
    { name, 0, type, 1, high, offsetof(options, pilot.member), argument, standard, help }
#define PILOT_ROWS(options)                                                                        \
    PILOT_ROW(options, "tasks-per-node", OPTION_COUNT, 4096, tasks, "N", "1",                      \
              "processes of a pilot, which has one node"),                                         \
        PILOT_ROW(options, "cpus-per-task", OPTION_COUNT, 4096, cpus, "N", "1",                    \
                  "processors of each, which works on as many threads"),                           \
        PILOT_ROW(options, "time", OPTION_TEXT, 0, time, "TIME", NULL,                             \
                  "limit of a pilot, as of sbatch; results are handed in a minute before"),        \
        PILOT_ROW(options, "partition", OPTION_TEXT, 0, partition, "NAME", NULL, "as of sbatch"),  \
        PILOT_ROW(options, "account", OPTION_TEXT, 0, account, "NAME", NULL, "as of sbatch"),      \
        PILOT_ROW(options, "sbatch", OPTION_LIST, 0, sbatch, "OPTION", NULL,                       \
                  "another option of sbatch, such as --sbatch=--mem=2G"),                          \
        PILOT_ROW(options, "idle", OPTION_COUNT, 31536000, idle_s, "SECONDS", "300",               \
                  "a pilot without a job for so long ends"),                                       \
        PILOT_ROW(options, "program", OPTION_TEXT, 0, program, "FILE", NULL,                       \
                  "the executable on the nodes (this one)")

struct pilot_script {
    const struct pilot_options *options; /* all borrowed */
    const char *name;                    /* of the jobs */
    const char *folder;                  /* absolute: for logs */
    const char *program;                 /* absolute */
    /* Where the server is: a file of options of `rugo work`, a word a line, read when the pilot
     * starts. */
    const char *place;
};
/* Returns EXIT_USAGE, after a usage error was printed, where an option would not be one line. */
int pilot_options_check(const char *command, const struct pilot_options *options);
/* Whether a text needs no quotes in a script's line for sbatch. */
bool script_is_word(const char *text);
/* Prints a word that sh takes as it is. */
void script_print_word(const char *text, FILE *file);
/* Prints a path between quotation marks in a line for sbatch, whose own signs have no meaning then.
 */
void script_print_path(const char *path, FILE *file);
/* Prints the script. */
void pilot_script_print(const struct pilot_script *script, FILE *file);

struct pilots {
    char name[SLURM_NAME_SIZE]; /* of the jobs */
    char program[PATH_MAX];     /* the executable on the nodes */
    char script[PATH_MAX];      /* "pilots.sh" of the folder */
};
/* Names the pilots after what they serve, and writes their script into the folder. */
int pilots_prepare(struct pilots *pilots, const struct slurm_folder *folder, const char *served,
                   const struct pilot_options *options, struct error *err);
/* Prints a script of a work folder to standard output. */
int pilots_print(const char *script, struct error *err);

#endif
