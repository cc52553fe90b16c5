#include "core/instrument/archive/zip_archive.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <zip.h>
#include <zlib.h>

struct zip_archive {
    zip_t *zip;    /* owned */
    uint64_t most; /* largest size of an unpacked entry */
};

bool zip_archive_begins(const char *data, size_t size) {
    return size >= 4 && (memcmp(data, "PK\x03\x04", 4) == 0 || memcmp(data, "PK\x05\x06", 4) == 0);
}

bool zip_archive_names(const char *data, size_t size, const char *ending) {
    enum { LENGTH = 28, NAME = 46 }; /* their offsets in a record of the directory */
    const char *end = data + size, *at = data;
    size_t tail = strlen(ending);
    while ((at = memmem(at, (size_t)(end - at), "PK\x01\x02", 4)) != NULL && end - at > NAME) {
        size_t length = (unsigned char)at[LENGTH] | (size_t)(unsigned char)at[LENGTH + 1] << 8;
        if (length >= tail && length <= (size_t)(end - at) - NAME &&
            memcmp(at + NAME + length - tail, ending, tail) == 0)
            return true;
        at++;
    }
    return false;
}

/* Returns whether libzip has run out of memory, which it sometimes reports as no error, or as one
 * of zlib. */
static bool is_memory(const zip_error_t *fault) {
    int code = zip_error_code_zip(fault);
    return code == ZIP_ER_MEMORY || code == ZIP_ER_OK ||
           (code == ZIP_ER_ZLIB && zip_error_code_system(fault) == Z_MEM_ERROR);
}

/* Reports libzip's fault of the archive or of an entry. */
static int refuse(zip_error_t *fault, const char *name, struct error *err) {
    if (is_memory(fault))
        return error_set(err, ERROR_MEMORY, "cannot allocate memory for a zip archive");
    return error_set(err, ERROR_INPUT, "%s is damaged: %s", name, zip_error_strerror(fault));
}

int zip_archive_open(struct zip_archive **out, const char *data, size_t size, struct error *err) {
    zip_error_t fault;
    struct zip_archive *archive = array_create(1, sizeof *archive);
    if (archive == NULL)
        return error_memory(err, sizeof *archive, "a zip archive");
    zip_error_init(&fault);
    zip_source_t *source = zip_source_buffer_create(data, size, 0, &fault);
    if (source != NULL)
        archive->zip = zip_open_from_source(source, ZIP_RDONLY, &fault);
    if (archive->zip == NULL) {
        zip_source_free(source);
        free(archive);
        int status = refuse(&fault, "the zip archive", err);
        zip_error_fini(&fault);
        return status;
    }
    zip_error_fini(&fault);
    archive->most = ZIP_ARCHIVE_FREE + (uint64_t)size * 100;
    *out = archive;
    size_t entries = zip_archive_entries(archive);
    if (entries <= ZIP_ARCHIVE_ENTRIES)
        return 0;
    zip_archive_close(out);
    return error_set(err, ERROR_INPUT, "the zip archive holds %zu files; allowed: at most %d",
                     entries, ZIP_ARCHIVE_ENTRIES);
}

void zip_archive_close(struct zip_archive **archive) {
    if (*archive == NULL)
        return;
    zip_discard((*archive)->zip);
    free(*archive);
    *archive = NULL;
}

size_t zip_archive_entries(const struct zip_archive *archive) {
    zip_int64_t count = zip_get_num_entries(archive->zip, 0);
    return count > 0 ? (size_t)count : 0;
}

const char *zip_archive_name(const struct zip_archive *archive, size_t entry) {
    const char *name = zip_get_name(archive->zip, entry, ZIP_FL_ENC_RAW);
    return name != NULL ? name : "";
}

static char slashed(char character) {
    return character == '\\' ? '/' : character;
}

static bool same_name(const char *a, const char *b) {
    a += strncmp(a, "./", 2) == 0 ? 2 : 0;
    b += strncmp(b, "./", 2) == 0 ? 2 : 0;
    while (*a != '\0' && slashed(*a) == slashed(*b)) {
        a++;
        b++;
    }
    return *a == *b;
}

bool zip_archive_find(const struct zip_archive *archive, const char *name, size_t *entry) {
    size_t count = zip_archive_entries(archive);
    for (size_t at = 0; at < count; at++)
        if (same_name(zip_archive_name(archive, at), name)) {
            *entry = at;
            return true;
        }
    return false;
}

