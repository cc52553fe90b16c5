#include "jobs/memory.h"

#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The number in a file of one number; INFINITY where there is none ("max", no such file). */
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

/* Smallest limit of a group and those above it. folder is the process's group below root ("/a/b")
 * and is cut short on the way up. */
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

double memory_available(void) {
    long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
    double physical = pages > 0 && page > 0 ? (double)pages * (double)page : INFINITY;
    double least = fmin(physical, cgroup_limit());
    return isfinite(least) ? least : 0;
}
