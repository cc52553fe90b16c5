#include "core/full/file/mesh_inp.h"
#include "core/full/file/mesh_points.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>

/* Penalty: pressure in E* over penetration in columns of the face. */
static const double PENALTY = 1e3;
/* Tension that a linear penalty of CalculiX leaves far from the contact, in E*. */
static const double TENSION = 1e-9;
enum { NUMBERS_A_LINE = 10 };

struct inp_writer {
    FILE *file;
    const struct inp_model *model;
    const struct mesh *mesh;
    size_t points;      /* of one sheet */
    int sheets;         /* of points: 2 of profiles, front and back of the layer */
    size_t *point_of;   /* owned: by node, the number of its own point */
    size_t sheet;       /* that is written */
    size_t written;     /* numbers on the line of a set */
    bool own, far_side; /* which points a set has */
    double lowest;      /* height of the lowest point of the face */
};

static bool is_profile(const struct inp_writer *w) {
    return w->mesh->dimension == 2;
}

static size_t number_of(const struct inp_writer *w, size_t point, size_t sheet) {
    return point + 1 + sheet * w->points;
}

/* --- points --- */

static void note_own(void *context, const struct mesh_point *point) {
    struct inp_writer *w = context;
    if (point->own)
        w->point_of[point->node[0]] = point->number;
}

static void put_point(void *context, const struct mesh_point *point) {
    const struct inp_writer *w = context;
    double at[3];
    mesh_point_position(w->mesh, point, at);
    size_t number = number_of(w, point->number, w->sheet);
    if (is_profile(w))
        fprintf(w->file, "%zu, %.12g, %.12g, %.12g\n", number, at[0], at[2],
                (double)w->sheet * w->mesh->unit);
    else
        fprintf(w->file, "%zu, %.12g, %.12g, %.12g\n", number, at[0], at[1], at[2]);
}

static void put_number(struct inp_writer *w, size_t number) {
    fprintf(w->file, "%zu,%s", number, ++w->written % NUMBERS_A_LINE == 0 ? "\n" : " ");
}

static void end_set(struct inp_writer *w) {
    if (w->written % NUMBERS_A_LINE != 0)
        fputc('\n', w->file);
    w->written = 0;
}

static void put_member(void *context, const struct mesh_point *point) {
    struct inp_writer *w = context;
    size_t level = w->far_side ? w->mesh->layers : 0;
    if (point->level == level && (point->own || !w->own))
        put_number(w, number_of(w, point->number, w->sheet));
}

static void write_set(struct inp_writer *w, const char *name, bool far_side, bool own) {
    fprintf(w->file, "*NSET, NSET=%s\n", name);
    w->far_side = far_side;
    w->own = own;
    for (w->sheet = 0; w->sheet < (size_t)w->sheets; w->sheet++)
        mesh_points_each(w->mesh, put_member, w);
    end_set(w);
}

/* --- elements --- */

static void put_cell(void *context, const struct mesh_cell *cell) {
    const struct inp_writer *w = context;
    fprintf(w->file, "%zu", cell->number + 1);
    for (size_t sheet = 0; sheet < (size_t)w->sheets; sheet++)
        for (size_t a = 0; a < cell->corners; a++)
            fprintf(w->file, ", %zu", number_of(w, cell->corner[a], sheet));
    fputc('\n', w->file);
}

static size_t first_of_flat(const struct inp_writer *w) {
    return w->points * (size_t)w->sheets + 1;
}

/* Writes the corners of the flat, half a cell wider than the block on each side. */
static void put_flat(const struct inp_writer *w) {
    const struct mesh *mesh = w->mesh;
    double x = (double)mesh->level[0].nx * mesh->unit, low = w->lowest - 2 * mesh->unit;
    double y = is_profile(w) ? mesh->unit : (double)mesh->level[0].ny * mesh->across * mesh->unit;
    for (size_t a = 0; a < 8; a++) {
        double right = a % 4 == 1 || a % 4 == 2 ? 1.5 * x : -0.5 * x;
        double back = a % 4 >= 2 ? 1.5 * y : -0.5 * y, up = a >= 4 ? w->lowest : low;
        /* Upward is y of profiles: their corners turn the opposite sense, and go from the back. */
        if (is_profile(w))
            fprintf(w->file, "%zu, %.12g, %.12g, %.12g\n", first_of_flat(w) + a, right, up,
                    y - back);
        else
            fprintf(w->file, "%zu, %.12g, %.12g, %.12g\n", first_of_flat(w) + a, right, back, up);
    }
}

static void write_flat(const struct inp_writer *w) {
    fprintf(w->file, "*ELEMENT, TYPE=C3D8, ELSET=FLAT_ELEMENT\n%zu", w->mesh->elements + 1);
    for (size_t a = 0; a < 8; a++)
        fprintf(w->file, ", %zu", first_of_flat(w) + a);
    fputs("\n*SURFACE, NAME=FLAT, TYPE=ELEMENT\nFLAT_ELEMENT, S2\n", w->file);
}

static void write_rough(struct inp_writer *w) {
    size_t face = level_nodes(&w->mesh->level[0]);
    fputs("*ELSET, ELSET=FACE_ELEMENTS\n", w->file);
    for (size_t e = 1; e <= face; e++)
        put_number(w, e);
    end_set(w);
    fprintf(w->file, "*SURFACE, NAME=ROUGH, TYPE=ELEMENT\nFACE_ELEMENTS, %s\n",
            is_profile(w) ? "S3" : "S1");
}

