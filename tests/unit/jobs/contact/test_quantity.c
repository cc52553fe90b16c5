/* Protects what studies ask of a solved contact: the conductance is the stiffness of a half-space
 * without end, and of other blocks that of half-spaces through their nodes; what yields bears the
 * hardness, and stays flat as the load falls; faces slip by the contact of lighter loads, and as
 * that does where nothing couples pressures and tractions; leaks lie between those of both means,
 * and close where free space does. All have the errors of other curves and do not depend on how
 * realisations are cut into blocks. A case that does not ask for them keeps the bytes of its
 * partial results. */
#include "jobs/contact/case/contact_case_read.h"
#include "jobs/contact/case/contact_loads.h"
#include "jobs/contact/contact_measure.h"
#include "jobs/contact/quantity/quantity.h"
#include "schema/result/total.h"
#include "tests/support/check.h"
#include "tests/support/contact_document.h"
#include <stdio.h>
#include <stdlib.h>

#define STUDY(contact)                                                                             \
    "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": " \
    "4, \"points_per_wavelength\": 8, \"rms_slope\": 0.1}, \"contact\": {\"levels\": [4, 8], "     \
    "\"pressures\": {\"values\": [0.01, 0.1]}, " contact "}}"
#define SURFACE(contact)                                                                           \
    "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 2, "                \
    "\"points_per_wavelength\": 4}, \"contact\": {\"tolerance\": 1e-6, " contact "}}"
enum { LOADS = 2 };

static void half_space_conducts_as_it_is_stiff(void **state) {
    (void)state;
    cJSON *document = solve(STUDY("\"conductance\": true"), 3);
    const cJSON *conductance = curve_of(document, "conductance", "", "halfspace");
    const cJSON *stiffness = curve_of(document, "stiffness", "", "halfspace");
    static const char *const KEYS[] = {"/y", "/standard_error", "/discretisation_bound",
                                       "/solver_bound", "/cell_bound"};
    for (int k = 0; k < LOADS; k++)
        for (size_t a = 0; a < sizeof KEYS / sizeof *KEYS; a++) {
            double value = at(conductance, KEYS[a], k);
            if (!(value > 0))
                fail_msg("%s at %d: %g", KEYS[a], k, value);
            assert_near(value, at(stiffness, KEYS[a], k), 0, at(conductance, "/x", k));
        }
    cJSON_Delete(document);
}

/* A layer of a twentieth of the cell is at least a fifth stiffer than half-spaces that touch in its
 * nodes, which conduct; a high one is as stiff as they. */
static void low_blocks_conduct_as_half_spaces(void **state) {
    (void)state;
    static const struct {
        const char *study;
        double least, most; /* stiffness over conductance */
    } BLOCKS[] = {
        {STUDY("\"conductance\": true, \"block_height\": {\"lengths\": 0.05}"), 1.2, 20},
        {STUDY("\"conductance\": true, \"block_height\": {\"lengths\": 2}"), 0.9999, 1.0001}};
    for (size_t b = 0; b < 2; b++) {
        cJSON *document = solve(BLOCKS[b].study, 2);
        for (int k = 0; k < LOADS; k++) {
            double stiff = at(curve_of(document, "stiffness", "", "halfspace"), "/y", k) /
                           at(curve_of(document, "conductance", "", "halfspace"), "/y", k);
            if (!(stiff > BLOCKS[b].least && stiff < BLOCKS[b].most))
                fail_msg("block %zu, load %d: %.6g times as stiff as what conducts", b, k, stiff);
        }
        cJSON_Delete(document);
    }
}

/* Without the stiffness shown the conductance stays what it is. */
static void stiffness_may_be_omitted(void **state) {
    (void)state;
    cJSON *with = solve(STUDY("\"conductance\": true"), 2);
    cJSON *without = solve(STUDY("\"conductance\": true, \"stiffness\": \"omitted\""), 2);
    for (int k = 0; k < LOADS; k++)
        assert_near(at(curve_of(without, "conductance", "", "halfspace"), "/y", k),
                    at(curve_of(with, "conductance", "", "halfspace"), "/y", k), 0, k);
    const cJSON *curve;
    cJSON_ArrayForEach(curve, json_at(without, "/curves")) {
        assert_false(text_is(curve, "/quantity", "stiffness"));
    }
    cJSON_Delete(with);
    cJSON_Delete(without);
}

