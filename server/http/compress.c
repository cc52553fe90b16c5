#include "server/http/compress.h"
#include "core/error.h"
#include "server/http/accept.h"
#include <stdlib.h>
#define ZLIB_CONST /* input is const */
#include <zlib.h>

enum {
    LEVEL = 4,       /* of 9: half the time of the usual 6 for a twentieth more bytes */
    GZIP = 16 + 15,  /* asks zlib for gzip's header and the largest window */
    MEMORY = 8,      /* zlib's default */
    PART = 32 * 1024 /* bytes read at a time */
};

bool compress_is_accepted(const char *accept_encoding) {
    return accept_encoding != NULL && accept_quality(accept_encoding, "gzip") > 0;
}

static bool begin(z_stream *stream) {
    return deflateInit2(stream, LEVEL, Z_DEFLATED, GZIP, MEMORY, Z_DEFAULT_STRATEGY) == Z_OK;
}

char *compress_text(const char *text, size_t size, size_t *compressed) {
    z_stream stream = {.next_in = (const Bytef *)text, .avail_in = (uInt)size};
    if (size > UINT32_MAX / 2 || !begin(&stream))
        return NULL;
    uLong bound = deflateBound(&stream, (uLong)size);
    char *out = malloc(bound);
    stream.next_out = (Bytef *)out;
    stream.avail_out = (uInt)bound;
    bool done = out != NULL && deflate(&stream, Z_FINISH) == Z_STREAM_END;
    *compressed = stream.total_out;
    deflateEnd(&stream);
    if (done)
        return out;
    free(out);
    return NULL;
}

struct compressor {
    MHD_ContentReaderCallback read;
    void *context; /* owned by way of free_context */
    MHD_ContentReaderFreeCallback free_context;
    uint64_t position; /* bytes read so far */
    z_stream stream;
    bool at_end; /* all is read */
    bool done;   /* all is written */
    char part[PART];
};

struct compressor *compressor_create(MHD_ContentReaderCallback read, void *context,
                                     MHD_ContentReaderFreeCallback free_context) {
    struct compressor *compressor = array_create(1, sizeof *compressor);
    if (compressor == NULL || !begin(&compressor->stream)) {
        free(compressor);
        return NULL;
    }
    compressor->read = read;
    compressor->context = context;
    compressor->free_context = free_context;
    return compressor;
}

void compressor_free(void *context) {
    struct compressor *compressor = context;
    deflateEnd(&compressor->stream);
    compressor->free_context(compressor->context);
    free(compressor);
}

/* Reads one more part; false after an error, which cuts the answer off as without compression. */
static bool read_part(struct compressor *compressor) {
    ssize_t got =
        compressor->read(compressor->context, compressor->position, compressor->part, PART);
    if (got == MHD_CONTENT_READER_END_WITH_ERROR)
        return false;
    compressor->at_end = got == MHD_CONTENT_READER_END_OF_STREAM;
    size_t size = compressor->at_end ? 0 : (size_t)got;
    compressor->position += size;
    compressor->stream.next_in = (const Bytef *)compressor->part;
    compressor->stream.avail_in = (uInt)size;
    return true;
}

ssize_t compressor_read(void *context, uint64_t position, char *buffer, size_t room) {
    struct compressor *compressor = context;
    z_stream *stream = &compressor->stream;
    (void)position;
    if (compressor->done)
        return MHD_CONTENT_READER_END_OF_STREAM;
    uInt size = room < PART ? (uInt)room : (uInt)PART;
    stream->next_out = (Bytef *)buffer;
    stream->avail_out = size;
    while (stream->avail_out == size && !compressor->done) {
        if (stream->avail_in == 0 && !compressor->at_end && !read_part(compressor))
            return MHD_CONTENT_READER_END_WITH_ERROR;
        int status = deflate(stream, compressor->at_end ? Z_FINISH : Z_NO_FLUSH);
        compressor->done = status == Z_STREAM_END;
        if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR)
            return MHD_CONTENT_READER_END_WITH_ERROR;
    }
    return (ssize_t)(size - stream->avail_out);
}
