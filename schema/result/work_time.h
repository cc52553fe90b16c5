/* The time that jobs took. Their cost is processor time; on a busy machine the clock runs several
 * times faster. */
#ifndef RUGO_SCHEMA_RESULT_WORK_TIME_H
#define RUGO_SCHEMA_RESULT_WORK_TIME_H

#include "schema/json/json.h"
#include <stdint.h>

struct work_time {
    double seconds; /* by the clock, summed over jobs */
    /* Processor time of the threads that computed. A job that does not report its own counts with
     * its seconds by the clock. */
    double cpu_seconds;
    uint64_t jobs_without_cpu; /* jobs that do not report it */
};

/* `"seconds": ..., "cpu_seconds": ..., "jobs_without_cpu": ...`, without a comma in front. */
void work_time_print(FILE *file, const struct work_time *time);
/* Reads those members. Documents of older programs have no processor time: the clock's stands for
 * it, and all jobs, at least one, count as without. */
void work_time_read(const cJSON *object, uint64_t jobs, struct work_time *out);

#endif
