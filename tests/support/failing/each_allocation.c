#include "tests/support/failing/each_allocation.h"
#include "tests/support/check.h"
#include "tests/support/effort.h"
#include "tests/support/failing/failing_allocator.h"
#include <inttypes.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* CPU time that one loop may take, unless all allocations are asked for, and the least number of
 * them, a third of it without RUGO_EFFORT, which multiplies both. */
static const double SECONDS = 0.2;
enum { LEAST = 24 };

/* Of the leak checker, where there is one. */
__attribute__((weak)) int __lsan_do_recoverable_leak_check(void);

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/* From one allocation that fails to the next: 1, or more where a call takes long. */
static uint64_t step_of(uint64_t total, double seconds_a_call) {
    const char *wish = getenv("RUGO_FAULTS");
    if (wish != NULL && strcmp(wish, "all") == 0)
        return 1;
    /* Two modes, and each time the call that fails and the one that passes. */
    double most = fmax((double)effort() * SECONDS / (4 * seconds_a_call), (double)cases_of(LEAST));
    return (double)total <= most ? 1 : (uint64_t)ceil((double)total / most);
}

static void run_undisturbed(const struct failing_call *call, const char *when, uint64_t n) {
    struct error err = {0};
    if (call->run(call->context, &err) != 0) {
        failing_where();
        fail_msg("%s, %s allocation %" PRIu64 " failed: %s", call->name, when, n, err.text);
    }
}

/* True where nothing was left to fail. */
static bool fail_allocation(const struct failing_call *call, uint64_t n, uint64_t most) {
    struct error err = {0};
    failing_arm(n, most);
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
                 most == 1 ? "" : " and all behind it", status, err.code, err.text);
    }
    run_undisturbed(call, "after", n);
    return false;
}

void each_allocation(const struct failing_call *call) {
    run_undisturbed(call, "before", 0); /* what libraries keep for good is made here */
    double begin = now();
    failing_arm(0, 0);
    run_undisturbed(call, "before", 0);
    uint64_t total = failing_disarm().asked, failed = 0, step = step_of(total, now() - begin);
    if (total == 0)
        fail_msg("%s allocates nothing: the loop shows nothing", call->name);
    for (int all = 0; all <= 1; all++)
        for (uint64_t n = 0; !fail_allocation(call, n, all ? UINT64_MAX : 1); n += step)
            failed++;
    if (__lsan_do_recoverable_leak_check != NULL && __lsan_do_recoverable_leak_check() != 0)
        fail_msg("%s leaks after a failed allocation", call->name);
    print_message("%s: %" PRIu64 " allocations, %" PRIu64 " failures\n", call->name, total, failed);
}
