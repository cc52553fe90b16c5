/* Protects: whichever allocation fails, in SQLite too, an operation of the store says so and is not
 * done by half; the handle goes on, and no result that was taken is lost. */
#include "tests/support/check.h"

#include "schema/store/store.h"
#include "schema/store/upkeep/store_verify.h"
#include "schema/study/study_reader.h"
#include "tests/support/failing/each_allocation.h"
#include "tests/support/failing/failing_allocator.h"
#include "tests/support/fake_kind.h"
#include "tests/support/store_files.h"
#include <fcntl.h>
#include <sqlite3.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char STUDY[] =
    "{\"name\":\"n\",\"kind\":\"boxes\",\"realisations\":20,\"seconds\":0.5,"
    "\"box\":{\"width\":1}}";

struct store_life {
    struct store *store;
    struct study *study;
    uint64_t taken; /* results that store_complete said to have */
};

static int open_and_close(void *context, struct error *err) {
    const char *path = context;
    struct store *store = NULL;
    int status = store_open(&store, path, &(struct store_options){0}, err);
    assert_true(status == 0 || store == NULL);
    store_close(&store);
    return status;
}

static int open_new(void *context, struct error *err) {
    int status = open_and_close(context, err);
    unlink(context);
    return status;
}

/* A file of an older program, which is migrated; copied without memory, as that is to fail. */
static int open_older(void *context, struct error *err) {
    char buffer[65536];
    int from = open(context, O_RDONLY), to = open("copy.db", O_WRONLY | O_CREAT | O_TRUNC, 0600);
    assert_true(from >= 0 && to >= 0);
    for (ssize_t got; (got = read(from, buffer, sizeof buffer)) > 0;)
        assert_int_equal(write(to, buffer, (size_t)got), got);
    close(from);
    close(to);
    char path[] = "copy.db";
    int status = open_and_close(path, err);
    remove_store(path);
    return status;
}

/* Makes a store of version 17 out of its text. */
static void make_older(const char *path) {
    enum { MOST = 1 << 20 };
    char name[512], *text = calloc(1, MOST);
    const char *source = getenv("RUGO_SOURCE");
    sqlite3 *db = NULL;
    snprintf(name, sizeof name, "%s/tests/fixtures/stores/version-17.sql",
             source != NULL ? source : ".");
    FILE *file = fopen(name, "rb");
    assert_true(file != NULL && text != NULL);
    assert_true(fread(text, 1, MOST - 1, file) < MOST - 1);
    fclose(file);
    assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
    assert_int_equal(sqlite3_exec(db, text, NULL, NULL, NULL), SQLITE_OK);
    sqlite3_close(db);
    free(text);
}

static int complete_jobs(struct store_life *life, struct claimed_job *jobs, size_t count,
                         struct error *err) {
    static const char *const NAMES[] = {"a"};
    static const unsigned char data[2 * PACKED_LEAST]; /* packed for the store */
    double scalars[20] = {1, NAN, 3};
    int status = 0;
    for (size_t n = 0; n < count && status == 0; n++) {
        struct block_result result = {.first = jobs[n].first,
                                      .count = jobs[n].count,
                                      .scalar_count = 1,
                                      .names = NAMES,
                                      .scalars = scalars,
                                      .data = data,
                                      .size = sizeof data,
                                      .seconds = 2};
        bool first = false, case_done = false;
        status = store_heartbeat(life->store, jobs[n].id, jobs[n].token, 1, err);
        if (status == 0)
            status = store_complete(life->store, jobs[n].id, jobs[n].token, &result, &first,
                                    &case_done, err);
        life->taken += status == 0 && first;
    }
    return status;
}

static int count_result(void *context, const struct block_result *result, struct error *err) {
    (void)err;
    *(uint64_t *)context += result->count;
    return 0;
}

static int look_at_published(struct store *store, const char *id, uint64_t revision,
                             struct error *err) {
    const struct published_part all = {0};
    struct case_result result = {0};
    struct case_report report = {0};
    bool found = false;
    int status = store_published(store, id, 0, revision, &all, &result, &found, err);
    if (status == 0) {
        assert_true(found && result.curve_count == 1 && result.curves[0].theories[0].y != NULL);
        status = store_published_report(store, id, 0, revision, &report, &found, err);
        assert_true(status != 0 || found);
    }
    result_clear(&result);
    case_report_clear(&report);
    return status;
}

static int look(struct store_life *life, const char *id, struct error *err) {
    struct study_status status = {0};
    struct case_info info = {0};
    struct case_cost cost;
    uint64_t seen = 0;
    int result = store_status(life->store, id, &status, err);
    if (result == 0)
        result = store_case(life->store, id, 0, &info, err);
    if (result == 0)
        result = store_cost(life->store, id, 0, &cost, err);
    if (result == 0)
        result = store_results(life->store, id, 0, count_result, &seen, err);
    if (result == 0)
        result = look_at_published(life->store, id, info.revision, err);
    if (result == 0) {
        assert_string_equal(status.state, "done");
        assert_int_equal(info.realisations_done, 20);
        assert_int_equal(seen, 20);
    }
    case_info_clear(&info);
    study_status_clear(&status);
    return result;
}

