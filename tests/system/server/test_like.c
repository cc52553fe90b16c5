/* Protects: a study that names a measured surface is fitted where the command runs, relative to the
 * study's folder; here and over HTTP it gives the same curves, and the service never needs the
 * file; so it does where surfaces hold the patch, or are like several maps; a study with a file
 * alone is refused over HTTP with the command to use; check shows what was fitted, and what it
 * prints is a study. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define STUDY(like)                                                                                \
    "{\"name\":\"alike\",\"kind\":\"statistics\",\"realisations\":30,\"surface\":{\"like\":" like  \
    "}}"
#define LIKE                                                                                       \
    "{\"file\":\"patch.npy\",\"crop\":\"0,0,48,40\",\"dx\":0.25,\"heights\":\"gaussian\","         \
    "\"despike\":true,\"rotate\":90}"

/* A folder with a map and studies of it. */
static int make_files(void **state) {
    (void)state;
    mkdir("data", 0777);
    spit("data/alike.json", STUDY(LIKE));
    spit("data/bare.json", STUDY("\"patch.npy\""));
    spit("made.json",
         "{\"name\":\"made\",\"kind\":\"statistics\",\"seed\":3,\"surface\":{\"hurst\":"
         "0.7,\"wavelength_ratio\":16,\"rolloff_ratio\":2,\"length_ratio\":2,"
         "\"points_per_wavelength\":4,\"rms_slope\":0.1}}");
    return run_shell("$RUGO generate made.json -o data/patch.npy");
}

static void near_and_over_http(void **state) {
    (void)state;
    struct process server;
    char url[64];
    assert_int_equal(run_shell("$RUGO run --db near.db --workers 2 data/alike.json"), 0);
    snprintf(url, sizeof url, "http://127.0.0.1:%u",
             serve_start(&server, (const char *[]){"--db", "far.db", NULL}));
    assert_int_equal(
        run_rugo("submit", (const char *[]){"submit", "--server", url, "data/alike.json", NULL}),
        0);
    assert_int_equal(run_shell("mv data/patch.npy data/gone.npy"),
                     0); /* nobody needs it any more */
    assert_int_equal(run_rugo("work", (const char *[]){"work", "--server", url, "--drain", NULL}),
                     0);
    assert_int_equal(run_shell("mv data/gone.npy data/patch.npy"), 0);
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 20), 0);
    assert_int_equal(run_shell("$RUGO curves --db near.db alike > near.json"), 0);
    assert_int_equal(run_shell("$RUGO curves --db far.db alike > far.json"), 0);
    char *near_cases = slurp_from("near.json", "\"cases\":"),
         *far_cases = slurp_from("far.json", "\"cases\":");
    assert_string_equal(near_cases, far_cases);
    assert_non_null(strstr(near_cases, "\"/surface/like/sha256\":\""));
    free(near_cases);
    free(far_cases);
    assert_true(contains("near.json", "\"percentile_skewness\":{"));
    static const char *const SHOWN[][2] = {
        {"curves --db near.db alike --format csv", "# like: patch.npy, SHA-256 "},
        {"curves --db near.db alike --format table",
         "the measured surface patch.npy among sub-maps"},
        {"table --db near.db alike --columns percentile_kurtosis,measured_kurtosis",
         "measured_kurtosis"},
        {"plot --db near.db alike --quantity psd -o near.svg && cat near.svg",
         "like&quot;:{&quot;file&quot;:&quot;patch.npy"}};
    for (size_t s = 0; s < sizeof SHOWN / sizeof *SHOWN; s++) {
        char line[200];
        snprintf(line, sizeof line, "$RUGO %s", SHOWN[s][0]);
        assert_int_equal(run_shell(line), 0);
        if (!contains("shell.out", SHOWN[s][1]))
            fail_msg("%s: no \"%s\"", SHOWN[s][0], SHOWN[s][1]);
    }
}

