#include "server/command/study/local_study.h"
#include "jobs/kind.h"
#include "schema/result/view.h"
#include "server/command/command.h"
#include "server/show/output.h"
#include "server/show/summary/summary.h"
#include "worker/publish/aggregate.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Checks whose results the folder holds. */
static int check_folder(struct store *store, const struct result_folder *folder, const char *id,
                        struct error *err) {
    cJSON *document = NULL;
    if (folder->path == NULL)
        return 0;
    int status = store_document(store, id, &document, err);
    if (status == 0)
        status = result_folder_check(folder, id, document, err);
    cJSON_Delete(document);
    return status;
}

/* Queues a study, but not where its folder is another's. */
static int queue(struct store *store, const struct study *study, const char *key,
                 const struct result_folder *folder, char id[STUDY_ID_SIZE], struct error *err) {
    bool existing = false;
    int status = store_begin(store, err);
    if (status != 0)
        return status;
    status = store_submit(store, study, key, id, &existing, err);
    if (status == 0)
        status = check_folder(store, folder, id, err);
    if (status == 0)
        return store_commit(store, err);
    store_abandon(store);
    return status;
}

int local_study_submit(struct store **store, const struct local_submission *submission,
                       char id[STUDY_ID_SIZE], struct fault_list *faults, struct error *err) {
    char *key = NULL;
    struct study *study = NULL;
    int status = study_file_read(&study, submission->file, submission->overrides, faults, err);
    if (status == 0 && asprintf(&key, "run %s", study->source) < 0) {
        key = NULL;
        status = error_memory(err, strlen(study->source), "a study's key");
    }
    if (status == 0)
        status = store_open(store, submission->database, NULL, err);
    if (status == 0)
        status = queue(*store, study, key, &submission->folder, id, err);
    study_destroy(&study);
    free(key);
    return status;
}

static int check_end(const struct outcome *outcome, const struct study_status *now,
                     struct error *err) {
    struct failure *failures = NULL;
    size_t count = 0;
    if (strcmp(now->state, "cancelled") == 0)
        return error_set(err, ERROR_STATE, "study %s was cancelled; rugo retry --db %s %s goes on",
                         outcome->id, outcome->database, outcome->id);
    if (now->jobs_failed + now->cases_failed == 0)
        return 0;
    int status = store_failures(outcome->store, outcome->id, &failures, &count, err);
    const char *reason = count > 0 ? failures[count - 1].reason : "?"; /* jobs follow cases */
    if (status == 0 && now->jobs_failed > 0)
        status = error_set(err, ERROR_STATE,
                           "study %s: jobs failed: %llu (%.200s); rugo retry --db %s %s queues "
                           "them again",
                           outcome->id, (unsigned long long)now->jobs_failed, reason,
                           outcome->database, outcome->id);
    else if (status == 0)
        status =
            error_set(err, ERROR_STATE, "study %s: cases that cannot be published: %llu (%.300s)",
                      outcome->id, (unsigned long long)now->cases_failed, reason);
    failures_free(failures, count);
    return status;
}

/* What may pass, such as a full disk, leaves cases without rows in the store: that is not done. */
static int check_published(const struct outcome *outcome, const struct study_status *now,
                           struct error *err) {
    if (strcmp(now->state, "running") != 0 || now->jobs_waiting + now->jobs_running > 0)
        return 0;
    return error_set(err, ERROR_SYSTEM,
                     "study %s: cases are computed but not published (%.300s); the same command "
                     "tries again",
                     outcome->id,
                     outcome->published->postponed > 0 ? outcome->published->reason.text : "?");
}

/* A study without any value is no success, whatever became of its jobs. */
static int check_values(const struct outcome *outcome, const struct study_status *now,
                        struct error *err) {
    struct valueless valueless = {0};
    int status = store_valueless(outcome->store, outcome->id, &valueless, err);
    if (status == 0 && valueless.cases > 0 && valueless.cases == now->cases)
        status = error_set(err, ERROR_NUMERIC, "study %s: no realisation has a value: %.300s",
                           outcome->id, valueless.note);
    else if (status == 0 && valueless.cases > 0)
        fprintf(stderr,
                "rugo %s: no realisation has a value in %llu of %llu cases, such as case %llu: "
                "%.300s\n",
                outcome->command, (unsigned long long)valueless.cases,
                (unsigned long long)now->cases, (unsigned long long)valueless.first,
                valueless.note);
    valueless_clear(&valueless);
    return status;
}

/* Returns what the table needs: all curves only where files are written. */
static struct result_filter filter_of(const struct outcome *outcome, const char *kind) {
    const struct job_kind *found = kind_find(kind);
    const struct result_view *view = found != NULL ? found->view : NULL;
    const char *quantity = view != NULL && view->table != NULL ? view->table->quantity : NULL;
    if (outcome->folder.path != NULL)
        return (struct result_filter){.case_number = -1, .complete = true};
    return (struct result_filter){.case_number = -1,
                                  .part = {.quantity = quantity, .scalars_only = quantity == NULL}};
}

static int write_folder(const struct outcome *outcome, const struct study_result *study,
                        struct error *err) {
    cJSON *document = NULL;
    int status = store_document(outcome->store, outcome->id, &document, err);
    if (status == 0)
        status = result_folder_take(&outcome->folder, outcome->id, document, err);
    cJSON_Delete(document);
    return status == 0 ? output_write(study, outcome->folder.path, err) : status;
}

static int show_results(const struct outcome *outcome, const char *kind, struct error *err) {
    const struct result_filter filter = filter_of(outcome, kind);
    struct study_result study = {0};
    struct study_report report = {0};
    int status = aggregate_study(outcome->store, outcome->id, &filter, &study, err);
    if (status == 0)
        status = aggregate_report(outcome->store, outcome->id, &report, err);
    if (status == 0 && outcome->folder.path != NULL)
        status = write_folder(outcome, &study, err);
    if (status == 0) {
        summary_of_curves(&study, &report, stdout);
        status = output_flush(err);
    }
    study_result_clear(&study);
    study_report_clear(&report);
    return status;
}

int local_study_present(const struct outcome *outcome, struct error *err) {
    struct study_status now = {0};
    int status = store_status(outcome->store, outcome->id, &now, err);
    if (status != 0)
        return status;
    status = show_results(outcome, now.kind, err);
    if (status == 0 || now.cases_failed > 0) /* these are why it cannot be presented */
        status = check_end(outcome, &now, err);
    if (status == 0)
        status = check_published(outcome, &now, err);
    if (status == 0)
        status = check_values(outcome, &now, err);
    study_status_clear(&now);
    return status;
}
