/* Protects the files of steps: a collection that lists a file a load, with the load as its time,
 * and a table from which every number comes back. */
#include "core/nodal/step_folder.h"
#include "tests/support/check.h"
#include "tests/support/process.h"
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { NODES = 6 };
static const double Z[NODES] = {0.1, -0.2, 1.0 / 3, 0, 1e-12, -5},
                    GAP[NODES] = {0, 0.25, 0, 1, 2, 3}, P[NODES] = {0.5, 0, 0.125, 0, 0, 0},
                    CONTACT[NODES] = {1, 0, 1, 0, 0, 0},
                    U[3 * NODES] = {0.01, 0.02, -0.03, 0, 0, 0, 1, 2, 3};

static struct nodal_step step_of(double load, bool displaced) {
    return (struct nodal_step){.load = load,
                               .title = "lengths in a unit",
                               .grid = {3, 2, 1.5, 1},
                               .z = Z,
                               .gap = GAP,
                               .p = P,
                               .contact = CONTACT,
                               .u = displaced ? U : NULL};
}

static void write_steps(const char *folder, const char *nodes, size_t count, bool displaced) {
    const double loads[] = {0.1, 0.25};
    struct step_folder files = {0};
    struct error err = {0};
    int status = step_folder_open(&files, folder, nodes, &err);
    for (size_t k = 0; k < count && status == 0; k++) {
        struct nodal_step step = step_of(loads[k], displaced);
        status = step_folder_put(&files, &step, &err);
    }
    if (step_folder_close(&files, status, &err) != 0)
        fail_msg("%s", err.text);
}

/* Reads back the rows of a table, of this many numbers behind the status. */
static void check_table(const char *text, size_t displacements) {
    const char *at = strchr(text, '\n') + 1;
    for (size_t row = 0; row < (size_t)2 * NODES; row++) {
        const size_t node = row % NODES;
        const double expected[] = {row < NODES ? 0.1 : 0.25,
                                   (double)node,
                                   0.5 * (double)(node % 3),
                                   node / 3 == 0 ? 0 : 0.5,
                                   Z[node],
                                   GAP[node],
                                   P[node]};
        char *end;
        for (size_t v = 0; v < sizeof expected / sizeof *expected; v++, at = end + 1)
            check_close(strtod(at, &end), expected[v], 1e-9 * fabs(expected[v]));
        const char *status = CONTACT[node] > 0 ? "contact" : "open";
        assert_int_equal(strncmp(at, status, strlen(status)), 0);
        at += strlen(status);
        for (size_t v = 0; v < displacements; v++, at = end) {
            assert_int_equal(*at, ',');
            check_close(strtod(at + 1, &end), U[3 * node + v], 1e-9);
        }
        assert_int_equal(*at++, '\n');
    }
    assert_int_equal(*at, '\0');
}

static void steps_and_nodes_come_back(void **state) {
    (void)state;
    for (int again = 0; again < 2; again++) { /* the second run replaces the first */
        write_steps("steps", "nodes.csv", 2, false);
        char *text = slurp("steps/steps.pvd");
        assert_non_null(strstr(text, "timestep=\"0.1\" group=\"\" part=\"0\" file=\"step-1.vtu\""));
        assert_non_null(
            strstr(text, "timestep=\"0.25\" group=\"\" part=\"0\" file=\"step-2.vtu\""));
        assert_null(strstr(text, "step-3"));
        free(text);
        assert_true(contains("steps/step-2.vtu", "Name=\"contact\""));
        text = slurp("nodes.csv");
        assert_int_equal(strncmp(text, "load,node,x,y,z,gap,pressure,status\n", 36), 0);
        check_table(text, 0);
        free(text);
    }
    write_steps(NULL, "moved.csv", 2, true);
    char *text = slurp("moved.csv");
    assert_non_null(strstr(text, "status,u_x,u_y,u_z\n"));
    check_table(text, 3);
    free(text);
}

/* A run with fewer steps leaves none of a longer one, and nothing else is touched. */
static void a_shorter_run_replaces_a_longer_one(void **state) {
    (void)state;
    write_steps("fewer", NULL, 2, false);
    spit("fewer/step-2.vtu.kept", "somebody's own");
    write_steps("fewer", NULL, 1, false);
    assert_int_equal(access("fewer/step-1.vtu", F_OK), 0);
    assert_int_not_equal(access("fewer/step-2.vtu", F_OK), 0);
    assert_int_equal(access("fewer/step-2.vtu.kept", F_OK), 0);
    assert_false(contains("fewer/steps.pvd", "step-2"));
}

/* What fails before its first step, by a name of a file or of a model, costs no results. */
static void a_run_without_a_step_replaces_nothing(void **state) {
    (void)state;
    struct step_folder files = {0};
    struct error err = {0};
    write_steps("earlier", "earlier.csv", 2, false);
    char *collection = slurp("earlier/steps.pvd"), *table = slurp("earlier.csv");
    assert_int_equal(step_folder_open(&files, "earlier", "no/such.csv", &err), ERROR_SYSTEM);
    assert_int_equal(step_folder_open(&files, "earlier", "earlier.csv", &err), 0);
    assert_int_equal(step_folder_close(&files, ERROR_INPUT, &err), ERROR_INPUT);
    assert_int_equal(access("earlier/step-1.vtu", F_OK), 0);
    assert_int_equal(access("earlier/step-2.vtu", F_OK), 0);
    char *collection_after = slurp("earlier/steps.pvd"), *table_after = slurp("earlier.csv");
    assert_string_equal(collection_after, collection);
    assert_string_equal(table_after, table);
    free(collection);
    free(table);
    free(collection_after);
    free(table_after);
    assert_int_equal(step_folder_open(&files, "made", "made.csv", &err), 0);
    assert_int_equal(step_folder_close(&files, ERROR_INPUT, &err), ERROR_INPUT);
    assert_int_not_equal(access("made/steps.pvd", F_OK), 0);
    assert_int_not_equal(access("made.csv", F_OK), 0);
    /* One that succeeds without steps leaves none. */
    write_steps("earlier", "earlier.csv", 0, false);
    assert_int_not_equal(access("earlier/step-1.vtu", F_OK), 0);
    assert_false(contains("earlier/steps.pvd", "step-1"));
    assert_true(contains("earlier/steps.pvd", "</VTKFile>"));
}

/* A failure closes all files, and names what it is about. */
static void what_cannot_be_written_is_told(void **state) {
    (void)state;
    struct step_folder files = {0};
    struct error err = {0};
    struct nodal_step step = step_of(0.1, false);
    assert_int_equal(step_folder_open(&files, "no/such", NULL, &err), ERROR_SYSTEM);
    assert_non_null(strstr(err.text, "cannot make folder no/such: No such file or directory"));
    assert_int_equal(step_folder_open(&files, "half", "no/such.csv", &err), ERROR_SYSTEM);
    assert_non_null(strstr(err.text, "cannot open no/such.csv"));
    if (access("/dev/full", W_OK) != 0)
        skip();
    assert_int_equal(step_folder_open(&files, NULL, "/dev/full", &err), 0);
    assert_int_equal(step_folder_put(&files, &step, &err), ERROR_SYSTEM);
    assert_non_null(strstr(err.text, "cannot write the nodes: No space left on device"));
    assert_int_equal(step_folder_close(&files, ERROR_SYSTEM, &err), ERROR_SYSTEM);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_and_nodes_come_back),
        cmocka_unit_test(a_shorter_run_replaces_a_longer_one),
        cmocka_unit_test(a_run_without_a_step_replaces_nothing),
        cmocka_unit_test(what_cannot_be_written_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
