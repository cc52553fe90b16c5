#include "core/map/membrane_levels.h"
#include <stdlib.h>

int membrane_level_create(struct membrane_level *level, size_t nx, size_t ny, size_t count,
                          struct error *err) {
    *level = (struct membrane_level){.nx = nx, .ny = ny, .count = count};
    level->cell_x = array_create(count, sizeof *level->cell_x);
    level->cell_y = array_create(count, sizeof *level->cell_y);
    level->neighbour = array_create(count, sizeof *level->neighbour);
    level->weight = array_create(count, sizeof *level->weight);
    level->diagonal = array_create(count, sizeof *level->diagonal);
    level->solution = array_create(count, sizeof *level->solution);
    level->right = array_create(count, sizeof *level->right);
    if (level->cell_x == NULL || level->cell_y == NULL || level->neighbour == NULL ||
        level->weight == NULL || level->diagonal == NULL || level->solution == NULL ||
        level->right == NULL) {
        membrane_level_clear(level);
        return error_memory(err, count * 80, "a membrane over holes");
    }
    for (size_t a = 0; a < count; a++)
        for (size_t d = 0; d < MEMBRANE_SIDES; d++)
            level->neighbour[a][d] = MEMBRANE_NONE;
    return 0;
}

void membrane_level_clear(struct membrane_level *level) {
    free(level->cell_x);
    free(level->cell_y);
    free(level->neighbour);
    free(level->weight);
    free(level->diagonal);
    free(level->solution);
    free(level->right);
    free(level->parent);
    *level = (struct membrane_level){0};
}

/* Numbers the points of the next level in rising order of their cells; returns how many there are.
 * row: nx/2 + 1 values of scratch. */
static size_t number_parents(struct membrane_level *fine, uint32_t *row) {
    const size_t cells = fine->nx / 2 + 1;
    uint32_t count = 0;
    for (size_t first = 0, last; first < fine->count; first = last) {
        for (size_t c = 0; c < cells; c++)
            row[c] = MEMBRANE_NONE;
        for (last = first; last < fine->count && fine->cell_y[last] / 2 == fine->cell_y[first] / 2;
             last++)
            row[fine->cell_x[last] / 2] = 0;
        for (size_t c = 0; c < cells; c++)
            if (row[c] == 0)
                row[c] = count++;
        for (size_t a = first; a < last; a++)
            fine->parent[a] = row[fine->cell_x[a] / 2];
    }
    return count;
}

static void sum_equations(const struct membrane_level *fine, struct membrane_level *coarse) {
    for (size_t a = 0; a < fine->count; a++) {
        const uint32_t parent = fine->parent[a];
        coarse->cell_x[parent] = fine->cell_x[a] / 2;
        coarse->cell_y[parent] = fine->cell_y[a] / 2;
        coarse->diagonal[parent] += 0.5 * fine->diagonal[a];
        for (size_t d = 0; d < MEMBRANE_SIDES; d++) {
            const uint32_t other = fine->neighbour[a][d];
            if (other == MEMBRANE_NONE)
                continue;
            const double weight = 0.5 * fine->weight[a][d];
            if (fine->parent[other] == parent)
                coarse->diagonal[parent] -= weight;
            else {
                coarse->neighbour[parent][d] = fine->parent[other];
                coarse->weight[parent][d] += weight;
            }
        }
    }
}

int membrane_level_coarsen(struct membrane_level *fine, struct membrane_level *coarse,
                           struct error *err) {
    uint32_t *row = array_create(fine->nx / 2 + 1, sizeof *row);
    fine->parent = array_create(fine->count, sizeof *fine->parent);
    int status = row != NULL && fine->parent != NULL
                     ? 0
                     : error_memory(err, fine->count * sizeof *row, "a membrane over holes");
    if (status == 0) {
        size_t count = number_parents(fine, row);
        status = membrane_level_create(coarse, (fine->nx + 1) / 2, (fine->ny + 1) / 2, count, err);
    }
    if (status == 0)
        sum_equations(fine, coarse);
    free(row);
    return status;
}

/* Returns what the neighbours of a point add to the right side of its equation. */
static double pull(const struct membrane_level *level, size_t a) {
    double total = 0;
    for (size_t d = 0; d < MEMBRANE_SIDES; d++)
        if (level->neighbour[a][d] != MEMBRANE_NONE)
            total += level->weight[a][d] * level->solution[level->neighbour[a][d]];
    return total;
}

static void relax(struct membrane_level *level, size_t a) {
    level->solution[a] = (level->right[a] + pull(level, a)) / level->diagonal[a];
}

static void descend(const struct membrane_level *fine, struct membrane_level *coarse) {
    for (size_t a = 0; a < coarse->count; a++)
        coarse->right[a] = 0;
    for (size_t a = 0; a < fine->count; a++)
        coarse->right[fine->parent[a]] +=
            fine->right[a] + pull(fine, a) - fine->diagonal[a] * fine->solution[a];
}

void membrane_cycle(struct membrane_level *levels, size_t count) {
    for (size_t l = 0; l < count; l++) {
        struct membrane_level *level = &levels[l];
        for (size_t a = 0; a < level->count; a++)
            level->solution[a] = 0;
        for (size_t a = 0; a < level->count; a++)
            relax(level, a);
        if (l + 1 < count)
            descend(level, &levels[l + 1]);
    }
    for (size_t l = count; l-- > 0;) {
        struct membrane_level *level = &levels[l];
        for (size_t a = 0; a < level->count && l + 1 < count; a++)
            level->solution[a] += levels[l + 1].solution[level->parent[a]];
        for (size_t a = level->count; a-- > 0;)
            relax(level, a);
    }
}
