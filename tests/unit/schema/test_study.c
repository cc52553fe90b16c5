/* Protects: a study is read as it was meant, or every fault of it is reported with its pointer,
 * what is there and what is allowed; sweeps are numbered in the order of the file. */
#include "schema/study/fault.h"
#include "schema/study/study_reader.h"
#include "tests/support/check.h"
#include "tests/support/fake_kind.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int read_text(const char *text, struct study **study, struct fault_list *faults,
                     struct error *err) {
    return study_read(study, text, strlen(text), NULL, FAKE_KINDS, 1000, faults, err);
}

#define STUDY(rest) "{\"name\":\"n\",\"kind\":\"boxes\"," rest "}"
#define WIDE(rest) STUDY("\"box\":{\"width\":1}," rest)
#define BOX(rest) STUDY("\"box\":{\"width\":1" rest "}")

static void faults_are_told_with_pointer_and_range(void **state) {
    (void)state;
    static const struct {
        const char *text, *pointer, *detail;
    } BAD[] = {
        {"[]", "", "a study is a JSON object"},
        {"{\"kind\":\"boxes\",\"box\":{\"width\":1}}", "/name",
         "missing: name of the study, shown with its results"},
        {"{\"name\":\"\",\"kind\":\"boxes\",\"box\":{\"width\":1}}", "/name",
         "\"\" is not a text of 1 to 200 characters, none a control character"},
        {"{\"name\":\"a\\u001b[2J\",\"kind\":\"boxes\",\"box\":{\"width\":1}}", "/name",
         "\"a\\u001b[2J\" is not a text of 1 to 200 characters, none a control character"},
        {"{\"name\":\"\\u009b2J\",\"kind\":\"boxes\",\"box\":{\"width\":1}}", "/name",
         "\"\xc2\x9b\x32J\" is not a text of 1 to 200 characters, none a control character"},
        {"{\"name\":7,\"kind\":\"boxes\",\"box\":{\"width\":1}}", "/name",
         "7 is not a text of 1 to 200 characters, none a control character"},
        {"{\"name\":\"n\"}", "/kind",
         "missing: what is computed; it says which of the members below the study may have; one of "
         "\"boxes\""},
        {"{\"name\":\"n\",\"kind\":\"barrels\"}", "/kind", "\"barrels\" is not one of \"boxes\""},
        {"{\"name\":\"n\",\"kind\":3}", "/kind", "3 is not one of \"boxes\""},
        {WIDE("\"random\":\"comon\""), "/random",
         "\"comon\" is not one of \"common\", \"independent\""},
        {WIDE("\"random\":[\"common\"]"), "/random",
         "[\"common\"] is not one of \"common\", \"independent\""},
        {STUDY("\"box\":{}"), "/box/width", "missing: in metres"},
        {STUDY("\"seed\":1"), "/box/width", "missing: in metres"},
        {STUDY("\"box\":{\"width\":1.4}"), "/box/width", "1.4 is not in (0, 1]"},
        {STUDY("\"box\":{\"width\":0}"), "/box/width", "0 is not in (0, 1]"},
        {STUDY("\"box\":{\"width\":\"wide\"}"), "/box/width", "\"wide\" is not a number"},
        {STUDY("\"box\":{\"width\":null}"), "/box/width", "null is not a number"},
        {STUDY("\"box\":{\"width\":[0.2,1.4]}"), "/box/width/1", "1.4 is not in (0, 1]"},
        {STUDY("\"box\":{\"width\":[]}"), "/box/width", "an empty list; give at least one value"},
        {STUDY("\"box\":{\"width\":[[1]]}"), "/box/width/0", "[1] is not a number"},
        {BOX(",\"count\":2.5"), "/box/count", "2.5 is not an integer"},
        {BOX(",\"count\":0"), "/box/count", "0 is not in [1, infinity)"},
        {BOX(",\"count\":true"), "/box/count", "true is not an integer"},
        {BOX(",\"colour\":\"blue\""), "/box/colour", "\"blue\" is not one of \"red\", \"green\""},
        {BOX(",\"colour\":1"), "/box/colour", "1 is not one of \"red\", \"green\""},
        {BOX(",\"color\":\"red\""), "/box/color", "unknown name; did you mean \"colour\"?"},
        {BOX(",\"weight\":1"), "/box/weight", "unknown name; allowed: width, count, colour"},
        {WIDE("\"box/colour\":\"red\""), "/box/colour",
         "unknown name; allowed: name, kind, seed, random, realisations, priority, box, bins, "
         "shapes, depth, "
         "seconds"},
        {STUDY("\"box\":{\"width\":1},\"bin\":[0,1]"), "/bin",
         "unknown name; did you mean \"bins\"?"},
        {STUDY("\"box\":{\"width\":1},\"bins\":[1]"), "/bins",
         "[1] is not an array of 2 to 3 numbers"},
        {STUDY("\"box\":{\"width\":1},\"bins\":[1,10]"), "/bins/1", "10 is not in [-9, 9]"},
        {STUDY("\"box\":{\"width\":1},\"bins\":[[1,2],[3]]"), "/bins/1",
         "[3] is not an array of 2 to 3 numbers"},
        {STUDY("\"box\":{\"width\":1},\"bins\":3"), "/bins", "3 is not an array of 2 to 3 numbers"},
        {STUDY("\"box\":{\"width\":1},\"seconds\":[1,2]"), "/seconds",
         "a list is not allowed here: this cannot be swept"},
        {WIDE("\"shapes\":\"flat\""), "/shapes",
         "\"flat\" is not one of \"round\", \"square\", \"oval\""},
        {WIDE("\"shapes\":[\"round\",\"flat\"]"), "/shapes/1",
         "\"flat\" is not one of \"round\", \"square\", \"oval\""},
        {WIDE("\"shapes\":[\"round\",\"oval\",\"round\"]"), "/shapes/2",
         "\"round\" is there already"},
        {WIDE("\"shapes\":[]"), "/shapes", "an empty list; give at least one value"},
        {WIDE("\"shapes\":[[\"round\"]]"), "/shapes",
         "a list is not allowed here: this cannot be swept"},
        {WIDE("\"depth\":3"), "/depth",
         "3 is not one of \"endless\", nor an object of one number named \"metres\", \"feet\""},
        {WIDE("\"depth\":{\"feet\":11}"), "/depth/feet", "11 is not in (0, 10]"},
        {WIDE("\"depth\":{\"feet\":\"x\"}"), "/depth/feet", "\"x\" is not a number"},
        {WIDE("\"depth\":{\"miles\":1}"), "/depth",
         "{\"miles\":1} is not one of \"endless\", nor an object of one number named \"metres\", "
         "\"feet\""},
        {WIDE("\"depth\":{\"feet\":1,\"metres\":1}"), "/depth",
         "{\"feet\":1,\"metres\":1} is not one of \"endless\", nor an object of one number named "
         "\"metres\", \"feet\""},
        {WIDE("\"depth\":[{\"feet\":1},{\"feet\":0}]"), "/depth/1/feet", "0 is not in (0, 10]"},
        {STUDY("\"seed\":-1,\"box\":{\"width\":1}"), "/seed", "-1 is not an integer of 0 or more"},
        {STUDY("\"seed\":1.5,\"box\":{\"width\":1}"), "/seed",
         "1.5 is not an integer of 0 or more"},
        {STUDY("\"seed\":1.5e16,\"box\":{\"width\":1}"), "/seed",
         "1.50000000000000e+16 is not in [0, 9007199254740992]; write a larger seed as a decimal "
         "string"},
        {STUDY("\"seed\":\"18446744073709551616\",\"box\":{\"width\":1}"), "/seed",
         "\"18446744073709551616\" is not a decimal number up to 18446744073709551615"},
        {STUDY("\"seed\":\"0x10\",\"box\":{\"width\":1}"), "/seed",
         "\"0x10\" is not a decimal number up to 18446744073709551615"},
        {STUDY("\"realisations\":0,\"box\":{\"width\":1}"), "/realisations",
         "0 is not in [1, 10000000]"},
        {STUDY("\"realisations\":\"many\",\"box\":{\"width\":1}"), "/realisations",
         "\"many\" is not an integer"},
        {STUDY("\"realisations\":{\"target_error\":0.01},\"box\":{\"width\":1}"), "/realisations",
         "give a number; an error is asked for by /target/error, in its place"},
        {STUDY("\"box\":{\"width\":[0.5,1],\"count\":7}"), "/box/count",
         "seven boxes are too many for half a metre"},
        {BOX(",\"count\":2000"), "",
         "a worker needs 1.86e-06 GiB for a grid of 1 by 1; allowed: 9.31e-07 GiB on this machine"},
    };
    for (size_t b = 0; b < sizeof BAD / sizeof *BAD; b++) {
        struct fault_list faults = {0};
        struct study *study = NULL;
        struct error err = {0};
        assert_int_equal(read_text(BAD[b].text, &study, &faults, &err), ERROR_INPUT);
        assert_null(study);
        if (faults.count != 1 || strcmp(faults.faults[0].pointer, BAD[b].pointer) != 0 ||
            strcmp(faults.faults[0].detail, BAD[b].detail) != 0)
            print_error("%s: %zu faults, %s: %s\n", BAD[b].text, faults.count,
                        faults.faults[0].pointer, faults.faults[0].detail);
        assert_int_equal(faults.count, 1);
        assert_string_equal(faults.faults[0].pointer, BAD[b].pointer);
        assert_string_equal(faults.faults[0].detail, BAD[b].detail);
        fault_list_clear(&faults);
    }
}

