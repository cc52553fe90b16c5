#include "tests/support/fuzz/choices.h"
#include <math.h>

static uint8_t next_byte(struct choices *choices) {
    if (choices->left == 0)
        return 0;
    choices->left--;
    return *choices->bytes++;
}

uint64_t choose(struct choices *choices, uint64_t count) {
    uint64_t word = 0;
    if (count < 2)
        return 0;
    for (uint64_t covered = 1; covered < count && covered < UINT64_C(1) << 56; covered <<= 8)
        word = word << 8 | next_byte(choices);
    return word % count;
}

bool choose_rarely(struct choices *choices, unsigned times) {
    return choose(choices, times) == times - 1;
}

/* A number of the range between share 0 and 1 of it. */
static double between(double low, double high, double share) {
    if (low > 0 && high / low > 100)
        return low * pow(high / low, share);
    return low + (high - low) * share;
}

double choose_number(struct choices *choices, double low, double high) {
    if (isinf(low))
        low = isinf(high) || high > 0 ? -1e6 : 10 * high - 1e6;
    if (isinf(high))
        high = fmax(low + 1, 1e6);
    switch (choose(choices, 8)) {
    case 0: /* a small whole number */
        return fmin(high, fmax(low, ceil(low) + (double)choose(choices, 9)));
    case 1:
        return low;
    case 2:
        return high;
    case 3: /* of any digits */
        return between(low, high, (double)choose(choices, UINT64_C(1) << 32) / 0x1p32);
    case 4: /* the lowest tenth */
        return low + (high - low) * (double)choose(choices, 256) / 2560;
    default: { /* of two digits, in the lower part of the range */
        double number = between(fmax(low, fmin(0.01, high)), fmin(high, fmax(low, 10)),
                                (double)choose(choices, 256) / 255);
        double unit = number != 0 ? pow(10, floor(log10(fabs(number))) - 1) : 1;
        return fmin(high, fmax(low, round(number / unit) * unit));
    }
    }
}

double choose_odd_number(struct choices *choices, bool special) {
    static const double ODD[] = {0,
                                 -0.0,
                                 -1,
                                 1e300,
                                 -1e300,
                                 1e-300,
                                 5e-324,
                                 0x1p31,
                                 0x1p32,
                                 0x1p53,
                                 0x1p53 + 2,
                                 0x1p63,
                                 1e16,
                                 1e-9,
                                 0.1 + 0.2,
                                 1 - 1e-16,
                                 1 + 0x1p-52,
                                 1.7976931348623157e308,
                                 (double)NAN,
                                 (double)INFINITY,
                                 -(double)INFINITY};
    enum { COUNT = sizeof ODD / sizeof *ODD, SPECIAL = 3 };
    return ODD[choose(choices, COUNT - (special ? 0 : SPECIAL))];
}
