/* Protects: a command whose answer is lost does what it was asked once: it asks again with the same
 * key while there is time, and says how to find out when there is none left. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include "tests/support/small_studies.h"
#include <arpa/inet.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static struct process server;
static unsigned port;

static int set_up(void **state) {
    (void)state;
    spit("one.json", ONE_CASE);
    port = serve_start(&server, (const char *[]){"--db", "lost.db", NULL});
    return 0;
}

static int tear_down(void **state) {
    (void)state;
    process_kill(&server, SIGTERM);
    return process_wait(&server, 15);
}

/* How many studies the server has. */
static size_t count_studies(void) {
    char *answer = NULL;
    size_t count = 0;
    assert_int_equal(http_exchange(port, "GET", "/v1/studies", NULL, NULL, &answer), 200);
    for (const char *at = answer; (at = strstr(at, "\"kind\":")) != NULL; at++)
        count++;
    free(answer);
    return count;
}

/* --- a connection to the server that loses answers --- */

enum { MESSAGE_MOST = 1 << 16 };

/* Reads a message with its body, or to the end. */
static size_t read_message(int connection, char *text) {
    size_t used = 0;
    for (ssize_t part; (part = recv(connection, text + used, MESSAGE_MOST - 1 - used, 0)) > 0;) {
        used += (size_t)part;
        text[used] = '\0';
        const char *end = strstr(text, "\r\n\r\n"), *length = strcasestr(text, "content-length:");
        size_t body = length != NULL && length < end ? strtoul(length + 15, NULL, 10) : 0;
        if (end != NULL && used >= (size_t)(end + 4 - text) + body)
            break;
    }
    return used;
}

/* Hands each request on, and every other answer to one that changes something to nobody. */
static void lose_answers(int listening) {
    static char text[MESSAGE_MOST];
    for (unsigned changes = 0;;) {
        int client = accept(listening, NULL, NULL);
        size_t size = client >= 0 ? read_message(client, text) : 0;
        if (size == 0) {
            close(client);
            continue;
        }
        bool lost = strncmp(text, "GET", 3) != 0 && changes++ % 2 == 0;
        int onward = http_connect(port);
        (void)!write(onward, text, size);
        size = read_message(onward, text);
        if (!lost)
            (void)!write(client, text, size);
        close(onward);
        close(client);
    }
}

static pid_t start_loser(char url[64]) {
    struct sockaddr_in address = {.sin_family = AF_INET};
    socklen_t size = sizeof address;
    int listening = socket(AF_INET, SOCK_STREAM, 0);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    assert_int_equal(bind(listening, (struct sockaddr *)&address, sizeof address), 0);
    assert_int_equal(listen(listening, 8), 0);
    assert_int_equal(getsockname(listening, (struct sockaddr *)&address, &size), 0);
    snprintf(url, 64, "http://127.0.0.1:%u", ntohs(address.sin_port));
    pid_t loser = fork();
    assert_true(loser >= 0);
    if (loser == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        lose_answers(listening);
    }
    close(listening);
    return loser;
}

static char *read_line(const char *path) {
    char *text = slurp(path);
    text[strcspn(text, "\n")] = '\0';
    return text;
}

static void a_lost_answer_is_asked_for_again(void **state) {
    (void)state;
    char url[64];
    pid_t loser = start_loser(url);
    size_t before = count_studies();
    assert_int_equal(
        run_rugo("lost", (const char *[]){"submit", "--server", url, "one.json", NULL}), 0);
    assert_int_equal(count_studies(), before + 1);
    char *id = read_line("lost.out");
    /* each is done once, and found done by the request that is sent again */
    static const char *const CHANGES[] = {"cancel", "retry", "cancel", "delete"};
    for (size_t c = 0; c < sizeof CHANGES / sizeof *CHANGES; c++)
        assert_int_equal(run_rugo("lost", (const char *[]){CHANGES[c], "--server", url, id, NULL}),
                         0);
    assert_int_equal(count_studies(), before);
    /* what was refused stays refused */
    assert_int_equal(run_rugo("lost", (const char *[]){"cancel", "--server", url, id, NULL}), 1);
    free(id);
    kill(loser, SIGKILL);
    waitpid(loser, NULL, 0);
}

/* A server that answers later than the command waits. */
static void a_late_answer_doubles_nothing(void **state) {
    (void)state;
    char url[64], key[40] = "";
    snprintf(url, sizeof url, "http://127.0.0.1:%u", port);
    size_t before = count_studies();
    process_kill(&server, SIGSTOP);
    assert_int_equal(run_rugo("late", (const char *[]){"submit", "--server", url, "--timeout", "3",
                                                       "one.json", NULL}),
                     1);
    process_kill(&server, SIGCONT);
    char *told = slurp("late.err");
    const char *at = strstr(told, "--key ");
    assert_true(strstr(told, "may have been queued") != NULL && at != NULL);
    assert_int_equal(sscanf(at, "--key %39s", key), 1);
    free(told);
    for (int again = 0; again < 2; again++) {
        assert_int_equal(run_rugo("late", (const char *[]){"submit", "--server", url, "--key", key,
                                                           "one.json", NULL}),
                         0);
        assert_int_equal(count_studies(), before + 1);
    }
    /* without the key it is another study, as ever */
    assert_int_equal(
        run_rugo("late", (const char *[]){"submit", "--server", url, "one.json", NULL}), 0);
    assert_int_equal(count_studies(), before + 2);
    assert_int_equal(run_rugo("late", (const char *[]){"submit", "--server", url, "--key", "a b",
                                                       "one.json", NULL}),
                     2);
}

/* Nothing was sent to a server that is not there: that is reported at once. */
static void a_server_that_is_away_is_told_at_once(void **state) {
    enum { AT_ONCE_S = 20 }; /* lost answers are asked for again for 30 s */
    (void)state;
    time_t begin = time(NULL);
    assert_int_equal(run_rugo("away", (const char *[]){"submit", "--server", "http://127.0.0.1:1",
                                                       "one.json", NULL}),
                     1);
    assert_true(time(NULL) - begin < AT_ONCE_S);
    assert_false(contains("away.err", "may have been"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_lost_answer_is_asked_for_again),
        cmocka_unit_test(a_late_answer_doubles_nothing),
        cmocka_unit_test(a_server_that_is_away_is_told_at_once),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
