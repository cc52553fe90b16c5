/* Protects: studies of stratified faces give the same curves here and over HTTP, with any number of
 * workers; what does not go with them is refused over both; and a map of such a face is named as
 * one, with the errors of its parameters and the study that makes it again, with both of its laws.
 */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define STATISTICS                                                                                 \
    "{\"name\":\"honed\",\"kind\":\"statistics\",\"seed\":5,\"realisations\":40,\"surface\":{"     \
    "\"hurst\":0.8,\"wavelength_ratio\":4,\"length_ratio\":8,\"points_per_wavelength\":4,"         \
    "\"amplitudes\":\"random\",\"plateau\":{\"rms_ratio\":0.25,\"material_ratio\":[0.6,0.8]}}}"
#define CONTACT                                                                                    \
    "{\"name\":\"pressed\",\"kind\":\"contact\",\"seed\":5,\"realisations\":6,\"surface\":{"       \
    "\"dimension\":1,\"hurst\":0.8,\"wavelength_ratio\":4,\"length_ratio\":4,"                     \
    "\"points_per_wavelength\":16,\"plateau\":{\"rms_ratio\":0.25,\"offset\":-0.7}},"              \
    "\"contact\":{\"levels\":[4,8,16],\"pressures\":{\"values\":[0.02,0.1]}}}"
#define REFUSED                                                                                    \
    "{\"name\":\"no\",\"kind\":\"contact\",\"seed\":5,\"target\":{\"error\":0.1},\"surface\":{"    \
    "\"dimension\":1,\"hurst\":0.8,\"wavelength_ratio\":4,\"plateau\":{\"rms_ratio\":0.25,"        \
    "\"offset\":-0.7}},\"contact\":{\"pressures\":{\"values\":[0.1]}}}"

static void check_same(const char *study, const char *name, unsigned port) {
    char line[600];
    spit("study.json", study);
    snprintf(line, sizeof line,
             "rm -rf a.db b.db a b; \"$RUGO\" run study.json --db a.db --workers 1 --out a && "
             "\"$RUGO\" run study.json --db b.db --workers 3 --out b && "
             "\"$RUGO\" submit --server http://127.0.0.1:%u study.json && "
             "\"$RUGO\" wait --server http://127.0.0.1:%u %s && "
             "\"$RUGO\" curves --server http://127.0.0.1:%u %s >c.json",
             port, port, name, port, name);
    check_shell(line);
    char *one = slurp_from("a/curves.json", "\"cases\":");
    char *three = slurp_from("b/curves.json", "\"cases\":");
    char *served = slurp_from("c.json", "\"cases\":");
    assert_string_equal(one, three);
    assert_string_equal(one, served);
    assert_non_null(strstr(one, strcmp(name, "honed") == 0 ? "\"stratified\"" : "\"persson\""));
    free(one);
    free(three);
    free(served);
}

static void same_answer(void **state) {
    (void)state;
    struct process server;
    const unsigned port =
        serve_start(&server, (const char *[]){"--db", "served.db", "--workers", "2", NULL});
    check_same(STATISTICS, "honed", port);
    check_same(CONTACT, "pressed", port);
    char *answer = NULL;
    const int status = http_exchange(port, "POST", "/v1/studies",
                                     "Content-Type: application/json\r\n", REFUSED, &answer);
    assert_int_equal(status, 422);
    assert_non_null(strstr(answer, "/surface/plateau"));
    assert_non_null(strstr(answer, "without kinks"));
    free(answer);
    spit("refused.json", REFUSED);
    check_shell_refused("\"$RUGO\" check refused.json", "without kinks");
    process_kill(&server, SIGTERM);
    process_wait(&server, 60);
}

/* Returns the number behind "name": in the file. */
static double number_of(const char *path, const char *name) {
    char key[64];
    snprintf(key, sizeof key, "\"%s\":", name);
    char *text = slurp_from(path, key);
    const double number = strtod(text + strlen(key), NULL);
    free(text);
    return number;
}

