/* The work folder of `rugo slurm`, which login node and nodes share: store, secrets, script, logs.
 */
#ifndef RUGO_SERVER_COMMAND_CLUSTER_SLURM_FOLDER_H
#define RUGO_SERVER_COMMAND_CLUSTER_SLURM_FOLDER_H

#include "core/error.h"
#include <limits.h>
#include <stddef.h>

struct slurm_folder {
    char path[PATH_MAX]; /* absolute */
    int lock;            /* a file held for this process alone */
};
/* Makes the folder where it is missing, for its user alone, and holds it. ERROR_STATE where another
 * process holds it. */
int slurm_folder_open(struct slurm_folder *folder, const char *path, struct error *err);
/* Accepts one that is zero or was closed. */
void slurm_folder_close(struct slurm_folder *folder);

/* Writes the path of a file of the folder. ERROR_INPUT where it is too long. */
int slurm_folder_file(const struct slurm_folder *folder, const char *name, char path[PATH_MAX],
                      struct error *err);
/* Puts a file with this text in the place of one that may be there, whole or not at all; secret:
 * its user alone may read it. */
int slurm_folder_write(const struct slurm_folder *folder, const char *name, const char *text,
                       int secret, struct error *err);
/* Writes the files "tokens", for a server, and "pilot.token", for its workers, unless an earlier
 * run left them to pilots that are still there. */
int slurm_folder_make_tokens(const struct slurm_folder *folder, struct error *err);
/* Removes the files with secrets. */
void slurm_folder_forget(const struct slurm_folder *folder);

#endif
