/* Protects: whatever is killed at whatever moment, what was acknowledged is there, once, and its
 * curves are those of a run that nobody disturbed. */
#include "tests/support/check.h"
#include "tests/support/faults/world.h"

static void strike(struct world *world) {
    struct actor *actor = world_pick(world);
    if (actor != NULL)
        world_kill(world, actor);
}

static void random_kills_lose_nothing(void **state) {
    (void)state;
    world_test(&(struct world_options){.program = "kills", .strike = strike, .pause_ms = 150}, 3);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(random_kills_lose_nothing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
