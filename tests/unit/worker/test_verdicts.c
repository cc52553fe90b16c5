/* Protects: the JSON Schema and the reader say the same of a document. Documents are made from the
 * tables: of every parameter values at, within and beyond its bounds, of wrong types, in lists,
 * beside names that do not exist. An independent validator (python3-jsonschema) judges them by the
 * schema; without it the test is skipped. */
#include "jobs/kind.h"
#include "schema/study/study_reader.h"
#include "schema/study/value.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

/* What no single value shows is not in the schema: the kinds' own checks are left out. */
static int check_nothing(const struct study_kind *kind, const cJSON *parameters,
                         double memory_limit, struct fault_list *faults, struct study_cost *cost,
                         struct error *err) {
    (void)kind;
    (void)parameters;
    (void)memory_limit;
    (void)faults;
    (void)err;
    *cost = (struct study_cost){.nx = 1, .ny = 1, .seconds = 1};
    return 0;
}

enum { KINDS_MOST = 16 };
struct verdict_fixture {
    struct study_kind kinds[KINDS_MOST];
    const struct study_kind *table[KINDS_MOST + 1]; /* of these */
    size_t kind_count, documents, accepted;
    FILE *file; /* a document a line, behind the reader's verdict: 1 or 0 */
};

/* Has the reader judge a document, and writes it down. */
static void judge(struct verdict_fixture *f, const cJSON *document) {
    char *text = json_print(document);
    struct fault_list faults = {0};
    struct study *study = NULL;
    assert_non_null(text);
    int status = study_read(&study, text, strlen(text), NULL, f->table, 0, &faults, NULL);
    assert_true(status == 0 || status == ERROR_INPUT);
    f->documents++;
    f->accepted += status == 0;
    fprintf(f->file, "%d %s\n", status == 0, text);
    study_destroy(&study);
    fault_list_clear(&faults);
    free(text);
}

static cJSON *document_of(const struct study_kind *kind) {
    cJSON *document = cJSON_CreateObject();
    cJSON_AddStringToObject(document, "name", "n");
    cJSON_AddStringToObject(document, "kind", kind->name);
    return document;
}

/* Puts a value (taken) at a path, with the objects that lead to it. */
static void put_at(cJSON *object, const char *path, cJSON *value) {
    char name[POINTER_SIZE];
    for (const char *at = path + 1;;) {
        size_t length = strcspn(at, "/");
        snprintf(name, sizeof name, "%.*s", (int)length, at);
        if (at[length] == '\0')
            break;
        cJSON *next = cJSON_GetObjectItemCaseSensitive(object, name);
        object = next != NULL ? next : cJSON_AddObjectToObject(object, name);
        at += length + 1;
    }
    cJSON_DeleteItemFromObjectCaseSensitive(object, name);
    assert_true(cJSON_AddItemToObject(object, name, value));
}

static void judge_value(struct verdict_fixture *f, const struct study_kind *kind, const char *path,
                        const char *json) {
    cJSON *document = document_of(kind), *value = cJSON_Parse(json);
    if (value == NULL)
        fail_msg("%s: %s", path, json);
    put_at(document, path, value);
    judge(f, document);
    cJSON_Delete(document);
}

/* The value alone, in lists, and as a member of an object. */
static void judge_forms(struct verdict_fixture *f, const struct study_kind *kind,
                        const struct parameter *row, const char *json) {
    static const char *const FORMS[] = {"%s", "[%s]", "[%s,%s]", "[[%s],[%s]]", "[%s,null]"};
    for (size_t form = 0; form < sizeof FORMS / sizeof *FORMS; form++) {
        char text[1600];
        const char *rest = strstr(FORMS[form], "%s") + 2, *again = strstr(rest, "%s");
        size_t before = (size_t)(strstr(FORMS[form], "%s") - FORMS[form]);
        int between = again != NULL ? (int)(again - rest) : (int)strlen(rest);
        snprintf(text, sizeof text, "%.*s%s%.*s%s%s", (int)before, FORMS[form], json, between, rest,
                 again != NULL ? json : "", again != NULL ? again + 2 : "");
        judge_value(f, kind, row->path, text);
    }
}

static void judge_numbers(struct verdict_fixture *f, const struct study_kind *kind,
                          const struct parameter *row, const char *unit) {
    const double step = row->type == PARAMETER_INTEGER ? 1 : 0.5;
    const double numbers[] = {
        row->minimum,        row->minimum - step, row->minimum + step, row->maximum,
        row->maximum + step, row->maximum - step, row->maximum * 2,    0};
    for (size_t n = 0; n < sizeof numbers / sizeof *numbers; n++) {
        char text[200];
        snprintf(text, sizeof text, unit != NULL ? "{\"%s\":%.17g}" : "%s%.17g",
                 unit != NULL ? unit : "", numbers[n]);
        if (row->type != PARAMETER_NUMBERS) {
            judge_forms(f, kind, row, text);
            continue;
        }
        char array[700];
        snprintf(array, sizeof array, "[%s,%s,%s]", text, text, text);
        judge_forms(f, kind, row, array);
    }
}

