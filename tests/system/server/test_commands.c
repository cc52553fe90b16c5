/* Protects: the command line: exit statuses, messages on wrong usage and input, and that a run goes
 * on where it was stopped, however it was stopped. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include "tests/support/small_studies.h"
#include <cjson/cJSON.h>
#include <signal.h>
#include <sqlite3.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int setup(void **state) {
    (void)state;
    spit("one.json", ONE_CASE);
    spit("blocks.json", SEVERAL_BLOCKS);
    spit("broken.json", "{\"name\":");
    spit("wrong.json",
         "{\"name\":\"w\",\"kind\":\"statistics\",\"surface\":{\"hurst\":[0.2,1.4],\"colour\":1}}");
    spit("text.csv", "1,2\n3,x\n");
    return 0;
}

static const struct {
    const char *line;
    int status;
    const char *text; /* on standard error */
} WRONG[] = {
    {"$RUGO", 2, "usage: rugo COMMAND"},
    {"$RUGO dance", 2, "there is no command \"dance\"; see rugo --help"},
    {"$RUGO chekc", 2, "there is no command \"chekc\" (did you mean check?)"},
    {"$RUGO list", 2, "there is no command \"list\" (did you mean status?)"},
    {"$RUGO help rm", 2, "there is no command or topic \"rm\" (did you mean delete?)"},
    {"$RUGO help statu", 2, "\"statu\" (did you mean status?)"},
    {"$RUGO help dance", 2, "there is no command or topic \"dance\""},
    {"$RUGO run", 2, "rugo run: an argument is missing"},
    {"$RUGO run one.json two.json", 2, "unexpected argument two.json"},
    {"$RUGO run --colour red one.json", 2, "unknown option --colour; see"},
    {"$RUGO run --wrokers 2 one.json", 2, "--wrokers (did you mean --workers?)"},
    {"$RUGO generate --file x one.json", 2, "unknown option --file; see"},
    {"$RUGO press -q text.csv", 2, "unknown option -q"},
    {"$RUGO check --schema=1", 2, "--schema takes no value"},
    {"$RUGO help study surface/heigths", 2, "(did you mean /surface/heights?)"},
    {"$RUGO help study surface.like.heigths", 2, "(did you mean /surface/like/heights?)"},
    {"$RUGO run --workers -1 one.json", 2, "--workers -1 is not a whole number in [0, 4096]"},
    {"$RUGO run --workers many one.json", 2, "--workers many is not a whole number"},
    {"$RUGO serve --lease 0", 2, "--lease 0 is not a whole number in [1, 31536000]"},
    {"$RUGO run one.json --db", 2, "--db needs a value"},
    {"$RUGO run one.json --db early.db --out absent/folder", 1, "folder absent/folder: No such"},
    {"test ! -e early.db", 0, ""}, /* before anything was computed */
    {"$RUGO run --out new broken.json", 2, "line 1, column 9"},
    {"$RUGO run one.json --db one.db >/dev/null && $RUGO curves nosuch --db one.db --out new", 1,
     "there is no study \"nosuch\""},
    {"$RUGO export nosuch --db one.db --out new", 1, "there is no study"},
    {"$RUGO theory --out new wrong.json", 2, "/surface/hurst/1"},
    {"test ! -e new", 0, ""}, /* of what was refused no folder is left */
    {"$RUGO theory -o new one.json && test -e new/study.json", 0, ""},
    {"$RUGO curves one --db one.db -o new --replace && test -e new/psd.svg", 0, ""},
    {"$RUGO run one.json --db one.db -o new2 && test -e new2/curves.json", 0, ""},
    {"$RUGO export one --db one.db -o E.ZIP && test -f E.ZIP", 0, ""},
    {"$RUGO plot one --db one.db --quantity psd -o X.SVG && grep -q '<svg' X.SVG", 0, ""},
    {"$RUGO export one --db one.db -o E.TAR", 2, "archives that end in .zip"},
    {"$RUGO generate one.json --picture Z.SVG --format npy", 2,
     "--format npy is of the height map"},
    {"$RUGO run --threads 2 one.json", 2, "--threads (did you mean --workers?)"},
    {"$RUGO work --threads=2", 2, "--threads (did you mean --workers?)"},
    {"$RUGO press --workers 2 text.csv", 2, "--workers (did you mean --threads?)"},
    {"$RUGO plot --output x.svg", 2, "--output (did you mean --out?)"},
    {"$RUGO --version > long && $RUGO -v | cmp - long && $RUGO -V | cmp - long", 0, ""},
    {"$RUGO help study surface --format markdown", 2, "--format markdown is of the topic study"},
    {"$RUGO help run --format markdown", 2, "--format markdown is of the topic study"},
    {"$RUGO help --format markdown", 2, "--format markdown is of the topic study"},
    {"$RUGO status --server h.example/x", 2, "the server's URL h.example/x is not http(s)"},
    {"$RUGO run absent.json", 2, "absent.json: No such file"},
    {"$RUGO run broken.json", 2, "line 1, column 9"},
    {"$RUGO run --set nothing one.json", 2, "\"nothing\" is not PATH=VALUE"},
    {"$RUGO run --set surface/hurst= one.json", 2, "as in surface/hurst=0.8"},
    {"$RUGO run --set hurst=0.5 one.json", 2, "did you mean \"/surface/hurst\"?"},
    {"$RUGO generate one.json -o map.png", 2, "--picture FILE.svg or FILE.png draws the surface"},
    {"$RUGO table", 2, "an argument is missing: rugo table ID"},
    {"$RUGO help stdy", 2, "did you mean study?"},
    {"$RUGO help study hurst", 2, "did you mean /surface/hurst?"},
    {"$RUGO check wrong.json", 2, "/surface/hurst/1: 1.4 is not in (0, 1]"},
    {"$RUGO check wrong.json", 2, "/surface/colour: unknown name"},
    {"$RUGO check --format xml one.json", 2, "--format xml is not text or json"},
    {"$RUGO check", 2, "an argument is missing"},
    {"$RUGO check --set surface.wavelength_ratio=9000 one.json", 2, "/surface"},
    {"$RUGO submit --db a.db --server http://localhost:1 one.json", 2, "exclude each other"},
    {"$RUGO submit --token-file t one.json", 2, "--token-file goes with --server"},
    {"$RUGO submit --server http://127.0.0.1:1 one.json", 1, "127.0.0.1"},
    {"$RUGO status --db absent.db", 1, "there is no database absent.db"},
    {"$RUGO curves --db absent.db 0123456789abcdef", 1, "there is no database"},
    {"$RUGO curves", 2, "an argument is missing"},
    {"$RUGO work --drain --db typo.db || test -e typo.db", 1, "there is no database typo.db"},
    {"$RUGO curves --case -1 x", 2, "--case -1 is not a whole number of 0 or more"},
    {"$RUGO report --db absent.db x", 1, "there is no database"},
    {"$RUGO cancel --db absent.db x", 1, "there is no database"},
    {"$RUGO serve --listen nowhere", 2, "--listen nowhere is not ADDRESS:PORT"},
    {"$RUGO serve --listen elsewhere:8080", 2, "is not ADDRESS:PORT"}, /* a name */
    {"$RUGO serve --listen :", 2, "is not ADDRESS:PORT"},
    {"$RUGO serve --listen ::1", 2, "is not ADDRESS:PORT"},
    {"$RUGO serve --listen +8080", 2, "is not ADDRESS:PORT"},
    {"$RUGO serve --listen 127.0.0.1:99999", 2, "is not ADDRESS:PORT"},
    {"$RUGO serve --listen 0.0.0.0:0", 2, "tokens are needed"},
    {"$RUGO work --lease 5 --server http://localhost:1", 2, "--lease goes with --db"},
    {"$RUGO generate --case 7 one.json", 2, "there is no case 7"},
    {"$RUGO characterise text.csv", 2, "text.csv"},
    {"$RUGO characterise absent.npy", 2, "absent.npy"},
    {"$RUGO press absent.npy", 2, "absent.npy"},
    {"$RUGO press text.csv", 2, "text.csv"},
    {"$RUGO press --loads 0.2,0.1 text.csv", 2, "--loads 0.2,0.1: not up to 1000 rising"},
    {"$RUGO press --model steel text.csv", 2, "--model steel is not halfspace, layered or full"},
    {"$RUGO press --poisson 0.5 text.csv", 2, "--poisson 0.5 is not a number in [0, 0.4999]"},
    {"$RUGO press --counter absent.npy --model full text.csv", 2, "text.csv"},
    {"printf '1,2\\n3,1\\n' > a.csv; $RUGO press --counter absent.npy a.csv", 2,
     "--counter absent.npy: absent.npy"},
    {"$RUGO press --counter a.csv --model full --boundary periodic a.csv", 2,
     "--counter a.csv: the model full has the shape of one rough face"},
    {"printf '1,1\\n1,1\\n' > flat.csv; $RUGO press flat.csv", 2, "flat.csv: the map is flat"},
    {"mkdir -p d && $RUGO run --db d one.json", 2, "is not a file"},
    {"echo junkjunkjunkjunk > junk.db && $RUGO status --db junk.db", 1, "damaged or no database"},
};

