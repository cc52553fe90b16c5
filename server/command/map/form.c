#include "server/command/map/form.h"
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { BOUNDARY_MOST = 70 };

/* What is left of a form. */
struct rest {
    char *at, *end;
    char delimiter[BOUNDARY_MOST + 5]; /* CR LF -- and the boundary */
    size_t part;                       /* number of the part that is read, from 1 */
};

static char *find(char *at, const char *end, const char *text) {
    return at < end ? memmem(at, (size_t)(end - at), text, strlen(text)) : NULL;
}

static int refuse(const struct rest *rest, const char *reason, struct error *err) {
    return error_set(err, ERROR_INPUT, "part %zu of the form: %s", rest->part, reason);
}

/* --- headers of a part --- */

/* What a part says of itself; NULL: nothing. */
struct said {
    const char *field, *file;
};

/* Ends a text in quotes, without its escapes, where it stands; returns what is behind it, NULL
 * where it has no end. */
static char *unquote(char *text) {
    char *to = text, *at = text;
    for (; *at != '"' && *at != '\0'; at++) {
        at += *at == '\\' && (at[1] == '"' || at[1] == '\\') ? 1 : 0;
        *to++ = *at;
    }
    char *behind = *at == '"' ? at + 1 : NULL;
    *to = '\0';
    return behind;
}

/* Reads form-data; name="map"; filename="a.x3p". */
static void read_disposition(char *line, struct said *out) {
    char *at = strchr(line, ';');
    while (at != NULL) {
        char *key = at + 1 + strspn(at + 1, " \t"), *equal = strchr(key, '=');
        if (equal == NULL || equal[1] != '"')
            return;
        char *value = equal + 2;
        at = unquote(value);
        *equal = '\0';
        if (at != NULL && strcasecmp(key, "name") == 0)
            out->field = value;
        if (at != NULL && strcasecmp(key, "filename") == 0)
            out->file = value;
        at = at != NULL ? strchr(at, ';') : NULL;
    }
}

/* Reads to the end of the empty line before the bytes of the part. */
static int read_headers(struct rest *rest, struct said *out, struct error *err) {
    static const char DISPOSITION[] = "Content-Disposition:";
    *out = (struct said){0};
    for (;;) {
        char *line = rest->at, *end = find(line, rest->end, "\r\n");
        if (end == NULL)
            return refuse(rest, "it ends within its headers", err);
        *end = '\0';
        rest->at = end + 2;
        if (end == line)
            return 0;
        if (strncasecmp(line, DISPOSITION, strlen(DISPOSITION)) == 0)
            read_disposition(line, out);
    }
}

/* --- parts --- */

static int keep_file(struct form *out, const struct rest *rest, const struct form_file *file,
                     struct error *err) {
    if (file->name == NULL)
        return refuse(rest, "neither a file nor the field \"study\"", err);
    if (*file->name == '\0' || strlen(file->name) > FORM_NAME_MOST)
        return refuse(rest, "a file has a name, such as a.x3p, of up to 300 bytes", err);
    if (out->count == FORM_FILES_MOST)
        return error_set(err, ERROR_INPUT, "more than %d files in a form", (int)FORM_FILES_MOST);
    for (size_t f = 0; f < out->count; f++)
        if (strcmp(out->files[f].name, file->name) == 0)
            return error_set(err, ERROR_INPUT,
                             "two files named %.80s: each needs a name of its own", file->name);
    out->files[out->count++] = *file;
    return 0;
}

static int take_part(struct form *out, struct rest *rest, struct error *err) {
    struct said said;
    int status = read_headers(rest, &said, err);
    if (status != 0)
        return status;
    char *end = find(rest->at, rest->end, rest->delimiter);
    if (end == NULL)
        return refuse(rest, "the boundary is missing behind it", err);
    struct form_file file = {said.file, rest->at, (size_t)(end - rest->at)};
    *end = '\0';
    rest->at = end + strlen(rest->delimiter);
    if (said.field == NULL || strcmp(said.field, "study") != 0)
        return keep_file(out, rest, &file, err);
    if (out->study.name != NULL)
        return refuse(rest, "a second study", err);
    file.name = "study";
    out->study = file;
    return 0;
}

/* Whether another part begins here, behind a boundary; the last has two dashes behind it. */
static bool next_part(struct rest *rest) {
    char *line = find(rest->at, rest->end, "\r\n");
    const bool last = rest->end - rest->at >= 2 && strncmp(rest->at, "--", 2) == 0;
    rest->at = line != NULL ? line + 2 : rest->end;
    rest->part++;
    return !last;
}

int form_take(struct form *out, char *text, size_t size, const char *boundary, struct error *err) {
    struct rest rest = {.at = text, .end = text + size};
    *out = (struct form){.text = text};
    if (*boundary == '\0' || strlen(boundary) > BOUNDARY_MOST)
        return error_set(err, ERROR_INPUT, "the boundary of a form has 1 to %d letters, not %zu",
                         (int)BOUNDARY_MOST, strlen(boundary));
    snprintf(rest.delimiter, sizeof rest.delimiter, "\r\n--%s", boundary);
    const char *first = rest.delimiter + 2; /* nothing need stand before it */
    rest.at = size >= strlen(first) && memcmp(text, first, strlen(first)) == 0
                  ? text
                  : find(text, rest.end, rest.delimiter);
    if (rest.at == NULL)
        return error_set(err, ERROR_INPUT, "no form: it has no boundary --%s", boundary);
    rest.at += strlen(rest.at == text ? first : rest.delimiter);
    int status = 0;
    while (status == 0 && next_part(&rest))
        status = take_part(out, &rest, err);
    if (status == 0 && out->count == 0)
        status = error_set(err, ERROR_INPUT, "a form without files");
    return status;
}

void form_clear(struct form *form) {
    free(form->text);
    *form = (struct form){0};
}

int form_read(const struct form *form, const char *name, char **text, size_t *size,
              struct error *err) {
    for (const struct form_file *file = form->files; file->name != NULL; file++)
        if (strcmp(file->name, name) == 0) {
            char *copy = malloc(file->size + 1);
            if (copy == NULL)
                return error_memory(err, file->size, name);
            memcpy(copy, file->data, file->size);
            copy[file->size] = '\0';
            *text = copy;
            *size = file->size;
            return 0;
        }
    return error_set(err, ERROR_INPUT, "%.80s: no file of this name was sent", name);
}
