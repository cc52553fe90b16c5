#include "server/command/command.h"
#include "core/file/plain_text.h"
#include "jobs/kind.h"
#include "server/command/input_file.h"
#include "server/command/map/like_study.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

atomic_int stop_requested;
static atomic_llong stop_ms; /* when it was set, by clock_of_signals */

static long long clock_of_signals(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (long long)now.tv_sec * 1000 + now.tv_nsec / 1000000;
}

/* The second one ends at once: nothing is lost but the leases of running jobs. Those that come
 * together are one: timeout(1) sends its signal to the program, and to the group it is in. SIGTERM
 * is no key that is pressed again: Slurm sends it to a worker and to the script above, which hands
 * it on. */
static void on_signal(int number) {
    enum { TOGETHER_MS = 100, TERM_TOGETHER_MS = 2000 };
    long long together_ms = number == SIGTERM ? TERM_TOGETHER_MS : TOGETHER_MS;
    if (stop_requested == 0)
        stop_ms = clock_of_signals();
    else if (clock_of_signals() - stop_ms > together_ms)
        _exit(EXIT_INTERRUPTED);
    stop_requested = 1;
}

bool stop_is_requested(void *context) {
    (void)context;
    return atomic_load(&stop_requested) != 0;
}

void signals_catch(void) {
    struct sigaction action = {.sa_handler = on_signal};
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    /* A terminal that closes; under nohup(1) it may. */
    struct sigaction now;
    if (sigaction(SIGHUP, NULL, &now) == 0 && now.sa_handler != SIG_IGN)
        sigaction(SIGHUP, &action, NULL);
}

int command_fail(const char *command, const struct error *err) {
    if (err->code == ERROR_STOPPED) {
        fprintf(stderr, "rugo %s: interrupted; nothing is lost, the same command goes on\n",
                command);
        return EXIT_INTERRUPTED;
    }
    fprintf(stderr, "rugo %s: %s\n", command, err->text);
    return err->code == ERROR_INPUT ? EXIT_USAGE : EXIT_FAILED;
}

void command_warn_missing(const char *command, const struct case_result *result) {
    if (result->error == NULL)
        return;
    fprintf(stderr, "rugo %s: no results: ", command);
    text_print_plain(stderr, result->error);
    fputc('\n', stderr);
}

int command_fail_faults(const char *file, const struct fault_list *faults) {
    size_t kept = faults->count < FAULTS_KEPT ? faults->count : FAULTS_KEPT;
    if (faults->faults == NULL && faults->count > 0)
        fprintf(stderr, "%s: %zu faults, and no memory to list them\n", input_file_name(file),
                faults->count);
    for (size_t i = 0; faults->faults != NULL && i < kept; i++) {
        const struct fault *fault = &faults->faults[i];
        const char *pointer = fault->pointer != NULL ? fault->pointer : "";
        fprintf(stderr, "%s: ", input_file_name(file));
        text_print_plain(stderr, pointer);
        fputs(*pointer != '\0' ? ": " : "", stderr);
        text_print_plain(stderr, fault->detail != NULL ? fault->detail : "");
        fputc('\n', stderr);
    }
    if (faults->count > kept)
        fprintf(stderr, "%s: and %zu more\n", input_file_name(file), faults->count - kept);
    return EXIT_USAGE;
}

int command_end(const char *command, int status, const char *file, const struct fault_list *faults,
                const struct error *err) {
    if (status == 0)
        return EXIT_DONE;
    return faults->count > 0 ? command_fail_faults(file, faults) : command_fail(command, err);
}

int output_flush(struct error *err) {
    errno = 0; /* an earlier write may have failed, whose errno is gone */
    bool flushed = fflush(stdout) == 0;
    if (flushed && ferror(stdout) == 0)
        return 0;
    return error_set(err, ERROR_SYSTEM, "cannot write the output: %s",
                     strerror(errno != 0 ? errno : EIO));
}

int output_document(const cJSON *document, struct error *err) {
    char *text = document != NULL ? json_print(document) : NULL;
    if (text == NULL)
        return error_memory(err, 0, "a document");
    puts(text);
    int status = output_flush(err);
    free(text);
    return status;
}

int study_file_read(struct study **out, const char *path, const char *const *overrides,
                    struct fault_list *faults, struct error *err) {
    char *text = NULL;
    static const char EMPTY[] = "{\"name\": \"theory\", \"kind\": \"statistics\"}";
    size_t size;
    if (path == NULL)
        return kind_read_study(out, EMPTY, sizeof EMPTY - 1, overrides, faults, err);
    int status = input_file_read(path, JSON_LIMITS.bytes, &text, &size, err);
    if (status != 0)
        return status;
    bool fitted;
    status = like_study_fit(&text, &size, path, overrides, &fitted, err);
    if (status == 0)
        status = kind_read_study(out, text, size, fitted ? NULL : overrides, faults, err);
    free(text);
    return status != 0 ? error_context(err, "%s", input_file_name(path)) : 0;
}