/* A curve whose bytes are packed, in one row of the views. */
static int publish_matrix(void *context, struct store *store, const struct due_case *due,
                          size_t number, struct error *err) {
    (void)number;
    static const double x[20], theory[400], y[1], error[1];
    static const uint32_t cells[1];
    struct case_result result = {.case_number = due->case_number, .realisations = 20};
    struct curve matrix = curve_named("joint", "z", "density");
    (void)context;
    curve_set_points(&matrix, 20, x, y, error);
    matrix.x2 = x;
    matrix.x2_label = "t";
    matrix.columns = 20;
    matrix.cells = cells;
    matrix.cell_count = 1;
    matrix.theories[matrix.theory_count++] = (struct theory){"nayak", theory};
    int status = result_add_curve(&result, &matrix, err);
    if (status == 0)
        status = store_publish(store, due->study, due->case_number, due->revision, &result, err);
    result_clear(&result);
    return status;
}

static int publish(struct store_life *life, struct error *err) {
    const struct publication publication = {.publish = publish_matrix};
    struct publish_counts counts;
    int status = store_publish_due(life->store, &publication, &counts, err);
    if (status == 0 && counts.postponed > 0) {
        *err = counts.reason;
        status = counts.reason.code;
    }
    return status;
}

/* A study from its submission to the publication of its case, on a handle that has seen failures.
 */
static int live(void *context, struct error *err) {
    struct store_life *life = context;
    char id[STUDY_ID_SIZE];
    struct claimed_job jobs[4] = {0};
    struct claim claim = {.worker = "w", .host = "h", .study = id, .count = 4};
    size_t count = 0;
    bool existing = false;
    int status = store_submit(life->store, life->study, NULL, id, &existing, err);
    if (status == 0)
        status = store_claim(life->store, &claim, jobs, &count, err);
    if (status == 0)
        status = complete_jobs(life, jobs, count, err);
    if (status == 0)
        status = publish(life, err);
    for (size_t n = 0; n < count; n++)
        claimed_job_clear(&jobs[n]);
    return status == 0 ? look(life, id, err) : status;
}

/* The other transitions of a job and a study. */
static int give_up(void *context, struct error *err) {
    struct store_life *life = context;
    char id[STUDY_ID_SIZE];
    struct claimed_job jobs[3] = {0};
    struct claim claim = {.worker = "w", .host = "h", .study = id, .count = 3};
    struct failure *failures = NULL;
    size_t count = 0, failed = 0;
    uint64_t again = 0;
    bool existing = false;
    int status = store_begin(life->store, err);
    if (status != 0)
        return status;
    status = store_submit(life->store, life->study, NULL, id, &existing, err);
    if (status == 0)
        status = store_claim(life->store, &claim, jobs, &count, err);
    for (size_t n = 0; n < count && status == 0; n++)
        status = store_fail(life->store, jobs[n].id, jobs[n].token, "no reason", true, err);
    if (status == 0)
        status = store_failures(life->store, id, &failures, &failed, err);
    if (status == 0)
        status = store_retry(life->store, id, 0, &again, err);
    if (status == 0)
        status = store_cancel(life->store, id, err);
    for (size_t n = 0; n < count; n++)
        claimed_job_clear(&jobs[n]);
    failures_free(failures, failed);
    struct error late = {0};
    int committed = store_commit(life->store, &late);
    if (status == 0 && committed != 0)
        *err = late;
    return status == 0 ? committed : status;
}

static int list(void *context, struct error *err) {
    struct store_life *life = context;
    struct study_status *statuses = NULL;
    struct store_metrics metrics;
    size_t count = 0;
    int status = store_list(life->store, "", 3, &statuses, &count, err);
    for (size_t n = 0; status == 0 && n < count; n++)
        study_status_clear(&statuses[n]);
    if (status == 0)
        free(statuses);
    return status == 0 ? store_metrics(life->store, &metrics, err) : status;
}

static int snapshot(void *context, struct error *err) {
    struct store_life *life = context;
    int status = store_snapshot(life->store, "snapshot.db", NULL, NULL, err);
    unlink("snapshot.db");
    return status;
}

static struct store_life life;

static int open_life(void **state) {
    struct fault_list faults = {0};
    struct error err = {0};
    (void)state;
    return store_open(&life.store, "life.db", &(struct store_options){0}, &err) != 0 ||
           study_read(&life.study, STUDY, strlen(STUDY), NULL, FAKE_KINDS, 0, &faults, &err) != 0;
}

static int close_life(void **state) {
    (void)state;
    study_destroy(&life.study);
    store_close(&life.store);
    return 0;
}

static void opening(void **state) {
    (void)state;
    char fresh[] = "new.db", old[] = "life.db", older[] = "older.db";
    make_older(older);
    each_allocation(
        &(struct failing_call){.name = "store, new", open_new, fresh, .may_succeed = 1});
    each_allocation(&(struct failing_call){.name = "store", open_and_close, old, .may_succeed = 1});
    each_allocation(
        &(struct failing_call){.name = "store, older", open_older, older, .may_succeed = 1});
}

