#include "server/command/tool.h"
#include "core/file/whole_file.h"
#include "server/child.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

enum { OUTPUT_MOST = 1 << 24 };

/* Reads what was written into a file of tool_file; the caller frees. */
static int read_back(FILE *file, char **text, struct error *err) {
    size_t size = 0;
    int number = fileno(file);
    return lseek(number, 0, SEEK_SET) == 0
               ? whole_file_take(number, "what a program printed", OUTPUT_MOST, text, &size, err)
               : error_set(err, ERROR_SYSTEM, "a file in memory: %s", strerror(errno));
}

/* What a program said that failed: its last 300 bytes, in one line. */
static int tell_failure(const char *program, int state, FILE *said, struct error *err) {
    enum { LAST = 300 };
    char *text = NULL;
    (void)read_back(said, &text, NULL);
    size_t length = text != NULL ? strlen(text) : 0;
    char *last = text != NULL && length > LAST ? text + length - LAST : text;
    while (length > 0 && text[length - 1] == '\n')
        text[--length] = '\0';
    for (char *c = last; c != NULL && *c != '\0'; c++)
        if ((unsigned char)*c < ' ' || *c == 0x7f)
            *c = ' ';
    int status = WIFEXITED(state) ? error_set(err, ERROR_SYSTEM, "%s ended with status %d: %s",
                                              program, WEXITSTATUS(state), last != NULL ? last : "")
                                  : error_set(err, ERROR_SYSTEM, "%s ended by signal %d", program,
                                              WTERMSIG(state));
    free(text);
    return status;
}

static int run_with(const char *const *arguments, const int files[3], FILE *said,
                    struct error *err) {
    pid_t child = 0;
    int state = 0, failure = child_start(arguments[0], arguments, files, &child);
    if (failure == ENOENT)
        return error_set(err, ERROR_SYSTEM, "there is no program %s in PATH", arguments[0]);
    if (failure == 0)
        failure = child_wait(child, &state);
    if (failure != 0)
        return error_set(err, ERROR_SYSTEM, "%s: %s", arguments[0], strerror(failure));
    return WIFEXITED(state) && WEXITSTATUS(state) == 0
               ? 0
               : tell_failure(arguments[0], state, said, err);
}

FILE *tool_file(struct error *err) {
    int number = memfd_create("rugo", MFD_CLOEXEC);
    FILE *file = number < 0 ? NULL : fdopen(number, "w+b");
    if (file == NULL) {
        error_set(err, ERROR_SYSTEM, "a file in memory: %s", strerror(errno));
        if (number >= 0)
            close(number);
    }
    return file;
}

int tool_convert(const char *const *arguments, int from, int to, struct error *err) {
    FILE *said = tool_file(err);
    if (said == NULL)
        return ERROR_SYSTEM;
    int status = run_with(arguments, (const int[]){from, to, fileno(said)}, said, err);
    (void)fclose(said);
    return status;
}

int tool_run(const char *const *arguments, char **out, struct error *err) {
    FILE *printed = tool_file(err);
    if (printed == NULL)
        return ERROR_SYSTEM;
    int status = tool_convert(arguments, -1, fileno(printed), err);
    if (status == 0 && out != NULL)
        status = read_back(printed, out, err);
    (void)fclose(printed);
    return status;
}
