#include "jobs/statistics/statistics_pairs.h"
#include <string.h>

enum shape { SHAPE_DENSITY, SHAPE_CUMULATIVE, SHAPE_CURVATURE };
enum cells { CELLS_POINTS, CELLS_SUMMITS, CELLS_EQUIVALENT };

/* These curves are ratios of what groups keep. */
static const struct row {
    const char *quantity;
    enum cells cells;
    enum shape shape;
} ROWS[] = {{"height_pdf", CELLS_POINTS, SHAPE_DENSITY},
            {"height_cdf", CELLS_POINTS, SHAPE_CUMULATIVE},
            {"summit_height_pdf", CELLS_SUMMITS, SHAPE_DENSITY},
            {"summit_height_cdf", CELLS_SUMMITS, SHAPE_CUMULATIVE},
            {"summit_mean_curvature", CELLS_SUMMITS, SHAPE_CURVATURE},
            {"summit_curvature_pdf", CELLS_EQUIVALENT, SHAPE_DENSITY}};

static const struct row *row_of(const struct curve *curve) {
    for (size_t a = 0; a < sizeof ROWS / sizeof *ROWS; a++)
        if (strcmp(ROWS[a].quantity, curve->quantity) == 0)
            return &ROWS[a];
    return NULL;
}

/* Counts of cells first to last of a group, the first standing at a place in it. */
static double counted(const struct statistics_groups *groups, size_t g, size_t place, size_t first,
                      size_t last) {
    const uint64_t *count = groups->count + g * groups->counts + place;
    double sum = 0;
    for (size_t cell = first; cell <= last; cell++)
        sum += (double)count[cell];
    return sum;
}

/* A share of things of each group, over a width. */
static void fill_shares(const struct statistics_groups *groups, size_t place, size_t cells,
                        size_t first, size_t last, double width, struct point_groups *out) {
    for (size_t g = 0; g < GROUPS; g++) {
        double some = counted(groups, g, place, first, last);
        out->things[g] = counted(groups, g, place, 0, cells - 1);
        out->counted[g] = some / width;
        out->telling += some > 0 && some < out->things[g];
    }
}

static void fill_curvatures(const struct statistics_groups *groups, size_t place, size_t sums,
                            size_t cell, struct point_groups *out) {
    for (size_t g = 0; g < GROUPS; g++) {
        out->things[g] = counted(groups, g, place, cell, cell);
        out->counted[g] = exact_sum_value(&groups->sum[g * groups->sums + sums + cell]);
        out->telling += out->things[g] > 0;
    }
}

bool statistics_point_groups(const struct statistics_tally *tally, const struct curve *curve,
                             size_t at, struct point_groups *out) {
    const struct statistics_case *one_case = tally->one_case;
    const struct row *row = row_of(curve);
    struct group_place place = statistics_group_place(one_case);
    size_t side = strcmp(curve->series, "pits") == 0 ? SIDE_PITS : SIDE_SUMMITS;
    if (row == NULL || side >= tally->sides)
        return false;
    const struct bins *bins =
        row->cells == CELLS_EQUIVALENT ? &one_case->equivalent : &one_case->height;
    const size_t places[] = {place.height, place.summit[side], place.equivalent[side]};
    size_t first = row->shape == SHAPE_CUMULATIVE ? 0 : at + 1;
    if (at >= bins->count)
        return false;
    *out = (struct point_groups){.telling = 0};
    if (row->shape == SHAPE_CURVATURE)
        fill_curvatures(&tally->groups, places[row->cells], place.curvature[side], at + 1, out);
    else
        fill_shares(&tally->groups, places[row->cells], cells_of(bins), first, at + 1,
                    row->shape == SHAPE_DENSITY ? bins_width(bins) : 1, out);
    return true;
}
