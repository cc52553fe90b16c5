#include "core/full/file/mesh_points.h"
#include <errno.h>
#include <string.h>

static size_t plane_columns(const struct mesh *mesh, size_t level) {
    return mesh->level[level].nx + 1;
}

static size_t plane_rows(const struct mesh *mesh, size_t level) {
    return mesh->dimension == 3 ? mesh->level[level].ny + 1 : 1;
}

/* Returns the planes of a level: 2 below a layer whose deeper columns are wider. */
static size_t planes(const struct mesh *mesh, size_t level) {
    return level > 0 && mesh_widens(mesh, level - 1) ? 2 : 1;
}

/* Counts the points of a level, with those of its second plane. */
static size_t level_points(const struct mesh *mesh, size_t level) {
    size_t points = plane_columns(mesh, level) * plane_rows(mesh, level);
    if (planes(mesh, level) == 2)
        points += plane_columns(mesh, level - 1) * plane_rows(mesh, level - 1);
    return points;
}

size_t mesh_points_count(const struct mesh *mesh) {
    size_t points = 0;
    for (size_t level = 0; level <= mesh->layers; level++)
        points += level_points(mesh, level);
    return points;
}

/* The point in row j and column i of a level whose nodes are `wide` columns apart. */
static struct mesh_point point_of(const struct mesh *mesh, size_t k, size_t wide, size_t j,
                                  size_t i) {
    const struct level *level = &mesh->level[k];
    size_t width = level->width / wide;
    struct mesh_point point = {.level = k,
                               .x = (double)(i * width),
                               .y = (double)(j * width) * mesh->across,
                               .right = i == wide * level->nx,
                               .back = mesh->dimension == 3 && j == wide * level->ny};
    for (size_t behind = 0; behind <= j % wide; behind++)
        for (size_t beside = 0; beside <= i % wide; beside++)
            point.node[point.count++] = level_node(level, j / wide + behind, i / wide + beside);
    point.own = wide == 1 && !point.right && !point.back;
    return point;
}

void mesh_points_each(const struct mesh *mesh,
                      void (*put)(void *context, const struct mesh_point *point), void *context) {
    size_t number = 0;
    for (size_t k = 0; k <= mesh->layers; k++)
        for (size_t wide = 1; wide <= planes(mesh, k); wide++)
            for (size_t j = 0; j < plane_rows(mesh, k + 1 - wide); j++)
                for (size_t i = 0; i < plane_columns(mesh, k + 1 - wide); i++) {
                    struct mesh_point point = point_of(mesh, k, wide, j, i);
                    point.number = number++;
                    put(context, &point);
                }
}

double mesh_point_mean(const struct mesh_point *point, const double *field, size_t components,
                       size_t component) {
    double sum = 0;
    for (size_t a = 0; a < point->count; a++)
        sum += field[point->node[a] * components + component];
    return sum / (double)point->count;
}

void mesh_point_position(const struct mesh *mesh, const struct mesh_point *point, double out[3]) {
    out[0] = point->x * mesh->unit;
    out[1] = mesh->dimension == 3 ? point->y * mesh->unit : 0;
    out[2] = mesh_point_mean(point, mesh->height, 1, 0) * mesh->unit;
}

/* Fills the corners from the first points above and below. VTK orders corners around each face, the
 * mesh in binary (element.h). */
static void fill_corners(const struct mesh *mesh, size_t upper, size_t lower,
                         struct mesh_cell *cell) {
    static const size_t AROUND[] = {0, 1, 3, 2, 4, 5, 7, 6};
    bool profile = mesh->dimension == 2;
    cell->corners = profile ? 4 : 8;
    for (size_t c = 0; c < cell->corners; c++) {
        size_t a = AROUND[c], deep = profile ? a >> 1 : a >> 2, back = profile ? 0 : a >> 1 & 1;
        size_t row = (cell->j + back) * plane_columns(mesh, cell->layer);
        cell->corner[c] = (deep != 0 ? lower : upper) + row + cell->i + (a & 1);
    }
}

void mesh_cells_each(const struct mesh *mesh,
                     void (*put)(void *context, const struct mesh_cell *cell), void *context) {
    struct mesh_cell cell = {0};
    size_t first = 0;
    for (cell.layer = 0; cell.layer < mesh->layers; cell.layer++) {
        size_t k = cell.layer, next = first + level_points(mesh, k);
        size_t hanging =
            mesh_widens(mesh, k) ? plane_columns(mesh, k + 1) * plane_rows(mesh, k + 1) : 0;
        for (cell.j = 0; cell.j < mesh->level[k].ny; cell.j++)
            for (cell.i = 0; cell.i < mesh->level[k].nx; cell.i++) {
                fill_corners(mesh, first, next + hanging, &cell);
                put(context, &cell);
                cell.number++;
            }
        first = next;
    }
}

int mesh_file_end(FILE *file, struct error *err) {
    if (fflush(file) != 0 || ferror(file) != 0)
        return error_set(err, ERROR_SYSTEM, "cannot write the mesh: %s", strerror(errno));
    return 0;
}
