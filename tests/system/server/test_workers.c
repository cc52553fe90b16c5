/* Workers and their server: one connection a process, claims that wait, jobs that reach nobody,
 * and what is kept of a job that is stopped. */
#include "tests/support/check.h"
#include "tests/support/effort.h"
#include "tests/support/process.h"
#include "tests/support/sql.h"
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define SURFACE                                                                                    \
    "\"surface\":{\"dimension\":2,\"hurst\":0.5,\"wavelength_ratio\":8,\"length_ratio\":4,"        \
    "\"points_per_wavelength\":8}"
/* Many seconds of work. */
static const char LONG[] = "{\"name\":\"long\",\"kind\":\"statistics\",\"seed\":7,"
                           "\"realisations\":1000000," SURFACE "}";
static const char ONE_JOB[] = "{\"name\":\"one\",\"kind\":\"statistics\",\"seed\":7,"
                              "\"realisations\":1," SURFACE "}";
/* About two seconds of one processor; under sanitizers fewer realisations take longer. */
static const char SOME[] = "{\"name\":\"some\",\"kind\":\"statistics\",\"seed\":7,"
                           "\"realisations\":%u," SURFACE "}";

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static void submit(unsigned port, const char *study) {
    assert_int_equal(http_exchange(port, "POST", "/v1/studies",
                                   "Content-Type: application/json\r\n", study, NULL),
                     201);
}

/* The value behind a key in the answer to a GET. */
static double figure(unsigned port, const char *path, const char *key) {
    char *answer = NULL;
    assert_int_equal(http_exchange(port, "GET", path, "", NULL, &answer), 200);
    const char *at = strstr(answer, key);
    assert_non_null(at);
    double value = strtod(at + strlen(key), NULL);
    free(answer);
    return value;
}

/* Connections that are established to this port, of all processes here. */
static unsigned connections_to(unsigned port) {
    unsigned count = 0;
    char line[512], wanted[16];
    FILE *file = fopen("/proc/net/tcp", "r");
    assert_non_null(file);
    snprintf(wanted, sizeof wanted, "0100007F:%04X", port);
    while (fgets(line, sizeof line, file) != NULL) {
        char remote[64] = "", state[8] = "";
        if (sscanf(line, "%*s %*s %63s %7s", remote, state) == 2)
            count += strcmp(remote, wanted) == 0 && strcmp(state, "01") == 0;
    }
    fclose(file);
    return count;
}

/* The system's list is no picture of one moment, so that a connection may stand in it twice: one
 * that is kept beside another is there each time. */
static bool has_one_connection(unsigned port) {
    enum { LOOKS = 10 };
    for (int look = 0; look < LOOKS; look++, sleep_ms(20))
        if (connections_to(port) <= 1)
            return true;
    return false;
}

#define RUNNING " FROM job WHERE state = 'running'"

/* Four threads at a server that takes four connections, with leases that are renewed while they
 * work: nothing is lost, as all goes through one connection; and asked to end, they keep what they
 * have done. */
static void one_connection_keeps_all_leases(void **state) {
    (void)state;
    struct process server, worker;
    char url[64];
    unsigned port = serve_start(
        &server, (const char *[]){"--db", "one.db", "--connections", "4", "--lease", "9", NULL});
    snprintf(url, sizeof url, "http://127.0.0.1:%u", port);
    submit(port, LONG);
    process_start(&worker, "worker",
                  (const char *[]){"work", "--server", url, "--workers", "4", NULL});
    for (int tries = 0; tries < 600 && figure(port, "/v1/studies?limit=1", "\"running\":") < 4;
         tries++)
        sleep_ms(100);
    assert_true(figure(port, "/v1/studies?limit=1", "\"running\":") >= 4);
    int64_t first = sql_integer("one.db", "SELECT max(lease_until)" RUNNING);
    for (int tries = 0; sql_integer("one.db", "SELECT min(lease_until)" RUNNING) <= first;
         tries++) {
        assert_true(tries < 1200);
        sleep_ms(50);
        assert_true(has_one_connection(port));
    }
    process_kill(&worker, SIGTERM);
    assert_int_equal(process_wait(&worker, 30), 0);
    char *log = slurp("worker.err");
    assert_null(strstr(log, "level=warning"));
    assert_null(strstr(log, "attempt=2"));
    assert_non_null(strstr(log, "the others are handed back"));
    free(log);
    assert_true(figure(port, "/v1/studies?limit=1", "\"running\":") == 0);
    assert_true(
        figure(port, "/v1/studies?limit=1", "\"realisations\":{\"total\":1000000,\"done\":") > 0);
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 20), 0);
}

