/* Trees of nodes that are joined, by links: of a node to one nearer to its root, of a root below 0.
 * Private to core. */
#ifndef RUGO_CORE_CONTACT_LINK_TREE_H
#define RUGO_CORE_CONTACT_LINK_TREE_H

#include <stddef.h>

/* Returns the root of a node, and halves its path (Tarjan 1975). */
static inline size_t link_tree_root(ptrdiff_t *link, size_t node) {
    while (link[node] >= 0) {
        ptrdiff_t next = link[link[node]];
        if (next < 0)
            return (size_t)link[node];
        link[node] = next;
        node = (size_t)next;
    }
    return node;
}

#endif
