/* Protects: what a peer sent is read by a process that has so much memory and time and no more,
 * that ends when it is not wanted, and whose end, words and output are reported as they were. The
 * process is this program again: its first argument says what it does. */
#include "server/http/route/own_process.h"
#include "tests/support/check.h"
#include "worker/clock.h"
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static const char *const SELF = "test_own_process";

/* --- the other side --- */

static int echo(void) {
    char part[4096];
    for (size_t count; (count = fread(part, 1, sizeof part, stdin)) > 0;)
        fwrite(part, 1, count, stdout);
    fputs("that was all\n", stderr);
    return 3;
}

static int take_memory(void) {
    char *block = NULL;
    for (size_t size = 16 << 20; size <= (size_t)1 << 30; size += 16 << 20) {
        char *larger = realloc(block, size);
        if (larger == NULL) {
            free(block);
            fputs("no memory", stderr);
            return 1;
        }
        block = larger;
        memset(block, 1, size);
    }
    free(block);
    return 0;
}

static int act(const char *word) {
    volatile bool on = true;
    if (strcmp(word, "echo") == 0)
        return echo();
    if (strcmp(word, "memory") == 0)
        return take_memory();
    if (strcmp(word, "print") == 0)
        while (puts("much") >= 0)
            continue;
    if (strcmp(word, "break") == 0)
        raise(SIGSEGV);
    if (strcmp(word, "hide") == 0) {
        (void)close(STDOUT_FILENO);
        (void)close(STDERR_FILENO);
        (void)sleep(60);
    }
    if (strcmp(word, "sleep") == 0)
        (void)sleep(60);
    while (strcmp(word, "spin") == 0 && on)
        continue;
    return 0;
}

/* --- this side --- */

static int never(void *context) {
    (void)context;
    return 0;
}

static int after_a_while(void *context) {
    return clock_ms() > *(const int64_t *)context;
}

static struct own_process_result run_with(const char *word, int (*stop)(void *), void *context) {
    const char *const arguments[] = {SELF, word, NULL};
    static char input[300000];
    memset(input, 'a', sizeof input);
    const struct own_process process = {.arguments = arguments,
                                        .input = input,
                                        .input_size = sizeof input,
                                        .memory_bytes = 256 << 20,
                                        .cpu_seconds = strcmp(word, "spin") == 0 ? 1 : 20,
                                        .wait_seconds = 50,
                                        .output_most = 400000,
                                        .stop = stop,
                                        .context = context};
    struct own_process_result result;
    struct error err = {0};
    assert_int_equal(own_process_run(&process, &result, &err), 0);
    assert_int_equal(waitpid(-1, NULL, WNOHANG), -1); /* nothing is left of it */
    assert_int_equal(errno, ECHILD);
    return result;
}

static enum own_process_end end_of(const char *word) {
    struct own_process_result result = run_with(word, never, NULL);
    free(result.output);
    return result.end;
}

static void bytes_words_and_status_come_back(void **state) {
    (void)state;
    struct own_process_result result = run_with("echo", never, NULL);
    assert_int_equal(result.end, OWN_PROCESS_DONE);
    assert_int_equal(result.status, 3);
    assert_int_equal(result.output_size, 300000);
    assert_int_equal(strspn(result.output, "a"), 300000);
    assert_string_equal(result.said, "that was all");
    free(result.output);
}

static void memory_is_bounded(void **state) {
    (void)state;
#ifdef RUGO_SANITIZED
    print_message("SKIP: sanitizers take any address space\n");
    skip();
#else
    struct own_process_result result = run_with("memory", never, NULL);
    assert_int_equal(result.end, OWN_PROCESS_DONE);
    assert_int_equal(result.status, 1);
    assert_string_equal(result.said, "no memory");
    free(result.output);
#endif
}

static void time_and_output_are_bounded(void **state) {
    (void)state;
    assert_int_equal(end_of("spin"), OWN_PROCESS_LATE);
    assert_int_equal(end_of("print"), OWN_PROCESS_LARGE);
    int64_t begin = clock_ms();
    assert_int_equal(end_of("hide"), OWN_PROCESS_LATE); /* it closed its streams, and stayed */
    assert_true(clock_ms() - begin < 40000);            /* it would sleep for a minute */
}

static void it_ends_when_it_is_not_wanted(void **state) {
    (void)state;
    int64_t begin = clock_ms(), until = begin + 300;
    struct own_process_result result = run_with("sleep", after_a_while, &until);
    assert_int_equal(result.end, OWN_PROCESS_STOPPED);
    assert_true(clock_ms() - begin < 40000);
    free(result.output);
}

static void a_breakdown_is_told(void **state) {
    (void)state;
#ifdef RUGO_SANITIZED
    print_message("SKIP: sanitizers catch the signal\n");
    skip();
#else
    assert_int_equal(end_of("break"), OWN_PROCESS_BROKEN);
#endif
}

int main(int argc, char **argv) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bytes_words_and_status_come_back),
        cmocka_unit_test(memory_is_bounded),
        cmocka_unit_test(time_and_output_are_bounded),
        cmocka_unit_test(it_ends_when_it_is_not_wanted),
        cmocka_unit_test(a_breakdown_is_told),
    };
    if (argc > 1 && strcmp(argv[0], SELF) == 0)
        return act(argv[1]);
    signal(SIGPIPE, SIG_IGN); /* as the program does */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
