#include "core/full/mesh_file.h"
#include "core/full/element.h"
#include <errno.h>
#include <string.h>

enum { VTK_QUAD = 9, VTK_HEXAHEDRON = 12 };

struct vtu_writer {
    FILE *file;
    const struct mesh *mesh;
    const struct mesh_step *step; /* may be NULL */
};

static void array_open(const struct vtu_writer *w, const char *type, const char *name,
                       int components, const char *attributes) {
    fprintf(w->file,
            "        <DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\"%s "
            "format=\"ascii\">\n",
            type, name, components, attributes);
}

static void array_close(const struct vtu_writer *w) {
    fputs("        </DataArray>\n", w->file);
}

/* --- points ---
 *
 * Each level is a plane of its nodes, in which the last column and row repeat the first. Where
 * columns widen, a second plane follows: that of the corners of the narrower columns, which lie
 * between the nodes. */

struct vtu_point {
    double x, y; /* in steps */
    size_t count, node[4];
};

/* The point in row j and column i of a level whose nodes are `wide` columns apart. */
static struct vtu_point point_of(const struct mesh *mesh, size_t k, size_t wide, size_t j,
                                 size_t i) {
    const struct level *level = &mesh->level[k];
    size_t width = level->width / wide;
    struct vtu_point point = {.x = (double)(i * width), .y = (double)(j * width) * mesh->across};
    for (size_t back = 0; back <= j % wide; back++)
        for (size_t right = 0; right <= i % wide; right++)
            point.node[point.count++] = level_node(level, j / wide + back, i / wide + right);
    return point;
}

static double mean_at(const struct vtu_point *point, const double *field, size_t components,
                      size_t component) {
    double sum = 0;
    for (size_t a = 0; a < point->count; a++)
        sum += field[point->node[a] * components + component];
    return sum / (double)point->count;
}

static void put_position(const struct vtu_writer *w, const struct vtu_point *point) {
    const struct mesh *mesh = w->mesh;
    double up = mean_at(point, mesh->height, 1, 0) * mesh->unit;
    if (mesh->dimension == 2)
        fprintf(w->file, "%.9g %.9g 0\n", point->x * mesh->unit, up);
    else
        fprintf(w->file, "%.9g %.9g %.9g\n", point->x * mesh->unit, point->y * mesh->unit, up);
}

static void put_displacement(const struct vtu_writer *w, const struct vtu_point *point) {
    double u[3] = {0};
    size_t d = (size_t)w->mesh->dimension;
    for (size_t k = 0; k < d; k++)
        u[k] = mean_at(point, w->step->u, d, k);
    fprintf(w->file, "%.9g %.9g %.9g\n", u[0], u[1], u[2]);
}

static void put_of_face(const struct vtu_writer *w, const struct vtu_point *point,
                        const double *field, double unit) {
    bool face = point->node[0] < w->mesh->face;
    fprintf(w->file, "%.9g\n", face ? field[point->node[0]] / unit : 0);
}

static void put_pressure(const struct vtu_writer *w, const struct vtu_point *point) {
    put_of_face(w, point, w->step->face.p, w->step->unit);
}

static void put_gap(const struct vtu_writer *w, const struct vtu_point *point) {
    put_of_face(w, point, w->step->face.gap, 1);
}

static size_t plane_columns(const struct mesh *mesh, size_t level) {
    return mesh->level[level].nx + 1;
}
static size_t plane_rows(const struct mesh *mesh, size_t level) {
    return mesh->dimension == 3 ? mesh->level[level].ny + 1 : 1;
}
/* Counts the points of a level, with those of its second plane. */
static size_t plane_points(const struct mesh *mesh, size_t level) {
    size_t points = plane_columns(mesh, level) * plane_rows(mesh, level);
    if (level > 0 && mesh_widens(mesh, level - 1))
        points += plane_columns(mesh, level - 1) * plane_rows(mesh, level - 1);
    return points;
}