static uint64_t jobs_done(void) {
    struct error err = {0};
    struct store_metrics metrics;
    struct store *store = NULL;
    assert_int_equal(store_open(&store, "life.db", &(struct store_options){0}, &err), 0);
    assert_int_equal(store_metrics(store, &metrics, &err), 0);
    store_close(&store);
    return metrics.jobs_done;
}

static void a_study(void **state) {
    (void)state;
    each_allocation(&(struct failing_call){.name = "study", live, &life, .may_succeed = 1});
    assert_true(life.taken > 0);
    assert_true(jobs_done() >= life.taken);
}

static void other_ways(void **state) {
    (void)state;
    each_allocation(
        &(struct failing_call){.name = "fail, retry, cancel", give_up, &life, .may_succeed = 1});
    each_allocation(&(struct failing_call){.name = "list", list, &life, .may_succeed = 1});
    each_allocation(&(struct failing_call){.name = "snapshot", snapshot, &life, .may_succeed = 1});
}

static int pass_over(void *context, const struct flaw *flaw, struct error *err) {
    (void)context, (void)flaw, (void)err;
    return 0;
}

struct damage {
    struct store *store;
    uint64_t flaws; /* 0: not counted yet */
};

/* A verification that ends well has found each flaw. */
static int verify(void *context, struct error *err) {
    struct damage *damage = context;
    const struct verification verification = {.found = pass_over};
    struct verify_counts counts = {0};
    int status = store_verify(damage->store, &verification, &counts, err);
    if (damage->flaws == 0)
        damage->flaws = counts.flaws;
    if (status == 0)
        assert_int_equal(counts.flaws, damage->flaws);
    return status;
}

/* A handle that has never undone a change lacks memory for it, too: a change of a batch stays
 * whole, or nothing of it. Other changes of the batch may be lost with it. */
static void a_batch_keeps_no_part_of_a_change(void **state) {
    (void)state;
    enum { SOME = 10, ALLOCATIONS_MOST = 4000 };
    uint64_t failures = 0;
    struct error err = {0};
    bool reached = false;
    assert_int_equal(open_and_close((char[]){"empty.db"}, &err), 0);
    for (uint64_t n = 0; n < ALLOCATIONS_MOST && !reached; n += SOME) {
        struct store_life batch = {.study = life.study};
        struct claimed_job jobs[4] = {0};
        char id[STUDY_ID_SIZE];
        struct claim claim = {.worker = "w", .host = "h", .study = id, .count = 4};
        struct damage damage = {0};
        size_t count = 0;
        bool existing = false;
        copy_file("empty.db", "batch.db");
        assert_int_equal(store_open(&batch.store, "batch.db", &(struct store_options){0}, &err), 0);
        assert_int_equal(store_submit(batch.store, batch.study, NULL, id, &existing, &err), 0);
        assert_int_equal(store_claim(batch.store, &claim, jobs, &count, &err), 0);
        assert_true(count > 1);
        assert_int_equal(store_begin(batch.store, &err), 0);
        failing_arm(n, SOME);
        (void)complete_jobs(&batch, jobs, count, &err);
        struct failing_count failed = failing_disarm();
        (void)store_commit(batch.store, &err);
        failures += failed.failed > 0;
        reached = failed.failed == 0;
        for (size_t j = 0; j < count; j++)
            claimed_job_clear(&jobs[j]);
        damage.store = batch.store;
        assert_int_equal(verify(&damage, &err), 0);
        assert_int_equal(damage.flaws, 0);
        store_close(&batch.store);
        remove_store("batch.db");
    }
    assert_true(reached && failures > 10);
}

static void verification_of_damage(void **state) {
    struct error err = {0};
    struct damage damage = {0};
    sqlite3 *db;
    (void)state;
    assert_int_equal(sqlite3_open("life.db", &db), SQLITE_OK);
    assert_int_equal(
        sqlite3_exec(db,
                     "UPDATE study_case SET seal = seal + 1 WHERE study_id IN (SELECT min(id) FROM "
                     "study);"
                     "UPDATE published SET rows_seal = 1 WHERE study_id IN (SELECT min(study_id) "
                     "FROM published)",
                     NULL, NULL, NULL),
        SQLITE_OK);
    sqlite3_close(db);
    assert_int_equal(store_open(&damage.store, "life.db", &(struct store_options){0}, &err), 0);
    each_allocation(&(struct failing_call){.name = "verify", verify, &damage, .may_succeed = 1});
    assert_int_equal(damage.flaws, 2);
    store_close(&damage.store);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(opening),
        cmocka_unit_test(a_study),
        cmocka_unit_test(other_ways),
        cmocka_unit_test(a_batch_keeps_no_part_of_a_change),
        cmocka_unit_test(verification_of_damage),
    };
    return cmocka_run_group_tests(tests, open_life, close_life);
}
