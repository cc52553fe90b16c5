#include "core/full/linear/aliasing.h"
#include <string.h>

size_t aliasing_below(const struct level *above, size_t wave, bool *mirrored) {
    const struct level *below = above + 1;
    size_t mx = wave / above->ny, row = wave % above->ny;
    *mirrored = mx > below->nx / 2;
    if (*mirrored) {
        mx = below->nx - mx;
        row = above->ny - row;
    }
    return mx * below->ny + row % below->ny;
}

void aliasing_unfold(const struct level *above, size_t components, const double *below,
                     double *out) {
    size_t n = level_waves(above), wide = level_waves(above + 1);
    bool mirrored;
    for (size_t i = 0; i < components; i++) {
        const double *from = below + 2 * i * wide;
        double *to = out + 2 * i * n, sign = i + 1 == components ? 1 : -1;
        for (size_t wave = 0; wave < n; wave++) {
            size_t alias = aliasing_below(above, wave, &mirrored);
            to[wave] = from[alias] * (mirrored ? sign : 1);
            to[n + wave] = from[wide + alias] * (mirrored ? -sign : 1);
        }
    }
}

/* A wave with 2 mx = level->nx has an alias in either half plane, and is added to both. */
void aliasing_fold(const struct level *above, size_t components, const double *field,
                   double *below) {
    const struct level *level = above + 1;
    size_t n = level_waves(above), wide = level_waves(level);
    memset(below, 0, 2 * components * wide * sizeof *below);
    for (size_t i = 0; i < components; i++) {
        const double *from = field + 2 * i * n;
        double *to = below + 2 * i * wide, sign = i + 1 == components ? 1 : -1;
        for (size_t wave = 0; wave < n; wave++) {
            size_t mx = wave / above->ny, row = wave % above->ny;
            if (2 * mx <= level->nx) {
                size_t alias = mx * level->ny + row % level->ny;
                to[alias] += from[wave];
                to[wide + alias] += from[n + wave];
            }
            if (2 * mx >= level->nx) {
                size_t alias = (level->nx - mx) * level->ny + (above->ny - row) % level->ny;
                to[alias] += sign * from[wave];
                to[wide + alias] -= sign * from[n + wave];
            }
        }
    }
}
