/* A table of a study, local or of a server. */
#include "core/memory_file.h"
#include "server/command/access.h"
#include "server/command/access_internal.h"
#include "server/show/case_table.h"
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

/* Writes a query's value so that nothing in it has a meaning (RFC 3986, 2.1). */
static void put_escaped(FILE *file, const char *value) {
    static const char PLAIN[] = "-._~:@,/=";
    for (; *value != '\0'; value++)
        if (isalnum((unsigned char)*value) || strchr(PLAIN, *value) != NULL)
            fputc(*value, file);
        else
            fprintf(file, "%%%02X", (unsigned)(unsigned char)*value);
}

/* Makes the path of a table; the caller frees. NULL when out of memory. */
static char *table_path(const char *id, const struct table_request *request, int format) {
    static const char *const FORMATS[] = {"text", "csv", "json"};
    struct memory_file path;
    if (!memory_file_open(&path))
        return NULL;
    fprintf(path.file, "/v1/studies/%s/table?format=%s", id, FORMATS[format]);
    if (request->columns != NULL) {
        fputs("&columns=", path.file);
        put_escaped(path.file, request->columns);
    }
    for (size_t w = 0; request->where != NULL && request->where[w] != NULL; w++) {
        fputs(w == 0 ? "&where=" : ",", path.file);
        put_escaped(path.file, request->where[w]);
    }
    return memory_file_close(&path, NULL);
}

/* A table is made of a study of a store. */
struct origin {
    struct store *store;
    const char *id;
};

static int results(const void *context, const struct result_filter *filter,
                   struct study_result *out, struct error *err) {
    const struct origin *origin = context;
    return aggregate_study(origin->store, origin->id, filter, out, err);
}

static int download(struct access *access, const char *id, const struct table_request *request,
                    int format, FILE *file, struct error *err) {
    char *path = table_path(id, request, format);
    int status = path != NULL ? client_download(access->client, path, file, err)
                              : error_memory(err, 0, "a request");
    free(path);
    return status;
}

int access_table(struct access *access, const char *id, const struct table_request *request,
                 int format, FILE *file, struct error *err) {
    const struct origin origin = {access->store, id};
    const struct picture_source source = {.context = &origin, .results = results};
    struct case_table table = {0};
    if (access->client != NULL)
        return download(access, id, request, format, file, err);
    int status = case_table_make(&table, &source, request, err);
    if (status == 0)
        status = case_table_print(&table, format, file, err);
    case_table_clear(&table);
    return status;
}
