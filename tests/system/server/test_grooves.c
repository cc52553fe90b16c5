/* Protects: grooves from a study to a map and back, by the commands: studies of both kinds run with
 * them, by one worker and by two to the same bytes; a surface of the study is found to have the
 * grooves that were asked for; a study like it makes them again, and one that holds it names how to
 * take them out. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define SURFACE                                                                                    \
    "\"surface\":{\"hurst\":0.8,\"wavelength_ratio\":8,\"length_ratio\":4,"                        \
    "\"points_per_wavelength\":4,\"rms_height\":0.1,\"amplitudes\":\"random\",\"grooves\":{"       \
    "\"period\":3.2,\"depth\":2,\"angle\":90,\"shape\":\"arcs\"}}"

static void write_text(const char *path, const char *text) {
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static void expect_in(const char *path, const char *words) {
    char *text = slurp(path);
    if (strstr(text, words) == NULL)
        fail_msg("%s lacks '%s': %s", path, words, text);
    free(text);
}

static void studies_run(void **state) {
    (void)state;
    static const char *const STUDIES[] = {
        "{\"name\":\"s\",\"kind\":\"statistics\",\"seed\":4,\"realisations\":8," SURFACE "}",
        "{\"name\":\"c\",\"kind\":\"contact\",\"seed\":4,\"realisations\":3," SURFACE
        ",\"contact\":{\"levels\":[4,8],\"pressures\":{\"values\":[0.1]}}}"};
    for (size_t s = 0; s < 2; s++) {
        write_text("study.json", STUDIES[s]);
        assert_int_equal(run_rugo("run", (const char *[]){"run", "study.json", "--workers", "1",
                                                          "--out", "one", NULL}),
                         0);
        assert_int_equal(run_rugo("run", (const char *[]){"run", "study.json", "--workers", "2",
                                                          "--out", "two", NULL}),
                         0);
        char *one = slurp("one/curves.csv"), *two = slurp("two/curves.csv");
        assert_true(strlen(one) > 100);
        assert_string_equal(one, two);
        free(one);
        free(two);
        assert_int_equal(system("rm -rf one two"), 0);
    }
}

static void what_is_made_is_found(void **state) {
    (void)state;
    write_text("study.json",
               "{\"name\":\"s\",\"kind\":\"statistics\",\"seed\":4,\"realisations\":8," SURFACE
               "}");
    assert_int_equal(
        run_rugo("generate", (const char *[]){"generate", "study.json", "-o", "map.npy", NULL}), 0);
    assert_int_equal(
        run_rugo("characterise", (const char *[]){"characterise", "map.npy", "--dx", "0.25", NULL}),
        0);
    expect_in("characterise.out", "Grooves: every 3.2");
    expect_in("characterise.out", "90.0");
    expect_in("characterise.out", "radius 6.4");
    expect_in("characterise.out", "without its grooves");
    assert_int_equal(run_rugo("characterise", (const char *[]){"characterise", "map.npy", "--dx",
                                                               "0.25", "--degroove", NULL}),
                     0);
    char *text = slurp("characterise.out");
    assert_null(strstr(text, "Grooves:"));
    assert_non_null(strstr(text, "degroove: every 3.2"));
    free(text);
}

/* The study that is written for a map makes surfaces in which the same grooves are found. */
static void like_makes_them(void **state) {
    (void)state;
    write_text("study.json",
               "{\"name\":\"s\",\"kind\":\"statistics\",\"seed\":4,\"realisations\":8," SURFACE
               "}");
    assert_int_equal(
        run_rugo("generate", (const char *[]){"generate", "study.json", "-o", "map.npy", NULL}), 0);
    assert_int_equal(run_rugo("characterise", (const char *[]){"characterise", "map.npy", "--dx",
                                                               "0.25", "--format", "study", NULL}),
                     0);
    expect_in("characterise.out", "\"grooves\"");
    expect_in("characterise.out", "taken out of the law: every 3.2 at 90 degrees, 0.2 deep");
    assert_int_equal(rename("characterise.out", "again.json"), 0);
    assert_int_equal(
        run_rugo("generate", (const char *[]){"generate", "again.json", "-o", "again.npy", NULL}),
        0);
    /* lengths are in lambda_s of the law that was fitted, 32/33 of the map's unit */
    assert_int_equal(run_rugo("characterise", (const char *[]){"characterise", "again.npy", "--dx",
                                                               "0.2578125", NULL}),
                     0);
    expect_in("characterise.out", "Grooves: every 3.300");
    expect_in("characterise.out", "0.2062"); /* 0.2 of the unit */
    expect_in("characterise.out", "radius 6.6");
    write_text("like.json",
               "{\"name\":\"l\",\"kind\":\"statistics\",\"realisations\":2,\"surface\":"
               "{\"like\":{\"file\":\"map.npy\",\"dx\":\"0.25\",\"hold\":true}}}");
    assert_int_equal(run_rugo("check", (const char *[]){"check", "like.json", "--study", NULL}), 0);
    expect_in("check.out", "made every 3.2 beyond the map, which holds them as they are");
    expect_in("check.out", "\"grooves\"");
    assert_int_equal(rename("check.out", "held.json"), 0);
    assert_int_equal(
        run_rugo("generate", (const char *[]){"generate", "held.json", "-o", "held.npy", NULL}), 0);
    write_text("like.json",
               "{\"name\":\"l\",\"kind\":\"statistics\",\"realisations\":2,\"surface\":"
               "{\"like\":{\"file\":[\"map.npy\",\"map.npy\"],\"dx\":\"0.25\"}}}");
    assert_int_not_equal(run_rugo("check", (const char *[]){"check", "like.json", NULL}), 0);
    expect_in("check.err", "give \"degroove\": true");
}

