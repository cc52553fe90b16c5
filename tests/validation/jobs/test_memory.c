/* The memory that `check` states for a worker, without that of the program itself, is what a
 * realisation takes at its peak, or up to 15 % more: workers refuse cases by it. Each case runs in
 * a process of its own, whose largest resident set is measured, less that of a tiny case. */
#include "jobs/kind.h"
#include "jobs/runner.h"
#include "schema/study/fault.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

static const struct {
    const char *kind, *name, *parameters;
} CASES[] = {
    {"statistics", "Gaussian, 4096 x 4096",
     "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 64}}"},
    {"statistics", "Weibull, 2048 x 2048",
     "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 32,"
     " \"heights\": {\"distribution\": \"weibull_max\", \"shape\": 2, \"max_iterations\": 5}}}"},
    {"statistics", "Gaussian, refined, 2048 x 2048",
     "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 32},"
     " \"statistics\": {\"summits\": \"refined\"}}"},
    {"contact", "Weibull half-space of 512 x 512, longer surfaces beside it",
     "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 16, \"length_ratio\": 4,"
     " \"heights\": {\"distribution\": \"weibull_min\", \"shape\": 1}},"
     " \"contact\": {\"pressures\": {\"values\": [0.05]}}}"},
    {"contact", "half-space of 512 x 512",
     "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 8},"
     " \"contact\": {\"cell_error\": \"none\", \"pressures\": {\"values\": [0.1]}}}"},
    {"contact", "half-space of 512 x 512 without stiffness",
     "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 8},"
     " \"contact\": {\"cell_error\": \"none\", \"stiffness\": \"omitted\", \"pressures\": "
     "{\"values\": [0.1, 0.2]}}}"},
    {"contact", "layered, 512 x 512",
     "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 8},"
     " \"contact\": {\"cell_error\": \"none\", \"model\": \"layered\", \"pressures\": {\"values\": "
     "[0.1]}}}"},
    {"contact", "half-space, profile of 65536",
     "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 1024},"
     " \"contact\": {\"cell_error\": \"none\", \"pressures\": {\"values\": [0.1]}}}"},
    {"contact", "full, profile of 4096",
     "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 64,"
     " \"rms_slope\": 0.1}, \"contact\": {\"model\": \"full\","
     " \"pressures\": {\"values\": [0.05]}}}"},
    {"contact", "full, surface of 48 x 48",
     "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 2,"
     " \"points_per_wavelength\": 6, \"rms_slope\": 0.1}, \"contact\": {\"model\": \"full\","
     " \"layer_growth\": 1.3, \"pressures\": {\"values\": [0.1]}}}"},
};

static int run_one(const struct job_kind *kind, const cJSON *parameters) {
    struct job_runner *runner = NULL;
    struct block_result result = {0};
    int status = runner_create(&runner, kind, parameters, NULL, 1, 0, NULL);
    if (status == 0)
        status = runner_run(runner, 0, 1, NULL, &result, NULL);
    block_result_clear(&result);
    runner_destroy(&runner);
    return status == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

/* Returns the largest resident set of a process that runs the case. */
static double measured_bytes(const struct job_kind *kind, const cJSON *parameters) {
    struct rusage usage;
    int ended = 0;
    fflush(stdout);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0)
        _exit(run_one(kind, parameters));
    assert_int_equal(wait4(child, &ended, 0, &usage), child);
    assert_true(WIFEXITED(ended) && WEXITSTATUS(ended) == EXIT_SUCCESS);
    return 1024.0 * (double)usage.ru_maxrss;
}

/* Of 512 nodes, which take some kilobytes of their own. */
static double program_bytes(void) {
    cJSON *tiny =
        cJSON_Parse("{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 8},"
                    " \"contact\": {\"cell_error\": \"none\","
                    " \"pressures\": {\"values\": [0.1]}}}");
    double bytes = measured_bytes(kind_find("contact"), tiny);
    cJSON_Delete(tiny);
    return bytes;
}

/* Pages that the system gives at a time, and what a heap keeps of what was freed; pages of
 * libraries that a tiny case does not touch, up to 2.6 MB of the full model, are stated with the
 * program. */
static const double ROOM = 1e6, LIBRARIES = 4e6, UNSURE = 0.01, MOST = 1.15;

static void stated_memory(void **state) {
    (void)state;
    const double program = program_bytes();
    for (size_t a = 0; a < sizeof CASES / sizeof *CASES; a++) {
        const struct job_kind *kind = kind_find(CASES[a].kind);
        struct fault_list faults = {0};
        struct study_cost estimate = {0};
        cJSON *parameters = cJSON_Parse(CASES[a].parameters);
        assert_int_equal(kind_check(&kind->study, parameters, 0, &faults, &estimate, NULL), 0);
        assert_int_equal(faults.count, 0);
        double available = (double)sysconf(_SC_AVPHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
        if (available < 1.5 * estimate.memory_bytes) {
            printf("SKIP: %s needs %.0f MB\n", CASES[a].name, estimate.memory_bytes / 1e6);
            cJSON_Delete(parameters);
            skip();
        }
        double measured = measured_bytes(kind, parameters) - program;
        double stated = estimate.memory_bytes - PROCESS_BYTES;
        printf("%s: %.1f MB stated, %.1f MB measured\n", CASES[a].name, stated / 1e6,
               measured / 1e6);
        assert_true(measured <= (1 + UNSURE) * stated + LIBRARIES);
        assert_true(stated <= MOST * measured + ROOM);
        cJSON_Delete(parameters);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(stated_memory)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
