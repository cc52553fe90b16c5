/* rugo: the one executable. Finds the subcommand, shows help, sees that output arrived. */
#include "server/command/command.h"
#include "worker/client.h"
#include <errno.h>
#include <fcntl.h>
#include <gsl/gsl_errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define VERSION "0.1.0"
#define PLACE                                                                                      \
    "  --db FILE           the local store (rugo.db)\n"                                            \
    "  --server URL        a server instead\n"                                                     \
    "  --token-file FILE   its token; or RUGO_TOKEN\n"

static const struct command COMMANDS[] = {
    {"run", "STUDY.json", "run a study here, from submission to table", command_run,
     "  --db FILE           the local store (rugo.db)\n"
     "  --workers N         threads (as many as processors)\n"
     "  --set PATH=VALUE    change the study, e.g. --set realisations=100; may be repeated\n"
     "  --out DIR           write curves.json, a CSV a curve and an SVG a quantity\n"},
    {"check", "STUDY.json", "read and validate a study, print cases and cost, run nothing",
     command_check,
     "  --set PATH=VALUE    change the study; may be repeated\n"
     "  --format FORMAT     text or json (text)\n"
     "  --schema            print the JSON Schema of studies instead; needs no study\n"},
    {"submit", "STUDY.json", "queue a study and print its id", command_submit,
     PLACE "  --set PATH=VALUE    change the study; may be repeated\n"},
    {"status", "[ID]", "progress, workers, time left, failures; without ID all studies",
     command_status, PLACE "  --format FORMAT     text or json (text)\n"},
    {"curves", "ID", "aggregated curves, also of a study still running", command_curves,
     PLACE "  --case K            this case only\n"
           "  --quantity Q        this quantity only\n"
           "  --format FORMAT     json or csv (json)\n"},
    {"report", "ID", "speed against error, by case", command_report,
     PLACE "  --format FORMAT     text or json (text)\n"},
    {"snapshot", "FILE", "a consistent copy of the results database", command_snapshot, PLACE},
    {"cancel", "ID", "stop a study", command_cancel, PLACE},
    {"retry", "ID", "queue the failed jobs of a study again", command_retry, PLACE},
    {"serve", "", "the HTTP service", command_serve,
     "  --db FILE           the store (rugo.db)\n"
     "  --listen ADDR:PORT  where to listen (127.0.0.1:8080); port 0 picks a free one\n"
     "  --token-file FILE   tokens, role:token a line; needed beyond loopback\n"
     "  --workers N         run jobs in this process too\n"
     "  --lease SECONDS     how long a silent worker keeps its job (60)\n"
     "  --connections N     most connections at a time (256)\n"
     "  --per-address N     most connections of one address (no limit)\n"
     "  --deadline SECONDS  most time for one request (30)\n"
     "  --allow-host NAME   another name of this server; may be repeated\n"},
    {"work", "", "claim and run jobs of a store or a server", command_work,
     PLACE "  --workers N         threads (as many as processors)\n"
           "  --drain             end when the queue is empty\n"
           "  --lease SECONDS     how long this worker may be silent, with --db (60)\n"},
    {"generate", "STUDY.json", "one surface of a study, and its characterisation", command_generate,
     "  --case K            of this case (0)\n"
     "  --realisation R     this realisation (0)\n"
     "  --format FORMAT     npy, csv or xyz (npy)\n"
     "  -o FILE             write the height map there\n"
     "  --mesh FILE.vtu     write the block of the model full, meshed on the surface\n"
     "  --pressure P        ... pressed to p/(E* h'), with displacement, pressure, stress\n"
     "  --set PATH=VALUE    change the study; may be repeated\n"},
    {"characterise", "FILE", "parameters and summits of a height map in a file",
     command_characterise,
     "  --dx D              distance of points (1)\n"
     "  --format FORMAT     text or json (text)\n"},
    {"press", "FILE", "contact of a height map in a file, periodic, with a rigid flat",
     command_press,
     "  --dx D              distance of points (1)\n"
     "  --loads LIST        rising loads p/(E* h') (0.01,0.02,0.05,0.1,0.2,0.3)\n"
     "  --model MODEL       halfspace or layered (halfspace)\n"
     "  --poisson NU        Poisson's ratio, layered (0.3)\n"
     "  --height LENGTHS    height of the block in lengths of the map (infinite; layered 1.5)\n"
     "  --format FORMAT     text or json (text)\n"
     "  -o FILE             write the pressures p/(E* h') of the last load there, as a map\n"},
};
enum { COMMAND_COUNT = sizeof COMMANDS / sizeof *COMMANDS };

static void print_commands(FILE *file) {
    fprintf(file, "usage: rugo COMMAND [OPTIONS]\n\n"
                  "Monte Carlo studies of rough surfaces and rough contact.\n\n");
    for (size_t c = 0; c < COMMAND_COUNT; c++)
        fprintf(file, "  %-12s %s\n", COMMANDS[c].name, COMMANDS[c].summary);
    fprintf(file, "\nrugo COMMAND --help tells a command's options.\n"
                  "Exit status: 0 done, 1 failed, 2 wrong usage or input, 130 interrupted.\n");
}

static void print_help(const struct command *command) {
    printf("usage: rugo %s %s%s[OPTIONS]\n\n%s\n\n%s", command->name, command->arguments,
           *command->arguments ? " " : "", command->summary, command->help);
}

static bool wants_help(int argc, char **argv) {
    for (int i = 1; i < argc && strcmp(argv[i], "--") != 0; i++)
        if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0)
            return true;
    return false;
}

static int run_command(const struct command *command, int argc, char **argv) {
    if (wants_help(argc, argv)) {
        print_help(command);
        return EXIT_DONE;
    }
    struct error err = {0};
    gsl_set_error_handler_off(); /* errors are values, also GSL's */
    if (client_global_init(&err))
        return command_fail(command->name, &err);
    int status = command->run(argc, argv);
    client_global_cleanup();
    return status;
}

static int dispatch(int argc, char **argv) {
    if (argc < 2) {
        print_commands(stderr);
        return EXIT_USAGE;
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0) {
        print_commands(stdout);
        return EXIT_DONE;
    }
    if (strcmp(argv[1], "--version") == 0) {
        puts("rugo " VERSION);
        return EXIT_DONE;
    }
    for (size_t c = 0; c < COMMAND_COUNT; c++)
        if (strcmp(argv[1], COMMANDS[c].name) == 0)
            return run_command(&COMMANDS[c], argc - 1, argv + 1);
    fprintf(stderr, "rugo: there is no command \"%.40s\"; see rugo --help\n", argv[1]);
    return EXIT_USAGE;
}

/* A standard stream that is closed must not become the number of a file opened later: it is opened
 * the wrong way round, so that using it fails. */
static void hold_standard_streams(void) {
    for (int number = STDIN_FILENO; number <= STDERR_FILENO; number++)
        if (fcntl(number, F_GETFD) < 0 && errno == EBADF)
            (void)open("/dev/null", number == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

int main(int argc, char **argv) {
    hold_standard_streams();
    signal(SIGPIPE, SIG_IGN); /* a closed pipe and a file at its limit are errors like any other */
    signal(SIGXFSZ, SIG_IGN);
    int status = dispatch(argc, argv);
    struct error err = {0};
    if (output_flush(&err) && status == EXIT_DONE) {
        fprintf(stderr, "rugo: %s\n", err.text);
        return EXIT_FAILED;
    }
    return status;
}
