/* Protects: a contact study is shown by every command: tables of area against load with their
 * errors, the report of what models, levels and estimators cost, pictures, tables, views. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

#define PRESSED(hurst, cells)                                                                      \
    "{\"name\":\"pressed\",\"kind\":\"contact\",\"seed\":5,\"realisations\":4,\"surface\":{"       \
    "\"dimension\":1,\"hurst\":" hurst ",\"wavelength_ratio\":4,\"length_ratio\":2},\"contact\":{" \
    "\"cell_error\":\"" cells                                                                      \
    "\",\"model\":[\"halfspace\",\"layered\"],\"levels\":[4,8],\"pressures\":{\"to\":0.3,"         \
    "\"steps\":30},\"pressure_pdf\":{\"at\":[0.1,0.3]}}}"

static int setup(void **state) {
    (void)state;
    spit("pressed.json", PRESSED("0.8", "probed"));
    spit("many.json", PRESSED("[0.2,0.3,0.4,0.5,0.6]", "none"));
    spit("steep.json",
         "{\"name\":\"steep\",\"kind\":\"contact\",\"seed\":3,\"realisations\":8,\"surface\":{"
         "\"dimension\":1,\"hurst\":0.8,\"wavelength_ratio\":2,\"length_ratio\":2,"
         "\"points_per_wavelength\":6,\"rms_slope\":1.2},\"contact\":{\"model\":[\"full\","
         "\"layered\"],\"block_height\":{\"lengths\":1},\"cell_error\":\"none\",\"time_limit\":0.3,"
         "\"pressures\":{\"to\":0.5,\"steps\":3}}}");
    spit("wave.json",
         "{\"name\":\"wave\",\"kind\":\"contact\",\"realisations\":2,\"surface\":{\"dimension\":1,"
         "\"hurst\":0.8,"
         "\"length_ratio\":1,\"wavelength_ratio\":1,\"points_per_wavelength\":64},\"contact\":{"
         "\"pressures\":{\"values\":[0.1,0.4]}}}");
    return 0;
}

/* A shell line with $RUGO and, of $DB, $ID; it must succeed. Output goes to shell.out. */
static void shell(const char *database, const char *line) {
    char command[900];
    snprintf(command, sizeof command,
             "RUGO='%s'; DB=%s; ID=$($RUGO status --db $DB 2>/dev/null | awk 'NR == 2 {print "
             "$1}'); { %s ; } >shell.out 2>shell.err",
             rugo(), database, line);
    int status = system(command);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        fail_msg("%s: status %d", line, status);
}

static void check_shown(const char *const *texts) {
    char *out = slurp("shell.out");
    for (; *texts; texts++)
        if (!strstr(out, *texts))
            fail_msg("no \"%s\" in\n%s", *texts, out);
    free(out);
}

static void a_run_shows_area_against_load(void **state) {
    (void)state;
    shell("one.db", "$RUGO run --db $DB --out out pressed.json");
    check_shown((const char *[]){
        "pressed (done)", "case 0: 4 realisations", "contact area by edges at 8 points", "load  ",
        "halfspace  ", "mesh %", "model %", "layered  ", "persson", "\n0.01  ", "\n 0.3  ", " +- ",
        "\nErrors below 0.5 %: solver.", "kappa ", "erf_kappa ", ", theory 1.5958)", NULL});
    shell("one.db",
          "test $($RUGO run --db $DB pressed.json | grep -c '^ *0.* +- .* +- ') = 10"); /* of 30
                                                                                           loads */
    shell("wave.db", "$RUGO run --db $DB wave.json");
    check_shown((const char *[]){"westergaard", NULL});
}

static void many_cases_have_a_row_each(void **state) {
    (void)state;
    shell("many.db", "$RUGO run --db $DB --set realisations=2 many.json");
    check_shown((const char *[]){"case  hurst", "area at 0.01", "area at 0.15", "area at 0.3",
                                 "mesh %", "model %", "kappa", "\n   4    0.6  ", NULL});
    shell("many.db", "$RUGO report --db $DB $ID");
    check_shown((const char *[]){"all cases, root mean square: contact_area by model",
                                 "\nlayered        4  nodes", NULL});
    /* a study that has not begun shows what there is */
    shell("queued.db", "$RUGO submit --db $DB many.json");
    shell("queued.db", "$RUGO report --db $DB $ID && $RUGO curves --db $DB $ID");
    check_shown((const char *[]){"pressed (queued)", "\"scalars\":{},\"curves\":[]", NULL});
}

