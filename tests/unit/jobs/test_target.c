/* Protects: realisations of components go as the square root of variance over cost, and are enough
 * for the error asked for; a plan depends on its arguments alone; what is done is never undone; the
 * time there is is kept. */
#include "jobs/kind.h"
#include "jobs/target.h"
#include "schema/study/study_reader.h"
#include "tests/support/check.h"
#include <stdio.h>
#include <string.h>

static const struct target TARGET = {.error = 0.01, .confidence = 0.95, .max_seconds = INFINITY};

/* Rounds until nothing is wanted; returns how many. */
static size_t rounds(const struct target_plan *plan, size_t count, struct target_part *parts) {
    uint64_t wanted[TARGET_PARTS_MOST];
    for (size_t n = 0;; n++) {
        bool grows = false;
        target_allot(plan, count, parts, wanted);
        for (size_t a = 0; a < count; a++) {
            assert_true(wanted[a] >= parts[a].done);
            grows = grows || wanted[a] > parts[a].done;
            parts[a].done = wanted[a];
        }
        if (!grows)
            return n;
        assert_true(n < 100);
    }
}

static double reached(size_t count, const struct target_part *parts, size_t point) {
    double standard_error;
    double quantile = target_quantile(&TARGET, count, parts, point, &standard_error);
    return quantile * standard_error;
}

/* Three components far enough from their first numbers that these do not matter. */
static void allots_by_variance_and_cost(void **state) {
    (void)state;
    const double base = 1, mesh = 1e-2, model = 1e-3, allowed = 0.01;
    struct target_part parts[] = {
        {16, 1, 1e-3, &base}, {8, 10, 1e-2, &mesh}, {8, 400, 0.4, &model}};
    double multiplier, quantile;
    const struct target_plan plan = {&TARGET, 1, &allowed, &multiplier, &quantile};
    assert_true(rounds(&plan, 3, parts) > 1);
    const double z = 1.959964;
    double sum = sqrt(1.0 * 1) + sqrt(1e-2 * 10) + sqrt(1e-3 * 400);
    for (size_t a = 0; a < 3; a++) {
        double best = z * z / (allowed * allowed) * sqrt(*parts[a].variance / parts[a].work) * sum;
        check_relative((double)parts[a].done, best, 0.12);
    }
    double width = reached(3, parts, 0);
    assert_true(width <= allowed && width > 0.9 * allowed);
}

/* Each point has its own allowance: the hardest decides. A point without one is left out. */
static void meets_every_point(void **state) {
    (void)state;
    const double base[] = {1, 4, 1}, mesh[] = {0.3, 0.01, 7}, allowed[] = {0.05, 0.2, NAN};
    struct target_part parts[] = {{32, 1, 1, base}, {8, 5, 5, mesh}};
    double multipliers[3], quantiles[3];
    const struct target_plan plan = {&TARGET, 3, allowed, multipliers, quantiles};
    rounds(&plan, 2, parts);
    for (size_t k = 0; k < 2; k++)
        assert_true(reached(2, parts, k) <= allowed[k]);
    uint64_t wanted[2];
    target_allot(&plan, 2, parts, wanted);
    assert_int_equal(wanted[0], parts[0].done);
    assert_int_equal(wanted[1], parts[1].done);
}

/* Two parts that are hard at points of their own need no more than each at its point. The work is
 * that of a search over all numbers, and less than where each point is met by its worst parts. */
static void takes_the_least_work(void **state) {
    (void)state;
    const double base[] = {1, 0.1}, mesh[] = {0.02, 0.5}, allowed[] = {0.1, 0.1};
    const struct target_part parts[] = {{10, 1, 1, base}, {10, 3, 3, mesh}};
    double multipliers[2], quantiles[2], needed[2];
    const struct target_plan plan = {&TARGET, 2, allowed, multipliers, quantiles};
    double work = target_least_work(&plan, 2, parts, needed), best = INFINITY;
    const double z = 1.959964, scale = z * z / (0.1 * 0.1);
    for (double n = 10; n < 4000; n *= 1.0005) {
        double left =
            fmin((1 - scale * base[0] / n) / mesh[0], (1 - scale * base[1] / n) / mesh[1]);
        if (left > 0)
            best = fmin(best, n - 10 + 3 * (fmax(10, scale / left) - 10));
    }
    check_relative(work, best, 2e-3);
    double separate = sqrt(1.0) + sqrt(0.5 * 3);
    assert_true(work < 0.8 * scale * separate * separate);
    for (size_t k = 0; k < 2; k++)
        assert_true(scale * (base[k] / needed[0] + mesh[k] / needed[1]) < 1.001);
}

