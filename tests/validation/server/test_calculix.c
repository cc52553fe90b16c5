/* Protects the models for CalculiX: where it is installed, it runs a block of the model full as it
 * is written, and finds the same force, the same nodes in contact and the same displacements.
 *
 * St. Venant and Kirchhoff's material is the one that CalculiX has under finite strain. What
 * differs is its penalty in place of contact without penetration, and the part of lambda that acts
 * on an element's mean dilatation: on this profile they leave 2e-4 of the force, 2e-4 lambda_s of
 * displacements, and a node at the edge of contact. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NODES = 64, LOADS = 2 };
static const double LOAD[LOADS] = {0.1, 0.3}, SLOPE = 0.1, DX = 0.125;
static const double FORCE_TOLERANCE = 1e-3, MOVE_TOLERANCE = 5e-4;
enum { NODES_TOLERANCE = 2 };

static const char STUDY[] =
    "{\"name\": \"block\", \"kind\": \"contact\", \"seed\": 1, \"realisations\": 1, \"surface\": "
    "{\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 2, "
    "\"points_per_wavelength\": 8, \"rms_slope\": 0.1}, \"contact\": {\"model\": \"full\", "
    "\"gap_weighting\": \"dual\", \"kinematics\": \"st_venant_kirchhoff\", \"block_height\": "
    "{\"lengths\": 0.5}}}";

/* A node by one of the two. */
struct node {
    double u_x, u_z; /* u_z towards the flat */
    bool touches;
};

/* Reads Rugo's table of nodes. */
static void read_nodes(struct node nodes[LOADS][NODES]) {
    char *text = slurp("nodes.csv");
    const char *at = strchr(text, '\n') + 1;
    for (size_t row = 0; row < (size_t)LOADS * NODES; row++) {
        struct node *node = &nodes[row / NODES][row % NODES];
        char status[8];
        assert_int_equal(sscanf(at,
                                "%*[^,],%*[^,],%*[^,],%*[^,],%*[^,],%*[^,],%*[^,],%7[a-z],%lf,"
                                "%*[^,],%lf",
                                status, &node->u_x, &node->u_z),
                         3);
        node->touches = strcmp(status, "contact") == 0;
        at = strchr(at, '\n') + 1;
    }
    free(text);
}

/* Returns where the block of a quantity at the end of a step begins in what CalculiX printed. */
static const char *block_at(const char *text, const char *what, int step) {
    char end[20];
    snprintf(end, sizeof end, "0.%d000000E+01\n", step);
    for (const char *at = text; (at = strstr(at, what)) != NULL; at += strlen(what)) {
        const char *line = at + strcspn(at, "\n");
        if (line > at + strlen(end) && strncmp(line + 1 - strlen(end), end, strlen(end)) == 0)
            return line + 1;
    }
    fail_msg("no %s at the end of step %d", what, step);
    return "";
}

/* Reads what CalculiX printed of the front sheet, whose points have the numbers of nodes from 1,
 * and returns the force. */
static double read_step(const char *text, int step, struct node nodes[NODES]) {
    double force, value[3];
    size_t number;
    int used;
    assert_int_equal(
        sscanf(block_at(text, "total force (fx,fy,fz) for set FAR", step), " %*f %lf", &force), 1);
    const char *at = block_at(text, "displacements (vx,vy,vz) for set FACE", step);
    for (size_t n = 0; n < NODES; n++, at += used) {
        assert_int_equal(sscanf(at, " %zu %lf %lf %*f%n", &number, &value[0], &value[1], &used), 3);
        assert_int_equal(number, n + 1);
        nodes[n] = (struct node){value[0], -value[1], false};
    }
    at = block_at(text, "contact stress (slave node,press,tang1,tang2)", step);
    while (sscanf(at, " %zu %lf %*f %*f%n", &number, &value[0], &used) == 2) {
        if (number <= NODES && value[0] > 1e-7)
            nodes[number - 1].touches = true;
        at += used;
    }
    return -force;
}

static void calculix_finds_the_same(void **state) {
    (void)state;
    struct node own[LOADS][NODES], other[NODES];
    if (run_shell("command -v ccx") != 0) {
        print_message("ccx (Debian's calculix-ccx) is not installed\n");
        skip();
    }
    spit("block.json", STUDY);
    assert_int_equal(run_shell("$RUGO generate block.json --mesh block.inp --pressure 0.1,0.3 "
                               "--nodes nodes.csv && ccx block"),
                     0);
    read_nodes(own);
    char *text = slurp("block.dat");
    for (int k = 0; k < LOADS; k++) {
        int touching = 0, others = 0;
        double force = read_step(text, k + 1, other);
        /* The layer is as thick as a column is wide. */
        check_relative(force, LOAD[k] * SLOPE * NODES * DX * DX, FORCE_TOLERANCE);
        for (size_t n = 0; n < NODES; n++) {
            check_close(other[n].u_x, own[k][n].u_x, MOVE_TOLERANCE);
            check_close(other[n].u_z, own[k][n].u_z, MOVE_TOLERANCE);
            touching += own[k][n].touches;
            others += other[n].touches;
        }
        assert_true(touching > 10 && abs(touching - others) <= NODES_TOLERANCE);
    }
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(calculix_finds_the_same)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
