#include "server/command/command.h"
#include "jobs/kind.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

atomic_int stop_requested;

/* The second one ends at once: nothing is lost but the lease of a running block. */
static void on_signal(int number) {
    if (stop_requested != 0 && number == SIGINT)
        _exit(EXIT_INTERRUPTED);
    stop_requested = 1;
}

void signals_catch(void) {
    struct sigaction action = {.sa_handler = on_signal};
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
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
    if (result->error != NULL)
        fprintf(stderr, "rugo %s: no results: %s\n", command, result->error);
}

static const char *name_of(const char *path) {
    return strcmp(path, "-") == 0 ? "standard input" : path;
}

int command_fail_faults(const char *file, const struct fault_list *faults) {
    size_t kept = faults->count < FAULTS_KEPT ? faults->count : FAULTS_KEPT;
    if (faults->faults == NULL && faults->count > 0)
        fprintf(stderr, "%s: %zu faults, and no memory to tell them\n", name_of(file),
                faults->count);
    for (size_t i = 0; faults->faults != NULL && i < kept; i++) {
        const struct fault *fault = &faults->faults[i];
        const char *pointer = fault->pointer != NULL ? fault->pointer : "";
        fprintf(stderr, "%s: %s%s%s\n", name_of(file), pointer, *pointer != '\0' ? ": " : "",
                fault->detail != NULL ? fault->detail : "");
    }
    if (faults->count > kept)
        fprintf(stderr, "%s: and %zu more\n", name_of(file), faults->count - kept);
    return EXIT_USAGE;
}

int output_flush(struct error *err) {
    if (ferror(stdout) == 0 && fflush(stdout) == 0)
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

/* Reads to the end of a stream; the buffer doubles. */
static int read_stream(FILE *file, const char *path, size_t limit, char **text, size_t *size,
                       struct error *err) {
    size_t room = 65536, used = 0;
    char *buffer = malloc(room + 1);
    while (buffer != NULL && used <= limit) {
        used += fread(buffer + used, 1, room - used, file);
        if (used < room)
            break;
        room *= 2;
        char *larger = realloc(buffer, room + 1);
        if (larger == NULL)
            free(buffer);
        buffer = larger;
    }
    if (buffer == NULL)
        return error_memory(err, room, path);
    if (ferror(file) != 0 || used > limit) {
        free(buffer);
        return used > limit ? error_set(err, ERROR_INPUT, "%s: larger than %zu bytes", path, limit)
                            : error_set(err, ERROR_SYSTEM, "%s: %s", path, strerror(errno));
    }
    buffer[used] = 0;
    *text = buffer;
    *size = used;
    return 0;
}

int file_read(const char *path, size_t limit, char **text, size_t *size, struct error *err) {
    if (strcmp(path, "-") == 0)
        return read_stream(stdin, name_of(path), limit, text, size, err);
    FILE *file = fopen(path, "rb");
    if (file == NULL)
        return error_set(err, errno == ENOENT ? ERROR_INPUT : ERROR_SYSTEM, "%s: %s", path,
                         strerror(errno));
    int status = read_stream(file, path, limit, text, size, err);
    fclose(file);
    return status;
}

int study_file_read(struct study **out, const char *path, const char *const *overrides,
                    struct fault_list *faults, struct error *err) {
    char *text = NULL;
    static const char EMPTY[] = "{\"name\": \"theory\", \"kind\": \"statistics\"}";
    size_t size;
    if (path == NULL)
        return kind_read_study(out, EMPTY, sizeof EMPTY - 1, overrides, faults, err);
    int status = file_read(path, JSON_LIMITS.bytes, &text, &size, err);
    if (status != 0)
        return status;
    status = kind_read_study(out, text, size, overrides, faults, err);
    free(text);
    return status != 0 ? error_context(err, "%s", name_of(path)) : 0;
}