static void is_the_same_each_time(void **state) {
    (void)state;
    const double base = 1, mesh = 1e-2, allowed = 0.01;
    const struct target_part parts[] = {{100, 3, 1, &base}, {9, 17, 1, &mesh}};
    double multiplier, quantile;
    const struct target_plan plan = {&TARGET, 1, &allowed, &multiplier, &quantile};
    uint64_t first[2], again[2];
    target_allot(&plan, 2, parts, first);
    target_allot(&plan, 2, parts, again);
    assert_memory_equal(first, again, sizeof first);
    assert_true(first[0] > 100);
}

/* Few realisations of a difference widen the interval, as Student's quantile has it. */
static void distrusts_few_realisations(void **state) {
    (void)state;
    const double one = 1;
    double standard_error;
    const struct target_part few = {4, 1, 1, &one}, many = {100000, 1, 1, &one};
    check_close(target_quantile(&TARGET, 1, &few, 0, &standard_error), 3.182446, 1e-5);
    check_close(standard_error, 0.5, 1e-15);
    check_close(target_quantile(&TARGET, 1, &many, 0, &standard_error), 1.95998, 1e-4);
}

/* What Student's quantile asks for beyond the normal one is paid where it costs least. */
static void pays_what_few_realisations_ask_for_where_it_is_cheap(void **state) {
    (void)state;
    const double dear = 6e-5, cheap = 1e-2, allowed = 0.0207; /* 1.96 and 1.98 times 0.01049 */
    struct target_part parts[] = {{6, 1000, 1, &dear}, {100, 1, 1, &cheap}};
    double multiplier, quantile;
    const struct target_plan plan = {&TARGET, 1, &allowed, &multiplier, &quantile};
    assert_true(reached(2, parts, 0) > allowed && reached(2, parts, 0) < 1.01 * allowed);
    assert_true(rounds(&plan, 2, parts) > 0);
    assert_int_equal(parts[0].done, 6);
    assert_true(parts[1].done > 100 && reached(2, parts, 0) <= allowed);
}

/* A round that would take longer than there is is cut, and the next adds nothing. */
static void keeps_within_the_time(void **state) {
    (void)state;
    const double base = 1, allowed = 1e-3;
    struct target target = TARGET;
    target.max_seconds = 500;
    struct target_part part = {100, 1, 2, &base};
    double multiplier, quantile;
    const struct target_plan plan = {&target, 1, &allowed, &multiplier, &quantile};
    rounds(&plan, 1, &part);
    assert_true(2 * (double)part.done <= 500 && part.done >= 240);
}

/* --- a study --- */

static const char STUDY[] =
    "{\"name\":\"t\",\"kind\":\"contact\",\"target\":{\"error\":0.01%s},\"surface\":{"
    "\"dimension\":1,\"hurst\":0.8,\"wavelength_ratio\":4,\"rms_slope\":0.1%s},\"contact\":{"
    "\"model\":%s%s}}";

static struct study *read_study(const char *target, const char *surface, const char *model,
                                const char *contact, struct fault_list *faults) {
    char text[1024];
    struct study *study = NULL;
    struct error err = {0};
    snprintf(text, sizeof text, STUDY, target, surface, model, contact);
    if (kind_read_study(&study, text, strlen(text), NULL, faults, &err) != 0)
        return NULL;
    return study;
}

static const struct study_case *component(const struct study *study, const char *role) {
    for (size_t a = 0; a < study->cases[0].component_count; a++)
        if (strcmp(study->cases[0].components[a].role, role) == 0)
            return &study->cases[0].components[a];
    return NULL;
}

