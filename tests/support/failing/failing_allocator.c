#include "tests/support/failing/failing_allocator.h"
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include <unistd.h>

/* The allocator behind the hook: the sanitizer's, where there is one. */
#ifdef RUGO_SANITIZED
#define BEHIND(name) __interceptor_##name
#else
#define BEHIND(name) __libc_##name
#endif
void *BEHIND(malloc)(size_t size);
void *BEHIND(calloc)(size_t count, size_t size);
void *BEHIND(realloc)(void *memory, size_t size);

/* So that the libraries find them too. */
#define EXPORTED __attribute__((visibility("default")))
/* Asked before a sanitizer has set itself up. */
#define UNCHECKED __attribute__((no_sanitize("address", "thread", "undefined")))

enum { FRAMES_MOST = 48 };
static struct {
    atomic_bool armed;
    atomic_uint_fast64_t asked, failed;
    uint64_t first, most;      /* changed only while not armed */
    void *frames[FRAMES_MOST]; /* of the first failure */
    int frame_count;
} failing;

UNCHECKED static bool fails(void) {
    if (!atomic_load(&failing.armed))
        return false;
    uint64_t n = atomic_fetch_add(&failing.asked, 1);
    if (n < failing.first || n - failing.first >= failing.most)
        return false;
    if (atomic_fetch_add(&failing.failed, 1) == 0)
        failing.frame_count = backtrace(failing.frames, FRAMES_MOST);
    errno = ENOMEM;
    return true;
}

/* Of the leak checker, where there is one. */
__attribute__((weak)) void __lsan_disable(void);
__attribute__((weak)) void __lsan_enable(void);

/* The first call of backtrace loads a library, whose memory stays. */
static void prepare_backtrace(void) {
    if (__lsan_disable != NULL)
        __lsan_disable();
    failing.frame_count = backtrace(failing.frames, 1);
    if (__lsan_enable != NULL)
        __lsan_enable();
}

void failing_arm(uint64_t first, uint64_t most) {
    prepare_backtrace();
    failing.first = first;
    failing.most = most;
    atomic_store(&failing.asked, 0);
    atomic_store(&failing.failed, 0);
    atomic_store(&failing.armed, true);
}

struct failing_count failing_disarm(void) {
    atomic_store(&failing.armed, false);
    return (struct failing_count){atomic_load(&failing.asked), atomic_load(&failing.failed)};
}

void failing_where(void) {
    backtrace_symbols_fd(failing.frames, failing.frame_count, STDERR_FILENO);
}

EXPORTED UNCHECKED void *malloc(size_t size) {
    return fails() ? NULL : BEHIND(malloc)(size);
}

EXPORTED UNCHECKED void *calloc(size_t nmemb, size_t size) {
    return fails() ? NULL : BEHIND(calloc)(nmemb, size);
}

EXPORTED UNCHECKED void *realloc(void *ptr, size_t size) {
    /* A size of 0 frees, which cannot fail. */
    return (ptr == NULL || size > 0) && fails() ? NULL : BEHIND(realloc)(ptr, size);
}

void *fftw_malloc(size_t size);
EXPORTED void *fftw_malloc(size_t size) {
    static void *(*real)(size_t size);
    if (real == NULL)
        *(void **)&real = dlsym(RTLD_NEXT, "fftw_malloc");
    return real == NULL || fails() ? NULL : real(size);
}
