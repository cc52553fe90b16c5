/* A list of summits: of surfaces, and of profiles their peaks. */
#ifndef RUGO_CORE_STATISTICS_SUMMITS_SUMMIT_LIST_H
#define RUGO_CORE_STATISTICS_SUMMITS_SUMMIT_LIST_H

#include "core/error.h"
#include <stddef.h>

struct summit {
    double x, y;      /* position, units of the cell; [0, lx) x [0, ly) */
    double height;    /* same unit as z */
    double curvature; /* mean curvature -(z_xx + z_yy)/2, profile -z_xx; positive at a summit */
};
/* A list that grows and is reused from realisation to realisation. Initialise with {0}. */
struct summit_list {
    struct summit *summits; /* owned */
    size_t count, capacity;
};
void summit_list_clear(struct summit_list *list);
int summit_list_add(struct summit_list *list, const struct summit *summit, struct error *err);
/* Appends all of another list. */
int summit_list_append(struct summit_list *list, const struct summit_list *other,
                       struct error *err);

#endif
