/* Protects: processes that stand still, for a moment or beyond their leases, lose nothing and
 * count nothing twice when they go on. */
#include "tests/support/check.h"
#include "tests/support/faults/world.h"

static void strike(struct world *world) {
    struct actor *actor = world_pick(world);
    if (actor == NULL)
        return;
    long beyond = actor->role == ROLE_IS_SERVER ? WORLD_LEASE * 1000 : WORLD_LEASE * 2500;
    bool briefly = world_draw(world, 3) != 0;
    world_stop(world, actor, 1 + (long)world_draw(world, briefly ? 500 : (unsigned)beyond));
}

static void stopped_processes_lose_nothing(void **state) {
    (void)state;
    world_test(&(struct world_options){.program = "stops", .strike = strike, .pause_ms = 300}, 20);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(stopped_processes_lose_nothing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
