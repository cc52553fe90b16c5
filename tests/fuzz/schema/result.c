/* Results as JSON: what is read prints, and reads and prints again the same; and as a table. Curves
 * of it as bytes: read back and written again the same. Other bytes are refused, or
 * written as what they mean. Packed bytes likewise, which never take more memory than they may. */
#include "core/file/memory_file.h"
#include "schema/json/json.h"
#include "schema/result/bytes/bytes.h"
#include "schema/result/bytes/curve_bytes.h"
#include "schema/result/bytes/packed_bytes.h"
#include "schema/result/csv.h"
#include "schema/result/result_json.h"
#include "tests/support/fuzz/fuzz.h"

static char *print(const struct case_result *result) {
    struct memory_file memory;
    MUST(memory_file_open(&memory));
    MUST(result_print(memory.file, result));
    char *text = memory_file_close(&memory, NULL);
    MUST(text != NULL);
    return text;
}

static void tabulate(const struct case_result *result) {
    struct memory_file memory;
    MUST(memory_file_open(&memory));
    struct case_result one = *result;
    const struct study_result study = {.case_count = 1, .cases = &one};
    (void)csv_print(memory.file, &study);
    char *text = memory_file_close(&memory, NULL);
    MUST(text != NULL);
    free(text);
}

/* The curve of some bytes as it is written; NULL where they are refused. The caller frees. */
static unsigned char *write_again(const unsigned char *data, size_t size, size_t *length) {
    struct case_result result = {0};
    struct error err = {0};
    unsigned char *again = NULL;
    int status = curves_decode(&result, data, size, &err);
    MUST(status == 0 || status == ERROR_INPUT);
    if (status == 0) {
        MUST(result.curve_count >= 1);
        MUST(curves_encode(result.curves, result.curve_count, &again, length, &err) == 0);
    }
    result_clear(&result);
    return again;
}

/* What was written is written again the same. */
static void cross_curve(const unsigned char *data, size_t size) {
    size_t length = 0;
    unsigned char *again = write_again(data, size, &length);
    MUST(again != NULL && length == size && memcmp(data, again, size) == 0);
    free(again);
}

static void read_text(const uint8_t *data, size_t size) {
    struct case_result result = {0}, again = {0};
    struct error err = {0};
    cJSON *document = NULL, *copy = NULL;
    if (json_parse((const char *)data, size, NULL, &document, &err) == 0 &&
        result_read(document, &result, &err) == 0) {
        char *text = print(&result);
        MUST(json_parse(text, strlen(text), NULL, &copy, &err) == 0);
        MUST(result_read(copy, &again, &err) == 0);
        char *twice = print(&again);
        MUST(strcmp(text, twice) == 0);
        tabulate(&result);
        for (size_t c = 0; c < result.curve_count; c++) {
            unsigned char *bytes = NULL;
            size_t length = 0;
            MUST(curves_encode(&result.curves[c], 1, &bytes, &length, &err) == 0);
            cross_curve(bytes, length);
            free(bytes);
        }
        free(text);
        free(twice);
    }
    result_clear(&result);
    result_clear(&again);
    cJSON_Delete(document);
    cJSON_Delete(copy);
}

/* Any bytes under a checksum made for them. */
static void read_bytes(const uint8_t *data, size_t size) {
    uint64_t hash = hash_bytes(HASH_START, size, data);
    unsigned char *sealed = malloc(size + 8);
    MUST(sealed != NULL);
    memcpy(sealed, data, size);
    for (size_t a = 0; a < 8; a++)
        sealed[size + a] = (unsigned char)(hash >> (8 * a));
    /* Parts that a newer program may have put there are left out. */
    size_t length = 0;
    unsigned char *again = write_again(sealed, size + 8, &length);
    if (again != NULL)
        cross_curve(again, length);
    free(again);
    free(sealed);
}

/* Whatever bytes are packed come back, packed ones too. */
static void cross_packed(const unsigned char *data, size_t size) {
    struct packed_bytes packed, again;
    struct error err = {0};
    MUST(bytes_pack(&packed, data, size, 0, &err) == 0);
    MUST(bytes_unpack(&again, packed.data, packed.size, &err) == 0);
    MUST(again.size == size && (size == 0 || memcmp(again.data, data, size) == 0));
    packed_bytes_clear(&packed);
    packed_bytes_clear(&again);
}

static void read_packed(const uint8_t *data, size_t size) {
    struct packed_bytes bytes = {0};
    struct error err = {0};
    int status = bytes_unpack(&bytes, data, size, &err);
    MUST(status == 0 || status == ERROR_INPUT);
    MUST(status == 0 || err.text[0] != '\0');
    MUST(bytes.owned == NULL || (bytes.size <= PACKED_MOST && bytes.size / 1032 <= size));
    if (status == 0)
        cross_packed(bytes.data, bytes.size);
    packed_bytes_clear(&bytes);
    cross_packed(data, size);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size > 0 && *data == '{')
        read_text(data, size);
    else if (size > 0 && *data == 0xfe)
        read_packed(data, size);
    else if (size > 0)
        read_bytes(data + 1, size - 1);
    return 0;
}
