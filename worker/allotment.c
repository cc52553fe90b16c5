#include "worker/allotment.h"

#include <ctype.h>
#include <sched.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PATH_MOST = 4096, LINE_MOST = 8192, PROCESSORS_MOST = 1 << 20 };

/* 0 is no limit. */
static unsigned least_of(unsigned a, unsigned b) {
    return a == 0 ? b : b == 0 || a < b ? a : b;
}

/* --- files of control groups --- */

/* Reads the first line of FOLDER/NAME, without its end. */
static bool read_line(const char *folder, const char *name, char *line, size_t size) {
    char path[PATH_MOST];
    int length = snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = length > 0 && (size_t)length < sizeof path ? fopen(path, "re") : NULL;
    if (file == NULL)
        return false;
    bool read = fgets(line, (int)size, file) != NULL;
    fclose(file);
    if (read)
        line[strcspn(line, "\n")] = '\0';
    return read;
}

/* Half a processor runs one thread, one and a half run two. */
static unsigned processors_of(double quota, double period) {
    double count = period > 0 ? quota / period : 0;
    if (!(count > 0) || count >= PROCESSORS_MOST)
        return 0;
    unsigned whole = (unsigned)count;
    return whole < count ? whole + 1 : whole;
}

/* Reads the quota of a group. cpu.max of version 2 holds "QUOTA PERIOD" or "max PERIOD"; version 1
 * has a file for each, and -1 for no quota. */
static unsigned quota_of(const char *folder) {
    char quota[64], period[64], *rest;
    if (read_line(folder, "cpu.max", quota, sizeof quota)) {
        double allowed = strtod(quota, &rest);
        return rest != quota ? processors_of(allowed, strtod(rest, NULL)) : 0;
    }
    if (!read_line(folder, "cpu.cfs_quota_us", quota, sizeof quota) ||
        !read_line(folder, "cpu.cfs_period_us", period, sizeof period))
        return 0;
    return processors_of(strtod(quota, NULL), strtod(period, NULL));
}

/* Returns the least quota of a group and of all above it, as far as they are mounted. */
static unsigned quota_upward(const char *mounted, const char *group) {
    char folder[PATH_MOST];
    size_t base = strlen(mounted);
    unsigned least = 0;
    int length = snprintf(folder, sizeof folder, "%s%s", mounted, group);
    if (length < 0 || (size_t)length >= sizeof folder)
        return 0;
    for (;;) {
        least = least_of(least, quota_of(folder));
        char *slash = strrchr(folder, '/');
        if (slash == NULL || slash < folder + base)
            return least;
        *slash = '\0';
    }
}

/* --- which groups the process is in, and where they are mounted --- */

/* Returns whether a list with commas between has this word. */
static bool has_word(const char *list, const char *word) {
    size_t size = strlen(word);
    for (const char *at = list; at != NULL; at = strchr(at, ',')) {
        at += *at == ',';
        if (strncmp(at, word, size) == 0 && (at[size] == ',' || at[size] == '\0'))
            return true;
    }
    return false;
}

/* Finds the process's group of the hierarchy that limits processors. "0::PATH" is that of version
 * 2, "N:cpu,cpuacct:PATH" one of version 1. */
static bool group_find(const char *root, bool unified, char *group, size_t size) {
    char path[PATH_MOST], line[LINE_MOST];
    bool found = false;
    snprintf(path, sizeof path, "%.1000s/proc/self/cgroup", root);
    FILE *file = fopen(path, "re");
    while (file != NULL && !found && fgets(line, sizeof line, file) != NULL) {
        line[strcspn(line, "\n")] = '\0';
        char *list = strchr(line, ':'), *at = list != NULL ? strchr(list + 1, ':') : NULL;
        if (at == NULL)
            continue;
        *list++ = *at++ = '\0';
        found = unified ? strcmp(line, "0") == 0 && *list == '\0' : has_word(list, "cpu");
        if (found)
            snprintf(group, size, "%s", strcmp(at, "/") == 0 ? "" : at);
    }
    if (file != NULL)
        fclose(file);
    return found;
}