/* The map of a face gives back, within 5 standard errors, what made it. */
static void map_of_a_face(void **state) {
    (void)state;
    spit("face.json",
         "{\"name\":\"face\",\"kind\":\"statistics\",\"seed\":2,\"realisations\":1,\"surface\":{"
         "\"hurst\":0.8,\"wavelength_ratio\":4,\"length_ratio\":24,\"points_per_wavelength\":4,"
         "\"rms_height\":1,\"amplitudes\":\"random\",\"plateau\":{\"rms_ratio\":0.25,"
         "\"material_ratio\":0.8}}}");
    check_shell(
        "\"$RUGO\" generate face.json --format npy -o face.npy && "
        "\"$RUGO\" characterise face.npy --dx 1 --boundary periodic >face.txt && "
        "\"$RUGO\" characterise face.npy --dx 1 --boundary periodic --format json >face.out");
    assert_true(contains("face.txt", "two laws fit better than one"));
    assert_true(contains("face.txt", "spectra.\n")); /* the end of a long sentence */
    assert_true(contains("face.txt", "\"plateau\": {\"rms_ratio\":"));
    static const struct {
        const char *name, *error;
        double made;
    } MADE[] = {{"Spq", "Spq_error", 0.25}, {"Svq", "Svq_error", 1}, {"Smq", "Smq_error", 0.8}};
    for (size_t m = 0; m < sizeof MADE / sizeof *MADE; m++) {
        const double error = number_of("face.out", MADE[m].error);
        assert_true(error > 0 && error < 0.1 * MADE[m].made);
        check_close(number_of("face.out", MADE[m].name), MADE[m].made, 5 * error);
    }
    assert_true(number_of("face.out", "Sk_error") > 0);
}

/* The study that is written for a map of a face has both laws, makes faces of which the map may be
 * one, and goes with the map beside it, which one of a law of its own does not. */
static void study_of_a_face(void **state) {
    (void)state;
    check_shell("\"$RUGO\" characterise face.npy --dx 1 --crop 0,0,192,192 --boundary open "
                "--format study >like.json");
    const double valleys = number_of("like.json", "rms_height"); /* over lambda_s, 4 points */
    const double points = number_of("like.json", "points_per_wavelength");
    assert_true(points == 4);
    check_close(valleys * points, 1, 0.25);
    check_close(number_of("like.json", "rms_ratio"), 0.25, 0.05);
    assert_true(contains("like.json", "two laws: valleys of RMS height "));
    assert_true(contains("like.json", "\"spectrum\":\"given\",\"heights\":\"given\""));
    check_shell("\"$RUGO\" run like.json --db like.db --workers 2 --set realisations=24 >like.txt");
    assert_true(contains("like.txt", "may be one of them"));
    check_shell("\"$RUGO\" characterise face.npy --dx 1 --crop 0,0,96,96 --boundary open --format "
                "study --hold >hold.json");
    assert_false(contains("hold.json", "\"plateau\""));
    spit("both.json", "{\"name\":\"both\",\"kind\":\"statistics\",\"realisations\":2,\"surface\":{"
                      "\"plateau\":{\"rms_ratio\":0.25,\"offset\":0},\"like\":{\"file\":"
                      "\"face.npy\",\"dx\":1,\"off\":\"stated\"}}}");
    check_shell_refused("\"$RUGO\" check both.json", "a spectrum (hurst) beside the plateau");
}

/* Heights of one law have far tails that two would fit better, and are no stratified face. */
static void tails_are_no_plateau(void **state) {
    (void)state;
    spit("one.json",
         "{\"name\":\"one\",\"kind\":\"statistics\",\"seed\":3,\"realisations\":1,\"surface\":{"
         "\"hurst\":0.8,\"wavelength_ratio\":4,\"length_ratio\":16,\"points_per_wavelength\":4,"
         "\"rms_height\":1,\"heights\":{\"distribution\":[\"gaussian\",\"weibull_max\"],"
         "\"shape\":2}}}");
    for (int number = 0; number < 2; number++) {
        check_shell(number == 0 ? "\"$RUGO\" generate one.json --case 0 -o one.npy"
                                : "\"$RUGO\" generate one.json --case 1 -o one.npy");
        check_shell("\"$RUGO\" characterise one.npy --dx 1 --boundary periodic >one.txt");
        assert_true(contains("one.txt", "Heights: ") && !contains("one.txt", "two laws"));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_answer), cmocka_unit_test(map_of_a_face),
        cmocka_unit_test(study_of_a_face), cmocka_unit_test(tails_are_no_plateau)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