static double number_at(const struct study_case *one, const char *path) {
    const cJSON *value = json_at(one->parameters, path);
    return cJSON_IsNumber(value) ? value->valuedouble : (double)NAN;
}

/* What the study leaves out is chosen, and no parameter of the case. */
static void chooses_what_is_left_out(void **state) {
    (void)state;
    struct fault_list faults = {0};
    struct study *study = read_study("", "", "\"full\"", "", &faults);
    assert_non_null(study);
    assert_int_equal(study->realisations, 0);
    assert_int_equal(study->cases[0].component_count, 8);
    const struct study_case *base = component(study, "base"), *cell = component(study, "cell");
    double length = number_at(base, "/surface/length_ratio");
    assert_true(length >= 8);
    check_close(number_at(cell, "/surface/length_ratio"), length / 4, 0);
    check_close(number_at(component(study, "longer"), "/surface/length_ratio"), 4 * length, 0);
    const cJSON *coarse = json_at(component(study, "model")->parameters, "/contact/levels");
    const cJSON *mesh = json_at(component(study, "model_mesh")->parameters, "/contact/levels");
    assert_int_equal(cJSON_GetArraySize(coarse), 1);
    assert_int_equal(cJSON_GetArraySize(mesh), 3);
    check_close(coarse->child->valuedouble, mesh->child->valuedouble, 0);
    assert_true(isnan(number_at(&study->cases[0], "/surface/length_ratio")));
    assert_int_equal(
        cJSON_GetArraySize(json_at(component(study, "model")->parameters, "/contact/model")), 2);
    uint64_t expected[TARGET_PARTS_MOST];
    assert_true(target_expect(&study->cases[0], expected) > 0);
    for (size_t a = 0; a < 7; a++) {
        const struct study_case *one = &study->cases[0].components[a];
        bool later = strcmp(one->role, "longer") == 0 || strcmp(one->role, "longest") == 0;
        assert_null(json_at(one->parameters, "/target"));
        assert_true((one->realisations == 0) == later && one->cost.seconds > 0 && one->block > 0);
        assert_true(one == base ? expected[a] > one->realisations
                                : expected[a] >= one->realisations);
    }
    study_destroy(&study);
}

static const char *first_model(const struct study_case *one) {
    return json_at(one->parameters, "/contact/model")->child->valuestring;
}

static double coarsest_points(const struct study_case *one) {
    return json_at(one->parameters, "/contact/levels")->child->valuedouble;
}

/* Full is compared with its own elements, on columns that widen as deep as the error asks, and on
 * finer meshes for a small one; a named mesh with what the other components see of it. */
static void compares_models_as_the_error_asks(void **state) {
    (void)state;
    static const char path[] = "/contact/transition_depth";
    struct fault_list faults = {0};
    struct study *coarse = read_study("", "", "\"full\"", "", &faults);
    struct study *small = NULL;
    static const char SMALL[] = "{\"name\":\"t\",\"kind\":\"contact\",\"target\":{\"error\":0.002},"
                                "\"surface\":{\"dimension\":1,\"hurst\":0.8,\"wavelength_ratio\":4,"
                                "\"rms_slope\":0.1},\"contact\":{\"model\":\"full\"}}";
    assert_int_equal(kind_read_study(&small, SMALL, strlen(SMALL), NULL, &faults, NULL), 0);
    struct study *named =
        read_study("", "", "\"full\"", ",\"levels\":[8],\"transition_depth\":9", &faults);
    assert_non_null(coarse);
    assert_non_null(named);
    const struct study_case *mesh = component(coarse, "model_mesh");
    assert_string_equal(first_model(mesh), "layered");
    check_close(coarsest_points(mesh), 8, 0);
    double depth = number_at(mesh, path);
    assert_true(depth > 8 && depth < 16);
    assert_true(isnan(number_at(&coarse->cases[0], path)));
    const struct study_case *finer = component(small, "model_mesh");
    check_close(coarsest_points(finer), 16, 0);
    check_close(coarsest_points(component(small, "model")), 16, 0);
    assert_true(number_at(finer, path) > 1.5 * depth);
    assert_string_equal(first_model(component(named, "model")), "halfspace");
    check_close(number_at(component(named, "model"), path), 9, 0);
    study_destroy(&coarse);
    study_destroy(&small);
    study_destroy(&named);
}

