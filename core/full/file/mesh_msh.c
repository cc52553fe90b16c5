#include "core/full/file/mesh_msh.h"
#include "core/full/file/mesh_points.h"
#include <errno.h>

enum { MSH_LINE = 1, MSH_QUAD = 3, MSH_HEXAHEDRON = 5 };

/* Physical groups, whose numbers are those of their entities too. */
enum group { BLOCK = 1, FACE, FAR_SIDE, LEFT, RIGHT, FRONT, BACK, GROUPS };
static const char *const GROUP_NAMES[GROUPS] = {
    [BLOCK] = "block", [FACE] = "face",   [FAR_SIDE] = "far", [LEFT] = "left",
    [RIGHT] = "right", [FRONT] = "front", [BACK] = "back"};

struct msh_writer {
    FILE *file;
    const struct mesh *mesh;
    size_t elements; /* written so far */
    enum group side; /* that is written */
};

static enum group groups_of(const struct mesh *mesh) {
    return mesh->dimension == 2 ? FRONT : GROUPS;
}

static void write_names(const struct msh_writer *w) {
    enum group end = groups_of(w->mesh);
    int dimension = w->mesh->dimension;
    fprintf(w->file, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n%d\n", end - 1);
    for (enum group g = BLOCK; g < end; g++)
        fprintf(w->file, "%d %d \"%s\"\n", g == BLOCK ? dimension : dimension - 1, (int)g,
                GROUP_NAMES[g]);
    fputs("$EndPhysicalNames\n", w->file);
}

static void put_point(void *context, const struct mesh_point *point) {
    const struct msh_writer *w = context;
    double at[3];
    mesh_point_position(w->mesh, point, at);
    if (w->mesh->dimension == 2)
        fprintf(w->file, "%zu %.12g %.12g 0\n", point->number + 1, at[0], at[2]);
    else
        fprintf(w->file, "%zu %.12g %.12g %.12g\n", point->number + 1, at[0], at[1], at[2]);
}

/* --- elements of the block and of its sides --- */

static void put_element(struct msh_writer *w, int type, enum group group, size_t corners,
                        const size_t *corner) {
    fprintf(w->file, "%zu %d 2 %d %d", ++w->elements, type, (int)group, (int)group);
    for (size_t a = 0; a < corners; a++)
        fprintf(w->file, " %zu", corner[a] + 1);
    fputc('\n', w->file);
}

/* The corners of a cell that lie on each side, around it. */
static const size_t PROFILE_SIDES[GROUPS][2] = {
    [FACE] = {0, 1}, [FAR_SIDE] = {2, 3}, [LEFT] = {3, 0}, [RIGHT] = {1, 2}};
static const size_t SURFACE_SIDES[GROUPS][4] = {
    [FACE] = {0, 3, 2, 1},  [FAR_SIDE] = {4, 5, 6, 7}, [LEFT] = {0, 4, 7, 3},
    [RIGHT] = {1, 2, 6, 5}, [FRONT] = {0, 1, 5, 4},    [BACK] = {3, 7, 6, 2}};

static bool lies_on(const struct mesh *mesh, const struct mesh_cell *cell, enum group side) {
    const struct level *level = &mesh->level[cell->layer];
    switch (side) {
    case FACE:
        return cell->layer == 0;
    case FAR_SIDE:
        return cell->layer + 1 == mesh->layers;
    case LEFT:
        return cell->i == 0;
    case RIGHT:
        return cell->i + 1 == level->nx;
    case FRONT:
        return cell->j == 0;
    case BACK:
        return cell->j + 1 == level->ny;
    case BLOCK:
    case GROUPS:
        break;
    }
    return false;
}

static void put_cell(void *context, const struct mesh_cell *cell) {
    struct msh_writer *w = context;
    put_element(w, w->mesh->dimension == 2 ? MSH_QUAD : MSH_HEXAHEDRON, BLOCK, cell->corners,
                cell->corner);
}

/* Puts what the cell has of the side that is written. */
static void put_side(void *context, const struct mesh_cell *cell) {
    struct msh_writer *w = context;
    bool profile = w->mesh->dimension == 2;
    size_t corner[4], corners = profile ? 2 : 4;
    if (!lies_on(w->mesh, cell, w->side))
        return;
    for (size_t a = 0; a < corners; a++)
        corner[a] = cell->corner[profile ? PROFILE_SIDES[w->side][a] : SURFACE_SIDES[w->side][a]];
    put_element(w, profile ? MSH_LINE : MSH_QUAD, w->side, corners, corner);
}

/* Counts the elements of the block and of its sides. */
static size_t count_elements(const struct mesh *mesh) {
    size_t nx = mesh->level[0].nx, ny = mesh->level[0].ny, sides = 2 * nx * ny;
    sides += 2 * mesh->layers * (mesh->dimension == 2 ? 1 : nx + ny);
    return mesh->elements + sides;
}

/* --- periodic sides --- */

static void put_link(void *context, const struct mesh_point *point) {
    const struct msh_writer *w = context;
    size_t nx = w->mesh->level[0].nx, ny = w->mesh->level[0].ny, number = point->number + 1;
    if (w->side == RIGHT && point->right)
        fprintf(w->file, "%zu %zu\n", number, number - nx);
    else if (w->side == BACK && point->back)
        fprintf(w->file, "%zu %zu\n", number, number - ny * (nx + 1));
}

static void write_links(struct msh_writer *w) {
    const struct mesh *mesh = w->mesh;
    bool profile = mesh->dimension == 2;
    size_t levels = mesh->layers + 1, nx = mesh->level[0].nx, ny = mesh->level[0].ny;
    fprintf(w->file, "$Periodic\n%d\n", profile ? 1 : 2);
    fprintf(w->file, "%d %d %d\n%zu\n", mesh->dimension - 1, RIGHT, LEFT,
            levels * (profile ? 1 : ny + 1));
    w->side = RIGHT;
    mesh_points_each(mesh, put_link, w);
    if (!profile) {
        fprintf(w->file, "%d %d %d\n%zu\n", mesh->dimension - 1, BACK, FRONT, levels * (nx + 1));
        w->side = BACK;
        mesh_points_each(mesh, put_link, w);
    }
    fputs("$EndPeriodic\n", w->file);
}

int mesh_msh_check(const struct mesh *mesh, struct error *err) {
    for (size_t k = 0; k < mesh->layers; k++)
        if (mesh_widens(mesh, k))
            return error_set(err, ERROR_INPUT,
                             "columns of elements widen with depth, which files of Gmsh cannot "
                             "hold: \"transition_depth\": 1e9, of rugo press --transition-depth "
                             "1e9, keeps them as wide as those of the surface");
    return 0;
}

int mesh_msh(FILE *file, const struct mesh *mesh, struct error *err) {
    struct msh_writer w = {.file = file, .mesh = mesh};
    int status = mesh_msh_check(mesh, err);
    if (status != 0)
        return status;
    errno = 0;
    write_names(&w);
    fprintf(file, "$Nodes\n%zu\n", mesh_points_count(mesh));
    mesh_points_each(mesh, put_point, &w);
    fprintf(file, "$EndNodes\n$Elements\n%zu\n", count_elements(mesh));
    mesh_cells_each(mesh, put_cell, &w);
    for (w.side = FACE; w.side < groups_of(mesh); w.side++)
        mesh_cells_each(mesh, put_side, &w);
    fputs("$EndElements\n", file);
    write_links(&w);
    return mesh_file_end(file, err);
}
