/* What fuzz targets share. A target is one file of tests/fuzz/<layer> with LLVMFuzzerTestOneInput;
 * it is linked with libFuzzer (`make fuzz`), or with replay.c, a test that feeds its corpus and
 * changed copies of it. */
#ifndef RUGO_TESTS_SUPPORT_FUZZ_FUZZ_H
#define RUGO_TESTS_SUPPORT_FUZZ_FUZZ_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Takes any bytes; 0. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* What must hold for every input: ends the process where it does not. */
#define MUST(condition)                                                                            \
    do {                                                                                           \
        if (!(condition)) {                                                                        \
            fprintf(stderr, "%s:%d: does not hold: %s\n", __FILE__, __LINE__, #condition);         \
            abort();                                                                               \
        }                                                                                          \
    } while (0)

/* The bytes as a text of their own, NUL behind it. The caller frees. */
static inline char *text_of(const uint8_t *data, size_t size) {
    char *text = malloc(size + 1);
    MUST(text != NULL);
    if (size > 0)
        memcpy(text, data, size);
    text[size] = 0;
    return text;
}

#endif