static void the_report_tells_what_each_part_buys(void **state) {
    (void)state;
    shell("one.db", "$RUGO report --db $DB $ID");
    check_shown((const char *[]){"statistical %", "discretisation %", "model %", "size %",
                                 "s to halve", "case 0: contact_area by model, level and estimator",
                                 "\nhalfspace      8  edges", "\nhalfspace      4  nodes",
                                 "\nlayered        8  edges", NULL});
    shell("one.db", "! $RUGO report --db $DB $ID | grep nodes_");
    shell("one.db", "$RUGO report --db $DB --format json $ID");
    check_shown((const char *[]){"\"series\":\"edges\",\"model\":\"halfspace\",\"level\":8",
                                 "\"main_curve\":\"contact_area\"", "\"model_error\":0.",
                                 "\"seconds\":", "\"total_error\":", NULL});
    shell("one.db", "$RUGO report --db $DB --format svg $ID");
    check_shown((const char *[]){"<svg ", "layered, level 8, edges", "<circle ",
                                 "least error for the cost", NULL});
    shell("one.db", "! $RUGO report --db $DB --format svg $ID | grep 'not known'");
}

/* Of every table of curves, in a folder or on standard output. */
#define COLUMNS                                                                                    \
    "case,quantity,series,model,kinematics,level,pressure,x,x2,y,standard_error,"                  \
    "discretisation_error,discretisation_bound,cell_error,cell_bound,block_error,block_bound,"     \
    "model_error,model_bound,solver_error,solver_bound,missing_error,missing_bound,"               \
    "patch_error,patch_bound,valueless,law_difference,law_standard_error"

/* Every curve has its lines in the one table, every unit its picture. */
static void files_hold_every_curve(void **state) {
    (void)state;
    shell("one.db", "cd out && for q in contact_area contact_area-light contact_pressure_pdf "
                    "mean_gap stiffness patch_count patch_count-wave; do grep -q '</svg>' $q.svg "
                    "|| exit 1; done; cat curves.csv && test $(ls *.csv | wc -l) = 1 && test "
                    "$(grep -v '^#' curves.csv | "
                    "cut -d, -f2-7 | sort -u | wc -l) = "
                    "$(($(grep -o '\"quantity\"' curves.json | wc -l) + 1))");
    check_shown((const char *[]){COLUMNS ",theory_persson",
                                 "\n0,contact_pressure_pdf,,layered,,8,0.1,",
                                 "\n# computed: ", NULL});
    shell("one.db", "$RUGO curves --db $DB --format csv $ID");
    check_shown((const char *[]){COLUMNS ",theory_persson",
                                 "\n0,contact_pressure_pdf,,layered,,8,0.1,", NULL});
}

/* Its kinematics stand beside every number of the model full, and where it found no answer, why. */
static void the_model_full_is_told_apart(void **state) {
    (void)state;
    shell("steep.db", "$RUGO run --db $DB --out steep steep.json && ls steep");
    check_shown((const char *[]){"  full (hencky)  ", "\nfull (hencky): kappa ",
                                 "\nnotes: ", "\ncase 0, realisation ",
                                 ": model full (hencky), level 6: load ", " was reached up to ",
                                 " E* only: the time limit of 0.3 s ", "curves.csv\n", NULL});
    shell("steep.db", "$RUGO report --db $DB $ID");
    check_shown((const char *[]){"\nfull (hencky) (", " was reached up to ", NULL});
    shell("steep.db", "$RUGO report --db $DB --format json $ID");
    check_shown((const char *[]){"\"model\":\"full\",\"kinematics\":\"hencky\",\"level\":6",
                                 "\"notes\":{\"count\":", NULL});
    shell("steep.db", "$RUGO curves --db $DB $ID");
    check_shown((const char *[]){"\"notes\":{\"count\":", " was reached up to ", NULL});
    shell("steep.db", "$RUGO curves --db $DB --format csv $ID");
    check_shown((const char *[]){"\n0,contact_area,edges,full,hencky,6,,",
                                 "\n0,mean_gap,,layered,,", NULL});
}

