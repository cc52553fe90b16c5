/* Protects: on a terminal the bar of a run moves each second, to its end; a queued study never has
 * no time left; events report work that goes on while no job ends. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include <pty.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* Some seconds of one worker: few realisations, which take long. */
static const char STUDY[] =
    "{\"name\":\"slow\",\"kind\":\"statistics\",\"seed\":7,\"realisations\":20,\"surface\":{"
    "\"hurst\":0.8,\"wavelength_ratio\":64,\"length_ratio\":8,\"points_per_wavelength\":8}}";

enum { TEXT_MOST = 1 << 20 };

/* Runs the study of so many realisations on a terminal of its own; what came, and its exit status.
 */
static char *run_on_terminal(int realisations, int *status) {
    char number[40];
    int terminal = -1;
    size_t size = 0;
    char *text = calloc(1, TEXT_MOST);
    assert_non_null(text);
    snprintf(number, sizeof number, "realisations=%d", realisations);
    pid_t child = forkpty(&terminal, NULL, NULL, NULL);
    assert_true(child >= 0);
    if (child == 0) {
        execl(rugo(), "rugo", "run", "--workers", "1", "--db", "bar.db", "--set", number,
              "slow.json", (char *)NULL);
        _exit(127);
    }
    ssize_t got;
    while (size < TEXT_MOST - 1 && (got = read(terminal, text + size, TEXT_MOST - 1 - size)) > 0)
        size += (size_t)got;
    close(terminal);
    assert_int_equal(waitpid(child, status, 0), child);
    return text;
}

/* How often the bar moved, and the seconds of its own clock when it was drawn last. The text is
 * cut. */
static int count_moves(char *text, int *seconds) {
    char *rest = NULL, last[200] = "";
    int moves = 0;
    *seconds = 0;
    for (char *bar = strtok_r(text, "\r", &rest); bar != NULL; bar = strtok_r(NULL, "\r", &rest)) {
        int hours = 0, minutes = 0;
        const char *time = strstr(bar, "realisations, ");
        if (*bar != '[' || strncmp(bar, last, sizeof last - 1) == 0)
            continue;
        snprintf(last, sizeof last, "%s", bar);
        moves++;
        if (time != NULL && sscanf(time, "realisations, %d:%d:%d", &hours, &minutes, seconds) == 3)
            *seconds += 3600 * hours + 60 * minutes;
    }
    return moves;
}

/* A machine that has no time to draw it now and then moves it every other second at least; one that
 * is soon done is given more to do. */
static void the_bar_moves(void **state) {
    (void)state;
    enum { SECONDS_LEAST = 2, MOST = 20000 };
    int status = -1, seconds = 0, moves = 0;
    spit("slow.json", STUDY);
    for (int realisations = 20; seconds < SECONDS_LEAST; realisations *= 2) {
        char all[80], *text = run_on_terminal(realisations, &status);
        assert_true(realisations < MOST);
        assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
        snprintf(all, sizeof all, "%d of %d realisations", realisations, realisations);
        assert_non_null(strstr(text, "100.0 %"));
        assert_non_null(strstr(text, all));
        moves = count_moves(text, &seconds);
        free(text);
    }
    if (!(2 * moves >= seconds))
        fail_msg("%d moves in %d s", moves, seconds);
}

static void nobody_is_told_of_no_time(void **state) {
    (void)state;
    spit("slow.json", STUDY);
    assert_int_equal(
        run_rugo("submit", (const char *[]){"submit", "--db", "queue.db", "slow.json", NULL}), 0);
    assert_int_equal(
        run_rugo("status", (const char *[]){"status", "--db", "queue.db", "slow", NULL}), 0);
    assert_true(contains("status.out", "0.0 % of the work"));
    assert_true(contains("status.out", "left not known, as nobody works"));
}

/* A job that runs moves its study, though nothing of it has ended: each event has more of the work
 * done than the one before. */
static void events_tell_of_work_that_goes_on(void **state) {
    (void)state;
    static const char LONG[] =
        "{\"name\":\"long\",\"kind\":\"statistics\",\"realisations\":9,\"surface\":{\"hurst\":0.8,"
        "\"wavelength_ratio\":128,\"length_ratio\":8}}";
    char text[16384] = "";
    size_t used = 0;
    double shares[3];
    int count = 0;
    static const char JSON[] = "Content-Type: application/json\r\n";
    struct process server = {0};
    unsigned port = serve_start(&server, NULL);
    assert_int_equal(http_exchange(port, "POST", "/v1/studies", JSON, LONG, NULL), 201);
    assert_int_equal(http_exchange(port, "POST", "/v1/jobs/claim", JSON,
                                   "{\"worker\":\"w\",\"sequence\":true}", NULL),
                     200);
    int stream = http_connect(port);
    static const char REQUEST[] = "GET /v1/studies/long/events HTTP/1.1\r\nHost: localhost\r\n\r\n";
    assert_int_equal(write(stream, REQUEST, strlen(REQUEST)), strlen(REQUEST));
    while (count < 3) {
        ssize_t got = read(stream, text + used, sizeof text - 1 - used);
        assert_true(got > 0); /* the stream is not cut off before */
        text[used += (size_t)got] = '\0';
        const char *at = text;
        for (count = 0; count < 3 && (at = strstr(at, "\"share\":")) != NULL; at++)
            shares[count++] = strtod(at + 8, NULL);
    }
    close(stream);
    assert_true(shares[0] < shares[1] && shares[1] < shares[2] && shares[2] < 1);
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 15), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_bar_moves),
        cmocka_unit_test(nobody_is_told_of_no_time),
        cmocka_unit_test(events_tell_of_work_that_goes_on),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
