/* Growth: what an operation takes in stores of more and more studies, and in a study of more and
 * more cases, with exponents fitted to it, beside a bare writer of SQLite in the same run. Needles
 * of a test kind are thrown, so that it is the store that is measured. RUGO_STUDIES=n: the most
 * studies, 10 000 by default. */
#include "server/command/access/api.h"
#include "server/show/table/contents.h"
#include "tests/support/growth.h"
#include "tests/support/needle_study.h"
#include "tests/support/queue_load.h"
#include "worker/publish/publish.h"
#include "worker/publish/verify.h"
#include <sqlite3.h>
#include <unistd.h>

#define LIST(KIND) KIND(NEEDLE_KIND)
JOB_KIND_TABLE(LIST)

enum { SIZES_MOST = 5, BATCH = 100, OWNERS = 10, WINDOW = 50, REPEATS = 9, DELETED = 20 };
static const char DATABASE[] = "growth.db", COPY[] = "copy.db";

/* What is timed; microseconds each, of one of what the name says. */
enum operation {
    SUBMIT,
    CLAIM,
    REPORT,
    PUBLISH,
    LIST_DONE,
    LIST_QUEUED,
    STATUS,
    CONTENTS,
    DELETE,
    SNAPSHOT,
    VERIFY,
    BARE,
    OPERATIONS
};
static const char *const NAMES[] = {"submit, a study",
                                    "claim, a job",
                                    "report, a job",
                                    "publish, a case",
                                    "list of 50 that are done",
                                    "list of 50 that wait",
                                    "status of a study that waits",
                                    "contents of a study",
                                    "delete and purge, a study",
                                    "snapshot, a study",
                                    "verify, a study",
                                    "bare SQLite writer, a row"};

struct growth {
    unsigned studies, cases;
    struct store *store;
    struct study *study;
    char done[STUDY_ID_SIZE], waits[STUDY_ID_SIZE], window[STUDY_ID_SIZE];
    double us[OPERATIONS];
};

/* Submits studies one at a time, as many owners do. */
static int submit_all(struct growth *growth, struct error *err) {
    static char *const WHO[OWNERS] = {"a", "b", "c", "d", "e", "f", "g", "h", "i", "j"};
    char id[STUDY_ID_SIZE];
    int status = 0;
    double start = seconds();
    for (unsigned n = 0; status == 0 && n < growth->studies; n++) {
        growth->study->owner = WHO[n % OWNERS]; /* lent to it */
        growth->study->priority = n / OWNERS % 3;
        cJSON *throws = cJSON_GetObjectItemCaseSensitive(
            cJSON_GetObjectItemCaseSensitive(growth->study->cases[0].parameters, "needle"),
            "throws");
        cJSON_SetNumberValue(throws,
                             growth->studies > 1 ? 10 + n % 5000 : 10); /* few are the same */
        if (n % BATCH == 0)
            status = store_begin(growth->store, err);
        if (status == 0)
            status = store_submit(growth->store, growth->study, NULL, id, NULL, err);
        if (status == 0 && (n % BATCH == BATCH - 1 || n == growth->studies - 1))
            status = store_commit(growth->store, err);
    }
    growth->study->owner = NULL;
    growth->us[SUBMIT] = 1e6 * (seconds() - start) / growth->studies;
    return status;
}

static int run_one(const struct claimed_job *job, struct block_result *out, struct error *err) {
    struct job_runner *runner = NULL;
    int status =
        runner_create(&runner, &NEEDLE_KIND, job->parameters, NULL, job->seed, job->sequence, err);
    if (status == 0)
        status = runner_run(runner, job->first, job->count, NULL, out, err);
    if (runner != NULL)
        runner_destroy(&runner);
    return status;
}

/* Claims, runs and completes a batch of jobs. */
static int run_batch(struct growth *growth, size_t wanted, struct error *err) {
    const struct claim claim = {.worker = "bench", .host = "bench", .count = 1};
    struct claimed_job jobs[BATCH] = {0};
    struct block_result results[BATCH] = {0};
    size_t count = 0, found = 0;
    bool first, done;
    double start = seconds();
    int status = store_begin(growth->store, err);
    for (; status == 0 && count<wanted; count += found> 0) {
        status = store_claim(growth->store, &claim, &jobs[count], &found, err);
        if (status == 0 && found == 0)
            status = error_set(err, ERROR_ABSENT, "no job waits");
    }
    if (status == 0)
        status = store_commit(growth->store, err);
    growth->us[CLAIM] += 1e6 * (seconds() - start);
    for (size_t n = 0; status == 0 && n < count; n++)
        status = run_one(&jobs[n], &results[n], err);
    start = seconds();
    if (status == 0)
        status = store_begin(growth->store, err);
    for (size_t n = 0; status == 0 && n < count; n++)
        status = store_complete(growth->store, jobs[n].id, jobs[n].token, &results[n], &first,
                                &done, err);
    if (status == 0)
        status = store_commit(growth->store, err);
    growth->us[REPORT] += 1e6 * (seconds() - start);
    snprintf(growth->done, sizeof growth->done, "%s", jobs[0].study);
    for (size_t n = 0; n < count; n++) {
        block_result_clear(&results[n]);
        claimed_job_clear(&jobs[n]);
    }
    return status;
}

