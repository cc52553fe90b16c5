/* Protects: pictures of results and surfaces hold what they say, and are the same by service and
 * command. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static struct process server;
static unsigned port;
static char id[17], url[64];

static const char STUDY[] =
    "{\"name\":\"two\",\"kind\":\"statistics\",\"seed\":7,\"realisations\":8,\"surface\":"
    "{\"dimension\":1,\"hurst\":[0.2,0.8],\"wavelength_ratio\":4,\"length_ratio\":4}}";

/* A service that has one study of two cases, all computed. */
static int start(void **state) {
    (void)state;
    char *answer;
    port = serve_start(&server, NULL);
    snprintf(url, sizeof url, "http://127.0.0.1:%u", port);
    assert_int_equal(http_exchange(port, "POST", "/v1/studies",
                                   "Content-Type: application/json\r\n", STUDY, &answer),
                     201);
    assert_int_equal(sscanf(answer, "{\"id\":\"%16[0-9a-f]\"", id), 1);
    free(answer);
    assert_int_equal(run_rugo("work", (const char *[]){"work", "--server", url, "--drain",
                                                       "--workers", "1", NULL}),
                     0);
    /* pictures name the state of their study, which the server ends after its last result */
    return run_rugo("wait", (const char *[]){"wait", "--server", url, id, NULL});
}

static int stop(void **state) {
    (void)state;
    process_kill(&server, SIGTERM);
    return process_wait(&server, 15);
}

/* Pictures are the same by the service and by the command, near and far. */
static void plots_are_the_same_near_and_far(void **state) {
    (void)state;
    static const struct {
        const char *query, *options[8], *word;
    } PLOTS[] = {
        {"quantity=summit_density",
         {"--quantity", "summit_density"},
         "summit density over Hurst exponent"},
        {"quantity=psd&case=1",
         {"--quantity", "psd", "--case", "1"},
         "two: power spectral density"},
        {"quantity=summit_joint_pdf&case=1",
         {"--quantity", "summit_joint_pdf", "--case", "1"},
         "summit joint PDF, case 1"},
        {"quantity=summit_joint_pdf", {"--quantity", "summit_joint_pdf"}, "class=\"heat\""},
        {"quantity=psd&where=hurst=0.8&width=85",
         {"--quantity", "psd", "--where", "hurst=0.8", "--width", "85"},
         "width=\"85mm\""},
        {"quantity=psd&panel=hurst", {"--quantity", "psd", "--panel", "hurst"}, ">H = 0.8<"},
        {"quantity=psd&colour=surface/hurst",
         {"--quantity", "psd", "--colour", "surface/hurst"},
         ">H = 0.2<"},
        {"quantity=summit_height_pdf&difference=1,0",
         {"--quantity", "summit_height_pdf", "--difference", "1", "0"},
         "case 1 less case 0"},
    };
    for (size_t n = 0; n < sizeof PLOTS / sizeof *PLOTS; n++) {
        char path[160], *answer;
        const char *near[16] = {"plot", "--db", "rugo.db", id},
                   *far[16] = {"plot", "--server", url, id};
        for (size_t o = 0; o < 8 && PLOTS[n].options[o] != NULL; o++)
            near[4 + o] = far[4 + o] = PLOTS[n].options[o];
        int status = run_rugo("near", near);
        if (status != 0)
            print_error("%s: %s\n", PLOTS[n].query, slurp("near.err"));
        assert_int_equal(status, 0);
        assert_int_equal(run_rugo("far", far), 0);
        snprintf(path, sizeof path, "/v1/studies/%s/plot?%s", id, PLOTS[n].query);
        assert_int_equal(http_exchange(port, "GET", path, NULL, NULL, &answer), 200);
        char *one = slurp("near.out"), *other = slurp("far.out");
        assert_non_null(strstr(answer, PLOTS[n].word));
        assert_non_null(strstr(answer, "class=\"theory\""));
        assert_string_equal(one, answer);
        assert_string_equal(other, answer);
        free(one);
        free(other);
        free(answer);
    }
}

