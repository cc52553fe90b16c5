/* What this process may use, which may be less than what the machine has. */
#ifndef RUGO_JOBS_ALLOTMENT_H
#define RUGO_JOBS_ALLOTMENT_H

#include <stdint.h>

/* Returns the number of threads, at least 1: the least of its affinity mask, the quota of its
 * control groups (versions 1 and 2) rounded up to processors, and what Slurm gave it. */
unsigned allotment_threads(void);
/* Returns the bytes of memory: the least of the machine's, the limit of its control groups and what
 * Slurm gave it; 0: not known. */
double allotment_memory(void);
/* Returns the seconds that are left, at least 1, to two minutes before the end of a job of Slurm,
 * when SIGTERM may come; 0: no such limit. */
int64_t allotment_seconds(void);

/* The single limits, for tests. Each returns 0 where there is none. */
/* root stands before every path, "" for the machine itself. */
unsigned allotment_of_groups(const char *root);
double allotment_memory_of_groups(const char *root);
/* The texts are the values of SLURM_CPUS_PER_TASK and SLURM_CPUS_ON_NODE; NULL where not set. One
 * that is no number of processors is no limit. */
unsigned allotment_of_slurm(const char *per_task, const char *on_node);
/* Likewise those of SLURM_MEM_PER_NODE and SLURM_MEM_PER_CPU, in MiB, and of SLURM_CPUS_ON_NODE. */
double allotment_memory_of_slurm(const char *per_node, const char *per_cpu, const char *on_node);
/* Likewise the end of SLURM_JOB_END_TIME, and now_s; both are seconds of the epoch. */
int64_t allotment_seconds_of_slurm(const char *end, int64_t now_s);

#endif