/* --- periodic sides, and points between nodes --- */

static void put_equation(void *context, const struct mesh_point *point) {
    const struct inp_writer *w = context;
    if (point->own)
        return;
    for (int direction = 1; direction <= w->mesh->dimension; direction++) {
        fprintf(w->file, "*EQUATION\n%zu\n%zu, %d, 1.\n", point->count + 1,
                number_of(w, point->number, w->sheet), direction);
        for (size_t a = 0; a < point->count; a++)
            fprintf(w->file, "%zu, %d, %.12g\n",
                    number_of(w, w->point_of[point->node[a]], w->sheet), direction,
                    -1 / (double)point->count);
    }
}

/* --- the model --- */

static void write_mesh(struct inp_writer *w) {
    size_t flat = first_of_flat(w);
    fputs("*NODE\n", w->file);
    for (w->sheet = 0; w->sheet < (size_t)w->sheets; w->sheet++)
        mesh_points_each(w->mesh, put_point, w);
    put_flat(w);
    fputs("*ELEMENT, TYPE=C3D8, ELSET=BLOCK\n", w->file);
    mesh_cells_each(w->mesh, put_cell, w);
    write_flat(w);
    fprintf(w->file,
            "*NSET, NSET=BLOCK_NODES, GENERATE\n1, %zu, 1\n"
            "*NSET, NSET=FLAT_NODES, GENERATE\n%zu, %zu, 1\n",
            flat - 1, flat, flat + 7);
    write_set(w, "FACE", false, false);
    write_set(w, "FAR", true, false);
    write_set(w, "FAR_OWN", true, true);
    write_rough(w);
    fputs("** Points on the last column and row, and between wider columns, follow others.\n",
          w->file);
    for (w->sheet = 0; w->sheet < (size_t)w->sheets; w->sheet++)
        mesh_points_each(w->mesh, put_equation, w);
}

static double poisson_of(const struct material *material) {
    double lambda = material->local + material->mean;
    return lambda / (2 * (lambda + material->shear));
}

/* Writes what holds in all steps. One point of the far side is held sideways. */
static void write_material(const struct inp_writer *w) {
    double poisson = poisson_of(&w->model->material);
    size_t held = w->point_of[mesh_far_side(w->mesh)];
    fprintf(w->file,
            "*MATERIAL, NAME=ELASTIC\n*ELASTIC\n%.12g, %.12g\n"
            "*SOLID SECTION, ELSET=BLOCK, MATERIAL=ELASTIC\n"
            "*SOLID SECTION, ELSET=FLAT_ELEMENT, MATERIAL=ELASTIC\n"
            "*SURFACE INTERACTION, NAME=HARD\n"
            "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n%.12g, %.12g\n"
            "*CONTACT PAIR, INTERACTION=HARD, TYPE=NODE TO SURFACE\nROUGH, FLAT\n"
            "*BOUNDARY\nFLAT_NODES, 1, 3\n",
            1 - poisson * poisson, poisson, PENALTY / w->mesh->unit, TENSION);
    if (is_profile(w))
        fputs("BLOCK_NODES, 3, 3\n", w->file);
    for (size_t sheet = 0; sheet < (size_t)w->sheets; sheet++)
        fprintf(w->file, "%zu, 1, %d\n", number_of(w, held, sheet), w->mesh->dimension - 1);
}

static void write_step(const struct inp_writer *w, const struct inp_step *step) {
    fprintf(w->file,
            "** mean pressure %.9g E*\n*STEP%s, INC=1000\n*STATIC\n0.25, 1., 1e-6\n"
            "*BOUNDARY\nFAR_OWN, %d, %d, %.12g\n"
            "*NODE FILE\nU, RF\n*EL FILE\nS\n"
            "*NODE PRINT, NSET=FAR, TOTALS=ONLY\nRF\n*NODE PRINT, NSET=FACE\nU\n"
            "*CONTACT PRINT\nCSTR\n*END STEP\n",
            step->pressure, w->model->material.kinematics != KINEMATICS_SMALL ? ", NLGEOM" : "",
            w->mesh->dimension, w->mesh->dimension, -step->displacement);
}

static void measure_face(struct inp_writer *w) {
    w->lowest = INFINITY;
    for (size_t node = 0; node < w->mesh->face; node++)
        w->lowest = fmin(w->lowest, w->mesh->height[node] * w->mesh->unit);
}

int mesh_inp(FILE *file, const char *lengths, const struct inp_model *model, struct error *err) {
    const struct mesh *mesh = model->mesh;
    struct inp_writer w = {.file = file,
                           .model = model,
                           .mesh = mesh,
                           .points = mesh_points_count(mesh),
                           .sheets = mesh->dimension == 2 ? 2 : 1,
                           .point_of = array_create(mesh->nodes, sizeof *w.point_of)};
    if (w.point_of == NULL)
        return error_memory(err, mesh->nodes * sizeof *w.point_of, "a mesh");
    errno = 0;
    measure_face(&w);
    mesh_points_each(mesh, note_own, &w);
    fprintf(file, "*HEADING\nlengths in %s; stresses in E*\n", lengths);
    write_mesh(&w);
    write_material(&w);
    for (size_t s = 0; s < model->step_count; s++)
        write_step(&w, &model->steps[s]);
    free(w.point_of);
    return mesh_file_end(file, err);
}
