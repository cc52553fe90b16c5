/* What runners of a case share is made once by whichever thread comes first, seen whole by all, and
 * destroyed by the last (run under ThreadSanitizer too); a failure is the failing thread's own. */
#include "worker/shared_parts.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <time.h>

#include <cmocka.h>

enum { THREADS = 8, ROUNDS = 200, CASES = 3, VALUES = 64 };

struct part {
    int values[VALUES];
};
static atomic_int alive, made, failures_left;

static int read_case(void *study, const cJSON *parameters, double memory_limit,
                     struct fault_list *faults, struct error *err) {
    (void)memory_limit;
    (void)study;
    (void)parameters;
    (void)faults;
    (void)err;
    return 0;
}

static void clear_case(void *study) {
    (void)study;
}

static int create(void *shared, const void *study, struct error *err) {
    struct part *part = shared;
    (void)study;
    if (atomic_load(&failures_left) > 0 && atomic_fetch_sub(&failures_left, 1) > 0)
        return error_set(err, ERROR_MEMORY, "no room today");
    for (int n = 0; n < VALUES; n++)
        part->values[n] = n;
    nanosleep(&(struct timespec){.tv_nsec = 100000}, NULL); /* so that others have to wait */
    atomic_fetch_add(&made, 1);
    atomic_fetch_add(&alive, 1);
    return 0;
}

static void clear(void *shared) {
    const struct part *part = shared;
    if (part->values[1] == 1) /* made */
        atomic_fetch_sub(&alive, 1);
}

static const struct job_kind SHARING = {.study = {.name = "sharing"},
                                        .read = read_case,
                                        .clear = clear_case,
                                        .shared_size = sizeof(struct part),
                                        .shared_create = create,
                                        .shared_clear = clear};
static const struct job_kind ALONE = {.study = {.name = "alone"}};

static int value_of(const struct shared_part *part, int n) {
    const struct part *content = job_shared_content(shared_part_content(part));
    return content->values[n];
}

static struct shared_part *take(struct shared_parts *parts, uint64_t case_number) {
    struct shared_part *part = NULL;
    struct error err = {0};
    if (shared_parts_take(parts, &SHARING, "0123456789abcdef", case_number, NULL, &part, &err)) {
        return NULL;
    }
    return part;
}

static void held_and_let_go(void **state) {
    (void)state;
    struct shared_parts parts;
    assert_int_equal(shared_parts_init(&parts, NULL), 0);
    atomic_store(&made, 0);
    struct shared_part *first = take(&parts, 1), *second = take(&parts, 1),
                       *other = take(&parts, 2);
    assert_ptr_equal(first, second);
    assert_ptr_not_equal(shared_part_content(first), shared_part_content(other));
    assert_int_equal(atomic_load(&made), 2);
    shared_parts_let_go(&parts, &first);
    assert_null(first);
    assert_int_equal(atomic_load(&alive), 2);
    assert_int_equal(value_of(second, VALUES - 1), VALUES - 1);
    shared_parts_let_go(&parts, &second);
    assert_int_equal(atomic_load(&alive), 1);
    shared_parts_let_go(&parts, &other);
    shared_parts_let_go(&parts, &other); /* nothing */
    assert_int_equal(atomic_load(&alive), 0);
    struct shared_part *none = NULL;
    assert_int_equal(shared_parts_take(&parts, &ALONE, "x", 0, NULL, &none, NULL), 0);
    assert_null(none);
    assert_null(shared_part_content(none));
    shared_parts_destroy(&parts);
}

static void a_failure_leaves_nothing(void **state) {
    (void)state;
    struct shared_parts parts;
    struct shared_part *part = NULL;
    struct error err = {0};
    assert_int_equal(shared_parts_init(&parts, NULL), 0);
    atomic_store(&failures_left, 1);
    assert_int_equal(shared_parts_take(&parts, &SHARING, "s", 0, NULL, &part, &err), ERROR_MEMORY);
    assert_string_equal(err.text, "no room today");
    assert_null(part);
    assert_int_equal(shared_parts_take(&parts, &SHARING, "s", 0, NULL, &part, &err), 0);
    shared_parts_let_go(&parts, &part);
    shared_parts_destroy(&parts);
    assert_int_equal(atomic_load(&alive), 0);
}

/* A thread takes, reads and lets go, over and over; returns how often it got a part with a wrong
 * value. */
static void *hold_often(void *context) {
    struct shared_parts *parts = context;
    size_t wrong = 0;
    for (unsigned round = 0; round < ROUNDS; round++) {
        struct shared_part *part = take(parts, round / 4 % CASES);
        for (int n = 0; part && n < VALUES; n++) {
            wrong += value_of(part, n) != n;
        }
        shared_parts_let_go(parts, &part);
    }
    return wrong ? context : NULL;
}

static void many_threads(void **state) {
    (void)state;
    struct shared_parts parts;
    pthread_t threads[THREADS];
    assert_int_equal(shared_parts_init(&parts, NULL), 0);
    atomic_store(&made, 0);
    atomic_store(&failures_left, 10);
    for (int n = 0; n < THREADS; n++) {
        assert_int_equal(pthread_create(&threads[n], NULL, hold_often, &parts), 0);
    }
    for (int n = 0; n < THREADS; n++) {
        void *wrong;
        assert_int_equal(pthread_join(threads[n], &wrong), 0);
        assert_null(wrong);
    }
    assert_int_equal(atomic_load(&alive), 0);
    assert_true(atomic_load(&made) < THREADS * ROUNDS); /* some were shared */
    shared_parts_destroy(&parts);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(held_and_let_go),
        cmocka_unit_test(a_failure_leaves_nothing),
        cmocka_unit_test(many_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