static int run_jobs(struct growth *growth, size_t jobs, struct error *err) {
    int status = 0;
    for (size_t n = 0; status == 0 && n < jobs; n += BATCH) {
        status = run_batch(growth, jobs - n < BATCH ? jobs - n : BATCH, err);
        double start = seconds();
        if (status == 0)
            status = publish_due(growth->store, NULL, NULL, NULL, err);
        growth->us[PUBLISH] += 1e6 * (seconds() - start) / (double)jobs;
    }
    growth->us[CLAIM] /= (double)jobs;
    growth->us[REPORT] /= (double)jobs;
    return status;
}

/* Finds a study that waits, and where a list of such begins. */
static int find_waiting(struct growth *growth, struct error *err) {
    struct study_status *list = NULL;
    size_t count = 0;
    char after[STUDY_ID_SIZE] = "";
    int status = 0;
    do {
        status = store_list(growth->store, after, WINDOW, &list, &count, err);
        for (size_t n = 0; status == 0 && n < count; n++) {
            if (list[n].place > 0)
                snprintf(growth->waits, STUDY_ID_SIZE, "%s", list[n].id);
            if (list[n].place > 0)
                snprintf(growth->window, STUDY_ID_SIZE, "%s", after);
            snprintf(after, sizeof after, "%s", list[n].id);
            study_status_clear(&list[n]);
        }
        free(list);
        list = NULL;
    } while (status == 0 && count == WINDOW && growth->waits[0] == '\0');
    return status;
}

static int ask(struct growth *growth, enum operation what, struct error *err) {
    cJSON *document = NULL;
    struct store *store = growth->store;
    int status = what == LIST_DONE     ? api_list(store, "", WINDOW, &document, err)
                 : what == LIST_QUEUED ? api_list(store, growth->window, WINDOW, &document, err)
                 : what == STATUS      ? api_status(store, growth->waits, &document, err)
                                       : contents_document(store, growth->done, &document, err);
    cJSON_Delete(document);
    return status;
}

/* Medians of repeated questions, with a change of the store in between. */
static int ask_all(struct growth *growth, struct error *err) {
    int status = find_waiting(growth, err);
    for (int what = LIST_DONE; status == 0 && what <= CONTENTS; what++) {
        double us[REPEATS] = {0};
        if (what == STATUS && growth->waits[0] == '\0')
            continue;
        for (int r = 0; status == 0 && r < REPEATS; r++) {
            status = store_probe(growth->store, err);
            double start = seconds();
            if (status == 0)
                status = ask(growth, (enum operation)what, err);
            us[r] = 1e6 * (seconds() - start);
        }
        qsort(us, REPEATS, sizeof *us, by_value);
        growth->us[what] = us[REPEATS / 2];
    }
    return status;
}

static int delete_some(struct growth *growth, struct error *err) {
    struct study_status *list = NULL;
    size_t count = 0;
    int status = store_list(growth->store, "", DELETED, &list, &count, err);
    size_t deleted = 0;
    double start = seconds();
    for (size_t n = 0; status == 0 && n < count; n++)
        if (strcmp(list[n].state, "done") == 0) {
            status = store_delete(growth->store, list[n].id, err);
            deleted++;
        }
    if (status == 0)
        status = store_purge(growth->store, NULL, NULL, err);
    growth->us[DELETE] = deleted > 0 ? 1e6 * (seconds() - start) / (double)deleted : 0;
    for (size_t n = 0; n < count; n++)
        study_status_clear(&list[n]);
    free(list);
    return status;
}

static int no_flaw(void *context, const struct flaw *flaw, struct error *err) {
    (void)context;
    return error_set(err, ERROR_INPUT, "a flaw: %s", flaw->text);
}

