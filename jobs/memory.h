/* How much memory this process may use. */
#ifndef RUGO_JOBS_MEMORY_H
#define RUGO_JOBS_MEMORY_H

/* Bytes: the machine's, or the limit of the control group that the process is in, whichever is
 * less. 0 when neither can be read. */
double memory_available(void);

#endif
