/* Choices made by the bytes of a fuzz target's input: each byte decides something, so that what
 * libFuzzer learns of coverage guides what is drawn, and an input that failed draws the same again.
 * Bytes that have run out choose the first of everything. */
#ifndef RUGO_TESTS_SUPPORT_FUZZ_CHOICES_H
#define RUGO_TESTS_SUPPORT_FUZZ_CHOICES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct choices {
    const uint8_t *bytes; /* borrowed; those not yet used */
    size_t left;
};

/* Returns one of 0 to count - 1; 0 for a count of 0 or 1, which takes no byte. */
uint64_t choose(struct choices *choices, uint64_t count);
/* Returns whether one of `times` came true; times of at least 2. */
bool choose_rarely(struct choices *choices, unsigned times);
/* Returns a number that lies in [low, high], mostly a plausible one: of few digits, at a bound, or
 * anything between, by logarithms where the range has more than two decades above 0. Bounds may be
 * infinite. */
double choose_number(struct choices *choices, double low, double high);
/* Returns a number that programs stumble over: 0, -0, 1e300, a denormal, 2^31, 2^53, NaN and
 * infinities only where `special` says so. */
double choose_odd_number(struct choices *choices, bool special);

#endif