/* How many realisations a mean is over, where not all have a value: in tables, files, pictures. */
static void missing_realisations_are_told(void **state) {
    (void)state;
    shell("steep.db", "$RUGO run --db $DB --out steep steep.json");
    check_shown((const char *[]){" of 8)  ", "\n(n of N): ", NULL});
    shell("steep.db", "$RUGO report --db $DB $ID");
    check_shown((const char *[]){"\n   0    8 (", " of 8)      6  edges", "\n(n of N): ", NULL});
    shell("steep.db", "$RUGO report --db $DB --format json $ID");
    check_shown((const char *[]){"\"valueless\":", NULL});
    shell("steep.db", "$RUGO curves --db $DB --format csv $ID | grep -q "
                      "'^0,contact_area,edges,full,hencky,6,,0.5,.*,[1-8],,,0.68' && "
                      "! $RUGO report --db one.db "
                      "$($RUGO status --db one.db | awk 'NR == 2 {print $1}') | grep 'of [0-9]' && "
                      "cat steep/curves.csv && "
                      "grep '<circle' steep/contact_area.svg steep/contact_pressure_pdf.svg");
    static const char HEADING[] = COLUMNS ",theory_persson";
    check_shown((const char *[]){HEADING, ",0.68", "steep/contact_area.svg:<circle ",
                                 "steep/contact_pressure_pdf.svg:<circle ", NULL});
}

/* In any case of a sweep, before anything runs. */
static void what_cannot_be_meshed_is_refused(void **state) {
    (void)state;
    shell("refused.db",
          "for set in 'contact.block_height=[{\"rms_heights\":100},{\"rms_heights\":1}]' "
          "contact.transition_depth=[8,0.5]; do "
          "$RUGO check --set \"$set\" steep.json && exit 1; "
          "$RUGO run --db $DB --set \"$set\" steep.json && exit 1; done 2>&1; test ! -e $DB");
    check_shown((const char *[]){"/contact/block_height: 1 RMS heights of the surface: the model "
                                 "full needs 4 or more",
                                 "/contact/transition_depth/1: 0.5 is not in [1, ", NULL});
    shell("refused.db", "$RUGO check --set contact.transition_depth=[1,1e9] steep.json");
}

/* Kept realisations are files of `run --out`, as `generate` writes them; `check` says what they
 * take, and refuses what there is not. */
static void kept_nodes_are_files(void **state) {
    (void)state;
    shell("kept.db",
          "keep='contact.keep={\"realisations\":[1,3],\"loads\":\"all\"}' && "
          "$RUGO check --set \"$keep\" pressed.json && "
          "$RUGO run --db $DB --set \"$keep\" --out kept pressed.json && "
          "find kept/nodes -name '*.vtu' | wc -l && ls kept/nodes/case-0 && "
          "$RUGO generate pressed.json --realisation 3 --model layered --nodes 3.csv >/dev/null && "
          "cmp 3.csv kept/nodes/case-0/realisation-3/layered/nodes.csv");
    check_shown((const char *[]){"nodes of kept realisations: about ",
                                 "realisation-1\nrealisation-3\n", NULL});
    shell("kept.db",
          "for keep in '{\"realisations\":[4]}' '{\"realisations\":[0.5]}' "
          "'{\"realisations\":[1,0]}' '{\"realisations\":[0],\"loads\":[0.123]}' "
          "'{\"loads\":[0.3]}' '{\"realisations\":\"all\"}'; do "
          "$RUGO check --set \"contact.keep=$keep\" pressed.json && exit 1; done 2>&1; true");
    check_shown((const char *[]){"/contact/keep/realisations: the study has no realisation 4",
                                 "/contact/keep/realisations: 0.5 is no whole number",
                                 "/contact/keep/realisations: must rise",
                                 "/contact/keep/loads: 0.123 is none of the study's pressures",
                                 "/contact/keep/loads: loads of no realisation",
                                 "/contact/keep/realisations: \"all\" is not an array", NULL});
}

/* 24 columns of 13 layers, or half as many, and half of these, as soon as they are as deep as wide.
 */
static void a_mesh_has_the_columns_asked_for(void **state) {
    (void)state;
    shell("mesh.db",
          "for depth in 1 1e9; do $RUGO generate --set surface.rms_slope=0.1 --set "
          "contact.transition_depth=$depth --mesh mesh.vtu --pressure 0.1 steep.json >/dev/null "
          "&& grep -o 'NumberOfCells=\"[0-9]*\"' mesh.vtu || exit 1; done");
    check_shown((const char *[]){"\"126\"", "\"312\"", NULL});
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_run_shows_area_against_load),
        cmocka_unit_test(many_cases_have_a_row_each),
        cmocka_unit_test(the_report_tells_what_each_part_buys),
        cmocka_unit_test(files_hold_every_curve),
        cmocka_unit_test(the_model_full_is_told_apart),
        cmocka_unit_test(missing_realisations_are_told),
        cmocka_unit_test(what_cannot_be_meshed_is_refused),
        cmocka_unit_test(a_mesh_has_the_columns_asked_for),
        cmocka_unit_test(kept_nodes_are_files),
    };
    return cmocka_run_group_tests(tests, setup, NULL);
}