/* A component that may never be needed does not keep a study from running where it has no room. */
static void goes_without_what_has_no_room(void **state) {
    (void)state;
    char text[1024];
    struct fault_list faults = {0};
    struct study *all = NULL, *fitting = NULL;
    snprintf(text, sizeof text, STUDY, "", "", "\"halfspace\"", "");
    size_t size = strlen(text);
    assert_int_equal(study_read(&all, text, size, NULL, JOB_KINDS, 0, &faults, NULL), 0);
    double most = component(all, "longest")->cost.memory_bytes;
    for (size_t a = 0; a < all->cases[0].component_count; a++)
        if (strcmp(all->cases[0].components[a].role, "longest") != 0)
            assert_true(all->cases[0].components[a].cost.memory_bytes < most);
    assert_int_equal(study_read(&fitting, text, size, NULL, JOB_KINDS, most - 1, &faults, NULL), 0);
    assert_int_equal(faults.count, 0);
    assert_null(component(fitting, "longest"));
    assert_int_equal(fitting->cases[0].component_count, all->cases[0].component_count - 1);
    double base = component(all, "base")->cost.memory_bytes;
    study_destroy(&fitting);
    assert_int_equal(study_read(&fitting, text, size, NULL, JOB_KINDS, base - 1, &faults, NULL),
                     ERROR_INPUT);
    assert_true(faults.count > 0);
    fault_list_clear(&faults);
    study_destroy(&all);
}

/* What it names is kept: no cell beside the named one, no mesh beyond the named level. */
static void keeps_what_is_named(void **state) {
    (void)state;
    struct fault_list faults = {0};
    struct study *study =
        read_study("", ",\"length_ratio\":6", "\"layered\"",
                   ",\"levels\":[8],\"tolerance\":1e-6,\"block_height\":{\"lengths\":2}", &faults);
    assert_non_null(study);
    assert_null(component(study, "cell"));
    assert_null(component(study, "model_mesh"));
    const struct study_case *base = component(study, "base"), *model = component(study, "model");
    check_close(number_at(base, "/surface/length_ratio"), 6, 0);
    check_close(number_at(base, "/contact/tolerance"), 1e-6, 0);
    check_close(number_at(base, "/contact/block_height/lengths"), 2, 0);
    check_close(number_at(model, "/contact/block_height/lengths"),
                2 * 6 / number_at(model, "/surface/length_ratio"), 1e-12);
    const cJSON *levels = json_at(component(study, "mesh")->parameters, "/contact/levels");
    check_close(cJSON_GetArrayItem(levels, cJSON_GetArraySize(levels) - 1)->valuedouble, 8, 0);
    study_destroy(&study);
}

/* All cells have the shape of a rectangle that the study names, none is narrower than a longest
 * wave; the length of one whose length it does not name is not chosen. */
static void keeps_the_shape_of_a_rectangle(void **state) {
    (void)state;
    struct fault_list faults = {0};
    struct study *study = NULL;
    static const char TEXT[] =
        "{\"name\":\"t\",\"kind\":\"contact\",\"target\":{\"error\":0.02},"
        "\"surface\":{\"hurst\":0.8,\"wavelength_ratio\":4,\"rms_slope\":0.1,"
        "%s\"length_ratio_y\":4},\"contact\":{\"model\":\"full\"}}";
    char text[512];
    snprintf(text, sizeof text, TEXT, "\"length_ratio\":12,");
    assert_int_equal(kind_read_study(&study, text, strlen(text), NULL, &faults, NULL), 0);
    assert_true(study->cases[0].component_count > 3);
    for (size_t a = 0; a < study->cases[0].component_count; a++) {
        const struct study_case *one = &study->cases[0].components[a];
        double along_y = number_at(one, "/surface/length_ratio_y");
        check_relative(number_at(one, "/surface/length_ratio"), 3 * along_y, 1e-15);
        assert_true(along_y >= 1);
    }
    const struct study_case *base = component(study, "base");
    assert_true(number_at(base, "/surface/length_ratio") == 12);
    assert_int_equal(base->cost.nx, 3 * base->cost.ny);
    assert_true(number_at(component(study, "model"), "/surface/length_ratio") < 12);
    study_destroy(&study);
    snprintf(text, sizeof text, TEXT, "");
    assert_int_equal(kind_read_study(&study, text, strlen(text), NULL, &faults, NULL), ERROR_INPUT);
    assert_int_equal(faults.count, 1);
    assert_non_null(strstr(faults.faults[0].pointer, "length_ratio_y"));
    assert_non_null(strstr(faults.faults[0].detail, "square cells alone"));
    fault_list_clear(&faults);
}

