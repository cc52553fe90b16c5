/* Protects: steps of the wall clock, of the server or of a worker, by seconds or by years, end no
 * lease and lose nothing. */
#include "tests/support/check.h"
#include "tests/support/faults/world.h"
#include <glob.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { CLOCKS = 3 }; /* of the server and of two workers */

static const char *clock_of(const struct actor *actor, char file[PATH_MAX]) {
    char folder[PATH_MAX - 64];
    assert_non_null(getcwd(folder, sizeof folder));
    snprintf(file, PATH_MAX, "%s/clock-%d", folder,
             actor->role == ROLE_IS_SERVER ? 0 : 1 + actor->number);
    return file;
}

static bool has_clock(const struct actor *actor) {
    return actor->role == ROLE_IS_SERVER ||
           (actor->role == ROLE_IS_WORKER && actor->number < CLOCKS - 1);
}

static void before(struct world *world, const struct actor *actor) {
    char file[PATH_MAX];
    if (!has_clock(actor))
        return;
    setenv("LD_PRELOAD", world->options.context, 1);
    setenv("FAKETIME_TIMESTAMP_FILE", clock_of(actor, file), 1);
    setenv("FAKETIME_NO_CACHE", "1", 1);
    setenv("FAKETIME_DONT_FAKE_MONOTONIC", "1", 1); /* as setting the clock does not change it */
    setenv("FAKETIME_DONT_RESET", "1", 1);
}

static void after(struct world *world, const struct actor *actor) {
    (void)world, (void)actor;
    unsetenv("LD_PRELOAD");
}

static void set_clock(struct world *world, int number, long seconds) {
    char file[PATH_MAX], text[32];
    const struct actor owner = {.role = number == 0 ? ROLE_IS_SERVER : ROLE_IS_WORKER,
                                .number = number - 1};
    (void)world;
    snprintf(text, sizeof text, "%+ld\n", seconds);
    spit("clock-new", text);
    assert_int_equal(rename("clock-new", clock_of(&owner, file)), 0);
}

static void strike(struct world *world) {
    static const unsigned STEPS[] = {3, 120, 86400, 40000000};
    long step = 1 + (long)world_draw(world, STEPS[world_draw(world, 4)]);
    set_clock(world, (int)world_draw(world, CLOCKS), world_draw(world, 2) == 0 ? step : -step);
    world_count_fault(world);
    if (world_draw(world, 10) == 0) {
        struct actor *actor = world_pick(world);
        if (actor != NULL)
            world_kill(world, actor); /* so that a store is opened under another date, too */
    }
}

static void stepped_clocks_lose_nothing(void **state) {
    (void)state;
    glob_t found = {0};
    if (glob("/usr/lib/*/faketime/libfaketimeMT.so.1", 0, NULL, &found) != 0) {
        print_message("SKIP: no libfaketime to step clocks with (Debian: libfaketime)\n");
        skip();
    }
    for (int number = 0; number < CLOCKS; number++)
        set_clock(NULL, number, 0);
    world_test(&(struct world_options){.program = "clocks",
                                       .before = before,
                                       .after = after,
                                       .strike = strike,
                                       .pause_ms = 100,
                                       .context = found.gl_pathv[0]},
               20);
    globfree(&found);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(stepped_clocks_lose_nothing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
