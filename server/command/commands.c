/* The table of commands, and the texts that are made of it: help, the manual page, the completion.
 */
#include "server/command/commands.h"
#include "jobs/kind.h"
#include "schema/near_name.h"
#include "schema/study/reference.h"
#include "server/command/command.h"
#include <string.h>

const struct command *const COMMANDS[] = {
    &COMMAND_RUN,          &COMMAND_CHECK,
    &COMMAND_SUBMIT,       &COMMAND_STATUS,
    &COMMAND_WAIT,         &COMMAND_SHOW,
    &COMMAND_TABLE,        &COMMAND_CURVES,
    &COMMAND_REPORT,       &COMMAND_PLOT,
    &COMMAND_EXPORT,       &COMMAND_SNAPSHOT,
    &COMMAND_RESTORE,      &COMMAND_VERIFY,
    &COMMAND_REPAIR,       &COMMAND_CANCEL,
    &COMMAND_RETRY,        &COMMAND_EXTEND,
    &COMMAND_DELETE,       &COMMAND_PRUNE,
    &COMMAND_SERVE,        &COMMAND_HEALTH,
    &COMMAND_WORK,         &COMMAND_SLURM,
    &COMMAND_SLURM_PILOTS, &COMMAND_CERTIFICATE,
    &COMMAND_TOKEN,        &COMMAND_GENERATE,
    &COMMAND_CHARACTERISE, &COMMAND_CONVERT,
    &COMMAND_PRESS,        &COMMAND_THEORY,
    &COMMAND_HELP,         NULL,
};

const struct command *command_find(const char *name) {
    for (size_t c = 0; COMMANDS[c] != NULL; c++)
        if (strcmp(COMMANDS[c]->name, name) == 0)
            return COMMANDS[c];
    return NULL;
}

const struct command *command_find_words(const char *first, const char *second, int *taken) {
    char both[64];
    snprintf(both, sizeof both, "%.30s %.30s", first, second != NULL ? second : "");
    const struct command *command = command_find(both);
    *taken = command != NULL ? 2 : 1;
    return command != NULL ? command : command_find(first);
}

/* What people type who know other programs, and the command that does it. It is named to them, not
 * run: some of these change a store. */
static const struct {
    const char *typed, *command;
} ELSEWHERE[] = {{"list", "status"},
                 {"ls", "status"},
                 {"studies", "status"},
                 {"start", "run"},
                 {"validate", "check"},
                 {"queue", "submit"},
                 {"results", "table"},
                 {"get", "table"},
                 {"draw", "plot"},
                 {"stop", "cancel"},
                 {"kill", "cancel"},
                 {"remove", "delete"},
                 {"rm", "delete"},
                 {"clean", "prune"},
                 {"backup", "snapshot"},
                 {"recover", "restore"},
                 {"measure", "characterise"},
                 {"solve", "press"},
                 {"contact", "press"},
                 {"daemon", "serve"}};

static const char *name_here(const char *typed) {
    for (size_t n = 0; n < sizeof ELSEWHERE / sizeof *ELSEWHERE; n++)
        if (strcmp(ELSEWHERE[n].typed, typed) == 0)
            return ELSEWHERE[n].command;
    return typed;
}

const char *command_near(const char *typed) {
    struct near_name near = {.typed = name_here(typed)};
    for (size_t c = 0; COMMANDS[c] != NULL; c++)
        near_name_see(&near, COMMANDS[c]->name);
    return near.name;
}

/* --- help --- */

/* Writes "-o, --output FILE". */
static void help_option_name(const struct option_row *row, char *text, size_t size) {
    char letter[5] = "", argument[100];
    if (row->letter != 0)
        snprintf(letter, sizeof letter, "-%c, ", row->letter);
    option_argument(row, argument, sizeof argument);
    snprintf(text, size, "%s--%s%s%s", letter, row->name, *argument != '\0' ? " " : "", argument);
}

/* Writes what an option does, with its default. */
static void help_option_text(const struct option_row *row, char *text, size_t size) {
    if (row->standard != NULL)
        snprintf(text, size, "%s (%s)", row->help, row->standard);
    else
        snprintf(text, size, "%s%s", row->help,
                 row->type == OPTION_LIST ? "; may be repeated" : "");
}

