/* Arms the hook of a whole program by RUGO_FAIL_ALLOCATION=FIRST,MOST. At the end of the process
 * the number of allocations asked for, and of those that failed, goes to the file
 * RUGO_COUNT_ALLOCATIONS. */
#include "tests/support/failing/failing_allocator.h"
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

__attribute__((constructor)) static void arm(void) {
    const char *wish = getenv("RUGO_FAIL_ALLOCATION");
    const char *most = wish != NULL ? strchr(wish, ',') : NULL;
    if (most != NULL)
        failing_arm(strtoull(wish, NULL, 10), strtoull(most + 1, NULL, 10));
}

__attribute__((destructor)) static void tell(void) {
    const char *path = getenv("RUGO_COUNT_ALLOCATIONS");
    struct failing_count count = failing_disarm();
    int file = path != NULL ? open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600) : -1;
    char text[64];
    int length =
        snprintf(text, sizeof text, "%" PRIu64 " %" PRIu64 "\n", count.asked, count.failed);
    if (file >= 0 && write(file, text, (size_t)length) != length)
        perror(path);
    if (file >= 0)
        close(file);
}
