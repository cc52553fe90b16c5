/* Protects: that no order of claims, results of whole jobs and of parts of them, failures,
 * releases, losses, cancellations and retries leaves a realisation out or does one twice. */
#include "schema/store/upkeep/store_verify.h"
#include "tests/support/seed.h"
#include "tests/unit/schema/spans.h"

enum { HELD = 40, STEPS = 1200, REALISATIONS = 700 };

struct scene {
    struct store *store;
    uint64_t random;
    struct claimed_job held[HELD]; /* also those whose leases ran out */
    size_t count;
    int64_t leased_ms[HELD];
    unsigned done[CASES][REALISATIONS]; /* how often a result of each was accepted */
    int parts, late, failed;
};

static uint64_t below(struct scene *scene, uint64_t n) {
    return next_word(&scene->random) % n;
}

static void drop(struct scene *scene, size_t at) {
    claimed_job_clear(&scene->held[at]);
    scene->held[at] = scene->held[--scene->count];
    scene->leased_ms[at] = scene->leased_ms[scene->count];
}

static void claim_some(struct scene *scene) {
    char worker[] = {'w', (char)('0' + below(scene, 6)), 0};
    const struct claim asked = {.worker = worker,
                                .count = 1 + below(scene, 3),
                                .seconds = (double)below(scene, 12),
                                .threads = (unsigned)below(scene, 3)};
    if (scene->count + asked.count > HELD)
        return;
    scene->count += claim(scene->store, &asked, &scene->held[scene->count]);
    for (size_t j = 0; j < scene->count; j++)
        if (scene->leased_ms[j] == 0)
            scene->leased_ms[j] = clock_ms;
}

/* A result of a whole job or of a part of it, which is taken unless its lease was lost. */
static void hand_in(struct scene *scene, size_t at) {
    const struct claimed_job *job = &scene->held[at];
    bool case_done;
    uint64_t count = below(scene, 3) > 0 ? job->count : 1 + below(scene, job->count);
    double seconds = 0.01 + 0.2 * (double)job->case_number;
    int status = complete(scene->store, job, count, seconds, &case_done);
    if (status != 0)
        assert_int_equal(status, ERROR_STATE);
    scene->parts += status == 0 && count < job->count;
    scene->late += status != 0;
    for (uint64_t r = 0; status == 0 && r < count; r++)
        scene->done[job->case_number][job->first + r]++;
    drop(scene, at);
}

/* Ends a lease in one of all manners. */
static void end_one(struct scene *scene) {
    size_t at = scene->count > 0 ? (size_t)below(scene, scene->count) : 0;
    if (scene->count == 0)
        return;
    const struct claimed_job *job = &scene->held[at];
    uint64_t how = below(scene, 12);
    if (how < 8) {
        hand_in(scene, at);
    } else if (how < 9) {
        (void)store_release(scene->store, job->id, job->token, NULL);
        drop(scene, at);
    } else if (how < 10) {
        (void)store_fail(scene->store, job->id, job->token, "no luck", below(scene, 4) == 0, NULL);
        drop(scene, at);
        scene->failed++;
    } else if (how < 11) {
        (void)store_heartbeat(scene->store, job->id, job->token, (double)below(scene, job->count),
                              NULL);
    } else {
        clock_ms += 700; /* leases run out, and results of theirs come later, or never */
        if (below(scene, 2) == 0)
            drop(scene, at);
    }
}

/* Whatever failed or waits is done in the end. */
static void work_off(struct scene *scene, const char *id) {
    struct study_status now = {0};
    uint64_t again = 0;
    while (scene->count > 0)
        drop(scene, scene->count - 1);
    for (int n = 0; n < 10000; n++) {
        clock_ms += 70000; /* no lease and no pause is longer */
        if (claim_one(scene->store, "last", &scene->held[0]) > 0) {
            scene->count = 1;
            hand_in(scene, 0);
            continue;
        }
        assert_int_equal(store_retry(scene->store, id, 0, &again, NULL), 0);
        assert_int_equal(store_status(scene->store, id, &now, NULL), 0);
        bool ended = now.jobs_waiting + now.jobs_running == 0;
        study_status_clear(&now);
        if (ended)
            return;
    }
    fail_msg("it never ends");
}

static int next_block(void *context, const struct block_result *result, struct error *err) {
    uint64_t *next = context;
    (void)err;
    assert_int_equal(result->first, *next);
    for (uint64_t r = 0; r < result->count; r++)
        assert_true(result->scalars[r] == (double)(result->first + r));
    *next += result->count;
    return 0;
}

static int print_flaw(void *context, const struct flaw *flaw, struct error *err) {
    (void)context;
    return error_set(err, ERROR_STATE, "%s", flaw->text);
}

/* The store finds itself whole. */
static void check_whole(struct store *store) {
    const struct verification verification = {.found = print_flaw};
    struct verify_counts counts = {0};
    struct error err = {0};
    if (store_verify(store, &verification, &counts, &err) != 0)
        fail_msg("%s", err.text);
}

static void no_order_loses_or_doubles(void **state) {
    (void)state;
    static struct scene scene;
    uint64_t seed = seed_of_now();
    char id[STUDY_ID_SIZE];
    int parts = 0, late = 0, failed = 0;
    for (uint64_t n = 0; n < 6; n++) {
        char path[24];
        snprintf(path, sizeof path, "order%d.db", (int)n);
        scene = (struct scene){.store = open_store(path), .random = seed + 0x10001 * n};
        submit(scene.store, CASES, REALISATIONS, 0.05, id);
        for (int step = 0; step < STEPS; step++) {
            if (below(&scene, 2) == 0)
                claim_some(&scene);
            else
                end_one(&scene);
            if (below(&scene, 200) == 0) {
                uint64_t jobs;
                (void)store_cancel(scene.store, id, NULL);
                check_counts(path, REALISATIONS);
                assert_int_equal(store_retry(scene.store, id, 0, &jobs, NULL), 0);
            }
            if (step % 100 == 0)
                check_counts(path, REALISATIONS);
        }
        check_whole(scene.store);
        work_off(&scene, id);
        check_counts(path, REALISATIONS);
        check_whole(scene.store);
        for (uint64_t c = 0; c < CASES; c++) {
            uint64_t next = 0;
            for (int r = 0; r < REALISATIONS; r++)
                if (scene.done[c][r] != 1)
                    fail_msg("case %d, realisation %d: done %u times", (int)c, r, scene.done[c][r]);
            assert_int_equal(store_results(scene.store, id, c, next_block, &next, NULL), 0);
            assert_int_equal(next, REALISATIONS);
        }
        parts += scene.parts;
        late += scene.late;
        failed += scene.failed;
        store_close(&scene.store);
    }
    print_message("%d parts, %d results of lost leases, %d failures\n", parts, late, failed);
    assert_true(parts > 20 && late > 20 && failed > 20); /* or it would show nothing */
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(no_order_loses_or_doubles)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
