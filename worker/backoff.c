#include "worker/backoff.h"

#include <sys/random.h>

enum { PAUSE_FIRST_MS = 50 };

int64_t backoff_next(struct backoff *backoff, int64_t most_ms) {
    int64_t pause = backoff->ms != 0 ? 2 * backoff->ms : PAUSE_FIRST_MS;
    backoff->ms = pause < most_ms ? pause : most_ms;
    uint32_t word = 0;
    if (getrandom(&word, sizeof word, GRND_NONBLOCK) != (ssize_t)sizeof word)
        word = 0; /* no jitter then */
    return backoff->ms / 2 + (backoff->ms / 2) * (int64_t)word / UINT32_MAX;
}
