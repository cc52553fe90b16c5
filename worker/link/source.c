#include "worker/link/source.h"
#include "schema/program.h"
#include "worker/link/source_backend.h"
#include "worker/link/wire.h"

#include <stdlib.h>
#include <string.h>

enum { NAME_MOST = 256 };

struct source {
    const struct source_backend *backend;
    void *self;
    char worker[NAME_MOST], host[NAME_MOST], program[PROGRAM_SIZE];
    char study[STUDY_ID_SIZE]; /* "": any */
    const char *kinds[WIRE_KINDS_MOST + 1];
};

static int name_copy(char *out, size_t size, const char *what, const char *name,
                     struct error *err) {
    size_t length = name != NULL ? strlen(name) : 0;
    if (length >= size) {
        return error_set(err, ERROR_INPUT, "%s '%.40s...' is longer than %zu bytes", what, name,
                         size - 1);
    }
    if (name != NULL && !worker_name_is_plain(name))
        return error_set(err, ERROR_INPUT, "the %s has a control character", what);
    if (name != NULL)
        memcpy(out, name, length + 1);
    return 0;
}

static int source_fill(struct source *source, const struct source_options *options,
                       struct error *err) {
    size_t n = 0;
    for (; JOB_KINDS[n] != NULL && n < WIRE_KINDS_MOST; n++)
        source->kinds[n] = JOB_KINDS[n]->name;
    if (JOB_KINDS[n] != NULL)
        return error_set(err, ERROR_INPUT, "a claim names at most %d kinds, and there are more",
                         WIRE_KINDS_MOST);
    program_write(source->program);
    source->backend = options->database != NULL ? &SOURCE_STORE : &SOURCE_SERVER;
    int status = name_copy(source->worker, NAME_MOST, "worker name", options->worker, err);
    status =
        status != 0 ? status : name_copy(source->host, NAME_MOST, "host name", options->host, err);
    status = status != 0 ? status
                         : name_copy(source->study, STUDY_ID_SIZE, "study id", options->study, err);
    return status != 0 ? status : source->backend->create(&source->self, options, err);
}

int source_create(struct source **out, const struct source_options *options, struct error *err) {
    if ((options->database == NULL) == (options->url == NULL))
        return error_set(err, ERROR_INPUT, "a worker needs either a database or a server");
    struct source *source = calloc(1, sizeof *source);
    if (source == NULL)
        return error_memory(err, sizeof *source, "a source of jobs");
    int status = source_fill(source, options, err);
    if (status != 0) {
        source_destroy(&source);
        return status;
    }
    *out = source;
    return 0;
}

void source_destroy(struct source **source) {
    struct source *gone = *source;
    if (gone == NULL)
        return;
    if (gone->backend != NULL)
        gone->backend->destroy(gone->self);
    free(gone);
    *source = NULL;
}

int source_claim(struct source *source, const struct wish *wish, struct claimed_job *jobs,
                 size_t *count, bool *due, struct error *err) {
    struct claim claim = {
        .worker = source->worker,
        .host = source->host,
        .program = source->program,
        .kinds = source->kinds,
        .study = source->study[0] != '\0' ? source->study : NULL,
        .count = wish->count,
        .seconds = wish->seconds,
        .threads = wish->threads,
    };
    return source->backend->claim(source->self, &claim, wish, jobs, count, due, err);
}

int source_report(struct source *source, struct report *reports, size_t count, bool *due,
                  struct error *err) {
    for (size_t n = 0; n < count; n++)
        reports[n].status = 0;
    return source->backend->report(source->self, reports, count, due, err);
}

const char *source_other_forms(const struct source *source) {
    return source->backend->other_forms != NULL ? source->backend->other_forms(source->self) : "";
}

int source_left(struct source *source, int *left, bool *due, struct error *err) {
    return source->backend->left(source->self, left, due, err);
}
