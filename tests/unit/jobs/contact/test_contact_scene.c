/* What the scene reports of the model full is of the block as it is pressed: areas stretched, and
 * pressures on these areas, which together carry the load; of small strains nothing is
 * stretched. Over the face as it stands, areas are less by its slopes, and what touches is the
 * same; so it is where gaps are along the normal. A limit of time ends the loads of a realisation,
 * with a note, and changes none before it. */
#include "core/contact/area.h"
#include "core/contact/patches.h"
#include "jobs/contact/case/contact_case_read.h"
#include "jobs/contact/contact_scene.h"
#include "tests/support/check.h"
#include "tests/support/contact_document.h"
#include "tests/support/effort.h"
#include "tests/support/unstopped.h"
#include <stdlib.h>
#include <string.h>

/* No cells of other lengths, which this file does not look at. Fine bins, so that their centres
 * give the mean pressure. */
#define PRESSED(dimension, kinematics) PRESSED_WITHIN(dimension, kinematics, "")
#define PRESSED_WITHIN(dimension, kinematics, limit)                                               \
    "{\"surface\": {\"dimension\": " dimension ", \"hurst\": 0.8, \"wavelength_ratio\": 2,"        \
    " \"length_ratio\": 2, \"points_per_wavelength\": 4, \"rms_slope\": 0.2}, \"contact\": {"      \
    "\"model\": [\"layered\", \"full\"], " limit "\"kinematics\": \"" kinematics "\", "            \
    "\"block_height\":"                                                                            \
    " {\"lengths\": 1}, \"cell_error\": \"none\", \"pressures\": {\"values\": [0.1, 0.3]}, "       \
    "\"pressure_pdf\": {\"at\":"                                                                   \
    " [0.1, 0.3], \"bins\": [0, 10, 10000]}}}"
#define CURRENT "\"areas\": \"current\", "
#define NORMAL "\"gap_direction\": \"normal\", "
enum { LAYERED, FULL, MODELS };

/* A study, and one surface pressed by the scene and, beside it, by a solver of its own. */
struct scene_fixture {
    struct contact_tally tally;
    struct contact_scene *scene;
    double *z;
    struct moments moments;
    struct contact_compliances compliances;
    struct contact_case one_case;
};

static void fixture_surface(struct scene_fixture *f) {
    struct generator *generator;
    struct surface_report report;
    struct error err = {0};
    const struct surface_case *surface = &f->one_case.surface;
    f->z = array_create(grid_points(&surface->grid), sizeof *f->z);
    assert_non_null(f->z);
    must(generator_create(&generator, &surface->spectrum, &surface->grid, &surface->options, &err),
         &err);
    modes_moments(generator_modes(generator), &f->moments);
    must(generator_run(generator, (struct random_key){4, 0, 0}, f->z, &report, &err), &err);
    generator_destroy(&generator);
}

static void fixture_open(struct scene_fixture *f, const char *text) {
    struct error err = {0};
    cJSON *parameters = cJSON_Parse(text);
    *f = (struct scene_fixture){0};
    assert_non_null(parameters);
    must(contact_case_read(&f->one_case, parameters, 0, NULL, &err), &err);
    fixture_surface(f);
    must(contact_compliances_create(&f->compliances, &f->one_case, &err), &err);
    must(contact_scene_create(&f->scene, &f->one_case, &f->moments, &f->compliances, &err), &err);
    must(contact_tally_create(&f->tally, &f->one_case, &err), &err);
    const struct contact_surface surface = {{4, 0, 0}, f->z};
    must(contact_scene_solve(f->scene, &surface, &f->tally, go_on, NULL, &err), &err);
    cJSON_Delete(parameters);
}

static void fixture_close(struct scene_fixture *f) {
    contact_scene_destroy(&f->scene);
    contact_compliances_clear(&f->compliances);
    contact_tally_clear(&f->tally);
    contact_case_clear(&f->one_case);
    free(f->z);
}

/* Areas of a state whose nodes in contact cover `now` times what they do on the undeformed face:
 * all areas by nodes are as many times as large. Edges lie where hardly any pressure acts: what is
 * open beyond them has grown as the open nodes have. */
