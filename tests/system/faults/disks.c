/* Protects: a disk that fills up, while studies and results come in, loses nothing that was
 * acknowledged; with room again the service goes on by itself. */
#include "tests/support/check.h"
#include "tests/support/faults/namespace.h"
#include "tests/support/faults/world.h"
#include <sched.h>
#include <stdio.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/statvfs.h>

static bool set_size(unsigned long long bytes) {
    char size[48];
    snprintf(size, sizeof size, "size=%llu", bytes);
    return mount(NULL, "store", NULL, MS_REMOUNT, size) == 0;
}

static unsigned long long used_bytes(void) {
    struct statvfs now;
    assert_int_equal(statvfs("store", &now), 0);
    return (now.f_blocks - now.f_bfree) * now.f_frsize;
}

/* With room for a copy of the store, its log, and what killed copies have left. */
static void heal(struct world *world) {
    (void)world;
    assert_true(set_size((1ULL << 30) + 4 * used_bytes()));
}

/* Full but for some pages, or with room. */
static void strike(struct world *world) {
    if (world_draw(world, 3) == 0)
        heal(world);
    else if (set_size(used_bytes() + 4096ULL * world_draw(world, 64)))
        world_count_fault(world);
    if (world_draw(world, 20) == 0)
        world_kill(world, &world->actors[0]); /* to start again on a full disk */
}

static void full_disks_lose_nothing(void **state) {
    (void)state;
    mkdir("store", 0700);
    if (!namespace_enter(CLONE_NEWNS) || mount("none", "store", "tmpfs", 0, "size=1g") != 0) {
        print_message("SKIP: no mount of a small disk is permitted here\n");
        skip();
    }
    world_test(
        &(struct world_options){
            .program = "disks", .strike = strike, .pause_ms = 300, .heal = heal},
        20);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(full_disks_lose_nothing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