static void judge_row(struct verdict_fixture *f, const struct study_kind *kind,
                      const struct parameter *row) {
    static const char *const ODD[] = {"null",
                                      "true",
                                      "\"\"",
                                      "\"odd\"",
                                      "[]",
                                      "[[]]",
                                      "{}",
                                      "{\"odd\":1}",
                                      "0.5",
                                      "-1",
                                      "1e300",
                                      "3",
                                      "[1,2]",
                                      "[1,2,3]",
                                      "[[1,2,3],4]",
                                      "\"18446744073709551615\"",
                                      "\"18446744073709551616\"",
                                      "\"099\"",
                                      "9007199254740993",
                                      "9007199254740994"};
    for (size_t a = 0; a < sizeof ODD / sizeof *ODD; a++)
        judge_value(f, kind, row->path, ODD[a]);
    if (row->example_json != NULL)
        judge_value(f, kind, row->path, row->example_json);
    for (const struct choice *choice = row->choices; choice != NULL && choice->name != NULL;
         choice++) {
        char text[100];
        snprintf(text, sizeof text, "\"%s\"", choice->name);
        judge_forms(f, kind, row, text);
    }
    for (const struct choice *unit = row->units; unit != NULL && unit->name != NULL; unit++)
        judge_numbers(f, kind, row, unit->name);
    if (row->type == PARAMETER_NUMBER || row->type == PARAMETER_INTEGER ||
        row->type == PARAMETER_NUMBERS)
        judge_numbers(f, kind, row, NULL);
    char beside[POINTER_SIZE];
    snprintf(beside, sizeof beside, "%s_", row->path);
    judge_value(f, kind, beside, "1");
}

static void judge_common(struct verdict_fixture *f) {
    static const char *const TEXTS[] = {"{}",
                                        "[]",
                                        "3",
                                        "{\"name\":\"n\"}",
                                        "{\"kind\":\"contact\"}",
                                        "{\"name\":\"n\",\"kind\":\"weather\"}",
                                        "{\"name\":\"n\",\"kind\":\"weather\",\"odd\":1}"};
    for (size_t t = 0; t < sizeof TEXTS / sizeof *TEXTS; t++) {
        cJSON *document = cJSON_Parse(TEXTS[t]);
        judge(f, document);
        cJSON_Delete(document);
    }
    static const char *const PATHS[] = {"/name", "/kind", "/seed", "/realisations"};
    for (size_t k = 0; k < f->kind_count; k++)
        for (size_t p = 0; p < sizeof PATHS / sizeof *PATHS; p++) {
            const struct parameter row = {.path = PATHS[p],
                                          .type = PARAMETER_INTEGER,
                                          .minimum = p == 2 ? 0 : 1,
                                          .maximum = p == 2 ? 0x1p53 : 1e7,
                                          .example_json = "\"n\""};
            judge_row(f, &f->kinds[k], &row);
        }
}

static void write_schema(const struct verdict_fixture *f) {
    cJSON *schema = study_schema(f->table);
    char *text = json_print(schema);
    FILE *file = fopen("schema.json", "w");
    assert_true(text != NULL && file != NULL && fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
    free(text);
    cJSON_Delete(schema);
}

static const char PROGRAM[] =
    "python3 -c 'import json, jsonschema\n"
    "judge = jsonschema.Draft202012Validator(json.load(open(\"schema.json\")))\n"
    "judge.check_schema(judge.schema)\n"
    "for line in open(\"documents\"): print(int(judge.is_valid(json.loads(line[2:]))))'";

static void compare(const struct verdict_fixture *f) {
    FILE *pipe = popen(PROGRAM, "r"), *documents = fopen("documents", "r");
    assert_true(pipe != NULL && documents != NULL);
    size_t differing = 0, read = 0;
    char *line = NULL;
    size_t room = 0;
    for (int verdict; fscanf(pipe, "%d", &verdict) == 1 && read < f->documents; read++) {
        assert_true(getline(&line, &room, documents) > 0);
        const bool accepted = line[0] == '1';
        if ((verdict == 1) != accepted && differing++ < 20)
            print_error("the schema %s, the reader %s %s", verdict == 1 ? "accepts" : "refuses",
                        accepted ? "accepts" : "refuses", line + 2);
    }
    free(line);
    fclose(documents);
    assert_int_equal(pclose(pipe), 0);
    assert_int_equal(read, f->documents);
    assert_int_equal(differing, 0);
}

static void verdicts_agree(void **state) {
    (void)state;
    if (system("python3 -c 'import jsonschema' 2> no-validator") != 0) {
        remove("no-validator");
        print_message("SKIP: python3-jsonschema is not installed\n");
        skip();
    }
    remove("no-validator");
    static struct verdict_fixture f;
    for (; JOB_KINDS[f.kind_count] != NULL; f.kind_count++) {
        assert_true(f.kind_count < KINDS_MOST);
        f.kinds[f.kind_count] = *JOB_KINDS[f.kind_count];
        f.kinds[f.kind_count].check = check_nothing;
        f.kinds[f.kind_count].expand = NULL;
        f.table[f.kind_count] = &f.kinds[f.kind_count];
    }
    f.file = fopen("documents", "w");
    assert_non_null(f.file);
    judge_common(&f);
    const struct parameter *row;
    for (size_t k = 0; k < f.kind_count; k++)
        for (size_t p = 0; (row = parameter_row(f.kinds[k].tables, p)) != NULL; p++)
            judge_row(&f, &f.kinds[k], row);
    assert_int_equal(fclose(f.file), 0);
    print_message("%zu documents, %zu of them accepted\n", f.documents, f.accepted);
    assert_true(f.accepted > f.documents / 10 && f.accepted < f.documents);
    write_schema(&f);
    compare(&f);
    remove("documents");
    remove("schema.json");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(verdicts_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
