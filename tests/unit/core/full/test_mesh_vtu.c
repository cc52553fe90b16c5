/* Protects the VTU files of meshed blocks: well-formed, as many values as they announce, elements
 * of VTK's order and positive volume that fill the block, and a step whose stresses carry the load.
 */
#include "core/full/file/mesh_vtu.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

enum { DEEP = 8, ARRAYS = 16, NAME = 32 };
static const double HEIGHT = 1.5;

struct array {
    char name[NAME];
    size_t components, count; /* values in all */
    double *values;           /* owned */
};
struct parsed {
    char *text; /* owned */
    size_t points, cells, array_count;
    struct array arrays[ARRAYS];
};

/* The value of an attribute of the tag into out[NAME]. */
static void attribute(const char *tag, const char *name, char out[NAME]) {
    const char *end = strchr(tag, '>');
    char key[NAME];
    snprintf(key, sizeof key, " %s=\"", name);
    const char *at = strstr(tag, key);
    if (at == NULL || at > end) {
        fail_msg("no %s in %.60s", name, tag);
        return;
    }
    at += strlen(key);
    size_t length = strcspn(at, "\"");
    assert_true(length < NAME);
    memcpy(out, at, length);
    out[length] = '\0';
}

static size_t size_attribute(const char *tag, const char *name) {
    char text[NAME];
    attribute(tag, name, text);
    return strtoul(text, NULL, 10);
}

static void read_array(struct parsed *parsed, const char *tag) {
    struct array *array = &parsed->arrays[parsed->array_count++];
    assert_true(parsed->array_count <= ARRAYS);
    attribute(tag, "Name", array->name);
    array->components = size_attribute(tag, "NumberOfComponents");
    const char *at = strchr(tag, '>') + 1;
    size_t room = strcspn(at, "<") / 2 + 1; /* a digit and a space each at least */
    array->values = calloc(room, sizeof *array->values);
    assert_non_null(array->values);
    for (char *stop;; at = stop) {
        double value = strtod(at, &stop);
        if (stop == at)
            break;
        assert_true(array->count < room && isfinite(value));
        array->values[array->count++] = value;
    }
    at += strspn(at, " \n");
    assert_int_equal(strncmp(at, "</DataArray>", 12), 0);
}

/* Every tag is closed by its own, in order. */
static void parse_tags(struct parsed *parsed) {
    char open[DEEP][NAME] = {""};
    size_t depth = 0;
    assert_int_equal(strncmp(parsed->text, "<?xml version=\"1.0\"?>\n<!-- ", 27), 0);
    const char *at = strstr(parsed->text, "-->");
    assert_non_null(at);
    while ((at = strchr(at, '<')) != NULL) {
        size_t length = strcspn(at + 1, " >");
        if (at[1] == '/') {
            assert_true(depth-- > 0);
            assert_true(length - 1 == strlen(open[depth]));
            assert_int_equal(strncmp(at + 2, open[depth], length - 1), 0);
        } else {
            assert_true(depth < DEEP);
            assert_true(length < NAME);
            snprintf(open[depth++], NAME, "%.*s", (int)length, at + 1);
            if (strncmp(at, "<Piece ", 7) == 0) {
                parsed->points = size_attribute(at, "NumberOfPoints");
                parsed->cells = size_attribute(at, "NumberOfCells");
            } else if (strncmp(at, "<DataArray ", 11) == 0)
                read_array(parsed, at);
        }
        at++;
    }
    assert_int_equal(depth, 0);
}

static struct parsed parse(FILE *file) {
    struct parsed parsed = {0};
    long size = ftell(file);
    assert_true(size > 0);
    parsed.text = calloc((size_t)size + 1, 1);
    assert_non_null(parsed.text);
    rewind(file);
    assert_int_equal(fread(parsed.text, 1, (size_t)size, file), size);
    parse_tags(&parsed);
    return parsed;
}

static void parsed_clear(struct parsed *parsed) {
    for (size_t a = 0; a < parsed->array_count; a++)
        free(parsed->arrays[a].values);
    free(parsed->text);
}

/* NULL where there is none. */
static const struct array *find(const struct parsed *parsed, const char *name) {
    for (size_t a = 0; a < parsed->array_count; a++)
        if (strcmp(parsed->arrays[a].name, name) == 0)
            return &parsed->arrays[a];
    return NULL;
}

/* An array of so many values in all. */
static const struct array *array_of(const struct parsed *parsed, const char *name,
                                    size_t components, size_t count) {
    const struct array *array = find(parsed, name);
    if (array == NULL) {
        fail_msg("no array %s", name);
        return NULL;
    }
    assert_int_equal(array->components, components);
    assert_int_equal(array->count, components * count);
    return array;
}

static const double *corner(const struct parsed *parsed, const double *corners, int a) {
    return find(parsed, "Points")->values + 3 * (size_t)corners[a];
}

/* Volume of an element by its edges at corner 0, exact for upright columns over flat cells; the
 * corners go around, so that it is positive. */
static double edge_volume(const struct parsed *parsed, const double *corners, size_t n) {
    double edge[3][3] = {{0}, {0}, {0, 0, 1}};
    const int ends[] = {1, 3, 4};
    for (size_t a = 0; a < (n == 4 ? 2u : 3u); a++)
        for (size_t k = 0; k < 3; k++)
            edge[a][k] = corner(parsed, corners, ends[a])[k] - corner(parsed, corners, 0)[k];
    double x = edge[0][1] * edge[1][2] - edge[0][2] * edge[1][1];
    double y = edge[0][2] * edge[1][0] - edge[0][0] * edge[1][2];
    double z = edge[0][0] * edge[1][1] - edge[0][1] * edge[1][0];
    return x * edge[2][0] + y * edge[2][1] + z * edge[2][2];
}