static void each_point(const struct vtu_writer *w,
                       void (*put)(const struct vtu_writer *w, const struct vtu_point *point)) {
    const struct mesh *mesh = w->mesh;
    for (size_t k = 0; k <= mesh->layers; k++)
        for (size_t wide = 1; wide <= (k > 0 && mesh_widens(mesh, k - 1) ? 2 : 1); wide++)
            for (size_t j = 0; j < plane_rows(mesh, k + 1 - wide); j++)
                for (size_t i = 0; i < plane_columns(mesh, k + 1 - wide); i++) {
                    struct vtu_point point = point_of(mesh, k, wide, j, i);
                    put(w, &point);
                }
}

static void write_points(const struct vtu_writer *w) {
    fputs("      <Points>\n", w->file);
    array_open(w, "Float64", "Points", 3, "");
    each_point(w, put_position);
    array_close(w);
    fputs("      </Points>\n", w->file);
    if (w->step == NULL)
        return;
    fputs("      <PointData Scalars=\"pressure\" Vectors=\"displacement\">\n", w->file);
    array_open(w, "Float64", "displacement", 3, "");
    each_point(w, put_displacement);
    array_close(w);
    array_open(w, "Float64", "pressure", 1, "");
    each_point(w, put_pressure);
    array_close(w);
    array_open(w, "Float64", "gap", 1, "");
    each_point(w, put_gap);
    array_close(w);
    fputs("      </PointData>\n", w->file);
}

/* --- elements --- */

/* Layer and element, and the numbers of elements before those of its layer's upper and lower
 * side. */
struct vtu_cell {
    size_t layer, j, i, upper, lower;
};

/* VTK orders corners around each face; the mesh in binary (element.h). */
static void put_corners(const struct vtu_writer *w, const struct vtu_cell *cell) {
    static const int AROUND[] = {0, 1, 3, 2, 4, 5, 7, 6};
    bool profile = w->mesh->dimension == 2;
    for (int corner = 0; corner < 1 << w->mesh->dimension; corner++) {
        int a = AROUND[corner], deep = profile ? a >> 1 : a >> 2, back = profile ? 0 : a >> 1 & 1;
        size_t row = (cell->j + (size_t)back) * plane_columns(w->mesh, cell->layer);
        fprintf(w->file, "%zu ",
                (deep != 0 ? cell->lower : cell->upper) + row + cell->i + (size_t)(a & 1));
    }
    fputc('\n', w->file);
}

static void put_quality(const struct vtu_writer *w, const struct vtu_cell *cell) {
    double position[8][3];
    struct mesh_element element;
    mesh_element(w->mesh, cell->layer, cell->j, cell->i, &element);
    mesh_position(w->mesh, &element, position);
    fprintf(w->file, "%.4g\n", element_quality(w->mesh->dimension, position));
}

/* Mean Cauchy stress: the sum over nodes of inner force times position is the volume integral of
 * the stress. Positions are the deformed ones; of the linear strain, the undeformed ones. Returns
 * false for an inverted element. */
static bool element_stress(const struct vtu_writer *w, double position[8][3], double u[8][3],
                           double stress[3][3]) {
    int d = w->mesh->dimension, nodes = 1 << d;
    const struct material *material = &w->step->material;
    double force[ELEMENT_DEGREES_OF_FREEDOM];
    struct element_shape shape, now;
    if (!element_shape_make(d, position, &shape) ||
        !element_evaluate(d, material, &shape, u, NULL, NULL, force, NULL, NULL))
        return false;
    for (int a = 0; a < nodes && material->kinematics != KINEMATICS_SMALL; a++)
        for (int k = 0; k < d; k++)
            position[a][k] += u[a][k];
    if (!element_shape_make(d, position, &now))
        return false;
    for (int k = 0; k < d; k++)
        for (int l = 0; l < d; l++) {
            stress[k][l] = 0;
            for (int a = 0; a < nodes; a++)
                stress[k][l] += force[a * d + k] * position[a][l] / (now.volume * w->step->unit);
        }
    return true;
}

