/* Protects the files of meshed blocks for other finite element programs: a Gmsh mesh whose sides
 * are whole and linked to their images, and a CalculiX model in which every point that is no node
 * follows nodes, with the sets, surfaces and steps that it names. */
#include "core/file/memory_file.h"
#include "core/full/file/mesh_inp.h"
#include "core/full/file/mesh_msh.h"
#include "core/full/file/mesh_points.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

static const double HEIGHT = 1.5;

static struct mesh *mesh_of(const struct grid *grid, double transition) {
    const struct block block = {MODEL_LAYERED, 0.3, HEIGHT, 1.3, GAP_DUAL, {0, 0, 0}};
    struct error err = {0};
    struct mesh *mesh = NULL;
    double z[128];
    for (size_t i = 0; i < grid_points(grid); i++) {
        size_t column = i % grid->nx, row = i / grid->nx;
        z[i] = 0.1 * cos(2 * M_PI * (double)column / (double)grid->nx) *
               cos(2 * M_PI * (double)row / (double)grid->ny);
    }
    if (mesh_create(&mesh, grid, &block, transition, &err) != 0 || mesh_shape(mesh, z, &err) != 0)
        fail_msg("%s", err.text);
    return mesh;
}

/* Returns what stands behind a line; fails where there is none. */
static const char *behind(const char *text, const char *line) {
    const char *at = strstr(text, line);
    if (at == NULL) {
        fail_msg("no line %s", line);
        return "";
    }
    return at + strlen(line);
}

/* Reads numbers between blanks, commas and ends of lines. */
static double number(const char **at) {
    char *end;
    *at += strspn(*at, " ,\n");
    double value = strtod(*at, &end);
    assert_true(end != *at);
    *at = end;
    return value;
}

static size_t whole(const char **at) {
    double value = number(at);
    assert_true(value >= 0 && value == floor(value));
    return (size_t)value;
}

/* --- Gmsh --- */

static const size_t GROUPS_MOST = 8;

/* Every element has points that there are; counts[g] becomes the number of group g. */
static void read_elements(const char *text, size_t points, size_t counts[]) {
    const char *at = behind(text, "$Elements\n");
    size_t elements = whole(&at);
    for (size_t e = 1; e <= elements; e++) {
        assert_int_equal(whole(&at), e);
        size_t type = whole(&at);
        assert_int_equal(whole(&at), 2);
        size_t group = whole(&at);
        assert_true(group > 0 && group < GROUPS_MOST);
        assert_int_equal(whole(&at), group);
        counts[group]++;
        for (size_t a = 0; a < (type == 1 ? 2u : type == 3 ? 4u : 8u); a++) {
            size_t point = whole(&at);
            assert_true(point > 0 && point <= points);
        }
    }
    assert_int_equal(strncmp(at, "\n$EndElements\n$Periodic\n", 24), 0);
}

/* Points of "right" and "back" lie a cell beside their images. */
static void check_links(const char *text, const struct grid *grid, double (*point)[3]) {
    const char *at = behind(text, "$Periodic\n");
    size_t sides = whole(&at);
    assert_int_equal(sides, grid_is_profile(grid) ? 1 : 2);
    for (size_t s = 0; s < sides; s++) {
        const double apart[] = {s == 0 ? grid->lx : 0, s == 1 ? grid->ly : 0, 0};
        (void)whole(&at);
        assert_int_equal(whole(&at), s == 0 ? 5 : 7);
        assert_int_equal(whole(&at), s == 0 ? 4 : 6);
        size_t links = whole(&at);
        assert_true(links > 0);
        for (size_t l = 0; l < links; l++) {
            size_t image = whole(&at), own = whole(&at);
            for (size_t k = 0; k < 3; k++)
                check_close(point[image - 1][k] - point[own - 1][k], apart[k], 1e-9);
        }
    }
}

