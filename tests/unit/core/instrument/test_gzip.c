/* Protects: a file in gzip's format is unpacked bit for bit; what is damaged, has several members
 * or states another size than it has is refused, before memory is taken that its bytes cannot fill.
 */
#define ZLIB_CONST
#include "core/instrument/archive/gzip.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { ROOM = 1 << 16 };

/* Writes what gzip makes of the bytes; returns its size. */
static size_t pack(char *out, const char *bytes, size_t size) {
    z_stream stream = {.next_in = (const Bytef *)bytes, .avail_in = (uInt)size};
    stream.next_out = (Bytef *)out;
    stream.avail_out = ROOM;
    assert_int_equal(deflateInit2(&stream, 6, Z_DEFLATED, MAX_WBITS + 16, 8, Z_DEFAULT_STRATEGY),
                     Z_OK);
    assert_int_equal(deflate(&stream, Z_FINISH), Z_STREAM_END);
    assert_int_equal(deflateEnd(&stream), Z_OK);
    return stream.total_out;
}

static void expect_refusal(const char *file, size_t size, const char *words) {
    char *copy = malloc(size > 0 ? size : 1), *out = NULL; /* of its own size, for sanitizers */
    size_t unpacked;
    struct error err = {0};
    assert_non_null(copy);
    memcpy(copy, file, size);
    int status = gzip_unpack(&out, &unpacked, copy, size, &err);
    if (status != ERROR_INPUT || strstr(err.text, words) == NULL || out != NULL)
        fail_msg("status %d, '%s', not '%s'", status, err.text, words);
    free(copy);
}

static void files_come_back(void **state) {
    (void)state;
    static char text[50000], file[ROOM];
    for (size_t c = 0; c < sizeof text; c++)
        text[c] = (char)(c * c % 251); /* zero bytes among them */
    const size_t sizes[] = {0, 1, 1000, sizeof text};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        char *out = NULL;
        size_t size = pack(file, text, sizes[s]), unpacked = 0;
        struct error err = {0};
        assert_true(gzip_begins(file, size));
        assert_int_equal(gzip_unpack(&out, &unpacked, file, size, &err), 0);
        assert_int_equal(unpacked, sizes[s]);
        assert_memory_equal(out, text, unpacked);
        assert_true(out[unpacked] == '\0');
        free(out);
    }
    assert_false(gzip_begins("\x1f", 1) || gzip_begins("PK", 2));
}

static void damage_is_refused(void **state) {
    (void)state;
    static const char text[] = "0 1\n1 3\n2 2\n3 5\n4 4\n5 1\n6 2\n7 2\n";
    static char file[2 * ROOM];
    const size_t size = pack(file, text, sizeof text - 1);
    for (size_t at = 0; at < size; at++)
        expect_refusal(file, at, "gzip: ");
    /* The method, the data and the check follow; the time and the system in the header are free. */
    for (size_t at = 10; at < size; at++) {
        file[at] = (char)(file[at] ^ 0x41);
        expect_refusal(file, size, "gzip: ");
        file[at] = (char)(file[at] ^ 0x41);
    }
    memcpy(file + size, file, size);
    expect_refusal(file, 2 * size, "allowed: one whole member");
}

/* 4 GB that 60 bytes state are not asked for: the bound is that of deflate. */
static void stated_sizes_are_bounded(void **state) {
    (void)state;
    static char file[ROOM];
    const size_t size = pack(file, "1 2\n", 4);
    memset(file + size - 4, 0xff, 4);
    expect_refusal(file, size, "bytes cannot hold the size that they state");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_come_back),
        cmocka_unit_test(damage_is_refused),
        cmocka_unit_test(stated_sizes_are_bounded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
