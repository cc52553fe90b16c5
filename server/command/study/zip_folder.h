/* The files of a folder as one zip archive: the same files give the same bytes. */
#ifndef RUGO_SERVER_COMMAND_STUDY_ZIP_FOLDER_H
#define RUGO_SERVER_COMMAND_STUDY_ZIP_FOLDER_H

#include "core/error.h"
#include <stddef.h>

/* Packs the files of a folder, without folders in it, in the order of their names, below `top`.
 * All have one date and the rights rw-r--r--. The archive is whole or absent; ERROR_SYSTEM names
 * what cannot be read or written; ERROR_STOPPED where stop_requested was set. *count: how many
 * files. */
int zip_folder(const char *folder, const char *top, const char *path, size_t *count,
               struct error *err);

#endif
