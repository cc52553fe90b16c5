#include "server/command/cluster/slurm_inside.h"
#include "core/file/memory_file.h"
#include "schema/result/view.h"
#include "server/command/command.h"
#include "server/command/tool.h"
#include "worker/clock.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { LOOK_MS = 5000, END_S = 120 /* signalled so long before its limit of time */ };

/* Prints an option as it would be typed, where it has a value or is set. */
static void print_option(FILE *file, const struct option_row *row, const void *values) {
    const void *value = (const char *)values + row->at;
    const char *alone[2] = {NULL, NULL}, *const *texts = alone;
    char number[16];
    if (row->type == OPTION_COUNT) {
        snprintf(number, sizeof number, "%u", *(const unsigned *)value);
        alone[0] = number;
    } else if (row->type == OPTION_TEXT || row->type == OPTION_MODELS) {
        alone[0] = *(const char *const *)value;
    } else if (row->type == OPTION_LIST) {
        texts = *(const char *const *const *)value;
    } else if (row->type == OPTION_FLAG && *(const bool *)value) {
        fprintf(file, " --%s", row->name);
    }
    for (; *texts != NULL; texts++) {
        fprintf(file, " --%s=", row->name);
        script_print_word(*texts, file);
    }
}

static void print_script(const struct slurm_folder *folder, const struct inside *inside,
                         const struct pilot_options *options, const char *program, const char *time,
                         const struct inside_command *command, FILE *file) {
    fprintf(file, "#!/bin/sh\n#SBATCH --job-name=%s\n#SBATCH --output=\"", inside->name);
    script_print_path(folder->path, file);
    fputs("/inside.log\"\n#SBATCH --open-mode=append\n#SBATCH --requeue\n", file);
    for (const char **option = options->sbatch; *option != NULL; option++)
        fprintf(file, "#SBATCH %s\n", *option);
    /* Behind those of --sbatch, which sbatch lets them overrule. */
    fprintf(file, "#SBATCH --ntasks=1\n#SBATCH --signal=B:TERM@%d\n#SBATCH --time=%s\n", END_S,
            time);
    if (options->partition != NULL)
        fprintf(file, "#SBATCH --partition=%s\n", options->partition);
    if (options->account != NULL)
        fprintf(file, "#SBATCH --account=%s\n", options->account);
    fputs("exec ", file);
    script_print_word(program, file);
    fputs(" slurm", file);
    for (const struct option_row *row = command->rows; row->name != NULL; row++)
        if (!view_lists(command->without, row->name))
            print_option(file, row, command->values);
    fputs(" -- ", file);
    script_print_word(command->file, file);
    fputc('\n', file);
}

int inside_prepare(struct inside *inside, const struct slurm_folder *folder,
                   const struct pilots *pilots, const struct pilot_options *options,
                   const char *time, const struct inside_command *command, struct error *err) {
    struct memory_file memory;
    char *text = NULL;
    snprintf(inside->name, sizeof inside->name, "%s-server", pilots->name);
    int status = slurm_folder_file(folder, "inside.sh", inside->script, err);
    if (status == 0)
        status = slurm_folder_file(folder, "inside.log", inside->log, err);
    if (status != 0)
        return status;
    if (memory_file_open(&memory)) {
        print_script(folder, inside, options, pilots->program, time, command, memory.file);
        text = memory_file_close(&memory, NULL);
    }
    status = text != NULL ? slurm_folder_write(folder, "inside.sh", text, 0, err)
                          : error_memory(err, 0, "a script");
    free(text);
    return status;
}

/* Waits until the next look; a signal is heeded at once, the first time. */
static void pause_or_stop(bool stopped) {
    const struct timespec step = {0, 100000000};
    int64_t until_ms = clock_ms() + LOOK_MS;
    while (clock_ms() < until_ms && (stopped || stop_requested == 0))
        nanosleep(&step, NULL);
}

/* The command in the job ends by itself, after its pilots have handed in. */
static int cancel(const struct inside *inside, struct error *err) {
    int status = slurm_jobs_cancel(inside->name, 1, err);
    return status != 0 ? status : slurm_jobs_tell(inside->name, err);
}

static void tell(const struct inside *inside, const struct slurm_count *count) {
    const char *state = count->running > 0 ? "runs" : count->waiting > 0 ? "waits" : "ends";
    fprintf(stderr, "rugo slurm: the job of the server %s; see %s\n", state, inside->log);
}

int inside_follow(const struct inside *inside, struct error *err) {
    struct slurm_count count = {0}, seen = {0};
    bool stopped = false;
    int status = slurm_jobs_count(inside->name, &count, err);
    if (status == 0 && count.left == 0) /* else an earlier command left it there */
        status =
            tool_run((const char *[]){"sbatch", "--parsable", inside->script, NULL}, NULL, err);
    for (count.left = 1; status == 0 && count.left > 0; seen = count) {
        struct error away = {0};
        pause_or_stop(stopped);
        if (stop_requested != 0 && !stopped) {
            stopped = true;
            status = cancel(inside, err);
        }
        if (slurm_jobs_count(inside->name, &count, &away) != 0)
            fprintf(stderr, "rugo slurm: %s; asked again\n", away.text);
        else if (count.running != seen.running || count.waiting != seen.waiting)
            tell(inside, &count);
    }
    return status == 0 && stopped ? error_set(err, ERROR_STOPPED, "stopped") : status;
}
