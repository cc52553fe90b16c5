/* rugo: the one executable. Finds the subcommand, shows help, sees that output arrived. */
#include "schema/program.h"
#include "server/command/command.h"
#include "server/command/commands.h"
#include "server/command/portable.h"
#include "worker/link/client.h"
#include <errno.h>
#include <fcntl.h>
#include <gsl/gsl_errno.h>
#include <malloc.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

static bool wants_help(int argc, char **argv) {
    for (int i = 1; i < argc && strcmp(argv[i], "--") != 0; i++)
        if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0)
            return true;
    return false;
}

static int run_command(const struct command *command, int argc, char **argv) {
    if (wants_help(argc, argv)) {
        help_command(command, stdout);
        return EXIT_DONE;
    }
    struct error err = {0};
    const char *arguments[ARGUMENTS_MOST] = {NULL};
    void *options = array_create(1, command->options_size);
    gsl_set_error_handler_off(); /* errors are values, also GSL's */
    if (options == NULL) {
        error_memory(&err, command->options_size, "options");
        return command_fail(command->name, &err);
    }
    argv[0] = (char *)command->name; /* for messages: both words of two */
    int result = options_parse(argc, argv, command->options, options, command->least, command->most,
                               command->arguments, arguments);
    if (result == 0 && client_global_init(&err) != 0)
        result = command_fail(command->name, &err);
    else if (result == 0) {
        result = command->run(options, arguments);
        client_global_cleanup();
    }
    options_clear(command->options, options);
    free(options);
    return result;
}

static int unknown_command(const char *name) {
    const char *near = command_near(name);
    fprintf(stderr, "rugo: there is no command \"%.40s\"%s%s%s; see rugo --help\n", name,
            near != NULL ? " (did you mean " : "", near != NULL ? near : "",
            near != NULL ? "?)" : "");
    return EXIT_USAGE;
}

static bool is_version(const char *word) {
    static const char *const WORDS[] = {"--version", "version", "-V", "-v"};
    for (size_t w = 0; w < sizeof WORDS / sizeof *WORDS; w++)
        if (strcmp(word, WORDS[w]) == 0)
            return true;
    return false;
}

static int dispatch(int argc, char **argv) {
    if (argc < 2) {
        help_commands(stderr);
        return EXIT_USAGE;
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0) {
        help_commands(stdout);
        return EXIT_DONE;
    }
    if (is_version(argv[1])) {
        char program[PROGRAM_SIZE];
        program_write(program);
        printf("rugo %s\n", program);
        return EXIT_DONE;
    }
    int words = 1;
    const struct command *command = command_find_words(argv[1], argv[2], &words);
    return command != NULL ? run_command(command, argc - words, argv + words)
                           : unknown_command(argv[1]);
}

/* A standard stream that is closed must not become the number of a file opened later: it is opened
 * in the wrong direction, so that using it fails. */
static void hold_standard_streams(void) {
    for (int number = STDIN_FILENO; number <= STDERR_FILENO; number++)
        if (fcntl(number, F_GETFD) < 0 && errno == EBADF)
            (void)open("/dev/null", number == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

/* Large arrays come zeroed and untouched from the system: a joint histogram of megabytes, of which
 * a case uses a few cells, costs those cells alone. Left to itself the allocator keeps what was
 * freed, and has to clear it each time. */
enum { MAPPED_BYTES = 256 * 1024 };

/* What a thread and the first one may need of the stack; where it is smaller, they may crash. */
enum { STACK_LEAST = 1 << 20, STACK_WANTED = 8 << 20 };

/* Raises a small limit of the stack where that may be done; false where it may not. */
static bool stack_is_enough(void) {
    struct rlimit stack;
    pthread_attr_t attributes;
    if (getrlimit(RLIMIT_STACK, &stack) != 0 || stack.rlim_cur >= STACK_LEAST)
        return true;
    if (stack.rlim_max < STACK_LEAST)
        return false;
    stack.rlim_cur = stack.rlim_max < STACK_WANTED ? stack.rlim_max : STACK_WANTED;
    if (setrlimit(RLIMIT_STACK, &stack) != 0 || pthread_attr_init(&attributes) != 0)
        return false;
    bool raised = pthread_attr_setstacksize(&attributes, stack.rlim_cur) == 0 &&
                  pthread_setattr_default_np(&attributes) == 0;
    pthread_attr_destroy(&attributes);
    return raised;
}

int main(int argc, char **argv) {
    mallopt(M_MMAP_THRESHOLD, MAPPED_BYTES);
    portable_prepare();
    hold_standard_streams();
    signal(SIGPIPE, SIG_IGN); /* a closed pipe and a file at its limit are errors like any other */
    signal(SIGXFSZ, SIG_IGN);
    if (!stack_is_enough()) {
        fputs("rugo: the stack may have less than 1 MiB: see ulimit -s\n", stderr);
        return EXIT_FAILED;
    }
    int status = dispatch(argc, argv);
    struct error err = {0};
    if (output_flush(&err) != 0 && status == EXIT_DONE) {
        fprintf(stderr, "rugo: %s\n", err.text);
        return EXIT_FAILED;
    }
    return status;
}
