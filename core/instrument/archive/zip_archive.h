/* A zip archive in memory, whose entries are unpacked in chunks. The stated size of an entry is
 * enforced while it is unpacked, and bounds the memory that a small file can take. Entries may be
 * stored or deflated; encrypted ones and other methods are refused. */
#ifndef RUGO_CORE_INSTRUMENT_ARCHIVE_ZIP_ARCHIVE_H
#define RUGO_CORE_INSTRUMENT_ARCHIVE_ZIP_ARCHIVE_H

#include "core/error.h"
#include <stdbool.h>
#include <stddef.h>

/* Bytes of a chunk: a multiple of the bytes of every record of X3P files (x3p_layout.h). */
enum { ZIP_ARCHIVE_CHUNK = 65520 };
/* An entry may unpack to this many bytes plus 100 times those of the whole file. */
enum { ZIP_ARCHIVE_FREE = 1 << 28 };
enum { ZIP_ARCHIVE_ENTRIES = 10000 }; /* at most */

/* Returns whether a file begins as zip archives do. */
bool zip_archive_begins(const char *data, size_t size);
/* Returns whether its directory names an entry with this ending; takes no memory, and checks
 * nothing else. */
bool zip_archive_names(const char *data, size_t size, const char *ending);

struct zip_archive;
/* data is borrowed until the archive is closed. ERROR_INPUT names the fault. */
int zip_archive_open(struct zip_archive **out, const char *data, size_t size, struct error *err);
void zip_archive_close(struct zip_archive **archive);

size_t zip_archive_entries(const struct zip_archive *archive);
/* Returns the name, borrowed from the bytes of the file; "" where it has none. */
const char *zip_archive_name(const struct zip_archive *archive, size_t entry);
/* Finds an entry by its name; a leading "./" and the kind of slash do not matter. */
bool zip_archive_find(const struct zip_archive *archive, const char *name, size_t *entry);

/* Finds the stated bytes of an entry, and checks them against the bound above. */
int zip_archive_size(struct zip_archive *archive, size_t entry, size_t *size, struct error *err);

/* Takes a chunk of ZIP_ARCHIVE_CHUNK bytes, or fewer at the end. Returns 0 to go on,
 * ZIP_ARCHIVE_ENOUGH to skip the rest of the entry, or an error. */
enum { ZIP_ARCHIVE_ENOUGH = 1 };
typedef int zip_archive_take(void *context, const char *bytes, size_t count, struct error *err);
/* ERROR_INPUT where the entry is damaged (CRC-32) or differs from its stated size; chunks may have
 * been passed on by then. */
int zip_archive_unpack(struct zip_archive *archive, size_t entry, zip_archive_take *take,
                       void *context, struct error *err);
/* Reads all bytes of an entry and appends a NUL; *out is the caller's to free. */
int zip_archive_read(struct zip_archive *archive, size_t entry, char **out, size_t *size,
                     struct error *err);
/* Reads its first bytes, at most *size (in: room; out: number read). The rest is not checked. */
int zip_archive_peek(struct zip_archive *archive, size_t entry, char *first, size_t *size,
                     struct error *err);

#endif
