/* Protects: that no order of events loses, repeats or forgets anything. Random sequences of what
 * workers, people and publishers do to a store, with commits that fail and processes that die at
 * any point, are done to a store and to a model of the states without SQL (life_model.h); after
 * each sequence the views say what the model says, and nothing is left due. */
#include "schema/store/upkeep/store_verify.h"
#include "tests/support/effort.h"
#include "tests/unit/schema/life_merge.h"
#include "tests/unit/schema/life_views.h"
#include "tests/unit/schema/life_world.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { SEQUENCES = 400 }; /* times RUGO_EFFORT */

/* --- what workers and people do; each changes the model, too, and compares the answers --- */

/* What the store returns of a change that the model accepts or refuses. */
static int answer_of(bool accepted) {
    return accepted ? 0 : ERROR_STATE;
}

static int submit(struct world *world, struct store *store) {
    struct study_kind kind = {.name = "boxes"};
    struct study_case cases[LIFE_CASES] = {{0}};
    char source[32];
    if (world->life.study_count == LIFE_STUDIES)
        return 0;
    int realisations = 1 + below(world, LIFE_MOST), count = 1 + below(world, LIFE_CASES);
    /* where nothing is known of its seconds, a study is not divided among the workers seen */
    double estimate = below(world, 2);
    int number = world->life.study_count;
    snprintf(source, sizeof source, "{\"number\":%d}", number);
    struct study study = {.name = (char[]){"life"},
                          .kind = &kind,
                          .realisations = (uint64_t)realisations,
                          .case_count = (size_t)count,
                          .cases = cases,
                          .source = source};
    for (int c = 0; c < count; c++) {
        cases[c] = (struct study_case){.parameters = cJSON_CreateObject(),
                                       .block = LIFE_BLOCK,
                                       .cost.seconds = estimate,
                                       .realisations = study.realisations};
        assert_non_null(cases[c].parameters);
    }
    char id[STUDY_ID_SIZE];
    int status = store_submit(store, &study, NULL, id, NULL, NULL);
    for (int c = 0; c < count; c++)
        cJSON_Delete(cases[c].parameters);
    if (status != 0)
        return status;
    memcpy(world->ids[number], id, sizeof id);
    life_submit(&world->life, count, realisations);
    for (int c = 0; c < count; c++)
        world->life.studies[number].of[c].poisoned = below(world, 6) == 0;
    return 0;
}

/* The model does as the store did, if that is what the store may do. */
static void take(struct world *world, const struct claimed_job *job, int worker) {
    int row = life_next(&world->life, world->now_ms);
    expect(world, "a job to claim", row >= 0, true);
    const struct life_job *span = &world->life.jobs[row];
    int64_t most = life_block(span);
    expect(world, "first realisation", (int)job->first, (int)span->first);
    expect(world, "number of realisations", job->count >= 1 && (int64_t)job->count <= most, true);
    int index =
        life_lease(&world->life, row, (int64_t)job->count, worker, ++world->leases, world->now_ms);
    const struct life_job *expected = &world->life.jobs[index];
    expect(world, "number of the job claimed", (int)job->id, index + 1);
    expect(world, "case", (int)job->case_number, expected->case_number);
    expect(world, "attempt", (int)job->attempt, expected->attempts);
    struct hold *hold = &world->holds[world->hold_count++ % HOLDS];
    *hold = (struct hold){.job = index, .number = world->leases};
    memcpy(hold->token, job->token, sizeof hold->token);
}

static int claim(struct world *world, struct store *store) {
    enum { JOBS = 3 };
    char worker[8];
    struct claimed_job jobs[JOBS];
    size_t count = 0;
    int number = 1 + below(world, 3);
    snprintf(worker, sizeof worker, "w%d", number);
    struct claim what = {.worker = worker,
                         .host = "here",
                         .count = (size_t)(1 + below(world, JOBS)),
                         .seconds = below(world, 3),
                         .threads = (unsigned)below(world, 3)};
    int status = store_claim(store, &what, jobs, &count, NULL);
    if (status != 0)
        return status;
    life_expire(&world->life, world->now_ms);
    expect(world, "jobs claimed", count > 0, life_next(&world->life, world->now_ms) >= 0);
    expect(world, "no more than asked for", count <= what.count, true);
    for (size_t j = 0; j < count; j++) {
        take(world, &jobs[j], number);
        claimed_job_clear(&jobs[j]);
    }
    return 0;
}

/* One of the last leases; NULL when there is none, or only one of a job whose study was never
 * committed. */