/* Which random numbers a case is made of: those of all cases, unless the study says otherwise. */
static void random_numbers_are_common_unless_told(void **state) {
    (void)state;
    static const struct {
        const char *text;
        enum study_random random;
        uint64_t sequence; /* of case 3 */
    } STUDIES[] = {{WIDE("\"seed\":1"), RANDOM_COMMON, 0},
                   {WIDE("\"random\":\"common\""), RANDOM_COMMON, 0},
                   {WIDE("\"random\":\"independent\""), RANDOM_INDEPENDENT, 3}};
    for (size_t s = 0; s < sizeof STUDIES / sizeof *STUDIES; s++) {
        struct study *study = NULL;
        struct fault_list faults = {0};
        assert_int_equal(read_text(STUDIES[s].text, &study, &faults, NULL), 0);
        assert_int_equal(study->random, STUDIES[s].random);
        assert_int_equal(study_sequence(study->random, 3), STUDIES[s].sequence);
        assert_string_equal(study->kind->name, "boxes"); /* the other choice of a study */
        study_destroy(&study);
        fault_list_clear(&faults);
    }
}

static void all_faults_are_told_at_once(void **state) {
    (void)state;
    struct fault_list faults = {0};
    struct study *study = NULL;
    struct error err = {0};
    assert_int_equal(
        read_text(
            "{\"kind\":\"boxes\",\"seed\":-1,\"colour\":1,\"box\":{\"width\":2,\"count\":\"x\"}}",
            &study, &faults, &err),
        ERROR_INPUT);
    assert_int_equal(faults.count, 5);
    fault_list_clear(&faults);
    assert_int_equal(read_text(STUDY("\"box\":7"), &study, &faults, &err), ERROR_INPUT);
    assert_int_equal(faults.count, 2);
    assert_string_equal(faults.faults[0].detail, "7 is not an object");
    assert_string_equal(faults.faults[1].pointer, "/box/width");
    fault_list_clear(&faults);
    /* what cases need is there, though the study has no name */
    assert_int_equal(read_text("{\"kind\":\"boxes\",\"box\":{\"width\":[0.5,1],\"count\":7}}",
                               &study, &faults, &err),
                     ERROR_INPUT);
    assert_int_equal(faults.count, 2);
    assert_string_equal(faults.faults[0].pointer, "/name");
    assert_string_equal(faults.faults[1].pointer, "/box/count");
    assert_null(study);
    fault_list_clear(&faults);
}