int zip_archive_size(struct zip_archive *archive, size_t entry, size_t *size, struct error *err) {
    const zip_uint64_t needed = ZIP_STAT_SIZE | ZIP_STAT_COMP_METHOD | ZIP_STAT_ENCRYPTION_METHOD;
    const char *name = zip_archive_name(archive, entry);
    zip_stat_t stat;
    zip_stat_init(&stat);
    if (zip_stat_index(archive->zip, entry, 0, &stat) != 0 || (stat.valid & needed) != needed)
        return error_set(err, ERROR_INPUT, "the zip archive is damaged at its entry %s", name);
    if (stat.encryption_method != ZIP_EM_NONE)
        return error_set(err, ERROR_INPUT, "%s is encrypted, which is not read", name);
    if (stat.comp_method != ZIP_CM_STORE && stat.comp_method != ZIP_CM_DEFLATE)
        return error_set(
            err, ERROR_INPUT,
            "%s is compressed by method %u of zip; allowed: stored (0) and deflated (8)", name,
            (unsigned)stat.comp_method);
    if (stat.size > archive->most)
        return error_set(
            err, ERROR_INPUT,
            "%s says that it unpacks to %llu bytes; allowed: %llu, which is 256 MiB and "
            "100 times the file",
            name, (unsigned long long)stat.size, (unsigned long long)archive->most);
    *size = (size_t)stat.size;
    return 0;
}

/* Fills a chunk as far as the entry goes; *count below ZIP_ARCHIVE_CHUNK: its end. */
static int read_chunk(zip_file_t *file, const char *name, char *chunk, size_t *count,
                      struct error *err) {
    *count = 0;
    while (*count < ZIP_ARCHIVE_CHUNK) {
        zip_int64_t got = zip_fread(file, chunk + *count, ZIP_ARCHIVE_CHUNK - *count);
        if (got < 0)
            return refuse(zip_file_get_error(file), name, err);
        if (got == 0)
            break;
        *count += (size_t)got;
    }
    return 0;
}

/* Passes the chunks of an open entry to take. */
static int unpack_chunks(zip_file_t *file, const char *name, size_t size, zip_archive_take *take,
                         void *context, struct error *err) {
    char chunk[ZIP_ARCHIVE_CHUNK];
    size_t taken = 0, count = ZIP_ARCHIVE_CHUNK;
    while (count == ZIP_ARCHIVE_CHUNK) {
        int status = read_chunk(file, name, chunk, &count, err);
        if (status != 0)
            return status;
        if (count > size - taken)
            return error_set(err, ERROR_INPUT, "%s has more than the %zu bytes that it says", name,
                             size);
        taken += count;
        status = count > 0 ? take(context, chunk, count, err) : 0;
        if (status != 0)
            return status == ZIP_ARCHIVE_ENOUGH ? 0 : status;
    }
    if (taken != size)
        return error_set(err, ERROR_INPUT, "%s has %zu bytes and says that it has %zu", name, taken,
                         size);
    return 0;
}

int zip_archive_unpack(struct zip_archive *archive, size_t entry, zip_archive_take *take,
                       void *context, struct error *err) {
    size_t size = 0;
    int status = zip_archive_size(archive, entry, &size, err);
    if (status != 0)
        return status;
    zip_file_t *file = zip_fopen_index(archive->zip, entry, 0);
    if (file == NULL)
        return refuse(zip_get_error(archive->zip), zip_archive_name(archive, entry), err);
    status = unpack_chunks(file, zip_archive_name(archive, entry), size, take, context, err);
    zip_fclose(file);
    return status;
}

struct bytes {
    char *to;
    size_t room, count;
};

static int take_bytes(void *context, const char *bytes, size_t count, struct error *err) {
    (void)err;
    struct bytes *taken = context;
    size_t left = taken->room - taken->count;
    memcpy(taken->to + taken->count, bytes, count < left ? count : left);
    taken->count += count < left ? count : left;
    return taken->count == taken->room ? ZIP_ARCHIVE_ENOUGH : 0;
}

int zip_archive_peek(struct zip_archive *archive, size_t entry, char *first, size_t *size,
                     struct error *err) {
    struct bytes taken = {first, *size, 0};
    int status = zip_archive_unpack(archive, entry, take_bytes, &taken, err);
    *size = taken.count;
    return status;
}

int zip_archive_read(struct zip_archive *archive, size_t entry, char **out, size_t *size,
                     struct error *err) {
    struct bytes taken = {0};
    int status = zip_archive_size(archive, entry, size, err);
    if (status != 0)
        return status;
    /* One byte more than stated, so that the end of the entry is read and its CRC checked. */
    taken.room = *size + 1;
    taken.to = array_create(taken.room, 1);
    if (taken.to == NULL)
        return error_memory(err, taken.room, "an entry of a zip archive");
    status = zip_archive_unpack(archive, entry, take_bytes, &taken, err);
    if (status == 0)
        *out = taken.to;
    else
        free(taken.to);
    return status;
}
