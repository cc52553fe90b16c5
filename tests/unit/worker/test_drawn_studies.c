/* Protects: what fuzzing draws of studies has every parameter of every kind, in studies that are
 * taken as in others. A quarter of what is drawn is taken: a fuzz target that draws nothing but
 * refused studies would test nothing behind the reader. */
#include "tests/support/check.h"

#include "jobs/kind.h"
#include "schema/json/json.h"
#include "schema/study/common.h"
#include "schema/study/study_reader.h"
#include "tests/support/fuzz/draw_study.h"
#include "tests/support/seed.h"
#include <string.h>

enum { BYTES = 256, DRAWN = 8000, KINDS_MOST = 4, ROWS_MOST = 200, CASES_MOST = 20 };

/* How often a row was in a study that was taken, and in one that was not. */
static size_t counts[KINDS_MOST][ROWS_MOST][2];

static int stop(void *context) {
    int *cases = context;
    return (*cases)++ >= CASES_MOST;
}

/* Reads a study; 0 also where there are more cases than are looked at. */
static int read_drawn(const char *text) {
    int cases = 0;
    const struct study_reading reading = {
        .kinds = JOB_KINDS, .memory_limit = 1e9, .stop = stop, .stop_context = &cases};
    struct fault_list faults = {0};
    struct study *study = NULL;
    struct error err = {0};
    int status = study_read_ext(&study, text, strlen(text), &reading, &faults, &err);
    study_destroy(&study);
    fault_list_clear(&faults);
    return status == ERROR_STOPPED ? 0 : status;
}

static void count_rows(const char *text, bool taken) {
    cJSON *document = cJSON_Parse(text);
    const char *name = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(document, "kind"));
    for (size_t k = 0; JOB_KINDS[k] != NULL && name != NULL; k++) {
        const struct parameter *row;
        if (strcmp(JOB_KINDS[k]->name, name) != 0)
            continue;
        for (size_t p = 0; (row = parameter_row(JOB_KINDS[k]->tables, p)) != NULL; p++)
            counts[k][p][taken] += json_at(document, row->path) != NULL;
    }
    cJSON_Delete(document);
}

static void every_parameter_is_drawn(void **state) {
    uint64_t seed = seed_or(1);
    size_t taken = 0;
    (void)state;
    for (size_t drawn = 0; drawn < DRAWN; drawn++) {
        uint8_t bytes[BYTES];
        for (size_t a = 0; a < BYTES; a++)
            bytes[a] = (uint8_t)next_word(&seed);
        char *text = draw_study(&(struct choices){bytes, BYTES}, JOB_KINDS);
        int status = read_drawn(text);
        assert_true(status == 0 || status == ERROR_INPUT);
        count_rows(text, status == 0);
        taken += status == 0;
        free(text);
    }
    print_message("%zu of %d drawn studies were taken\n", taken, DRAWN);
    assert_true(taken > DRAWN / 5 && taken < DRAWN * 3 / 4);
    for (size_t k = 0; JOB_KINDS[k] != NULL; k++) {
        const struct parameter *row;
        for (size_t p = 0; (row = parameter_row(JOB_KINDS[k]->tables, p)) != NULL; p++)
            if (counts[k][p][false] == 0 || counts[k][p][true] == 0)
                fail_msg("%s of %s: in %zu studies that were refused, %zu that were taken",
                         row->path, JOB_KINDS[k]->name, counts[k][p][false], counts[k][p][true]);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_parameter_is_drawn)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