/* The load is what yielded nodes bear, each the hardness, and what others bear. A hard block is
 * elastic, and a soft one touches where it yields. */
static void what_yields_bears_the_hardness(void **state) {
    (void)state;
    cJSON *document = solve(STUDY("\"hardness\": 0.2, \"conductance\": true"), 3);
    const cJSON *area = curve_of(document, "plastic_area", "", "halfspace");
    const cJSON *load = curve_of(document, "plastic_load", "", "halfspace");
    const cJSON *nodes = curve_of(document, "contact_area", "nodes", "halfspace");
    const cJSON *bracket = curve_of(document, "contact_area", "edges_yielded", "halfspace");
    const cJSON *edges = curve_of(document, "contact_area", "edges", "halfspace");
    const cJSON *unload = curve_of(document, "unload_stiffness", "", "halfspace");
    const cJSON *conductance = curve_of(document, "conductance", "", "halfspace");
    for (int k = 0; k < LOADS; k++) {
        double x = at(area, "/x", k);
        assert_near(0.2 * at(area, "/y", k), at(load, "/y", k) * x, 1e-4 * x, x);
        assert_true(at(area, "/y", k) > 0 && at(area, "/y", k) <= at(nodes, "/y", k));
        assert_true(at(bracket, "/y", k) > 0);
        assert_true(at(edges, "/discretisation_bound", k) >= at(bracket, "/y", k));
        assert_true(at(area, "/discretisation_bound", k) > 0 && at(area, "/cell_bound", k) > 0);
        assert_near(at(conductance, "/y", k), at(unload, "/y", k), 0, x);
        assert_near(cJSON_GetArrayItem(json_at(area, "/theory/persson"), k)->valuedouble,
                    at(area, "/y", k), 0.5 * at(area, "/y", k), x);
    }
    cJSON_Delete(document);
    cJSON *hard = solve(STUDY("\"hardness\": 1e3"), 2),
          *elastic = solve(STUDY("\"poisson\": 0.3"), 2);
    for (int k = 0; k < LOADS; k++) {
        assert_near(at(curve_of(hard, "contact_area", "edges", "halfspace"), "/y", k),
                    at(curve_of(elastic, "contact_area", "edges", "halfspace"), "/y", k), 0, k);
        assert_near(at(curve_of(hard, "plastic_area", "", "halfspace"), "/y", k), 0, 0, k);
    }
    cJSON_Delete(hard);
    cJSON_Delete(elastic);
}

/* Light loads leave the gap open, heavy ones close it, and the area at which it closes
 * lies between those of the loads. */
static void gaps_leak_until_they_close(void **state) {
    (void)state;
    cJSON *document = solve(
        SURFACE("\"leak\": true, \"pressures\": {\"values\": [0.02, 0.1, 0.2, 0.3, 0.5]}"), 3);
    const cJSON *leak = curve_of(document, "leak", "", "halfspace");
    const cJSON *low = curve_of(document, "leak", "harmonic", "halfspace");
    const cJSON *high = curve_of(document, "leak", "arithmetic", "halfspace");
    const cJSON *open = curve_of(document, "percolates", "", "halfspace");
    const cJSON *along_x = curve_of(document, "leak", "x", "halfspace");
    const cJSON *along_y = curve_of(document, "leak", "y", "halfspace");
    const cJSON *area = curve_of(document, "contact_area", "edges", "halfspace");
    for (int k = 0; k < points(leak); k++) {
        double y = at(leak, "/y", k), x = at(leak, "/x", k);
        assert_true(y >= at(low, "/y", k) && y <= at(high, "/y", k));
        assert_true((y > 0) == (at(open, "/y", k) > 0));
        assert_near(y, (at(along_x, "/y", k) + at(along_y, "/y", k)) / 2, 1e-12, x);
    }
    assert_true(at(open, "/y", 0) == 1 && at(open, "/y", 4) == 0 && at(leak, "/y", 0) > 0.3);
    double closes = json_at(document, "/scalars/percolation_area/value")->valuedouble;
    double load = json_at(document, "/scalars/percolation_load/value")->valuedouble;
    assert_true(closes > 0.3 && closes < 0.6 && closes < at(area, "/y", 4));
    assert_true(load > 0.02 && load < 0.5);
    cJSON_Delete(document);
}

