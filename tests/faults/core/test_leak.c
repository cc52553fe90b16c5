/* Protects: a leak is measured, or refused for want of memory, whichever allocation fails; nothing
 * leaks, and the next one succeeds. */
#include "tests/support/check.h"

#include "core/quantity/leak.h"
#include "tests/support/failing/each_allocation.h"

enum { NX = 80, NY = 70 };

static int measure(void *context, struct error *err) {
    static const struct grid GRID = {NX, NY, 1, 1};
    static double gap[NX * NY];
    struct leak *leak = NULL;
    struct leak_result result;
    (void)context;
    for (size_t i = 0; i < (size_t)NX * NY; i++)
        gap[i] = i % 7 == 0 ? 0 : 1 + (double)(i % 5);
    int status = leak_create(&leak, &GRID, &LEAK_DEFAULTS, err);
    if (status == 0)
        status = leak_measure(leak, gap, NULL, &result, err);
    if (status == 0)
        assert_true(result.x.open && result.x.value > 0 && result.y.value > 0);
    leak_destroy(&leak);
    return status;
}

/* The factorisation has more than one ordering of the unknowns. */
static void leaks(void **state) {
    (void)state;
    each_allocation(&(struct failing_call){.name = "leak", measure, NULL, .may_succeed = 1});
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(leaks)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
