#include "worker/source.h"
#include "worker/source_way.h"
#include "worker/wire.h"

#include <stdlib.h>
#include <string.h>

enum { NAME_MOST = 256 };

struct source {
    const struct source_way *way;
    void *self;
    char worker[NAME_MOST], host[NAME_MOST];
    char study[STUDY_ID_SIZE]; /* "": any */
    const char *kinds[WIRE_KINDS_MOST + 1];
};

static int name_copy(char *out, size_t size, const char *what, const char *name,
                     struct error *err) {
    size_t length = name ? strlen(name) : 0;
    if (length >= size) {
        return error_set(err, ERROR_INPUT, "%s '%.40s...' is longer than %zu bytes", what, name,
                         size - 1);
    }
    if (name) {
        memcpy(out, name, length + 1);
    }
    return 0;
}

static int source_fill(struct source *source, const struct source_options *options,
                       struct error *err) {
    size_t kinds = JOB_KIND_COUNT < WIRE_KINDS_MOST ? JOB_KIND_COUNT : WIRE_KINDS_MOST;
    for (size_t n = 0; n < kinds; n++) {
        source->kinds[n] = JOB_KINDS[n]->name;
    }
    source->way = options->database ? &SOURCE_STORE : &SOURCE_SERVER;
    int status = name_copy(source->worker, NAME_MOST, "worker name", options->worker, err);
    status = status ? status : name_copy(source->host, NAME_MOST, "host name", options->host, err);
    status =
        status ? status : name_copy(source->study, STUDY_ID_SIZE, "study id", options->study, err);
    return status ? status : source->way->create(&source->self, options, err);
}

int source_create(struct source **out, const struct source_options *options, struct error *err) {
    if (!options->database == !options->url) {
        return error_set(err, ERROR_INPUT, "a worker needs either a database or a server");
    }
    struct source *source = calloc(1, sizeof *source);
    if (!source) {
        return error_memory(err, sizeof *source, "a source of jobs");
    }
    int status = source_fill(source, options, err);
    if (status) {
        source_destroy(&source);
        return status;
    }
    *out = source;
    return 0;
}

void source_destroy(struct source **source) {
    struct source *gone = *source;
    if (!gone) {
        return;
    }
    if (gone->way) {
        gone->way->destroy(gone->self);
    }
    free(gone);
    *source = NULL;
}

int source_claim(struct source *source, struct claimed_job *job, int *found, struct error *err) {
    struct claim claim = {
        .worker = source->worker,
        .host = source->host,
        .kinds = source->kinds,
        .study = source->study[0] ? source->study : NULL,
        .count = 1,
    };
    return source->way->claim(source->self, &claim, job, found, err);
}

int source_left(struct source *source, int *left, struct error *err) {
    return source->way->left(source->self, left, err);
}

int source_heartbeat(struct source *source, const struct claimed_job *job, uint64_t done,
                     struct error *err) {
    return source->way->heartbeat(source->self, job, done, err);
}

int source_complete(struct source *source, const struct claimed_job *job,
                    const struct job_kind *kind, const struct job_result *result,
                    struct error *err) {
    return source->way->complete(source->self, job, kind, result, err);
}

int source_fail(struct source *source, const struct claimed_job *job, const char *reason,
                int permanent, struct error *err) {
    return source->way->fail(source->self, job, reason, permanent, err);
}

int source_release(struct source *source, const struct claimed_job *job, struct error *err) {
    return source->way->release(source->self, job, err);
}