/* Where the loads end before some realisations close, the mean is over the others: their number
 * gives the interval, and what is missing is an error. What bears on a leak bears on it, too. */
static void those_that_stay_open_are_missing(void **state) {
    (void)state;
    static const char LEAKS[] =
        SURFACE("\"leak\": true, \"pressures\": {\"values\": [0.02, 0.1, 0.2, 0.25]}");
    enum { COUNT = 8 };
    double values = 0, squares = 0;
    int closed = 0;
    for (uint64_t r = 0; r < COUNT; r++) {
        cJSON *one = solve_from(LEAKS, r, 1);
        const cJSON *load = json_at(one, "/scalars/percolation_load/value");
        if (cJSON_IsNumber(load)) {
            closed++;
            values += load->valuedouble;
            squares += load->valuedouble * load->valuedouble;
        }
        cJSON_Delete(one);
    }
    assert_true(closed >= 2 && closed < COUNT);
    cJSON *document = solve(LEAKS, COUNT);
    const cJSON *scalar = json_at(document, "/scalars/percolation_load");
    const double mean = values / closed, deviation = sqrt((squares - values * mean) / (closed - 1));
    const double error = deviation / sqrt(closed), share = (double)(COUNT - closed) / COUNT;
    check_close(json_number_at(scalar, "/value", NAN), mean, 1e-12);
    check_close(json_number_at(scalar, "/standard_error", NAN), error, 1e-12);
    check_close(json_number_at(scalar, "/effective_realisations", NAN), closed, 0);
    check_close(json_number_at(scalar, "/missing_bound", NAN), 2 * share * deviation, 1e-12);
    check_close(json_number_at(scalar, "/total_high", NAN),
                mean + total_deviations(closed) * error + 2 * share * deviation, 1e-12);
    char *unknown = cJSON_PrintUnformatted(json_at(scalar, "/unknown_errors"));
    assert_string_equal(unknown, "[\"discretisation\",\"cell\",\"solver\"]");
    free(unknown);
    cJSON_Delete(document);
}

static void blocks_do_not_matter(void **state) {
    (void)state;
    static const char *const STUDIED[] = {
        STUDY("\"conductance\": true, \"hardness\": 0.3, \"model\": [\"halfspace\", \"layered\"], "
              "\"friction\": 0.3, \"unload\": true"),
        SURFACE("\"conductance\": true, \"leak\": true, \"pressures\": {\"values\": [0.1, 0.3]}")};
    for (size_t s = 0; s < 2; s++) {
        size_t one_block, two_blocks;
        char *one = in_blocks(STUDIED[s], 2, 2, &one_block);
        char *two = in_blocks(STUDIED[s], 2, 1, &two_blocks);
        assert_string_equal(one, two);
        assert_non_null(strstr(one, "\"conductance\""));
        free(one);
        free(two);
    }
}

#define POINTS 16 /* more than any curve here has */

/* Returns the value of a curve at x, which is one of its points. */
static double value_at(const cJSON *curve, double x) {
    for (int i = 0; i < cJSON_GetArraySize(json_at(curve, "/x")); i++)
        if (fabs(at(curve, "/x", i) - x) < 1e-9)
            return at(curve, "/y", i);
    fail_msg("no point at %g", x);
    return (double)NAN;
}

/* What sticks at Q is what touches under P - Q/mu, and the faces have moved by mu times what that
 * raises. Each curve has all errors, and loads that the study lacks are those of all curves. */
