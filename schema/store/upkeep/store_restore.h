/* Restores a store from a copy. The steps are made so that, wherever a process is killed, the name
 * of the database is that of the old file or of the new one, whole, and logs of the old file are
 * beside the new one for a moment only, in which store_open refuses them. */
#ifndef RUGO_SCHEMA_STORE_STORE_RESTORE_H
#define RUGO_SCHEMA_STORE_STORE_RESTORE_H

#include "core/file/part_file.h"
#include "schema/store/store.h"

/* Ends what a killed restore_swap of this database left beside it, or takes away what a killed copy
 * left; true where the logs of the old file were still to be moved. */
int restore_finish(const char *database, bool *finished, struct error *err);
/* Copies a backup into a part of folder/NAME, NAME being that of the database, with the owner and
 * the mode of the database, and brings it to the disk. The folder exists, beside the database. The
 * caller publishes the part by restore_swap, or destroys it. ERROR_INPUT where the backup is the
 * database itself or has a log beside it, whose changes would be left out. */
int restore_copy(struct part_file *part, const char *backup, const char *database,
                 const char *folder, bool (*stop)(void *context), void *context, struct error *err);
/* Gives the copy the name of the database. The old files are in the folder then; *kept is false
 * where there were none. ERROR_STATE, with what can be known of it, where another process has one
 * of the two files open. */
int restore_swap(struct part_file *part, const char *database, const char *folder, bool *kept,
                 struct error *err);

struct lacking_study {
    const char *id, *name, *owner, *created; /* borrowed for the call; owner "": nobody */
};
/* Calls found for each study of `store` that `copy` lacks, by their age. */
int store_lacks(struct store *store, struct store *copy,
                int (*found)(void *context, const struct lacking_study *study), void *context,
                struct error *err);

#endif
