/* A contact case is read as it was meant: defaults, models, blocks, loads, meshes; and what does
 * not fit together is refused, with its pointer. */
#include "core/surface/spectrum.h"
#include "jobs/contact/case/contact_case_read.h"
#include "jobs/contact/coated_theory.h"
#include "jobs/contact/contact_scene.h"
#include "schema/study/fault.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#define PROFILE "\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 2"
#define STUDY(surface, contact) "{\"surface\": {" surface "}, \"contact\": {" contact "}}"

static struct contact_case read_case(const char *text) {
    struct contact_case one_case;
    struct error err = {0};
    cJSON *parameters = cJSON_Parse(text);
    assert_non_null(parameters);
    if (contact_case_read(&one_case, parameters, 0, NULL, &err) != 0)
        fail_msg("%s: %s", text, err.text);
    cJSON_Delete(parameters);
    return one_case;
}

static void defaults(void **state) {
    (void)state;
    struct contact_case one_case = read_case(STUDY(PROFILE, ""));
    assert_int_equal(one_case.model_count, 1);
    assert_true(one_case.blocks[0].model == MODEL_HALFSPACE && isinf(one_case.blocks[0].height));
    assert_true(one_case.blocks[0].poisson == 0.3 && one_case.blocks[0].weighting == GAP_STANDARD);
    assert_int_equal(one_case.load_count, 30);
    assert_true(fabs(one_case.loads[0] - 0.01) < 1e-15 && one_case.loads[29] == 0.3);
    assert_int_equal(one_case.level_count, 1);
    assert_true(one_case.levels[0].points == 8 && one_case.levels[0].grid.nx == 64);
    assert_int_equal(one_case.levels[0].stride, 1);
    assert_true(one_case.nodes && one_case.edges && !one_case.perimeter);
    assert_true(one_case.tolerance == 1e-8);
    assert_int_equal(one_case.pdf_count, 1);
    assert_int_equal(one_case.pdf_loads[0], 29);
    assert_true(one_case.pressure.low == 0 && one_case.pressure.high == 4 &&
                one_case.pressure.count == 80);
    contact_case_clear(&one_case);
    one_case = read_case("{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 4}}");
    assert_true(one_case.nodes && one_case.edges && one_case.perimeter);
    contact_case_clear(&one_case);
}

static void check_number(double value, double expected) {
    assert_true(fabs(value - expected) < 1e-12);
}

static void blocks(void **state) {
    (void)state;
    struct contact_case one_case =
        read_case(STUDY(PROFILE, "\"model\": [\"layered\", \"halfspace\"], \"poisson\": 0.4"));
    assert_int_equal(one_case.model_count, 2);
    assert_true(one_case.blocks[0].model == MODEL_LAYERED && one_case.blocks[0].height == 12);
    assert_true(one_case.blocks[0].layer_growth == 1.1 && one_case.blocks[0].poisson == 0.4);
    assert_true(one_case.blocks[1].model == MODEL_HALFSPACE && isinf(one_case.blocks[1].height));
    assert_int_equal(contact_case_complete(&one_case), 0);
    contact_case_clear(&one_case);
    one_case = read_case(STUDY(PROFILE, "\"model\": [\"halfspace\", \"layered\"],"
                                        "\"block_height\": {\"lengths\": 0.5}"));
    assert_true(one_case.blocks[0].height == 4 &&
                one_case.blocks[1].height == 4); /* both take it */
    assert_int_equal(contact_case_complete(&one_case), 1);
    contact_case_clear(&one_case);
    one_case = read_case(STUDY(PROFILE ", \"rms_height\": 0.01",
                               "\"block_height\": {\"rms_heights\": 160}, \"model\": \"layered\""));
    assert_true(fabs(one_case.blocks[0].height - 1.6) < 1e-12);
    contact_case_clear(&one_case);
    /* one wave of amplitude a and length 1: slope sqrt(2) pi a, height a/sqrt(2) */
    one_case = read_case(STUDY("\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 1,"
                               "\"length_ratio\": 1, \"rms_slope\": 0.1",
                               "\"block_height\": {\"rms_heights\": 100}, \"model\": \"layered\""));
    assert_true(fabs(one_case.blocks[0].height - 100 * 0.1 / 6.283185307179586) < 1e-12);
    contact_case_clear(&one_case);
}