static void what_cannot_be_drawn_is_refused(void **state) {
    (void)state;
    static const struct {
        const char *query;
        int status;
        const char *word;
    } REFUSED[] = {
        {"", 422, "?quantity"},
        {"?quantity=colour", 422, "no quantity 'colour'"},
        {"?quantity=summit_density&x=shape", 422, "is no number"},
        {"?quantity=summit_density&case=0", 422, "is a scalar"},
        {"?quantity=psd&x=hurst", 422, "curves are over their own x"},
        {"?quantity=psd&where=hurst=0.3", 422, "there is 0.2, 0.8"},
        {"?quantity=psd&dash=shape", 422, "what differs: hurst"},
        {"?quantity=psd&model=layered", 422, "no curve of psd is of model layered"},
        {"?quantity=psd&level=abc", 422, "level: \\\"abc\\\" is no number"},
        {"?quantity=psd@3&level=8x", 422, "level: \\\"8x\\\" is no number"},
        {"?quantity=summit_height_pdf&level=16", 422, "is of level 16"},
        {"?quantity=psd&log=z", 422, "?log"},
        {"?quantity=psd&total=1", 422, "none of yes|no"},
        {"?quantity=psd&width=3", 422, "neither one, two"},
        {"?quantity=summit_density&model=layered", 422, "belong to curves"},
        {"?quantity=psd@3", 422, "quantity: psd has no value at 3"},
        {"?quantity=psd:edges@3", 422, "quantity: psd has no such curve"},
        {"?quantity=psd@x", 422, "quantity: \\\"x\\\" is no number behind @"},
        {"?quantity=summit_joint_pdf&colour=nonsense", 422, "colour nonsense belongs to lines"},
        {"?quantity=summit_joint_pdf&dash=hurst", 422, "dash hurst belongs to lines"},
        {"?quantity=summit_joint_pdf&panel=hurst", 422, "panel hurst belongs to lines"},
        {"?quantity=summit_joint_pdf&model=layered", 422, "model layered belongs to lines"},
        {"?quantity=summit_joint_pdf&level=8", 422, "level 8 belongs to lines"},
        {"?quantity=summit_joint_pdf&log=xy", 422, "log xy belongs to lines"},
        {"?quantity=summit_joint_pdf&total=no", 422, "summit_joint_pdf is a density; allowed"},
        {"?quantity=psd&case=2", 404, "has no case 2"},
        {"?quantity=psd&case=0&where=hurst=0.8", 422,
         "case 0 and where hurst=0.8: a picture is of"},
        {"?quantity=summit_joint_pdf&case=0&where=hurst=0.8", 422, "or of those of where"},
        {"?quantity=psd&difference=1,0&x=hurst", 422, "takes no case, x or where"},
        {"?quantity=psd&size=3", 422, "?size"},
    };
    for (size_t n = 0; n < sizeof REFUSED / sizeof *REFUSED; n++) {
        char path[160], *answer;
        snprintf(path, sizeof path, "/v1/studies/%s/plot%s", id, REFUSED[n].query);
        int status = http_exchange(port, "GET", path, NULL, NULL, &answer);
        if (status != REFUSED[n].status || strstr(answer, REFUSED[n].word) == NULL)
            print_error("%s: %d %.300s\n", REFUSED[n].query, status, answer);
        assert_int_equal(status, REFUSED[n].status);
        assert_non_null(strstr(answer, REFUSED[n].word));
        free(answer);
    }
}

/* Pixels need a program that may not be there: the picture, or a word about what is missing. */
static void pictures_become_pixels(void **state) {
    (void)state;
    int status = run_rugo("png", (const char *[]){"plot", "--db", "rugo.db", id, "--quantity",
                                                  "psd", "--out", "psd.png", NULL});
    if (status == 0)
        assert_true(contains("psd.png", "PNG"));
    else
        assert_true(contains("png.err", "need rsvg-convert"));
    static const struct {
        const char *file, *begins;
    } PRINTED[] = {{"psd.pdf", "%PDF"}, {"psd.eps", "%!PS"}};
    for (size_t n = 0; n < sizeof PRINTED / sizeof *PRINTED && status == 0; n++) {
        assert_int_equal(
            run_rugo("print", (const char *[]){"plot", "--db", "rugo.db", id, "--quantity", "psd",
                                               "-o", PRINTED[n].file, NULL}),
            0);
        char *text = slurp(PRINTED[n].file);
        assert_memory_equal(text, PRINTED[n].begins, 4);
        free(text);
    }
    /* a name that ends otherwise would hold what it does not say */
    assert_int_equal(
        run_rugo("ending", (const char *[]){"plot", "--db", "rugo.db", id, "--quantity", "psd",
                                            "-o", "psd.jpg", NULL}),
        2);
    assert_true(contains("ending.err", "none of .svg, .png, .pdf, .eps"));
    assert_int_equal(access("psd.jpg", F_OK), -1);
    assert_int_equal(run_rugo("file", (const char *[]){"plot", "--db", "rugo.db", id, "--quantity",
                                                       "psd", "-o", "psd.svg", NULL}),
                     0);
    assert_true(contains("psd.svg", "</svg>"));
    assert_int_not_equal(
        run_rugo("none", (const char *[]){"plot", "--db", "rugo.db", id, "--quantity", "no", "-o",
                                          "no.svg", NULL}),
        0);
    assert_true(access("no.svg", F_OK) != 0);
}

