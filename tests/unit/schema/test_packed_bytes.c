/* Protects: what is packed for the store comes back to the bit; damaged, cut and hostile bytes are
 * refused with a word, before much memory is taken; what older programs stored is read as it is. */
#include "schema/result/bytes/packed_bytes.h"
#include "tests/support/check.h"
#include "tests/support/seed.h"
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#define ZLIB_CONST
#include <zlib.h>

enum { MARK = 4, HEADER = 12, SIZE = 20000 };

/* Doubles of few values, which pack well. */
static unsigned char *doubles(size_t size) {
    unsigned char *data = calloc(1, size + sizeof(double));
    assert_non_null(data);
    for (size_t a = 0; a < size; a += sizeof(double)) {
        double value = 1.0 / (double)(1 + a / 64 % 7);
        memcpy(data + a, &value, sizeof value);
    }
    return data;
}

static void check_same(const unsigned char *data, size_t size, size_t least, bool packs) {
    struct packed_bytes packed, again;
    struct error err = {0};
    assert_int_equal(bytes_pack(&packed, data, size, least, &err), 0);
    assert_int_equal(packed.owned != NULL, packs);
    if (!packs)
        assert_ptr_equal(packed.data, data);
    assert_int_equal(bytes_unpack(&again, packed.data, packed.size, &err), 0);
    assert_int_equal(again.size, size);
    if (size > 0)
        assert_memory_equal(again.data, data, size);
    packed_bytes_clear(&again);
    packed_bytes_clear(&packed);
}

static void bytes_come_back(void **state) {
    (void)state;
    static const size_t SIZES[] = {0, 1, 3, 4, 5, 11, 12, 13, 100, 8191, 8192, SIZE};
    uint64_t random = seed_of_now();
    unsigned char *data = doubles(SIZE), *noise = malloc(SIZE);
    assert_non_null(noise);
    for (size_t a = 0; a < SIZE; a++)
        noise[a] = (unsigned char)(next_word(&random) >> 32);
    for (size_t s = 0; s < sizeof SIZES / sizeof *SIZES; s++) {
        check_same(data, SIZES[s], 8192, SIZES[s] >= 8192);
        check_same(noise, SIZES[s], 0, false); /* not made fewer */
    }
    check_same(NULL, 0, 0, false);
    free(data);
    free(noise);
}

/* Bytes that look like packed ones are packed whatever they are, so that they come back. */
static void packed_bytes_can_be_packed(void **state) {
    (void)state;
    struct packed_bytes packed;
    unsigned char *data = doubles(SIZE);
    assert_int_equal(bytes_pack(&packed, data, SIZE, 0, NULL), 0);
    for (size_t size = MARK; size < packed.size; size += size < 40 ? 1 : 37)
        check_same(packed.data, size, 8192, true);
    packed_bytes_clear(&packed);
    free(data);
}

static void refuse(const unsigned char *data, size_t size) {
    struct packed_bytes out;
    struct error err = {0};
    assert_int_equal(bytes_unpack(&out, data, size, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "damaged"));
    assert_null(out.owned);
}

static void damaged_bytes_are_refused(void **state) {
    (void)state;
    struct packed_bytes packed;
    unsigned char *data = doubles(SIZE);
    assert_int_equal(bytes_pack(&packed, data, SIZE, 0, NULL), 0);
    for (size_t bit = 8 * MARK; bit < 8 * packed.size; bit++) {
        packed.owned[bit / 8] ^= (unsigned char)(1u << bit % 8);
        struct packed_bytes out = {0};
        struct error err = {0};
        int status = bytes_unpack(&out, packed.data, packed.size, &err);
        /* zlib's header has bits that are for the compressor alone: they change no byte */
        if (status == 0)
            assert_true(out.size == SIZE && memcmp(out.data, data, SIZE) == 0);
        else
            assert_int_equal(status, ERROR_INPUT);
        packed_bytes_clear(&out);
        packed.owned[bit / 8] ^= (unsigned char)(1u << bit % 8);
    }
    for (size_t size = MARK; size < packed.size; size++)
        refuse(packed.data, size);
    packed_bytes_clear(&packed);
    free(data);
}

/* Makes packed bytes of zeros that say to be so many; the caller frees. */
static unsigned char *zeros(size_t count, uint64_t said, size_t *size) {
    struct packed_bytes mark;
    unsigned char *data = doubles(SIZE), *none = calloc(1, count);
    uLongf used = compressBound(count);
    unsigned char *out = malloc(HEADER + used);
    assert_non_null(none);
    assert_non_null(out);
    assert_int_equal(bytes_pack(&mark, data, SIZE, 0, NULL), 0);
    memcpy(out, mark.data, MARK);
    for (size_t a = 0; a < 8; a++)
        out[MARK + a] = (unsigned char)(said >> 8 * a);
    assert_int_equal(compress2(out + HEADER, &used, none, count, 9), Z_OK);
    *size = HEADER + used;
    packed_bytes_clear(&mark);
    free(data);
    free(none);
    return out;
}

/* A stream of zeros is a thousandth of them: one that says to be more is refused before memory is
 * taken, one that is more than it says ends there. */
static void bombs_are_refused(void **state) {
    (void)state;
    enum { COUNT = 8 << 20 };
    static const uint64_t SAID[] = {0,        1,         COUNT - 1, COUNT + 1,
                                    16 << 20, 256 << 20, 1u << 31,  UINT64_MAX};
    size_t size = 0;
    for (size_t s = 0; s < sizeof SAID / sizeof *SAID; s++) {
        unsigned char *bomb = zeros(COUNT, SAID[s], &size);
        assert_true(size < COUNT / 1000);
        refuse(bomb, size);
        free(bomb);
    }
    unsigned char *honest = zeros(COUNT, COUNT, &size);
    struct packed_bytes out;
    assert_int_equal(bytes_unpack(&out, honest, size, NULL), 0);
    assert_int_equal(out.size, COUNT);
    packed_bytes_clear(&out);
    unsigned char *longer = calloc(1, size + 1);
    assert_non_null(longer);
    memcpy(longer, honest, size);
    refuse(longer, size + 1); /* something behind the stream */
    free(longer);
    free(honest);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bytes_come_back),
        cmocka_unit_test(packed_bytes_can_be_packed),
        cmocka_unit_test(damaged_bytes_are_refused),
        cmocka_unit_test(bombs_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
