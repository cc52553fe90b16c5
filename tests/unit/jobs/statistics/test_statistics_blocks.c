/* Protects: statistics from parameters to bytes of blocks and back: any split into blocks and any
 * order of merging gives the same document; foreign and damaged results are refused whole; a run
 * that is stopped gives nothing. */
#include "schema/result/bytes/bytes.h"
#include "tests/support/effort.h"
#include "tests/support/seed.h"
#include "tests/support/statistics_study.h"
#include <stdlib.h>

/* Random blocks, run by several runners, merged in random order: the same text. */
static void any_split_and_order(void **state) {
    (void)state;
    uint64_t seed = seed_of_now();
    for (int s = 0; s < STUDY_COUNT; s++) {
        struct job_runner *runners[] = {runner_of(STUDIES[s]), runner_of(STUDIES[s])};
        struct job_merger *whole = merger_of(STUDIES[s]);
        struct block_result result = run(runners[0], 0, REALISATIONS);
        merge(whole, &result);
        block_result_clear(&result);
        char *expected = text_of(whole);
        for (size_t trial = 0; trial < 3; trial += case_step()) {
            struct job_merger *merger = merger_of(STUDIES[s]);
            struct block_result parts[REALISATIONS];
            size_t count = 0;
            for (uint64_t first = 0; first < REALISATIONS;) {
                uint64_t size = 1 + next_word(&seed) % 9;
                size = first + size <= REALISATIONS ? size : REALISATIONS - first;
                parts[count] = run(runners[count % 2], first, size);
                count++;
                first += size;
            }
            for (size_t left = count; left > 0; left--) {
                size_t pick = (size_t)(next_word(&seed) % left);
                merge(merger, &parts[pick]);
                block_result_clear(&parts[pick]);
                parts[pick] = parts[left - 1];
            }
            char *got = text_of(merger);
            assert_string_equal(got, expected);
            free(got);
            merger_destroy(&merger);
        }
        free(expected);
        merger_destroy(&whole);
        runner_destroy(&runners[0]);
        runner_destroy(&runners[1]);
    }
}

/* Another case's, another block's, twice the same, damaged, cut: refused, and nothing is added. */
static void foreign_and_damaged(void **state) {
    (void)state;
    struct job_runner *runner = runner_of(GAUSSIAN), *other = runner_of(PROFILE);
    struct job_merger *merger = merger_of(GAUSSIAN);
    struct block_result good = run(runner, 3, 4), next = run(runner, 7, 4);
    struct block_result foreign = run(other, 0, 2);
    merge(merger, &good);
    char *before = text_of(merger);
    assert_refused(merger, &good, "realisation 3 is there already");
    assert_refused(merger, &foreign, "other parameters");
    struct block_result bad = next;
    bad.first = 6;
    assert_refused(merger, &bad, "realisation 6 is there already");
    bad.first = 0;
    assert_refused(merger, &bad, "realisation 3 is there already");
    bad = next;
    bad.count = 3;
    assert_refused(merger, &bad, "scalars beside it");
    bad = next;
    bad.scalar_count--;
    assert_refused(merger, &bad, "scalars a realisation");
    assert_damaged_are_refused(merger, &next, 500);
    char *after = text_of(merger);
    assert_string_equal(after, before);
    merge(merger, &next);
    free(before);
    free(after);
    block_result_clear(&good);
    block_result_clear(&next);
    block_result_clear(&foreign);
    merger_destroy(&merger);
    runner_destroy(&runner);
    runner_destroy(&other);
}

/* Changed bytes under a checksum made anew, as someone might send on purpose: taken or refused, but
 * never a crash, a read past the end or an overflow (run under sanitizers). */
static void malicious(void **state) {
    (void)state;
    uint64_t seed = seed_of_now();
    struct job_runner *runner = runner_of(GAUSSIAN);
    struct job_merger *merger = merger_of(GAUSSIAN);
    struct block_result good = run(runner, 0, 2);
    unsigned char *copy = malloc(good.size);
    assert_non_null(copy);
    size_t taken = 0;
    for (int trial = 0; trial < 20000; trial++) {
        struct block_result bad = good;
        memcpy(copy, good.data, good.size);
        bad.data = copy;
        bad.first = (uint64_t)trial * 2;
        bad.size = trial % 2 ? good.size : 8 + (size_t)(next_word(&seed) % (good.size - 8));
        for (uint64_t change = next_word(&seed) % 4; change > 0; change--)
            copy[next_word(&seed) % good.size] = (unsigned char)(next_word(&seed) >> 13);
        uint64_t hash = hash_bytes(HASH_START, bad.size - 8, copy);
        for (size_t a = 0; a < 8; a++)
            copy[bad.size - 8 + a] = (unsigned char)(hash >> (8 * a));
        struct error err = {0};
        int status = merger_add(merger, &bad, &err);
        assert_true(status == 0 || status == ERROR_INPUT);
        taken += status == 0;
    }
    assert_true(taken > 1000); /* the unchanged ones at least: their checksum is right */
    cJSON_Delete(curves_of(merger));
    free(copy);
    block_result_clear(&good);
    merger_destroy(&merger);
    runner_destroy(&runner);
}

/* Before any result there are curves too, all of them empty of values. */
static void no_realisation_yet(void **state) {
    (void)state;
    struct job_merger *merger = merger_of(GAUSSIAN);
    cJSON *document = curves_of(merger);
    assert_true(json_at(document, "/realisations")->valuedouble == 0);
    assert_true(isnan(at(curve_of(document, "summit_height_pdf"), "/y", 0)));
    assert_true(scalar(document, "nayak_alpha", "value") > 1.5);
    cJSON_Delete(document);
    merger_destroy(&merger);
}

/* The number of realisations to stop after. */
static int stop_at(void *context, double done) {
    const uint64_t *most = context;
    return done == (double)*most;
}

/* What is done when a block is stopped is handed out, as if no more had been asked for. */
static void stopping(void **state) {
    (void)state;
    struct job_runner *runner = runner_of(GAUSSIAN);
    uint64_t most = 2;
    const struct job_control control = {stop_at, &most};
    struct block_result result = {.first = 77}, two = {0};
    struct error err = {0};
    assert_int_equal(runner_run(runner, 0, 5, &control, &result, &err), 0);
    assert_int_equal(result.count, 2);
    assert_int_equal(runner_run(runner, 0, 2, NULL, &two, &err), 0);
    assert_int_equal(result.size, two.size);
    assert_memory_equal(result.data, two.data, two.size);
    assert_memory_equal(result.scalars, two.scalars, 2 * two.scalar_count * sizeof *two.scalars);
    block_result_clear(&two);
    block_result_clear(&result);
    most = 0;
    result.first = 77;
    assert_int_equal(runner_run(runner, 0, 5, &control, &result, &err), ERROR_STOPPED);
    assert_non_null(strstr(err.text, "0 of 5"));
    assert_true(result.first == 77 && result.data == NULL);
    runner_destroy(&runner);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_split_and_order),
        cmocka_unit_test(foreign_and_damaged),
        cmocka_unit_test(malicious),
        cmocka_unit_test(no_realisation_yet),
        cmocka_unit_test(stopping),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
