#include "jobs/tally_near.h"
#include <string.h>

static bool tells(const struct tally_near *near, size_t cell) {
    switch (near->telling) {
    case TELLING_THINGS:
        return near->tally->some[cell] > 0;
    case TELLING_OTHERS:
        return near->tally->all[cell] < near->realisations;
    default:
        return near->tally->some[cell] > 1;
    }
}

static void look_ahead(struct tally_near *near) {
    while (near->right_count < TALLY_RARE && near->ahead < near->high) {
        size_t cell = near->ahead++;
        if (tells(near, cell))
            near->right[near->right_count++] = cell;
    }
}

void tally_near_begin(struct tally_near *near, const struct tally *tally, uint64_t realisations,
                      enum tally_telling telling, size_t cell) {
    *near = (struct tally_near){.tally = tally,
                                .realisations = realisations,
                                .telling = telling,
                                .cell = cell,
                                .low = cell - cell % tally->row,
                                .ahead = cell + 1};
    near->high = near->low + tally->row;
    for (size_t a = cell; a > near->low && near->left_count < TALLY_RARE; a--)
        if (tells(near, a - 1))
            near->left[near->left_count++] = a - 1;
    look_ahead(near);
}

void tally_near_next(struct tally_near *near) {
    size_t cell = near->cell + 1;
    if (cell == near->high) {
        if (cell < near->tally->size)
            tally_near_begin(near, near->tally, near->realisations, near->telling, cell);
        return;
    }
    if (tells(near, near->cell)) {
        near->left_count += near->left_count < TALLY_RARE;
        memmove(near->left + 1, near->left, (near->left_count - 1) * sizeof *near->left);
        near->left[0] = near->cell;
    }
    if (near->right_count > 0 && near->right[0] == cell) {
        near->right_count--;
        memmove(near->right, near->right + 1, near->right_count * sizeof *near->right);
    }
    near->cell = cell;
    near->ahead = near->ahead > cell ? near->ahead : cell + 1;
    look_ahead(near);
}
