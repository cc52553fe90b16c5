/* Zip archives made in memory, for tests of what reads them; a failure fails the test. */
#ifndef RUGO_TESTS_SUPPORT_ZIP_FILE_H
#define RUGO_TESTS_SUPPORT_ZIP_FILE_H

#include <stdbool.h>
#include <stddef.h>

struct zip_part {
    const char *name;
    const void *data;
    size_t size;
    bool stored; /* else deflated */
};

/* Packs parts as an archive of *size bytes, a NUL behind them; the caller frees. */
char *zip_file_create(const struct zip_part *parts, size_t count, size_t *size);

/* Where the 4 bytes of a number stand in the central directory, of the entry of this name. */
enum zip_number { ZIP_CRC = 16, ZIP_PACKED = 20, ZIP_UNPACKED = 24 };
char *zip_file_number(char *archive, size_t size, const char *name, enum zip_number which);

#endif
