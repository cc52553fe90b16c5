#include "core/contact/patches.h"
#include "core/contact/link_tree.h"
#include <math.h>
#include <stdlib.h>

/* Nodes of a patch are joined in a tree whose root stands for it (Tarjan 1975, paths halved); the
 * smaller index is the root, so that roots come in the order of the nodes. */
struct patch_finder {
    struct grid grid;
    size_t nx, ny;   /* patches are found among its first nx by ny nodes */
    bool open;       /* whose sides do not meet */
    ptrdiff_t *own;  /* grid_points: takes memory where none is lent */
    ptrdiff_t *link; /* that, or what was lent: of a root minus the nodes of its patch; else nearer
                        to it */
};
_Static_assert(sizeof(ptrdiff_t) <= sizeof(double), "links do not fit into lent doubles");

int patch_finder_create(struct patch_finder **out, const struct grid *grid, struct error *err) {
    size_t n = grid_points(grid);
    struct patch_finder *finder = array_create(1, sizeof *finder);
    if (finder != NULL) {
        finder->grid = *grid;
        finder->nx = grid->nx;
        finder->ny = grid->ny;
        finder->own = finder->link = array_create(n, sizeof *finder->own);
    }
    if (finder == NULL || finder->own == NULL) {
        patch_finder_destroy(&finder);
        return error_memory(err, n * sizeof(ptrdiff_t), "contact patches");
    }
    *out = finder;
    return 0;
}

void patch_finder_open(struct patch_finder *finder, size_t nx, size_t ny) {
    finder->nx = nx;
    finder->ny = ny;
    finder->open = true;
}

void patch_finder_destroy(struct patch_finder **finder) {
    if (*finder == NULL)
        return;
    free((*finder)->own);
    free(*finder);
    *finder = NULL;
}

double patch_finder_bytes(const struct grid *grid) {
    return sizeof(ptrdiff_t) * (double)grid_points(grid);
}

void patch_finder_lend(struct patch_finder *finder, double *scratch) {
    finder->link = scratch != NULL ? (ptrdiff_t *)(void *)scratch : finder->own;
}

static void join(ptrdiff_t *link, size_t i, size_t j) {
    size_t a = link_tree_root(link, i), b = link_tree_root(link, j);
    if (a == b)
        return;
    size_t root = a < b ? a : b, other = a < b ? b : a;
    link[root] += link[other];
    link[other] = (ptrdiff_t)root;
}

/* Makes each node under pressure a patch of its own. */
static void divide(const struct patch_finder *finder, const double *p) {
    for (size_t j = 0; j < finder->ny; j++)
        for (size_t i = 0; i < finder->nx; i++)
            finder->link[j * finder->nx + i] = p[j * finder->grid.nx + i] > 0 ? -1 : 0;
}

/* Joins each node under pressure with those at its right and above it. */
static void join_neighbours(const struct patch_finder *finder, const double *p) {
    size_t nx = finder->nx, ny = finder->ny, row = finder->grid.nx;
    ptrdiff_t *link = finder->link;
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++) {
            size_t right = (i + 1) % nx, up = (j + 1) % ny;
            if (!(p[j * row + i] > 0))
                continue;
            if (p[j * row + right] > 0 && !(finder->open && right == 0))
                join(link, j * nx + i, j * nx + right);
            if (p[up * row + i] > 0 && !(finder->open && up == 0))
                join(link, j * nx + i, up * nx + i);
        }
}

void patches_find(struct patch_finder *finder, const double *p, struct patches *out,
                  size_t *sizes) {
    size_t n = finder->nx * finder->ny;
    const ptrdiff_t *link = finder->link;
    divide(finder, p);
    join_neighbours(finder, p);
    double nodes = 0;
    *out = (struct patches){0};
    for (size_t i = 0; i < n; i++) {
        if (link[i] >= 0)
            continue;
        size_t size = (size_t)-link[i];
        if (sizes != NULL)
            sizes[out->count] = size;
        out->count++;
        out->largest = size > out->largest ? size : out->largest;
        nodes += (double)size;
    }
    out->mean = out->count > 0 ? nodes / (double)out->count : NAN;
    finder->link = finder->own;
}