/* Reads a line of mountinfo: ID PARENT DEVICE ROOT POINT OPTIONS [TAGS] - TYPE SOURCE OPTIONS.
 * Returns ROOT and POINT where it mounts the hierarchy that limits processors. */
static bool mount_read(char *line, bool *unified, char **top, char **point) {
    char *tail = strstr(line, " - "), *next = NULL;
    if (tail == NULL)
        return false;
    *tail = '\0';
    char *type = strtok_r(tail + 3, " \n", &next);
    (void)strtok_r(NULL, " \n", &next);
    const char *options = strtok_r(NULL, " \n", &next);
    bool first = type != NULL && strcmp(type, "cgroup") == 0;
    *unified = type != NULL && strcmp(type, "cgroup2") == 0;
    if (!*unified && !(first && options != NULL && has_word(options, "cpu")))
        return false;
    (void)strtok_r(line, " ", &next);
    for (int skipped = 0; skipped < 2; skipped++)
        (void)strtok_r(NULL, " ", &next);
    *top = strtok_r(NULL, " ", &next);
    *point = strtok_r(NULL, " ", &next);
    return *top != NULL && *point != NULL;
}

/* In a container the mount shows a part of the hierarchy, from its ROOT on. A group that is not
 * below it is one of another name space: then the top of the mount is the process's group. */
static unsigned quota_of_mount(const char *root, bool unified, const char *top, const char *point) {
    char group[PATH_MOST], mounted[PATH_MOST];
    if (!group_find(root, unified, group, sizeof group))
        return 0;
    size_t shown = strcmp(top, "/") == 0 ? 0 : strlen(top);
    const char *below = strncmp(group, top, shown) == 0 ? group + shown : "";
    if (*below != '/' || strstr(below, "/..") != NULL)
        below = "";
    int length = snprintf(mounted, sizeof mounted, "%s%s", root, point);
    return length > 0 && (size_t)length < sizeof mounted ? quota_upward(mounted, below) : 0;
}

unsigned allotment_of_groups(const char *root) {
    char path[PATH_MOST], line[LINE_MOST];
    unsigned least = 0;
    snprintf(path, sizeof path, "%.1000s/proc/self/mountinfo", root);
    FILE *file = fopen(path, "re");
    while (file != NULL && fgets(line, sizeof line, file) != NULL) {
        bool unified = false;
        char *top = NULL, *point = NULL;
        if (mount_read(line, &unified, &top, &point))
            least = least_of(least, quota_of_mount(root, unified, top, point));
    }
    if (file != NULL)
        fclose(file);
    return least;
}

/* --- Slurm and affinity --- */

static unsigned count_of(const char *text) {
    char *end;
    if (text == NULL || !isdigit((unsigned char)*text))
        return 0;
    unsigned long count = strtoul(text, &end, 10);
    return *end == '\0' && count < PROCESSORS_MOST ? (unsigned)count : 0;
}

unsigned allotment_of_slurm(const char *per_task, const char *on_node) {
    return least_of(count_of(per_task), count_of(on_node));
}

/* A mask of more processors than cpu_set_t holds needs a larger set. */
static unsigned allotment_of_affinity(void) {
    for (int most = 1024; most <= PROCESSORS_MOST; most *= 4) {
        cpu_set_t *set = CPU_ALLOC((size_t)most);
        if (set == NULL)
            return 0;
        size_t size = CPU_ALLOC_SIZE((size_t)most);
        CPU_ZERO_S(size, set);
        int count = sched_getaffinity(0, size, set) == 0 ? CPU_COUNT_S(size, set) : 0;
        CPU_FREE(set);
        if (count > 0)
            return (unsigned)count;
    }
    return 0;
}

unsigned allotment_threads(void) {
    unsigned least = least_of(allotment_of_affinity(), allotment_of_groups(""));
    least = least_of(
        least, allotment_of_slurm(getenv("SLURM_CPUS_PER_TASK"), getenv("SLURM_CPUS_ON_NODE")));
    return least > 0 ? least : 1;
}
