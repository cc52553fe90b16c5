#include "core/statistics/hills.h"
#include <stdlib.h>

static const size_t NONE = (size_t)-1;

/* A point and its height, to be sorted. */
struct place {
    double z;
    size_t at;
};

/* Highest first; of equal ones the first point. */
static int by_height(const void *a, const void *b) {
    const struct place *s = a, *t = b;
    if (s->z != t->z)
        return s->z > t->z ? -1 : 1;
    return (s->at > t->at) - (s->at < t->at);
}

struct search {
    const struct measured_map *map;
    struct place *places; /* owned: all heights, sorted */
    size_t count;         /* of them */
    size_t *parent;       /* owned; NONE: not yet flooded; a peak is its own parent */
    unsigned char *whole; /* owned: points with all neighbours */
    struct average bends; /* of the peaks that count */
};

static void search_clear(struct search *s) {
    free(s->places);
    free(s->parent);
    free(s->whole);
}

static int search_create(struct search *s, const struct measured_map *map, struct error *err) {
    size_t points = grid_points(map->grid);
    *s = (struct search){.map = map,
                         .places = array_create(points, sizeof *s->places),
                         .parent = array_create(points, sizeof *s->parent),
                         .whole = array_create(points, 1)};
    if (s->places == NULL || s->parent == NULL || s->whole == NULL) {
        search_clear(s);
        return error_memory(err, points * (sizeof *s->places + sizeof *s->parent + 1), "hills");
    }
    for (size_t point = 0; point < points; point++) {
        s->parent[point] = NONE;
        if (!isnan(map->z[point]))
            s->places[s->count++] = (struct place){map->z[point], point};
    }
    qsort(s->places, s->count, sizeof *s->places, by_height);
    return 0;
}

/* Returns the peak of the hill that a flooded point belongs to (Tarjan 1975). */
static size_t peak_of(size_t *parent, size_t at) {
    while (parent[at] != at) {
        parent[at] = parent[parent[at]];
        at = parent[at];
    }
    return at;
}

static void peak_count(struct search *s, size_t peak) {
    const struct grid *grid = s->map->grid;
    long i = (long)(peak % grid->nx), j = (long)(peak / grid->nx);
    double dx = grid_dx(grid), dy = grid_dy(grid), z = s->map->z[peak];
    if (s->whole[peak] == 0)
        return;
    double xx = map_height(s->map, i - 1, j) - 2 * z + map_height(s->map, i + 1, j);
    double yy = map_height(s->map, i, j - 1) - 2 * z + map_height(s->map, i, j + 1);
    average_add(&s->bends, -(xx / (dx * dx) + yy / (dy * dy)) / 2);
}

/* Returns the number of a neighbour; NONE beside an open map. */
static size_t neighbour(const struct measured_map *map, long i, long j) {
    long nx = (long)map->grid->nx, ny = (long)map->grid->ny;
    if (map->boundary == BOUNDARY_OPEN && (i < 0 || i >= nx || j < 0 || j >= ny))
        return NONE;
    return (size_t)((j + ny) % ny * nx + (i + nx) % nx);
}

/* Lets a point rise out of the falling water: it begins a hill, or joins the hills around it, of
 * which the highest goes on. */
static void point_flood(struct search *s, size_t at, double least) {
    const double *z = s->map->z;
    long nx = (long)s->map->grid->nx, i = (long)at % nx, j = (long)at / nx;
    s->parent[at] = at;
    for (long step = 0; step < 9; step++) {
        size_t beside = neighbour(s->map, i + step % 3 - 1, j + step / 3 - 1);
        if (beside == NONE || s->parent[beside] == NONE)
            continue;
        size_t here = peak_of(s->parent, at), there = peak_of(s->parent, beside);
        if (here == there)
            continue;
        bool higher = z[there] > z[here] || (z[there] == z[here] && there < here);
        size_t stays = higher ? there : here, ends = higher ? here : there;
        if (ends != at && z[ends] - z[at] >= least)
            peak_count(s, ends);
        s->parent[ends] = stays;
    }
}

int hills_find(const struct measured_map *map, double least, struct hills *out, struct error *err) {
    struct search s;
    int status = search_create(&s, map, err);
    if (status != 0)
        return status;
    size_t searched = map_mark_whole(map, 1, 1, s.whole);
    for (size_t n = 0; n < s.count; n++)
        point_flood(&s, s.places[n].at, least);
    for (size_t n = 0; n < s.count; n++)
        if (s.parent[s.places[n].at] == s.places[n].at)
            peak_count(&s, s.places[n].at); /* the highest, and one in each part cut off by holes */
    *out = (struct hills){.count = s.bends.count,
                          .density = (double)s.bends.count / (double)searched /
                                     (grid_dx(map->grid) * grid_dy(map->grid)),
                          .curvature = average_value(&s.bends)};
    search_clear(&s);
    return 0;
}