/* A picture that cannot be drawn leaves the one that was there. */
static void the_earlier_picture_stays(void **state) {
    (void)state;
    const char *const arguments[] = {"plot", "--db", "rugo.db", id,  "--quantity",
                                     "psd",  "-o",   "old.png", NULL};
    const char *before = getenv("PATH");
    char *path = strdup(before != NULL ? before : "");
    assert_non_null(path);
    spit("old.png", "earlier");
    assert_int_equal(setenv("PATH", "/nonexistent", 1), 0);
    const int status = run_rugo("old", arguments);
    assert_int_equal(setenv("PATH", path, 1), 0);
    free(path);
    assert_int_equal(status, 1);
    assert_true(contains("old.err", "old.png: "));
    assert_true(contains("old.png", "earlier"));
}

/* A density has a picture a case among the files, too. */
static void files_have_densities(void **state) {
    (void)state;
    assert_int_equal(
        run_rugo("files", (const char *[]){"curves", "--server", url, id, "--out", "out", NULL}),
        0);
    for (int c = 0; c < 2; c++) {
        char path[64], word[32];
        snprintf(path, sizeof path, "out/case-%d-summit_joint_pdf.svg", c);
        snprintf(word, sizeof word, "H = %s<", c == 0 ? "0.2" : "0.8");
        assert_true(contains(path, "class=\"heat\""));
        assert_true(contains(path, ">theory: "));
        assert_true(contains(path, word));
    }
}

/* A surface is drawn in place of its heights on standard output, or beside them in a file. */
static void surfaces_are_drawn(void **state) {
    (void)state;
    spit("two.json", STUDY);
    assert_int_equal(run_rugo("one", (const char *[]){"generate", "two.json", "--case", "1",
                                                      "--picture", "one.svg", NULL}),
                     0);
    assert_true(contains("one.svg", "two: case 1, realisation 0<"));
    assert_true(contains("one.svg", "class=\"summit\""));
    assert_true(contains("one.out", "skewness"));
    assert_int_equal(
        run_rugo("map", (const char *[]){"generate", "two.json", "--set", "surface/dimension=2",
                                         "--picture", "map.svg", "-o", "map.npy", NULL}),
        0);
    assert_true(contains("map.svg", "class=\"heat\""));
    assert_true(contains("map.svg", "class=\"summit\""));
    assert_true(contains("map.npy", "NUMPY"));
    assert_int_equal(run_rugo("none", (const char *[]){"generate", "two.json", "--picture",
                                                       "no/folder.svg", NULL}),
                     1);
    assert_true(contains("none.err", "cannot open no/folder.svg"));
}

static void maps_of_files_are_drawn(void **state) {
    (void)state;
    spit("map.csv", "0,1,2\n3,nan,5\n");
    assert_int_equal(run_rugo("map", (const char *[]){"plot", "map.csv", "--out", "map.svg", NULL}),
                     0);
    assert_true(contains("map.svg", "map.csv: 3 x 2 points"));
    assert_false(contains("map.svg", "<circle")); /* heights are nothing but values here */
    assert_int_equal(run_rugo("map", (const char *[]){"plot", "map.csv", "--out", "map.png", NULL}),
                     0);
    char *png = slurp("map.png");
    assert_memory_equal(png, "\x89PNG", 4);
    free(png);
    /* zeros of many points are no contact: blank, as in pictures of press */
    spit("pressures.csv", "0,0,2\n0,4,0\n");
    assert_int_equal(
        run_rugo("map", (const char *[]){"plot", "pressures.csv", "--out", "p.svg", NULL}), 0);
    assert_true(contains("p.svg", ">blank: 0<"));
    assert_false(contains("map.svg", "blank: 0"));
    static const char *const OF_STUDIES[][2] = {
        {"--width", "one"},      {"--x", "hurst"},    {"--where", "hurst=0.8"},
        {"--log", "xy"},         {"--total", "no"},   {"--case", "0"},
        {"--difference", "1,0"}, {"--db", "rugo.db"}, {"--server", "http://[::1]:1"}};
    for (size_t o = 0; o < sizeof OF_STUDIES / sizeof *OF_STUDIES; o++) {
        char words[64];
        snprintf(words, sizeof words, "%s belongs to the --quantity of a study", OF_STUDIES[o][0]);
        assert_int_equal(run_rugo("map", (const char *[]){"plot", "map.csv", OF_STUDIES[o][0],
                                                          OF_STUDIES[o][1], NULL}),
                         2);
        assert_true(contains("map.err", words));
    }
    assert_int_equal(run_rugo("nomap", (const char *[]){"plot", "nowhere.npy", NULL}), 2);
    assert_true(contains("nomap.err", "nowhere.npy"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plots_are_the_same_near_and_far),
        cmocka_unit_test(pictures_become_pixels),
        cmocka_unit_test(the_earlier_picture_stays),
        cmocka_unit_test(files_have_densities),
        cmocka_unit_test(surfaces_are_drawn),
        cmocka_unit_test(maps_of_files_are_drawn),
        cmocka_unit_test(what_cannot_be_drawn_is_refused),
    };
    return cmocka_run_group_tests(tests, start, stop);
}