static void wrong_usage_and_input(void **state) {
    (void)state;
    for (size_t w = 0; w < sizeof WRONG / sizeof *WRONG; w++) {
        int status = run_shell(WRONG[w].line);
        if (status != WRONG[w].status || !contains("shell.err", WRONG[w].text)) {
            char *told = slurp("shell.err");
            print_error("%s: status %d, %s\n", WRONG[w].line, status, told);
            free(told);
        }
        assert_int_equal(status, WRONG[w].status);
        assert_true(contains("shell.err", WRONG[w].text));
    }
}

/* A port alone is what many type; it never listens beyond this machine. */
static void a_port_is_enough(void **state) {
    (void)state;
    static const char *const LISTEN[] = {"0", ":0", "localhost:0"};
    for (size_t l = 0; l < sizeof LISTEN / sizeof *LISTEN; l++) {
        struct process server;
        const char *const more[] = {"--db", "port.db", "--listen", LISTEN[l], NULL};
        assert_true(serve_start(&server, more) > 0); /* it says 127.0.0.1 */
        process_kill(&server, SIGTERM);
        assert_int_equal(process_wait(&server, 10), 0);
    }
}

static void every_command_has_help(void **state) {
    (void)state;
    static const char *const COMMANDS[] = {
        "run",    "check",  "submit", "status", "curves",   "report",       "wait",   "snapshot",
        "cancel", "retry",  "serve",  "work",   "generate", "characterise", "press",  "theory",
        "plot",   "extend", "delete", "help",   "prune",    "health",       "convert"};
    for (size_t c = 0; c < sizeof COMMANDS / sizeof *COMMANDS; c++) {
        char line[120], usage[80];
        snprintf(line, sizeof line, "$RUGO %s --help && $RUGO help %s | cmp - shell.out",
                 COMMANDS[c], COMMANDS[c]);
        snprintf(usage, sizeof usage, "usage: rugo %s", COMMANDS[c]);
        assert_int_equal(run_shell(line), 0);
        assert_true(contains("shell.out", usage));
        assert_int_equal(run_shell("$RUGO help"), 0);
        assert_true(contains("shell.out", COMMANDS[c]));
    }
    assert_int_equal(run_shell("$RUGO --help && $RUGO --version | grep -Eq '^rugo [0-9.]+[+]"
                               "([0-9a-f]+(-dirty)?|unknown)$'"),
                     0);
}

