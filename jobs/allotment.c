#include "jobs/allotment.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <sched.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { PATH_MOST = 4096, LINE_MOST = 8192, PROCESSORS_MOST = 1 << 20 };

/* A resource that control groups limit, and the limit of the group of a folder; INFINITY: none. */
struct resource {
    const char *controller; /* of version 1 */
    double (*limit)(const char *folder);
};

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
static double processors_of(double quota, double period) {
    double count = period > 0 ? quota / period : 0;
    return count > 0 && count < PROCESSORS_MOST ? ceil(count) : INFINITY;
}

/* Reads the quota of a group. cpu.max of version 2 holds "QUOTA PERIOD" or "max PERIOD"; version 1
 * has a file for each, and -1 for no quota. */
static double quota_of(const char *folder) {
    char quota[64], period[64], *rest;
    if (read_line(folder, "cpu.max", quota, sizeof quota)) {
        double allowed = strtod(quota, &rest);
        return rest != quota ? processors_of(allowed, strtod(rest, NULL)) : INFINITY;
    }
    if (!read_line(folder, "cpu.cfs_quota_us", quota, sizeof quota) ||
        !read_line(folder, "cpu.cfs_period_us", period, sizeof period))
        return INFINITY;
    return processors_of(strtod(quota, NULL), strtod(period, NULL));
}

/* Reads the bytes that a group may have: "max" of version 2, and a number beyond all memory of
 * version 1, are no limit. */
static double bytes_of(const char *folder) {
    char text[64];
    if (!read_line(folder, "memory.max", text, sizeof text) &&
        !read_line(folder, "memory.limit_in_bytes", text, sizeof text))
        return INFINITY;
    double bytes = strtod(text, NULL);
    return bytes > 0 && bytes < 0x1p62 ? bytes : INFINITY;
}

/* Returns the least limit of a group and of all above it, as far as they are mounted. */
static double limit_upward(const struct resource *resource, const char *mounted,
                           const char *group) {
    char folder[PATH_MOST];
    size_t base = strlen(mounted);
    double least = INFINITY;
    int length = snprintf(folder, sizeof folder, "%s%s", mounted, group);
    if (length < 0 || (size_t)length >= sizeof folder)
        return least;
    for (;;) {
        least = fmin(least, resource->limit(folder));
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

/* Finds the process's group of the hierarchy that limits a resource. "0::PATH" is that of version
 * 2, "N:cpu,cpuacct:PATH" one of version 1. */
static bool group_find(const struct resource *resource, const char *root, bool unified, char *group,
                       size_t size) {
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
        found = unified ? strcmp(line, "0") == 0 && *list == '\0'
                        : has_word(list, resource->controller);
        if (found)
            snprintf(group, size, "%s", strcmp(at, "/") == 0 ? "" : at);
    }
    if (file != NULL)
        fclose(file);
    return found;
}

/* Reads a line of mountinfo: ID PARENT DEVICE ROOT POINT OPTIONS [TAGS] - TYPE SOURCE OPTIONS.
 * Returns ROOT and POINT where it mounts the hierarchy that limits a resource. */
static bool mount_read(const struct resource *resource, char *line, bool *unified, char **top,
                       char **point) {
    char *tail = strstr(line, " - "), *next = NULL;
    if (tail == NULL)
        return false;
    *tail = '\0';
    char *type = strtok_r(tail + 3, " \n", &next);
    (void)strtok_r(NULL, " \n", &next);
    const char *options = strtok_r(NULL, " \n", &next);
    bool first = type != NULL && strcmp(type, "cgroup") == 0;
    *unified = type != NULL && strcmp(type, "cgroup2") == 0;
    if (!*unified && !(first && options != NULL && has_word(options, resource->controller)))
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
static double limit_of_mount(const struct resource *resource, const char *root, bool unified,
                             const char *top, const char *point) {
    char group[PATH_MOST], mounted[PATH_MOST];
    if (!group_find(resource, root, unified, group, sizeof group))
        return INFINITY;
    size_t shown = strcmp(top, "/") == 0 ? 0 : strlen(top);
    const char *below = strncmp(group, top, shown) == 0 ? group + shown : "";
    if (*below != '/' || strstr(below, "/..") != NULL)
        below = "";
    int length = snprintf(mounted, sizeof mounted, "%s%s", root, point);
    return length > 0 && (size_t)length < sizeof mounted ? limit_upward(resource, mounted, below)
                                                         : INFINITY;
}

static double limit_of_groups(const struct resource *resource, const char *root) {
    char path[PATH_MOST], line[LINE_MOST];
    double least = INFINITY;
    snprintf(path, sizeof path, "%.1000s/proc/self/mountinfo", root);
    FILE *file = fopen(path, "re");
    while (file != NULL && fgets(line, sizeof line, file) != NULL) {
        bool unified = false;
        char *top = NULL, *point = NULL;
        if (mount_read(resource, line, &unified, &top, &point))
            least = fmin(least, limit_of_mount(resource, root, unified, top, point));
    }
    if (file != NULL)
        fclose(file);
    return isfinite(least) ? least : 0;
}

unsigned allotment_of_groups(const char *root) {
    static const struct resource PROCESSORS = {"cpu", quota_of};
    return (unsigned)limit_of_groups(&PROCESSORS, root);
}

double allotment_memory_of_groups(const char *root) {
    static const struct resource MEMORY = {"memory", bytes_of};
    return limit_of_groups(&MEMORY, root);
}

/* --- Slurm, affinity and the machine --- */

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

double allotment_memory_of_slurm(const char *per_node, const char *per_cpu, const char *on_node) {
    double node = per_node != NULL ? strtod(per_node, NULL) : 0;
    double cpu = per_cpu != NULL ? strtod(per_cpu, NULL) : 0;
    double mebibytes = node > 0 ? node : cpu > 0 ? cpu * count_of(on_node) : 0;
    return isfinite(mebibytes) ? 0x1p20 * mebibytes : 0;
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

double allotment_memory(void) {
    long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
    const double limits[] = {
        pages > 0 && page > 0 ? (double)pages * (double)page : 0,
        allotment_memory_of_groups(""),
        allotment_memory_of_slurm(getenv("SLURM_MEM_PER_NODE"), getenv("SLURM_MEM_PER_CPU"),
                                  getenv("SLURM_CPUS_ON_NODE")),
    };
    double least = INFINITY;
    for (size_t n = 0; n < sizeof limits / sizeof *limits; n++)
        if (limits[n] > 0)
            least = fmin(least, limits[n]);
    return isfinite(least) ? least : 0;
}

/* --- time --- */

/* Pilots ask for SIGTERM a minute before, and Slurm may send it a minute earlier still. */
enum { BEFORE_END_S = 120 };

int64_t allotment_seconds_of_slurm(const char *end, int64_t now_s) {
    char *rest;
    if (end == NULL || !isdigit((unsigned char)*end))
        return 0;
    errno = 0;
    long long end_s = strtoll(end, &rest, 10);
    if (*rest != '\0' || errno != 0)
        return 0;
    return end_s - BEFORE_END_S > now_s ? end_s - BEFORE_END_S - now_s : 1;
}

int64_t allotment_seconds(void) {
    enum { DAYS_MOST = 36500 };
    int64_t left_s = allotment_seconds_of_slurm(getenv("SLURM_JOB_END_TIME"), (int64_t)time(NULL));
    return left_s < 86400LL * DAYS_MOST ? left_s : 0;
}
