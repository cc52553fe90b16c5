#include "core/contact/solver/lines.h"
#include <stdbool.h>
#include <string.h>

/* Two nodes in contact of a profile with `apart` - 1 open nodes between them, also across the ends
 * of the cell. */
struct neighbours {
    size_t from, to, apart;
};

/* Returns the first node of the set r != 0; n where there is none. */
static size_t first_of(size_t n, const double *r) {
    size_t i = 0;
    while (i < n && r[i] == 0)
        i++;
    return i;
}

/* Advances to the next pair of a walk once around the cell, which begins with from = to = first_of.
 * Returns false when the walk is back at its start. */
static bool next_neighbours(size_t n, const double *r, size_t first, struct neighbours *pair) {
    size_t i = pair->to;
    if (pair->apart > 0 && i == first)
        return false;
    pair->from = i;
    pair->apart = 0;
    do {
        i = i + 1 < n ? i + 1 : 0;
        pair->apart++;
    } while (r[i] == 0);
    pair->to = i;
    return true;
}

void lines_continue(size_t n, const double *r, double *out) {
    size_t first = first_of(n, r);
    struct neighbours pair = {first, first, 0};
    memcpy(out, r, n * sizeof *out);
    while (first < n && next_neighbours(n, r, first, &pair)) {
        double slope = (r[pair.to] - r[pair.from]) / (double)pair.apart;
        for (size_t a = 1, i = pair.from; a < pair.apart; a++) {
            i = i + 1 < n ? i + 1 : 0;
            out[i] = r[pair.from] + slope * (double)a;
        }
    }
}

void lines_transpose(size_t n, const double *r, double *w) {
    size_t first = first_of(n, r);
    struct neighbours pair = {first, first, 0};
    while (first < n && next_neighbours(n, r, first, &pair)) {
        double sum = 0, moment = 0;
        for (size_t a = 1, i = pair.from; a < pair.apart; a++) {
            i = i + 1 < n ? i + 1 : 0;
            sum += w[i];
            moment += w[i] * (double)a;
        }
        moment /= (double)pair.apart;
        w[pair.to] += moment;
        w[pair.from] += sum - moment;
    }
}