static void help_tells_of_a_parameter(void **state) {
    (void)state;
    assert_int_equal(run_shell("$RUGO help study surface.heights"), 0);
    assert_true(contains("shell.out", "/surface/heights/shape"));
    assert_false(contains("shell.out", "/surface/hurst"));
    assert_int_equal(run_shell("$RUGO help study weather"), 2);
    assert_true(contains("shell.err", "a study has no parameter \"weather\""));
    assert_int_equal(run_shell("$RUGO help run weather"), 2);
    assert_int_equal(run_shell("$RUGO help study --format markdown"), 0);
    assert_true(contains("shell.out", "| `/contact/model` | one name, or a list |"));
}

/* A case of steep faces has a range of CPU time, in text and JSON; one of gentle faces has none. */
static void check_says_between_what_a_steep_study_lies(void **state) {
    (void)state;
    assert_int_equal(
        run_shell("printf '%s' '{\"name\": \"steep\", \"kind\": \"contact\", \"realisations\": 4, "
                  "\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 4, "
                  "\"rms_slope\": [0.1, 1.2]}, "
                  "\"contact\": {\"model\": \"full\", \"levels\": [8]}}' >steep.json && "
                  "$RUGO check steep.json --format json >plan.json && $RUGO check steep.json"),
        0);
    assert_true(contains("shell.out", "in brackets: what nine of ten such studies take"));
    char *text = slurp("plan.json");
    cJSON *plan = cJSON_Parse(text);
    const cJSON *cases = cJSON_GetObjectItem(plan, "cases"), *steep = cJSON_GetArrayItem(cases, 1);
    assert_null(cJSON_GetObjectItem(cJSON_GetArrayItem(cases, 0), "seconds_most"));
    const cJSON *const documents[] = {plan, steep};
    for (size_t a = 0; a < 2; a++) {
        const double least = cJSON_GetObjectItem(documents[a], "seconds_least")->valuedouble;
        const double seconds = cJSON_GetObjectItem(documents[a], "seconds")->valuedouble;
        assert_true(least > 0 && least < seconds);
        assert_true(seconds < cJSON_GetObjectItem(documents[a], "seconds_most")->valuedouble);
    }
    cJSON_Delete(plan);
    free(text);
}

