/* Workers on a local store: every realisation once, whatever happens to leases and workers. */
#include "tests/support/result_tree.h"
#include "tests/unit/worker/small_study.h"
#include "worker/link/client.h"
#include "worker/publish/aggregate.h"
#include "worker/worker.h"

#include <time.h>

/* Work for some seconds: surfaces of 256 x 256 points, in one job. */
static const char LONG_STUDY[] =
    "{\"name\":\"long\",\"kind\":\"statistics\",\"seed\":7,\"realisations\":20000,\"surface\":{"
    "\"dimension\":2,\"hurst\":0.5,\"wavelength_ratio\":8,\"length_ratio\":4,"
    "\"points_per_wavelength\":8}}";

static struct worker_options drain(const struct fixture *fixture, unsigned threads) {
    return (struct worker_options){.source = {.database = fixture->database, .worker = "test"},
                                   .threads = threads,
                                   .drain = 1};
}

static void work(const struct worker_options *options, int expected) {
    struct error err = {0};
    int status = workers_run(options, &err);
    if (status != expected) {
        fail_msg("status %d: %s", status, err.text);
    }
}

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

static void queue_is_drained(void **state) {
    (void)state;
    struct fixture fixture;
    fixture_open(&fixture);
    fixture_submit(&fixture, SMALL_STUDY, 5, NULL, 0);
    struct worker_options options = drain(&fixture, 1);
    work(&options, 0);
    struct study_status status = fixture_status(&fixture);
    assert_string_equal(status.state, "done");
    assert_int_equal(status.jobs, 10);
    assert_int_equal(status.jobs_done, 10);
    assert_int_equal(status.realisations_done, 48);
    study_status_clear(&status);
    struct case_info info = {0};
    struct error err = {0};
    const struct published_part all = {0};
    struct case_result published = {0};
    bool found = false;
    assert_int_equal(store_case(fixture.store, fixture.study, 1, &info, &err), 0);
    assert_int_equal(store_published(fixture.store, fixture.study, 1, info.revision, &all,
                                     &published, &found, &err),
                     0);
    assert_true(found); /* by the worker that took the case's last block */
    result_clear(&published);
    case_info_clear(&info);
    fixture_close(&fixture);
}

/* The promise of the service: threads and blocks do not show in the result. */
static void threads_and_blocks_leave_the_bits(void **state) {
    (void)state;
    static const struct {
        unsigned threads;
        uint64_t block;
    } table[] = {{1, 24}, {2, 5}, {5, 1}};
    char *first = NULL;
    for (size_t n = 0; n < sizeof table / sizeof table[0]; n++) {
        struct fixture fixture;
        fixture_open(&fixture);
        fixture_submit(&fixture, SMALL_STUDY, table[n].block, NULL, 0);
        struct worker_options options = drain(&fixture, table[n].threads);
        work(&options, 0);
        char *text = curves_text(&fixture);
        if (first) {
            assert_string_equal(text, first);
            free(text);
        } else {
            first = text;
        }
        fixture_close(&fixture);
    }
    free(first);
}

/* What the caller's tick does while a long job runs. */
struct worker_scene {
    struct fixture *fixture;
    atomic_int stop;
    int ticks;
    struct store *thief;
    struct claimed_job stolen;
    size_t taken;  /* jobs that the thief got */
    int64_t hours; /* that his clock is ahead */
};

static int tick_stop(void *context) {
    struct worker_scene *scene = context;
    scene->stop = 1;
    return 0;
}

/* Asked to stop, a worker hands its job back at once, as if it had never had it. */
static void stop_hands_the_job_back(void **state) {
    (void)state;
    struct fixture fixture;
    fixture_open(&fixture);
    fixture_submit(&fixture, LONG_STUDY, 20000, NULL, 0);
    struct worker_scene scene = {.fixture = &fixture};
    struct worker_options options = drain(&fixture, 2);
    options.stop = &scene.stop;
    options.tick = tick_stop;
    options.context = &scene;
    work(&options, ERROR_STOPPED);
    struct study_status status = fixture_status(&fixture);
    assert_int_equal(status.jobs_running, 0);
    assert_int_equal(status.jobs_waiting, 1);
    study_status_clear(&status);
    struct claim claim = {.worker = "next", .count = 1};
    struct claimed_job job = {0};
    size_t count = 0;
    struct error err = {0};
    assert_int_equal(store_claim(fixture.store, &claim, &job, &count, &err), 0);
    assert_int_equal(count, 1);
    assert_int_equal(job.attempt, 1);
    claimed_job_clear(&job);
    fixture_close(&fixture);
}

