/* The pilots of a place: their name, and their script in a work folder. */
#ifndef RUGO_SERVER_COMMAND_PILOTS_H
#define RUGO_SERVER_COMMAND_PILOTS_H

#include "server/command/slurm_folder.h"
#include "server/command/slurm_jobs.h"
#include "server/command/slurm_script.h"

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