/* Gaussian heights beside others have the moments of Gaussian ones; alone they need no column. */
static void check_knows_the_moments_of_gaussian_heights(void **state) {
    (void)state;
    static const char SWEPT[] =
        "--set '/surface/heights/distribution=[\"gaussian\",\"weibull_max\"]' "
        "--set /surface/heights/shape=1.5";
    char command[200];
    snprintf(command, sizeof command, "$RUGO check one.json %s", SWEPT);
    assert_int_equal(run_shell(command), 0);
    assert_true(contains("shell.out", "skewness  kurtosis\n"));
    assert_true(contains("shell.out", " 0         3\n"));
    assert_true(contains("shell.out", "-1.072    4.3904\n"));
    assert_int_equal(run_shell("$RUGO check one.json"), 0);
    assert_false(contains("shell.out", "skewness  "));
}

/* Its formatter, where there is one, finds nothing to warn of; a shell reads the completion. */
static void the_manual_page_is_sound(void **state) {
    (void)state;
    assert_int_equal(run_shell("$RUGO help man >rugo.1 && $RUGO help bash >completion"), 0);
    assert_true(contains("rugo.1", "\\fB\\-\\-workers N\\fR"));
    assert_int_equal(
        run_shell("if command -v groff; then groff -man -ww -Tutf8 rugo.1 >/dev/null; fi"), 0);
    char *warnings = slurp("shell.err");
    assert_string_equal(warnings, "");
    free(warnings);
    assert_int_equal(run_shell("if command -v bash; then bash -n completion; fi"), 0);
}

/* The curves of the only study of a database, without what names the run. */
static char *curves_of(const char *database) {
    char line[300];
    snprintf(line, sizeof line,
             "$RUGO curves --db %s $($RUGO status --db %s | awk 'NR == 2 {print $1}')", database,
             database);
    assert_int_equal(run_shell(line), 0);
    char *text = slurp("shell.out"), *cases = strstr(text, "\"cases\":");
    assert_non_null(cases);
    memmove(text, cases, strlen(cases) + 1);
    return text;
}

/* As time would: the leases of a killed process have run out. */
static void void_leases(const char *database) {
    sqlite3 *db = NULL;
    assert_int_equal(sqlite3_open(database, &db), SQLITE_OK);
    assert_int_equal(sqlite3_exec(db, "UPDATE job SET lease_until = 0 WHERE state = 'running'",
                                  NULL, NULL, NULL),
                     SQLITE_OK);
    sqlite3_close(db);
}

