#include "server/command/map/gwyddion.h"
#include "core/file/plain_text.h"
#include "core/file/whole_file.h"
#include "core/file/written_file.h"
#include "core/instrument/foreign.h"
#include "server/bounded_program.h"
#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const uint64_t MEMORY_LEAST = 512 << 20; /* bytes; Gwyddion takes less than 200 MiB itself */
enum {
    MEMORY_FACTOR = 64, /* of the bytes of the file: a channel has 8 bytes a point, and copies */
    VERSION_SECONDS = 20,
    SAID_MOST = 4096, /* bytes that are read of what it prints */
    PATH_ROOM = 512,
    DEPTH_MOST = 8 /* of folders that it makes */
};
static const char OUTPUT[] = "printed", MADE[] = "made.gwy";

/* A run of Gwyddion. */
struct run {
    char folder[PATH_ROOM];
    char input[40]; /* "measured.al3d" */
    uint64_t memory;
    unsigned seconds;
    char version[64]; /* "Gwyddion 2.62" */
};

/* --- its folder --- */

static int remove_one(const char *path, const struct stat *state, int type, struct FTW *at) {
    (void)state;
    (void)type;
    (void)at;
    return remove(path) != 0 && errno != ENOENT ? -1 : 0;
}

static void remove_folder(const char *folder) {
    (void)nftw(folder, remove_one, DEPTH_MOST, FTW_DEPTH | FTW_PHYS);
}

static int make_folder(struct run *run, struct error *err) {
    const char *base = getenv("TMPDIR");
    int length = snprintf(run->folder, sizeof run->folder, "%s/rugo-convert-XXXXXX",
                          base != NULL && *base == '/' ? base : "/tmp");
    if (length < 0 || (size_t)length >= sizeof run->folder)
        return error_set(err, ERROR_INPUT, "TMPDIR is longer than %d bytes", PATH_ROOM - 30);
    if (mkdtemp(run->folder) == NULL)
        return error_set(err, ERROR_SYSTEM, "%s: %s", run->folder, strerror(errno));
    return 0;
}

/* The name that Gwyddion sees has the ending alone, of letters and digits, by which it knows some
 * formats. */
static void name_input(struct run *run, const char *name) {
    const char *dot = strrchr(name, '.');
    size_t used = (size_t)snprintf(run->input, sizeof run->input, "measured.");
    for (const char *at = dot != NULL ? dot + 1 : "bin"; *at != '\0'; at++)
        if (used + 1 < sizeof run->input && isalnum((unsigned char)*at))
            run->input[used++] = *at;
    run->input[used] = '\0';
}

static int write_input(const struct run *run, const char *data, size_t size, struct error *err) {
    char path[PATH_ROOM + 48];
    struct written_file file;
    snprintf(path, sizeof path, "%s/%s", run->folder, run->input);
    int status = written_file_open(&file, path, err);
    if (status != 0)
        return status;
    if (fwrite(data, 1, size, file.stream) != size)
        status = error_set(err, ERROR_SYSTEM, "%s: %s", path, strerror(errno));
    return written_file_close(&file, status, err);
}

/* --- the program --- */

