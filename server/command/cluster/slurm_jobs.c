#include "server/command/cluster/slurm_jobs.h"
#include "server/command/tool.h"
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void slurm_jobs_name(const char *place, char name[SLURM_NAME_SIZE]) {
    uint64_t hash = 0xcbf29ce484222325; /* FNV-1a */
    for (; *place != '\0'; place++)
        hash = (hash ^ (unsigned char)*place) * 0x100000001b3;
    snprintf(name, SLURM_NAME_SIZE, "rugo-%016llx", (unsigned long long)hash);
}

/* An option of squeue and scancel for the jobs of this user. */
static void user_option(char text[32]) {
    snprintf(text, 32, "--user=%lu", (unsigned long)getuid());
}

static void name_option(const char *name, char text[48]) {
    snprintf(text, 48, "--name=%.31s", name);
}

int slurm_jobs_submit(const char *script, unsigned count, struct error *err) {
    char array[32], *out = NULL;
    snprintf(array, sizeof array, "--array=1-%u", count);
    int status = tool_run((const char *[]){"sbatch", "--parsable", array, script, NULL}, &out, err);
    if (status == 0 && strspn(out, "0123456789") == 0)
        status = error_set(err, ERROR_SYSTEM, "sbatch printed no number of a job: %.100s", out);
    free(out);
    return status;
}

/* A job that ends has no seconds where it is to be started again: those of its next start. */
static void count_state(const char *state, const char *used, struct slurm_count *count) {
    static const char *const WAITING[] = {"PENDING", "REQUEUED", "REQUEUE_FED", "REQUEUE_HOLD",
                                          "SUSPENDED"};
    static const char *const RUNNING[] = {"RUNNING", "CONFIGURING"};
    count->left++;
    for (size_t s = 0; s < sizeof WAITING / sizeof *WAITING; s++)
        count->waiting += strcmp(state, WAITING[s]) == 0;
    for (size_t s = 0; s < sizeof RUNNING / sizeof *RUNNING; s++)
        count->running += strcmp(state, RUNNING[s]) == 0;
    count->waiting += strcmp(state, "COMPLETING") == 0 && strcmp(used, "0:00") == 0;
}

int slurm_jobs_count(const char *name, struct slurm_count *count, struct error *err) {
    char user[32], named[48], *out = NULL, *rest = NULL;
    user_option(user);
    name_option(name, named);
    int status = tool_run(
        (const char *[]){"squeue", "--noheader", "--array", "--format=%T %M", user, named, NULL},
        &out, err);
    if (status != 0)
        return status;
    *count = (struct slurm_count){0};
    for (char *line = strtok_r(out, "\n", &rest); line != NULL;
         line = strtok_r(NULL, "\n", &rest)) {
        char *used = NULL, *state = strtok_r(line, " ", &used);
        if (state != NULL)
            count_state(state, used + strspn(used, " "), count);
    }
    free(out);
    return 0;
}

int slurm_jobs_cancel(const char *name, int waiting_alone, struct error *err) {
    char user[32], named[48];
    user_option(user);
    name_option(name, named);
    return tool_run((const char *[]){"scancel", user, named,
                                     waiting_alone != 0 ? "--state=PENDING" : NULL, NULL},
                    NULL, err);
}

int slurm_jobs_tell(const char *name, struct error *err) {
    char user[32], named[48];
    user_option(user);
    name_option(name, named);
    return tool_run((const char *[]){"scancel", "--batch", "--signal=TERM", user, named, NULL},
                    NULL, err);
}
