/* Protects: jobs that together need more memory than the process may use do not run at once; one
 * alone always does, if it fits; and a worker that waits for memory can be stopped. */
#include "tests/support/check.h"
#include "worker/clock.h"
#include "worker/memory_budget.h"
#include <stdatomic.h>
#include <string.h>

static int never(void *context) {
    (void)context;
    return 0;
}

/* Stops at the third call. */
static int third(void *context) {
    int *calls = context;
    return ++*calls >= 3;
}

enum { THREADS = 8, TURNS = 50, FIT = 3 };
struct user {
    struct memory_budget *budget;
    atomic_int *inside, *most;
    pthread_t handle;
};

static void *use(void *context) {
    struct user *user = context;
    for (int turn = 0; turn < TURNS; turn++) {
        if (memory_budget_take(user->budget, 1e9, never, NULL, NULL) != 0)
            return user;
        int inside = atomic_fetch_add(user->inside, 1) + 1, most = atomic_load(user->most);
        while (inside > most && !atomic_compare_exchange_weak(user->most, &most, inside))
            ;
        atomic_fetch_sub(user->inside, 1);
        memory_budget_give(user->budget, 1e9);
    }
    return NULL;
}

static void only_what_fits_is_taken_at_once(void **state) {
    (void)state;
    struct memory_budget budget;
    struct user users[THREADS];
    atomic_int inside = 0, most = 0;
    assert_int_equal(memory_budget_init(&budget, FIT * 1e9 + 5e8, NULL), 0);
    for (int n = 0; n < THREADS; n++) {
        users[n] = (struct user){.budget = &budget, .inside = &inside, .most = &most};
        assert_int_equal(pthread_create(&users[n].handle, NULL, use, &users[n]), 0);
    }
    for (int n = 0; n < THREADS; n++) {
        void *failed = NULL;
        assert_int_equal(pthread_join(users[n].handle, &failed), 0);
        assert_null(failed);
    }
    assert_in_range(atomic_load(&most), 1, FIT);
    assert_true(budget.taken == 0);
    memory_budget_destroy(&budget);
}

static void a_wait_can_be_stopped(void **state) {
    (void)state;
    struct memory_budget budget;
    struct error err = {0};
    int calls = 0;
    assert_int_equal(memory_budget_init(&budget, 1e9, NULL), 0);
    assert_int_equal(memory_budget_take(&budget, 6e8, never, NULL, NULL), 0);
    assert_int_equal(memory_budget_take(&budget, 6e8, third, &calls, &err), ERROR_STOPPED);
    assert_int_equal(calls, 3);
    assert_int_equal(memory_budget_take(&budget, 4e8, third, &calls, NULL), 0);
    assert_true(budget.taken == 1e9);
    memory_budget_destroy(&budget);
}

static void what_never_fits_is_refused(void **state) {
    (void)state;
    struct memory_budget budget;
    struct error err = {0};
    assert_int_equal(memory_budget_init(&budget, 3.6e9, NULL), 0);
    assert_int_equal(memory_budget_take(&budget, 5.2e9, never, NULL, &err), ERROR_MEMORY);
    assert_string_equal(err.text,
                        "the case needs about 5.2 GB of memory, and the jobs of this process may "
                        "use 3.6 GB, 0.9 of what the machine, a control group or Slurm gives");
    assert_true(budget.taken == 0);
    memory_budget_destroy(&budget);
    assert_int_equal(memory_budget_init(&budget, 0, NULL), 0); /* not known: no limit */
    assert_int_equal(memory_budget_take(&budget, 1e15, never, NULL, NULL), 0);
    assert_int_equal(memory_budget_take(&budget, 1e15, never, NULL, NULL), 0);
    memory_budget_destroy(&budget);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(only_what_fits_is_taken_at_once),
        cmocka_unit_test(a_wait_can_be_stopped),
        cmocka_unit_test(what_never_fits_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