/* Sets the first line of what it printed, without what terminals would take for orders. */
static void read_said(const struct run *run, char *line, size_t room) {
    char path[PATH_ROOM + 16];
    *line = '\0';
    snprintf(path, sizeof path, "%s/%s", run->folder, OUTPUT);
    int file = open(path, O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
    if (file < 0)
        return;
    ssize_t count = read(file, line, room - 1);
    (void)close(file);
    line[count > 0 ? count : 0] = '\0';
    line[strcspn(line, "\r\n")] = '\0';
    text_make_plain(line);
}

/* Runs it; *end and *code as bounded_program_run() has them. */
static int start(const struct run *run, const char *option, unsigned seconds, enum bounded_end *end,
                 int *code, struct error *err) {
    char home[PATH_ROOM + 16], temporary[PATH_ROOM + 16], libraries[PATH_ROOM], shared[PATH_ROOM];
    const char *arguments[] = {"gwyddion", option, run->input, NULL};
    const char *environment[8] = {"LC_ALL=C.UTF-8", home, temporary, NULL};
    const char *path = getenv("PATH"), *library = getenv("LD_LIBRARY_PATH"),
               *data = getenv("XDG_DATA_DIRS");
    char *paths = NULL;
    size_t used = 3;
    snprintf(home, sizeof home, "HOME=%s", run->folder);
    snprintf(temporary, sizeof temporary, "TMPDIR=%s", run->folder);
    if (path != NULL && asprintf(&paths, "PATH=%s", path) < 0)
        return error_memory(err, strlen(path), "an environment");
    if (paths != NULL)
        environment[used++] = paths;
    if (library != NULL && strlen(library) + 20 < sizeof libraries) {
        snprintf(libraries, sizeof libraries, "LD_LIBRARY_PATH=%s", library);
        environment[used++] = libraries;
    }
    if (data != NULL && strlen(data) + 20 < sizeof shared) {
        snprintf(shared, sizeof shared, "XDG_DATA_DIRS=%s", data);
        environment[used++] = shared;
    }
    const struct bounded_program program = {.arguments = arguments,
                                            .environment = environment,
                                            .folder = run->folder,
                                            .output = OUTPUT,
                                            .memory_bytes = run->memory,
                                            .file_bytes = run->memory,
                                            .seconds = seconds,
                                            .abandon = remove_folder};
    int status = bounded_program_run(&program, end, code, err);
    free(paths);
    return status;
}

static int refuse_end(const struct run *run, enum bounded_end end, int code, unsigned seconds,
                      struct error *err) {
    char said[200];
    read_said(run, said, sizeof said);
    if (end == BOUNDED_LATE)
        return error_set(err, ERROR_INPUT,
                         "%s took longer than the %u s that it may take (--convert)", run->version,
                         seconds);
    if (end == BOUNDED_KILLED)
        return error_set(err, ERROR_INPUT, "%s was ended by signal %d, within %llu MiB%s%s",
                         run->version, code, (unsigned long long)(run->memory >> 20),
                         *said != '\0' ? ": " : "", said);
    return error_set(err, ERROR_INPUT, "%s cannot convert it, within %llu MiB%s%s", run->version,
                     (unsigned long long)(run->memory >> 20), *said != '\0' ? ": " : "", said);
}

/* Finds its version, and so whether it is there. */
static int find_version(struct run *run, bool *there, struct error *err) {
    enum bounded_end end = BOUNDED_ABSENT;
    int code = 0;
    snprintf(run->version, sizeof run->version, "Gwyddion");
    const unsigned seconds = run->seconds < VERSION_SECONDS ? run->seconds : VERSION_SECONDS;
    int status = start(run, "--version", seconds, &end, &code, err);
    *there = end != BOUNDED_ABSENT;
    if (status != 0 || !*there)
        return status;
    if (end != BOUNDED_EXITED || code != 0)
        return refuse_end(run, end, code, seconds, err);
    char said[sizeof run->version];
    read_said(run, said, sizeof said);
    said[strcspn(said, "(")] = '\0'; /* a date follows */
    for (size_t length = strlen(said); length > 0 && said[length - 1] == ' ';)
        said[--length] = '\0';
    if (*said != '\0')
        memcpy(run->version, said, sizeof said);
    return 0;
}

static int convert(struct run *run, struct gwyddion_file *out, struct error *err) {
    char option[64], path[PATH_ROOM + 16];
    enum bounded_end end;
    int code;
    snprintf(option, sizeof option, "--convert-to-gwy=%s", MADE);
    snprintf(path, sizeof path, "%s/%s", run->folder, MADE);
    int status = start(run, option, run->seconds, &end, &code, err);
    if (status != 0)
        return status;
    if (end != BOUNDED_EXITED || code != 0)
        return refuse_end(run, end, code, run->seconds, err);
    status = whole_file_read(path, run->memory, &out->data, &out->size, err);
    return status == 0 ? 0 : error_context(err, "%s made nothing of it", run->version);
}

/* --- what it is asked for --- */

static int refuse_format(const struct foreign_format *format, const char *why, struct error *err) {
    if (format == NULL)
        return error_set(err, ERROR_INPUT,
                         "neither its first bytes nor its ending belong to a format that is read "
                         "here%s",
                         why);
    return error_set(err, ERROR_INPUT, "by its first bytes this is %s, which is not read here%s",
                     format->name, why);
}

static int run_in_folder(struct run *run, struct gwyddion_file *out, const char *data, size_t size,
                         const struct foreign_format *format, struct error *err) {
    bool there = false;
    int status = find_version(run, &there, err);
    if (status == 0 && !there)
        return refuse_format(format,
                             "; where Gwyddion is installed (package gwyddion of Debian) it "
                             "converts files of many more formats",
                             err);
    if (status == 0)
        status = write_input(run, data, size, err);
    return status == 0 ? convert(run, out, err) : status;
}

int gwyddion_convert(struct gwyddion_file *out, const char *name, const char *data, size_t size,
                     unsigned seconds, struct error *err) {
    const struct foreign_format *format = foreign_format_of(data, size);
    struct run run = {.memory = MEMORY_LEAST + MEMORY_FACTOR * (uint64_t)size, .seconds = seconds};
    *out = (struct gwyddion_file){.data = NULL};
    if (format != NULL && format->picture)
        return error_set(err, ERROR_INPUT, "this is a picture (%s), which holds no heights",
                         format->name);
    if (seconds == 0)
        return refuse_format(format,
                             "; Gwyddion may convert it, but is not asked to (--convert of the "
                             "command, or of rugo serve)",
                             err);
    name_input(&run, name);
    int status = make_folder(&run, err);
    if (status != 0)
        return status;
    status = run_in_folder(&run, out, data, size, format, err);
    remove_folder(run.folder);
    snprintf(out->step, sizeof out->step, "by %s%s%s", run.version, format != NULL ? " from " : "",
             format != NULL ? format->name : "");
    return status;
}

void gwyddion_file_clear(struct gwyddion_file *file) {
    free(file->data);
    *file = (struct gwyddion_file){.data = NULL};
}
