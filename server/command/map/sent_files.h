/* Several files on standard input, one behind the other, as the service hands on what a peer sent.
 */
#ifndef RUGO_SERVER_COMMAND_MAP_SENT_FILES_H
#define RUGO_SERVER_COMMAND_MAP_SENT_FILES_H

#include "core/error.h"
#include "core/statistics/spectra/joint_fit.h"
#include <stddef.h>

/* Initialise with {0}. Names are borrowed; all else lies in `text`. */
struct sent_files {
    size_t count;
    const char *names[JOINT_PATCHES_MOST];
    size_t ends[JOINT_PATCHES_MOST]; /* bytes of text to the end of each */
    size_t size;                     /* of text; behind the last file stands a study, or nothing */
    char *text;                      /* owned */
};
/* Cuts text[size] into the files of these names, ended by NULL, by their sizes, a list of numbers
 * of bytes such as "120,77"; text belongs to the files from then on. ERROR_INPUT where the sizes
 * are not those of the names or the text; the files are to be cleared then, too. */
int sent_files_take(struct sent_files *out, char *text, size_t size, const char *sizes,
                    const char *const *names, struct error *err);
void sent_files_clear(struct sent_files *files);
/* Copies the bytes of a file, with a 0 behind them, for the caller to free. ERROR_INPUT: there is
 * none of this name. */
int sent_files_read(const struct sent_files *files, const char *name, char **text, size_t *size,
                    struct error *err);
/* Likewise the study behind them; *size is 0 where there is none. */
int sent_files_study(const struct sent_files *files, char **text, size_t *size, struct error *err);

#endif
