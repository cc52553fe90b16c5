/* Errors as values.
 *
 * Every fallible function returns an int: 0, or one of the negative codes below. With a code it has
 * filled the caller's struct error with a sentence that names the thing at fault, its value and
 * what is allowed. In this sentence, characters that a terminal would obey are replaced by '?'.
 * Callers either handle the error or return it, with a word of context put in front.
 *
 * After a failure, unless a function says otherwise: *out of a constructor is NULL or untouched,
 * and nothing has to be destroyed; outputs that are filled in place are undefined; the objects that
 * were passed in can be used again. */
#ifndef RUGO_CORE_ERROR_H
#define RUGO_CORE_ERROR_H

#include <stddef.h>

enum {
    ERROR_INPUT = -1,   /* the user's input is wrong; trying again will not help */
    ERROR_MEMORY = -2,  /* an allocation failed */
    ERROR_SYSTEM = -3,  /* a file, the network, the operating system */
    ERROR_NUMERIC = -4, /* no result of the required accuracy: no convergence, out of domain */
    ERROR_STATE = -5, /* refused by the state of a study, a job or an object: a call out of order */
    ERROR_ABSENT = -6,  /* no such study, job or case */
    ERROR_STOPPED = -7, /* asked to stop; nothing is wrong */
    ERROR_LIMIT = -8,   /* a limit of this process, as of the length of its files: it stays */
};

struct error {
    int code; /* 0 or a code above */
    char text[480];
};

/* Fills err (which may be NULL). The value is code, a constant at the call, so that readers and
 * analysers see that it is not 0. */
#define error_set(err, code, ...) (error_fill((err), (code), __VA_ARGS__), error_code(code))
static inline int error_code(int code) {
    return code;
}
__attribute__((format(printf, 3, 4))) void error_fill(struct error *err, int code,
                                                      const char *format, ...);
/* Puts "context: " in front of the text of err; returns err->code, ERROR_SYSTEM where
 * err is NULL. */
__attribute__((format(printf, 2, 3))) int error_context(struct error *err, const char *format, ...);
/* "cannot allocate N bytes for WHAT"; its value is ERROR_MEMORY. */
#define error_memory(err, bytes, what)                                                             \
    error_set(err, ERROR_MEMORY, "cannot allocate %zu bytes for %s", (size_t)(bytes), (what))

/* malloc of count * size bytes, zeroed; NULL when out of memory or when the product overflows. */
void *array_create(size_t count, size_t size);

#endif
