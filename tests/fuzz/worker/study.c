/* Studies of the real kinds: one that is taken has cases of finite cost, and what is kept of it is
 * read as the same study; one that is refused says why. */
#include "jobs/kind.h"
#include "schema/study/study_reader.h"
#include "tests/support/fuzz/fuzz.h"
#include <math.h>

static const double MEMORY = 1e9; /* bytes: what a machine may have */

static int read_study(struct study **out, const char *text, size_t size, struct error *err) {
    struct fault_list faults = {0};
    int status = study_read(out, text, size, NULL, JOB_KINDS, MEMORY, &faults, err);
    MUST(status != 0 || faults.count == 0);
    fault_list_clear(&faults);
    return status;
}

static void check_study(const struct study *study) {
    struct study *again = NULL;
    struct error err = {0};
    MUST(study->case_count > 0 && study->case_count <= STUDY_CASES_MOST);
    for (size_t c = 0; c < study->case_count; c++) {
        const struct study_cost *cost = &study->cases[c].cost;
        MUST(cost->nx > 0 && cost->ny > 0 && study->cases[c].block > 0);
        MUST(isfinite(cost->seconds) && cost->seconds >= 0);
        MUST(cost->memory_bytes > 0 && cost->memory_bytes <= MEMORY);
        MUST(cost->relative_error >= 0);
    }
    MUST(read_study(&again, study->source, strlen(study->source), &err) == 0);
    MUST(again->case_count == study->case_count && again->seed == study->seed);
    MUST(strcmp(again->source, study->source) == 0);
    study_destroy(&again);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    char *text = text_of(data, size);
    struct study *study = NULL;
    struct error err = {0};
    int status = read_study(&study, text, size, &err);
    MUST(status == 0 || (status == ERROR_INPUT && *err.text != 0 && study == NULL));
    if (status == 0)
        check_study(study);
    study_destroy(&study);
    free(text);
    return 0;
}
