#include "server/command/slurm_script.h"
#include "server/command/exit_status.h"
#include <string.h>

enum { HAND_IN_S = 60 }; /* before the limit of time */

static bool is_line(const char *text) {
    for (; *text != '\0'; text++)
        if ((unsigned char)*text < ' ' || *text == 0x7f)
            return false;
    return true;
}

bool script_is_word(const char *text) {
    static const char PLAIN[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_.:,+@/=%";
    return *text != '\0' && strspn(text, PLAIN) == strlen(text);
}

int pilot_options_check(const char *command, const struct pilot_options *options) {
    const struct {
        const char *name, *text;
    } WORDS[] = {
        {"time", options->time}, {"partition", options->partition}, {"account", options->account}};
    for (size_t w = 0; w < sizeof WORDS / sizeof *WORDS; w++)
        if (WORDS[w].text != NULL && !script_is_word(WORDS[w].text))
            return usage_error(command,
                               "--%s has characters other than letters, digits and "
                               "-_.:,+@/=%%",
                               WORDS[w].name);
    for (const char **option = options->sbatch; *option != NULL; option++)
        if ((*option)[0] != '-' || !is_line(*option))
            return usage_error(command, "--sbatch takes an option of sbatch on one line, such as "
                                        "--sbatch=--mem=2G");
    return options->program == NULL || is_line(options->program)
               ? 0
               : usage_error(command, "--program has control characters");
}

void script_print_word(const char *text, FILE *file) {
    fputc('\'', file);
    for (; *text != '\0'; text++)
        if (*text == '\'')
            fputs("'\\''", file);
        else
            fputc(*text, file);
    fputc('\'', file);
}

void script_print_path(const char *path, FILE *file) {
    for (; *path != '\0'; path++) {
        if (*path == '"' || *path == '\\')
            fputc('\\', file);
        if (*path == '%')
            fputc('%', file);
        fputc(*path, file);
    }
}

static void print_asked(const struct pilot_script *script, FILE *file) {
    const struct pilot_options *options = script->options;
    fprintf(file, "#SBATCH --job-name=%s\n#SBATCH --output=\"", script->name);
    script_print_path(script->folder, file);
    fputs("/pilot-%A_%a.log\"\n#SBATCH --open-mode=append\n#SBATCH --requeue\n", file);
    fprintf(file, "#SBATCH --nodes=1\n#SBATCH --ntasks-per-node=%u\n#SBATCH --cpus-per-task=%u\n",
            options->tasks, options->cpus);
    /* B: the script becomes the worker; the tasks of srun are told themselves */
    fprintf(file, "#SBATCH --signal=%sTERM@%d\n", options->tasks == 1 ? "B:" : "", HAND_IN_S);
    if (options->time != NULL)
        fprintf(file, "#SBATCH --time=%s\n", options->time);
    if (options->partition != NULL)
        fprintf(file, "#SBATCH --partition=%s\n", options->partition);
    if (options->account != NULL)
        fprintf(file, "#SBATCH --account=%s\n", options->account);
    for (const char **option = options->sbatch; *option != NULL; option++)
        fprintf(file, "#SBATCH %s\n", *option);
}

void pilot_script_print(const struct pilot_script *script, FILE *file) {
    const struct pilot_options *options = script->options;
    fputs("#!/bin/sh\n", file);
    print_asked(script, file);
    fputs("\n# Where the server is now, also after a requeue: options of rugo work, one a line.\n"
          "set --\nwhile IFS= read -r option; do set -- \"$@\" \"$option\"; done <",
          file);
    script_print_word(script->place, file);
    fputs(" || exit\nexec ", file);
    if (options->tasks > 1)
        fprintf(file, "srun --ntasks=%u --cpus-per-task=%u --kill-on-bad-exit=0 ", options->tasks,
                options->cpus);
    script_print_word(script->program, file);
    fprintf(file, " work \"$@\" --idle-exit %u\n", options->idle_s);
}