/* A list of choices is one value; a measure may be swept, in any of its forms. */
static void choices_and_measures(void **state) {
    (void)state;
    struct fault_list faults = {0};
    struct study *study = NULL;
    assert_int_equal(read_text(WIDE("\"shapes\":[\"oval\",\"round\"],"
                                    "\"depth\":[\"endless\",{\"feet\":2}]"),
                               &study, &faults, NULL),
                     0);
    assert_int_equal(study->case_count, 2);
    assert_string_equal(study->swept[0], "/depth");
    assert_int_equal(cJSON_GetArraySize(json_at(study->cases[1].parameters, "/shapes")), 2);
    assert_true(cJSON_IsString(json_at(study->cases[0].parameters, "/depth")));
    assert_true(json_at(study->cases[1].parameters, "/depth/feet")->valuedouble == 2);
    study_destroy(&study);
    assert_int_equal(read_text(WIDE("\"depth\":{\"metres\":0.5}"), &study, &faults, NULL), 0);
    assert_int_equal(study->case_count, 1);
    assert_string_equal(json_at(study->cases[0].parameters, "/shapes")->valuestring, "round");
    study_destroy(&study);
}

static void sweeps_run_in_the_order_of_the_file(void **state) {
    (void)state;
    struct fault_list faults = {0};
    struct study *study = NULL;
    assert_int_equal(read_text(STUDY("\"bins\":[[0,1],[2,3]],\"box\":{\"colour\":[\"green\","
                                     "\"red\",\"green\"],\"width\":[0.5,1]}"),
                               &study, &faults, NULL),
                     0);
    assert_int_equal(study->case_count, 12);
    assert_string_equal(study->swept[0], "/bins");
    assert_string_equal(study->swept[1], "/box/colour");
    assert_string_equal(study->swept[2], "/box/width");
    assert_null(study->swept[3]);
    for (size_t c = 0; c < 12; c++) {
        const cJSON *p = study->cases[c].parameters;
        assert_true(json_at(p, "/box/width")->valuedouble == (c % 2 ? 1 : 0.5));
        assert_string_equal(json_at(p, "/box/colour")->valuestring,
                            c / 2 % 3 == 1 ? "red" : "green");
        assert_true(json_at(p, "/bins/0")->valuedouble == (c < 6 ? 0 : 2));
        assert_true(json_at(p, "/box/count")->valuedouble == 2); /* a default */
    }
    study_destroy(&study);
    assert_null(study);
}

