/* Pilots as jobs of Slurm: an array a submission, found again by their name. */
#ifndef RUGO_SERVER_COMMAND_CLUSTER_SLURM_JOBS_H
#define RUGO_SERVER_COMMAND_CLUSTER_SLURM_JOBS_H

#include "core/error.h"

enum { SLURM_NAME_SIZE = 32 };

/* Makes the name of the jobs that belong to a path or URL, such as a folder: the same each time. */
void slurm_jobs_name(const char *place, char name[SLURM_NAME_SIZE]);

/* Submits a script as an array of so many pilots. */
int slurm_jobs_submit(const char *script, unsigned count, struct error *err);

struct slurm_count {
    unsigned waiting, running; /* those that are about to end, and for good, are neither */
    unsigned left;             /* all that Slurm has not done with */
};
/* Counts this user's pilots of a name; *count stays as it was where Slurm does not answer. */
int slurm_jobs_count(const char *name, struct slurm_count *count, struct error *err);

/* Cancels this user's pilots of a name: those that wait alone, or all, which get SIGTERM first and
 * hand in what they have done. */
int slurm_jobs_cancel(const char *name, int waiting_alone, struct error *err);
/* Sends SIGTERM to the scripts of this user's running jobs of a name, not to what these started. */
int slurm_jobs_tell(const char *name, struct error *err);

#endif
