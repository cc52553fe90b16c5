/* Protects: writes and synchronisations of the store and of its copies that fail lose nothing that
 * was acknowledged. They fail now and then or all for a while, by a bad disk, a full one or one
 * that was mounted read-only. */
#include "tests/support/check.h"
#include "tests/support/failing/failing_writes.h"
#include "tests/support/faults/world.h"
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

struct disk {
    struct failing_writes *wish;
    char library[PATH_MAX], file[PATH_MAX];
};

static void before(struct world *world, const struct actor *actor) {
    const struct disk *disk = world->options.context;
    if (actor->role != ROLE_IS_SERVER && actor->role != ROLE_IS_SNAPSHOT)
        return;
    setenv("LD_PRELOAD", disk->library, 1);
    setenv("RUGO_FAIL_WRITES", disk->file, 1);
}

static void after(struct world *world, const struct actor *actor) {
    (void)world, (void)actor;
    unsetenv("LD_PRELOAD");
}

static void strike(struct world *world) {
    static const int ERRORS[] = {EIO, EIO, ENOSPC, EROFS};
    static const unsigned RATES[] = {0, 2000, 50000, 300000, 1000000};
    struct failing_writes *wish = ((struct disk *)world->options.context)->wish;
    unsigned rate = RATES[world_draw(world, 5)];
    atomic_store(&wish->error, ERRORS[world_draw(world, 4)]);
    atomic_store(&wish->per_million, rate);
    if (world_draw(world, 20) == 0)
        world_kill(world, &world->actors[0]); /* over what failing writes have left */
}

static void heal(struct world *world) {
    struct failing_writes *wish = ((struct disk *)world->options.context)->wish;
    atomic_store(&wish->per_million, 0);
    atomic_store(&world->tally->faults, atomic_load(&wish->failed));
}

/* The library lies beside the programs. */
static void disk_open(struct disk *disk) {
    char folder[PATH_MAX - 64];
    ssize_t length = readlink("/proc/self/exe", folder, sizeof folder - 1);
    assert_true(length > 0);
    folder[length] = '\0';
    *strrchr(folder, '/') = '\0';
    snprintf(disk->library, sizeof disk->library, "%s/failing_writes.so", folder);
    assert_int_equal(access(disk->library, R_OK), 0);
    assert_non_null(getcwd(folder, sizeof folder));
    snprintf(disk->file, sizeof disk->file, "%s/wish", folder);
    int file = open(disk->file, O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    assert_true(file >= 0);
    assert_int_equal(ftruncate(file, sizeof *disk->wish), 0);
    disk->wish = mmap(NULL, sizeof *disk->wish, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    assert_true(disk->wish != MAP_FAILED);
    close(file);
}

static void failing_writes_lose_nothing(void **state) {
    (void)state;
    struct disk disk;
    disk_open(&disk);
    world_test(&(struct world_options){.program = "writes",
                                       .before = before,
                                       .after = after,
                                       .strike = strike,
                                       .pause_ms = 200,
                                       .heal = heal,
                                       .context = &disk},
               20);
    munmap(disk.wish, sizeof *disk.wish);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(failing_writes_lose_nothing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