/* A fine zone is as deep on every mesh: in widths of the wide columns more on finer ones. */
static void fine_zones(void **state) {
    (void)state;
    struct study_cost cost;
    struct contact_case one_case = read_case(
        STUDY(PROFILE ", \"rms_height\": 0.05",
              "\"model\": \"full\", \"levels\": [4, 8], \"block_height\": {\"lengths\": 1},"
              "\"block_fine_height\": {\"rms_heights\": 40}"));
    check_number(one_case.fine_height, 2);
    check_number(contact_case_transition(&one_case, &one_case.levels[0].grid), 4);
    check_number(contact_case_transition(&one_case, &one_case.levels[1].grid), 8);
    contact_case_estimate(&one_case, &cost);
    check_number(cost.fine_height, 2);
    contact_case_clear(&one_case);
    one_case = read_case(STUDY(PROFILE ", \"rms_height\": 0.05",
                               "\"model\": \"full\", \"block_height\": {\"lengths\": 1},"
                               "\"block_fine_height\": \"whole\""));
    contact_case_estimate(&one_case, &cost);
    check_number(cost.fine_height, 8); /* the block */
    contact_case_clear(&one_case);
    one_case = read_case(STUDY(PROFILE ", \"rms_height\": 0.05", "\"model\": \"full\""));
    check_number(contact_case_transition(&one_case, &one_case.levels[0].grid), 8);
    contact_case_estimate(&one_case, &cost);
    check_number(cost.fine_height, 0);
    contact_case_clear(&one_case);
}

/* Loads in Pa are over E* h': of 91 GPa, nu = 0.3 and h' = 0.1 that is 10 GPa. */
static void loads_in_pascal(void **state) {
    (void)state;
    static const char *const STUDIES[] = {
        STUDY(PROFILE ", \"rms_slope\": 0.1",
              "\"young\": 91e9, \"pressure_pdf\": {\"at\": [2e9]},"
              "\"pressures\": {\"values\": [1e9, 2e9], \"unit\": \"Pa\"}"),
        STUDY(PROFILE ", \"rms_slope\": 0.1",
              "\"young\": 91e9, \"pressures\": {\"to\": 2e9, \"steps\": 2, \"unit\": \"Pa\"}")};
    for (size_t n = 0; n < sizeof STUDIES / sizeof *STUDIES; n++) {
        struct contact_case one_case = read_case(STUDIES[n]);
        assert_int_equal(one_case.load_count, 2);
        assert_true(fabs(one_case.loads[0] - 0.1) < 1e-15);
        assert_true(fabs(one_case.loads[1] - 0.2) < 1e-15);
        assert_int_equal(one_case.pdf_loads[0], 1);
        contact_case_clear(&one_case);
    }
}

/* The name that a study gives is the one that curves have. */
static void models_bear_their_names(void **state) {
    (void)state;
    size_t m = 0;
    for (; CONTACT_MODELS[m] != NULL; m++)
        assert_string_equal(contact_model_name(CONTACT_MODELS[m]),
                            choice_name(CONTACT_MODEL_CHOICES, (int)m));
    assert_null(CONTACT_MODEL_CHOICES[m].name);
    assert_int_equal(m, 3);
    assert_null(contact_model_name(NULL));
}

/* Errors are counted from full, wherever it stands. */
static void models_beside_full(void **state) {
    (void)state;
    struct contact_case one_case = read_case(
        STUDY(PROFILE ", \"rms_slope\": 0.1", "\"model\": [\"layered\", \"full\", \"halfspace\"]"));
    assert_int_equal(one_case.model_count, 3);
    assert_int_equal(contact_case_complete(&one_case), 1);
    assert_string_equal(contact_model_name(one_case.models[1]), "full");
    assert_int_equal(one_case.kinematics, KINEMATICS_HENCKY);
    assert_true(fabs(one_case.rms_slope - 0.1) < 1e-12);
    for (size_t m = 0; m < 2; m++) {
        assert_int_equal(one_case.blocks[m].weighting, GAP_STANDARD);
        assert_true(one_case.blocks[m].height == 1.5 * one_case.surface.grid.lx);
    }
    assert_true(isinf(one_case.blocks[2].height));
    contact_case_clear(&one_case);
    one_case = read_case(STUDY(PROFILE ", \"rms_slope\": 0.1",
                               "\"model\": \"full\", \"kinematics\": \"st_venant_kirchhoff\","
                               "\"gap_weighting\": \"dual\""));
    assert_int_equal(one_case.kinematics, KINEMATICS_ST_VENANT);
    assert_int_equal(one_case.blocks[0].weighting, GAP_DUAL);
    assert_true(one_case.transition_depth == 8);
    contact_case_clear(&one_case);
    one_case = read_case(STUDY(PROFILE, "\"model\": [\"layered\", \"halfspace\"]"));
    assert_int_equal(one_case.blocks[0].weighting, GAP_STANDARD);
    assert_int_equal(contact_case_complete(&one_case), 0);
    assert_string_equal(contact_model_name(one_case.models[0]), "layered");
    contact_case_clear(&one_case);
}