/* Sub-maps that do not fit into the cell are reported, not left out in silence. */
static void too_small_a_cell(void **state) {
    (void)state;
    assert_int_equal(run_shell("$RUGO run --db small.db data/alike.json --set "
                               "surface/length_ratio=2 --set name=small --set realisations=2"),
                     0);
    assert_true(contains("shell.out", "patch.npy is not ranked among random ones"));
    assert_false(contains("shell.out", "percentile"));
}

/* The map and a sub-map of each surface are pressed alike; other loads leave it out. */
static void contact(void **state) {
    (void)state;
    spit("data/pressed.json",
         "{\"name\":\"pressed\",\"kind\":\"contact\",\"realisations\":3,\"surface\":{\"like\":" LIKE
         "},\"contact\":{\"cell_error\":\"none\",\"pressures\":{\"values\":[0.1,0.2]}}}");
    assert_int_equal(run_shell("$RUGO run --db pressed.db data/pressed.json"), 0);
    assert_true(contains("shell.out", "contact_area_last"));
    assert_int_equal(run_shell("$RUGO table --db pressed.db pressed --columns "
                               "percentile_contact_area@0.1,percentile_mean_gap@0.2"),
                     0);
    assert_true(contains("shell.out", "percentile_contact_area@0.1"));
    assert_int_equal(
        run_shell("sed 's/0,48,40\"/0,48,40\",\"contact\":\"none\"/' data/pressed.json > "
                  "data/none.json && $RUGO check data/none.json"),
        0);
    assert_false(contains("shell.out", "contact_areas"));
}

/* Both here and by a service that has no file. */
static void check_both(const char *name) {
    struct process server;
    char line[300], url[64];
    snprintf(line, sizeof line, "$RUGO run --db %s-near.db data/%s.json", name, name);
    assert_int_equal(run_shell(line), 0);
    snprintf(line, sizeof line, "%s-far.db", name);
    snprintf(url, sizeof url, "http://127.0.0.1:%u",
             serve_start(&server, (const char *[]){"--db", line, NULL}));
    snprintf(line, sizeof line, "data/%s.json", name);
    assert_int_equal(run_rugo("submit", (const char *[]){"submit", "--server", url, line, NULL}),
                     0);
    assert_int_equal(run_rugo("work", (const char *[]){"work", "--server", url, "--drain", NULL}),
                     0);
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 20), 0);
    snprintf(line, sizeof line,
             "for d in near far; do $RUGO curves --db %s-$d.db %s > %s-$d.json || exit 1; done",
             name, name, name);
    assert_int_equal(run_shell(line), 0);
    snprintf(line, sizeof line, "%s-near.json", name);
    char *near_cases = slurp_from(line, "\"cases\":");
    snprintf(line, sizeof line, "%s-far.json", name);
    char *far_cases = slurp_from(line, "\"cases\":");
    assert_string_equal(near_cases, far_cases);
    free(near_cases);
    free(far_cases);
}

static void surfaces_hold_the_patch(void **state) {
    (void)state;
    spit("data/held.json",
         "{\"name\":\"held\",\"kind\":\"contact\",\"realisations\":3,\"surface\":{\"like\":"
         "{\"file\":\"patch.npy\",\"crop\":\"0,0,40,32\",\"dx\":0.25,\"hold\":true}},"
         "\"contact\":{\"pressures\":{\"values\":[0.1,0.2]}}}");
    check_both("held");
    assert_true(contains("held-near.json", "\"held_contact_area\""));
    assert_true(contains("held-near.json", "\"patch_bound\":"));
    assert_int_equal(run_shell("$RUGO generate data/held.json --realisation 1 -o held.npy"), 0);
    assert_int_equal(run_shell("$RUGO check data/held.json"), 0);
    assert_true(contains("shell.out", "80 x 64"));
    assert_int_equal(run_shell("$RUGO check data/held.json --set surface/length_ratio=8"), 2);
    assert_true(contains("shell.err", "twice the sides of the patch"));
}

