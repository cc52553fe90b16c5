#include "server/command/cluster/pilots.h"
#include "core/file/memory_file.h"
#include "server/command/command.h"
#include "server/command/exit_status.h"
#include "server/command/input_file.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

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
    /* B: the script hands it on to its worker; the tasks of srun get the signal themselves */
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

/* The worker, or several by srun, behind this shell. A signal for a pilot of one task comes to the
 * shell alone at a limit of time, and to both where the job is ended. */
static void print_worker(const struct pilot_script *script, FILE *file) {
    const struct pilot_options *options = script->options;
    if (options->tasks > 1)
        fprintf(file, "srun --ntasks=%u --cpus-per-task=%u --kill-on-bad-exit=0 ", options->tasks,
                options->cpus);
    script_print_word(script->program, file);
    fprintf(file, " work \"$@\" --idle-exit %u &\nworker=$!\n", options->idle_s);
    fputs(options->tasks > 1 ? "trap : TERM\n" : "trap 'kill -s TERM \"$worker\"' TERM\n", file);
    fputs("wait \"$worker\"\nstatus=$?\n"
          "while [ $status -gt 128 ] && kill -0 \"$worker\" 2>/dev/null; do\n"
          "    wait \"$worker\"\n    status=$?\ndone\n",
          file);
}

void pilot_script_print(const struct pilot_script *script, FILE *file) {
    fputs("#!/bin/sh\n", file);
    print_asked(script, file);
    fputs("\n# Where the server is now, also after a requeue: options of rugo work, one a line.\n"
          "set --\nwhile IFS= read -r option; do set -- \"$@\" \"$option\"; done <",
          file);
    script_print_word(script->place, file);
    fputs(" || exit\n\n# When its time ends, which older Slurm, such as 22.05, does not say.\n"
          "export SLURM_TIME_FORMAT=standard\n"
          "job=${SLURM_ARRAY_JOB_ID:+${SLURM_ARRAY_JOB_ID}_}${SLURM_ARRAY_TASK_ID:-$SLURM_JOB_ID}\n"
          "if [ -z \"$SLURM_JOB_END_TIME\" ] &&\n"
          "    end=$(squeue --noheader --jobs \"$job\" --format %e 2>/dev/null) && [ -n \"$end\" "
          "]; then\n"
          "    SLURM_JOB_END_TIME=$(date +%s --date \"$end\" 2>/dev/null)\nfi\n"
          "export SLURM_JOB_END_TIME\n\n"
          "# Signals go on to the worker, which hands in what it has done.\n",
          file);
    print_worker(script, file);
    fputs("\n# One that is preempted has ended before its time of grace: the node is free at once, "
          "and\n# Slurm starts it again later.\n"
          "case $(squeue --noheader --jobs \"$job\" --Format State,PreemptTime 2>/dev/null) in\n"
          "RUNNING*:*) scontrol requeue \"$job\" ;;\nesac\nexit $status\n",
          file);
}

enum { SCRIPT_MOST = 1 << 20 };

/* Where the executable is: on the nodes, too, unless the option names another one there. */
static int find_program(const struct pilot_options *options, char path[PATH_MAX],
                        struct error *err) {
    if (options->program != NULL) {
        if (options->program[0] != '/')
            return error_set(err, ERROR_INPUT, "--program %.200s is not an absolute path",
                             options->program);
        snprintf(path, PATH_MAX, "%s", options->program);
        return 0;
    }
    ssize_t length = readlink("/proc/self/exe", path, PATH_MAX - 1);
    if (length < 0)
        return error_set(err, ERROR_SYSTEM, "/proc/self/exe: %s", strerror(errno));
    path[length] = '\0';
    return 0;
}

/* Makes the text of the script, which the caller frees. */
static int make_text(const struct pilot_script *script, char **text, struct error *err) {
    struct memory_file memory;
    *text = NULL;
    if (memory_file_open(&memory)) {
        pilot_script_print(script, memory.file);
        *text = memory_file_close(&memory, NULL);
    }
    return *text != NULL ? 0 : error_memory(err, 0, "a script");
}

int pilots_prepare(struct pilots *pilots, const struct slurm_folder *folder, const char *served,
                   const struct pilot_options *options, struct error *err) {
    char place[PATH_MAX], *text = NULL;
    slurm_jobs_name(served, pilots->name);
    int status = slurm_folder_file(folder, "place", place, err);
    if (status == 0)
        status = slurm_folder_file(folder, "pilots.sh", pilots->script, err);
    if (status == 0)
        status = find_program(options, pilots->program, err);
    const struct pilot_script script = {.options = options,
                                        .name = pilots->name,
                                        .folder = folder->path,
                                        .program = pilots->program,
                                        .place = place};
    if (status == 0)
        status = make_text(&script, &text, err);
    if (status == 0)
        status = slurm_folder_write(folder, "pilots.sh", text, 0, err);
    free(text);
    return status;
}

int pilots_print(const char *script, struct error *err) {
    char *text = NULL;
    size_t size = 0;
    int status = input_file_read(script, SCRIPT_MOST, &text, &size, err);
    if (status == 0) {
        fputs(text, stdout);
        status = output_flush(err);
    }
    free(text);
    return status;
}
