/* The sets of nodes that a Newton's method has gone through, by which one that comes again is
 * recognised. Private to core/full. */
#ifndef RUGO_CORE_FULL_SET_HISTORY_H
#define RUGO_CORE_FULL_SET_HISTORY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { SETS_REMEMBERED = 64 };
/* Zeroed at first. */
struct set_history {
    uint64_t hash[SETS_REMEMBERED]; /* Fowler, Noll & Vo 1991 */
    size_t count;
};

/* Returns whether a set, a byte below 255 a node, was met before, and remembers it. One that was
 * met empties the memory. */
static inline bool set_history_meets(struct set_history *history, size_t nodes,
                                     const unsigned char *set) {
    uint64_t hash = UINT64_C(14695981039346656037);
    for (size_t node = 0; node < nodes; node++)
        hash = (hash ^ (set[node] + 1u)) * UINT64_C(1099511628211);
    for (size_t a = 0; a < history->count && a < SETS_REMEMBERED; a++)
        if (history->hash[a] == hash) {
            history->count = 0;
            return true;
        }
    history->hash[history->count++ % SETS_REMEMBERED] = hash;
    return false;
}

#endif