static const struct hold *any_hold(struct world *world) {
    int kept = world->hold_count < HOLDS ? world->hold_count : HOLDS;
    int back = kept > 0 ? 1 + below(world, kept < 5 ? kept : 5) : 0;
    const struct hold *hold = &world->holds[(world->hold_count - back) % HOLDS];
    return back > 0 && hold->job < world->life.job_count ? hold : NULL;
}

static int complete(struct world *world, struct store *store) {
    static const char *const names[] = {"a", "odd"};
    const struct hold *hold = any_hold(world);
    if (hold == NULL)
        return 0;
    const struct life_job *job = &world->life.jobs[hold->job];
    int64_t done = job->count; /* or some of them */
    if (job->state == LIFE_RUNNING && done > 1 && below(world, 3) == 0)
        done = 1;
    double scalars[2 * LIFE_MOST];
    for (int r = 0; r < LIFE_MOST; r++) {
        scalars[2 * r] = value_of(job, r);
        scalars[2 * r + 1] = r % 2 ? NAN : 0;
    }
    struct block_result result = {.first = (uint64_t)job->first,
                                  .count = (uint64_t)done,
                                  .scalar_count = 2,
                                  .names = names,
                                  .scalars = scalars,
                                  .data = (const unsigned char *)"data",
                                  .size = 4,
                                  .seconds = 2};
    bool first = false, case_done = false, again = false;
    int status =
        store_complete(store, hold->job + 1, hold->token, &result, &first, &case_done, NULL);
    if (status == ERROR_SYSTEM)
        return status;
    bool accepted = life_complete(&world->life, hold->job, hold->number, done, &again);
    expect(world, "completion", status, answer_of(accepted));
    if (accepted) {
        expect(world, "first time", first, !again);
        expect(world, "case done", case_done,
               life_left(&world->life, job->study, job->case_number) == 0);
    }
    return 0;
}

/* A change whose commit failed is for the caller, who undoes it in the model too. */
static int compare(const struct world *world, const char *what, int status, bool accepted) {
    if (status != ERROR_SYSTEM)
        expect(world, what, status, answer_of(accepted));
    return status == ERROR_SYSTEM ? status : 0;
}

static int fail_job(struct world *world, struct store *store) {
    const struct hold *hold = any_hold(world);
    bool permanent = below(world, 2) == 0;
    if (hold == NULL)
        return 0;
    int status = store_fail(store, hold->job + 1, hold->token, "bad luck", permanent, NULL);
    return compare(world, "failure", status,
                   life_fail(&world->life, hold->job, hold->number, "bad luck", permanent));
}

static int release(struct world *world, struct store *store) {
    const struct hold *hold = any_hold(world);
    if (hold == NULL)
        return 0;
    return compare(world, "release", store_release(store, hold->job + 1, hold->token, NULL),
                   life_release(&world->life, hold->job, hold->number));
}

static int heartbeat(struct world *world, struct store *store) {
    const struct hold *hold = any_hold(world);
    if (hold == NULL)
        return 0;
    return compare(world, "heartbeat", store_heartbeat(store, hold->job + 1, hold->token, 1, NULL),
                   life_heartbeat(&world->life, hold->job, hold->number, world->now_ms));
}

static int cancel(struct world *world, struct store *store) {
    if (world->life.study_count == 0)
        return 0;
    int study = below(world, world->life.study_count);
    return compare(world, "cancellation", store_cancel(store, world->ids[study], NULL),
                   life_cancel(&world->life, study));
}

static int retry(struct world *world, struct store *store) {
    if (world->life.study_count == 0)
        return 0;
    int study = below(world, world->life.study_count);
    uint64_t count = 0;
    int status = store_retry(store, world->ids[study], 0, &count, NULL);
    if (status == 0)
        expect(world, "jobs retried", (int)count, life_retry(&world->life, study));
    return status;
}

/* A change of any sort. ERROR_SYSTEM: its commit failed, and nothing happened. */
static int change(struct world *world, struct store *store) {
    static const struct {
        int weight;
        int (*change)(struct world *world, struct store *store);
    } CHANGES[] = {{10, submit}, {30, claim},    {28, complete}, {9, fail_job},
                   {3, release}, {4, heartbeat}, {6, cancel},    {8, retry}};
    int weight = below(world, 98);
    size_t c = 0;
    for (; weight >= CHANGES[c].weight; c++)
        weight -= CHANGES[c].weight;
    return CHANGES[c].change(world, store);
}

/* --- publishing --- */

/* The store's changes for the last case offered are committed by now. */
static void confirm_mark(struct world *world) {
    if (world->mark_pending)
        life_mark(&world->life, world->mark.study, world->mark.case_number, world->mark.revision);
    world->mark_pending = false;
}

