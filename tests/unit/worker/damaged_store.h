/* A store whose study is done, copies of it, and what is damaged in them. */
#ifndef RUGO_TESTS_UNIT_WORKER_DAMAGED_STORE_H
#define RUGO_TESTS_UNIT_WORKER_DAMAGED_STORE_H

#include "schema/result/bytes/bytes.h"
#include "schema/result/bytes/curve_bytes.h"
#include "tests/support/seed.h"
#include "tests/support/sql.h"
#include "tests/support/store_files.h"
#include "tests/unit/worker/small_study.h"
#include "worker/publish/aggregate.h"
#include "worker/worker.h"

enum { CASES = 2 };

static inline void work_off(const char *database) {
    struct worker_options options = {
        .source = {.database = database, .worker = "test"}, .threads = 1, .drain = 1};
    struct error err = {0};
    if (workers_run(&options, &err) != 0)
        fail_msg("%s", err.text);
}

/* Leaves the file of a study of two cases, done in blocks of 6 realisations; its id goes to id. */
static inline void make_whole(const char *path, char id[STUDY_ID_SIZE]) {
    struct fixture fixture;
    fixture_open(&fixture);
    fixture_submit(&fixture, SMALL_STUDY, 6, NULL, 0);
    work_off(fixture.database);
    memcpy(id, fixture.study, STUDY_ID_SIZE);
    store_close(&fixture.store);
    assert_int_equal(rename(fixture.database, path), 0);
}

/* Flips a bit of the file anywhere, and says which. */
static inline void flip_file_bit(const char *path, uint64_t *random, char *what, size_t size) {
    FILE *file = fopen(path, "r+b");
    assert_non_null(file);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    long at = (long)(next_word(random) % (uint64_t)ftell(file));
    unsigned bit = (unsigned)(next_word(random) >> 32) % 8;
    assert_int_equal(fseek(file, at, SEEK_SET), 0);
    int byte = fgetc(file);
    assert_int_equal(fseek(file, at, SEEK_SET), 0);
    assert_true(fputc(byte ^ (int)(1u << bit), file) != EOF);
    assert_int_equal(fclose(file), 0);
    snprintf(what, size, "bit %u of byte %ld of the file", bit, at);
}

/* Prints all that the results of a case are, curves as hashes of their bytes: as numbers they would
 * take most of the time. */
static inline void print_results(FILE *file, const struct case_result *result) {
    fprintf(file, "%llu realisations\n", (unsigned long long)result->realisations);
    for (size_t p = 0; p < result->parameter_count; p++) {
        const struct result_parameter *one = &result->parameters[p];
        fprintf(file, "%s %s %a\n", one->pointer, one->text != NULL ? one->text : "", one->number);
    }
    for (size_t s = 0; s < result->scalar_count; s++) {
        const struct scalar *scalar = &result->scalars[s];
        fprintf(file, "%s %a %a %a %a\n", scalar->name, scalar->value, scalar->standard_error,
                scalar->theory, scalar->grid);
    }
    for (size_t a = 0; a < result->curve_count; a++) {
        struct error err = {0};
        unsigned char *bytes = NULL;
        size_t size = 0;
        assert_int_equal(curves_encode(&result->curves[a], 1, &bytes, &size, &err), 0);
        fprintf(file, "%s %s %llx\n", result->curves[a].quantity, result->curves[a].series,
                (unsigned long long)hash_bytes(HASH_START, size, bytes));
        free(bytes);
    }
}

/* Gives the results of a case as a text, the caller's to free; NULL with the reason where they are
 * refused. */
static inline char *case_text(const char *path, const char *study, int64_t case_number,
                              struct error *err) {
    const struct result_filter filter = {.case_number = case_number};
    struct store_options options = {.read_only = true};
    struct study_result result = {0};
    struct store *store = NULL;
    char *text = NULL;
    *err = (struct error){0};
    int status = store_open(&store, path, &options, err);
    if (status == 0)
        status = aggregate_study(store, study, &filter, &result, err);
    if (status == 0) {
        size_t size;
        FILE *file = open_memstream(&text, &size);
        assert_non_null(file);
        print_results(file, &result.cases[0]);
        assert_int_equal(fclose(file), 0);
    }
    study_result_clear(&result);
    store_close(&store);
    return text;
}

/* The store of a test program, in whole.db. */
static struct {
    char study[STUDY_ID_SIZE];
    char *cases[CASES]; /* as they are */
} whole;

static inline int whole_set_up(void **state) {
    (void)state;
    struct error err;
    make_whole("whole.db", whole.study);
    for (int64_t c = 0; c < CASES; c++) {
        whole.cases[c] = case_text("whole.db", whole.study, c, &err);
        assert_non_null(whole.cases[c]);
        assert_true(strlen(whole.cases[c]) > 500);
    }
    return 0;
}

static inline int whole_tear_down(void **state) {
    (void)state;
    for (int c = 0; c < CASES; c++)
        free(whole.cases[c]);
    remove_store("whole.db");
    return 0;
}

#endif