static void several_maps_are_of_one_surface(void **state) {
    (void)state;
    assert_int_equal(run_shell("$RUGO convert data/patch.npy data/fine.csv --crop 0,0,64,64 --dx "
                               "0.25 && $RUGO convert data/patch.npy data/wide.csv --crop "
                               "0,0,128,128 --stride 2 --dx 0.25"),
                     0);
    spit("data/several.json", "{\"name\":\"several\",\"kind\":\"statistics\",\"realisations\":3,"
                              "\"surface\":{\"like\":[\"fine.csv\",\"wide.csv\"]}}");
    check_both("several");
    assert_true(contains("several-near.json", "wide.csv, SHA-256 "));
    assert_true(contains("several-near.json", "\"percentile_rms_slope\":{"));
    assert_true(contains("several-near.json", "\"patch_bound\":"));
}

/* A study and the maps that it names are sent as a form; what comes back is submitted, and a worker
 * without the files computes what a command with them does. */
static void several_maps_go_over_http(void **state) {
    (void)state;
    struct process server;
    char url[64], line[600];
    spit("data/two.json", STUDY("{\"file\":[\"one.npy\",\"two.npy\"],\"dx\":0.25,"
                                "\"heights\":\"gaussian\"}"));
    assert_int_equal(run_shell("cd data && $RUGO convert patch.npy one.npy --dx 0.25 && $RUGO "
                               "convert patch.npy two.npy --dx 0.25 --crop 0,0,48,48"),
                     0);
    assert_int_equal(run_shell("$RUGO run --db near2.db --workers 2 data/two.json"), 0);
    const unsigned port = serve_start(&server, (const char *[]){"--db", "far2.db", NULL});
    snprintf(url, sizeof url, "http://127.0.0.1:%u", port);
    snprintf(line, sizeof line,
             "mkdir -p away && cd data && curl -sS -f -F map=@one.npy -F map=@two.npy -F "
             "study=@two.json '%s/v1/characterise?format=study' -o ../away/fitted.json && cd "
             "../away && $RUGO submit --server %s fitted.json && $RUGO work --server %s --drain",
             url, url, url);
    assert_int_equal(run_shell(line), 0);
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 20), 0);
    assert_int_equal(run_shell("$RUGO curves --db near2.db alike > near.json && $RUGO curves --db "
                               "far2.db alike > far.json"),
                     0);
    char *near_cases = slurp_from("near.json", "\"cases\":"),
         *far_cases = slurp_from("far.json", "\"cases\":");
    assert_string_equal(near_cases, far_cases);
    assert_non_null(strstr(near_cases, "\"/surface/like/others\":\"two.npy"));
    free(near_cases);
    free(far_cases);
}

static void a_file_alone_is_refused_over_http(void **state) {
    (void)state;
    struct process server;
    unsigned port = serve_start(&server, (const char *[]){"--db", "bare.db", NULL});
    static const char *const STUDIES[] = {STUDY("\"patch.npy\""), STUDY(LIKE)};
    for (size_t s = 0; s < 2; s++) {
        char *answer = NULL;
        assert_int_equal(http_exchange(port, "POST", "/v1/studies",
                                       "Content-Type: application/json\r\n", STUDIES[s], &answer),
                         422);
        assert_non_null(strstr(answer, "\"/surface/like\""));
        assert_non_null(strstr(answer, "rugo check --study"));
        free(answer);
    }
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 20), 0);
}

static void check_shows_what_was_fitted(void **state) {
    (void)state;
    assert_int_equal(run_shell("$RUGO check data/alike.json"), 0);
    assert_true(contains("shell.out", "/surface/like/sha256"));
    assert_true(contains("shell.out", "/surface/spectrum/wave_number"));
    assert_int_equal(run_shell("$RUGO check --study data/alike.json > fitted.json"), 0);
    assert_int_equal(run_shell("$RUGO check --study fitted.json > again.json"), 0);
    assert_int_equal(run_shell("cmp fitted.json again.json"), 0);
    assert_int_equal(
        run_shell("$RUGO check data/bare.json --set surface/heights/distribution=gaussian"), 0);
    assert_true(contains("shell.out", "/surface/like/heights                \"given\""));
    assert_int_equal(run_shell("$RUGO check data/bare.json --set surface/heights/keep=heights"), 0);
    assert_true(contains("shell.out", "/surface/like/heights                \"quantiles\""));
}

