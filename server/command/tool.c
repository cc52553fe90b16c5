#include "server/command/tool.h"
#include "server/command/command.h"
#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { OUTPUT_MOST = 1 << 24 };

/* In a process group of its own, and with the signals that this program ignores as they were. */
static int set_attributes(posix_spawnattr_t *attributes) {
    sigset_t ignored;
    sigemptyset(&ignored);
    sigaddset(&ignored, SIGPIPE);
    sigaddset(&ignored, SIGXFSZ);
    int failure = posix_spawnattr_setsigdefault(attributes, &ignored);
    if (failure == 0)
        failure = posix_spawnattr_setpgroup(attributes, 0);
    if (failure == 0)
        failure =
            posix_spawnattr_setflags(attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
    return failure;
}

static int set_files(posix_spawn_file_actions_t *actions, int out, int said) {
    int failure = posix_spawn_file_actions_addopen(actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    if (failure == 0)
        failure = posix_spawn_file_actions_adddup2(actions, out, STDOUT_FILENO);
    if (failure == 0)
        failure = posix_spawn_file_actions_adddup2(actions, said, STDERR_FILENO);
    return failure;
}

static int start(const char *const *arguments, int out, int said, pid_t *child) {
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    int failure = posix_spawnattr_init(&attributes);
    if (failure != 0)
        return failure;
    failure = posix_spawn_file_actions_init(&actions);
    if (failure == 0) {
        failure = set_attributes(&attributes);
        if (failure == 0)
            failure = set_files(&actions, out, said);
        if (failure == 0)
            failure = posix_spawnp(child, arguments[0], &actions, &attributes,
                                   (char *const *)arguments, environ);
        posix_spawn_file_actions_destroy(&actions);
    }
    posix_spawnattr_destroy(&attributes);
    return failure;
}

/* Reads a file from its begin; the caller frees. NULL when out of memory. */
static char *read_back(FILE *file) {
    long size = fseek(file, 0, SEEK_END) == 0 ? ftell(file) : 0;
    if (size < 0 || size > OUTPUT_MOST)
        size = 0;
    char *text = malloc((size_t)size + 1);
    rewind(file);
    if (text != NULL)
        text[fread(text, 1, (size_t)size, file)] = '\0';
    return text;
}

/* What a program said that failed: its last 300 bytes, in one line. */
static int tell_failure(const char *program, int state, FILE *said, struct error *err) {
    enum { LAST = 300 };
    char *text = read_back(said);
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

static int run_with(const char *const *arguments, FILE *out, FILE *said, struct error *err) {
    pid_t child = 0;
    int state = 0, failure = start(arguments, fileno(out), fileno(said), &child);
    if (failure == ENOENT)
        return error_set(err, ERROR_SYSTEM, "there is no program %s in PATH", arguments[0]);
    if (failure != 0)
        return error_set(err, ERROR_SYSTEM, "%s: %s", arguments[0], strerror(failure));
    while (waitpid(child, &state, 0) < 0)
        if (errno != EINTR)
            return error_set(err, ERROR_SYSTEM, "%s: %s", arguments[0], strerror(errno));
    if (WIFEXITED(state) && WEXITSTATUS(state) == 0)
        return 0;
    return tell_failure(arguments[0], state, said, err);
}

int tool_run(const char *const *arguments, char **out, struct error *err) {
    FILE *printed = tmpfile(), *said = tmpfile();
    int status = printed != NULL && said != NULL
                     ? run_with(arguments, printed, said, err)
                     : error_set(err, ERROR_SYSTEM, "a temporary file: %s", strerror(errno));
    if (status == 0 && out != NULL && (*out = read_back(printed)) == NULL)
        status = error_memory(err, 0, "what a program printed");
    if (printed != NULL)
        (void)fclose(printed);
    if (said != NULL)
        (void)fclose(said);
    return status;
}