/* All components have the waves that the Nayak parameter gives on the cell of the base. */
static void solves_the_nayak_parameter_once(void **state) {
    (void)state;
    struct fault_list faults = {0};
    struct study *study = NULL;
    static const char TEXT[] =
        "{\"name\":\"t\",\"kind\":\"contact\",\"target\":{\"error\":0.05},\"surface\":{"
        "\"dimension\":1,\"hurst\":0.8,\"nayak_alpha\":4,\"rms_slope\":0.1}}";
    assert_int_equal(kind_read_study(&study, TEXT, strlen(TEXT), NULL, &faults, NULL), 0);
    double ratio = number_at(component(study, "base"), "/surface/wavelength_ratio");
    assert_true(ratio > 1);
    for (size_t a = 0; a < study->cases[0].component_count; a++)
        check_close(number_at(&study->cases[0].components[a], "/surface/wavelength_ratio"), ratio,
                    0);
    study_destroy(&study);
}

/* What a target cannot answer it does not drop: each has its pointer and reason, and what is given
 * as the target has it anyway is none. */
static void refuses_what_it_does_not_answer(void **state) {
    (void)state;
    static const char *const REFUSED[][3] = {
        {",\"estimators\":[\"perimeter\"]", "/contact/estimators", "is for surfaces"},
        {",\"stiffness\":\"some\"", "/contact/stiffness", "measured"},
        {",\"pressure_pdf\":{\"pairs\":\"omitted\"}", "/contact/pressure_pdf/pairs",
         "leave it out, or take \"counted\""},
        {",\"pressure_pdf\":{\"at\":[0.123]}", "/contact/pressure_pdf/at", "none of the study's"},
        {",\"cell_error\":\"none\"", "/contact/cell_error", "whose length is left out"},
        {"},\"counter_surface\":{\"hurst\":0.5,\"wavelength_ratio\":4,\"rms_slope\":1",
         "/counter_surface", "one rough face"},
        {",\"levels\":[4,8]", "/contact/levels", "give one level"}};
    for (size_t a = 0; a < sizeof REFUSED / sizeof *REFUSED; a++) {
        struct fault_list faults = {0};
        assert_null(read_study("", "", "\"halfspace\"", REFUSED[a][0], &faults));
        assert_int_equal(faults.count, 1);
        assert_string_equal(faults.faults[0].pointer, REFUSED[a][1]);
        assert_non_null(strstr(faults.faults[0].detail, REFUSED[a][2]));
        fault_list_clear(&faults);
    }
}

/* Components measure what is asked for, and edges, of which the error is; no more. */
static void measures_what_is_asked_for(void **state) {
    (void)state;
    static const char *const ASKED[][3] = {
        {"", "[\"edges\"]", "omitted"},
        {",\"estimators\":\"nodes\"", "[\"edges\",\"nodes\"]", "omitted"},
        {",\"estimators\":[\"nodes\",\"edges\"],\"stiffness\":\"measured\"",
         "[\"edges\",\"nodes\"]", "measured"},
        {",\"stiffness\":\"omitted\"", "[\"edges\"]", "omitted"}};
    for (size_t a = 0; a < sizeof ASKED / sizeof *ASKED; a++) {
        struct fault_list faults = {0};
        struct study *study = read_study("", "", "\"halfspace\"", ASKED[a][0], &faults);
        assert_non_null(study);
        for (size_t c = 0; c < study->cases[0].component_count; c++) {
            const cJSON *parameters = study->cases[0].components[c].parameters;
            char *estimators = cJSON_PrintUnformatted(json_at(parameters, "/contact/estimators"));
            assert_string_equal(estimators, ASKED[a][1]);
            assert_string_equal(cJSON_GetStringValue(json_at(parameters, "/contact/stiffness")),
                                ASKED[a][2]);
            cJSON_free(estimators);
        }
        study_destroy(&study);
    }
}

