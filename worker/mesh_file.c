#include "worker/mesh_file.h"
#include "core/full/element.h"
#include <errno.h>
#include <string.h>

enum { VTK_QUAD = 9, VTK_HEXAHEDRON = 12 };

struct writer {
    FILE *file;
    const struct mesh *mesh;
    const struct mesh_step *step; /* may be NULL */
    size_t columns, rows;         /* of points, the last ones images of the first */
};

static void array_open(const struct writer *w, const char *type, const char *name, int components,
                       const char *attributes) {
    fprintf(w->file,
            "        <DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\"%s "
            "format=\"ascii\">\n",
            type, name, components, attributes);
}

static void array_close(const struct writer *w) {
    fputs("        </DataArray>\n", w->file);
}

/* --- points --- */

/* A vector along the mesh's axes, as one in space. */
static void put_vector(const struct writer *w, const double *vector) {
    fprintf(w->file, "%.9g %.9g %.9g\n", vector[0], vector[1],
            w->mesh->dimension == 3 ? vector[2] : 0);
}

static void put_position(const struct writer *w, size_t node, size_t j, size_t i) {
    const struct mesh *mesh = w->mesh;
    double position[3] = {(double)i * mesh->unit, (double)j * mesh->across * mesh->unit, 0};
    position[mesh->dimension - 1] = mesh->height[node] * mesh->unit;
    put_vector(w, position);
}

static void put_displacement(const struct writer *w, size_t node, size_t j, size_t i) {
    (void)j;
    (void)i;
    put_vector(w, w->step->u + node * (size_t)w->mesh->dimension);
}

static void put_pressure(const struct writer *w, size_t node, size_t j, size_t i) {
    (void)j;
    (void)i;
    fprintf(w->file, "%.9g\n", node < w->mesh->face ? w->step->face.p[node] / w->step->unit : 0);
}

static void put_gap(const struct writer *w, size_t node, size_t j, size_t i) {
    (void)j;
    (void)i;
    fprintf(w->file, "%.9g\n", node < w->mesh->face ? w->step->face.gap[node] : 0);
}

static void each_point(const struct writer *w,
                       void (*put)(const struct writer *w, size_t node, size_t j, size_t i)) {
    const struct mesh *mesh = w->mesh;
    for (size_t level = 0; level <= mesh->layers; level++)
        for (size_t j = 0; j < w->rows; j++)
            for (size_t i = 0; i < w->columns; i++)
                put(w, level * mesh->face + j % mesh->ny * mesh->nx + i % mesh->nx, j, i);
}

static void write_points(const struct writer *w) {
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

/* VTK goes around each face; the mesh counts in binary (element.h). */
static void put_corners(const struct writer *w, size_t layer, size_t j, size_t i) {
    static const int AROUND[] = {0, 1, 3, 2, 4, 5, 7, 6};
    bool profile = w->mesh->dimension == 2;
    for (int corner = 0; corner < 1 << w->mesh->dimension; corner++) {
        int a = AROUND[corner], deep = profile ? a >> 1 : a >> 2, back = profile ? 0 : a >> 1 & 1;
        size_t row = (layer + (size_t)deep) * w->rows + j + (size_t)back;
        fprintf(w->file, "%zu ", row * w->columns + i + (size_t)(a & 1));
    }
    fputc('\n', w->file);
}

static void put_quality(const struct writer *w, size_t layer, size_t j, size_t i) {
    double position[8][3];
    mesh_position(w->mesh, layer, j, i, position);
    fprintf(w->file, "%.4g\n", element_quality(w->mesh->dimension, position));
}

/* Mean Cauchy stress: the sum of the nodes' inner forces times their places is the volume integral
 * of the stress, now; of the linear strain, before. False for an element that is inside out. */
static bool element_stress(const struct writer *w, double position[8][3], double u[8][3],
                           double stress[3][3]) {
    int d = w->mesh->dimension, nodes = 1 << d;
    const struct solid *solid = &w->step->solid;
    double force[ELEMENT_FREEDOMS];
    struct element_shape shape, now;
    if (!element_shape_make(d, position, &shape) ||
        !element_evaluate(d, solid, &shape, u, NULL, force, NULL))
        return false;
    for (int a = 0; a < nodes && solid->kinematics != KINEMATICS_SMALL; a++)
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

static void put_stress(const struct writer *w, size_t layer, size_t j, size_t i) {
    const struct mesh *mesh = w->mesh;
    size_t d = (size_t)mesh->dimension;
    double position[8][3], u[8][3] = {{0}}, s[3][3] = {{0}};
    mesh_position(mesh, layer, j, i, position);
    for (int a = 0; a < 1 << mesh->dimension; a++)
        for (size_t k = 0; k < d; k++)
            u[a][k] = w->step->u[mesh_node(mesh, layer, j, i, a) * d + k] / mesh->unit;
    /* No equilibrium has elements inside out; a state that is none leaves zeros. */
    (void)element_stress(w, position, u, s);
    double shear = (s[0][1] + s[1][0]) / 2;
    if (d == 2)
        fprintf(w->file, "%.9g %.9g %.9g\n", s[0][0], s[1][1], shear);
    else
        fprintf(w->file, "%.9g %.9g %.9g %.9g %.9g %.9g\n", s[0][0], s[1][1], s[2][2], shear,
                (s[1][2] + s[2][1]) / 2, (s[0][2] + s[2][0]) / 2);
}

static void each_element(const struct writer *w,
                         void (*put)(const struct writer *w, size_t layer, size_t j, size_t i)) {
    for (size_t layer = 0; layer < w->mesh->layers; layer++)
        for (size_t j = 0; j < w->mesh->ny; j++)
            for (size_t i = 0; i < w->mesh->nx; i++)
                put(w, layer, j, i);
}

static void write_elements(const struct writer *w) {
    bool profile = w->mesh->dimension == 2;
    size_t elements = w->mesh->layers * w->mesh->face, corners = profile ? 4 : 8;
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

static void write_element_data(const struct writer *w) {
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
    struct writer w = {file, mesh, step, mesh->nx + 1, mesh->dimension == 3 ? mesh->ny + 1 : 1};
    size_t points = (mesh->layers + 1) * w.rows * w.columns;
    errno = 0;
    fprintf(file,
            "<?xml version=\"1.0\"?>\n<!-- %s -->\n"
            "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
            "  <UnstructuredGrid>\n"
            "    <Piece NumberOfPoints=\"%zu\" NumberOfCells=\"%zu\">\n",
            title, points, mesh->layers * mesh->face);
    write_points(&w);
    write_elements(&w);
    write_element_data(&w);
    fputs("    </Piece>\n  </UnstructuredGrid>\n</VTKFile>\n", file);
    if (fflush(file) != 0 || ferror(file))
        return error_set(err, ERROR_SYSTEM, "cannot write the mesh: %s", strerror(errno));
    return 0;
}
