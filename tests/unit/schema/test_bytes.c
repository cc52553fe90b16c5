/* The encoding of partial results: what is written is read back, and no bytes at all can make the
 * reader pass its end or give a number that was not written in its one shortest form. */
#include "schema/result/bytes/bytes.h"
#include "tests/support/seed.h"
#include <float.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static struct byte_reader reader_of(const struct bytes *bytes) {
    const unsigned char *end = bytes->size > 0 ? bytes->data + bytes->size : bytes->data;
    return (struct byte_reader){bytes->data, end, false, false};
}

static void unsigned_round_trip(void **state) {
    (void)state;
    struct bytes bytes = {0};
    for (int shift = 0; shift < 64; shift++)
        for (uint64_t d = 0; d < 3; d++)
            bytes_put_unsigned(&bytes, (UINT64_C(1) << shift) - 1 + d);
    bytes_put_unsigned(&bytes, UINT64_MAX);
    struct byte_reader reader = reader_of(&bytes);
    for (int shift = 0; shift < 64; shift++)
        for (uint64_t d = 0; d < 3; d++)
            assert_true(bytes_get_unsigned(&reader) == (UINT64_C(1) << shift) - 1 + d);
    assert_true(bytes_get_unsigned(&reader) == UINT64_MAX);
    assert_false(reader.failed);
    assert_ptr_equal(reader.at, reader.end);
    bytes_clear(&bytes);
}

/* Both ends of the 128-bit range, and all powers of two between, keep sign and value. */
static void fixed_round_trip(void **state) {
    (void)state;
    struct bytes bytes = {0};
    fixed_point values[3 * 127], lowest = (fixed_point)1 << 126;
    lowest = -lowest - lowest;
    for (int shift = 0; shift < 127; shift++) {
        values[3 * shift] = (fixed_point)1 << shift;
        values[3 * shift + 1] = -((fixed_point)1 << shift);
        values[3 * shift + 2] = lowest + ((fixed_point)1 << shift) - 1;
    }
    for (size_t a = 0; a < 3 * 127; a++)
        bytes_put_fixed(&bytes, values[a]);
    struct byte_reader reader = reader_of(&bytes);
    for (size_t a = 0; a < 3 * 127; a++)
        assert_true(bytes_get_fixed(&reader) == values[a]);
    assert_false(reader.failed);
    bytes_clear(&bytes);
}

static void double_round_trip(void **state) {
    (void)state;
    const double values[] = {0.0, -0.0, 1.5, -DBL_MAX, DBL_TRUE_MIN, INFINITY, NAN};
    struct bytes bytes = {0};
    for (size_t a = 0; a < 7; a++)
        bytes_put_double(&bytes, values[a]);
    assert_int_equal(bytes.size, 56);
    struct byte_reader reader = reader_of(&bytes);
    for (size_t a = 0; a < 7; a++) {
        double value = bytes_get_double(&reader);
        assert_memory_equal(&value, &values[a], sizeof value);
    }
    bytes_clear(&bytes);
}

/* Sparse arrays of every pattern of zeros; a long run of zeros stays short. */
static void counts_round_trip(void **state) {
    (void)state;
    uint64_t seed = seed_or(7), counts[100], read[100];
    for (int pattern = 0; pattern < 500; pattern++) {
        size_t n = (size_t)(next_word(&seed) % 100);
        for (size_t a = 0; a < n; a++)
            counts[a] = next_word(&seed) % 3 == 0 ? next_word(&seed) >> (next_word(&seed) % 64) : 0;
        struct bytes bytes = {0};
        bytes_put_counts(&bytes, n, counts);
        struct byte_reader reader = reader_of(&bytes);
        memset(read, 0, sizeof read);
        bytes_get_counts(&reader, n, read);
        assert_false(reader.failed);
        assert_ptr_equal(reader.at, reader.end);
        assert_true(n == 0 || memcmp(read, counts, n * sizeof *read) == 0);
        bytes_clear(&bytes);
    }
    uint64_t *zeros = calloc(100000, sizeof *zeros);
    struct bytes bytes = {0};
    assert_non_null(zeros);
    bytes_put_counts(&bytes, 100000, zeros);
    assert_true(bytes.size <= 4);
    bytes_clear(&bytes);
    free(zeros);
}

static int get_unsigned_fails(const char *data, size_t size) {
    struct byte_reader reader = {(const unsigned char *)data, (const unsigned char *)data + size,
                                 false, false};
    return bytes_get_unsigned(&reader) == 0 && reader.failed;
}

/* Truncated, overlong and too large numbers; counts that run past their array. */
static void malformed(void **state) {
    (void)state;
    assert_true(get_unsigned_fails("", 0));
    assert_true(get_unsigned_fails("\x80", 1));
    assert_true(get_unsigned_fails("\x80\x00", 2));
    assert_true(get_unsigned_fails("\xff\xff\xff\xff\xff\xff\xff\xff\xff\x02", 10));
    assert_true(get_unsigned_fails("\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\x01", 11));
    const unsigned char past[] = {2, 9, 1}, stuck[] = {0, 0, 0, 0}, zero[] = {1, 1, 0};
    uint64_t counts[4] = {0};
    struct byte_reader reader = {past, past + 3, false, false};
    bytes_get_counts(&reader, 4, counts);
    assert_true(reader.failed);
    reader = (struct byte_reader){stuck, stuck + 4, false, false};
    bytes_get_counts(&reader, 4, counts);
    assert_true(reader.failed);
    reader = (struct byte_reader){zero, zero + 3, false, false};
    bytes_get_counts(&reader, 2, counts);
    assert_true(reader.failed);
}

/* The checksum detects every single damaged bit and every cut. */
static void seal(void **state) {
    (void)state;
    struct bytes bytes = {0};
    for (uint64_t a = 0; a < 40; a++)
        bytes_put_unsigned(&bytes, a * a * a);
    bytes_put_checksum(&bytes);
    assert_false(bytes_open(bytes.data, bytes.size).failed);
    for (size_t bit = 0; bit < 8 * bytes.size; bit++) {
        bytes.data[bit / 8] ^= (unsigned char)(1u << (bit % 8));
        assert_true(bytes_open(bytes.data, bytes.size).failed);
        bytes.data[bit / 8] ^= (unsigned char)(1u << (bit % 8));
    }
    for (size_t size = 0; size < bytes.size; size++)
        assert_true(bytes_open(bytes.data, size).failed);
    bytes_clear(&bytes);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(unsigned_round_trip), cmocka_unit_test(fixed_round_trip),
        cmocka_unit_test(double_round_trip),   cmocka_unit_test(counts_round_trip),
        cmocka_unit_test(malformed),           cmocka_unit_test(seal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