static void faults_are_named(void **state) {
    (void)state;
    static const struct {
        const char *like, *words;
    } FAULTS[] = {
        {"\"none.npy\"", "/surface/like: data/none.npy: No such file"},
        {"[\"patch.npy\",7]", "/surface/like: a list of files has the names"},
        {"{\"file\":[],\"dx\":0.25}", "/surface/like: a list without files"},
        {"{\"file\":[\"patch.npy\",\"none.npy\"],\"dx\":1}", "data/none.npy: No such file"},
        {"{\"file\":[\"patch.npy\",\"patch.npy\"],\"dx\":1,\"hold\":true}",
         "surfaces hold one map"},
        {"{\"file\":[\"patch.npy\",\"patch.npy\"],\"dx\":1,\"heights\":\"fit\"}",
         "of several allowed: quantiles, gaussian"},
        {"7", "/surface/like: neither the name of a file"},
        {"{\"file\":\"patch.npy\",\"detrend\":\"cubic\"}", "\"detrend\": \"cubic\" is not auto|"},
        {"{\"file\":\"patch.npy\",\"trend\":\"plane\"}",
         "unknown name \"trend\"; there are file, "},
        {"{\"detrend\":\"plane\"}", "\"file\" is missing"},
        {"{\"file\":\"patch.npy\",\"crop\":\"0,0,4,4\"}", "/surface/like: data/patch.npy: "},
    };
    for (size_t f = 0; f < sizeof FAULTS / sizeof *FAULTS; f++) {
        char study[400];
        snprintf(study, sizeof study, STUDY("%s"), FAULTS[f].like);
        spit("data/wrong.json", study);
        assert_int_equal(run_shell("$RUGO check data/wrong.json"), 2);
        if (!contains("shell.err", FAULTS[f].words))
            fail_msg("no \"%s\" in %s", FAULTS[f].words, slurp("shell.err"));
    }
}

/* What is printed as a study is one: heights that differ by rounding alone, so far from 0, are in
 * none, and nothing is printed. */
static void what_no_study_takes_is_refused(void **state) {
    (void)state;
    spit("data/far.awk", "BEGIN { for (j = 0; j < 24; j++) for (i = 0; i < 24; i++)\n"
                         "printf \"%.17g%s\", 5e15 + int(3 * sin(0.2 * i * i + j * j) + i * i / "
                         "20), i < 23 ? \",\" : "
                         "\"\\n\" }\n");
    assert_int_equal(run_shell("awk -f data/far.awk > data/far.csv"), 0);
    assert_int_equal(run_shell("$RUGO characterise data/far.csv --format study"), 0);
    assert_int_equal(run_shell("$RUGO characterise data/far.csv --detrend none --format study"), 2);
    assert_true(
        contains("shell.err", "no study can be made of the map: /surface/heights/quantile"));
    assert_false(contains("shell.out", "{"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(near_and_over_http),
        cmocka_unit_test(too_small_a_cell),
        cmocka_unit_test(contact),
        cmocka_unit_test(surfaces_hold_the_patch),
        cmocka_unit_test(several_maps_are_of_one_surface),
        cmocka_unit_test(several_maps_go_over_http),
        cmocka_unit_test(a_file_alone_is_refused_over_http),
        cmocka_unit_test(check_shows_what_was_fitted),
        cmocka_unit_test(faults_are_named),
        cmocka_unit_test(what_no_study_takes_is_refused),
    };
    return cmocka_run_group_tests(tests, make_files, NULL);
}
