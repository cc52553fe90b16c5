/* The number of threads that this process may use, which may be fewer than the machine's
 * processors. */
#ifndef RUGO_WORKER_ALLOTMENT_H
#define RUGO_WORKER_ALLOTMENT_H

/* Returns the least of the limits of this process, at least 1: its affinity mask, the quota of its
 * control groups (versions 1 and 2) rounded up to processors, and what Slurm gave it. */
unsigned allotment_threads(void);

/* The single limits, for tests. Each returns 0 where there is none. */
/* root stands before every path, "" for the machine itself. */
unsigned allotment_of_groups(const char *root);
/* The texts are the values of SLURM_CPUS_PER_TASK and SLURM_CPUS_ON_NODE; NULL where not set. One
 * that is no number of processors is no limit. */
unsigned allotment_of_slurm(const char *per_task, const char *on_node);

#endif
