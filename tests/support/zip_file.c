#include "tests/support/zip_file.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <zip.h>

#include <cmocka.h>

static void add(zip_t *zip, const struct zip_part *part) {
    zip_source_t *source = zip_source_buffer(zip, part->data, part->size, 0);
    assert_non_null(source);
    zip_int64_t entry = zip_file_add(zip, part->name, source, ZIP_FL_ENC_UTF_8);
    assert_true(entry >= 0);
    assert_int_equal(zip_set_file_compression(zip, (zip_uint64_t)entry,
                                              part->stored ? ZIP_CM_STORE : ZIP_CM_DEFLATE, 1),
                     0);
}

char *zip_file_create(const struct zip_part *parts, size_t count, size_t *size) {
    zip_error_t fault;
    zip_stat_t stat;
    zip_error_init(&fault);
    zip_source_t *source = zip_source_buffer_create(NULL, 0, 0, &fault);
    assert_non_null(source);
    zip_source_keep(source);
    zip_t *zip = zip_open_from_source(source, ZIP_TRUNCATE, &fault);
    assert_non_null(zip);
    for (size_t part = 0; part < count; part++)
        add(zip, &parts[part]);
    assert_int_equal(zip_close(zip), 0);
    zip_stat_init(&stat);
    assert_int_equal(zip_source_stat(source, &stat), 0);
    *size = (size_t)stat.size;
    char *out = calloc(*size + 1, 1);
    assert_non_null(out);
    assert_int_equal(zip_source_open(source), 0);
    assert_int_equal(zip_source_read(source, out, *size), *size);
    zip_source_close(source);
    zip_source_free(source);
    zip_error_fini(&fault);
    return out;
}

char *zip_file_number(char *archive, size_t size, const char *name, enum zip_number which) {
    const size_t fixed = 46, length = strlen(name);
    for (char *at = archive; at + fixed + length <= archive + size; at++)
        if (memcmp(at, "PK\x01\x02", 4) == 0 && memcmp(at + fixed, name, length) == 0)
            return at + which;
    fail_msg("the archive holds no %s", name);
    return NULL;
}