static bool stop(void *context) {
    struct world *world = context;
    confirm_mark(world);
    return world->stop_after-- == 0;
}

/* Changes that come between reading a case and publishing it: often its study is tried again, and
 * may even end again. */
static void race(struct world *world, int study) {
    uint64_t count = 0;
    if (!world->racing)
        return;
    if (below(world, 2) == 0) {
        assert_int_equal(store_retry(any_handle(world), world->ids[study], 0, &count, NULL), 0);
        expect(world, "jobs retried meanwhile", (int)count, life_retry(&world->life, study));
        for (int n = below(world, 8); n > 0; n--)
            assert_int_equal(claim(world, any_handle(world)) + complete(world, any_handle(world)),
                             0);
    }
    for (int n = below(world, 6); n > 0; n--)
        expect(world, "a change meanwhile", change(world, any_handle(world)), 0);
}

static int publish(void *context, struct store *store, const struct due_case *due, size_t number,
                   struct error *err) {
    (void)number;
    struct world *world = context;
    int study = 0, c = (int)due->case_number;
    while (strcmp(world->ids[study], due->study) != 0)
        study++;
    expect(world, "offered while due", life_is_due(&world->life, study, c), true);
    expect(world, "offered once", LIFE_CASES * study + c > world->last_offered, true);
    world->last_offered = LIFE_CASES * study + c;
    const struct life_case *one = &world->life.studies[study].of[c];
    int64_t revision = one->revision;
    uint32_t jobs = life_done_jobs(&world->life, study, c);
    expect(world, "revision offered", (int)due->revision, (int)revision);
    if (world->transient && below(world, 3) == 0)
        return error_set(err, ERROR_SYSTEM, "it may pass");
    if (one->poisoned) {
        world->mark.study = study;
        world->mark.case_number = c;
        world->mark.revision = revision;
        world->mark_pending = true;
        race(world, study);
        return error_set(err, ERROR_INPUT, "poisoned");
    }
    struct case_result merged = {0};
    merge(store, due, &merged);
    race(world, study);
    int status = store_publish(store, due->study, due->case_number, due->revision, &merged, err);
    result_clear(&merged);
    if (status == 0)
        life_publish(&world->life, study, c, revision, jobs);
    return status;
}

/* A publisher's pass, which may be killed, or meet errors, or changes that come meanwhile. */
static void publish_pass(struct world *world, struct store *store, bool calm) {
    struct publication publication = {.publish = publish, .stop = stop, .context = world};
    struct publish_counts counts;
    world->last_offered = -1;
    world->stop_after = calm || below(world, 3) > 0 ? -1 : below(world, 3);
    world->transient = !calm && below(world, 4) == 0;
    commits_to_failure = calm || below(world, 4) > 0 ? 0 : 1 + below(world, 3);
    world->racing = !calm && commits_to_failure == 0 && below(world, 2) == 0;
    world->mark_pending = false;
    int status = store_publish_due(store, &publication, &counts, NULL);
    if (status == 0)
        confirm_mark(world);
    else if (status != ERROR_STOPPED)
        expect(world, "a mark that could not be committed", status, ERROR_SYSTEM);
    commits_to_failure = 0;
    bool due = false;
    assert_int_equal(store_is_due(store, &due, NULL), 0);
    expect(world, "whether a case is due", due, life_due_count(&world->life) > 0);
    if (status == 0 && !world->racing)
        expect(world, "cases that stay due", (int)counts.postponed, life_due_count(&world->life));
}

/* --- what fails --- */

/* A change whose commit fails: it says so, and nothing happened. */
static void change_in_vain(struct world *world) {
    struct store *store = any_handle(world);
    struct life before = world->life;
    commits_to_failure = 1;
    (void)change(world, store);
    if (commits_to_failure == 0) /* it came to a commit */
        world->life = before;
    commits_to_failure = 0;
}

/* The machine dies: what is on disk is what was written by then. */
static void lose_power(struct world *world) {
    char wal[PATH_SIZE + 32], copy[PATH_SIZE + 32], copy_wal[PATH_SIZE + 40];
    snprintf(wal, sizeof wal, "%s-wal", path);
    snprintf(copy, sizeof copy, "%s.copy", path);
    snprintf(copy_wal, sizeof copy_wal, "%s-wal", copy);
    copy_file(path, copy);
    copy_file(wal, copy_wal);
    close_handles(world);
    assert_int_equal(rename(copy, path), 0);
    assert_int_equal(rename(copy_wal, wal), 0);
}

