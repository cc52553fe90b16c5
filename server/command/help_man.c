/* The manual page rugo(1) and the completion for bash. */
#include "server/command/help.h"
#include <string.h>

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
    char name[80], text[240];
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

void help_man(FILE *file) {
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
          "who vouches for servers, where neither \\-\\-ca\\-file nor \\-\\-fingerprint is given\n"
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

void help_bash(FILE *file) {
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