static void one_msh(struct grid grid) {
    struct mesh *mesh = mesh_of(&grid, INFINITY);
    struct memory_file memory;
    struct error err = {0};
    size_t counts[8] = {0}, sides = grid_is_profile(&grid) ? 1 : grid.ny;
    assert_true(memory_file_open(&memory));
    if (mesh_msh(memory.file, mesh, &err) != 0)
        fail_msg("%s", err.text);
    char *text = memory_file_close(&memory, NULL);
    const char *at = behind(text, "$Nodes\n");
    size_t points = whole(&at);
    assert_int_equal(points, mesh_points_count(mesh));
    double(*point)[3] = calloc(points, sizeof *point);
    assert_non_null(point);
    for (size_t p = 0; p < points; p++) {
        assert_int_equal(whole(&at), p + 1);
        for (size_t k = 0; k < 3; k++)
            point[p][k] = number(&at);
    }
    read_elements(text, points, counts);
    assert_int_equal(counts[1], mesh->elements);
    assert_int_equal(counts[2], grid_points(&grid));
    assert_int_equal(counts[3], grid_points(&grid));
    assert_int_equal(counts[4], mesh->layers * sides);
    assert_int_equal(counts[5], mesh->layers * sides);
    assert_int_equal(counts[6], grid_is_profile(&grid) ? 0 : mesh->layers * grid.nx);
    assert_int_equal(counts[7], counts[6]);
    check_links(text, &grid, point);
    free(point);
    free(text);
    mesh_destroy(&mesh);
}

static void gmsh_meshes_have_whole_sides(void **state) {
    (void)state;
    one_msh((struct grid){12, 1, 1, 1});
    one_msh((struct grid){6, 5, 1, 0.8});
}

static void points_between_others_are_not_for_gmsh(void **state) {
    (void)state;
    struct grid grid = {20, 1, 1, 1};
    struct mesh *mesh = mesh_of(&grid, 6);
    struct memory_file memory;
    struct error err = {0};
    assert_true(memory_file_open(&memory));
    assert_int_equal(mesh_msh(memory.file, mesh, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "\"transition_depth\": 1e9"));
    assert_non_null(strstr(err.text, "--transition-depth 1e9"));
    char *text = memory_file_close(&memory, NULL);
    assert_string_equal(text, "");
    free(text);
    mesh_destroy(&mesh);
}

/* --- CalculiX --- */

/* Which points follow others: each in every direction once, and none that others follow. */
static size_t check_equations(const char *text, size_t points, size_t directions) {
    bool *follows = calloc(4 * (points + 1), sizeof *follows);
    bool *leads = calloc(points + 1, sizeof *leads);
    size_t count = 0;
    if (follows == NULL || leads == NULL) {
        fail_msg("out of memory");
        abort();
    }
    for (const char *at = text; (at = strstr(at, "*EQUATION\n")) != NULL; count++) {
        at += strlen("*EQUATION\n");
        size_t terms = whole(&at), point = whole(&at), direction = whole(&at);
        double sum = number(&at);
        check_close(sum, 1, 0);
        assert_true(point <= points && direction > 0 && direction <= directions);
        assert_false(follows[4 * point + direction]);
        follows[4 * point + direction] = true;
        for (size_t a = 1; a < terms; a++) {
            size_t leader = whole(&at);
            assert_true(leader > 0 && leader <= points);
            leads[leader] = true;
            assert_int_equal(whole(&at), direction);
            sum += number(&at);
        }
        check_close(sum, 0, 1e-11);
    }
    for (size_t p = 1; p <= points; p++)
        for (size_t k = 1; k <= directions; k++)
            assert_false(leads[p] && follows[4 * p + k]);
    free(follows);
    free(leads);
    return count;
}

static size_t set_size(const char *text, const char *name) {
    char line[60];
    snprintf(line, sizeof line, "*NSET, NSET=%s\n", name);
    const char *at = behind(text, line);
    size_t count = 0;
    while (*(at + strspn(at, " ,\n")) != '*') {
        (void)whole(&at);
        count++;
    }
    return count;
}

