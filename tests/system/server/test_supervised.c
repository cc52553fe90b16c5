/* Protects: server and workers report to systemd that they are ready, that they live and that they
 * end; a server whose writer is stuck does not say that it lives. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include <errno.h>
#include <signal.h>
#include <sqlite3.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

enum { WATCHDOG_MS = 400, PATIENCE_S = 60 };

/* A socket such as systemd's, under the name in the environment; "@" begins one that is no file. */
static int listen_as(const char *name) {
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    struct timeval limit = {.tv_sec = PATIENCE_S};
    size_t length = strlen(name);
    memcpy(address.sun_path, name, length);
    if (*name == '@')
        address.sun_path[0] = 0;
    int file = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    assert_true(file >= 0);
    setsockopt(file, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    assert_int_equal(bind(file, (struct sockaddr *)&address,
                          (socklen_t)(offsetof(struct sockaddr_un, sun_path) + length)),
                     0);
    setenv("NOTIFY_SOCKET", name, 1);
    return file;
}

/* What comes next; false after a while without anything. */
static bool hear(int file, char *text, size_t size, int flags) {
    ssize_t length = recv(file, text, size - 1, flags);
    text[length > 0 ? length : 0] = 0;
    return length > 0;
}

static void expect(int file, const char *wanted) {
    char text[200];
    do {
        if (!hear(file, text, sizeof text, 0))
            fail_msg("%s did not come", wanted);
    } while (strcmp(text, wanted) != 0);
}

static void forget(int file) {
    char text[200];
    while (hear(file, text, sizeof text, MSG_DONTWAIT))
        continue;
}

/* Waits until nothing has come for so long; how much came before. */
static unsigned await_silence(int file, long milliseconds) {
    struct timeval silence = {milliseconds / 1000, milliseconds % 1000 * 1000},
                   limit = {.tv_sec = PATIENCE_S};
    char text[200];
    unsigned count = 0;
    setsockopt(file, SOL_SOCKET, SO_RCVTIMEO, &silence, sizeof silence);
    while (count < 100 && hear(file, text, sizeof text, 0))
        count++;
    setsockopt(file, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    return count;
}

static void set_watchdog(void) {
    char microseconds[24];
    snprintf(microseconds, sizeof microseconds, "%d", 1000 * WATCHDOG_MS);
    setenv("WATCHDOG_USEC", microseconds, 1);
}

static void server_tells(void **state) {
    struct process server;
    char folder[80], name[100];
    sqlite3 *db = NULL;
    (void)state;
    assert_non_null(getcwd(folder, sizeof folder));
    snprintf(name, sizeof name, "%s/notify", folder);
    int file = listen_as(name);
    set_watchdog();
    serve_start(&server, (const char *[]){"--db", "told.db", NULL});
    expect(file, "READY=1");
    expect(file, "WATCHDOG=1");
    expect(file, "WATCHDOG=1");
    /* Nobody can write: the writer waits. What it said before may come yet, and once more what it
     * was about to say. */
    assert_int_equal(sqlite3_open("told.db", &db), SQLITE_OK);
    sqlite3_busy_timeout(db, 20000);
    assert_int_equal(sqlite3_exec(db, "BEGIN IMMEDIATE", NULL, NULL, NULL), SQLITE_OK);
    forget(file);
    assert_in_range(await_silence(file, 4 * WATCHDOG_MS), 0, 2);
    assert_int_equal(sqlite3_exec(db, "ROLLBACK", NULL, NULL, NULL), SQLITE_OK);
    sqlite3_close(db);
    expect(file, "WATCHDOG=1");
    process_kill(&server, SIGTERM);
    expect(file, "STOPPING=1");
    assert_int_equal(process_wait(&server, 20), 0);
    close(file);
    unlink(name);
}

static void worker_tells(void **state) {
    struct process worker;
    (void)state;
    char name[64];
    snprintf(name, sizeof name, "@rugo-test-%d", (int)getpid());
    int file = listen_as(name);
    set_watchdog();
    process_start(&worker, "work", (const char *[]){"work", "--db", "told.db", NULL});
    expect(file, "READY=1");
    expect(file, "WATCHDOG=1");
    expect(file, "WATCHDOG=1");
    process_kill(&worker, SIGTERM);
    expect(file, "STOPPING=1");
    assert_int_equal(process_wait(&worker, 20), 0);
    close(file);
}

/* Of another process, or nonsense: nothing is sent, and nothing else happens. */
static void others_are_not_told(void **state) {
    struct process server;
    char text[200];
    (void)state;
    char name[64];
    snprintf(name, sizeof name, "@rugo-test-%d", (int)getpid());
    int file = listen_as(name);
    setenv("WATCHDOG_PID", "1", 1);
    serve_start(&server, (const char *[]){"--db", "told.db", NULL});
    expect(file, "READY=1");
    sleep_ms(2 * WATCHDOG_MS);
    assert_false(hear(file, text, sizeof text, MSG_DONTWAIT));
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 20), 0);
    unsetenv("WATCHDOG_PID");
    setenv("NOTIFY_SOCKET", "nowhere", 1);
    setenv("WATCHDOG_USEC", "never", 1);
    serve_start(&server, (const char *[]){"--db", "told.db", NULL});
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 20), 0);
    close(file);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(server_tells),
        cmocka_unit_test(worker_tells),
        cmocka_unit_test(others_are_not_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