static int tick_cancel(void *context) {
    struct worker_scene *scene = context;
    struct error err = {0};
    (void)store_cancel(scene->fixture->store, scene->fixture->study, &err);
    return 0;
}

/* The word of a cancelled study comes with a heartbeat: the worker leaves a job of many seconds. */
static void cancelled_study_is_left(void **state) {
    (void)state;
    struct fixture fixture;
    fixture_open(&fixture);
    fixture_submit(&fixture, LONG_STUDY, 20000, NULL, 0);
    struct worker_scene scene = {.fixture = &fixture};
    struct worker_options options = drain(&fixture, 1);
    options.source.lease_ms = 300;
    options.tick = tick_cancel;
    options.context = &scene;
    work(&options, 0);
    struct study_status status = fixture_status(&fixture);
    assert_string_equal(status.state, "cancelled");
    assert_int_equal(status.jobs_done, 0);
    study_status_clear(&status);
    fixture_close(&fixture);
}

/* The lease clock, some hours later. */
static int64_t in_hours(void *context) {
    const int64_t *hours = context;
    struct timespec now = {0};
    clock_gettime(CLOCK_BOOTTIME, &now);
    return (int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000 + *hours * 3600000;
}

static bool has_begun(const struct worker_scene *scene) {
    return sql_integer(scene->fixture->database, "SELECT count(*) " RUNNING_JOBS) > 0;
}

/* First takes the running job away, as a worker does whose predecessor's lease ran out; then gives
 * up the whole study. */
static int tick_steal(void *context) {
    struct worker_scene *scene = context;
    struct error err = {0};
    struct claim claim = {.worker = "thief", .count = 1};
    if (scene->ticks == 0 && !has_begun(scene)) /* there is nothing to be stolen yet */
        return 0;
    if (scene->ticks < 2) { /* at first the job waits for a while, as it was lost */
        assert_int_equal(scene->taken, 0);
        assert_int_equal(store_claim(scene->thief, &claim, &scene->stolen, &scene->taken, &err), 0);
        scene->hours++;
    }
    return ++scene->ticks == 4;
}

/* A worker that lost its lease does not report: neither done nor failed, the job is the thief's. */
static void lost_lease_is_not_reported(void **state) {
    (void)state;
    struct fixture fixture;
    fixture_open(&fixture);
    fixture_submit(&fixture, LONG_STUDY, 20000, NULL, 0);
    struct worker_scene scene = {.fixture = &fixture};
    struct error err = {0};
    scene.hours = 1;
    struct store_options later = {.now_ms = in_hours, .context = &scene.hours};
    assert_int_equal(store_open(&scene.thief, fixture.database, &later, &err), 0);
    struct worker_options options = drain(&fixture, 1);
    options.source.lease_ms = 3000;
    options.tick = tick_steal;
    options.context = &scene;
    work(&options, ERROR_STOPPED);
    assert_int_equal(scene.taken, 1);
    assert_int_equal(scene.stolen.attempt, 1);
    assert_int_equal(store_heartbeat(scene.thief, scene.stolen.id, scene.stolen.token, 3, &err), 0);
    struct study_status status = fixture_status(&fixture);
    assert_int_equal(status.jobs_running, 1);
    assert_int_equal(status.jobs_done + status.jobs_failed, 0);
    study_status_clear(&status);
    claimed_job_clear(&scene.stolen);
    store_close(&scene.thief);
    fixture_close(&fixture);
}

static int64_t constant(void *context) {
    return *(const int64_t *)context;
}

/* A rival whose clock is just behind the end of the job's first lease. */
static int tick_compete(void *context) {
    struct worker_scene *scene = context;
    struct error err = {0};
    struct store *rival = NULL;
    struct claim claim = {.worker = "rival", .count = 1};
    if (!has_begun(scene))
        return 0;
    int64_t later_ms = fixture_await_renewals(scene->fixture) + 1;
    const struct store_options later = {.now_ms = constant, .context = &later_ms};
    assert_int_equal(store_open(&rival, scene->fixture->database, &later, &err), 0);
    assert_int_equal(store_claim(rival, &claim, &scene->stolen, &scene->taken, &err), 0);
    store_close(&rival);
    scene->ticks++;
    return 1;
}

/* A job that takes longer than its lease keeps it. */
static void long_job_keeps_its_lease(void **state) {
    (void)state;
    struct fixture fixture;
    fixture_open(&fixture);
    fixture_submit(&fixture, LONG_STUDY, 20000, NULL, 0);
    struct worker_scene scene = {.fixture = &fixture};
    struct worker_options options = drain(&fixture, 1);
    options.source.lease_ms = 4000;
    options.tick = tick_compete;
    options.context = &scene;
    work(&options, ERROR_STOPPED);
    assert_int_equal(scene.ticks, 1);
    assert_int_equal(scene.taken, 0);
    assert_int_equal(sql_integer(fixture.database, "SELECT sum(losses) FROM job"), 0);
    fixture_close(&fixture);
}

/* A study whose cases cannot run: it is reported once with the reason, and the queue still
 * drains. */
static void wrong_job_fails_with_its_reason(void **state) {
    (void)state;
    struct fixture fixture;
    fixture_open(&fixture);
    fixture_submit(&fixture, SMALL_STUDY, 24, "hurst", 7.0);
    struct worker_options options = drain(&fixture, 2);
    work(&options, 0);
    struct failure *failures = NULL;
    struct error err = {0};
    size_t count = 0;
    assert_int_equal(store_failures(fixture.store, fixture.study, &failures, &count, &err), 0);
    assert_int_equal(count, 2);
    assert_int_equal(failures[0].attempts, 1);
    assert_true(strlen(failures[0].reason) > 0);
    failures_free(failures, count);
    struct study_status status = fixture_status(&fixture);
    assert_string_equal(status.state, "failed");
    study_status_clear(&status);
    fixture_close(&fixture);
}

/* A job that takes its workers down with it: after ten of them it fails, with a reason, and the
 * next worker finds the queue empty. */
static void deadly_job_fails_after_ten_workers(void **state) {
    (void)state;
    struct fixture fixture;
    fixture_open(&fixture);
    fixture_submit(&fixture, SMALL_STUDY, 48, NULL, 0);
    struct error err = {0};
    for (int64_t hours = 0; hours <= 2 * LOSSES_MOST; hours++) {
        struct store *victim = NULL;
        struct store_options later = {.now_ms = in_hours, .context = &hours};
        struct claim claim = {.worker = "victim", .count = 2};
        struct claimed_job jobs[2] = {{0}, {0}};
        size_t count = 0;
        assert_int_equal(store_open(&victim, fixture.database, &later, &err), 0);
        assert_int_equal(store_claim(victim, &claim, jobs, &count, &err), 0);
        /* every other time leases run out, and what they were of waits for a while */
        assert_int_equal(count, hours % 2 == 0 && hours < 2 * LOSSES_MOST ? 2 : 0);
        claimed_job_clear(&jobs[0]);
        claimed_job_clear(&jobs[1]);
        store_close(&victim); /* gone without a word */
    }
    struct worker_options options = drain(&fixture, 1);
    work(&options, 0);
    struct failure *failures = NULL;
    size_t count = 0;
    assert_int_equal(store_failures(fixture.store, fixture.study, &failures, &count, &err), 0);
    assert_int_equal(count, 2);
    assert_int_equal(failures[0].losses, LOSSES_MOST);
    assert_int_equal(failures[0].attempts, 0);
    assert_non_null(strstr(failures[0].reason, "lost with its worker 10 times"));
    failures_free(failures, count);
    fixture_close(&fixture);
}

static int tick_end(void *context) {
    struct worker_scene *scene = context;
    return ++scene->ticks == 2;
}

/* A server that is not there yet is waited for, and the wait is no obstacle to the end. */
static void server_away_is_waited_for(void **state) {
    (void)state;
    struct worker_scene scene = {0};
    struct worker_options options = {.source = {.url = "http://127.0.0.1:1", .worker = "test"},
                                     .threads = 2,
                                     .tick = tick_end,
                                     .context = &scene};
    work(&options, ERROR_STOPPED);
}

static void wrong_options_are_refused(void **state) {
    (void)state;
    struct worker_options options = {.threads = 1};
    work(&options, ERROR_INPUT); /* neither database nor server */
    options.source.url = "http://127.0.0.1:1/path";
    work(&options, ERROR_INPUT);
    options.source.url = "http://127.0.0.1:1";
    options.threads = 0;
    work(&options, ERROR_INPUT);
}

static int set_up(void **state) {
    (void)state;
    struct error err = {0};
    return client_global_init(&err);
}

static int tear_down(void **state) {
    (void)state;
    client_global_cleanup();
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(queue_is_drained),
        cmocka_unit_test(threads_and_blocks_leave_the_bits),
        cmocka_unit_test(stop_hands_the_job_back),
        cmocka_unit_test(cancelled_study_is_left),
        cmocka_unit_test(lost_lease_is_not_reported),
        cmocka_unit_test(long_job_keeps_its_lease),
        cmocka_unit_test(wrong_job_fails_with_its_reason),
        cmocka_unit_test(deadly_job_fails_after_ten_workers),
        cmocka_unit_test(server_away_is_waited_for),
        cmocka_unit_test(wrong_options_are_refused),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
