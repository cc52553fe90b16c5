#include "server/command/pilots.h"
#include "core/memory_file.h"
#include "server/command/command.h"
#include "server/command/input_file.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

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