/* Two families that are no mirror images of each other, as honing with feed leaves them: the study
 * that is written for a map makes both, in which both are found again. */
static void crossed_families_are_made(void **state) {
    (void)state;
    write_text(
        "study.json",
        "{\"name\":\"s\",\"kind\":\"statistics\",\"seed\":4,\"realisations\":2,\"surface\":{"
        "\"hurst\":0.8,\"wavelength_ratio\":8,\"length_ratio\":4,\"points_per_wavelength\":4,"
        "\"rms_height\":0.1,\"amplitudes\":\"random\",\"grooves\":{\"period\":2.743977362,"
        "\"angle\":30.96375653,\"depth\":2,\"shape\":\"arcs\",\"cross_period\":3.577708764,"
        "\"cross_angle\":-63.43494882,\"cross_depth\":2,\"cross_shape\":\"sine\"}}}");
    assert_int_equal(
        run_rugo("generate", (const char *[]){"generate", "study.json", "-o", "map.npy", NULL}), 0);
    assert_int_equal(
        run_rugo("characterise", (const char *[]){"characterise", "map.npy", "--dx", "0.25",
                                                  "--boundary", "open", "--format", "study", NULL}),
        0);
    expect_in("characterise.out", "every 2.7441 at 30.96 degrees, 0.2 deep");
    expect_in("characterise.out", "; crossed by every ");
    expect_in("characterise.out", "\"cross_shape\":\"");
    assert_int_equal(rename("characterise.out", "again.json"), 0);
    assert_int_equal(
        run_rugo("generate", (const char *[]){"generate", "again.json", "-o", "again.npy", NULL}),
        0);
    assert_int_equal(run_rugo("characterise",
                              (const char *[]){"characterise", "again.npy", "--dx", "0.25", NULL}),
                     0);
    expect_in("characterise.out", "every 2.74");
    expect_in("characterise.out", "every 3.5");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(studies_run),
        cmocka_unit_test(what_is_made_is_found),
        cmocka_unit_test(like_makes_them),
        cmocka_unit_test(crossed_families_are_made),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