static void friction_slips_by_lighter_loads(void **state) {
    (void)state;
    static const char *const BOUNDS[] = {"/discretisation_bound", "/solver_bound", "/cell_bound"};
    const double mu = 0.3, held = 0.1;
    cJSON *document = solve(STUDY("\"friction\": 0.3"), 1);
    const cJSON *stick = curve_of(document, "stick_area", "edges", "halfspace");
    const cJSON *moved = curve_of(document, "tangential_displacement", "", "halfspace");
    const cJSON *area = curve_of(document, "contact_area", "edges", "halfspace");
    const cJSON *gap = curve_of(document, "mean_gap", "", "halfspace");
    int points = cJSON_GetArraySize(json_at(stick, "/x"));
    assert_true(points >= 12 && points < POINTS);
    for (int i = 0; i < points; i++) {
        double share = at(stick, "/x", i), load = held * (1 - share);
        assert_true(i == 0 ? share <= 0.1 + 1e-9 : share > at(stick, "/x", i - 1));
        assert_near(at(stick, "/y", i), value_at(area, load) / value_at(area, held), 1e-12, share);
        assert_near(at(moved, "/y", i), mu * (value_at(gap, load) - value_at(gap, held)), 1e-12,
                    share);
        for (size_t b = 0; b < sizeof BOUNDS / sizeof *BOUNDS; b++)
            assert_true(at(stick, BOUNDS[b], i) > 0 && at(moved, BOUNDS[b], i) > 0);
    }
    cJSON_Delete(document);
}

/* A lighter load may be held. A direction without waves of its own gives by the ratio of stiffness
 * of isotropic surfaces. */
static void a_load_is_held(void **state) {
    (void)state;
    static const char held[] = "\"friction\": 0.2, \"poisson\": 0.4, \"slip\": {\"pressure\": "
                               "0.05}, \"pressures\": {\"values\": [0.02, 0.2]}";
    char study[600];
    snprintf(study, sizeof study, SURFACE("%s"), held);
    cJSON *document = solve(study, 1);
    const cJSON *moved = curve_of(document, "tangential_displacement", "", "halfspace");
    const cJSON *gap = curve_of(document, "mean_gap", "", "halfspace");
    const cJSON *tangential = curve_of(document, "tangential_stiffness", "", "halfspace");
    const cJSON *normal = curve_of(document, "stiffness", "", "halfspace");
    const double ratio = (1 - 0.4) / (1 - 0.4 / 2);
    assert_near(json_number_at(moved, "/pressure", NAN), 0.05, 0, 0);
    assert_near(value_at(moved, 0.6), 0.2 / ratio * (value_at(gap, 0.02) - value_at(gap, 0.05)),
                1e-12, 0.6);
    assert_near(value_at(tangential, 0.2), ratio * value_at(normal, 0.2), 1e-12, 0.2);
    cJSON_Delete(document);
}

/* At a Poisson's ratio of nearly a half pressures do not move a profile along its face, so that
 * both solutions are one but for nodes whose pressure is within the tolerance of none. At 0.3
 * pressing with friction leaves less that sticks (0.75 becomes 0.49 of a cylinder at 0.45 of full
 * slip), and friction while only the tangential load rises about as much. */
static void pressures_and_tractions_couple(void **state) {
    (void)state;
    static const struct {
        const char *contact;
        double stick_least, stick_most, moved_least, moved_most;
    } CASES[] = {
        {"\"friction\": 0.3, \"slip\": {\"coupling\": true}, \"poisson\": 0.499", 0.97, 1.03, 0.998,
         1.002},
        {"\"friction\": 0.3, \"slip\": {\"coupling\": true}, \"poisson\": 0.3", 0.9, 1.1, 0.9,
         1.05},
        {"\"friction\": 0.3, \"slip\": {\"coupling\": true, \"pressing\": \"frictional\"}, "
         "\"poisson\": 0.3",
         0.5, 0.92, 1.01, 1.3}};
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        char study[600];
        snprintf(study, sizeof study, STUDY("\"tolerance\": 1e-6, %s"), CASES[c].contact);
        cJSON *document = solve(study, 2);
        const cJSON *stick[] = {curve_of(document, "stick_area", "nodes", "halfspace"),
                                curve_of(document, "stick_area", "coupled", "halfspace")};
        const cJSON *moved[] = {
            curve_of(document, "tangential_displacement", "", "halfspace"),
            curve_of(document, "tangential_displacement", "coupled", "halfspace")};
        for (int i = 0; i < 5; i++) {
            double sticks = at(stick[1], "/y", i) / at(stick[0], "/y", i);
            double moves = at(moved[1], "/y", i) / at(moved[0], "/y", i);
            if (!(sticks >= CASES[c].stick_least && sticks <= CASES[c].stick_most &&
                  moves >= CASES[c].moved_least && moves <= CASES[c].moved_most))
                fail_msg("case %zu, at %g of full slip: %.4f of what sticks, moved by %.4f", c,
                         at(stick[0], "/x", i), sticks, moves);
            assert_true(at(stick[1], "/cell_bound", i) > 0 && at(moved[1], "/cell_bound", i) > 0);
        }
        cJSON_Delete(document);
    }
}