static void loads_and_pressures(void **state) {
    (void)state;
    struct contact_case one_case =
        read_case(STUDY(PROFILE, "\"pressures\": {\"to\": 0.4, \"steps\": 4},"
                                 "\"pressure_pdf\": {\"at\": [0.1, 0.3], \"bins\": [0, 2, 10]}"));
    assert_int_equal(one_case.load_count, 4);
    assert_int_equal(one_case.pdf_count, 2);
    assert_true(one_case.pdf_loads[0] == 0 && one_case.pdf_loads[1] == 2);
    contact_case_clear(&one_case);
    one_case = read_case(STUDY(PROFILE, "\"pressures\": {\"values\": [1e-6, 0.1, 7]},"
                                        "\"estimators\": \"nodes\""));
    assert_true(one_case.load_count == 3 && one_case.loads[2] == 7);
    assert_true(one_case.nodes && !one_case.edges && !one_case.perimeter);
    contact_case_clear(&one_case);
}

/* A coating is that of all models; lengths are lambda_s, and its ratio of Poisson is the block's
 * unless given. */
static void coatings(void **state) {
    (void)state;
    struct contact_case one_case =
        read_case(STUDY(PROFILE, "\"model\": [\"layered\", \"halfspace\"], \"poisson\": 0.4, "
                                 "\"coating\": {\"thickness\": 0.5, \"modulus\": 4}"));
    for (size_t m = 0; m < 2; m++) {
        const struct coating *coating = &one_case.blocks[m].coating;
        assert_true(coating->thickness == 0.5 && coating->modulus == 4 && coating->poisson == 0.4);
    }
    assert_true(contact_case_is_coated(&one_case));
    contact_case_clear(&one_case);
    one_case = read_case(
        STUDY(PROFILE, "\"coating\": {\"thickness\": 2, \"modulus\": 0.5, \"poisson\": 0}"));
    assert_true(one_case.blocks[0].coating.poisson == 0);
    contact_case_clear(&one_case);
    one_case = read_case(STUDY(PROFILE, "\"coating\": {\"thickness\": 0}"));
    assert_false(contact_case_is_coated(&one_case));
    contact_case_clear(&one_case);
}

/* Persson's theory has the deviation of the pressure that flattens all: of a thick coating that of
 * a half-space of it, of a thin one that of the block, and in between the sum over all waves. */
static void persson_with_a_coating(void **state) {
    (void)state;
    static const char *const STUDIES[] = {
        STUDY(PROFILE, "\"coating\": {\"thickness\": 1e-6, \"modulus\": 4}"),
        STUDY(PROFILE, "\"coating\": {\"thickness\": 300, \"modulus\": 4}"),
        STUDY(PROFILE, "\"coating\": {\"thickness\": 0.2, \"modulus\": 4}"),
        STUDY(PROFILE, "\"poisson\": 0.1"),
        STUDY("\"hurst\": 0.8, \"wavelength_ratio\": 4",
              "\"coating\": {\"thickness\": 0.2, \"modulus\": 0.25}")};
    double factor[5];
    for (size_t a = 0; a < 5; a++) {
        struct contact_case one_case = read_case(STUDIES[a]);
        struct modes *modes = NULL;
        assert_int_equal(
            modes_create(&modes, &one_case.surface.spectrum, &one_case.surface.grid, NULL), 0);
        factor[a] = coated_theory_factor(&one_case, modes);
        modes_destroy(&modes);
        contact_case_clear(&one_case);
    }
    assert_true(fabs(factor[0] - 1) < 1e-4 && fabs(factor[1] - 0.25) < 1e-9);
    assert_true(factor[2] > 0.3 && factor[2] < 0.9 && factor[3] == 1);
    assert_true(factor[4] > 1.1 && factor[4] < 4);
}

/* 2 points a wave: every 4th point of the own 8; 4: every 2nd; 6: resampled; 16: finer. */
static void levels(void **state) {
    (void)state;
    struct contact_case one_case = read_case(STUDY(PROFILE, "\"levels\": [2, 4, 6, 16]"));
    static const size_t sides[] = {16, 32, 48, 128}, strides[] = {4, 2, 0, 0};
    assert_int_equal(one_case.level_count, 4);
    for (size_t l = 0; l < 4; l++) {
        assert_int_equal(one_case.levels[l].grid.nx, sides[l]);
        assert_int_equal(one_case.levels[l].grid.ny, 1);
        assert_int_equal(one_case.levels[l].stride, strides[l]);
    }
    assert_ptr_equal(contact_case_finest(&one_case), &one_case.levels[3]);
    contact_case_clear(&one_case);
}