static void too_many_cases_are_refused_before_they_are_made(void **state) {
    (void)state;
    char *text = malloc(200000);
    struct fault_list faults = {0};
    struct study *study = NULL;
    assert_non_null(text);
    size_t used = (size_t)sprintf(text, "{\"name\":\"n\",\"kind\":\"boxes\",\"box\":{\"width\":[");
    for (int i = 0; i < 10001; i++)
        used += (size_t)sprintf(text + used, "%s0.1", i ? "," : "");
    sprintf(text + used, "]}}");
    assert_int_equal(read_text(text, &study, &faults, NULL), ERROR_INPUT);
    assert_string_equal(faults.faults[0].detail, "the lists make more than 10000 cases");
    fault_list_clear(&faults);
    free(text);
}

static void seeds_are_read_whole(void **state) {
    (void)state;
    static const struct {
        const char *text;
        uint64_t seed;
    } SEEDS[] = {{BOX(""), 1},
                 {STUDY("\"seed\":9007199254740992,\"box\":{\"width\":1}"), 9007199254740992u},
                 {STUDY("\"seed\":\"18446744073709551615\",\"box\":{\"width\":1}"), UINT64_MAX}};
    for (size_t s = 0; s < 3; s++) {
        struct fault_list faults = {0};
        struct study *study = NULL;
        assert_int_equal(read_text(SEEDS[s].text, &study, &faults, NULL), 0);
        assert_true(study->seed == SEEDS[s].seed);
        study_destroy(&study);
    }
}

