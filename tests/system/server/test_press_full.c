/* Protects: `rugo press --model full`: the numbers of a study on the same heights, without friction
 * and with it, and over the face as it stands; open maps are mirrored; what a load without a
 * solution leaves; the block as a file; what it takes is printed before; what is refused. */
#include "schema/json/json.h"
#include "tests/support/check.h"
#include "tests/support/process.h"
#include <cjson/cJSON.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* One profile of 64 points, on its own mesh. */
static int setup(void **state) {
    (void)state;
    spit("steep.json",
         "{\"name\": \"steep\", \"kind\": \"contact\", \"seed\": 3, \"realisations\": 1, "
         "\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 4, "
         "\"length_ratio\": 2, \"rms_slope\": 0.3}, \"contact\": {\"model\": \"full\", \"levels\": "
         "[8], \"tolerance\": 1e-9, \"pressures\": {\"values\": [0.05, 0.2]}, \"friction\": 0.3, "
         "\"slip\": {\"to\": [0.8], \"steps\": 4}}}");
    spit("press", "$RUGO press z.npy --dx 0.125 --boundary periodic \"$@\"\n");
    return run_shell("$RUGO generate steep.json -o z.npy");
}

static cJSON *read_json(const char *path) {
    char *text = slurp(path);
    cJSON *document = cJSON_Parse(text);
    free(text);
    assert_non_null(document);
    return document;
}

/* The values of a map's member are those of the study's curve: the slope of the heights is the
 * prescribed one to rounding, and solutions are to 1e-9. */
static void compare(const char *named, const cJSON *values, const char *name) {
    char line[200];
    snprintf(line, sizeof line, "$RUGO curves %s --quantity %s > curve.json", named, name);
    check_shell(line);
    cJSON *study = read_json("curve.json");
    const cJSON *y = json_at(study, "/cases/0/curves/0/y");
    assert_true(cJSON_GetArraySize(y) > 1);
    assert_int_equal(cJSON_GetArraySize(y), cJSON_GetArraySize(values));
    for (int i = 0; i < cJSON_GetArraySize(y); i++)
        check_close(cJSON_GetArrayItem(values, i)->valuedouble,
                    cJSON_GetArrayItem(y, i)->valuedouble, 1e-8);
    cJSON_Delete(study);
}

static void a_map_is_pressed_as_in_a_study(void **state) {
    (void)state;
    check_shell("$RUGO run steep.json && sh ./press --model full --loads 0.05,0.2 --error none "
                "--friction 0.3 --slide-to 0.8 --slide-steps 4 --format json > map.json");
    cJSON *map = read_json("map.json");
    compare("steep", json_at(map, "/mean_gap"), "mean_gap");
    compare("steep", json_at(map, "/sliding/force"), "sliding_force");
    compare("steep", json_at(map, "/sliding/stick_load"), "sliding_stick_load");
    compare("steep", json_at(map, "/sliding/dissipation"), "sliding_dissipation");
    assert_string_equal(json_at(map, "/kinematics")->valuestring, "hencky");
    assert_true(json_at(map, "/mesh/nodes")->valuedouble > 500);
    assert_null(json_at(map, "/note"));
    cJSON_Delete(map);
}

/* Over the face as it stands, and along its normal, as in studies. */
static void faces_are_measured_as_in_a_study(void **state) {
    (void)state;
    check_shell(
        "sed 's/\"steep\"/\"stands\"/; s/\"friction.*steps\": 4}/\"areas\": \"current\", "
        "\"gap_direction\": \"normal\"/' steep.json > stands.json && $RUGO run stands.json && sh "
        "./press --model full --loads 0.05,0.2 --error none --format json > plain.json && sh "
        "./press --model full --loads 0.05,0.2 --error none --areas current --gap-direction "
        "normal --format json > map.json");
    cJSON *map = read_json("map.json"), *plain = read_json("plain.json");
    compare("stands", json_at(map, "/mean_gap"), "mean_gap");
    for (int i = 0; i < 2; i++) {
        const cJSON *one = cJSON_GetArrayItem(json_at(map, "/edges"), i);
        const cJSON *other = cJSON_GetArrayItem(json_at(plain, "/edges"), i);
        assert_true(one->valuedouble < 0.99 * other->valuedouble);
        assert_true(one->valuedouble > 0.9 * other->valuedouble);
    }
    cJSON_Delete(map);
    cJSON_Delete(plain);
}