/* Every level has the shape of the cell. The block is as high as its longer side asks for. */
static void rectangles(void **state) {
    (void)state;
    static const char text[] = STUDY("\"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 1,"
                                     " \"length_ratio_y\": 3",
                                     "\"levels\": [4, 6, 16], \"model\": \"layered\"");
    static const size_t sides[] = {16, 24, 64}, strides[] = {2, 0, 0};
    struct contact_case one_case = read_case(text);
    assert_int_equal(one_case.level_count, 3);
    for (size_t l = 0; l < 3; l++) {
        assert_int_equal(one_case.levels[l].grid.nx, sides[l]);
        assert_int_equal(one_case.levels[l].grid.ny, 3 * sides[l]);
        assert_int_equal(one_case.levels[l].stride, strides[l]);
    }
    assert_true(one_case.band.x == 4 && one_case.band.y == 12);
    assert_true(one_case.blocks[0].height == 1.5 * 12);
    double bound = contact_case_block_bound(&one_case, 0);
    contact_case_clear(&one_case);
    one_case = read_case(STUDY("\"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 3",
                               "\"model\": \"layered\""));
    assert_true(contact_case_block_bound(&one_case, 0) == bound);
    contact_case_clear(&one_case);
}

/* A study with one fault; pointer NULL: with none. */
struct faulty {
    const char *text, *pointer, *words;
};

static void check_fault(const struct faulty *bad) {
    struct fault_list list = {0};
    struct contact_case one_case;
    struct error err = {0};
    cJSON *parameters = cJSON_Parse(bad->text);
    assert_non_null(parameters);
    int status = contact_case_read(&one_case, parameters, 0, &list, &err);
    if (bad->pointer == NULL) {
        assert_int_equal(status, 0);
        contact_case_clear(&one_case);
    } else if (status != ERROR_INPUT || list.count != 1 ||
               strcmp(list.faults[0].pointer, bad->pointer) != 0 ||
               strstr(list.faults[0].detail, bad->words) == NULL) {
        fail_msg("%s: %zu faults, %s", bad->text, list.count, err.text);
    }
    fault_list_clear(&list);
    cJSON_Delete(parameters);
}

static void coating_faults(void **state) {
    (void)state;
    static const struct faulty BAD[] = {
        {STUDY(PROFILE, "\"coating\": {\"thickness\": 1}"), "/contact/coating/thickness",
         "give /contact/coating/modulus"},
        {STUDY(PROFILE, "\"coating\": {\"modulus\": 2}"), "/contact/coating/modulus",
         "give its thickness, too"},
        {STUDY(PROFILE, "\"coating\": {\"poisson\": 0.2}"), "/contact/coating/poisson",
         "give its thickness, too"},
        {STUDY(PROFILE, "\"coating\": {\"thickness\": 1, \"modulus\": 2000}"),
         "/contact/coating/modulus", "[0.001, 1000]"},
        {STUDY(PROFILE, "\"model\": \"layered\", \"coating\": {\"thickness\": 12, \"modulus\": 2}"),
         "/contact/coating/thickness", "12 lambda_s, and the block of layered is 12 lambda_s high"},
        {STUDY(PROFILE ", \"rms_slope\": 0.1",
               "\"model\": \"full\", \"coating\": {\"thickness\": 1, \"modulus\": 2}"),
         "/contact/coating/thickness", "the model full has no coatings"},
        {STUDY("\"hurst\": 0.8, \"wavelength_ratio\": 4",
               "\"asperities\": \"counted\", \"coating\": {\"thickness\": 1, \"modulus\": 2}"),
         "/contact/asperities", "for blocks without a coating"},
    };
    for (size_t b = 0; b < sizeof BAD / sizeof *BAD; b++)
        check_fault(&BAD[b]);
}

