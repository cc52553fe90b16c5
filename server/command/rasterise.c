#include "server/command/rasterise.h"
#include <errno.h>
#include <spawn.h>
#include <stdbool.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static const char PROGRAM[] = "rsvg-convert";

/* Starts the program, which reads one file and writes the other. */
static int start(int input, int output, pid_t *child, struct error *err) {
    char *const arguments[] = {(char[]){"rsvg-convert"}, (char[]){"--dpi-x=192"},
                               (char[]){"--dpi-y=192"}, (char[]){"--zoom=2"}, NULL};
    posix_spawn_file_actions_t actions;
    int failure = posix_spawn_file_actions_init(&actions);
    if (failure != 0)
        return error_set(err, ERROR_SYSTEM, "%s: %s", PROGRAM, strerror(failure));
    failure = posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
    if (failure == 0)
        failure = posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    if (failure == 0)
        failure = posix_spawnp(child, PROGRAM, &actions, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failure == ENOENT)
        return error_set(err, ERROR_SYSTEM,
                         "pixels need rsvg-convert (of librsvg, on Debian librsvg2-bin), which is "
                         "not installed; a file whose name does not end in .png is SVG");
    return failure == 0 ? 0 : error_set(err, ERROR_SYSTEM, "%s: %s", PROGRAM, strerror(failure));
}

static int wait_for(pid_t child, struct error *err) {
    int state = 0;
    while (waitpid(child, &state, 0) < 0)
        if (errno != EINTR)
            return error_set(err, ERROR_SYSTEM, "%s: %s", PROGRAM, strerror(errno));
    if (WIFEXITED(state) && WEXITSTATUS(state) == 0)
        return 0;
    return error_set(err, ERROR_SYSTEM, "%s could not draw the picture", PROGRAM);
}

int rasterise(const char *svg, size_t size, FILE *out, struct error *err) {
    pid_t child;
    FILE *file = tmpfile();
    if (file == NULL)
        return error_set(err, ERROR_SYSTEM, "a temporary file: %s", strerror(errno));
    bool written =
        fwrite(svg, 1, size, file) == size && fflush(file) == 0 && fseek(file, 0, SEEK_SET) == 0;
    int status = written ? start(fileno(file), fileno(out), &child, err)
                         : error_set(err, ERROR_SYSTEM, "a temporary file: %s", strerror(errno));
    if (status == 0)
        status = wait_for(child, err);
    (void)fclose(file);
    return status;
}