/* Surfaces with lay give less along their long waves (0.76 to 0.9 of the stiffness across the face
 * at nu = 0.3 and a ratio of 3), as the contact itself does. */
static void lay_has_a_direction(void **state) {
    (void)state;
    double ratio[2];
    static const char *const DIRECTIONS[] = {"x", "y"};
    for (size_t d = 0; d < 2; d++) {
        char study[600];
        snprintf(study, sizeof study,
                 "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 4, "
                 "\"anisotropy\": 3, \"points_per_wavelength\": 4}, \"contact\": {\"friction\": "
                 "0.2, \"slip\": {\"direction\": \"%s\"}, \"pressures\": {\"values\": [0.1]}}}",
                 DIRECTIONS[d]);
        cJSON *document = solve(study, 2);
        const cJSON *kept = curve_of(document, "stiffness_ratio", "", "halfspace");
        ratio[d] = value_at(kept, 0.1);
        assert_near(value_at(curve_of(document, "tangential_stiffness", "", "halfspace"), 0.1),
                    ratio[d] * value_at(curve_of(document, "stiffness", "", "halfspace"), 0.1),
                    0.05, 0.1);
        cJSON_Delete(document);
    }
    if (!(ratio[0] > 0.7 && ratio[0] < 0.8 && ratio[1] > 0.84 && ratio[1] < 1))
        fail_msg("stiffness along x %.4g, along y %.4g of that across", ratio[0], ratio[1]);
}

/* Of a sphere (F26.4): load^(2/3) is the approach, and the integral of what a cycle takes is known.
 * The loads that are added leave 2e-3 of it at the last, where all but an eightieth slips. */
static void a_cycle_takes_the_work_of_a_sphere(void **state) {
    (void)state;
    const double mu = 0.25;
    double loads[1 + CONTACT_LOADS_ADDED] = {1}, values[MEASURE_PAIRED * POINTS];
    struct contact_case one_case = {.loads = loads,
                                    .load_count = 1,
                                    .friction = mu,
                                    .surface.dimension = 1,
                                    .blocks = {{.poisson = 0.3}}};
    one_case.slip_load = contact_loads_add(loads, &one_case.load_count, 1);
    assert_int_equal(one_case.load_count, CONTACT_LOADS_ADDED);
    for (size_t a = 0; a < MEASURE_PAIRED * POINTS; a++)
        values[a] = 1;
    for (size_t k = 0; k < one_case.load_count; k++) {
        values[FRICTION_APPROACH * POINTS + k] = pow(loads[k], 2. / 3);
        values[FRICTION_NORMAL * POINTS + k] = 1.5 * cbrt(loads[k]);
    }
    const struct measure_context context = {.one_case = &one_case};
    assert_int_equal(FRICTION_QUANTITY.complete(NULL, &context, NULL, POINTS, values, NULL), 0);
    for (size_t k = 0; k < one_case.slip_load; k++) {
        double moved = mu * (1 - pow(loads[k], 2. / 3)), tangential = mu * (1 - loads[k]);
        double under = mu * mu * (1 - loads[k] - 0.6 * (1 - pow(loads[k], 5. / 3)));
        double work = 4 * tangential * moved - 8 * under;
        check_relative(values[SLIP_WORK * POINTS + k], work, 2e-3);
    }
}

/* The load falls on a face that was flattened: more touches, and the gap stays smaller, than as it
 * rose. What slips then is of that path. */