/* Blocks of about five seconds and of equal size, never beyond 1000 realisations. */
static void blocks_take_about_five_seconds(void **state) {
    (void)state;
    static const struct {
        uint64_t realisations;
        double seconds;
        uint64_t most, block;
    } BLOCKS[] = {{100, 0.1, 1000, 50}, {100, 100, 1000, 1}, {100, 1e-3, 1000, 100},
                  {2400, 0, 1000, 800}, {101, 1e-3, 20, 17}, {UINT64_MAX, 1e-9, 1000, 1000},
                  {7, 0, 0, 1},         {0, 1, 5, 1}};
    for (size_t b = 0; b < sizeof BLOCKS / sizeof *BLOCKS; b++)
        assert_int_equal(study_block(BLOCKS[b].realisations, BLOCKS[b].seconds, BLOCKS[b].most),
                         BLOCKS[b].block);
    assert_int_equal(study_block_most(&(struct study_cost){.seconds = 9}), 1000);
    assert_int_equal(study_block_most(&(struct study_cost){.runs_most = 20}), 20);
    assert_int_equal(study_block_most(&(struct study_cost){.result_bytes = 1e5}), 40);
    assert_int_equal(study_block_most(&(struct study_cost){.result_bytes = 1e9}), 1);
}

/* Each of the workers gets some of few realisations, unless these take next to nothing. */
static void few_realisations_are_shared(void **state) {
    (void)state;
    static const struct {
        uint64_t block;
        double seconds;
        uint64_t waiting, workers, share;
    } SHARES[] = {{50, 0.1, 100, 8, 13}, {50, 0.1, 1000, 8, 50}, {50, 0.1, 100, 1, 50},
                  {3, 0.1, 4, 100, 1},   {50, 1e-3, 60, 8, 50},  {500, 1e-3, 600, 8, 100},
                  {50, 0, 100, 8, 50},   {5, 1e-9, 6, 8, 5}};
    for (size_t n = 0; n < sizeof SHARES / sizeof *SHARES; n++)
        assert_int_equal(
            study_share(SHARES[n].block, SHARES[n].seconds, SHARES[n].waiting, SHARES[n].workers),
            SHARES[n].share);
}

static void overrides_change_the_document(void **state) {
    (void)state;
    static const char *const SETS[] = {"/box/width=[0.25,0.5]", "realisations=7",
                                       "box.colour=green", "box/count=3", NULL};
    static const char *const BAD[] = {"nothing", NULL}, *const THROUGH[] = {"name.x=1", NULL},
                             *const EMPTY[] = {"/=5", NULL};
    struct fault_list faults = {0};
    struct study *study = NULL;
    struct error err = {0};
    const char *text = BOX("");
    assert_int_equal(study_read(&study, text, strlen(text), SETS, FAKE_KINDS, 0, &faults, NULL), 0);
    assert_int_equal(study->case_count, 2);
    assert_int_equal(study->realisations, 7);
    assert_string_equal(json_at(study->cases[1].parameters, "/box/colour")->valuestring, "green");
    check_close(json_at(study->cases[1].parameters, "/box/count")->valuedouble, 3, 0);
    assert_non_null(strstr(study->source, "\"realisations\":7"));
    study_destroy(&study);
    assert_int_equal(study_read(&study, text, strlen(text), BAD, FAKE_KINDS, 0, &faults, &err),
                     ERROR_INPUT);
    assert_string_equal(err.text, "\"nothing\" is not PATH=VALUE, as in surface/hurst=0.8");
    assert_int_equal(study_read(&study, text, strlen(text), EMPTY, FAKE_KINDS, 0, &faults, &err),
                     ERROR_INPUT);
    assert_string_equal(err.text, "\"/=5\" names no member before the =, as in surface/hurst=0.8");
    assert_int_equal(study_read(&study, text, strlen(text), THROUGH, FAKE_KINDS, 0, &faults, &err),
                     ERROR_INPUT);
}

