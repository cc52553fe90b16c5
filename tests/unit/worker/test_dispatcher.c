/* The dispatcher on a local store: many small jobs at once, one offer each, and all of them back
 * or done in the end. */
#include "tests/unit/worker/small_study.h"
#include "worker/clock.h"
#include "worker/dispatcher.h"
#include "worker/publish/publish.h"

#include "jobs/runner.h"
#include <pthread.h>
#include <time.h>

enum { LEASE_MS = 4000 }; /* renewed after a third of it */

struct scene {
    struct fixture fixture;
    struct source_options source;
    struct dispatcher *dispatcher;
};

/* 48 realisations in jobs of `block`. */
static void scene_open_with(struct scene *scene, uint64_t block,
                            const struct dispatcher_options *own) {
    struct error err = {0};
    struct dispatcher_options options = *own;
    *scene = (struct scene){0};
    fixture_open(&scene->fixture);
    fixture_submit(&scene->fixture, SMALL_STUDY, block, NULL, 0);
    scene->source = (struct source_options){
        .database = scene->fixture.database, .worker = "test", .lease_ms = LEASE_MS};
    options.source = &scene->source;
    if (dispatcher_create(&scene->dispatcher, &options, &err) != 0)
        fail_msg("%s", err.text);
}

/* 48 jobs of a realisation. */
static void scene_open(struct scene *scene, unsigned threads, bool drain) {
    scene_open_with(scene, 1, &(struct dispatcher_options){.threads = threads, .drain = drain});
}

static void scene_close(struct scene *scene) {
    dispatcher_destroy(&scene->dispatcher);
    fixture_close(&scene->fixture);
}

static void expect(struct scene *scene, uint64_t waiting, uint64_t running, uint64_t done) {
    struct study_status status = fixture_status(&scene->fixture);
    assert_int_equal(status.jobs_running, running);
    assert_int_equal(status.realisations_done, done);
    assert_true((status.jobs_waiting > 0) == (waiting > 0));
    study_status_clear(&status);
}

static struct lease *take(struct scene *scene) {
    struct lease *lease = NULL;
    assert_int_equal(dispatcher_take(scene->dispatcher, true, &lease), OFFER_JOB);
    assert_non_null(lease);
    return lease;
}

static void run(struct scene *scene, struct lease *lease) {
    const struct claimed_job *job = lease_job(lease);
    struct job_end end = {.verb = REPORT_COMPLETE};
    struct job_runner *runner = NULL;
    struct error err = {0};
    assert_int_equal(runner_create(&runner, kind_find(job->kind), job->parameters, NULL, job->seed,
                                   job->sequence, &err),
                     0);
    assert_int_equal(runner_run(runner, job->first, job->count, NULL, &end.result, &err), 0);
    runner_destroy(&runner);
    dispatcher_hand_in(scene->dispatcher, &lease, &end);
    assert_null(lease);
    assert_null(end.result.data);
}

/* One claim brings more than one job; those not begun are given back at the end, those handed in
 * are stored. */
static void the_stock_is_given_back(void **state) {
    (void)state;
    struct scene scene;
    scene_open(&scene, 1, false);
    struct lease *lease = take(&scene);
    struct study_status status = fixture_status(&scene.fixture);
    assert_true(status.jobs_running > 1);
    study_status_clear(&status);
    run(&scene, lease);
    dispatcher_end(scene.dispatcher);
    assert_int_equal(dispatcher_take(scene.dispatcher, true, &lease), OFFER_END);
    dispatcher_destroy(&scene.dispatcher);
    expect(&scene, 1, 0, 1);
    scene_close(&scene);
}

/* A job that lasts for longer than the process does is not begun, once it is known how long jobs
 * last. It is handed back with all others. Jobs of several realisations are begun: those that are
 * done can be handed in. */
static void no_job_is_begun_that_ends_too_late(void **state) {
    (void)state;
    struct scene scene;
    struct lease *lease;
    const struct timespec pause = {0, 5000000};
    const struct dispatcher_options options = {.threads = 1, .until_ms = clock_ms() + 1};
    scene_open_with(&scene, 1, &options);
    lease = take(&scene);
    nanosleep(&pause, NULL);
    run(&scene, lease);
    assert_int_equal(dispatcher_take(scene.dispatcher, true, &lease), OFFER_END);
    dispatcher_destroy(&scene.dispatcher);
    expect(&scene, 1, 0, 1);
    assert_int_equal(sql_integer(scene.fixture.database, "SELECT sum(attempts) FROM job"), 1);
    scene_close(&scene);

    scene_open_with(&scene, 2, &options);
    lease = take(&scene);
    nanosleep(&pause, NULL);
    run(&scene, lease);
    run(&scene, take(&scene));
    scene_close(&scene);
}