/* A server that is asked to end lets its own workers hand in what they have first: no job stays
 * under a lease, none counts as lost, and what is done is kept. */
static void own_workers_hand_in_at_the_end(void **state) {
    (void)state;
    static const int SIGNALS[] = {SIGTERM, SIGINT};
    for (size_t s = 0; s < sizeof SIGNALS / sizeof *SIGNALS; s++) {
        struct process server;
        unsigned port =
            serve_start(&server, (const char *[]){"--db", "own.db", "--workers", "2", NULL});
        if (s == 0)
            submit(port, LONG);
        for (int tries = 0; figure(port, "/v1/studies?limit=1", "\"running\":") < 2; tries++) {
            assert_true(tries < 1200);
            sleep_ms(50);
        }
        int64_t done = sql_integer("own.db", "SELECT count(*) FROM result");
        process_kill(&server, SIGNALS[s]);
        assert_int_equal(process_wait(&server, 60), 0);
        assert_int_equal(sql_integer("own.db", "SELECT count(*)" RUNNING), 0);
        assert_int_equal(sql_integer("own.db", "SELECT max(losses) FROM job"), 0);
        assert_true(sql_integer("own.db", "SELECT count(*) FROM result") > done);
    }
}

#define CHANGES "\nrugo_changes_total "
static const char CLAIM[] = "{\"worker\":\"w\",\"sequence\":true}";

/* Sends a claim that waits; the connection. */
static int claim_begin(unsigned port, const char *worker, int wait_s) {
    char body[128], text[512];
    snprintf(body, sizeof body, "{\"worker\":\"%s\",\"sequence\":true}", worker);
    int size = snprintf(text, sizeof text,
                        "POST /v1/jobs/claim HTTP/1.1\r\nHost: localhost\r\nPrefer: wait=%d\r\n"
                        "Content-Type: application/json\r\nContent-Length: %zu\r\n\r\n%s",
                        wait_s, strlen(body), body);
    int peer = http_connect(port);
    assert_true(peer >= 0);
    assert_true(send(peer, text, (size_t)size, MSG_NOSIGNAL) == size);
    return peer;
}

/* How many of the connections have an answer with jobs. */
static unsigned answered(const int *peers, size_t count) {
    char text[2048];
    unsigned found = 0;
    for (size_t n = 0; n < count; n++) {
        ssize_t size = recv(peers[n], text, sizeof text - 1, MSG_DONTWAIT | MSG_PEEK);
        text[size > 0 ? size : 0] = '\0';
        found += strstr(text, "HTTP/1.1 200") != NULL && strstr(text, "Preference-Applied: wait=");
    }
    return found;
}

/* Waits until the server has made so many changes: a claim is one, also where there is no job. */
static void wait_for_changes(unsigned port, double count) {
    for (int tries = 0; figure(port, "/metrics", CHANGES) < count; tries++) {
        assert_true(tries < 1500);
        sleep_ms(20);
    }
}

/* Many wait; one job wakes one of them, and costs a few claims; the others go at the end at once.
 */
static void claims_wait_for_jobs(void **state) {
    (void)state;
    enum { PEERS = 100 };
    int peers[PEERS];
    struct process server;
    unsigned port = serve_start(&server, (const char *[]){"--db", "poll.db", NULL});
    double start = now();
    assert_int_equal(http_exchange(port, "POST", "/v1/jobs/claim",
                                   "Prefer: wait=1\r\nContent-Type: application/json\r\n", CLAIM,
                                   NULL),
                     204);
    assert_true(now() - start >= 0.99);
    double before = figure(port, "/metrics", CHANGES);
    for (size_t n = 0; n < PEERS; n++)
        peers[n] = claim_begin(port, "w", 30);
    wait_for_changes(port, before + PEERS);
    sleep_ms(500);
    assert_int_equal(answered(peers, PEERS), 0);
    before = figure(port, "/metrics", CHANGES);
    submit(port, ONE_JOB);
    for (int tries = 0; answered(peers, PEERS) == 0; tries++) {
        assert_true(tries < 1000);
        sleep_ms(20);
    }
    sleep_ms(500);
    assert_int_equal(answered(peers, PEERS), 1);
    assert_true(2 * (figure(port, "/metrics", CHANGES) - before) < PEERS);
    start = now();
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 20), 0);
    assert_true(now() - start < 10); /* they would wait for 30 s */
    for (size_t n = 0; n < PEERS; n++)
        close(peers[n]);
}