static void faults(void **state) {
    (void)state;
    static const struct faulty BAD[] = {
        {STUDY(PROFILE, "\"model\": \"mesh\""), "/contact/model", "not one of \"halfspace\""},
        {STUDY(PROFILE, "\"model\": \"full\""), "/surface/rms_slope", "slopes count"},
        {STUDY(PROFILE ", \"rms_slope\": 3", "\"model\": [\"layered\", \"full\"]"),
         "/surface/rms_slope", "up to about 2"},
        {STUDY(PROFILE ", \"rms_height\": 100", "\"model\": \"full\""), "/surface/rms_height",
         "RMS slope"},
        {STUDY(PROFILE ", \"rms_slope\": 0.1",
               "\"model\": \"full\", \"block_height\": \"infinite\""),
         "/contact/block_height", "only a halfspace can be infinite"},
        {STUDY(PROFILE ", \"rms_slope\": 0.1", "\"model\": \"full\", \"layer_growth\": 1,"
                                               "\"block_height\": {\"lengths\": 1000}"),
         "/contact/block_height", "4096 layers"},
        {STUDY(PROFILE ", \"rms_slope\": 0.1",
               "\"model\": [\"layered\", \"full\"], \"block_height\": {\"rms_heights\": 1}"),
         "/contact/block_height", "1 RMS heights of the surface: the model full needs 4 or more"},
        {"{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 16, \"length_ratio\": 4, "
         "\"points_per_wavelength\": 128, \"rms_slope\": 0.1}, \"contact\": {\"model\": "
         "\"full\"}}",
         "/contact/model", "layers under 8192 by 8192 points"},
        {STUDY(PROFILE ", \"rms_height\": 0.1",
               "\"model\": \"full\", \"block_height\": {\"lengths\": 0.045}"),
         "/contact/block_height", "3.6 RMS heights"},
        {STUDY(PROFILE ", \"rms_slope\": 0.1", "\"model\": \"full\", \"transition_depth\": 0.5"),
         "/contact/transition_depth", "[1, 1000000000]"},
        {STUDY(PROFILE, "\"time_limit\": 10"), "/contact/time_limit",
         "belongs to the model full, which is not asked for"},
        {STUDY(PROFILE ", \"rms_slope\": 0.1", "\"model\": \"full\", \"time_limit\": 0"),
         "/contact/time_limit", "(0, 1000000000]"},
        {STUDY(PROFILE, "\"areas\": \"current\""), "/contact/areas",
         "\"current\" belongs to the model full, which is not asked for"},
        {STUDY(PROFILE, "\"gap_direction\": \"normal\", \"model\": \"layered\""),
         "/contact/gap_direction", "\"normal\" belongs to the model full"},
        {STUDY(PROFILE ", \"rms_slope\": 0.1",
               "\"model\": \"full\", \"kinematics\": \"small\", \"areas\": \"current\""),
         "/contact/areas", "which small strains leave as it was"},
        {STUDY(PROFILE ", \"rms_slope\": 0.1", "\"model\": \"full\", \"areas\": \"true\""),
         "/contact/areas", "not one of \"flat\""},
        {STUDY(PROFILE, "\"kinematics\": \"finite\""), "/contact/kinematics",
         "not one of \"hencky\""},
        {STUDY(PROFILE, "\"model\": [\"layered\", \"layered\"]"), "/contact/model/1",
         "there already"},
        {STUDY(PROFILE, "\"model\": []"), "/contact/model", "at least one"},
        {STUDY(PROFILE, "\"young\": 0"), "/contact/young", "(0,"},
        {STUDY(PROFILE, "\"poisson\": 0.5"), "/contact/poisson", "[0, 0.4999]"},
        {STUDY(PROFILE, "\"model\": \"layered\", \"block_height\": \"infinite\""),
         "/contact/block_height", "only a halfspace can be infinite"},
        {STUDY(PROFILE, "\"model\": [\"halfspace\", \"layered\"], \"block_height\": \"infinite\""),
         "/contact/block_height", "only a halfspace can be infinite"},
        {STUDY(PROFILE, "\"block_height\": {\"rms_heights\": 160}"), "/contact/block_height",
         "need the scale"},
        {STUDY(PROFILE, "\"block_height\": {\"metres\": 1}"), "/contact/block_height",
         "\"lengths\""},
        {STUDY(PROFILE, "\"block_height\": {\"lengths\": 0}"), "/contact/block_height/lengths",
         "(0,"},
        {STUDY(PROFILE, "\"block_height\": {\"lengths\": 1, \"rms_heights\": 1}"),
         "/contact/block_height", "one number"},
        {STUDY(PROFILE, "\"block_height\": \"deep\""), "/contact/block_height", "infinite"},
        {STUDY(PROFILE, "\"model\": \"layered\", \"layer_growth\": 1,"
                        "\"block_height\": {\"lengths\": 1000}"),
         "/contact/block_height", "4096 layers"},
        {STUDY(PROFILE, "\"block_fine_height\": {\"rms_heights\": 40}, \"model\": \"layered\""),
         "/contact/block_fine_height", "model full"},
        {STUDY(PROFILE ", \"rms_height\": 0.05",
               "\"block_fine_height\": {\"wavelengths\": 0.2}, \"model\": \"full\""),
         "/contact/block_fine_height", "two columns"},
        {STUDY(PROFILE ", \"rms_height\": 0.05",
               "\"block_fine_height\": \"whole\", \"transition_depth\": 9, \"model\": \"full\""),
         "/contact/block_fine_height", "not both"},
        {STUDY(PROFILE, "\"layer_growth\": 0.9"), "/contact/layer_growth", "[1, 2]"},
        {STUDY(PROFILE, "\"gap_weighting\": \"dual\""), "/contact/gap_weighting",
         "finite elements"},
        {STUDY(PROFILE, "\"pressures\": {\"to\": 0}"), "/contact/pressures/to", "(0,"},
        {STUDY(PROFILE, "\"pressures\": {\"steps\": 2000}"), "/contact/pressures/steps", "1000"},
        {STUDY(PROFILE, "\"pressures\": {\"values\": [0.2, 0.1]}"), "/contact/pressures/values",
         "must rise"},
        {STUDY(PROFILE, "\"pressures\": {\"values\": [0, 0.1]}"), "/contact/pressures/values/0",
         "(0,"},
        {STUDY(PROFILE, "\"pressures\": {\"values\": [0.3], \"to\": 0.4}"),
         "/contact/pressures/values", "not both"},
        {STUDY(PROFILE, "\"pressures\": {\"values\": [1, 1e7]}"), "/contact/pressures/values",
         "load of 1e+07 E* h'"},
        {STUDY(PROFILE ", \"rms_slope\": 0.1",
               "\"pressures\": {\"values\": [1e8], \"unit\": \"Pa\"}"),
         "/contact/pressures/values", "E* h'"}, /* E is 1 Pa */
        {STUDY(PROFILE ", \"rms_slope\": 0.1", "\"young\": 1e9, \"pressures\": {\"unit\": \"Pa\"}"),
         "/contact/pressures/values", "no default"},
        {STUDY(PROFILE, "\"pressures\": {\"values\": [1e8], \"unit\": \"Pa\"}"),
         "/contact/pressures/unit", "scale"},
        {STUDY(PROFILE ", \"unit\": 1e-6", ""), "/surface/unit", "scale"},
        {STUDY(PROFILE, "\"estimators\": [\"perimeter\"]"), "/contact/estimators", "profile"},
        {STUDY(PROFILE, "\"estimators\": [\"corners\"]"), "/contact/estimators/0", "not one of"},
        {STUDY(PROFILE, "\"levels\": [1, 8]"), "/contact/levels/0", "[2,"},
        {STUDY(PROFILE, "\"levels\": [8, 4]"), "/contact/levels", "must rise"},
        {STUDY(PROFILE, "\"levels\": [2.3, 8]"), NULL, NULL}, /* 20 points hold 8 waves */
        {STUDY(PROFILE ", \"points_per_wavelength\": 6", "\"levels\": [2, 4, 6]"), NULL, NULL},
        {STUDY(PROFILE ", \"points_per_wavelength\": 5", "\"levels\": [2, 5]"), "/contact/levels",
         "neither hold the 8 waves"},
        {STUDY(PROFILE, "\"levels\": [7.99, 8]"), "/contact/levels", "the same grid"},
        {STUDY(PROFILE, "\"tolerance\": 0.1"), "/contact/tolerance", "0.01"},
        {STUDY(PROFILE, "\"pressure_pdf\": {\"at\": [0.015]}"), "/contact/pressure_pdf/at",
         "none of the study's"},
        {STUDY(PROFILE, "\"pressure_pdf\": {\"bins\": [1, 1, 5]}"), "/contact/pressure_pdf/bins",
         "below high"},
    };
    for (size_t b = 0; b < sizeof BAD / sizeof *BAD; b++)
        check_fault(&BAD[b]);
}

