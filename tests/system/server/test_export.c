/* Protects: an exported study is whole, repeats bit for bit, and is the same archive however often
 * and from wherever it is written; CITATION.cff names this version. */
#include "core/rugo.h"
#include "tests/support/check.h"
#include "tests/support/count_files.h"
#include "tests/support/process.h"
#include "tests/support/small_studies.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zip.h>

static struct process server;
static char url[64];

static int start(void **state) {
    (void)state;
    spit("one.json", ONE_CASE);
    snprintf(url, sizeof url, "http://127.0.0.1:%u", serve_start(&server, NULL));
    return run_rugo("run",
                    (const char *[]){"run", "one.json", "--db", "rugo.db", "--workers", "1", NULL});
}

static int stop(void **state) {
    (void)state;
    process_kill(&server, SIGTERM);
    return process_wait(&server, 15);
}

static int export(const char *place, const char *where, const char *out, const char *more) {
    return run_rugo("export",
                    (const char *[]){"export", "one", place, where, "-o", out, more, NULL});
}

static void assert_same_files(const char *a, const char *b) {
    char line[200];
    snprintf(line, sizeof line, "cmp %s %s", a, b);
    assert_int_equal(run_shell(line), 0);
}

static void the_same_archive_again(void **state) {
    (void)state;
    assert_int_equal(export("--db", "rugo.db", "a.zip", NULL), 0);
    assert_true(contains("export.out", "a.zip: "));
    assert_int_equal(export("--db", "rugo.db", "b.zip", NULL), 0);
    assert_int_equal(export("--server", url, "c.zip", NULL), 0);
    assert_same_files("a.zip", "b.zip");
    assert_same_files("a.zip", "c.zip");
}

/* The names in the archive stand below one folder, in their order, with one date. */
static void what_the_archive_holds(void **state) {
    (void)state;
    static const char *const HELD[] = {
        "README.txt",  "curves.csv", "curves.json", "provenance.json", "psd.svg",
        "report.json", "report.txt", "scalars.csv", "study.json",      "table.csv",
    };
    size_t found = 0;
    char last[256] = "";
    zip_t *zip = zip_open("a.zip", ZIP_RDONLY, NULL);
    assert_non_null(zip);
    for (zip_int64_t n = 0; n < zip_get_num_entries(zip, 0); n++) {
        const char *name = zip_get_name(zip, (zip_uint64_t)n, 0);
        assert_true(strncmp(name, "one-", 4) == 0 && strchr(name, '/') != NULL);
        assert_true(strcmp(last, name) < 0);
        snprintf(last, sizeof last, "%s", name);
        found +=
            found < sizeof HELD / sizeof *HELD && strcmp(strchr(name, '/') + 1, HELD[found]) == 0;
    }
    assert_int_equal(found, sizeof HELD / sizeof *HELD);
    zip_discard(zip);
}

static void a_folder_repeats_the_study(void **state) {
    (void)state;
    assert_int_equal(export("--db", "rugo.db", "folder", NULL), 0);
    assert_true(contains("folder/README.txt", "How to repeat it"));
    assert_true(contains("folder/provenance.json", "\"seed\": \""));
    assert_true(contains("folder/scalars.csv", "summit_density"));
    assert_int_equal(run_shell("cd folder && $RUGO run study.json --db repeated.db --out repeated "
                               "--workers 1 && grep -v '^#' curves.csv >old && grep -v '^#' "
                               "repeated/curves.csv | cmp - old"),
                     0);
}

static void nothing_is_written_over(void **state) {
    (void)state;
    assert_int_equal(export("--db", "rugo.db", "a.zip", NULL), 2);
    assert_true(contains("export.err", "a.zip exists"));
    assert_int_equal(export("--db", "rugo.db", "a.zip", "--replace"), 0);
    assert_int_equal(export("--db", "rugo.db", "a.tar.gz", NULL), 2);
    assert_true(contains("export.err", "archives that end in .zip"));
    assert_int_equal(run_shell("mkdir own && echo mine >own/README.txt"), 0);
    assert_int_equal(export("--db", "rugo.db", "own", NULL), 2);
    assert_true(contains("own/README.txt", "mine"));
    assert_int_equal(run_shell("ls -a | grep rugo-export"), 1); /* nothing is left beside it */
}

/* Ctrl-C in the midst leaves neither the files of the archive nor a part of it. */
static void a_stopped_export_leaves_nothing(void **state) {
    (void)state;
    static const char *const STEPS[] = {".rugo-export-*", ".rugo-export-*/README.txt",
                                        "stop.zip.*"};
    for (size_t s = 0; s < sizeof STEPS / sizeof *STEPS; s++) {
        struct process process;
        process_start(&process, "stop",
                      (const char *[]){"export", "one", "--db", "rugo.db", "-o", "stop.zip", NULL});
        process_wait_for_file(&process, STEPS[s]);
        process_kill(&process, SIGINT);
        int status = process_wait(&process, 20);
        assert_true(status == 0 || status == 130);
        assert_int_equal(count_files(".rugo-export-*") + count_files("stop.zip.*"), 0);
        assert_int_equal(count_files("stop.zip"), status == 0);
        print_message("interrupted at %s: %d\n", STEPS[s], status);
        (void)unlink("stop.zip");
    }
}

static void the_citation_has_this_version(void **state) {
    (void)state;
    char path[512];
    const char *source = getenv("RUGO_SOURCE");
    snprintf(path, sizeof path, "%.400s/CITATION.cff", source != NULL ? source : ".");
    assert_true(contains(path, "\nversion: " RUGO_VERSION "\n"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_same_archive_again),
        cmocka_unit_test(what_the_archive_holds),
        cmocka_unit_test(a_folder_repeats_the_study),
        cmocka_unit_test(nothing_is_written_over),
        cmocka_unit_test(a_stopped_export_leaves_nothing),
        cmocka_unit_test(the_citation_has_this_version),
    };
    return cmocka_run_group_tests(tests, start, stop);
}
