/* How many threads this process is allotted, which may be fewer than the machine has processors. */
#ifndef RUGO_WORKER_ALLOTMENT_H
#define RUGO_WORKER_ALLOTMENT_H

/* Returns the least of what restricts this process, at least 1: its affinity mask, the processors
 * that the quota of its control groups (versions 1 and 2) comes to, rounded up, and those that
 * Slurm gave it. */
unsigned allotment_threads(void);

/* The parts, for tests. Each returns 0 where nothing restricts. */
/* root stands before every path, "" for the machine itself. */
unsigned allotment_of_groups(const char *root);
/* The texts are the values of SLURM_CPUS_PER_TASK and SLURM_CPUS_ON_NODE; NULL where not set. What
 * is no number of processors says nothing. */
unsigned allotment_of_slurm(const char *per_task, const char *on_node);

#endif
