#include "core/contact/patches.h"
#include <math.h>
#include <stdlib.h>

/* Nodes of a patch are joined in a tree whose root stands for it (Tarjan 1975, paths halved); the
 * smaller index is the root, so that roots come in the order of the nodes. */
struct patch_finder {
    struct grid grid;
    bool open;      /* its sides do not meet */
    size_t *parent; /* grid_points */
    size_t *size;   /* grid_points: nodes, at a root */
};

int patch_finder_create(struct patch_finder **out, const struct grid *grid, struct error *err) {
    size_t n = grid_points(grid);
    struct patch_finder *finder = array_create(1, sizeof *finder);
    if (finder != NULL) {
        finder->grid = *grid;
        finder->parent = array_create(n, sizeof *finder->parent);
        finder->size = array_create(n, sizeof *finder->size);
    }
    if (finder == NULL || finder->parent == NULL || finder->size == NULL) {
        patch_finder_destroy(&finder);
        return error_memory(err, 2 * n * sizeof(size_t), "contact patches");
    }
    *out = finder;
    return 0;
}

void patch_finder_open(struct patch_finder *finder) {
    finder->open = true;
}

void patch_finder_destroy(struct patch_finder **finder) {
    if (*finder == NULL)
        return;
    free((*finder)->parent);
    free((*finder)->size);
    free(*finder);
    *finder = NULL;
}

static size_t root_of(size_t *parent, size_t i) {
    while (parent[i] != i)
        i = parent[i] = parent[parent[i]];
    return i;
}

static void join(size_t *parent, size_t i, size_t j) {
    size_t a = root_of(parent, i), b = root_of(parent, j);
    if (a < b)
        parent[b] = a;
    else
        parent[a] = b;
}

/* Joins each node under pressure with those at its right and above it. */
static void join_neighbours(const struct patch_finder *finder, const double *p) {
    size_t nx = finder->grid.nx, ny = finder->grid.ny;
    size_t *parent = finder->parent;
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++) {
            size_t at = j * nx + i, right = j * nx + (i + 1) % nx, up = (j + 1) % ny * nx + i;
            if (!(p[at] > 0))
                continue;
            if (p[right] > 0 && !(finder->open && i + 1 == nx))
                join(parent, at, right);
            if (p[up] > 0 && !(finder->open && j + 1 == ny))
                join(parent, at, up);
        }
}

void patches_find(struct patch_finder *finder, const double *p, struct patches *out,
                  size_t *sizes) {
    size_t n = finder->grid.nx * finder->grid.ny;
    size_t *parent = finder->parent, *size = finder->size;
    for (size_t i = 0; i < n; i++) {
        parent[i] = i;
        size[i] = 0;
    }
    join_neighbours(finder, p);
    double nodes = 0, squares = 0;
    *out = (struct patches){0};
    for (size_t i = 0; i < n; i++)
        if (p[i] > 0)
            size[root_of(parent, i)]++;
    for (size_t i = 0; i < n; i++) {
        if (size[i] == 0)
            continue;
        if (sizes != NULL)
            sizes[out->count] = size[i];
        out->count++;
        out->largest = size[i] > out->largest ? size[i] : out->largest;
        nodes += (double)size[i];
        squares += (double)size[i] * (double)size[i];
    }
    out->mean = out->count > 0 ? nodes / (double)out->count : NAN;
    out->second = out->count > 0 ? squares / nodes : NAN;
}