/* A load without a solution leaves those before: their table, and as files the last of them. */
static void loads_without_values_are_noted(void **state) {
    (void)state;
    check_shell(
        "sh ./press --model full --loads 0.2,1e7 --error none -o p.npy --mesh m.vtu --steps "
        "st --format json > two.json && mv shell.err words && sh ./press --model full "
        "--loads 0.2 --error none -o q.npy --mesh n.vtu >/dev/null && cmp p.npy q.npy && "
        "cmp m.vtu n.vtu && cmp m.vtu st/step-1.vtu && [ ! -e st/step-2.vtu ]");
    assert_true(
        contains("words", "warning: z.npy: model full: no values from p/(E* h') = 1e+07 on"));
    cJSON *map = read_json("two.json");
    assert_non_null(strstr(json_at(map, "/note")->valuestring, "was reached up to"));
    assert_true(json_at(map, "/edges/0")->valuedouble > 0);
    assert_true(cJSON_IsNull(json_at(map, "/edges/1")));
    cJSON_Delete(map);
    assert_int_equal(run_shell("sh ./press --model full --loads 1e7 --error none"), 1);
    assert_true(contains("shell.err", "z.npy: contact on the true geometry under a mean pressure"));
}

/* The file of the block is that of the last load; CalculiX's has a step for each, and its stresses
 * in E* whatever the unit of others. */
static void the_block_is_written(void **state) {
    (void)state;
    check_shell("sh ./press --model full --loads 0.05,0.1 --error none --mesh b.inp >/dev/null && "
                "[ $(grep -c '^[*]STEP' b.inp) = 2 ] && sh ./press --model full --loads 0.1 "
                "--error none --transition-depth 1e9 --mesh b.msh >/dev/null && grep -q "
                "MeshFormat b.msh && sh ./press --model full --loads 0.1 --error none --mesh b.vtu "
                ">/dev/null && grep -q 'Name=\"stress\"' b.vtu && grep -q 'Name=\"displacement\"' "
                "b.vtu");
    /* what Gmsh cannot hold leaves the file that was there */
    assert_int_equal(run_shell("sh ./press --model full --loads 0.1 --error none --mesh b.msh"), 2);
    assert_true(contains("shell.err", "columns of elements widen with depth"));
    assert_true(contains("b.msh", "MeshFormat"));
    check_shell("sh ./press --model full --loads 0.1 --error none --modulus 2GPa --mesh pa.inp "
                ">/dev/null && sed -n 2p pa.inp");
    assert_true(contains("shell.out", "lengths in the map's unit; stresses in E*\n"));
}

/* A map that does not repeat is mirrored, for all models of a command. */
static void open_maps_are_mirrored(void **state) {
    (void)state;
    check_shell("awk 'BEGIN { for (i = 0; i < 40; i++) print 0.2 * cos(i / 4) + 0.02 * i }' > "
                "open.csv && $RUGO press open.csv --model halfspace,full --loads 0.1");
    assert_true(contains("shell.out", "boundary: mirrored (by model)\nmodel: halfspace\n"));
    assert_true(contains("shell.out", "boundary: mirrored (by model)\nmodel: full (hencky)\n"));
    assert_true(contains("shell.out", ", 80 by 1 columns, "));
    assert_true(contains("shell.out", "of this model alone\n"));
    check_shell("$RUGO press open.csv --loads 0.1");
    assert_true(contains("shell.out", "boundary: open (by seam)\n"));
}

static void what_it_takes_is_estimated(void **state) {
    (void)state;
    check_shell("awk 'BEGIN { for (j = 0; j < 128; j++) for (i = 0; i < 256; i++) printf "
                "\"%.5f%c\", cos(i * 0.3) * cos(j * 0.2), i < 255 ? 44 : 10 }' > large.csv && "
                "$RUGO press large.csv --model full,halfspace --dx 10 --estimate");
    assert_true(contains("shell.out", "model full: 512 by 256 points, "));
    assert_true(contains("shell.out", "\nmemory: ") && contains("shell.out", "\nCPU time: "));
    assert_true(contains("shell.out", "model halfspace: no mesh"));
    assert_int_equal(run_shell("$RUGO press large.csv --model full --dx 10 --limit 10"), 2);
    assert_true(contains("shell.err", "large.csv: the model full takes about "));
    assert_true(contains("shell.err", "and may take 10 s (--limit); --resample "));
    assert_true(contains("shell.err", " takes all of it with fewer points, --crop 0,0,"));
}