static int upkeep(struct growth *growth, struct error *err) {
    const struct verification verification = {.found = no_flaw};
    struct verify_report report = {0};
    double start = seconds();
    int status = store_snapshot(growth->store, COPY, NULL, NULL, err);
    growth->us[SNAPSHOT] = 1e6 * (seconds() - start) / growth->studies;
    start = seconds();
    if (status == 0)
        status = verify_store(growth->store, &verification, false, &report, err);
    growth->us[VERIFY] = 1e6 * (seconds() - start) / growth->studies;
    return status;
}

/* Inserts as many rows of 200 bytes into a table with an index, BATCH a commit. */
static int write_bare(struct growth *growth, size_t rows, struct error *err) {
    sqlite3 *db = NULL;
    sqlite3_stmt *insert = NULL;
    const char *begin =
        "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; CREATE TABLE t (id INTEGER PRIMARY "
        "KEY, k INTEGER, v TEXT); CREATE INDEX i ON t(k)";
    double start = seconds();
    int code = sqlite3_open("bare.db", &db);
    code = code != 0 ? code : sqlite3_exec(db, begin, NULL, NULL, NULL);
    code =
        code != 0
            ? code
            : sqlite3_prepare_v2(db, "INSERT INTO t (k, v) VALUES (random(), hex(zeroblob(100)))",
                                 -1, &insert, NULL);
    for (size_t n = 0; code == 0 && n < rows; n++) {
        if (n % BATCH == 0)
            code = sqlite3_exec(db, "BEGIN IMMEDIATE", NULL, NULL, NULL);
        code = code == 0 && sqlite3_step(insert) == SQLITE_DONE ? sqlite3_reset(insert) : 1;
        if (code == 0 && (n % BATCH == BATCH - 1 || n == rows - 1))
            code = sqlite3_exec(db, "COMMIT", NULL, NULL, NULL);
    }
    growth->us[BARE] = 1e6 * (seconds() - start) / (double)rows;
    sqlite3_finalize(insert);
    sqlite3_close(db);
    unlink("bare.db");
    return code == 0 ? 0 : error_set(err, ERROR_SYSTEM, "the bare writer failed");
}

/* Nine tenths of the jobs are done before the store is asked; of a single study all of them. */
static int measure(struct growth *growth, struct error *err) {
    size_t jobs = growth->studies > 1 ? growth->studies * 9 / 10 : growth->cases;
    growth->study = needle_study(growth->cases, 1, err);
    int status = growth->study != NULL ? 0 : ERROR_MEMORY;
    if (status == 0)
        status = store_open(&growth->store, DATABASE, NULL, err);
    if (status == 0)
        status = submit_all(growth, err);
    if (status == 0)
        status = run_jobs(growth, jobs, err);
    if (status == 0)
        status = ask_all(growth, err);
    if (status == 0)
        status = delete_some(growth, err);
    if (status == 0)
        status = upkeep(growth, err);
    if (status == 0)
        status = write_bare(growth, jobs, err);
    store_close(&growth->store);
    study_destroy(&growth->study);
    unlink(DATABASE);
    unlink(COPY);
    return status;
}

static void print_table(const char *title, const struct growth *all, const double *sizes,
                        size_t count) {
    growth_print_head(title, sizes, count, "");
    for (int what = 0; what < OPERATIONS; what++) {
        double us[SIZES_MOST] = {0};
        for (size_t n = 0; n < count; n++)
            us[n] = all[n].us[what];
        if (!(us[0] > 0))
            continue;
        growth_print_row(NAMES[what], sizes, us, count);
        printf("\n");
    }
    fflush(stdout);
}

static int bench(bool of_cases, unsigned most, struct error *err) {
    struct growth all[SIZES_MOST] = {0};
    double sizes[SIZES_MOST];
    size_t count = 0;
    int status = 0;
    for (unsigned size = 100; status == 0 && size <= most && count < SIZES_MOST; size *= 10) {
        all[count].studies = of_cases ? 1 : size;
        all[count].cases = of_cases ? size : 1;
        sizes[count] = size;
        status = measure(&all[count++], err);
    }
    if (status == 0)
        print_table(of_cases ? "cases of one study" : "studies", all, sizes, count);
    return status;
}

int main(void) {
    struct error err = {0};
    const char *most = getenv("RUGO_STUDIES");
    int status = bench(false, most != NULL ? (unsigned)strtoul(most, NULL, 10) : 10000, &err);
    if (status == 0)
        status = bench(true, 10000, &err);
    if (status != 0)
        fprintf(stderr, "bench_growth: %s\n", err.text);
    return status != 0;
}
