#include "core/map/artefacts/repeated_lines.h"
#include <math.h>
#include <stdlib.h>

/* NEARLY_ALL: the share of the points of a line that must hold nothing of their own. OTHERS: the
 * most of such points among all other lines, and where these are several. */
static const double NEARLY_ALL = 0.99, OTHERS = 0.1, OTHERS_SEVERAL = 0.3;
enum { POINTS_LEAST = 32, SEVERAL = 4 };

/* What is the same, but for rounding. */
struct tolerance {
    double same, straight; /* of differences, and of second ones */
};

/* The share of the points of each line that are as their neighbours say. */
struct shares {
    double *copied, *straight; /* -1 with too few points to say; owned by copied */
};

/* Returns the share of counted points; -1 of too few. */
static double share(size_t part, size_t count) {
    return count >= POINTS_LEAST ? (double)part / (double)count : -1;
}

static void shares_fill(const struct grid *grid, const double *z, int axis,
                        const struct tolerance *tolerance, struct shares *out) {
    const size_t lines = axis == 0 ? grid->nx : grid->ny, points = axis == 0 ? grid->ny : grid->nx;
    const size_t across = axis == 0 ? 1 : grid->nx, along = axis == 0 ? grid->nx : 1;
    for (size_t l = 0; l < lines; l++) {
        size_t pairs = 0, triples = 0, same = 0, straight = 0;
        for (size_t p = 0; p < points && l > 0; p++) {
            const double *at = z + l * across + p * along;
            const double step = fabs(at[0] - *(at - across));
            const double bend = l + 1 < lines ? fabs(second_difference(at, across)) : (double)NAN;
            pairs += isnan(step) ? 0 : 1;
            triples += isnan(bend) ? 0 : 1;
            same += step <= tolerance->same ? 1 : 0;
            straight += bend <= tolerance->straight ? 1 : 0;
        }
        out->copied[l] = share(same, pairs);
        out->straight[l] = share(straight, triples);
    }
}

/* Returns how many lines have nearly all of their points; 0 where the others have too many. */
static size_t lines_count(const double *share, size_t lines) {
    size_t count = 0, others = 0;
    double rest = 0;
    for (size_t l = 0; l < lines; l++) {
        count += share[l] >= NEARLY_ALL ? 1 : 0;
        if (share[l] >= 0 && share[l] < NEARLY_ALL) {
            others++;
            rest += share[l];
        }
    }
    const double most = count < SEVERAL ? OTHERS : OTHERS_SEVERAL;
    return others > 0 && rest <= most * (double)others ? count : 0;
}

/* Takes the copies out of other shares. */
static void leave_out(const double *copied, size_t lines, double *share) {
    for (size_t l = 0; l < lines; l++)
        if (copied[l] >= NEARLY_ALL)
            share[l] = -1;
}

/* Says whether every second line is one of those that were found, and which are the others. */
static void find_pattern(const double *share, struct repeated_lines *out) {
    static const double NEARLY_HALF = 0.45;
    size_t count[2] = {0};
    for (size_t l = 0; l < out->lines; l++)
        count[l % 2] += share[l] >= NEARLY_ALL ? 1 : 0;
    out->measured = count[1] >= count[0] ? 0 : 1;
    out->every_second = (double)count[1 - out->measured] >= NEARLY_HALF * (double)out->lines &&
                        count[out->measured] == 0;
}

/* Returns how many points of a profile are as their neighbours say, while these are not; 0 where
 * they are few. odd: how many of them have odd numbers. */
static size_t points_count(size_t n, const double *z, bool copied, double tolerance, size_t *odd) {
    static const double LEAST = 0.05;
    size_t count = 0;
    bool before = true, here = true; /* whether these points are */
    *odd = 0;
    for (size_t i = 1; i < n; i++) {
        const double off = copied      ? z[i] - z[i - 1]
                           : i + 1 < n ? second_difference(z + i, 1)
                                       : INFINITY;
        const bool next = fabs(off) <= tolerance;
        if (here && !before && !next) {
            count++;
            *odd += (i - 1) % 2;
        }
        before = here;
        here = next;
    }
    return (double)count >= LEAST * (double)n ? count : 0;
}

/* Steps make such points by themselves. */
static void find_points(const struct grid *grid, const double *z, double tolerance,
                        struct repeated_lines *out) {
    static const double NEARLY_HALF = 0.45;
    size_t odd_copies, odd_between;
    out->copies = points_count(grid->nx, z, true, tolerance, &odd_copies);
    out->between = points_count(grid->nx, z, false, tolerance, &odd_between);
    const size_t all = out->copies + out->between;
    const size_t odd = (out->copies > 0 ? odd_copies : 0) + (out->between > 0 ? odd_between : 0);
    out->measured = odd >= all - odd ? 0 : 1;
    out->every_second = (odd == all || odd == 0) && (double)all > NEARLY_HALF * (double)out->lines;
}

int repeated_lines_find(const struct grid *grid, const double *z, int axis,
                        const struct map_differences *differences, double step,
                        struct repeated_lines *out, struct error *err) {
    /* of the RMS second difference, and of heights in 24 bits */
    static const double FINE = 1e-6, COARSE = 1e-3, ROUNDING = 0x1p-22, STEPS = 1.01;
    const size_t lines = axis == 0 ? grid->nx : grid->ny;
    const double rms = sqrt(differences->axis[axis].second);
    const double rounding = fmin(fmax(ROUNDING * differences->highest, FINE * rms), COARSE * rms);
    *out = (struct repeated_lines){.lines = lines};
    if (!(rms > 0))
        return 0;
    if (grid_is_profile(grid)) {
        if (step == 0)
            find_points(grid, z, rounding, out);
        return 0;
    }
    struct shares shares = {.copied = array_create(2 * lines, sizeof *shares.copied)};
    if (shares.copied == NULL)
        return error_memory(err, 2 * lines * sizeof *shares.copied, "lines of a map");
    shares.straight = shares.copied + lines;
    /* what lies between may have been rounded to a step */
    const struct tolerance tolerance[] = {{rounding, rounding},
                                          {rounding, fmax(rounding, STEPS * step)}};
    for (int n = 0; n < (step > 0 ? 2 : 1) && out->between == 0; n++) {
        shares_fill(grid, z, axis, &tolerance[n], &shares);
        out->copies = lines_count(shares.copied, lines);
        if (out->copies > 0) /* equal lines are on a line, too */
            leave_out(shares.copied, lines, shares.straight);
        out->between = lines_count(shares.straight, lines);
    }
    if (out->copies + out->between > 0)
        find_pattern(out->copies > 0 ? shares.copied : shares.straight, out);
    free(shares.copied);
    return 0;
}
