#include "tests/support/failing/failing_writes.h"
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#define EXPORTED __attribute__((visibility("default")))

static struct failing_writes *wish; /* set before main */

__attribute__((constructor)) static void map_wish(void) {
    const char *path = getenv("RUGO_FAIL_WRITES");
    int file = path != NULL ? open(path, O_RDWR | O_CLOEXEC) : -1;
    if (file < 0)
        return;
    void *memory = mmap(NULL, sizeof *wish, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    close(file);
    wish = memory != MAP_FAILED ? memory : NULL;
}

/* Decides by the number of the call, of which every bit counts (Knuth's multiplicative hash,
 * twice); sockets and pipes are left alone. */
static bool fails(int file) {
    struct stat about;
    if (wish == NULL || atomic_load(&wish->per_million) == 0 || fstat(file, &about) != 0 ||
        !S_ISREG(about.st_mode))
        return false;
    uint32_t word = atomic_fetch_add(&wish->calls, 1) * UINT32_C(2654435769);
    word = (word ^ (word >> 15)) * UINT32_C(2654435769);
    if ((word >> 8) % 1000000 >= atomic_load(&wish->per_million))
        return false;
    atomic_fetch_add(&wish->failed, 1);
    errno = atomic_load(&wish->error);
    return true;
}

/* The function of that name behind this library. */
#define BEHIND(function, name)                                                                     \
    do {                                                                                           \
        if ((function) == NULL)                                                                    \
            *(void **)&(function) = dlsym(RTLD_NEXT, name);                                        \
    } while (false)

EXPORTED ssize_t write(int fd, const void *buf, size_t n) {
    static ssize_t (*real)(int, const void *, size_t);
    BEHIND(real, "write");
    return fails(fd) ? -1 : real(fd, buf, n);
}

EXPORTED ssize_t pwrite(int fd, const void *buf, size_t n, off_t offset) {
    static ssize_t (*real)(int, const void *, size_t, off_t);
    BEHIND(real, "pwrite");
    return fails(fd) ? -1 : real(fd, buf, n, offset);
}

EXPORTED ssize_t pwrite64(int fd, const void *buf, size_t n, off64_t offset) {
    static ssize_t (*real)(int, const void *, size_t, off64_t);
    BEHIND(real, "pwrite64");
    return fails(fd) ? -1 : real(fd, buf, n, offset);
}

EXPORTED int fsync(int fd) {
    static int (*real)(int);
    BEHIND(real, "fsync");
    return fails(fd) ? -1 : real(fd);
}

EXPORTED int fdatasync(int fildes) {
    static int (*real)(int);
    BEHIND(real, "fdatasync");
    return fails(fildes) ? -1 : real(fildes);
}

EXPORTED int ftruncate(int fd, off_t length) {
    static int (*real)(int, off_t);
    BEHIND(real, "ftruncate");
    return fails(fd) ? -1 : real(fd, length);
}

EXPORTED int ftruncate64(int fd, off64_t length) {
    static int (*real)(int, off64_t);
    BEHIND(real, "ftruncate64");
    return fails(fd) ? -1 : real(fd, length);
}