static void check_areas(struct scene_fixture *f, size_t cell, const struct compliance *compliance,
                        const struct contact_pressed *pressed) {
    const struct contact_state *state = &pressed->state;
    const double now = pressed->stretch, face = 1 + pressed->face_tilt;
    const double share = now * (1 + pressed->contact_tilt) / face;
    struct area_workspace *workspace;
    struct patch_finder *finder;
    struct contact_area area;
    struct patches patches;
    struct error err = {0};
    double points = (double)grid_points(&compliance->grid);
    must(area_workspace_create(&workspace, compliance, &err), &err);
    must(patch_finder_create(&finder, &compliance->grid, &err), &err);
    contact_area(workspace, state, &area);
    patches_find(finder, state->p, &patches, NULL);
    double open = (1 - now * area.nodes) / (1 - area.nodes);
    const struct {
        enum contact_measure measure;
        double share;
    } AREAS[] = {{MEASURE_NODES, share * area.nodes},
                 {MEASURE_EDGES, (1 - (1 - area.edges) * open) / face},
                 {MEASURE_PERIMETER, (1 - (1 - area.perimeter) * open) / face},
                 {MEASURE_NODES_LOWER, share * area.lower},
                 {MEASURE_NODES_UPPER, share * area.upper},
                 {MEASURE_PATCH_MEAN, share * patches.mean / points},
                 {MEASURE_PATCH_LARGEST, share * (double)patches.largest / points}};
    size_t active = 0;
    assert_true(area.nodes < 1);
    for (size_t i = 0; i < grid_points(&compliance->grid); i++)
        active += state->p[i] > 0;
    check_relative(area.nodes, (double)active / points, 1e-14);
    for (size_t a = 0; a < sizeof AREAS / sizeof *AREAS; a++)
        if (!isnan(AREAS[a].share))
            check_relative(contact_tally_values(&f->tally, AREAS[a].measure)[cell], AREAS[a].share,
                           1e-12);
    patch_finder_destroy(&finder);
    area_workspace_destroy(&workspace);
}

/* Poisson's ratio 0.3: (1 - 2 nu)/(1 - nu) = 4/7. Of full the stretched edges are its edges unless
 * strains are small. */
static void check_stretched(struct scene_fixture *f, size_t cell, size_t model,
                            const struct contact_pressed *pressed) {
    double edges = contact_tally_values(&f->tally, MEASURE_EDGES)[cell];
    double stretched = contact_tally_values(&f->tally, MEASURE_EDGES_STRETCHED)[cell];
    double pressure = pressed->state.pressure;
    if (model == LAYERED)
        check_relative(stretched, edges - 4.0 / 7 * pressure * (1 - edges), 1e-12);
    else if (contact_case_stretches(&f->one_case, model))
        check_relative(stretched, edges, 1e-12);
    else
        check_relative(stretched, 1 - (1 - edges) * pressed->open_stretch, 1e-12);
    assert_true(model == FULL || stretched < edges);
    assert_true(edges < 1 && pressure > 0.01);
}

/* By a solver of its own, which presses the same surface to the same loads. */
static void areas_are_those_now(void **state) {
    (void)state;
    static const struct {
        const char *one_case;
        bool stretches;
    } CASES[] = {{PRESSED("1", "hencky"), true},
                 {PRESSED("2", "hencky"), true},
                 {PRESSED("1", "st_venant_kirchhoff"), true},
                 {PRESSED_WITHIN("1", "hencky", CURRENT), true},
                 {PRESSED_WITHIN("2", "hencky", CURRENT), true},
                 {PRESSED("1", "small"), false},
                 {PRESSED("2", "small"), false}};
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c += case_step()) {
        struct scene_fixture f;
        struct error err = {0};
        fixture_open(&f, CASES[c].one_case);
        for (size_t m = 0; m < MODELS; m++) {
            const struct compliance *compliance = f.compliances.of[m][0];
            const struct contact_model *model = f.one_case.models[m];
            struct contact_solver *solver;
            double facts[MODEL_FACTS_MOST];
            must(model->create(&solver, &f.one_case, m, compliance, &err), &err);
            must(model->begin(solver, f.z, go_on, NULL, facts, &err), &err);
            for (size_t k = 0; k < f.one_case.load_count; k++) {
                struct contact_pressed pressed = {.stretch = 1, .open_stretch = NAN};
                must(
                    model->press(solver, f.one_case.loads[k] * f.moments.rms_slope, &pressed, &err),
                    &err);
                bool stretched = m == FULL && CASES[c].stretches;
                assert_true(stretched == (fabs(pressed.stretch - 1) > 1e-3));
                size_t cell = contact_case_cell(&f.one_case, m, 0, k);
                check_areas(&f, cell, compliance, &pressed);
                check_stretched(&f, cell, m, &pressed);
            }
            model->destroy(&solver);
        }
        fixture_close(&f);
    }
}

