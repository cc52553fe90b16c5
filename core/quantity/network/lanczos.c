#include "core/quantity/network/lanczos.h"
#include <math.h>
#include <stdbool.h>

/* Below this no eigenvalue is looked for. */
static const double LEAST = 1e-30;

void lanczos_add(struct lanczos *lanczos, double step, double beta) {
    size_t k = lanczos->count++;
    double last = k > 0 ? lanczos->step : INFINITY;
    lanczos->diagonal[k] = 1 / step + beta / last;
    lanczos->beside[k] = beta / (last * last);
    lanczos->step = step;
}

/* Whether an eigenvalue is below x: whether a pivot of the matrix less x is not positive. */
static bool has_below(const struct lanczos *lanczos, double x) {
    double pivot = 1;
    for (size_t k = 0; k < lanczos->count; k++) {
        pivot = lanczos->diagonal[k] - x - lanczos->beside[k] / pivot;
        if (!(pivot > 0))
            return true;
    }
    return false;
}

double lanczos_least(const struct lanczos *lanczos) {
    double low = 0, high = lanczos->diagonal[0];
    while (high > 1.01 * low && high > LEAST) {
        double middle = low > 0 ? sqrt(low * high) : high / 16;
        *(has_below(lanczos, middle) ? &high : &low) = middle;
    }
    return high;
}
