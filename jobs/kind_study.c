/* What looks at the table of kinds: a kind by its name, and studies of the kinds there are. Kinds
 * do not call it. */
#include "jobs/kind.h"
#include "schema/study/study_reader.h"
#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The memory that this process may use. */

/* Reads a file with one number; INFINITY where there is none ("max", no such file). */
static double file_number(const char *path) {
    char text[64] = "";
    FILE *file = fopen(path, "re");
    if (file == NULL)
        return INFINITY;
    bool read = fgets(text, sizeof text, file) != NULL;
    (void)fclose(file);
    char *end = text;
    double number = read ? strtod(text, &end) : 0;
    return end > text && number > 0 ? number : INFINITY;
}

/* Returns the smallest limit of a group and those above it. folder is the process's group below
 * root ("/a/b"); its last part is cut off step by step. */
static double group_limit(const char *root, char *folder, const char *name) {
    double least = INFINITY;
    for (;;) {
        char path[PATH_MAX + 128];
        snprintf(path, sizeof path, "%s%s/%s", root, folder, name);
        least = fmin(least, file_number(path));
        char *slash = strrchr(folder, '/');
        if (slash == NULL)
            return least;
        *slash = '\0';
    }
}

/* /proc/self/cgroup has lines HIERARCHY:CONTROLLERS:FOLDER; version 2 is "0::FOLDER". */
static double cgroup_limit(void) {
    FILE *file = fopen("/proc/self/cgroup", "re");
    if (file == NULL)
        return INFINITY;
    double least = INFINITY;
    char line[PATH_MAX];
    while (fgets(line, sizeof line, file) != NULL) {
        line[strcspn(line, "\n")] = '\0';
        char *controllers = strchr(line, ':');
        char *folder = controllers != NULL ? strchr(controllers + 1, ':') : NULL;
        if (folder == NULL)
            continue;
        *folder++ = '\0';
        if (strcmp(controllers + 1, "") == 0) {
            least = fmin(least, group_limit("/sys/fs/cgroup", folder, "memory.max"));
        } else if (strcmp(controllers + 1, "memory") == 0) {
            least =
                fmin(least, group_limit("/sys/fs/cgroup/memory", folder, "memory.limit_in_bytes"));
        }
    }
    (void)fclose(file);
    return least;
}

/* Returns the bytes of the machine or the limit of the process's control group, whichever is less;
 * 0 when neither can be read. */
static double memory_available(void) {
    long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
    double physical = pages > 0 && page > 0 ? (double)pages * (double)page : INFINITY;
    double least = fmin(physical, cgroup_limit());
    return isfinite(least) ? least : 0;
}

double kind_memory_limit(void) {
    static const double CASES = 0.9; /* the rest is the system's */
    return CASES * memory_available();
}

const struct job_kind *kind_find(const char *name) {
    for (size_t k = 0; JOB_KINDS[k] != NULL; k++)
        if (strcmp(JOB_KINDS[k]->name, name) == 0)
            return kind_of(JOB_KINDS[k]);
    return NULL;
}

static int read_study(struct study **out, const char *text, size_t size,
                      const struct study_reading *reading, struct fault_list *faults,
                      struct error *err) {
    int status = study_read_ext(out, text, size, reading, faults, err);
    if (status == 0)
        (*out)->edition = kind_edition(kind_of((*out)->kind));
    return status;
}

int kind_read_study(struct study **out, const char *text, size_t size, const char *const *overrides,
                    struct fault_list *faults, struct error *err) {
    const struct study_reading reading = {
        .overrides = overrides, .kinds = JOB_KINDS, .memory_limit = kind_memory_limit()};
    return read_study(out, text, size, &reading, faults, err);
}

int kind_read_study_until(struct study **out, const char *text, size_t size,
                          int (*stop)(void *context), void *context, struct fault_list *faults,
                          struct error *err) {
    const struct study_reading reading = {.kinds = JOB_KINDS,
                                          .memory_limit = kind_memory_limit(),
                                          .stop = stop,
                                          .stop_context = context};
    return read_study(out, text, size, &reading, faults, err);
}