static void check_mesh(const struct parsed *parsed, const struct grid *grid) {
    bool profile = grid_is_profile(grid);
    size_t n = profile ? 4 : 8;
    const struct array *corners = array_of(parsed, "connectivity", 1, n * parsed->cells);
    const struct array *offsets = array_of(parsed, "offsets", 1, parsed->cells);
    const struct array *types = array_of(parsed, "types", 1, parsed->cells);
    (void)array_of(parsed, "Points", 3, parsed->points);
    (void)array_of(parsed, "quality", 1, parsed->cells);
    double volume = 0;
    for (size_t e = 0; e < parsed->cells; e++) {
        assert_true(offsets->values[e] == (double)((e + 1) * n));
        assert_true(types->values[e] == (profile ? 9 : 12));
        for (size_t a = 0; a < n; a++)
            assert_true(corners->values[e * n + a] < (double)parsed->points);
        double own = edge_volume(parsed, corners->values + e * n, n);
        assert_true(own > 0);
        volume += own;
    }
    /* Columns upright, mean height of the face 0: 9 digits are written. */
    check_relative(volume, grid->lx * (profile ? 1 : grid->ly) * HEIGHT, 1e-7);
}

/* The far side's layer, where the field is even, carries the load over the cell as it is now: all
 * layers do, but stresses of one elsewhere are far from even. */
static void check_step(const struct parsed *parsed, const struct grid *grid, size_t deepest,
                       double load) {
    size_t n = grid_points(grid), components = grid_is_profile(grid) ? 3 : 6;
    size_t up = grid_is_profile(grid) ? 1 : 2;
    const struct array *stress = array_of(parsed, "stress", components, parsed->cells);
    const struct array *pressure = array_of(parsed, "pressure", 1, parsed->points);
    (void)array_of(parsed, "displacement", 3, parsed->points);
    (void)array_of(parsed, "gap", 1, parsed->points);
    double far_side = 0, face = 0;
    for (size_t e = parsed->cells - deepest; e < parsed->cells; e++)
        far_side += stress->values[e * components + up] / (double)deepest;
    size_t columns = grid->nx + 1;
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t i = 0; i < grid->nx; i++)
            face += pressure->values[j * columns + i] / (double)n;
    check_relative(face, load, 1e-6);
    check_relative(-far_side, load, 1e-3); /* strain of the cell's width: slope squared */
}

static void one_file(struct grid grid, enum kinematics kinematics, size_t widenings) {
    static const double SLOPE = 0.05, LOAD = 0.2;
    struct block block = {MODEL_LAYERED, 0.3, HEIGHT, 1.3, GAP_DUAL, {0, 0, 0}};
    struct full_options options = FULL_DEFAULTS;
    struct error err = {0};
    struct full *full = NULL;
    double z[128];
    size_t n = grid_points(&grid);
    for (size_t i = 0; i < n; i++) {
        size_t column = i % grid.nx, row = i / grid.nx;
        z[i] = SLOPE / (2 * M_PI) * cos(2 * M_PI * (double)column / (double)grid.nx) *
               cos(2 * M_PI * (double)row / (double)grid.ny);
    }
    options.kinematics = kinematics;
    options.transition = 6;
    struct mesh_step step = {.material = material_of(block.poisson, kinematics), .unit = SLOPE};
    if (full_create(&full, &grid, &block, &options, &err) != 0 || full_begin(full, z, &err) != 0 ||
        full_press(full, LOAD * SLOPE, &step.face, NULL, &err) != 0)
        fail_msg("%s", err.text);
    step.u = full_displacement(full);
    const struct mesh *mesh = full_mesh(full);
    assert_int_equal(mesh->level[mesh->layers].width, 1 << widenings);
    for (int pressed = 0; pressed < 2; pressed++) {
        FILE *file = tmpfile();
        assert_non_null(file);
        if (mesh_vtu(file, "a test", mesh, pressed ? &step : NULL, &err) != 0)
            fail_msg("%s", err.text);
        struct parsed parsed = parse(file);
        assert_int_equal(parsed.cells, mesh->elements);
        check_mesh(&parsed, &grid);
        if (pressed)
            check_step(&parsed, &grid, level_nodes(&mesh->level[mesh->layers - 1]), LOAD);
        else
            assert_true(find(&parsed, "stress") == NULL && find(&parsed, "pressure") == NULL);
        parsed_clear(&parsed);
        fclose(file);
    }
    full_destroy(&full);
}

static void meshes_and_steps(void **state) {
    (void)state;
    for (int k = KINEMATICS_HENCKY; k <= KINEMATICS_SMALL; k++) {
        one_file((struct grid){20, 1, 1, 1}, (enum kinematics)k, 2);
        one_file((struct grid){6, 5, 1, 0.8}, (enum kinematics)k, 0);
        one_file((struct grid){10, 8, 1, 0.8}, (enum kinematics)k, 1);
    }
}

static void a_full_disk_is_told(void **state) {
    (void)state;
    struct grid grid = {8, 1, 1, 1};
    struct block block = {MODEL_LAYERED, 0.3, HEIGHT, 1.3, GAP_DUAL, {0, 0, 0}};
    struct mesh *mesh = NULL;
    struct error err = {0};
    FILE *file = fopen("/dev/full", "wb");
    if (file == NULL)
        skip();
    assert_int_equal(mesh_create(&mesh, &grid, &block, INFINITY, &err), 0);
    assert_int_equal(mesh_vtu(file, "a test", mesh, NULL, &err), ERROR_SYSTEM);
    assert_non_null(strstr(err.text, "cannot write the mesh"));
    mesh_destroy(&mesh);
    fclose(file);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(meshes_and_steps),
        cmocka_unit_test(a_full_disk_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