/* What is at fault is not handed on: a surface without its table, its lengths, its shape or a grid
 * leaves no band, no block in its units and no mesh to look at; what the contact has at fault by
 * itself is reported beside it. */
static void faulty_surfaces_end_reading(void **state) {
    (void)state;
#define CELL "\"wavelength_ratio\": 8, \"length_ratio\": 2"
    static const char *const SURFACES[] = {
        "\"hurst\": 0.8, \"spectrum\": {\"type\": \"table\"}, " CELL,
        "\"spectrum\": {\"type\": \"table\", \"wave_number\": [1, 2]}, " CELL,
        "\"spectrum\": {\"type\": \"table\", \"wave_number\": [1, 2], \"density\": [0, 0]}, " CELL,
        "\"spectrum\": {\"type\": \"exponential_acf\"}, " CELL,
        "\"hurst\": 0.8, \"heights\": {\"distribution\": \"samples\"}, " CELL,
        "\"hurst\": 0.8, \"heights\": {\"distribution\": \"weibull_min\"}, " CELL,
        "\"hurst\": 0.8, \"rms_slope\": 1, \"rms_height\": 1, " CELL,
        "\"hurst\": 0.8, \"nayak_alpha\": 5, " CELL,
        "\"hurst\": 0.8, \"anisotropy\": 4, " CELL,
        "\"hurst\": 0.8, \"dimension\": 1, \"length_ratio_y\": 4, " CELL,
        "\"hurst\": 0.8, \"wavelength_ratio\": 1e5, \"length_ratio\": 1e5",
        CELL,
    };
    static const char *const CONTACTS[] = {
        "\"levels\": [4, 8], \"model\": [\"layered\", \"full\"]",
        "\"block_height\": {\"rms_heights\": 20}, \"model\": \"layered\"",
        "\"pressures\": {\"values\": [0.2, 0.1]}, \"pressure_pdf\": {\"at\": [0.1]}",
    };
#undef CELL
    enum { SURFACE_COUNT = sizeof SURFACES / sizeof *SURFACES };
    for (size_t s = 0; s < SURFACE_COUNT; s++)
        for (size_t c = 0; c < sizeof CONTACTS / sizeof *CONTACTS; c++) {
            char text[600];
            struct fault_list list = {0};
            struct contact_case one_case;
            snprintf(text, sizeof text, "{\"surface\": {%s}, \"contact\": {%s}}", SURFACES[s],
                     CONTACTS[c]);
            cJSON *parameters = cJSON_Parse(text);
            assert_non_null(parameters);
            assert_int_equal(contact_case_read(&one_case, parameters, 0, &list, NULL), ERROR_INPUT);
            size_t own = c == 2; /* loads that do not rise; where pressures are counted then is not
                                    asked */
            if (list.count != 1 + own || strncmp(list.faults[0].pointer, "/surface/", 9) != 0)
                fail_msg("%s: %zu faults", text, list.count);
            fault_list_clear(&list);
            cJSON_Delete(parameters);
        }
}

