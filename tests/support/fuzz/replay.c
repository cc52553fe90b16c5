/* Feeds a fuzz target without libFuzzer: every file of its corpus, cut short at every length, and
 * copies with some bytes changed. What the target asserts must hold for all of them. */
#include "tests/support/check.h"

#include "tests/support/effort.h"
#include "tests/support/fuzz/fuzz.h"
#include "tests/support/seed.h"
#include <dirent.h>
#include <stdbool.h>
#include <sys/stat.h>
#include <time.h>

enum { FILE_MOST = 1 << 16, CHANGED_COPIES = 40, CUTS = 40 };
/* Targets whose inputs take long are fed fewer changed copies: none begins after so much CPU time,
 * times RUGO_EFFORT. */
static const double COPIES_SECONDS = 4;

static char corpus[4096]; /* the folder */
static uint8_t bytes[FILE_MOST], changed[FILE_MOST];

static size_t read_bytes(const char *name) {
    char path[sizeof corpus + 300];
    snprintf(path, sizeof path, "%s/%s", corpus, name);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    size_t size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    return size;
}

/* A copy, so that a read past the end is one past an allocation. */
static void feed(const uint8_t *data, size_t size) {
    uint8_t *copy = malloc(size > 0 ? size : 1);
    assert_non_null(copy);
    memcpy(copy, data, size);
    assert_int_equal(LLVMFuzzerTestOneInput(copy, size), 0);
    free(copy);
}

static bool has_time(void) {
    return (double)clock() / CLOCKS_PER_SEC < COPIES_SECONDS * (double)effort();
}

static void feed_changed(size_t size, uint64_t *seed) {
    for (size_t copy = 0; copy < CHANGED_COPIES && size > 0 && has_time(); copy++) {
        memcpy(changed, bytes, size);
        for (uint64_t n = 1 + next_word(seed) % 4; n > 0; n--)
            changed[next_word(seed) % size] = (uint8_t)next_word(seed);
        feed(changed, size);
    }
    for (size_t cut = 0; cut < CUTS && size > 0 && has_time(); cut++)
        feed(bytes, (size_t)(next_word(seed) % size));
}

static void corpus_and_changed_copies(void **state) {
    struct dirent **names = NULL;
    uint64_t seed = seed_of_now();
    (void)state;
    int count = scandir(corpus, &names, NULL, alphasort), fed = 0;
    for (int n = 0; n < count; n++) {
        if (*names[n]->d_name != '.') {
            size_t size = read_bytes(names[n]->d_name);
            feed(bytes, size);
            feed_changed(size, &seed);
            fed++;
        }
        free(names[n]);
    }
    free(names);
    if (fed == 0)
        fail_msg("no files in %s", corpus);
}

static void nothing(void **state) {
    (void)state;
    feed(bytes, 0);
}

int main(int argc, char **argv) {
    const char *source = getenv("RUGO_SOURCE"), *name = strrchr(argv[0], '/');
    (void)argc;
    snprintf(corpus, sizeof corpus, "%s/tests/fuzz/corpus/%s", source != NULL ? source : ".",
             name != NULL ? name + 1 : argv[0]);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(corpus_and_changed_copies),
        cmocka_unit_test(nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
