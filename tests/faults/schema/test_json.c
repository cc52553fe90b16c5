/* Protects: a text is parsed, printed and a study read, or refused for want of memory, whichever
 * allocation fails: never half of it, never as a fault of the user's, and nothing leaks. */
#include "tests/support/check.h"

#include "schema/json/json.h"
#include "schema/study/study_reader.h"
#include "tests/support/failing/each_allocation.h"
#include "tests/support/fake_kind.h"
#include <stdlib.h>
#include <string.h>

static const char TEXT[] =
    "{\"a\":[1,-2.5e-300,true,null],\"b\":{\"c\":\"\\u00e4 text\",\"d\":\"\"}}";
static const char PRINTED[] = "{\"a\":[1,-2.5e-300,true,null],\"b\":{\"c\":\"ä text\",\"d\":\"\"}}";

static int parse_and_print(void *context, struct error *err) {
    cJSON *value = NULL;
    (void)context;
    int status = json_parse(TEXT, strlen(TEXT), NULL, &value, err);
    if (status != 0)
        return status;
    char *text = json_print(value);
    cJSON_Delete(value);
    if (text == NULL)
        return error_memory(err, sizeof TEXT, "a text");
    assert_string_equal(text, PRINTED);
    free(text);
    return 0;
}

/* Longer than any buffer of the C library: a text that ends early would show. */
static int print_much(void *context, struct error *err) {
    char *text = json_print(context);
    if (text == NULL)
        return error_memory(err, 40000, "a text");
    assert_int_equal(strlen(text), 40003);
    free(text);
    return 0;
}

static int base64(void *context, struct error *err) {
    char *text = NULL;
    unsigned char *data = NULL;
    size_t size = 0;
    (void)context;
    int status = base64_encode((const unsigned char *)TEXT, sizeof TEXT, &text, err);
    if (status == 0)
        status = base64_decode(text, &data, &size, err);
    if (status == 0) {
        assert_int_equal(size, sizeof TEXT);
        assert_memory_equal(data, TEXT, size);
    }
    free(text);
    free(data);
    return status;
}

static void texts(void **state) {
    (void)state;
    static char long_text[40002];
    memset(long_text, 'x', 40001);
    cJSON *much = cJSON_CreateString(long_text);
    each_allocation(&(struct failing_call){.name = "JSON", parse_and_print, NULL});
    each_allocation(&(struct failing_call){.name = "long text", print_much, much});
    each_allocation(&(struct failing_call){.name = "base64", base64, NULL});
    cJSON_Delete(much);
}

static const char STUDY[] = "{\"name\":\"boxes\",\"kind\":\"boxes\",\"seed\":3,\"realisations\":20,"
                            "\"box\":{\"width\":[0.5,1],\"count\":[1,2,3]},\"bins\":[1,2],"
                            "\"shapes\":[\"oval\"]}";

static int read_study(void *context, struct error *err) {
    static const char *const OVERRIDES[] = {"box.colour=green", "/seconds=2", "depth.feet=3", NULL};
    struct study *study = NULL;
    struct fault_list faults = {0};
    (void)context;
    int status = study_read(&study, STUDY, strlen(STUDY), OVERRIDES, FAKE_KINDS, 0, &faults, err);
    assert_int_equal(faults.count, 0);
    if (status == 0)
        assert_int_equal(study->case_count, 6);
    study_destroy(&study);
    fault_list_clear(&faults);
    return status;
}

/* With faults, some of which there may be no memory to keep: it stays refused. */
static int refuse_study(void *context, struct error *err) {
    const char *wrong = context;
    struct study *study = NULL;
    struct fault_list faults = {0};
    int status = study_read(&study, wrong, strlen(wrong), NULL, FAKE_KINDS, 0, &faults, err);
    assert_null(study);
    fault_list_clear(&faults);
    assert_int_not_equal(status, 0);
    return status == ERROR_INPUT ? 0 : status;
}

static int make_schema(void *context, struct error *err) {
    (void)context;
    cJSON *schema = study_schema(FAKE_KINDS);
    if (schema == NULL)
        return error_memory(err, 0, "a schema");
    cJSON_Delete(schema);
    return 0;
}

static void studies(void **state) {
    (void)state;
    static char wrong[] = "{\"name\":3,\"kind\":\"boxes\",\"box\":{\"width\":7,\"many\":1}}";
    static char together[] =
        "{\"name\":\"b\",\"kind\":\"boxes\",\"box\":{\"width\":0.5,\"count\":7}}";
    static char each_case[] =
        "{\"name\":\"b\",\"kind\":\"boxes\",\"box\":{\"width\":0.5,\"count\":7,"
        "\"colour\":[\"red\",\"green\"]},\"depth\":[{\"metres\":1},{\"feet\":2}]}";
    /* What a fault would say is made beforehand, and may be missing where there is none. */
    each_allocation(&(struct failing_call){.name = "study", read_study, NULL, .may_succeed = 1});
    each_allocation(
        &(struct failing_call){.name = "faults", refuse_study, wrong, .may_succeed = 1});
    each_allocation(&(struct failing_call){
        .name = "fault of values", refuse_study, together, .may_succeed = 1});
    each_allocation(&(struct failing_call){
        .name = "fault of each case", refuse_study, each_case, .may_succeed = 1});
    each_allocation(&(struct failing_call){.name = "schema", make_schema, NULL});
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texts),
        cmocka_unit_test(studies),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
