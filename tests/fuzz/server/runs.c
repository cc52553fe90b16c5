/* Studies that are drawn and taken run whole: each case ends with curves, or says why it has none,
 * and no result of one's own is refused. Those that are thought to take long are left out. */
#include "core/file/memory_file.h"
#include "jobs/runner.h"
#include "schema/result/csv.h"
#include "schema/result/result_json.h"
#include "schema/study/study_reader.h"
#include "server/show/summary/plan.h"
#include "server/show/summary/summary.h"
#include "tests/support/fuzz/draw_study.h"
#include "tests/support/fuzz/fuzz.h"
#include "worker/checker.h"
#include "worker/log.h"
#include "worker/publish/aggregate.h"
#include "worker/publish/publish.h"
#include <math.h>
#include <unistd.h>

static const double SECONDS_MOST = 0.1, MEMORY = 5e8;
enum { CASES_MOST = 8, JOBS_MOST = 8, ROUNDS_MOST = 400, STUDIES_A_STORE = 500 };

static struct store *store;
static struct checker *checker;

static int stop(void *context) {
    int *cases = context;
    return (*cases)++ >= CASES_MOST;
}

/* In the folder of the run, which is the caller's to clear. */
static void open_store(void) {
    static unsigned studies;
    struct error err = {0};
    if (store != NULL && ++studies % STUDIES_A_STORE != 0)
        return;
    store_close(&store);
    checker_destroy(&checker);
    unlink("runs.db");
    unlink("runs.db-wal");
    unlink("runs.db-shm");
    log_set_least(LEVEL_ERROR);
    MUST(store_open(&store, "runs.db", NULL, &err) == 0);
    MUST(checker_create(&checker, &err) == 0);
}

/* Draws a study and reads it; NULL where it is refused, or would take long. */
static struct study *read_study(struct choices *choices) {
    /* What a target takes is not known beforehand. */
    static const char *const SHORT[] = {"target.max_seconds=0.1", NULL};
    char *text = draw_study(choices, JOB_KINDS);
    int cases = 0;
    const struct study_reading reading = {.overrides =
                                              strstr(text, "\"target\"") != NULL ? SHORT : NULL,
                                          .kinds = JOB_KINDS,
                                          .memory_limit = MEMORY,
                                          .stop = stop,
                                          .stop_context = &cases};
    struct fault_list faults = {0};
    struct study *study = NULL;
    struct error err = {0};
    int status = study_read_ext(&study, text, strlen(text), &reading, &faults, &err);
    fault_list_clear(&faults);
    free(text);
    if (status == 0 && !(plan_seconds(study) <= SECONDS_MOST))
        study_destroy(&study);
    return study;
}

/* One's own result is one of the job's case, whatever came out. */
static int run_job(const struct claimed_job *job, struct block_result *result, struct error *err) {
    struct job_runner *runner = NULL;
    int status = runner_create(&runner, kind_find(job->kind), job->parameters, NULL, job->seed,
                               job->sequence, err);
    if (status == 0)
        status = runner_run(runner, job->first, job->count, NULL, result, err);
    runner_destroy(&runner);
    if (status == 0)
        MUST(checker_check(checker, job, result, err) == 0);
    return status;
}

static void do_job(const struct claimed_job *job) {
    struct block_result result = {0};
    struct error err = {0};
    bool first, done;
    int status = run_job(job, &result, &err);
    if (status == 0) {
        MUST(store_complete(store, job->id, job->token, &result, &first, &done, &err) == 0);
    } else {
        /* A reason that a reader can act on; the program's own errors are none. */
        MUST(*err.text != '\0' && status != ERROR_STATE);
        MUST(store_fail(store, job->id, job->token, err.text, true, &err) == 0);
    }
    block_result_clear(&result);
}

/* Runs and publishes until nothing is left, round after round of targets. */
static void run_all(const char *id) {
    const struct claim claim = {.worker = "runs", .host = "runs", .study = id, .count = JOBS_MOST};
    struct error err = {0};
    size_t count = 1;
    for (unsigned round = 0; round < ROUNDS_MOST && count > 0; round++) {
        struct claimed_job jobs[JOBS_MOST] = {0};
        MUST(store_claim(store, &claim, jobs, &count, &err) == 0);
        for (size_t j = 0; j < count; j++) {
            do_job(&jobs[j]);
            claimed_job_clear(&jobs[j]);
        }
        bool waits = false;
        if (count == 0)
            MUST(publish_due(store, NULL, NULL, NULL, &err) == 0 &&
                 store_jobs_wait(store, &waits, &err) == 0);
        count += waits;
    }
}

static void check_case(const struct case_result *one) {
    if (one->error != NULL) {
        MUST(*one->error != '\0');
        return;
    }
    MUST(one->curve_count > 0 && one->scalar_count > 0);
    for (size_t a = 0; a < one->curve_count; a++) {
        const struct curve *curve = &one->curves[a];
        for (size_t k = 0; k < curve->n; k++)
            MUST(isfinite(curve->x[k]));
        for (size_t k = 0; k < curve_value_count(curve); k++)
            MUST(!isinf(curve->y[k]) && !isinf(curve->standard_error[k]));
    }
    for (size_t n = 0; n < one->note_count; n++)
        MUST(*one->notes[n].text != '\0');
}

/* What people are shown of it can be made. */
static void show(const struct study_result *study, const struct study_report *report) {
    struct memory_file memory;
    cJSON *document = NULL;
    size_t size = 0;
    MUST(memory_file_open(&memory));
    MUST(study_print(memory.file, study));
    char *text = memory_file_close(&memory, &size);
    MUST(text != NULL && json_parse(text, size, NULL, &document, &(struct error){0}) == 0);
    cJSON_Delete(document);
    free(text);
    MUST(memory_file_open(&memory));
    MUST(csv_print(memory.file, study));
    summary_of_curves(study, report, memory.file);
    text = memory_file_close(&memory, &size);
    MUST(text != NULL && size > 0);
    free(text);
}

static void check_end(const char *id, bool shown) {
    const struct result_filter filter = {.case_number = -1, .complete = shown};
    struct study_status now = {0};
    struct study_result study = {0};
    struct study_report report = {0};
    struct valueless valueless = {0};
    struct error err = {0};
    MUST(store_status(store, id, &now, &err) == 0);
    MUST(strcmp(now.state, "done") == 0 || strcmp(now.state, "failed") == 0);
    MUST(aggregate_study(store, id, &filter, &study, &err) == 0 || *err.text != '\0');
    MUST(aggregate_report(store, id, &report, &err) == 0);
    if (strcmp(now.state, "done") == 0) {
        for (size_t c = 0; c < study.case_count; c++)
            check_case(&study.cases[c]);
        MUST(store_valueless(store, id, &valueless, &err) == 0);
        MUST(valueless.cases == 0 || *valueless.note != '\0');
        valueless_clear(&valueless);
    }
    if (shown && study.case_count > 0)
        show(&study, &report);
    study_result_clear(&study);
    study_report_clear(&report);
    study_status_clear(&now);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct choices choices = {data, size};
    char id[STUDY_ID_SIZE];
    struct error err = {0};
    bool existing = false;
    struct study *study = read_study(&choices);
    if (study == NULL)
        return 0;
    open_store();
    MUST(store_submit(store, study, NULL, id, &existing, &err) == 0);
    study_destroy(&study);
    run_all(id);
    check_end(id, choose_rarely(&choices, 4));
    MUST(store_delete(store, id, &err) == 0);
    return 0;
}
