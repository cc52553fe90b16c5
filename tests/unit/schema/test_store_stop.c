/* Protects: whoever reads a store for somebody who has gone stops, at whatever row, and the handle
 * serves the next one. */
#include "schema/store/store.h"
#include "schema/study/study_reader.h"
#include "tests/support/check.h"
#include "tests/support/fake_kind.h"
#include <string.h>

static int leave(void *context) {
    int *patience = context;
    return (*patience)-- <= 0;
}

static void reading_stops_at_any_row(void **state) {
    (void)state;
    static const char text[] =
        "{\"name\":\"n\",\"kind\":\"boxes\",\"realisations\":4,\"box\":{\"width\":[0.5,1]}}";
    struct store *store = NULL;
    struct study *study = NULL;
    struct fault_list faults = {0};
    char id[STUDY_ID_SIZE];
    assert_int_equal(store_open(&store, "stopped.db", NULL, NULL), 0);
    assert_int_equal(study_read(&study, text, strlen(text), NULL, FAKE_KINDS, 0, &faults, NULL), 0);
    assert_int_equal(store_submit(store, study, NULL, id, NULL, NULL), 0);
    study_destroy(&study);
    int stops = 0, status = ERROR_STOPPED;
    for (int most = 0; status != 0 && most < 1000; most++) {
        struct study_status about = {0};
        struct error err = {0};
        int patience = most;
        store_set_stop(store, leave, &patience);
        status = store_status(store, id, &about, &err);
        assert_true(status == 0 || status == ERROR_STOPPED);
        stops += status == ERROR_STOPPED;
        assert_true(status == 0 || strstr(err.text, "stopped") != NULL);
        study_status_clear(&about);
        store_set_stop(store, NULL, NULL);
        assert_int_equal(store_status(store, id, &about, NULL), 0);
        assert_int_equal(about.cases, 2);
        study_status_clear(&about);
    }
    assert_int_equal(status, 0);
    assert_true(stops > 2);
    store_close(&store);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(reading_stops_at_any_row)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
