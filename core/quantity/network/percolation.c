#include "core/quantity/network/percolation.h"
#include "core/contact/link_tree.h"

/* Nodes are joined in a tree whose root stands for it (Tarjan 1975, paths halved). A root has a
 * negative link: minus 1, and minus the ends that its nodes reach. */
enum { ROOT = 1, FIRST = 2, LAST = 4, BOTH = ROOT + FIRST + LAST };

static void join(ptrdiff_t *link, size_t a, size_t b) {
    size_t m = link_tree_root(link, a), n = link_tree_root(link, b);
    if (m == n)
        return;
    size_t root = m < n ? m : n, other = m < n ? n : m;
    link[root] = -(-link[root] | -link[other]);
    link[other] = (ptrdiff_t)root;
}

static void join_neighbours(size_t nx, size_t ny, bool walled, size_t stride, const double *k,
                            ptrdiff_t *link) {
    for (size_t j = 0; j < ny; j++) {
        size_t next = j + 1 < ny ? j + 1 : 0;
        const double *row = k + j * stride, *up = k + next * stride;
        for (size_t i = 0; i < nx; i++) {
            if (!(row[i] > 0))
                continue;
            if (i + 1 < nx && row[i + 1] > 0)
                join(link, j * nx + i, j * nx + i + 1);
            if (up[i] > 0 && !(walled && next == 0))
                join(link, j * nx + i, next * nx + i);
        }
    }
}

bool percolation_keep(size_t nx, size_t ny, bool walled, size_t stride, double *k,
                      ptrdiff_t *link) {
    for (size_t j = 0; j < ny; j++) {
        for (size_t i = 0; i < nx; i++)
            link[j * nx + i] = -ROOT;
        link[j * nx] -= FIRST;
        link[j * nx + nx - 1] -= LAST;
    }
    join_neighbours(nx, ny, walled, stride, k, link);
    bool any = false;
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++) {
            double *node = k + j * stride + i;
            bool through = *node > 0 && link[link_tree_root(link, j * nx + i)] == -BOTH;
            any = any || through;
            *node = through ? *node : 0;
        }
    return any;
}