static void what_yielded_unloads(void **state) {
    (void)state;
    cJSON *document = solve(STUDY("\"hardness\": 0.2, \"unload\": true, \"friction\": 0.2"), 2);
    const cJSON *area = curve_of(document, "unload_area", "nodes", "halfspace");
    const cJSON *nodes = curve_of(document, "contact_area", "nodes", "halfspace");
    const cJSON *gap = curve_of(document, "unload_gap", "", "halfspace");
    const cJSON *rising = curve_of(document, "mean_gap", "", "halfspace");
    const cJSON *left = curve_of(document, "permanent_approach", "", "halfspace");
    int last = cJSON_GetArraySize(json_at(area, "/x")) - 1;
    for (int k = 0; k <= last; k++) {
        double more = at(area, "/y", k) - at(nodes, "/y", k);
        double wider = at(gap, "/y", k) - at(rising, "/y", k);
        assert_true(k < last ? more > 0 && wider < 0 : fabs(more) < 1e-12 && fabs(wider) < 1e-9);
        assert_true(at(left, "/y", k) >= (k > 0 ? at(left, "/y", k - 1) : 0));
        assert_true(k < last || at(left, "/y", k) > 0);
        assert_true(at(area, "/discretisation_bound", k) > 0);
    }
    cJSON_Delete(document);
    document = solve(STUDY("\"hardness\": 0.2, \"friction\": 0.2"), 1);
    area = curve_of(document, "unload_area", "nodes", "halfspace");
    const cJSON *stick = curve_of(document, "stick_area", "nodes", "halfspace");
    assert_near(value_at(stick, 0.9), value_at(area, 0.01) / value_at(area, 0.1), 1e-12, 0.9);
    cJSON_Delete(document);
}

/* What a case without quantities holds is counted by what it has to: sums of 20 measures of the
 * values, 15 of their differences, whatever quantities exist. */
static void what_is_not_asked_for_takes_no_room(void **state) {
    (void)state;
    struct contact_case one_case;
    struct error err = {0};
    size_t without, with;
    cJSON *parameters = cJSON_Parse(STUDY("\"conductance\": false"));
    assert_int_equal(contact_case_read(&one_case, parameters, 0, NULL, &err), 0);
    cJSON_Delete(parameters);
    assert_int_equal(measure_paired(&one_case), MEASURE_QUANTITIES);
    for (size_t a = MEASURE_QUANTITIES; a < MEASURE_PAIRED; a++) {
        assert_false(measure_is_of(&one_case, a));
        assert_false(measure_row(a)->kept(&one_case) || measure_row(a)->shown(&one_case, 0));
    }
    contact_case_clear(&one_case);
    free(in_blocks(STUDY("\"conductance\": false"), 4, 4, &without));
    free(in_blocks(STUDY("\"conductance\": true"), 4, 4, &with));
    assert_true(with > without);
    for (size_t a = 0; a < MEASURE_OWN; a++) /* each has its curve once */
        for (size_t b = 0; b < a; b++)
            assert_true(MEASURE_CURVES[a] != MEASURE_CURVES[b]);
}

static void refuse(const char *contact, const char *expected) {
    struct contact_case one_case;
    struct error err = {0};
    char study[600];
    snprintf(study, sizeof study, STUDY("%s"), contact);
    cJSON *parameters = cJSON_Parse(study);
    assert_non_null(parameters);
    assert_int_equal(contact_case_read(&one_case, parameters, 0, NULL, &err), ERROR_INPUT);
    cJSON_Delete(parameters);
    assert_string_equal(err.text, expected);
}