/* A run under a sanitizer, on a busy machine, takes its time until the study is in the database. */
static void wait_for_jobs(const char *database) {
    bool found = false;
    for (int tries = 0; tries < 500 && !found; tries++) {
        sqlite3 *db = NULL;
        sleep_ms(20);
        found = sqlite3_open_v2(database, &db, SQLITE_OPEN_READWRITE, NULL) == SQLITE_OK &&
                sqlite3_exec(db, "SELECT id FROM job", NULL, NULL, NULL) == SQLITE_OK;
        sqlite3_close(db);
    }
    assert_true(found);
}

static void a_run_goes_on_where_it_was(void **state) {
    (void)state;
    struct process run;
    const char *const killed[] = {"run", "--db",        "killed.db", "--workers",
                                  "1",   "blocks.json", NULL};
    const char *const stopped[] = {"run", "--db",        "stopped.db", "--workers",
                                   "1",   "blocks.json", NULL};
    assert_int_equal(run_shell("$RUGO run --db calm.db --workers 1 blocks.json"), 0);
    process_start(&run, "kill", killed);
    wait_for_jobs("killed.db");
    sleep_ms(120);
    process_kill(&run, SIGKILL);
    process_wait(&run, 10);
    for (int interrupt = 0; interrupt < 2; interrupt++) {
        process_start(&run, "stop", stopped);
        sleep_ms(120);
        process_kill(&run, SIGINT);
        int status = process_wait(&run, 20);
        assert_true(status == 130 || status == 0); /* 0: it was quicker than the signal */
    }
    assert_int_equal(run_shell("$RUGO run --db stopped.db blocks.json"), 0);
    char *calm = curves_of("calm.db"), *after = curves_of("stopped.db");
    assert_string_equal(after, calm);
    free(after);
    void_leases("killed.db"); /* or wait 20 s for them */
    assert_int_equal(run_shell("$RUGO run --db killed.db blocks.json"), 0);
    after = curves_of("killed.db");
    assert_string_equal(after, calm);
    free(after);
    free(calm);
}

static void a_finished_run_only_prints(void **state) {
    (void)state;
    assert_int_equal(run_shell("$RUGO run --db done.db one.json"), 0);
    char *first = slurp("shell.out");
    assert_int_equal(run_shell("$RUGO run --db done.db one.json"), 0);
    char *second = slurp("shell.out"), *told = slurp("shell.err");
    assert_string_equal(first, second);
    assert_string_equal(told, "");
    assert_non_null(strstr(first, "summit_density"));
    free(first);
    char *second_table = second;
    free(told);
    assert_int_equal(
        run_shell("$RUGO run --db done.db --out out one.json && test -s out/curves.json && test -s "
                  "out/curves.csv && grep -q '<metadata>.*0.1.0+' out/psd.svg && grep -q '</svg>' "
                  "out/summit_height_pdf.svg"),
        0);
    assert_int_equal(
        run_shell(
            "id=$($RUGO status --db done.db | awk 'NR == 2 {print $1}'); $RUGO report --db "
            "done.db $id && $RUGO status --db done.db $id && $RUGO curves --db done.db --format "
            "csv --quantity psd $id | grep -q ,psd, && $RUGO snapshot --db done.db copy.db && "
            "$RUGO status --db copy.db $id | grep -q done && ! $RUGO cancel --db done.db $id && "
            "$RUGO retry --db done.db $id"),
        0);
    assert_int_equal(
        run_shell(
            "id=$($RUGO status --db done.db | awk 'NR == 2 {print $1}'); $RUGO show --db done.db "
            "$id > shown.json && $RUGO run --db done.db shown.json"),
        0); /* the same study: nothing is computed again */
    char *again = slurp("shell.out");
    assert_int_equal(
        run_shell(
            "$RUGO table --db done.db one --columns summit_density --where hurst=0.8 --format csv "
            "> table.csv && grep -q '^# study: one, statistics ' table.csv && grep -q "
            "'^case,realisations,summit_density,summit_density_standard_error,' table.csv && "
            "grep -q '^0,5,0' table.csv"),
        0);
    assert_int_equal(run_shell("$RUGO table --db done.db one --where hurst=0.7"), 2);
    assert_true(contains("shell.err", "no case has /surface/hurst = 0.7; there is 0.8"));
    assert_string_equal(again, second_table);
    free(again);
    free(second_table);
    assert_int_equal(run_shell("$RUGO snapshot --db done.db copy.db"), 2);
    assert_true(contains("shell.err", "copy.db exists"));
}

