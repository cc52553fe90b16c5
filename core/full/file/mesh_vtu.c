#include "core/full/file/mesh_vtu.h"
#include "core/full/element.h"
#include "core/full/file/mesh_points.h"
#include <errno.h>

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

/* --- points --- */

static void put_position(void *context, const struct mesh_point *point) {
    const struct vtu_writer *w = context;
    double at[3];
    mesh_point_position(w->mesh, point, at);
    if (w->mesh->dimension == 2)
        fprintf(w->file, "%.9g %.9g 0\n", at[0], at[2]);
    else
        fprintf(w->file, "%.9g %.9g %.9g\n", at[0], at[1], at[2]);
}

static void put_displacement(void *context, const struct mesh_point *point) {
    const struct vtu_writer *w = context;
    double u[3] = {0};
    size_t d = (size_t)w->mesh->dimension;
    for (size_t k = 0; k < d; k++)
        u[k] = mesh_point_mean(point, w->step->u, d, k);
    fprintf(w->file, "%.9g %.9g %.9g\n", u[0], u[1], u[2]);
}

static void put_of_face(const struct vtu_writer *w, const struct mesh_point *point,
                        const double *field, double unit) {
    bool face = point->node[0] < w->mesh->face;
    fprintf(w->file, "%.9g\n", face ? field[point->node[0]] / unit : 0);
}

static void put_pressure(void *context, const struct mesh_point *point) {
    const struct vtu_writer *w = context;
    put_of_face(w, point, w->step->face.p, w->step->unit);
}

static void put_gap(void *context, const struct mesh_point *point) {
    const struct vtu_writer *w = context;
    put_of_face(w, point, w->step->face.gap, 1);
}

static void write_points(struct vtu_writer *w) {
    fputs("      <Points>\n", w->file);
    array_open(w, "Float64", "Points", 3, "");
    mesh_points_each(w->mesh, put_position, w);
    array_close(w);
    fputs("      </Points>\n", w->file);
    if (w->step == NULL)
        return;
    fputs("      <PointData Scalars=\"pressure\" Vectors=\"displacement\">\n", w->file);
    array_open(w, "Float64", "displacement", 3, "");
    mesh_points_each(w->mesh, put_displacement, w);
    array_close(w);
    array_open(w, "Float64", "pressure", 1, "");
    mesh_points_each(w->mesh, put_pressure, w);
    array_close(w);
    array_open(w, "Float64", "gap", 1, "");
    mesh_points_each(w->mesh, put_gap, w);
    array_close(w);
    fputs("      </PointData>\n", w->file);
}

/* --- elements --- */

static void put_corners(void *context, const struct mesh_cell *cell) {
    const struct vtu_writer *w = context;
    for (size_t a = 0; a < cell->corners; a++)
        fprintf(w->file, "%zu ", cell->corner[a]);
    fputc('\n', w->file);
}

static void put_quality(void *context, const struct mesh_cell *cell) {
    const struct vtu_writer *w = context;
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

static void put_stress(void *context, const struct mesh_cell *cell) {
    const struct vtu_writer *w = context;
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

static void write_elements(struct vtu_writer *w) {
    bool profile = w->mesh->dimension == 2;
    size_t elements = w->mesh->elements, corners = profile ? 4 : 8;
    fputs("      <Cells>\n", w->file);
    array_open(w, "Int64", "connectivity", 1, "");
    mesh_cells_each(w->mesh, put_corners, w);
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

static void write_element_data(struct vtu_writer *w) {
    static const char PLANE[] =
        " ComponentName0=\"XX\" ComponentName1=\"YY\" ComponentName2=\"XY\"";
    static const char SPACE[] =
        " ComponentName0=\"XX\" ComponentName1=\"YY\" ComponentName2=\"ZZ\""
        " ComponentName3=\"XY\" ComponentName4=\"YZ\" ComponentName5=\"XZ\"";
    bool profile = w->mesh->dimension == 2;
    fputs("      <CellData Scalars=\"quality\">\n", w->file);
    array_open(w, "Float64", "quality", 1, "");
    mesh_cells_each(w->mesh, put_quality, w);
    array_close(w);
    if (w->step != NULL) {
        array_open(w, "Float64", "stress", profile ? 3 : 6, profile ? PLANE : SPACE);
        mesh_cells_each(w->mesh, put_stress, w);
        array_close(w);
    }
    fputs("      </CellData>\n", w->file);
}

int mesh_vtu(FILE *file, const char *title, const struct mesh *mesh, const struct mesh_step *step,
             struct error *err) {
    struct vtu_writer w = {file, mesh, step};
    size_t points = mesh_points_count(mesh);
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
    return mesh_file_end(file, err);
}