/* Integral and first moment; centres of bins are within half a bin's width of what they hold. */
static void check_density(const cJSON *curve, double area, double load) {
    double width = at(curve, "/x", 1) - at(curve, "/x", 0), sum = 0, moment = 0;
    const cJSON *x = json_at(curve, "/x")->child, *y;
    cJSON_ArrayForEach(y, json_at(curve, "/y")) {
        sum += width * y->valuedouble;
        moment += width * y->valuedouble * x->valuedouble;
        x = x->next;
    }
    assert_true(x == NULL && y == NULL && sum > 0);
    assert_near(json_at(curve, "/underflow")->valuedouble, 0, 0, 0);
    assert_near(json_at(curve, "/overflow")->valuedouble, 0, 0, 0);
    check_relative(sum, area, 1e-6);
    assert_near(moment, load, width / 2 * sum, load);
}

/* Over the face as it stands all areas by edges are a share of those over the flat, and so is the
 * load: pressures are the same. */
static void pressures_carry_the_load(void **state) {
    (void)state;
    static const char *const STUDIES[] = {PRESSED("1", "hencky"), PRESSED("2", "hencky"),
                                          PRESSED("1", "small"),
                                          PRESSED_WITHIN("1", "hencky", CURRENT)};
    static const char *const MODEL[] = {"layered", "full"};
    for (size_t c = 0; c < sizeof STUDIES / sizeof *STUDIES; c += case_step()) {
        cJSON *document = solve(STUDIES[c], 3);
        cJSON *flat = c == 3 ? solve(STUDIES[0], 3) : NULL;
        for (size_t m = 0; m < MODELS; m++) {
            const cJSON *area = curve_of(document, "contact_area", "edges", MODEL[m]);
            const cJSON *over =
                curve_of(c == 3 ? flat : document, "contact_area", "edges", MODEL[m]);
            const cJSON *curve = curve_of(document, "contact_pressure_pdf", "", MODEL[m]);
            for (int k = 0; k < 2; k++, curve = curve->next) {
                double share = at(area, "/y", k) / at(over, "/y", k);
                assert_true((share < 0.999) == (c == 3 && m == FULL));
                check_density(curve, at(area, "/y", k), share * at(area, "/x", k));
            }
        }
        cJSON_Delete(document);
        cJSON_Delete(flat);
    }
}

/* Where the model's edges are not stretched already, and where a slope is known. */
static void stretched_edges_need_a_slope(void **state) {
    (void)state;
    static const struct {
        const char *study;
        bool layered, full;
    } CASES[] = {{PRESSED("1", "hencky"), true, false},
                 {PRESSED("1", "small"), true, true},
                 {"{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 2,"
                  " \"length_ratio\": 2, \"points_per_wavelength\": 4}, \"contact\": {\"model\":"
                  " \"layered\", \"pressures\": {\"values\": [0.1, 0.3]}}}",
                  false, false}};
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        cJSON *document = solve(CASES[c].study, 2);
        bool layered = false, full = false;
        const cJSON *curve;
        cJSON_ArrayForEach(curve, json_at(document, "/curves")) {
            bool stretched = text_is(curve, "/series", "edges_stretched");
            layered = layered || (stretched && text_is(curve, "/model", "layered"));
            full = full || (stretched && text_is(curve, "/model", "full"));
        }
        assert_true(layered == CASES[c].layered && full == CASES[c].full);
        cJSON_Delete(document);
    }
}

/* Returns a measure of a load. */
static double measured(struct scene_fixture *f, enum contact_measure measure, size_t model,
                       size_t load) {
    return contact_tally_values(&f->tally,
                                measure)[contact_case_cell(&f->one_case, model, 0, load)];
}

/* What is measured on the face as it stands, on one solution: its iterations are the same to the
 * digit, as is what does not concern it. Slopes of 0.2 in the mean leave a few percent of area. */
