/* Every study in jobs/studies reads without a fault and opens into the cases its README promises.
 * What it draws or solves is not run here. */
#include "jobs/kind.h"
#include "schema/study/fault.h"
#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static struct study *study_of(const char *name) {
    const char *source = getenv("RUGO_SOURCE"); /* set by tests/run-tests */
    char path[4096], text[65536];
    struct fault_list faults = {0};
    struct error err = {0};
    struct study *study = NULL;
    snprintf(path, sizeof path, "%s/jobs/studies/%s.json", source != NULL ? source : ".", name);
    FILE *file = fopen(path, "rb");
    if (file == NULL)
        fail_msg("cannot open %s", path);
    size_t size = fread(text, 1, sizeof text, file);
    fclose(file);
    if (kind_read_study(&study, text, size, NULL, &faults, &err) != 0)
        fail_msg("%s: %s %s", name, err.text, faults.faults != NULL ? faults.faults[0].detail : "");
    fault_list_clear(&faults);
    return study;
}

/* How many files of studies the folder has. */
static size_t file_count(void) {
    const char *source = getenv("RUGO_SOURCE");
    char path[4096];
    size_t count = 0;
    snprintf(path, sizeof path, "%s/jobs/studies", source != NULL ? source : ".");
    DIR *folder = opendir(path);
    if (folder == NULL) {
        fail_msg("cannot open %s", path);
        return 0;
    }
    for (const struct dirent *file = readdir(folder); file != NULL; file = readdir(folder)) {
        const char *end = strrchr(file->d_name, '.');
        count += end != NULL && strcmp(end, ".json") == 0;
    }
    closedir(folder);
    return count;
}

static void ready_studies(void **state) {
    (void)state;
    static const struct {
        const char *name;
        size_t cases, largest; /* grid of the largest case */
        uint64_t realisations; /* 0: by a target of the error */
    } studies[] = {{"demo", 3, 512, 20},
                   {"contact-demo", 2, 256, 10},
                   {"mueser-challenge", 1, 4000, 4},
                   {"steel", 1, 256, 20},
                   {"weibull-asperities", 8, 512, 20},
                   {"rce-area", 3, 512, 0},
                   {"rce-shape", 12, 512, 0},
                   {"rce-mesh", 12, 2048, 20},
                   {"rce-gaussian-3d", 4, 1024, 20},
                   {"rce-weibull-2d", 60, 4096, 20},
                   {"rce-weibull-2d-500", 60, 4096, 500},
                   {"rce-weibull-3d", 24, 1024, 20},
                   {"gaussian-nayak", 5, 8192, 1000},
                   {"weibull-statistics", 20, 1024, 1000},
                   {"weibull-translation", 20, 1024, 1000},
                   {"nayak-hurst", 9, 2400, 1000},
                   {"nayak-hurst-continuous", 9, 2430, 1000},
                   {"nayak-hurst-small", 6, 1500, 200},
                   {"rce-weibull-2d-full", 20, 512, 20},
                   {"rce-slope", 6, 256, 20},
                   {"rce-3d-full", 2, 16, 10},
                   {"rce-friction", 12, 128, 20},
                   {"rce-length", 18, 2048, 2000},
                   {"rce-length-3d", 12, 256, 100},
                   {"rce-amplitudes", 6, 1024, 2000},
                   {"rce-block", 15, 512, 100}};
    assert_int_equal(file_count(), sizeof studies / sizeof *studies);
    for (size_t a = 0; a < sizeof studies / sizeof *studies; a++) {
        struct study *study = study_of(studies[a].name);
        double seconds = 0;
        size_t largest = 0;
        assert_string_equal(study->name, studies[a].name);
        assert_int_equal(study->case_count, studies[a].cases);
        assert_int_equal(study->realisations, studies[a].realisations);
        assert_true((study->cases[0].component_count > 0) == (studies[a].realisations == 0));
        for (size_t c = 0; c < study->case_count; c++) {
            const struct study_cost *cost = &study->cases[c].cost;
            seconds += cost->seconds * (double)study->realisations;
            largest = cost->nx > largest ? cost->nx : largest;
        }
        printf("%s: %.0f CPU seconds expected, largest grid %zu\n", studies[a].name, seconds,
               largest);
        assert_int_equal(largest, studies[a].largest);
        study_destroy(&study);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(ready_studies)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
