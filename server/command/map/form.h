/* Several files on standard input, as browsers and curl -F send them: a form of the media type
 * multipart/form-data (RFC 7578). */
#ifndef RUGO_SERVER_COMMAND_MAP_FORM_H
#define RUGO_SERVER_COMMAND_MAP_FORM_H

#include "core/error.h"
#include <stddef.h>

enum { FORM_FILES_MOST = 16, FORM_NAME_MOST = 300 };

struct form_file {
    const char *name; /* as the sender names it */
    const char *data; /* data[size] is 0 */
    size_t size;
};
/* All but `text` lies in it. Initialise with {0}. */
struct form {
    size_t count;
    struct form_file files[FORM_FILES_MOST + 1]; /* the last has no name */
    struct form_file study;                      /* the field "study"; name NULL: there is none */
    char *text;                                  /* owned */
};
/* Takes the form in text[size], whose parts the boundary separates; text is the form's from then
 * on. Each part has a file, with a name of its own, or is the field "study". ERROR_INPUT says which
 * part is at fault; the form is to be cleared then, too. */
int form_take(struct form *out, char *text, size_t size, const char *boundary, struct error *err);
void form_clear(struct form *form);
/* Copies the bytes of a file, with a 0 behind them, for the caller to free. ERROR_INPUT: there is
 * none of this name. */
int form_read(const struct form *form, const char *name, char **text, size_t *size,
              struct error *err);

#endif
