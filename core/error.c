#include "core/error.h"
#include "core/file/plain_text.h"
#include "core/file/point_locale.h"
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

/* Bytes of an array from which on it is given huge pages. */
#define LARGE ((size_t)8 << 20)

/* As vsnprintf, with a decimal point. */
static int print_text(char *to, size_t size, const char *format, va_list arguments) {
    locale_t before = point_locale_begin(); /* without memory for it, a comma is no harm */
    int length = vsnprintf(to, size, format, arguments);
    point_locale_end(before);
    return length;
}

void error_fill(struct error *err, int code, const char *format, ...) {
    if (err == NULL)
        return;
    va_list arguments;
    va_start(arguments, format);
    err->code = code;
    print_text(err->text, sizeof err->text, format, arguments);
    va_end(arguments);
    text_make_plain(err->text);
}

int error_context(struct error *err, const char *format, ...) {
    if (err == NULL)
        return ERROR_SYSTEM;
    char context[sizeof err->text];
    va_list arguments;
    va_start(arguments, format);
    int length = print_text(context, sizeof context - 2, format, arguments);
    va_end(arguments);
    if (length < 0)
        return err->code;
    size_t head = strlen(context);
    memcpy(context + head, ": ", 3);
    head += 2;
    /* The first text names the fault: where both do not fit, the context is shortened. */
    size_t tail = strlen(err->text);
    size_t room = sizeof err->text - 1;
    if (head + tail > room)
        head = tail < room ? room - tail : 0;
    memmove(err->text + head, err->text, tail + 1);
    memcpy(err->text, context, head);
    text_make_plain(err->text);
    return err->code;
}

/* Columns of a large spectrum are pages apart: huge pages keep their addresses at hand. */
static void use_huge_pages(void *memory, size_t bytes) {
    const size_t HUGE_PAGE = (size_t)1 << 21;
    size_t skip = (HUGE_PAGE - (uintptr_t)memory % HUGE_PAGE) % HUGE_PAGE;
    size_t length = bytes > skip ? (bytes - skip) / HUGE_PAGE * HUGE_PAGE : 0;
    if (length > 0) /* where the system has none, nothing changes */
        madvise((char *)memory + skip, length, MADV_HUGEPAGE);
}

void *array_create(size_t count, size_t size) {
    if (size != 0 && count > SIZE_MAX / size)
        return NULL;
    void *memory = calloc(count != 0 ? count : 1, size != 0 ? size : 1);
    if (memory != NULL && size != 0 && count >= LARGE / size)
        use_huge_pages(memory, count * size);
    return memory;
}
