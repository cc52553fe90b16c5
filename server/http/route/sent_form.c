#include "server/http/route/sent_form.h"
#include "core/file/memory_file.h"
#include "server/http/route/route.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* What is read of a form. */
struct reading {
    struct sent_form *form;
    struct memory_file files, study;
    size_t study_size;
    bool in_study, has_study;
    int status;
    struct error *err;
};

bool sent_form_is(const struct exchange *exchange) {
    const char *type = exchange_header(exchange, "Content-Type");
    return type != NULL && strncasecmp(type, FORM_MEDIA, strlen(FORM_MEDIA)) == 0;
}

static int begin_study(struct reading *reading) {
    if (reading->has_study)
        return error_set(reading->err, ERROR_INPUT, "a second study in the form");
    reading->has_study = reading->in_study = true;
    return 0;
}

static int begin_file(struct reading *reading, const char *name) {
    struct sent_form *form = reading->form;
    if (name == NULL)
        return error_set(reading->err, ERROR_INPUT,
                         "a part of the form is neither a file nor the field \"study\"");
    if (*name == '\0' || strlen(name) > SENT_NAME_MOST)
        return error_set(reading->err, ERROR_INPUT,
                         "a file of a form has a name, such as a.x3p, of up to %d bytes",
                         (int)SENT_NAME_MOST);
    if (form->count == JOINT_PATCHES_MOST)
        return error_set(reading->err, ERROR_INPUT, "more than %d files in a form",
                         (int)JOINT_PATCHES_MOST);
    for (size_t f = 0; f < form->count; f++)
        if (strcmp(form->names[f], name) == 0)
            return error_set(reading->err, ERROR_INPUT,
                             "two files named %.80s: each needs a name of its own", name);
    if ((form->names[form->count] = strdup(name)) == NULL)
        return error_memory(reading->err, strlen(name), "the name of a file");
    form->sizes[form->count++] = 0;
    reading->in_study = false;
    return 0;
}

/* A part begins anew at offset 0, unless none of its bytes had come before. */
static bool begins(const struct reading *reading, bool study, const char *name, uint64_t offset) {
    const struct sent_form *form = reading->form;
    if (offset > 0)
        return false;
    if (study)
        return !reading->in_study || reading->study_size > 0;
    return name == NULL || form->count == 0 || reading->in_study ||
           form->sizes[form->count - 1] > 0 || strcmp(form->names[form->count - 1], name) != 0;
}

/* Writes the quotes of a name, which browsers and curl send as %22 (the multipart/form-data of
 * WHATWG's HTML). */
static void unquote(char *name) {
    for (char *at = name; (at = strstr(at, "%22")) != NULL;) {
        *at++ = '"';
        memmove(at, at + 2, strlen(at + 2) + 1);
    }
}

static enum MHD_Result keep(void *context, enum MHD_ValueKind kind, const char *field,
                            const char *quoted, const char *media, const char *encoding,
                            const char *data, uint64_t offset, size_t size) {
    struct reading *reading = context;
    const bool study = field != NULL && strcmp(field, "study") == 0;
    char text[SENT_NAME_MOST + 2]; /* of one that is too long, enough to see that */
    const char *name = quoted != NULL ? text : NULL;
    (void)kind, (void)media, (void)encoding;
    snprintf(text, sizeof text, "%s", quoted != NULL ? quoted : "");
    unquote(text);
    if (begins(reading, study, name, offset))
        reading->status = study ? begin_study(reading) : begin_file(reading, name);
    if (reading->status != 0)
        return MHD_NO;
    fwrite(data, 1, size, reading->in_study ? reading->study.file : reading->files.file);
    *(reading->in_study ? &reading->study_size : &reading->form->sizes[reading->form->count - 1]) +=
        size;
    return MHD_YES;
}

static int read_form(struct reading *reading, struct exchange *exchange) {
    enum { BUFFER = 64 << 10 };
    struct MHD_PostProcessor *processor =
        MHD_create_post_processor(exchange->connection, BUFFER, keep, reading);
    if (processor == NULL)
        return error_set(reading->err, ERROR_INPUT, "Content-Type: a form names its boundary");
    const bool read = MHD_post_process(processor, exchange->body, exchange->body_size) == MHD_YES;
    const bool whole = MHD_destroy_post_processor(processor) == MHD_YES;
    if (reading->status != 0)
        return reading->status;
    if (!read || !whole)
        return error_set(reading->err, ERROR_INPUT,
                         "the form is cut, or its boundary is not the one of Content-Type");
    return reading->form->count > 0
               ? 0
               : error_set(reading->err, ERROR_INPUT,
                           "a form without files by the boundary of Content-Type");
}

/* Takes the place of the body. */
static int replace_body(struct exchange *exchange, struct reading *reading, const char *study) {
    size_t size;
    if (study != NULL)
        fwrite(study, 1, reading->study_size, reading->files.file);
    char *files = memory_file_close(&reading->files, &size);
    if (files == NULL)
        return error_memory(reading->err, exchange->body_size, "the files of a form");
    free(exchange->body);
    exchange->body = files;
    exchange->body_size = size;
    return 0;
}

int sent_form_take(struct sent_form *out, struct exchange *exchange, struct error *err) {
    struct reading reading = {.form = out, .err = err};
    *out = (struct sent_form){0};
    if (!memory_file_open(&reading.files) || !memory_file_open(&reading.study)) {
        free(memory_file_close(&reading.files, NULL));
        return error_memory(err, sizeof reading, "the files of a form");
    }
    int status = read_form(&reading, exchange);
    char *study = memory_file_close(&reading.study, NULL);
    if (status == 0 && study == NULL)
        status = error_memory(err, exchange->body_size, "the study of a form");
    if (status == 0)
        status = replace_body(exchange, &reading, study);
    else
        free(memory_file_close(&reading.files, NULL));
    free(study);
    return status;
}

void sent_form_clear(struct sent_form *form) {
    for (size_t f = 0; f < form->count; f++)
        free(form->names[f]);
    *form = (struct sent_form){0};
}
