/* Contact studies through the queue: threads that share a case's compliance, blocks and their order
 * leave the bits of the curves alone (run under ThreadSanitizer too). */
#include "tests/support/effort.h"
#include "tests/support/result_tree.h"
#include "tests/unit/worker/small_study.h"
#include "worker/publish/aggregate.h"
#include "worker/worker.h"

/* Two models on two levels. */
static const char CONTACT_STUDY[] =
    "{\"name\":\"contact\",\"kind\":\"contact\",\"seed\":7,\"realisations\":12,\"surface\":{"
    "\"dimension\":1,\"hurst\":0.2,\"wavelength_ratio\":4,\"length_ratio\":2},"
    "\"contact\":{\"model\":[\"halfspace\",\"layered\"],\"levels\":[4,8],"
    "\"pressures\":{\"to\":0.4,\"steps\":4}}}";
/* Two cases, without errors of cells. The second one is too steep for the model full at some loads,
 * which leaves notes. */
static const char STEEP_STUDY[] =
    "{\"name\":\"steep\",\"kind\":\"contact\",\"seed\":3,\"realisations\":6,\"surface\":{"
    "\"dimension\":1,\"hurst\":0.8,\"wavelength_ratio\":2,\"length_ratio\":2,"
    "\"points_per_wavelength\":6,\"rms_slope\":[0.1,1.2]},\"contact\":{\"model\":[\"full\","
    "\"halfspace\"],\"block_height\":{\"lengths\":1},\"cell_error\":\"none\",\"time_limit\":0.3,"
    "\"pressures\":{\"to\":0.5,\"steps\":3}}}";

/* The study's curves without its id, as text. */
static char *curves_text(struct fixture *fixture) {
    const struct result_filter filter = {.case_number = -1, .complete = true};
    struct error err = {0};
    struct study_result study = {0};
    if (aggregate_study(fixture->store, fixture->study, &filter, &study, &err) != 0)
        fail_msg("%s", err.text);
    cJSON *curves = study_tree(&study);
    study_result_clear(&study);
    cJSON_DeleteItemFromObject(curves, "study");
    cJSON_DeleteItemFromObject(curves, "provenance"); /* what differs between runs */
    char *text = json_print(curves);
    assert_non_null(text);
    cJSON_Delete(curves);
    return text;
}

/* Under sanitizers five threads alone: one by itself has nobody to share with. */
static void same_bits(const char *study, bool noted) {
    static const struct {
        unsigned threads;
        uint64_t block;
    } table[] = {{1, 12}, {2, 4}, {5, 1}};
    char *first = NULL;
    for (size_t n = case_step() - 1; n < sizeof table / sizeof table[0]; n++) {
        struct fixture fixture;
        struct error err = {0};
        fixture_open(&fixture);
        fixture_submit(&fixture, study, table[n].block, NULL, 0);
        struct worker_options options = {.source = {.database = fixture.database, .worker = "test"},
                                         .threads = table[n].threads,
                                         .drain = 1};
        if (workers_run(&options, &err) != 0) {
            fail_msg("%s", err.text);
        }
        struct study_status status = fixture_status(&fixture);
        assert_string_equal(status.state, "done");
        assert_int_equal(status.realisations_done, 12);
        study_status_clear(&status);
        char *text = curves_text(&fixture);
        if (first) {
            assert_string_equal(text, first);
            free(text);
        } else {
            first = text;
        }
        fixture_close(&fixture);
    }
    assert_int_equal(strstr(first, "\"notes\":") != NULL, noted);
    free(first);
}

static void threads_and_blocks_leave_the_bits(void **state) {
    (void)state;
    same_bits(CONTACT_STUDY, false);
    same_bits(STEEP_STUDY, true);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_and_blocks_leave_the_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
