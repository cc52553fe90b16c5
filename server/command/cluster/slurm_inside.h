/* `rugo slurm --inside`: the command itself as a job, for login nodes that are not for long ones.
 */
#ifndef RUGO_SERVER_COMMAND_CLUSTER_SLURM_INSIDE_H
#define RUGO_SERVER_COMMAND_CLUSTER_SLURM_INSIDE_H

#include "server/command/cluster/pilots.h"

/* The command line of the job; all is borrowed. */
struct inside_command {
    const struct option_row *rows;
    const void *values;         /* of the rows */
    const char *file;           /* the study's */
    const char *const *without; /* NULL-terminated: options that are not handed on, as the one
                                   that asked for this job */
};
struct inside {
    char name[SLURM_NAME_SIZE + 8]; /* of the job */
    char script[PATH_MAX];          /* "inside.sh" of the folder */
    char log[PATH_MAX];             /* "inside.log": what the command prints */
};
/* Writes the batch script of the job, with this limit of time, into the folder. */
int inside_prepare(struct inside *inside, const struct slurm_folder *folder,
                   const struct pilots *pilots, const struct pilot_options *options,
                   const char *time, const struct inside_command *command, struct error *err);
/* Submits the job, unless it is there, and waits until Slurm has done with it. A signal cancels it:
 * it hands in what it has done then (ERROR_STOPPED). */
int inside_follow(const struct inside *inside, struct error *err);

#endif