static void what_has_no_meaning_is_refused(void **state) {
    (void)state;
    static const struct {
        const char *options, *reason;
    } WRONG[] = {
        {"--model full --friction 2", "--friction 2; allowed with the model full: (0, 1]"},
        {"--model full --slide-to 1", "--slide-to belongs to --friction with a model that slides"},
        {"--model halfspace --friction 0.2 --slide-steps 3", "--slide-steps belongs to --friction"},
        {"--model full --friction 0.2 --slide-to 1,1", "--slide-to 1,1: not up to 100 numbers"},
        {"--model full --friction 0.2 --slide-to 0.2,0.4", "at which the flat turns"},
        {"--model full --coupling frictional", "nothing slips unless --friction is given"},
        {"--model full --hardness 2GPa --modulus 200GPa", "--hardness: the model full does not"},
        {"--model full --boundary open", "--model full needs a block that does: --boundary"},
        {"--model full --dx 0.01", "the model full can mesh surfaces up to about 2; --filter"},
        {"--model full --height 0.02", "the model full needs 4 or more, as layers of lower"},
        {"--model full --kinematics linear", "--kinematics"},
        {"--model full --transition-depth 0.5", "--transition-depth"},
        {"--model layered --areas current", "--areas current belongs to --model full"},
        {"--model halfspace --gap-direction normal", "--gap-direction normal belongs to --model"},
        {"--model full --areas current --kinematics small", "which --kinematics small leaves"},
        {"--kinematics small", "--kinematics small belongs to --model full"},
        {"--model layered --kinematics neo_hooke",
         "--kinematics neo_hooke belongs to --model full"},
        {"--model layered --transition-depth 4", "--transition-depth 4 belongs to --model full"},
        {"--gap-weighting dual", "--gap-weighting dual belongs to models with meshes"},
        {"--direction y", "--direction y is that of the tangential load, which --friction gives"},
        {"--model halfspace,full --mesh m.vtu", "--mesh: the model halfspace, the first, has no"},
        {"--model full --limit 0.001", "no map of this shape with 16 points along a side is small"},
        {"--model full --mesh no/such.vtu", "cannot write no/such.vtu"},
        {"--model full --mesh b.stl", "--mesh b.stl: its name ends in none of .vtu, .msh, .inp"},
        {"--vtu face.png", "--vtu face.png: its name does not end in .vtu"},
        {"--nodes nodes.vtu", "--nodes nodes.vtu: its name does not end in .csv"}};
    char line[200];
    for (size_t n = 0; n < sizeof WRONG / sizeof *WRONG; n++) {
        snprintf(line, sizeof line, "$RUGO press z.npy --dx 0.125 %s", WRONG[n].options);
        assert_int_not_equal(run_shell(line), 0);
        if (!contains("shell.err", WRONG[n].reason))
            fail_msg("%s: no \"%s\"", line, WRONG[n].reason);
    }
}

/* The flat slides over a surface, too, and along y: with the friction of all of the pressure in the
 * end. */
static void surfaces_slide(void **state) {
    (void)state;
    check_shell("awk 'BEGIN { for (i = 0; i < 256; i++) printf \"%.5f%c\", cos(i * 0.393) * "
                "cos(int(i / 16) * 0.393), i % 16 < 15 ? 44 : 10 }' > waves.csv && $RUGO press "
                "waves.csv --dx 10 --boundary periodic --model full --loads 0.1 --error none "
                "--friction 0.2 --direction y --areas current --slide-to 1 --slide-steps 4 "
                "--format json > waves.json");
    cJSON *map = read_json("waves.json");
    const cJSON *force = json_at(map, "/sliding/force");
    assert_int_equal(cJSON_GetArraySize(force), 5);
    for (int i = 1; i < 5; i++)
        assert_true(cJSON_GetArrayItem(force, i)->valuedouble >=
                    cJSON_GetArrayItem(force, i - 1)->valuedouble);
    check_relative(cJSON_GetArrayItem(force, 4)->valuedouble, 0.2, 1e-3);
    check_close(json_at(map, "/sliding/stick_area/4")->valuedouble, 0, 0);
    check_close(json_at(map, "/sliding/stick_edges/0")->valuedouble, 1, 1e-9);
    check_close(json_at(map, "/sliding/contact_edges/0")->valuedouble, 1, 1e-9);
    assert_null(json_at(map, "/note"));
    cJSON_Delete(map);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_map_is_pressed_as_in_a_study),
        cmocka_unit_test(faces_are_measured_as_in_a_study),
        cmocka_unit_test(loads_without_values_are_noted),
        cmocka_unit_test(the_block_is_written),
        cmocka_unit_test(open_maps_are_mirrored),
        cmocka_unit_test(what_it_takes_is_estimated),
        cmocka_unit_test(what_has_no_meaning_is_refused),
        cmocka_unit_test(surfaces_slide),
    };
    return cmocka_run_group_tests(tests, setup, NULL);
}