static int64_t constant(void *context) {
    return *(const int64_t *)context;
}

/* Jobs in stock and at work keep their leases: a rival whose clock is behind the end of the first
 * ones gets none of them. */
static void all_leases_are_kept(void **state) {
    (void)state;
    struct scene scene;
    scene_open(&scene, 1, false);
    struct lease *lease = take(&scene);
    int64_t later_ms = fixture_await_renewals(&scene.fixture) + 1;
    const struct store_options later = {.now_ms = constant, .context = &later_ms};
    struct store *rival = NULL;
    struct claim claim = {.worker = "rival", .count = 100};
    struct claimed_job jobs[100];
    struct error err = {0};
    size_t count = 0;
    assert_int_equal(store_open(&rival, scene.fixture.database, &later, &err), 0);
    assert_int_equal(store_claim(rival, &claim, jobs, &count, &err), 0);
    for (size_t n = 0; n < count; n++) { /* of what waited, none of what was lost */
        assert_int_equal(jobs[n].attempt, 1);
        claimed_job_clear(&jobs[n]);
    }
    store_close(&rival);
    assert_int_equal(sql_integer(scene.fixture.database, "SELECT sum(losses) FROM job"), 0);
    assert_false(lease_is_lost(lease) || lease_is_given_back(lease));
    run(&scene, lease);
    scene_close(&scene);
}

/* What still runs when the time is over is lost to the thread that has it. */
static void running_jobs_are_given_back(void **state) {
    (void)state;
    struct scene scene;
    scene_open(&scene, 1, false);
    struct lease *lease = take(&scene);
    dispatcher_end(scene.dispatcher);
    dispatcher_give_back(scene.dispatcher);
    for (int tries = 0; !lease_is_lost(lease) && tries < 1000; tries++)
        nanosleep(&(struct timespec){.tv_nsec = 10000000}, NULL);
    assert_true(lease_is_lost(lease) && lease_is_given_back(lease));
    run(&scene, lease); /* too late */
    dispatcher_destroy(&scene.dispatcher);
    expect(&scene, 1, 0, 0);
    scene_close(&scene);
}

struct publishing {
    struct scene *scene;
    int times;
};

/* The body of the thread that publishes. */
static void *publish_all(void *context) {
    struct publishing *publishing = context;
    struct store *store = NULL;
    struct error err = {0};
    assert_int_equal(store_open(&store, publishing->scene->fixture.database, NULL, &err), 0);
    while (dispatcher_await_due(publishing->scene->dispatcher)) {
        assert_int_equal(publish_due(store, NULL, NULL, NULL, &err), 0);
        publishing->times++;
        dispatcher_published(publishing->scene->dispatcher, false);
    }
    store_close(&store);
    return NULL;
}

/* A drained queue ends the offers, once what is due is published. */
static void a_drained_queue_is_the_end(void **state) {
    (void)state;
    struct scene scene;
    struct publishing publishing = {.scene = &scene};
    struct lease *lease = NULL;
    pthread_t publisher;
    int jobs = 0;
    bool due = true;
    scene_open(&scene, 1, true);
    assert_int_equal(pthread_create(&publisher, NULL, publish_all, &publishing), 0);
    for (; dispatcher_take(scene.dispatcher, true, &lease) == OFFER_JOB; jobs++)
        run(&scene, lease);
    assert_int_equal(store_is_due(scene.fixture.store, &due, NULL), 0);
    assert_false(due);
    pthread_join(publisher, NULL);
    assert_int_equal(jobs, 48);
    assert_true(publishing.times > 0);
    expect(&scene, 0, 0, 48);
    scene_close(&scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_stock_is_given_back),
        cmocka_unit_test(no_job_is_begun_that_ends_too_late),
        cmocka_unit_test(all_leases_are_kept),
        cmocka_unit_test(running_jobs_are_given_back),
        cmocka_unit_test(a_drained_queue_is_the_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