/* Peers claim, and go before the server hears of it: who goes later may be handed a job. */
static void claim_and_go(const struct process *server, unsigned port) {
    assert_int_equal(kill(server->pid, SIGSTOP), 0);
    for (int n = 0; n < 20; n++)
        close(claim_begin(port, "gone", n % 2 == 0 ? 20 : 0));
    assert_int_equal(kill(server->pid, SIGCONT), 0);
}

/* Jobs go to those who are there to take them. */
static void who_has_gone_gets_no_job(void **state) {
    (void)state;
    struct process server;
    char *answer = NULL;
    unsigned port = serve_start(&server, (const char *[]){"--db", "gone.db", NULL});
    claim_and_go(&server, port);
    int later = claim_begin(port, "gone", 20);
    sleep_ms(300);
    close(later);
    submit(port, ONE_JOB);
    claim_and_go(&server, port);
    sleep_ms(300);
    assert_int_equal(http_exchange(port, "POST", "/v1/jobs/claim",
                                   "Content-Type: application/json\r\n", CLAIM, &answer),
                     200);
    assert_non_null(strstr(answer, "\"attempt\":1"));
    free(answer);
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 20), 0);
}

/* A program whose results of statistics have another form gets none of its jobs, and learns why. */
static void other_forms_get_no_jobs(void **state) {
    (void)state;
    struct process server;
    char *answer = NULL;
    unsigned port = serve_start(&server, (const char *[]){"--db", "forms.db", NULL});
    submit(port, ONE_JOB);
    static const char BODY[] = "{\"worker\":\"w\",\"sequence\":true,\"kinds\":[\"statistics\"],"
                               "\"forms\":{\"statistics\":1}}";
    char request[512];
    int size = snprintf(request, sizeof request,
                        "POST /v1/jobs/claim HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n"
                        "Content-Type: application/json\r\nContent-Length: %zu\r\n\r\n%s",
                        strlen(BODY), BODY);
    answer = http_raw(port, request, (size_t)size);
    assert_non_null(strstr(answer, "HTTP/1.1 204"));
    assert_non_null(strstr(answer, "Rugo-Other-Forms: statistics\r\n"));
    free(answer);
    assert_int_equal(http_exchange(port, "POST", "/v1/jobs/claim",
                                   "Content-Type: application/json\r\n", CLAIM, NULL),
                     200);
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 20), 0);
}

static void names_are_plain(void **state) {
    (void)state;
    struct process server;
    char *answer = NULL;
    unsigned port = serve_start(&server, (const char *[]){"--db", "names.db", NULL});
    assert_int_equal(http_exchange(port, "POST", "/v1/jobs/claim",
                                   "Content-Type: application/json\r\n",
                                   "{\"worker\":\"a\\u001b[31m\"}", &answer),
                     422);
    assert_non_null(strstr(answer, "control characters"));
    free(answer);
    assert_int_equal(run_rugo("name", (const char *[]){"work", "--server", "http://127.0.0.1:1",
                                                       "--name", "a\x1b[31m", NULL}),
                     2);
    assert_true(contains("name.err", "control character"));
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 20), 0);
}

/* What stands behind the lines of a document that say who computed it. */
static const char *rows(const char *text) {
    while (text != NULL && *text == '#')
        text = strchr(text, '\n') != NULL ? strchr(text, '\n') + 1 : NULL;
    return text;
}

/* Until a run has a job, or has ended. */
static void wait_until_at_work(const char *database, const struct process *run) {
    static const char JOBS[] = "SELECT count(*) FROM job WHERE state = 'running'";
    siginfo_t end = {0};
    int64_t jobs = 0;
    for (int tries = 0; jobs == 0 && end.si_pid == 0; tries++) {
        sqlite3 *db = NULL;
        sqlite3_stmt *row = NULL;
        assert_true(tries < 6000);
        sleep_ms(10);
        if (sqlite3_open_v2(database, &db, SQLITE_OPEN_READONLY, NULL) == SQLITE_OK &&
            sqlite3_prepare_v2(db, JOBS, -1, &row, NULL) == SQLITE_OK &&
            sqlite3_step(row) == SQLITE_ROW)
            jobs = sqlite3_column_int64(row, 0);
        sqlite3_finalize(row);
        sqlite3_close(db);
        assert_int_equal(waitid(P_PID, (id_t)run->pid, &end, WEXITED | WNOHANG | WNOWAIT), 0);
    }
}

