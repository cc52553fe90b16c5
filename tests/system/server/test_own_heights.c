/* Protects: a study with heights of one's own gives the same curves near and over HTTP, with theory
 * of these heights beside them; their faults are reported with a pointer; and the heights of a map
 * become those of a study. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include <cjson/cJSON.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define STUDY(heights)                                                                             \
    "{\"name\":\"own\",\"kind\":\"statistics\",\"realisations\":40,\"surface\":{\"dimension\":1,"  \
    "\"hurst\":[0.2,0.8],\"wavelength_ratio\":8,\"heights\":" heights "}}"
#define SAMPLES                                                                                    \
    "{\"distribution\":\"samples\",\"samples\":[3,1,4,1.5,9,2.6,5,3.5,8,9,7,9,3,2,3,8,4.6,2]}"

static void near_and_over_http(void **state) {
    (void)state;
    struct process server;
    char url[64];
    spit("own.json", STUDY(SAMPLES));
    assert_int_equal(run_shell("$RUGO run --db near.db --workers 2 own.json"), 0);
    snprintf(url, sizeof url, "http://127.0.0.1:%u",
             serve_start(&server, (const char *[]){"--db", "far.db", NULL}));
    assert_int_equal(
        run_rugo("submit", (const char *[]){"submit", "--server", url, "own.json", NULL}), 0);
    assert_int_equal(run_rugo("work", (const char *[]){"work", "--server", url, "--drain", NULL}),
                     0);
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 20), 0);
    for (int far = 0; far < 2; far++)
        assert_int_equal(run_shell(far ? "$RUGO curves --db far.db own > far.json"
                                       : "$RUGO curves --db near.db own > near.json"),
                         0);
    char *near_cases = slurp_from("near.json", "\"cases\":"),
         *far_cases = slurp_from("far.json", "\"cases\":");
    assert_string_equal(near_cases, far_cases);
    assert_non_null(strstr(near_cases, "\"quantity\":\"summit_height_pdf\""));
    assert_non_null(strstr(near_cases, "\"samples\""));
    free(near_cases);
    free(far_cases);
    assert_int_equal(run_shell("$RUGO curves --db near.db own --format table"), 0);
}

static void lists_are_shown_short(void **state) {
    (void)state;
    spit("own.json", STUDY(SAMPLES));
    assert_int_equal(run_shell("$RUGO check own.json"), 0);
    assert_true(contains("shell.out", "[3,1,4,1.5,9,2.6,5,3.5, ...] (18 numbers)"));
    assert_true(contains("shell.out", "\"samples\""));
}

static void faults_have_a_pointer(void **state) {
    (void)state;
    static const struct {
        const char *heights, *words;
    } FAULTS[] = {
        {"{\"distribution\":\"samples\",\"samples\":[1,2,3]}",
         "/surface/heights/samples: [1,2,3] is not an array of 8 to 10000 numbers"},
        {"{\"distribution\":\"samples\",\"samples\":[1,1,1,1,1,1,1,1]}",
         "/surface/heights/samples: heights must differ"},
        {"{\"distribution\":\"quantiles\",\"probability\":[0,0.5,0.3,0.8,1],\"quantile\":[1,2,3,4,"
         "5]}",
         "/surface/heights/probability: probabilities must rise; number 2, 0.29999999999999999, is "
         "not above 0.5"},
        {"{\"distribution\":\"quantiles\",\"probability\":[0,0.1,0.3,0.8,1],\"quantile\":[1,2,3,9,"
         "5]}",
         "/surface/heights/quantile: heights must not fall; number 4, 5, is below 9"},
    };
    struct process server;
    unsigned port = serve_start(&server, (const char *[]){"--db", "faults.db", NULL});
    for (size_t f = 0; f < sizeof FAULTS / sizeof *FAULTS; f++) {
        char study[600], *answer = NULL;
        snprintf(study, sizeof study, STUDY("%s"), FAULTS[f].heights);
        spit("wrong.json", study);
        assert_int_equal(run_shell("$RUGO check wrong.json"), 2);
        if (!contains("shell.err", FAULTS[f].words))
            fail_msg("no \"%s\"", FAULTS[f].words);
        assert_int_equal(http_exchange(port, "POST", "/v1/studies",
                                       "Content-Type: application/json\r\n", study, &answer),
                         422);
        assert_non_null(strstr(answer, "/surface/heights/"));
        free(answer);
    }
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 20), 0);
}

/* Writes a list of so many rising numbers. */
static void put_list(FILE *file, const char *name, int count, double step) {
    fprintf(file, ",\"%s\":[", name);
    for (int n = 1; n <= count; n++)
        fprintf(file, "%s%.6g", n > 1 ? "," : "", n * step);
    fputc(']', file);
}