static void output_that_cannot_be_written_is_an_error(void **state) {
    (void)state;
    assert_int_equal(run_shell("$RUGO check one.json > /dev/full"), 1);
    assert_true(contains("shell.err", "cannot write the output"));
    assert_int_equal(run_shell("$RUGO run --db full.db one.json > /dev/full"), 1);
    assert_int_equal(run_shell("$RUGO run --db full.db --out /dev/null/out one.json"), 1);
}

/* A limit on the size of files stands for a full disk: a clear word, and with room again the run
 * goes on. */
static void a_full_disk_loses_nothing(void **state) {
    (void)state;
    int status =
        run_shell("trap '' XFSZ; ulimit -f 100; $RUGO run --db tight.db --workers 1 blocks.json");
    assert_int_equal(status, 1);
    assert_true(contains("shell.err", "tight.db"));
    assert_int_equal(run_shell("$RUGO run --db tight.db --workers 1 blocks.json"), 0);
    char *calm = curves_of("calm.db"), *tight = curves_of("tight.db");
    assert_string_equal(tight, calm);
    free(calm);
    free(tight);
}

/* What theory expects needs no study: alpha of the discrete sums (F2.6), a picture, and faults. */
static void theory_needs_no_surface(void **state) {
    (void)state;
    assert_int_equal(
        run_shell("$RUGO theory --set surface/hurst=0.8 --set surface/wavelength_ratio=8"), 0);
    assert_true(contains("shell.out", "5.3368") && contains("shell.out", "summit_density"));
    spit("faces.json", "{\"name\": \"f\", \"kind\": \"contact\", \"seed\": 1, \"realisations\": 1,"
                       " \"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 4},"
                       " \"counter_surface\": {\"hurst\": 0.5, \"wavelength_ratio\": 4}}");
    assert_int_equal(run_shell("$RUGO theory faces.json > faces.out 2> faces.err && "
                               "grep -q 'first face alone' faces.err"),
                     0);
    assert_int_equal(run_shell("$RUGO theory one.json --format json > theory.json && "
                               "$RUGO theory one.json --format csv > theory.csv && "
                               "$RUGO theory one.json --format svg > theory.svg && "
                               "$RUGO theory one.json --out expected"),
                     0);
    assert_true(contains("theory.json", "\"series\":\"grid\""));
    assert_true(contains("theory.csv", "nayak_alpha_by_hurst"));
    assert_true(contains("theory.svg", "</svg>"));
    assert_true(contains("expected/summit_mean_curvature.svg", "</svg>"));
    assert_int_equal(
        run_shell("$RUGO theory --set surface/hurst=2 --set surface/wavelength_ratio=8"), 2);
    assert_true(contains("shell.err", "/surface/hurst"));
    assert_int_equal(run_shell("$RUGO theory one.json --format svg --quantity none"), 2);
    assert_int_equal(run_shell("$RUGO theory one.json --quantity psdd"), 2);
    assert_true(contains("shell.err", "no quantity 'psdd' in this study (did you mean psd?)"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wrong_usage_and_input),
        cmocka_unit_test(a_port_is_enough),
        cmocka_unit_test(every_command_has_help),
        cmocka_unit_test(help_tells_of_a_parameter),
        cmocka_unit_test(theory_needs_no_surface),
        cmocka_unit_test(check_says_between_what_a_steep_study_lies),
        cmocka_unit_test(check_knows_the_moments_of_gaussian_heights),
        cmocka_unit_test(the_manual_page_is_sound),
        cmocka_unit_test(a_run_goes_on_where_it_was),
        cmocka_unit_test(a_finished_run_only_prints),
        cmocka_unit_test(output_that_cannot_be_written_is_an_error),
        cmocka_unit_test(a_full_disk_loses_nothing),
    };
    return cmocka_run_group_tests(tests, setup, NULL);
}