void help_command(const struct command *command, FILE *file) {
    fprintf(file, "usage: rugo %s %s%s[OPTIONS]\n\n%s\n\n", command->name, command->arguments,
            *command->arguments != '\0' ? " " : "", command->summary);
    for (const struct option_row *row = command->options; row->name != NULL; row++) {
        char name[160], text[240];
        help_option_name(row, name, sizeof name);
        help_option_text(row, text, sizeof text);
        fprintf(file, "  %-19s%s%s\n", name, strlen(name) > 19 ? "\n                      " : " ",
                text);
    }
}

/* --- the manual page rugo(1), and the completion for bash --- */

/* Prints a text of a roff line with hyphens and quotes as typed, and nothing taken for a request.
 */
static void print_roff(FILE *file, const char *text) {
    if (*text == '.' || *text == '\'')
        fputs("\\&", file);
    for (; *text != '\0'; text++)
        if (*text == '-')
            fputs("\\-", file);
        else if (*text == '\'')
            fputs("\\(aq", file);
        else if (*text == '\\')
            fputs("\\e", file);
        else
            fputc(*text, file);
}

static void print_option(FILE *file, const struct option_row *row) {
    char name[160], text[240];
    help_option_name(row, name, sizeof name);
    help_option_text(row, text, sizeof text);
    fputs(".TP\n\\fB", file);
    print_roff(file, name);
    fputs("\\fR\n", file);
    print_roff(file, text);
    fputc('\n', file);
}

static void print_command(FILE *file, const struct command *command) {
    fprintf(file, ".SS rugo %s %s%s[OPTIONS]\n", command->name, command->arguments,
            *command->arguments != '\0' ? " " : "");
    print_roff(file, command->summary);
    fputs(".\n", file);
    for (const struct option_row *row = command->options; row->name != NULL; row++)
        print_option(file, row);
}

static void help_man(FILE *file) {
    fputs(".TH RUGO 1 \"\" \"rugo " PROGRAM_VERSION "\" \"User commands\"\n"
          ".SH NAME\nrugo \\- Monte Carlo studies of rough surfaces and rough contact\n"
          ".SH SYNOPSIS\n.B rugo\n.I COMMAND\n.RI [ OPTIONS ]\n"
          ".SH DESCRIPTION\n"
          "A study is a small JSON file: a rough surface, what to compute of many realisations of\n"
          "it, and which parameters to sweep. Rugo runs it on this machine or as a service with\n"
          "many workers, and gives curves with error bars.\n"
          ".SH COMMANDS\n",
          file);
    for (size_t c = 0; COMMANDS[c] != NULL; c++)
        print_command(file, COMMANDS[c]);
    fputs(".SH EXIT STATUS\n"
          ".TP\n0\ndone\n.TP\n1\nfailed\n.TP\n2\nwrong usage or input\n"
          ".TP\n130\ninterrupted; the same command goes on\n"
          ".SH ENVIRONMENT\n.TP\n.B RUGO_TOKEN\n"
          "the token for a server, where no file of tokens is given\n"
          ".TP\n.B RUGO_CA_FILE\n"
          "certificates of authorities that sign those of servers, where neither \\-\\-ca\\-file "
          "nor \\-\\-fingerprint is given\n"
          ".TP\n.B RUGO_FINGERPRINT\n"
          "that of the key of the server, likewise\n"
          ".SH EXAMPLES\n"
          ".nf\nrugo check study.json\nrugo run \\-\\-set realisations=100 study.json\n"
          "rugo serve \\-\\-db results.db \\-\\-workers 4\n.fi\n",
          file);
}

static size_t command_count(void) {
    size_t count = 0;
    while (COMMANDS[count] != NULL)
        count++;
    return count;
}

static void help_bash(FILE *file) {
    fputs("_rugo() {\n"
          "    local word=${COMP_WORDS[COMP_CWORD]} options=\n"
          "    case $COMP_CWORD in 1) options='",
          file);
    for (size_t c = 0; COMMANDS[c] != NULL; c++)
        if (strchr(COMMANDS[c]->name, ' ') == NULL)
            fprintf(file, "%s%s", c > 0 ? " " : "", COMMANDS[c]->name);
    fputs(
        "' ;; esac\n    [[ $COMP_CWORD == 1 ]] || case \"${COMP_WORDS[1]} ${COMP_WORDS[2]} \" in\n",
        file);
    /* from the last, since a command of two words comes behind that of its first */
    for (size_t c = command_count(); c-- > 0;) {
        fprintf(file, "    '%s '*) options='", COMMANDS[c]->name);
        for (const struct option_row *row = COMMANDS[c]->options; row->name != NULL; row++)
            fprintf(file, "--%s ", row->name);
        fputs("--help' ;;\n", file);
    }
    fputs("    esac\n"
          "    [[ $COMP_CWORD == 1 || $word == -* ]] && COMPREPLY=($(compgen -W \"$options\" -- "
          "\"$word\"))\n"
          "}\ncomplete -o default -F _rugo rugo\n",
          file);
}