/* Each case has its own copy of the samples: 3000 cases of the most of them are refused before any
 * of them is made. */
static void many_cases_of_many_samples_are_refused(void **state) {
    (void)state;
    FILE *file = fopen("many.json", "w");
    assert_non_null(file);
    fprintf(file, "{\"name\":\"many\",\"kind\":\"statistics\",\"surface\":{\"dimension\":1");
    put_list(file, "hurst", 50, 0.02);
    put_list(file, "wavelength_ratio", 60, 2);
    fprintf(file, ",\"heights\":{\"distribution\":\"samples\"");
    put_list(file, "samples", 10000, 1);
    fprintf(file, "}}}");
    assert_int_equal(fclose(file), 0);
    assert_int_equal(run_shell("$RUGO check many.json"), 2);
    assert_true(contains("shell.err", "3000 cases of 100"));
    assert_true(contains("shell.err", "values each are too many: 20000000 values at most"));
    assert_int_equal(run_shell("$RUGO check many.json --set 'surface/hurst=[0.5,0.8]' --set "
                               "surface/wavelength_ratio=8"),
                     0);
}

static double number_in(const char *path, const char *group, const char *name) {
    char *text = slurp(path);
    cJSON *document = cJSON_Parse(text);
    const cJSON *value = cJSON_GetObjectItem(cJSON_GetObjectItem(document, group), name);
    assert_true(cJSON_IsNumber(value));
    double number = value->valuedouble;
    cJSON_Delete(document);
    free(text);
    return number;
}

/* A surface with the exact heights of a distribution, taken for a measured one: its quantiles are
 * those heights again. */
static void heights_of_a_map_are_heights_of_a_study(void **state) {
    (void)state;
    spit("known.json",
         "{\"name\":\"known\",\"kind\":\"statistics\",\"surface\":{\"hurst\":0.8,"
         "\"wavelength_ratio\":4,\"length_ratio\":4,\"heights\":{\"distribution\":\"weibull_max\","
         "\"shape\":1.5,\"keep\":\"heights\",\"draw\":\"quantiles\"}}}");
    assert_int_equal(run_shell("$RUGO generate -o map.npy known.json && $RUGO characterise map.npy "
                               "--format json > map.json"),
                     0);
    char *text = slurp("map.json");
    cJSON *map = cJSON_Parse(text);
    cJSON *heights = cJSON_DetachItemFromObject(map, "quantiles");
    assert_non_null(heights);
    assert_non_null(cJSON_AddStringToObject(heights, "distribution", "quantiles"));
    char *own = cJSON_PrintUnformatted(heights);
    assert_non_null(own);
    spit("heights.json", own);
    free(own);
    free(text);
    cJSON_Delete(heights);
    cJSON_Delete(map);
    assert_int_equal(
        run_shell("$RUGO generate -o again.npy known.json --set surface/heights=\"$(cat "
                  "heights.json)\" --set surface/heights/keep=heights && $RUGO "
                  "characterise again.npy --format json > again.json"),
        0);
    double known = number_in("map.json", "areal", "Ssk");
    double again = number_in("again.json", "areal", "Ssk");
    assert_true(known < -0.9);
    check_close(again, known, 0.1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(near_and_over_http),
        cmocka_unit_test(lists_are_shown_short),
        cmocka_unit_test(faults_have_a_pointer),
        cmocka_unit_test(many_cases_of_many_samples_are_refused),
        cmocka_unit_test(heights_of_a_map_are_heights_of_a_study),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
