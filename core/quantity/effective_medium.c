#include "core/quantity/effective_medium.h"
#include "core/vectors.h"
#include <math.h>

enum { LANES = 8, STEPS_MOST = 200 };
static const double TOLERANCE = 1e-12;

/* The sum of (s - s_eff)/(s + s_eff), and minus its derivative by ln s_eff. */
WIDE_VECTORS static double excess(size_t n, const double *s, double effective, double *fall) {
    double sums[LANES] = {0}, falls[LANES] = {0}, sum = 0;
    size_t whole = n / LANES * LANES;
    for (size_t i = 0; i < whole; i += LANES)
        for (size_t a = 0; a < LANES; a++) {
            double part = 1 / (s[i + a] + effective);
            sums[a] += (s[i + a] - effective) * part;
            falls[a] += s[i + a] * effective * part * part;
        }
    for (size_t i = whole; i < n; i++) {
        double part = 1 / (s[i] + effective);
        sums[0] += (s[i] - effective) * part;
        falls[0] += s[i] * effective * part * part;
    }
    *fall = 0;
    for (size_t a = 0; a < LANES; a++) {
        sum += sums[a];
        *fall += 2 * falls[a];
    }
    return sum;
}

/* Newton's steps for ln s_eff; where one leaves the bracket, it is halved. */
double effective_medium(size_t n, const double *s) {
    double least = INFINITY, most = 0;
    size_t closed = 0;
    for (size_t i = 0; i < n; i++) {
        closed += s[i] == 0;
        least = s[i] > 0 && s[i] < least ? s[i] : least;
        most = s[i] > most ? s[i] : most;
    }
    if (2 * closed >= n)
        return 0;
    /* With all free parts at `least` it is that times 1 - 2 closed/n, at least 1/n. */
    double low = log(least) - log(2 * (double)n), high = log(most) + 1, x = (low + high) / 2;
    for (size_t step = 0; step < STEPS_MOST; step++) {
        double fall, sum = excess(n, s, exp(x), &fall), next = x + sum / fall;
        *(sum > 0 ? &low : &high) = x;
        if (!(next >= low && next <= high))
            next = (low + high) / 2;
        if (fabs(next - x) <= TOLERANCE)
            return exp(next);
        x = next;
    }
    return exp(x);
}
