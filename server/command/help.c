#include "server/command/help.h"
#include "jobs/kind.h"
#include "schema/study/reference.h"
#include <string.h>

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

const char *command_near(const char *typed) {
    const char *near = NULL;
    size_t best = 3;
    for (size_t c = 0; COMMANDS[c] != NULL; c++)
        if (name_is_nearer(typed, COMMANDS[c]->name, &best))
            near = COMMANDS[c]->name;
    return near;
}

void help_commands(FILE *file) {
    fprintf(file, "usage: rugo COMMAND [OPTIONS]\n\n"
                  "Monte Carlo studies of rough surfaces and rough contact.\n\n");
    for (size_t c = 0; COMMANDS[c] != NULL; c++)
        fprintf(file, "  %-12s %s\n", COMMANDS[c]->name, COMMANDS[c]->summary);
    fprintf(file, "\nrugo help COMMAND tells a command's options; rugo help TOPIC tells of\n");
    for (size_t t = 0; t < TOPIC_COUNT; t++)
        fprintf(file, "  %-12s %s\n", TOPICS[t].name, TOPICS[t].summary);
    fprintf(file, "\nExit status: 0 done, 1 failed, 2 wrong usage or input, 130 interrupted.\n");
}

void help_option_name(const struct option_row *row, char *text, size_t size) {
    char letter[5] = "";
    if (row->letter != 0)
        snprintf(letter, sizeof letter, "-%c, ", row->letter);
    snprintf(text, size, "%s--%s%s%s", letter, row->name, row->argument != NULL ? " " : "",
             row->argument != NULL ? row->argument : "");
}

void help_option_text(const struct option_row *row, char *text, size_t size) {
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
        char name[80], text[240];
        help_option_name(row, name, sizeof name);
        help_option_text(row, text, sizeof text);
        fprintf(file, "  %-19s%s%s\n", name, strlen(name) > 19 ? "\n                      " : " ",
                text);
    }
}

/* --- the command --- */

struct options {
    int markdown;
};
static const struct option_row OPTIONS[] = {{"format", 0, OPTION_CHOICE, 0, 0,
                                             offsetof(struct options, markdown), "text|markdown",
                                             "text", "how the topic study is written"},
                                            {0}};

static int help_study(const char *path, bool markdown) {
    struct error err = {0};
    int status = markdown ? reference_markdown(stdout, JOB_KINDS, &err)
                          : reference_print(stdout, JOB_KINDS, path, &err);
    return status == 0 ? EXIT_DONE : command_fail("help", &err);
}

/* Tells of a topic other than study, or that there is none of this name. */
static int help_topic(const char *name) {
    for (size_t t = 0; t < TOPIC_COUNT; t++)
        if (TOPICS[t].print != NULL && strcmp(TOPICS[t].name, name) == 0) {
            TOPICS[t].print(stdout);
            return EXIT_DONE;
        }
    const char *near = command_near(name);
    return usage_error("help", "there is no command or topic \"%.40s\"%s%s%s", name,
                       near != NULL ? " (did you mean " : "", near != NULL ? near : "",
                       near != NULL ? "?)" : "");
}

static int run(const void *values, const char *const *arguments) {
    const struct options *options = values;
    const char *name = arguments[0], *path = arguments[1];
    int words = 1;
    const struct command *command = name != NULL ? command_find_words(name, path, &words) : NULL;
    if (name != NULL && strcmp(name, "study") == 0)
        return help_study(path, options->markdown != 0);
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
