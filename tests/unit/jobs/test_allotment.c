/* A worker's threads, memory and time by its allotment: limits of control groups of both versions,
 * on trees made here, and what Slurm says. */
#include "jobs/allotment.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

/* Makes the file and the folders above it. */
static void put(const char *path, const char *text) {
    char folder[256];
    snprintf(folder, sizeof folder, "%s", path);
    for (char *at = strchr(folder, '/'); at != NULL; at = strchr(at + 1, '/')) {
        *at = '\0';
        (void)mkdir(folder, 0777);
        *at = '/';
    }
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

#define UNIFIED "31 23 0:28 / /sys/fs/cgroup rw,nosuid shared:9 - cgroup2 cgroup2 rw,nsdelegate\n"

static void version_two_by_its_groups(void **state) {
    (void)state;
    put("two/proc/self/mountinfo", "22 1 8:1 / / rw - ext4 /dev/sda1 rw\n" UNIFIED);
    put("two/proc/self/cgroup", "0::/slice/job/step\n");
    assert_int_equal(allotment_of_groups("two"), 0); /* nothing restricts */
    put("two/sys/fs/cgroup/slice/job/step/cpu.max", "max 100000\n");
    assert_int_equal(allotment_of_groups("two"), 0);
    put("two/sys/fs/cgroup/slice/cpu.max", "800000 100000\n");
    assert_int_equal(allotment_of_groups("two"), 8); /* of a group above */
    put("two/sys/fs/cgroup/slice/job/cpu.max", "150000 100000\n");
    assert_int_equal(allotment_of_groups("two"), 2); /* rounded up, and the least of all */
    put("two/sys/fs/cgroup/slice/job/step/cpu.max", "5000 100000\n");
    assert_int_equal(allotment_of_groups("two"), 1);
    put("two/sys/fs/cgroup/slice/job/step/cpu.max", "damaged\n");
    assert_int_equal(allotment_of_groups("two"), 2);
}

static void version_one_by_the_cpu_controller(void **state) {
    (void)state;
    put("one/proc/self/mountinfo",
        "32 31 0:29 / /sys/fs/cgroup/cpu,cpuacct rw - cgroup cgroup rw,cpu,cpuacct\n"
        "34 31 0:31 / /sys/fs/cgroup/cpuset rw - cgroup cgroup rw,cpuset\n");
    put("one/proc/self/cgroup", "5:cpuset:/other\n4:cpu,cpuacct:/job\n1:name=systemd:/job\n");
    put("one/sys/fs/cgroup/cpuset/other/cpu.cfs_quota_us", "100000\n"); /* of no meaning there */
    put("one/sys/fs/cgroup/cpuset/other/cpu.cfs_period_us", "100000\n");
    put("one/sys/fs/cgroup/cpu,cpuacct/job/cpu.cfs_quota_us", "-1\n");
    put("one/sys/fs/cgroup/cpu,cpuacct/job/cpu.cfs_period_us", "100000\n");
    assert_int_equal(allotment_of_groups("one"), 0);
    put("one/sys/fs/cgroup/cpu,cpuacct/job/cpu.cfs_quota_us", "300000\n");
    assert_int_equal(allotment_of_groups("one"), 3);
}

/* A container sees its own group as the top of what is mounted, by whichever name. */
static void a_container_by_what_is_mounted(void **state) {
    (void)state;
    put("box/proc/self/mountinfo",
        "41 31 0:38 /docker/abc /sys/fs/cgroup ro - cgroup2 cgroup rw\n");
    put("box/sys/fs/cgroup/cpu.max", "400000 100000\n");
    static const char *const groups[] = {"0::/docker/abc\n", "0::/\n", "0::/../other\n"};
    for (size_t n = 0; n < sizeof groups / sizeof *groups; n++) {
        put("box/proc/self/cgroup", groups[n]);
        assert_int_equal(allotment_of_groups("box"), 4);
    }
    put("box/proc/self/cgroup", "0::/docker/abc/inner\n");
    put("box/sys/fs/cgroup/inner/cpu.max", "100000 100000\n");
    assert_int_equal(allotment_of_groups("box"), 1);
}

static void memory_by_groups_of_both_versions(void **state) {
    (void)state;
    put("memory/proc/self/mountinfo", UNIFIED);
    put("memory/proc/self/cgroup", "0::/slice/job\n");
    assert_true(allotment_memory_of_groups("memory") == 0);
    put("memory/sys/fs/cgroup/slice/job/memory.max", "max\n");
    put("memory/sys/fs/cgroup/slice/memory.max", "4000000000\n");
    assert_true(allotment_memory_of_groups("memory") == 4e9);
    put("memory/sys/fs/cgroup/slice/job/memory.max", "3000000000\n");
    assert_true(allotment_memory_of_groups("memory") == 3e9);
    put("first/proc/self/mountinfo",
        "33 31 0:30 /docker/abc /sys/fs/cgroup/memory rw - cgroup cgroup rw,memory\n");
    put("first/proc/self/cgroup", "5:memory:/docker/abc/inner\n0::/\n");
    put("first/sys/fs/cgroup/memory/inner/memory.limit_in_bytes", "9223372036854771712\n");
    assert_true(allotment_memory_of_groups("first") == 0);
    put("first/sys/fs/cgroup/memory/memory.limit_in_bytes", "2000000000\n");
    assert_true(allotment_memory_of_groups("first") == 2e9);
}

static void nothing_mounted_restricts_nothing(void **state) {
    (void)state;
    assert_int_equal(allotment_of_groups("absent"), 0);
    put("none/proc/self/mountinfo", "damaged\n1 2 - cgroup2\n\n3 4 0:1 / - cgroup2 a b\n");
    put("none/proc/self/cgroup", "damaged\n::\n0:\n");
    assert_int_equal(allotment_of_groups("none"), 0);
}

static void slurm_by_task_and_node(void **state) {
    (void)state;
    assert_int_equal(allotment_of_slurm(NULL, NULL), 0);
    assert_int_equal(allotment_of_slurm("1", "16"), 1);
    assert_int_equal(allotment_of_slurm(NULL, "16"), 16);
    assert_int_equal(allotment_of_slurm("8", NULL), 8);
    assert_int_equal(allotment_of_slurm("0", "-3"), 0);
    assert_int_equal(allotment_of_slurm("4x", ""), 0);
    assert_int_equal(allotment_of_slurm("99999999999999999999", "2"), 2);
}

static void memory_of_slurm_by_node_and_processor(void **state) {
    (void)state;
    assert_true(allotment_memory_of_slurm(NULL, NULL, "4") == 0);
    assert_true(allotment_memory_of_slurm("4096", NULL, "4") == 0x1p32);
    assert_true(allotment_memory_of_slurm(NULL, "1024", "4") == 0x1p32);
    assert_true(allotment_memory_of_slurm(NULL, "1024", NULL) == 0); /* of how many? */
    assert_true(allotment_memory_of_slurm("0", "x", "2") == 0);      /* 0: all of the node's */
}

/* A pilot gets SIGTERM a minute before the end of its job, or a minute earlier still. */
static void time_of_slurm(void **state) {
    (void)state;
    assert_int_equal(allotment_seconds_of_slurm("1700003600", 1700000000), 3600 - 120);
    assert_int_equal(allotment_seconds_of_slurm("1700000060", 1700000000), 1);
    static const char *const NONE[] = {NULL, "", "UNLIMITED", "-1", "17e8", "99999999999999999999"};
    for (size_t n = 0; n < sizeof NONE / sizeof *NONE; n++)
        assert_int_equal(allotment_seconds_of_slurm(NONE[n], 1700000000), 0);
    unsetenv("SLURM_JOB_END_TIME");
    assert_int_equal(allotment_seconds(), 0);
    setenv("SLURM_JOB_END_TIME", "1", 1);
    assert_int_equal(allotment_seconds(), 1);
    unsetenv("SLURM_JOB_END_TIME");
}

static void the_least_holds(void **state) {
    (void)state;
    unsetenv("SLURM_CPUS_ON_NODE");
    unsetenv("SLURM_CPUS_PER_TASK");
    unsigned own = allotment_threads();
    assert_true(own >= 1 && own <= (unsigned)sysconf(_SC_NPROCESSORS_CONF));
    setenv("SLURM_CPUS_ON_NODE", "1", 1);
    assert_int_equal(allotment_threads(), 1);
    setenv("SLURM_CPUS_ON_NODE", "4096", 1);
    assert_int_equal(allotment_threads(), own);
    unsetenv("SLURM_CPUS_ON_NODE");
    double memory = allotment_memory();
    assert_true(memory > 0);
    setenv("SLURM_MEM_PER_NODE", "1", 1);
    assert_true(allotment_memory() == 0x1p20);
    unsetenv("SLURM_MEM_PER_NODE");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(version_two_by_its_groups),
        cmocka_unit_test(version_one_by_the_cpu_controller),
        cmocka_unit_test(a_container_by_what_is_mounted),
        cmocka_unit_test(memory_by_groups_of_both_versions),
        cmocka_unit_test(nothing_mounted_restricts_nothing),
        cmocka_unit_test(slurm_by_task_and_node),
        cmocka_unit_test(memory_of_slurm_by_node_and_processor),
        cmocka_unit_test(time_of_slurm),
        cmocka_unit_test(the_least_holds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