/* What sums over all waves of a surface is not computed of one that no machine holds, nor where the
 * answer could not be meshed: such a study is refused at once, in the memory of its text. */
static void surfaces_beyond_memory_are_not_summed(void **state) {
    (void)state;
#define LARGE "\"hurst\": 0.8, \"wavelength_ratio\": 2000, \"length_ratio\": 2, \"rms_slope\": 0.1"
    static const struct {
        const char *text;
        double memory_limit;
        const char *pointer, *words;
    } BAD[] = {
        {STUDY(LARGE, "\"model\": \"layered\", \"block_height\": {\"rms_heights\": 200}"), 1e9,
         "/surface/points_per_wavelength", "GiB; allowed: 0.931 GiB"},
        {STUDY(LARGE, "\"model\": [\"layered\", \"full\"]"), 1e9, "/surface/points_per_wavelength",
         "a surface of 32000 by 32000 points"},
        {STUDY(LARGE, "\"model\": [\"layered\", \"full\"]"), 0, "/contact/model", "the face alone"},
        {STUDY(LARGE, "\"block_height\": {\"rms_heights\": 200}"), 0,
         "/surface/points_per_wavelength", "32000 by 32000 points: blocks in rms_heights"},
    };
#undef LARGE
    for (size_t b = 0; b < sizeof BAD / sizeof *BAD; b++) {
        struct fault_list list = {0};
        struct contact_case one_case;
        cJSON *parameters = cJSON_Parse(BAD[b].text);
        assert_non_null(parameters);
        assert_int_equal(contact_case_read(&one_case, parameters, BAD[b].memory_limit, &list, NULL),
                         ERROR_INPUT);
        assert_int_equal(list.count, 1);
        assert_string_equal(list.faults[0].pointer, BAD[b].pointer);
        assert_non_null(strstr(list.faults[0].detail, BAD[b].words));
        fault_list_clear(&list);
        cJSON_Delete(parameters);
    }
}

/* Faults of the surface and of the contact, all at once. */
static void all_faults_at_once(void **state) {
    (void)state;
    struct fault_list list = {0};
    struct contact_case one_case;
    cJSON *parameters = cJSON_Parse(STUDY("\"dimension\": 1, \"hurst\": 2",
                                          "\"poisson\": 1, \"levels\": [8, 2], \"tolerance\": 1,"
                                          "\"pressures\": {\"values\": [2, 1]}"));
    assert_int_equal(contact_case_read(&one_case, parameters, 0, &list, NULL), ERROR_INPUT);
    assert_int_equal(list.count, 3); /* that do not fit their rows */
    fault_list_clear(&list);
    cJSON_Delete(parameters);
    parameters = cJSON_Parse(STUDY("\"dimension\": 1, \"wavelength_ratio\": 4",
                                   "\"levels\": [8, 4], \"pressures\": {\"values\": [2, 1]},"
                                   "\"gap_weighting\": \"dual\""));
    assert_int_equal(contact_case_read(&one_case, parameters, 0, &list, NULL), ERROR_INPUT);
    assert_int_equal(list.count, 4); /* that do not fit together */
    fault_list_clear(&list);
    cJSON_Delete(parameters);
}