/* A group commit, which comes to its end or does not. */
static void batch(struct world *world) {
    enum { COMMIT, REFUSED, KILLED, POWER };
    int h = below(world, 2), end = below(world, 5);
    if (world->handles[h] == NULL)
        open_handle(world, h);
    struct store *store = world->handles[h];
    struct life before = world->life;
    assert_int_equal(store_begin(store, NULL), 0);
    for (int n = below(world, 5); n > 0; n--)
        expect(world, "a change within a batch", change(world, store), 0);
    if (end == KILLED)
        store_close(&world->handles[h]);
    else if (end == POWER)
        lose_power(world);
    else {
        commits_to_failure = end == REFUSED;
        expect(world, "the commit of a batch", store_commit(store, NULL),
               end == REFUSED ? ERROR_SYSTEM : 0);
    }
    if (end == REFUSED || end == KILLED || end == POWER)
        world->life = before;
    commits_to_failure = 0;
}

static void step(struct world *world) {
    int what = below(world, 100);
    if (what < 60)
        expect(world, "a change", change(world, any_handle(world)), 0);
    else if (what < 68)
        world->now_ms += below(world, 2) ? 300 : 1100;
    else if (what < 78)
        batch(world);
    else if (what < 85)
        change_in_vain(world);
    else if (what < 96)
        publish_pass(world, any_handle(world), false);
    else if (what < 98)
        store_close(&world->handles[below(world, 2)]);
    else if (world->life.study_count >
             0) /* a newer program, which reads what the older could not */
        world->life.studies[below(world, world->life.study_count)]
            .of[below(world, LIFE_CASES)]
            .poisoned = false;
}

/* --- the test --- */

static int fail_for_flaw(void *context, const struct flaw *flaw, struct error *err) {
    const struct world *world = context;
    (void)err;
    fail_msg("sequence %d: study %s, case %lld, %llu+%llu: %s", world->sequence, flaw->study,
             (long long)flaw->case_number, (unsigned long long)flaw->first,
             (unsigned long long)flaw->count, flaw->text);
    return 0;
}

/* What the store makes is whole for who looks for damage. */
static void check_whole(struct world *world, struct store *store) {
    const struct verification verification = {.found = fail_for_flaw, .context = world};
    struct verify_counts counts = {0};
    struct error err = {0};
    if (store_verify(store, &verification, &counts, &err) != 0)
        fail_msg("%s", err.text);
    assert_true(counts.unsealed == 0);
}

static void run_sequence(struct world *world) {
    bool due = true;
    copy_file(empty_path, path);
    for (int n = 10 + below(world, 45); n > 0; n--)
        step(world);
    if (world->sequence % 8 == 0)
        check_whole(world, any_handle(world));
    if (below(world, 2) == 0)
        close_handles(world); /* as after the death of all processes */
    struct store *store = any_handle(world);
    publish_pass(world, store, true);
    expect(world, "cases due in the model", life_due_count(&world->life), 0);
    assert_int_equal(store_is_due(store, &due, NULL), 0);
    expect(world, "whether anything is due", due, false);
    check_views(world);
    close_handles(world);
}

/* A job of the case has no result, and will have none. */
static bool is_incomplete(const struct life *life, int study, int case_number) {
    bool found = false;
    for (int j = 0; j < life->job_count; j++) {
        const struct life_job *job = &life->jobs[j];
        found = found || (job->study == study && job->case_number == case_number &&
                          (job->state == LIFE_FAILED || job->state == LIFE_CANCELLED));
    }
    return found;
}

/* Where so many are expected of 800 sequences, those of n, less four standard deviations. */
static double least_of(double expected, int n) {
    expected *= n / 800.0;
    return expected - 4 * sqrt(expected);
}

static void sequences_end_as_the_model_says(void **state) {
    static struct world world;
    uint64_t seed = seed_of_now();
    int published = 0, marked = 0, incomplete = 0, sequences = (int)cases_of(SEQUENCES);
    (void)state;
    for (int n = 0; n < sequences; n++) {
        world = (struct world){.random = seed + (uint64_t)n * 0x10001, .sequence = n};
        run_sequence(&world);
        for (int s = 0; s < world.life.study_count; s++)
            for (int c = 0; c < world.life.studies[s].cases; c++) {
                const struct life_case *one = &world.life.studies[s].of[c];
                published += one->published > 0;
                marked += one->marked;
                incomplete += one->published > 0 && is_incomplete(&world.life, s, c);
            }
    }
    print_message("%d sequences: %d cases published, %d of them incomplete, %d marked\n", sequences,
                  published, incomplete, marked);
    /* Or the sequences would show nothing. */
    assert_true(published > least_of(300, sequences) && incomplete > least_of(49, sequences) &&
                marked > least_of(53, sequences));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(sequences_end_as_the_model_says)};
    return cmocka_run_group_tests(tests, setup, teardown);
}