/* A run that is interrupted again and again has the curves of one that was not. */
static void interrupted_runs_keep_realisations(void **state) {
    (void)state;
    struct process process;
    char study[512], total[64];
    const unsigned realisations = 4000 / (unsigned)case_step();
    snprintf(study, sizeof study, SOME, realisations);
    snprintf(total, sizeof total, "\"realisations\":{\"total\":%u,\"done\":", realisations);
    spit("some.json", study);
    const char *const arguments[] = {"run", "--db", "cut.db", "some.json", NULL};
    double done = 0;
    for (int cut = 0; cut < 2; cut++) {
        process_start(&process, "cut", arguments);
        wait_until_at_work("cut.db", &process);
        sleep_ms(500);
        process_kill(&process, SIGINT);
        if (process_wait(&process, 30) == 0)
            break; /* a fast machine: it was done */
        assert_int_equal(run_rugo("status", (const char *[]){"status", "--db", "cut.db", "--format",
                                                             "json", "some", NULL}),
                         0);
        char *status = slurp("status.out");
        const char *at = strstr(status, total);
        assert_non_null(at);
        double more = strtod(strstr(at, "\"done\":") + strlen("\"done\":"), NULL);
        assert_true(more > done);
        done = more;
        free(status);
    }
    assert_int_equal(run_rugo("cut", arguments), 0);
    assert_int_equal(
        run_rugo("whole", (const char *[]){"run", "--db", "whole.db", "some.json", NULL}), 0);
    assert_int_equal(run_rugo("cut", (const char *[]){"curves", "--db", "cut.db", "some",
                                                      "--format", "csv", NULL}),
                     0);
    assert_int_equal(run_rugo("whole", (const char *[]){"curves", "--db", "whole.db", "some",
                                                        "--format", "csv", NULL}),
                     0);
    char *cut = slurp("cut.out"), *whole = slurp("whole.out");
    assert_non_null(rows(whole));
    assert_true(strlen(rows(whole)) > 1000);
    assert_string_equal(rows(cut), rows(whole));
    free(cut);
    free(whole);
}

/* Realisations that take long enough for a second signal to come while one runs. */
static const char SLOW[] =
    "{\"name\":\"slow\",\"kind\":\"statistics\",\"seed\":7,\"realisations\":100,"
    "\"surface\":{\"dimension\":2,\"hurst\":0.5,\"wavelength_ratio\":64,\"length_ratio\":4,"
    "\"points_per_wavelength\":8}}";

/* SIGTERM that comes twice does not cut handing in short. So it comes under Slurm: to a worker, and
 * by the script above it. */
static void a_worker_that_is_ended_twice_hands_in(void **state) {
    (void)state;
    struct process worker;
    spit("slow.json", SLOW);
    assert_int_equal(
        run_rugo("slow", (const char *[]){"submit", "--db", "slow.db", "slow.json", NULL}), 0);
    process_start(&worker, "slow",
                  (const char *[]){"work", "--db", "slow.db", "--workers", "2", NULL});
    wait_until_at_work("slow.db", &worker);
    process_kill(&worker, SIGTERM);
    sleep_ms(200);
    process_kill(&worker, SIGTERM);
    assert_int_equal(process_wait(&worker, 60), 0);
    assert_int_equal(sql_integer("slow.db", "SELECT count(*)" RUNNING), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(own_workers_hand_in_at_the_end),
        cmocka_unit_test(a_worker_that_is_ended_twice_hands_in),
        cmocka_unit_test(one_connection_keeps_all_leases),
        cmocka_unit_test(claims_wait_for_jobs),
        cmocka_unit_test(who_has_gone_gets_no_job),
        cmocka_unit_test(other_forms_get_no_jobs),
        cmocka_unit_test(names_are_plain),
        cmocka_unit_test(interrupted_runs_keep_realisations),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
