/* Where random tests get their seed: from RUGO_SEED, so that a failure can be made again, else from
 * the test. What is printed ("seed N") is what is used. */
#ifndef RUGO_TESTS_SUPPORT_SEED_H
#define RUGO_TESTS_SUPPORT_SEED_H

#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

/* RUGO_SEED where it is set, else `usual`: for tests that draw the same numbers every time. */
static inline uint64_t seed_or(uint64_t usual) {
    const char *text = getenv("RUGO_SEED");
    uint64_t seed = text != NULL ? strtoull(text, NULL, 10) : usual;
    printf("seed %" PRIu64 "\n", seed);
    fflush(stdout);
    return seed;
}

/* The same with the clock: for tests that draw other numbers each time. */
static inline uint64_t seed_of_now(void) {
    return seed_or((uint64_t)time(NULL));
}

/* The next word of a row that begins with any seed, 0 too: splitmix64 (Steele, Lea and Flood 2014).
 */
static inline uint64_t next_word(uint64_t *state) {
    uint64_t word = *state += UINT64_C(0x9e3779b97f4a7c15);
    word = (word ^ (word >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    word = (word ^ (word >> 27)) * UINT64_C(0x94d049bb133111eb);
    return word ^ (word >> 31);
}

#endif
