/* Protects: workers whose memory a control group limits run as many jobs at once as fit, where they
 * would be killed otherwise; a job that does not fit alone fails with the figures; and where one
 * fits alone, all threads share its realisations, with the same digits. The first two are skipped,
 * with a word, where no group can be made. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* About 46 MB a thread, as `rugo check` says. */
static const char STUDY[] =
    "{\"name\":\"large\",\"kind\":\"statistics\",\"realisations\":2,\"surface\":{"
    "\"hurst\":[0.3,0.5,0.7,0.8],\"wavelength_ratio\":32}}";

static char group[128];

/* Makes a group with so much memory, of version 2 or 1. */
static bool group_make(const char *parent, const char *limit, const char *bytes) {
    char path[192];
    snprintf(group, sizeof group, "%s/rugo-test-%ld", parent, (long)getpid());
    snprintf(path, sizeof path, "%s/%s", group, limit);
    FILE *file = mkdir(group, 0700) == 0 ? fopen(path, "r+") : NULL;
    bool made = file != NULL && fputs(bytes, file) >= 0;
    if (file != NULL && fclose(file) != 0)
        made = false;
    if (!made)
        (void)rmdir(group);
    return made;
}

static void limit_to(const char *bytes) {
    if (!group_make("/sys/fs/cgroup", "memory.max", bytes) &&
        !group_make("/sys/fs/cgroup/memory", "memory.limit_in_bytes", bytes)) {
        print_message("SKIP: no control group can be made here\n");
        skip();
    }
    setenv("GROUP", group, 1);
}

/* A group can be removed once its last process has gone. */
static void group_remove(void) {
    for (int tries = 0; rmdir(group) != 0 && errno == EBUSY && tries < 100; tries++)
        sleep_ms(20);
}

static void jobs_run_as_memory_allows(void **state) {
    (void)state;
    limit_to("110000000");
    spit("large.json", STUDY);
    int status = run_shell("sh -c 'echo $$ >$GROUP/cgroup.procs && exec $RUGO run --db large.db "
                           "--workers 4 large.json'");
    group_remove();
    assert_int_equal(status, 0);
}

static void a_job_that_does_not_fit_fails(void **state) {
    (void)state;
    struct process server;
    limit_to("45000000");
    unsigned port = serve_start(&server, (const char *[]){"--db", "small.db", NULL});
    char address[64];
    snprintf(address, sizeof address, "http://127.0.0.1:%u", port);
    setenv("RUGO_SERVER", address, 1);
    spit("large.json", STUDY);
    check_shell("$RUGO submit large.json");
    int status =
        run_shell("sh -c 'echo $$ >$GROUP/cgroup.procs && exec $RUGO work --drain --workers 1'");
    group_remove();
    assert_int_equal(status, 0);
    check_shell("$RUGO status large");
    assert_true(contains("shell.out", "of memory, and the jobs of this process may use 0.0405 GB"));
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 20), 0);
}

/* About 40 MiB a thread. */
static const char CONTACT[] =
    "{\"name\":\"shared\",\"kind\":\"contact\",\"realisations\":2,\"surface\":{"
    "\"dimension\":2,\"hurst\":0.8,\"wavelength_ratio\":16,\"length_ratio\":2,"
    "\"rms_slope\":0.1},\"contact\":{\"model\":\"halfspace\",\"pressures\":{\"values\":[0.1]}}}";

static void threads_share_what_fits_once(void **state) {
    (void)state;
    spit("shared.json", CONTACT);
    assert_int_equal(
        run_shell("run() { $RUGO run shared.json --workers 3 --log-level info --db $1.db --out $1 "
                  "&& grep -v '^#' $1/curves.csv >$1.csv; }; run many && "
                  "! grep -q 'share a realisation' shell.err && SLURM_MEM_PER_NODE=80 && "
                  "export SLURM_MEM_PER_NODE && run once && cmp many.csv once.csv"),
        0);
    assert_true(
        contains("shell.err", "3 threads share a realisation, since memory holds 1 at once"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(jobs_run_as_memory_allows),
        cmocka_unit_test(a_job_that_does_not_fit_fails),
        cmocka_unit_test(threads_share_what_fits_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