static void check_inp(const char *text, const struct mesh *mesh, const struct grid *grid) {
    bool profile = grid_is_profile(grid);
    size_t sheets = profile ? 2 : 1, points = sheets * mesh_points_count(mesh);
    size_t directions = profile ? 2 : 3;
    char line[120];
    assert_int_equal(check_equations(text, points, directions),
                     (points - sheets * mesh->nodes) * directions);
    assert_int_equal(set_size(text, "FACE"),
                     profile ? 2 * (grid->nx + 1) : (grid->nx + 1) * (grid->ny + 1));
    const struct level *deepest = &mesh->level[mesh->layers];
    assert_int_equal(set_size(text, "FAR_OWN"), sheets * level_nodes(deepest));
    snprintf(line, sizeof line, "\nFACE_ELEMENTS, %s\n", profile ? "S3" : "S1");
    (void)behind(text, line);
    (void)behind(text, "*CONTACT PAIR, INTERACTION=HARD, TYPE=NODE TO SURFACE\nROUGH, FLAT\n");
    assert_true((strstr(text, "BLOCK_NODES, 3, 3\n") != NULL) == profile);
    const char *at = behind(text, "*ELASTIC\n");
    check_close(number(&at), 1 - 0.3 * 0.3, 1e-9);
    check_close(number(&at), 0.3, 1e-9);
    snprintf(line, sizeof line, "*BOUNDARY\nFAR_OWN, %zu, %zu, -0.25\n", directions, directions);
    (void)behind(text, line);
}

static void one_inp(struct grid grid, double transition, enum kinematics kinematics) {
    const struct inp_step steps[] = {{0.125, 0.01}, {0.25, 0.02}};
    struct mesh *mesh = mesh_of(&grid, transition);
    const struct inp_model model = {mesh, material_of(0.3, kinematics), 2, steps};
    struct memory_file memory;
    struct error err = {0};
    assert_true(memory_file_open(&memory));
    if (mesh_inp(memory.file, "um", &model, &err) != 0)
        fail_msg("%s", err.text);
    char *text = memory_file_close(&memory, NULL);
    check_inp(text, mesh, &grid);
    assert_non_null(strstr(text, "*HEADING\nlengths in um; stresses in E*\n*NODE\n"));
    assert_true((strstr(text, "*STEP, NLGEOM") != NULL) == (kinematics != KINEMATICS_SMALL));
    free(text);
    mesh_destroy(&mesh);
}

static void calculix_models_are_whole(void **state) {
    (void)state;
    one_inp((struct grid){20, 1, 1, 1}, 6, KINEMATICS_ST_VENANT);
    one_inp((struct grid){20, 1, 1, 1}, INFINITY, KINEMATICS_SMALL);
    one_inp((struct grid){10, 8, 1, 0.8}, 6, KINEMATICS_HENCKY);
}

static void a_full_disk_is_told(void **state) {
    (void)state;
    struct grid grid = {8, 1, 1, 1};
    struct mesh *mesh = mesh_of(&grid, INFINITY);
    const struct inp_model model = {mesh, material_of(0.3, KINEMATICS_SMALL), 0, NULL};
    struct error err = {0};
    FILE *file = fopen("/dev/full", "wb");
    if (file == NULL)
        skip();
    assert_int_equal(mesh_msh(file, mesh, &err), ERROR_SYSTEM);
    assert_int_equal(mesh_inp(file, "um", &model, &err), ERROR_SYSTEM);
    assert_non_null(strstr(err.text, "cannot write the mesh"));
    mesh_destroy(&mesh);
    fclose(file);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gmsh_meshes_have_whole_sides),
        cmocka_unit_test(points_between_others_are_not_for_gmsh),
        cmocka_unit_test(calculix_models_are_whole),
        cmocka_unit_test(a_full_disk_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
