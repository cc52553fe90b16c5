/* A zip archive in memory, of which entries are unpacked piece by piece: what an entry says of its
 * size is held to while it is unpacked, and bounds what a small file can make of itself. Entries
 * may be stored or deflated; encrypted ones and other methods are refused. */
#ifndef RUGO_CORE_INSTRUMENT_ZIP_ARCHIVE_H
#define RUGO_CORE_INSTRUMENT_ZIP_ARCHIVE_H

#include "core/error.h"
#include <stdbool.h>
#include <stddef.h>

/* Bytes of a piece: a multiple of the bytes of every record that X3P files have (x3p_layout.h). */
enum { ZIP_ARCHIVE_PIECE = 65520 };
/* An entry unpacks to at most this many bytes and 100 times those of the whole file. */
enum { ZIP_ARCHIVE_FREE = 1 << 28 };
enum { ZIP_ARCHIVE_ENTRIES = 10000 }; /* at most */

/* Whether a file begins as zip archives do. */
bool zip_archive_begins(const char *data, size_t size);
/* Whether its directory names an entry that ends so; takes no memory, and checks nothing else. */
bool zip_archive_names(const char *data, size_t size, const char *ending);

struct zip_archive;
/* data is borrowed until the archive is closed. ERROR_INPUT says what is wrong with it. */
int zip_archive_open(struct zip_archive **out, const char *data, size_t size, struct error *err);
void zip_archive_close(struct zip_archive **archive);

size_t zip_archive_entries(const struct zip_archive *archive);
/* Borrowed, in the bytes of the file; "" where it has none. */
const char *zip_archive_name(const struct zip_archive *archive, size_t entry);
/* Finds an entry by its name, for which "./" before it and the kind of slash make no difference. */
bool zip_archive_find(const struct zip_archive *archive, const char *name, size_t *entry);

/* Bytes of an entry as it says, checked against the bound above. */
int zip_archive_size(struct zip_archive *archive, size_t entry, size_t *size, struct error *err);

/* Takes a piece of ZIP_ARCHIVE_PIECE bytes, the last one of fewer: 0 to go on, ZIP_ARCHIVE_ENOUGH
 * to see no more of the entry, or an error. */
enum { ZIP_ARCHIVE_ENOUGH = 1 };
typedef int zip_archive_take(void *context, const char *bytes, size_t count, struct error *err);
/* ERROR_INPUT where the entry is damaged (CRC-32), or has another size than it says; pieces may
 * have been taken by then. */
int zip_archive_unpack(struct zip_archive *archive, size_t entry, zip_archive_take *take,
                       void *context, struct error *err);
/* All bytes of an entry, NUL behind them; *out is the caller's to free. */
int zip_archive_read(struct zip_archive *archive, size_t entry, char **out, size_t *size,
                     struct error *err);
/* Its first bytes, at most *size (in: room; out: those that there are). What stands behind them is
 * not looked at. */
int zip_archive_peek(struct zip_archive *archive, size_t entry, char *first, size_t *size,
                     struct error *err);

#endif