static const char *text_at(const struct study_case *one, const char *path) {
    return cJSON_GetStringValue(json_at(one->parameters, path));
}

/* Densities are answered where the study gives their loads or bins, and then at its highest load.
 * Components with several models or levels count the differences. */
static void counts_the_densities_that_are_asked_for(void **state) {
    (void)state;
    static const struct {
        const char *contact, *at;
    } ASKED[] = {{"", NULL},
                 {",\"pressure_pdf\":{\"bins\":[0,2,10]}", "[0.3]"},
                 {",\"pressure_pdf\":{\"at\":[0.1,0.2]}", "[0.1,0.2]"},
                 {",\"pressure_pdf\":{\"at\":[0.2],\"pairs\":\"counted\"}", "[0.2]"}};
    for (size_t a = 0; a < sizeof ASKED / sizeof *ASKED; a++) {
        struct fault_list faults = {0};
        struct study *study = read_study("", "", "\"full\"", ASKED[a].contact, &faults);
        assert_non_null(study);
        for (size_t c = 0; c < study->cases[0].component_count; c++) {
            const struct study_case *one = &study->cases[0].components[c];
            const cJSON *loads = json_at(one->parameters, "/contact/pressure_pdf/at");
            bool counted = text_at(one, "/contact/pressure_pdf/pairs") != NULL;
            bool several = cJSON_GetArraySize(json_at(one->parameters, "/contact/model")) > 1 ||
                           cJSON_GetArraySize(json_at(one->parameters, "/contact/levels")) > 1;
            char *text = loads != NULL ? cJSON_PrintUnformatted(loads) : NULL;
            assert_int_equal(counted, several && ASKED[a].at != NULL);
            assert_int_equal(text != NULL, ASKED[a].at != NULL);
            if (text != NULL)
                assert_string_equal(text, ASKED[a].at);
            cJSON_free(text);
        }
        study_destroy(&study);
    }
}

static void tells_faults(void **state) {
    (void)state;
    static const struct {
        const char *target, *model, *text;
    } WRONG[] = {{",\"confidence\":2", "\"halfspace\"", "confidence"},
                 {",\"eror\":1", "\"halfspace\"", "eror"},
                 {"", "[\"halfspace\",\"full\"]", "one model"}};
    for (size_t a = 0; a < sizeof WRONG / sizeof *WRONG; a++) {
        struct fault_list faults = {0};
        assert_null(read_study(WRONG[a].target, "", WRONG[a].model, "", &faults));
        assert_true(faults.count > 0);
        assert_true(strstr(faults.faults[0].detail, WRONG[a].text) != NULL ||
                    strstr(faults.faults[0].pointer, WRONG[a].text) != NULL);
        fault_list_clear(&faults);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(allots_by_variance_and_cost),
        cmocka_unit_test(meets_every_point),
        cmocka_unit_test(takes_the_least_work),
        cmocka_unit_test(is_the_same_each_time),
        cmocka_unit_test(distrusts_few_realisations),
        cmocka_unit_test(pays_what_few_realisations_ask_for_where_it_is_cheap),
        cmocka_unit_test(keeps_within_the_time),
        cmocka_unit_test(chooses_what_is_left_out),
        cmocka_unit_test(compares_models_as_the_error_asks),
        cmocka_unit_test(goes_without_what_has_no_room),
        cmocka_unit_test(keeps_what_is_named),
        cmocka_unit_test(keeps_the_shape_of_a_rectangle),
        cmocka_unit_test(refuses_what_it_does_not_answer),
        cmocka_unit_test(measures_what_is_asked_for),
        cmocka_unit_test(counts_the_densities_that_are_asked_for),
        cmocka_unit_test(tells_faults),
        cmocka_unit_test(solves_the_nayak_parameter_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
