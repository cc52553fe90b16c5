#include "tests/support/failing/each_allocation.h"
#include "tests/support/check.h"
#include "tests/support/failing/failing_allocator.h"
#include <inttypes.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum {
    FIRST_ALL = 150, /* so many from the start are failed each */
    SPREAD = 150     /* and of the rest about so many */
};

/* Of the leak checker, where there is one. */
__attribute__((weak)) int __lsan_do_recoverable_leak_check(void);

static uint64_t next_of(uint64_t n, uint64_t total) {
    const char *wish = getenv("RUGO_FAULTS");
    bool all = wish != NULL && strcmp(wish, "all") == 0;
    return all || n < FIRST_ALL || total <= FIRST_ALL + SPREAD
               ? n + 1
               : n + 1 + (total - FIRST_ALL) / SPREAD;
}

static void run_undisturbed(const struct failing_call *call, const char *when, uint64_t n) {
    struct error err = {0};
    if (call->run(call->context, &err) != 0) {
        failing_where();
        fail_msg("%s, %s allocation %" PRIu64 " failed: %s", call->name, when, n, err.text);
    }
}

/* True where nothing was left to fail. */
static bool fail_allocation(const struct failing_call *call, enum failing_mode mode, uint64_t n) {
    struct error err = {0};
    failing_arm(mode, n);
    int status = call->run(call->context, &err);
    struct failing_count count = failing_disarm();
    if (count.failed == 0 && status != 0)
        fail_msg("%s: %s though no allocation failed", call->name, err.text);
    if (count.failed == 0)
        return true;
    bool clear = status == 0 ? call->may_succeed != 0
                             : status == err.code && *err.text != 0 &&
                                   (status == ERROR_MEMORY || status == call->also);
    if (!clear) {
        failing_where();
        fail_msg("%s, allocation %" PRIu64 "%s failed: status %d, code %d, \"%s\"", call->name, n,
                 mode == FAIL_ONE ? "" : " and all behind it", status, err.code, err.text);
    }
    run_undisturbed(call, "after", n);
    return false;
}

void each_allocation(const struct failing_call *call) {
    run_undisturbed(call, "before", 0); /* what libraries keep for good is made here */
    failing_arm(FAIL_ONE, UINT64_MAX);
    run_undisturbed(call, "before", 0);
    uint64_t total = failing_disarm().asked, failed = 0;
    if (total == 0)
        fail_msg("%s allocates nothing: the loop shows nothing", call->name);
    for (enum failing_mode mode = FAIL_ONE; mode <= FAIL_FROM; mode++)
        for (uint64_t n = 0; !fail_allocation(call, mode, n); n = next_of(n, total))
            failed++;
    if (__lsan_do_recoverable_leak_check != NULL && __lsan_do_recoverable_leak_check() != 0)
        fail_msg("%s leaks after a failed allocation", call->name);
    print_message("%s: %" PRIu64 " allocations, %" PRIu64 " failures\n", call->name, total, failed);
}
