/* Protects: the table of kinds, and the rows of their parameters. */
#include "jobs/contact/companion/companion.h"
#include "jobs/kind.h"
#include "schema/json/json.h"
#include "schema/study/value.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* A default or an example in a row is a value of that row; an example may be swept. */
static void fits(const struct parameter *row, const char *json) {
    struct fault_list faults = {0};
    cJSON *value = cJSON_Parse(json);
    assert_non_null(value);
    if (row->sweep && value_is_list(row, value))
        for (const cJSON *item = value->child; item != NULL; item = item->next)
            value_check(row, item, row->path, &faults);
    else
        value_check(row, value, row->path, &faults);
    if (faults.count > 0)
        fail_msg("%s: %s: %s", row->path, json, faults.faults[0].detail);
    cJSON_Delete(value);
}

static void rows(void **state) {
    (void)state;
    for (size_t k = 0; JOB_KINDS[k] != NULL; k++) {
        const struct parameter_table *const *tables = JOB_KINDS[k]->tables;
        const struct parameter *row;
        for (size_t p = 0; (row = parameter_row(tables, p)) != NULL; p++) {
            size_t index = 0;
            assert_ptr_equal(parameter_find(tables, row->path, &index), row); /* each path once */
            assert_int_equal(index, p);
            assert_true(row->path[0] == '/' && strlen(row->help) > 0);
            bool named = row->type == PARAMETER_CHOICE || row->type == PARAMETER_CHOICES ||
                         row->type == PARAMETER_MEASURE;
            assert_true(named == (row->choices != NULL) || row->type == PARAMETER_NUMBERS);
            assert_true((row->type == PARAMETER_MEASURE) == (row->units != NULL));
            if (row->default_json != NULL)
                fits(row, row->default_json);
            assert_non_null(row->example_json);
            fits(row, row->example_json);
        }
    }
}

/* Calls each for every path of a parameter that a source file has in quotes. */
static void paths_each(const char *source, const char *file,
                       void (*each)(const char *path, const char *file)) {
    char name[4096], line[500];
    snprintf(name, sizeof name, "%s/%s", source, file);
    FILE *text = fopen(name, "r");
    if (text == NULL)
        fail_msg("cannot open %s", name);
    while (fgets(line, sizeof line, text) != NULL)
        for (char *at = line; (at = strstr(at, "\"/")) != NULL;) {
            char *path = at + 1, *end = strchr(path, '"');
            at = end != NULL ? end + 1 : path;
            if (end != NULL) {
                *end = '\0';
                each(path, file);
            }
        }
    fclose(text);
}

enum { ROWS_MOST = 512 };
static bool read_rows[ROWS_MOST]; /* of all kinds, in their order */
static size_t paths_found;

/* Marks the rows of a path; a path that no kind has is a reader's mistake. */
static void mark_read(const char *path, const char *file) {
    size_t before = 0;
    bool known = false;
    for (size_t k = 0; JOB_KINDS[k] != NULL; k++) {
        size_t index;
        if (parameter_find(JOB_KINDS[k]->tables, path, &index) != NULL) {
            assert_true(before + index < ROWS_MOST);
            read_rows[before + index] = known = true;
        }
        before += parameter_count(JOB_KINDS[k]->tables);
    }
    if (!known)
        fail_msg("%s reads %s, which no table has", file, path);
    paths_found++;
}

/* Parameters that stand beside results alone. */
static bool has_no_effect(const char *path) {
    static const char *const TOLD[] = {
        "/contact/generation_error", "/contact/young",         "/surface/like/bytes",
        "/surface/like/format",      "/surface/like/prepared", "/surface/like/unit",
        "/surface/like/wavelength",  "/surface/like/trusted",  "/surface/like/others"};
    for (size_t t = 0; t < sizeof TOLD / sizeof *TOLD; t++)
        if (strcmp(path, TOLD[t]) == 0)
            return true;
    return false;
}

/* A second face is read as the first is, where its row has a twin there (surface_counter.h). */
static bool twin_is_read(const char *path) {
    static const char COUNTER[] = "/counter_surface/";
    char twin[200];
    size_t before = 0;
    if (strncmp(path, COUNTER, sizeof COUNTER - 1) != 0)
        return false;
    snprintf(twin, sizeof twin, "/surface/%s", path + sizeof COUNTER - 1);
    for (size_t k = 0; JOB_KINDS[k] != NULL; k++) {
        size_t index;
        if (parameter_find(JOB_KINDS[k]->tables, twin, &index) != NULL && read_rows[before + index])
            return true;
        before += parameter_count(JOB_KINDS[k]->tables);
    }
    return false;
}

/* In both directions: readers ask for rows alone, and every row is read by one of them. */
static void readers_and_rows_agree(void **state) {
    (void)state;
    static const char *const READERS[] = {"jobs/surface/surface_case.c",
                                          "jobs/surface/surface_law.c",
                                          "jobs/surface/surface_counter.c",
                                          "jobs/surface/surface_plateau.c",
                                          "jobs/surface/surface_grooves.c",
                                          "jobs/contact/case/contact_case_read.c",
                                          "jobs/statistics/statistics_case.c",
                                          "jobs/target.c",
                                          "jobs/like/like_case.c",
                                          "jobs/like/like_hold.c",
                                          "jobs/contact/quantity/quantity_conductance.c",
                                          "jobs/contact/quantity/quantity_coupling.c",
                                          "jobs/contact/quantity/quantity_friction.c",
                                          "jobs/contact/quantity/quantity_hardness.c",
                                          "jobs/contact/quantity/quantity_leak.c",
                                          "jobs/contact/quantity/quantity_sliding.c",
                                          "jobs/contact/quantity/quantity_unload.c"};
    const char *source = getenv("RUGO_SOURCE");
    if (source == NULL) { /* it is set by tests/run-tests */
        print_message("SKIP: RUGO_SOURCE does not say where the tree is\n");
        skip();
    }
    for (size_t r = 0; r < sizeof READERS / sizeof *READERS; r++)
        paths_each(source, READERS[r], mark_read);
    for (size_t c = 0; c < COMPANION_COUNT; c++)
        if (COMPANIONS[c]->parameter != NULL)
            mark_read(COMPANIONS[c]->parameter, "the table of companions");
    assert_true(paths_found >= 40);
    const struct parameter *row;
    size_t before = 0;
    for (size_t k = 0; JOB_KINDS[k] != NULL; k++) {
        for (size_t p = 0; (row = parameter_row(JOB_KINDS[k]->tables, p)) != NULL; p++)
            if (!read_rows[before + p] && !has_no_effect(row->path) && !twin_is_read(row->path))
                fail_msg("nobody reads %s", row->path);
        before += parameter_count(JOB_KINDS[k]->tables);
    }
}

static void kinds(void **state) {
    (void)state;
    assert_non_null(kind_find("statistics"));
    assert_non_null(kind_find("contact"));
    assert_null(kind_find("statistic"));
    for (size_t k = 0; JOB_KINDS[k] != NULL; k++)
        assert_ptr_equal(&kind_find(JOB_KINDS[k]->name)->study, JOB_KINDS[k]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows),
        cmocka_unit_test(readers_and_rows_agree),
        cmocka_unit_test(kinds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