static void schema_has_what_the_reader_asks(void **state) {
    (void)state;
    cJSON *schema = study_schema(FAKE_KINDS);
    assert_non_null(schema);
    const cJSON *box = json_at(schema, "/allOf/0/then/properties/box");
    assert_true(cJSON_IsFalse(json_at(box, "/additionalProperties")));
    assert_string_equal(json_at(box, "/required/0")->valuestring, "width");
    assert_true(json_at(box, "/properties/width/anyOf/0/exclusiveMinimum")->valuedouble == 0);
    assert_true(json_at(box, "/properties/width/anyOf/1/minItems")->valuedouble == 1);
    assert_string_equal(json_at(box, "/properties/colour/anyOf/0/enum/1")->valuestring, "green");
    assert_string_equal(json_at(schema, "/allOf/0/if/properties/kind/const")->valuestring, "boxes");
    assert_null(json_at(schema, "/allOf/0/then/properties/seconds/anyOf/1"));
    assert_true(cJSON_IsFalse(json_at(schema, "/allOf/0/then/additionalProperties")));
    assert_string_equal(json_at(schema, "/properties/kind/anyOf/0/enum/0")->valuestring, "boxes");
    assert_true(json_at(schema, "/properties/name/anyOf/0/maxLength")->valuedouble == 200);
    assert_true(json_at(schema, "/allOf/0/then/properties/realisations/default")->valuedouble ==
                100);
    const cJSON *random = json_at(schema, "/properties/random");
    assert_string_equal(json_at(random, "/default")->valuestring, "common");
    assert_string_equal(json_at(random, "/anyOf/0/enum/1")->valuestring, "independent");
    assert_null(json_at(random, "/anyOf/1")); /* it cannot be swept */
    assert_non_null(json_at(schema, "/allOf/0/then/properties/random"));
    const cJSON *shapes = json_at(schema, "/allOf/0/then/properties/shapes/anyOf/0");
    assert_string_equal(json_at(shapes, "/anyOf/0/enum/2")->valuestring, "oval");
    assert_string_equal(json_at(shapes, "/anyOf/1/items/enum/2")->valuestring, "oval");
    assert_true(cJSON_IsTrue(json_at(shapes, "/anyOf/1/uniqueItems")));
    const cJSON *depth = json_at(schema, "/allOf/0/then/properties/depth/anyOf/1/items");
    assert_string_equal(json_at(depth, "/anyOf/0/enum/0")->valuestring, "endless");
    assert_true(json_at(depth, "/anyOf/1/properties/feet/maximum")->valuedouble == 10);
    assert_true(cJSON_IsFalse(json_at(depth, "/anyOf/1/additionalProperties")));
    cJSON_Delete(schema);
}

static int stop_at_zero(void *context) {
    int *left = context;
    return *left == 0 || --*left == 0;
}

/* Whoever asks for a check and leaves costs no more. */
static void a_check_stops_between_cases(void **state) {
    (void)state;
    static const char text[] = STUDY("\"box\":{\"width\":[0.1,0.2,0.3,0.4,0.5]}");
    for (int most = 1; most <= 6; most++) {
        struct fault_list faults = {0};
        struct study *study = NULL;
        struct error err = {0};
        int left = most;
        const struct study_reading reading = {
            .kinds = FAKE_KINDS, .stop = stop_at_zero, .stop_context = &left};
        int status = study_read_ext(&study, text, strlen(text), &reading, &faults, &err);
        assert_int_equal(status, most <= 5 ? ERROR_STOPPED : 0);
        assert_int_equal(left, most <= 5 ? 0 : 1);
        assert_true((study != NULL) == (status == 0));
        study_destroy(&study);
        fault_list_clear(&faults);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(faults_are_told_with_pointer_and_range),
        cmocka_unit_test(random_numbers_are_common_unless_told),
        cmocka_unit_test(all_faults_are_told_at_once),
        cmocka_unit_test(choices_and_measures),
        cmocka_unit_test(sweeps_run_in_the_order_of_the_file),
        cmocka_unit_test(too_many_cases_are_refused_before_they_are_made),
        cmocka_unit_test(seeds_are_read_whole),
        cmocka_unit_test(blocks_take_about_five_seconds),
        cmocka_unit_test(few_realisations_are_shared),
        cmocka_unit_test(a_check_stops_between_cases),
        cmocka_unit_test(overrides_change_the_document),
        cmocka_unit_test(schema_has_what_the_reader_asks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