static void faces_are_measured_as_they_stand(void **state) {
    (void)state;
    static const char *const STUDIES[2][4] = {
        {PRESSED("1", "hencky"), PRESSED_WITHIN("1", "hencky", "\"areas\": \"flat\", "),
         PRESSED_WITHIN("1", "hencky", CURRENT), PRESSED_WITHIN("1", "hencky", NORMAL)},
        {PRESSED("2", "hencky"), PRESSED_WITHIN("2", "hencky", "\"gap_direction\": \"vertical\", "),
         PRESSED_WITHIN("2", "hencky", CURRENT), PRESSED_WITHIN("2", "hencky", NORMAL)}};
    static const enum contact_measure SAME[] = {MEASURE_ITERATIONS, MEASURE_STIFFNESS,
                                                MEASURE_PATCHES, MEASURE_PENETRATION};
    for (size_t c = 0; c < 2; c++) {
        struct scene_fixture f[4];
        for (size_t a = 0; a < 4; a++)
            fixture_open(&f[a], STUDIES[c][a]);
        for (size_t k = 0; k < 2; k++) {
            double nodes = measured(&f[0], MEASURE_NODES, FULL, k);
            double edges = measured(&f[0], MEASURE_EDGES, FULL, k);
            double gap = measured(&f[0], MEASURE_GAP, FULL, k);
            for (size_t a = 1; a < 4; a++) {
                for (size_t s = 0; s < sizeof SAME / sizeof *SAME; s++)
                    assert_true(measured(&f[a], SAME[s], FULL, k) ==
                                measured(&f[0], SAME[s], FULL, k));
                for (size_t s = 0; s < MEASURE_QUANTITIES; s++) {
                    double before = measured(&f[0], (enum contact_measure)s, LAYERED, k);
                    double now = measured(&f[a], (enum contact_measure)s, LAYERED, k);
                    assert_true(now == before || (isnan(now) && isnan(before)));
                }
            }
            assert_true(measured(&f[1], MEASURE_NODES, FULL, k) == nodes);
            assert_true(measured(&f[1], MEASURE_EDGES, FULL, k) == edges);
            assert_true(measured(&f[1], MEASURE_GAP, FULL, k) == gap);
            assert_true(measured(&f[3], MEASURE_NODES, FULL, k) == nodes);
            assert_true(measured(&f[3], MEASURE_EDGES, FULL, k) == edges);
            double least = measured(&f[2], MEASURE_EDGES, FULL, k) / edges;
            assert_true(least < 0.998 && least > 0.95);
            least = measured(&f[2], MEASURE_NODES, FULL, k) / nodes;
            assert_true(least < 0.9999 && least > 0.95);
            double turned = measured(&f[3], MEASURE_GAP, FULL, k) / gap;
            assert_true(turned > 1.001 && turned < 1.1);
            assert_true(measured(&f[2], MEASURE_GAP, FULL, k) != gap);
        }
        for (size_t a = 0; a < 4; a++)
            fixture_close(&f[a]);
    }
}

/* The limit is looked at within load steps: none of the loads of full has a value, and the other
 * model keeps its own. */
static void a_limit_ends_loads(void **state) {
    (void)state;
    struct scene_fixture free_of_it, within;
    fixture_open(&free_of_it, PRESSED("1", "hencky"));
    fixture_open(&within, PRESSED_WITHIN("1", "hencky", "\"time_limit\": 1e-9, "));
    assert_int_equal(free_of_it.tally.notes.count, 0);
    assert_int_equal(within.tally.notes.count, 1);
    assert_non_null(strstr(within.tally.notes.kept[0].text, "load 0.1, reached 0: "));
    assert_non_null(
        strstr(within.tally.notes.kept[0].text, "the time limit of 1e-09 s was used up"));
    for (size_t m = 0; m < MODELS; m++)
        for (size_t k = 0; k < 2; k++) {
            size_t cell = contact_case_cell(&within.one_case, m, 0, k);
            double before = contact_tally_values(&free_of_it.tally, MEASURE_EDGES)[cell];
            double now = contact_tally_values(&within.tally, MEASURE_EDGES)[cell];
            assert_true(m == FULL ? isnan(now) : now == before);
        }
    fixture_close(&free_of_it);
    fixture_close(&within);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(areas_are_those_now),
        cmocka_unit_test(pressures_carry_the_load),
        cmocka_unit_test(stretched_edges_need_a_slope),
        cmocka_unit_test(faces_are_measured_as_they_stand),
        cmocka_unit_test(a_limit_ends_loads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
