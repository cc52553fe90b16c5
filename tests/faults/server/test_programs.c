/* Protects: the whole program, whichever of its allocations fails: it ends by itself, says on
 * stderr what is missing unless it could do without, and what it prints as done is right; the same
 * command succeeds afterwards on the same store. */
#include "tests/support/check.h"

#include "tests/support/effort.h"
#include "tests/support/process.h"
#include "tests/support/store_files.h"
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char STUDY[] =
    "{\"name\":\"small\",\"kind\":\"contact\",\"seed\":7,\"realisations\":2,\"surface\":{"
    "\"dimension\":1,\"hurst\":0.8,\"wavelength_ratio\":4,\"length_ratio\":1,"
    "\"points_per_wavelength\":4,\"rms_slope\":0.3},\"contact\":{\"block_height\":{\"lengths\":1},"
    "\"model\":["
    "\"layered\",\"full\"],\"pressures\":{\"values\":[0.02,0.05]},\"keep\":{\"realisations\":[1]}}"
    "}";

enum { MOST_ARGUMENTS = 12, SANITIZER = 99 };
struct program {
    const char *name;
    const char *arguments[MOST_ARGUMENTS]; /* NULL-terminated */
    const char *from;  /* what stdout holds from here on is the same every time; NULL: nothing is */
    const char *store; /* begins with none of that name; NULL: keeps all files */
};

/* Allocations of a command that fail, spread over all of them, times RUGO_EFFORT, unless
 * RUGO_FAULTS=all; each alone, and with all behind it, or where workers wait until there is memory
 * again, with some. */
enum { FAILURES = 12, SOME = 10 };

static uint64_t allocations(const char *path) {
    char *text = slurp(path);
    uint64_t count = strtoull(text, NULL, 10);
    free(text);
    return count;
}

/* The part of stdout that is the same every time; the caller frees. */
static char *told(const struct program *program) {
    char name[80];
    snprintf(name, sizeof name, "%s.out", program->name);
    char *text = slurp(name), *from = program->from != NULL ? strstr(text, program->from) : NULL;
    memmove(text, from != NULL ? from : "", strlen(from != NULL ? from : "") + 1);
    return text;
}

static int run_failing(const struct program *program, uint64_t n, uint64_t most) {
    char wish[60];
    snprintf(wish, sizeof wish, "%" PRIu64 ",%" PRIu64, n, most);
    setenv("RUGO_FAIL_ALLOCATION", wish, 1);
    int status = run_rugo(program->name, program->arguments);
    unsetenv("RUGO_FAIL_ALLOCATION");
    return status;
}

static void check_told(const struct program *program, const char *expected, const char *when) {
    char *text = told(program);
    if (strcmp(text, expected) != 0)
        fail_msg("%s, %s, tells \"%s\"", program->name, when, text);
    free(text);
}

static void fail_at(const struct program *program, uint64_t n, uint64_t most,
                    const char *expected) {
    char when[80], name[80];
    snprintf(when, sizeof when, "%" PRIu64 " allocations from %" PRIu64 " failed", most, n);
    snprintf(name, sizeof name, "%s.err", program->name);
    if (program->store != NULL)
        remove_store(program->store);
    int status = run_failing(program, n, most);
    char *text = slurp(name);
    if (status >= SANITIZER || (status != 0 && *text == 0))
        fail_msg("%s, %s: status %d, \"%s\"", program->name, when, status, text);
    free(text);
    snprintf(name, sizeof name, "%s.out", program->name);
    /* A table that there is no memory for is reported by a sentence instead. */
    if (status == 0 && !contains(name, "(no memory for a table)"))
        check_told(program, expected, when);
    if (program->store == NULL)
        return;
    if (run_rugo(program->name, program->arguments) != 0)
        fail_msg("%s does not succeed after %s", program->name, when);
    check_told(program, expected, "again");
}

static void each_failure(const struct program *program) {
    if (program->store != NULL)
        remove_store(program->store);
    if (run_failing(program, 0, 0) != 0)
        fail_msg("%s does not succeed", program->name);
    uint64_t total = allocations("allocations"), failed = 0;
    assert_true(total > 0);
    char *expected = told(program);
    assert_true(program->from == NULL || *expected != 0);
    const char *wish = getenv("RUGO_FAULTS");
    bool all = wish != NULL && strcmp(wish, "all") == 0;
    uint64_t most = cases_of(FAILURES), step = all || most == 0 || total < most ? 1 : total / most;
    for (uint64_t n = 0; n < total; n += step, failed += 2) {
        fail_at(program, n, 1, expected);
        fail_at(program, n, program->store != NULL ? SOME : UINT64_MAX, expected);
    }
    print_message("%s: %" PRIu64 " allocations, %" PRIu64 " failures\n", program->name, total,
                  failed);
    free(expected);
}

static int prepare(void **state) {
    static char path[4000];
    (void)state;
    snprintf(path, sizeof path, "%s-failing", rugo());
    setenv("RUGO", path, 1);
    setenv("ASAN_OPTIONS", "exitcode=99", 1);
    setenv("LSAN_OPTIONS", "exitcode=99", 1);
    setenv("RUGO_COUNT_ALLOCATIONS", "allocations", 1);
    spit("study.json", STUDY);
    return run_rugo("prepare", (const char *[]){"run", "--db", "done.db", "--workers", "1",
                                                "study.json", NULL});
}

static void run_of_a_study(void **state) {
    (void)state;
    each_failure(&(struct program){
        .name = "run",
        {"run", "--db", "run.db", "--workers", "1", "--out", "out", "study.json", NULL},
        .from = "\nload",
        .store = "run.db"});
}

/* The id of the one study of done.db. */
static const char *study_id(void) {
    static char id[17];
    assert_int_equal(run_rugo("status", (const char *[]){"status", "--db", "done.db", NULL}), 0);
    char *text = slurp("status.out"), *line = strchr(text, '\n');
    assert_non_null(line);
    snprintf(id, sizeof id, "%.16s", line + 1);
    free(text);
    return id;
}

static void commands_that_show(void **state) {
    (void)state;
    const char *id = study_id();
    const struct program programs[] = {
        {"check", {"check", "study.json", NULL}, NULL, NULL},
        {"json", {"curves", "--db", "done.db", id, NULL}, "", NULL},
        {"csv", {"curves", "--db", "done.db", "--format", "csv", id, NULL}, "", NULL},
        {"report", {"report", "--db", "done.db", id, NULL}, "", NULL},
        {"state", {"status", "--db", "done.db", id, NULL}, "", NULL},
        {"generate", {"generate", "study.json", "-o", "map.csv", NULL}, "", NULL},
        {"characterise", {"characterise", "map.csv", NULL}, "", NULL},
        {"page", {"characterise", "map.csv", "--format", "svg", NULL}, "", NULL},
        {"convert", {"convert", "map.csv", "converted.npy", NULL}, "", NULL},
        {"press",
         {"press", "map.csv", "--loads", "0.05", "--steps", "pressed", "--nodes", "p.csv", NULL},
         "\nboundary",
         NULL},
        {"steps",
         {"generate", "study.json", "--steps", "made", "--nodes", "m.csv", NULL},
         "",
         NULL},
        {"theory", {"theory", "study.json", NULL}, "", NULL},
        {"help", {"help", "run", NULL}, "", NULL},
    };
    for (size_t p = 0; p < sizeof programs / sizeof *programs; p++)
        each_failure(&programs[p]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(run_of_a_study),
        cmocka_unit_test(commands_that_show),
    };
    return cmocka_run_group_tests(tests, prepare, NULL);
}