static void put_stress(const struct vtu_writer *w, const struct vtu_cell *cell) {
    const struct mesh *mesh = w->mesh;
    size_t d = (size_t)mesh->dimension;
    struct mesh_element element;
    double position[8][3], u[8][3] = {{0}}, s[3][3] = {{0}};
    mesh_element(mesh, cell->layer, cell->j, cell->i, &element);
    mesh_position(mesh, &element, position);
    mesh_corners(mesh, &element, w->step->u, d, u);
    for (size_t a = 0; a < (size_t)1 << d; a++)
        for (size_t k = 0; k < d; k++)
            u[a][k] /= mesh->unit;
    /* No equilibrium has inverted elements; other states leave zeros. */
    (void)element_stress(w, position, u, s);
    double shear = (s[0][1] + s[1][0]) / 2;
    if (d == 2)
        fprintf(w->file, "%.9g %.9g %.9g\n", s[0][0], s[1][1], shear);
    else
        fprintf(w->file, "%.9g %.9g %.9g %.9g %.9g %.9g\n", s[0][0], s[1][1], s[2][2], shear,
                (s[1][2] + s[2][1]) / 2, (s[0][2] + s[2][0]) / 2);
}

static void each_element(const struct vtu_writer *w,
                         void (*put)(const struct vtu_writer *w, const struct vtu_cell *cell)) {
    const struct mesh *mesh = w->mesh;
    size_t first = 0;
    for (size_t k = 0; k < mesh->layers; k++) {
        size_t next = first + plane_points(mesh, k);
        size_t hanging =
            mesh_widens(mesh, k) ? plane_columns(mesh, k + 1) * plane_rows(mesh, k + 1) : 0;
        struct vtu_cell cell = {.layer = k, .upper = first, .lower = next + hanging};
        for (cell.j = 0; cell.j < mesh->level[k].ny; cell.j++)
            for (cell.i = 0; cell.i < mesh->level[k].nx; cell.i++)
                put(w, &cell);
        first = next;
    }
}

static void write_elements(const struct vtu_writer *w) {
    bool profile = w->mesh->dimension == 2;
    size_t elements = w->mesh->elements, corners = profile ? 4 : 8;
    fputs("      <Cells>\n", w->file);
    array_open(w, "Int64", "connectivity", 1, "");
    each_element(w, put_corners);
    array_close(w);
    array_open(w, "Int64", "offsets", 1, "");
    for (size_t e = 1; e <= elements; e++)
        fprintf(w->file, "%zu\n", e * corners);
    array_close(w);
    array_open(w, "UInt8", "types", 1, "");
    for (size_t e = 0; e < elements; e++)
        fprintf(w->file, "%d\n", profile ? VTK_QUAD : VTK_HEXAHEDRON);
    array_close(w);
    fputs("      </Cells>\n", w->file);
}

static void write_element_data(const struct vtu_writer *w) {
    static const char PLANE[] =
        " ComponentName0=\"XX\" ComponentName1=\"YY\" ComponentName2=\"XY\"";
    static const char SPACE[] =
        " ComponentName0=\"XX\" ComponentName1=\"YY\" ComponentName2=\"ZZ\""
        " ComponentName3=\"XY\" ComponentName4=\"YZ\" ComponentName5=\"XZ\"";
    bool profile = w->mesh->dimension == 2;
    fputs("      <CellData Scalars=\"quality\">\n", w->file);
    array_open(w, "Float64", "quality", 1, "");
    each_element(w, put_quality);
    array_close(w);
    if (w->step != NULL) {
        array_open(w, "Float64", "stress", profile ? 3 : 6, profile ? PLANE : SPACE);
        each_element(w, put_stress);
        array_close(w);
    }
    fputs("      </CellData>\n", w->file);
}

int mesh_file_write(FILE *file, const char *title, const struct mesh *mesh,
                    const struct mesh_step *step, struct error *err) {
    struct vtu_writer w = {file, mesh, step};
    size_t points = 0;
    for (size_t level = 0; level <= mesh->layers; level++)
        points += plane_points(mesh, level);
    errno = 0;
    fprintf(file,
            "<?xml version=\"1.0\"?>\n<!-- %s -->\n"
            "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
            "  <UnstructuredGrid>\n"
            "    <Piece NumberOfPoints=\"%zu\" NumberOfCells=\"%zu\">\n",
            title, points, mesh->elements);
    write_points(&w);
    write_elements(&w);
    write_element_data(&w);
    fputs("    </Piece>\n  </UnstructuredGrid>\n</VTKFile>\n", file);
    if (fflush(file) != 0 || ferror(file) != 0)
        return error_set(err, ERROR_SYSTEM, "cannot write the mesh: %s", strerror(errno));
    return 0;
}