/* --- the topics --- */

/* `rugo help` explains these topics beside the commands. */
struct topic {
    const char *name, *summary;
    void (*print)(FILE *file); /* NULL: help_study */
};
static const struct topic TOPICS[] = {
    {"study", "the parameters of a study; with PATH, those below it", NULL},
    {"man", "the manual page rugo(1), as roff", help_man},
    {"bash", "completion for bash, to be sourced", help_bash},
};
enum { TOPIC_COUNT = sizeof TOPICS / sizeof *TOPICS };

void help_commands(FILE *file) {
    fprintf(file, "usage: rugo COMMAND [OPTIONS]\n\n"
                  "Monte Carlo studies of rough surfaces and rough contact.\n\n");
    for (size_t c = 0; COMMANDS[c] != NULL; c++)
        fprintf(file, "  %-12s %s\n", COMMANDS[c]->name, COMMANDS[c]->summary);
    fprintf(file, "\nrugo help COMMAND lists a command's options; rugo help TOPIC explains\n");
    for (size_t t = 0; t < TOPIC_COUNT; t++)
        fprintf(file, "  %-12s %s\n", TOPICS[t].name, TOPICS[t].summary);
    fprintf(file, "\nExit status: 0 done, 1 failed, 2 wrong usage or input, 130 interrupted.\n");
}

/* --- the command --- */

struct options {
    int markdown;
};
static const struct option_row OPTIONS[] = {
    {"format", 0, OPTION_CHOICE, 0, 0, offsetof(struct options, markdown), "text|markdown", "text",
     "how the topic study is written; markdown without PATH"},
    {0}};

static int help_study(const char *path, bool markdown) {
    struct error err = {0};
    int status = markdown ? reference_markdown(stdout, JOB_KINDS, &err)
                          : reference_print(stdout, JOB_KINDS, path, &err);
    return status == 0 ? EXIT_DONE : command_fail("help", &err);
}

/* Prints a topic other than study, or that there is none of this name. */
static int help_topic(const char *name) {
    for (size_t t = 0; t < TOPIC_COUNT; t++)
        if (TOPICS[t].print != NULL && strcmp(TOPICS[t].name, name) == 0) {
            TOPICS[t].print(stdout);
            return EXIT_DONE;
        }
    char hint[NEAR_HINT_SIZE];
    struct near_name near = {.typed = name_here(name)};
    for (size_t t = 0; t < TOPIC_COUNT; t++)
        near_name_see(&near, TOPICS[t].name);
    for (size_t c = 0; COMMANDS[c] != NULL; c++)
        near_name_see(&near, COMMANDS[c]->name);
    return usage_error("help", "there is no command or topic \"%.40s\"%s", name,
                       near_name_hint(&near, hint));
}

static int run(const void *values, const char *const *arguments) {
    const struct options *options = values;
    const char *name = arguments[0], *path = arguments[1];
    int words = 1;
    const struct command *command = name != NULL ? command_find_words(name, path, &words) : NULL;
    bool study = name != NULL && strcmp(name, "study") == 0, markdown = options->markdown != 0;
    if (markdown && !(study && path == NULL))
        return usage_error("help", "--format markdown is of the topic study, without PATH");
    if (study)
        return help_study(path, markdown);
    if (path != NULL && words == 1)
        return usage_error("help", "unexpected argument %.60s", path);
    if (command == NULL && name != NULL)
        return help_topic(name);
    if (command != NULL)
        help_command(command, stdout);
    else
        help_commands(stdout);
    return EXIT_DONE;
}

const struct command COMMAND_HELP = {
    .name = "help",
    .arguments = "[COMMAND|TOPIC [PATH]]",
    .summary = "the commands, the options of one, or a topic",
    .most = 2,
    .options = OPTIONS,
    .options_size = sizeof(struct options),
    .run = run,
};