static void what_does_not_fit_is_refused(void **state) {
    (void)state;
    refuse("\"conductance\": 1", "/contact/conductance: 1 is not true or false");
    refuse("\"resistivity\": [1e-7]",
           "/contact/resistivity: nothing conducts unless /contact/conductance is true");
    refuse("\"conductance\": true, \"resistivity\": [1e-7], \"conductivity\": [50]",
           "/contact/conductivity: give it or /contact/resistivity, not both");
    refuse("\"leak\": true",
           "/contact/leak: a profile leaks nothing, as each contact closes it; take "
           "a surface");
    refuse("\"hardness\": 0.1", "/contact/pressures/values: number 1 is a load of 0.1 E* h', and "
                                "nothing bears a load of the hardness, 0.1 E* h', or more");
    refuse("\"hardness\": 1, \"model\": [\"halfspace\", \"full\"]",
           "/contact/hardness: the model full does not yield; leave one of them out");
    refuse(
        "\"hardness\": 1, \"pressure_pdf\": {\"at\": [0.1]}",
        "/contact/pressure_pdf/at: many pressures are the hardness, so that they have no density; "
        "plastic_area and plastic_load say how many");
    refuse("\"unload\": true",
           "/contact/unload: an elastic block comes back as it went: give /contact/hardness, too");
    refuse("\"slip\": {\"pressure\": 0.1}",
           "/contact/slip/pressure: nothing slips unless /contact/friction is given");
    refuse("\"friction\": 0.1, \"slip\": {\"pressure\": 0.2}",
           "/contact/slip/pressure: 0.2, and the highest load is 0.1; allowed: none above it");
    refuse("\"friction\": 0.1, \"hardness\": 1, \"slip\": {\"pressure\": 0.01}",
           "/contact/slip/pressure: 0.01, and the highest load is 0.1; allowed: with a hardness "
           "that one");
    refuse("\"friction\": 0.1}, \"counter_surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 4, "
           "\"rms_slope\": 0.1, \"young\": 1, \"poisson\": 0.2",
           "/counter_surface/poisson: 0.2: how both bodies give along the face is known of one "
           "Poisson's ratio, that of /contact/poisson; allowed with friction: the same, or none");
    refuse("\"friction\": 0.1, \"coating\": {\"thickness\": 1, \"modulus\": 2}",
           "/contact/friction: how a coating gives tangentially is not known from its contact; "
           "leave one of them out");
    refuse("\"slip\": {\"coupling\": true}",
           "/contact/slip/coupling: nothing slips unless /contact/friction is given");
    refuse("\"friction\": 0.1, \"slip\": {\"pressing\": \"frictional\"}",
           "/contact/slip/pressing: /contact/slip/coupling is not asked for, nor friction of the "
           "model full");
    refuse("\"friction\": 0.1, \"slip\": {\"coupling\": true}, \"hardness\": 1",
           "/contact/slip/coupling: a block that yields has none; leave one of them out");
    refuse("\"friction\": 0.1, \"slip\": {\"coupling\": true}, \"block_height\": {\"lengths\": 1}",
           "/contact/slip/coupling: blocks of finite height have none; leave one of them out");
    refuse("\"friction\": 0.1, \"slip\": {\"coupling\": true}, \"model\": \"layered\"",
           "/contact/slip/coupling: the model layered has none, but an infinite half-space; leave "
           "one of them out");
    refuse("\"friction\": 0.1, \"slip\": {\"coupling\": true}}, \"counter_surface\": {\"hurst\": "
           "0.8, \"wavelength_ratio\": 4, \"rms_slope\": 0.1, \"young\": 1, \"poisson\": 0.3",
           "/contact/slip/coupling: it is that against a rigid body, and the counter body is "
           "elastic; leave one of them out");
    refuse("\"conductance\": true, \"resistivity\": [1, 2, 3]",
           "/contact/resistivity: [1,2,3] is not an array of 1 to 2 numbers");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(half_space_conducts_as_it_is_stiff),
        cmocka_unit_test(low_blocks_conduct_as_half_spaces),
        cmocka_unit_test(stiffness_may_be_omitted),
        cmocka_unit_test(what_yields_bears_the_hardness),
        cmocka_unit_test(friction_slips_by_lighter_loads),
        cmocka_unit_test(a_load_is_held),
        cmocka_unit_test(pressures_and_tractions_couple),
        cmocka_unit_test(lay_has_a_direction),
        cmocka_unit_test(a_cycle_takes_the_work_of_a_sphere),
        cmocka_unit_test(what_yielded_unloads),
        cmocka_unit_test(gaps_leak_until_they_close),
        cmocka_unit_test(those_that_stay_open_are_missing),
        cmocka_unit_test(blocks_do_not_matter),
        cmocka_unit_test(what_is_not_asked_for_takes_no_room),
        cmocka_unit_test(what_does_not_fit_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