static void fingerprints(void **state) {
    (void)state;
    static const char *const texts[] = {
        STUDY(PROFILE, ""),
        STUDY(PROFILE, "\"model\": \"layered\""),
        STUDY(PROFILE, "\"model\": [\"layered\", \"halfspace\"]"),
        STUDY(PROFILE, "\"model\": [\"halfspace\", \"layered\"]"),
        STUDY(PROFILE, "\"block_height\": {\"lengths\": 2}"),
        STUDY(PROFILE, "\"block_height\": {\"lengths\": 3}"),
        STUDY(PROFILE ", \"rms_height\": 1", "\"block_height\": {\"rms_heights\": 3}"),
        STUDY(PROFILE, "\"estimators\": [\"nodes\"]"),
        STUDY(PROFILE, "\"estimators\": [\"edges\"]"),
        STUDY(PROFILE ", \"rms_slope\": 0.1", "\"model\": \"full\""),
        STUDY(PROFILE ", \"rms_slope\": 0.1", "\"model\": \"full\", \"kinematics\": \"small\""),
        STUDY(PROFILE ", \"rms_slope\": 0.1", "\"model\": \"full\", \"transition_depth\": 9"),
    };
    enum { TEXTS = sizeof texts / sizeof *texts };
    uint64_t marks[TEXTS];
    for (size_t a = 0; a < TEXTS; a++) {
        cJSON *parameters = cJSON_Parse(texts[a]);
        assert_int_equal(kind_fingerprint(kind_find("contact"), parameters, &marks[a], NULL), 0);
        cJSON_Delete(parameters);
        for (size_t b = 0; b < a; b++)
            assert_true(marks[a] != marks[b]);
    }
}

static void estimates(void **state) {
    (void)state;
    struct contact_case one_case = read_case(STUDY(PROFILE, ""));
    struct study_cost small, large;
    contact_case_estimate(&one_case, &small);
    contact_case_clear(&one_case);
    one_case = read_case("{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 16}, \"contact\":"
                         " {\"model\": [\"halfspace\", \"layered\"], \"levels\": [4, 8]}}");
    contact_case_estimate(&one_case, &large);
    contact_case_clear(&one_case);
    assert_true(small.nx == 64 && small.ny == 1 && large.nx == 1024 && large.ny == 1024);
    assert_true(small.seconds > 0 && small.seconds < 1 && large.seconds > 10 * small.seconds);
    assert_true(small.memory_bytes > 1e4 && small.memory_bytes < 1e8);
    assert_true(large.memory_bytes > 2 * 13 * 8.0 * 1024 * 1024); /* two finest solvers at least */
    assert_true(small.relative_error > 0.01 && small.relative_error < 1);
}

#define STEEP "\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 16"
#define FULL "\"model\": \"full\", \"cell_error\": \"none\", \"pressures\": {\"values\": [0.3]}"

/* A limit bounds what is expected of the loads of a realisation, and with friction of the load that
 * is pressed anew and of the sliding, each with its jumps. Jumps are a part of what is expected. */
static void limits_bound_estimates(void **state) {
    (void)state;
    static const char *const SLOPES[] = {"0.3", "0.6", "0.9", "1.2", "1.5"};
    static const double LIMIT = 5, OTHERS = 0.5; /* seconds; of surfaces and areas, at most */
    for (size_t s = 0; s < 10; s++) {
        const bool slides = s >= 5;
        char text[400];
        (void)snprintf(text, sizeof text, STUDY(STEEP ", \"rms_slope\": %s", FULL "%s, %s"),
                       SLOPES[s % 5], slides ? ", \"friction\": 0.6" : "", "\"time_limit\": 5");
        struct contact_case one_case = read_case(text);
        struct study_cost cost;
        contact_case_estimate(&one_case, &cost);
        assert_true(cost.seconds <= (slides ? 3 : 1) * LIMIT + OTHERS);
        assert_true(cost.rare_seconds <= cost.seconds && cost.rare_seconds <= cost.rare_most);
        assert_true(cost.rare_most <= (slides ? 3 : 1) * LIMIT);
        assert_true(cost.rare_variance <= LIMIT * cost.rare_most);
        one_case.time_limit = 0;
        contact_case_estimate(&one_case, &cost);
        assert_true(cost.rare_seconds <= cost.seconds);
        assert_true(cost.rare_seconds > 0 ? isinf(cost.rare_most) : cost.rare_most == 0);
        assert_true(s % 5 < 3 || cost.seconds > 10 * LIMIT);
        contact_case_clear(&one_case);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults),
        cmocka_unit_test(blocks),
        cmocka_unit_test(fine_zones),
        cmocka_unit_test(loads_in_pascal),
        cmocka_unit_test(models_bear_their_names),
        cmocka_unit_test(models_beside_full),
        cmocka_unit_test(loads_and_pressures),
        cmocka_unit_test(levels),
        cmocka_unit_test(coatings),
        cmocka_unit_test(persson_with_a_coating),
        cmocka_unit_test(rectangles),
        cmocka_unit_test(faults),
        cmocka_unit_test(coating_faults),
        cmocka_unit_test(faulty_surfaces_end_reading),
        cmocka_unit_test(surfaces_beyond_memory_are_not_summed),
        cmocka_unit_test(all_faults_at_once),
        cmocka_unit_test(fingerprints),
        cmocka_unit_test(estimates),
        cmocka_unit_test(limits_bound_estimates),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
