/* Protects: the commands of maps: surfaces and measured maps in files are written, characterised,
 * pressed and converted, in their units. */
#include "schema/json/json.h"
#include "tests/support/check.h"
#include "tests/support/comma_locale.h"
#include "tests/support/process.h"
#include "tests/support/small_studies.h"
#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int setup(void **state) {
    (void)state;
    spit("one.json", ONE_CASE);
    return 0;
}

static void a_surface_goes_out_and_in(void **state) {
    (void)state;
    assert_int_equal(
        run_shell("$RUGO generate -o z.npy --realisation 3 one.json && $RUGO characterise "
                  "z.npy --dx 0.125 --format json > z.json"),
        0);
    assert_true(contains("z.json", "\"finite_difference\":{\"rms_slope\":"));
    assert_int_equal(
        run_shell(
            "$RUGO generate -o a.csv --format csv one.json && $RUGO generate -o b.xyz --format "
            "xyz one.json && $RUGO characterise a.csv --dx 0.125 --format json > a.json && $RUGO "
            "characterise b.xyz --format json > b.json && test -s a.json && test -s b.json"),
        0);
}

/* Writes a study of a surface of 256 x 256 points, which sub-maps are taken of. */
static void write_study(const char *file, const char *more) {
    char text[600];
    snprintf(text, sizeof text,
             "{ \"name\": \"one\", \"kind\": \"statistics\", \"realisations\": 1, \"surface\":"
             " { \"hurst\": 0.7, \"wavelength_ratio\": 32, \"rolloff_ratio\": 4,"
             " \"length_ratio\": 2, \"points_per_wavelength\": 4, \"rms_slope\": 0.1,"
             " \"amplitudes\": \"random\"%s } }",
             more);
    spit(file, text);
}

/* Two maps of one surface have one law together, which is printed, drawn and refused of one. */
static void maps_of_one_surface_go_together(void **state) {
    (void)state;
    write_study("both.json", "");
    assert_int_equal(
        run_shell(
            "$RUGO generate both.json -o both.npy && convert() { $RUGO convert both.npy \"$@\" "
            "--dx 0.5um --z-unit um; } && convert one.csv --crop 0,0,128,128 && "
            "convert two.csv --crop 128,128,128,128 && together() { $RUGO characterise "
            "one.csv two.csv --together \"$@\"; } && together --report both.svg >both.txt && "
            "together --format json >both.out && ! together --psd c.npy 2>psd.txt && "
            "! $RUGO characterise one.csv two.csv 2>two.txt && "
            "! $RUGO characterise one.csv --together 2>one.txt"),
        0);
    assert_true(contains("both.txt", "hurst_low") && contains("both.txt", "two.csv"));
    assert_true(contains("both.svg", "one.csv") && contains("both.svg", "</svg>"));
    assert_true(contains("psd.txt", "--together goes with --report"));
    assert_true(contains("two.txt", "several files; --together fits them"));
    assert_true(contains("one.txt", "a joint fit needs two"));
    char *text = slurp("both.out");
    cJSON *document = cJSON_Parse(text);
    assert_true(json_at(document, "/together/maps")->valuedouble == 2);
    assert_true(fabs(json_at(document, "/together/hurst")->valuedouble - 0.7) < 0.3);
    const cJSON *of = json_at(document, "/psd/map"), *lines = json_at(document, "/psd_x/map");
    assert_true(cJSON_GetArraySize(lines) >= 2 * 60);
    assert_true(cJSON_GetArrayItem(of, cJSON_GetArraySize(of) - 1)->valuedouble == 2);
    cJSON_Delete(document);
    free(text);
}

/* Grooves are no part of the law of several maps either: it is the one of --degroove, and the maps
 * that have them say so. The others have an empty cell. */
static void grooves_are_in_no_law_of_several_maps(void **state) {
    (void)state;
    write_study("turned.json", ", \"grooves\": { \"period\": 2, \"depth\": 3, \"angle\": 0, "
                               "\"shape\": \"sine\" }");
    write_study("smooth.json", "");
    assert_int_equal(
        run_shell(
            "for map in turned smooth; do $RUGO generate $map.json -o $map.npy && $RUGO convert "
            "$map.npy $map.csv --crop 0,0,128,128 --dx 0.5um --z-unit um || exit 1; done; "
            "together() { $RUGO characterise turned.csv smooth.csv --together \"$@\"; }; "
            "together --format json > found.json && together --report found.svg && "
            "together --degroove --format json > taken.json"),
        0);
    assert_true(contains("found.svg", "turned.csv (degrooved)"));
    assert_true(!contains("found.svg", "smooth.csv (degrooved)"));
    char *text = slurp("found.json"), *other = slurp("taken.json");
    cJSON *found = cJSON_Parse(text), *taken = cJSON_Parse(other);
    const cJSON *period = json_at(found, "/maps/groove_period");
    /* In metres; the grooves are 4 um apart, and the map 64 um wide. */
    assert_true(fabs(cJSON_GetArrayItem(period, 0)->valuedouble - 4e-6) < 2e-8);
    assert_true(cJSON_IsNull(cJSON_GetArrayItem(period, 1)));
    assert_null(json_at(taken, "/maps/groove_period"));
    assert_true(json_at(found, "/together/hurst")->valuedouble ==
                json_at(taken, "/together/hurst")->valuedouble);
    cJSON_Delete(found);
    cJSON_Delete(taken);
    free(other);
    free(text);
}

/* A plane wave in a file is Westergaard's: (2/pi) asin(sqrt(sqrt(2) load)). */
static void a_map_in_a_file_is_pressed(void **state) {
    (void)state;
    assert_int_equal(
        run_shell("awk 'BEGIN { for (i = 0; i < 256; i++) print cos(i * 3.14159265358979 / "
                  "128) }' > wave.csv && $RUGO press wave.csv --loads 0.1,0.4,5 --format "
                  "json > wave.json && $RUGO press wave.csv --model layered -o p.npy && "
                  "$RUGO characterise p.npy"),
        0);
    char *text = slurp("wave.json");
    cJSON *document = cJSON_Parse(text);
    const cJSON *edges = cJSON_GetObjectItem(document, "edges");
    const double exact[] = {0.245442906579788, 0.541937864805995, 1};
    for (int l = 0; l < 3; l++) /* measured: 1e-4 */
        assert_true(fabs(cJSON_GetArrayItem(edges, l)->valuedouble - exact[l]) < 1e-3);
    cJSON_Delete(document);
    free(text);
}

/* Several models are elements of a list, each with its errors as a study's curves have them; the
 * same stand in the table for spreadsheets and in that for people. Without errors none is there. */
static void several_models_press_a_map(void **state) {
    (void)state;
    assert_int_equal(
        run_shell("awk 'BEGIN { for (i = 0; i < 64; i++) print cos(i * 3.14159265358979 / 32) }' "
                  "> wave.csv; press=\"$RUGO press wave.csv --boundary periodic --height 0.4 "
                  "--loads 0.1 --model halfspace,layered\"; $press --format json > models.json && "
                  "$press --format csv > models.csv && $press > models.txt && "
                  "$press --error none > bare.txt"),
        0);
    char *text = slurp("models.json");
    cJSON *document = cJSON_Parse(text);
    const cJSON *models = cJSON_GetObjectItem(document, "models");
    assert_int_equal(cJSON_GetArraySize(models), 2);
    for (int m = 0; m < 2; m++) {
        const cJSON *one = cJSON_GetArrayItem(models, m);
        const cJSON *edges = json_at(one, "/errors/edges"), *gap = json_at(one, "/errors/mean_gap");
        assert_string_equal(json_at(one, "/model")->valuestring, m == 0 ? "halfspace" : "layered");
        assert_true(json_at(edges, "/block_error/0")->valuedouble < 0);
        assert_true(json_at(edges, "/model_bound/0")->valuedouble > 0);
        assert_true(cJSON_IsNull(json_at(gap, "/model_error")) == (m == 1));
        assert_null(json_at(edges, "/cell_error"));
    }
    cJSON_Delete(document);
    free(text);
    assert_true(contains("models.csv", ",block_error,block_bound,model_error,model_bound,"));
    assert_true(contains("models.csv", "contact_area,edges,layered,"));
    assert_true(contains("models.csv", "# map: wave.csv, SHA-256 "));
    assert_false(contains("models.csv", "_physical"));
    assert_int_equal(run_shell("$RUGO press wave.csv --dx 1um --z-unit nm --modulus 2GPa "
                               "--pressure 1kPa --format csv"),
                     0);
    assert_true(contains("shell.out", "# prepared: "));
    assert_true(contains("shell.out", ",x_physical,x_unit,"));
    assert_true(contains("shell.out", ",Pa,"));
    assert_true(contains("models.txt", "errors by the height of the block"));
    assert_false(contains("bare.txt", "errors by"));
    assert_int_equal(run_shell("$RUGO press wave.csv --model layered,layered"), 2);
    assert_true(contains("shell.err", "--model layered,layered is not halfspace, layered or full"));
    assert_int_equal(run_shell("$RUGO press wave.csv --boundary open --model halfspace,full"), 2);
}

static double first_area(const char *path) {
    char *text = slurp(path);
    cJSON *document = cJSON_Parse(text);
    double area = json_at(document, "/edges/0")->valuedouble;
    cJSON_Delete(document);
    free(text);
    return area;
}

/* A soft coating takes more contact under one load, and a thick one is a softer block: its loads
 * are over its own E*. Coatings are printed, and refused where they have no meaning. */
static void coatings_are_pressed(void **state) {
    (void)state;
    assert_int_equal(
        run_shell("awk 'BEGIN { for (j = 0; j < 32; j++) for (i = 0; i < 32; i++) printf "
                  "\"%.9f%c\", cos(i * 0.19634954) * cos(j * 0.19634954), i < 31 ? 44 : 10 }' > "
                  "sines.csv; press=\"$RUGO press sines.csv --boundary periodic --format json\"; "
                  "$press --loads 0.1 > bare.json && $press --loads 0.1 --coating 2,0.25 > "
                  "soft.json && $press --loads 0.025 --coating 1e4,0.25 > thick.json && "
                  "$press --loads 0.1 --unit um --z-unit um --modulus 200GPa --coating "
                  "2um,50GPa,0.3 > units.json"),
        0);
    double bare = first_area("bare.json"), soft = first_area("soft.json");
    assert_true(soft > 1.5 * bare);
    check_relative(first_area("thick.json"), bare, 1e-3);
    check_relative(first_area("units.json"), soft, 1e-6);
    assert_true(contains("soft.json", "\"coating\""));
    assert_false(contains("bare.json", "\"coating\""));
    assert_int_equal(run_shell("$RUGO press sines.csv --boundary open --loads 0.1 --coating 2,4"),
                     0);
    assert_true(contains("shell.out", "coating: thickness 2, modulus 4 of the block's"));
    assert_int_equal(
        run_shell("$RUGO press sines.csv --boundary periodic --model full --coating 2,4"), 2);
    assert_true(contains("shell.err", "--coating 2,4: the model full has no coatings"));
    assert_int_equal(
        run_shell("$RUGO press sines.csv --boundary periodic --model layered --height 1 "
                  "--coating 32,4"),
        2);
    assert_true(contains("shell.err", "coating thickness = 32; allowed: below the block height"));
    assert_int_equal(run_shell("$RUGO press sines.csv --coating 2,4GPa"), 2);
    assert_true(contains("shell.err", "needs that of the block: --modulus"));
}

/* A tilted map with a hole is open, loses a plane and has no seam to be pressed over. */
static void a_measured_map_does_not_repeat(void **state) {
    (void)state;
    char line[400];
    for (int hole = 0; hole < 2; hole++) {
        snprintf(
            line, sizeof line,
            "awk -v HOLE=%d 'BEGIN { for (j = 0; j < 40; j++) for (i = 0; i < 50; i++) printf "
            "\"%%s%%c\", HOLE && i == 20 && j == 10 ? \"nan\" : 3 * i + cos(i * 0.7) * cos(j * "
            "0.6), i < 49 ? 44 : 10 }' > map%d.csv",
            hole, hole);
        assert_int_equal(run_shell(line), 0);
    }
    assert_int_equal(run_shell("$RUGO characterise map0.csv --format json > map0.json"), 0);
    assert_true(contains("map0.json", "\"boundary\":\"open\",\"boundary_by\":\"seam\""));
    assert_true(contains("map0.json", "\"detrend\":\"plane\",\"trend_height\":73."));
    assert_true(contains("map0.json", "\"acf\":{\"lag\":[0,1,2,"));
    assert_int_equal(
        run_shell(
            "$RUGO characterise map1.csv --all && grep -q 'holes *0.0005' shell.out && grep -q "
            "'boundary_by *holes' shell.out"),
        0);
    assert_int_equal(
        run_shell("$RUGO characterise map0.csv --boundary periodic --detrend mean --all && grep -q "
                  "'^spectral' shell.out"),
        0);
    assert_int_equal(
        run_shell("$RUGO characterise map1.csv --picture map1.svg --all && grep -q '^map' "
                  "shell.out && grep -q 'map1.csv: open' map1.svg && grep -q summit "
                  "map1.svg"),
        0);
    assert_int_equal(run_shell("$RUGO characterise map0.csv --picture none/map.svg"), 1);
    assert_true(contains("shell.err", "cannot open none/map.svg"));
    assert_int_equal(run_shell("$RUGO characterise map1.csv --boundary periodic"), 2);
    assert_true(contains("shell.err",
                         "1 of 2000 heights are holes (NaN), the first in row 11, column "
                         "21"));
    assert_int_equal(run_shell("$RUGO press map1.csv"), 2);
    assert_true(contains("shell.err", "map1.csv: 1 of 2000 heights are holes"));
    assert_int_equal(run_shell("$RUGO press map0.csv --boundary periodic --loads 0.01"), 0);
    assert_true(contains("shell.err", "warning: map0.csv: contact takes the map as periodic"));
}

/* Lengths of a map with units are printed as people read them, in JSON in metres; without units
 * they are bare. A window makes the map periodic, for contact too, and reports its power. */
static void lengths_have_units(void **state) {
    (void)state;
    assert_int_equal(
        run_shell(
            "awk 'BEGIN { for (j = 0; j < 40; j++) for (i = 0; i < 50; i++) printf \"%.17g%c\", "
            "0.1 * i + cos(i * 0.7) * cos(j * 0.6), i < 49 ? 44 : 10 }' > bare.csv"),
        0);
    assert_int_equal(
        run_shell("$RUGO characterise bare.csv --all && ! grep -q m^2 shell.out && grep -q '^  "
                  "dx  *1$' shell.out"),
        0);
    assert_int_equal(
        run_shell("$RUGO characterise bare.csv --dx 0.5um --z-unit 10nm --all && grep -q '^  dx "
                  " *500 nm$' shell.out && grep -q '^  m0 .* nm^2$' shell.out && grep -q "
                  "'^  rms_slope  *[0-9.]*$' shell.out && grep -q 'density\\[' shell.out"),
        0);
    assert_int_equal(
        run_shell("$RUGO characterise bare.csv --dx 0.5um --z-unit 10nm --format json > "
                  "units.json"),
        0);
    assert_true(contains("units.json", "\"unit\":\"m\""));
    assert_true(contains("units.json", "\"dx\":5e-07"));
    assert_true(contains("units.json", "\"preparation\":{\"file\":\"bare.csv\""));
    assert_int_equal(
        run_shell("$RUGO characterise bare.csv --window hann --format json > tapered.json"), 0);
    assert_true(contains("tapered.json", "\"boundary\":\"periodic\",\"boundary_by\":\"window\""));
    assert_true(contains("tapered.json", "\"window_power\":0.1406"));
    assert_int_equal(run_shell("$RUGO press bare.csv --window tukey --loads 0.01 --format json > "
                               "tapered.json"),
                     0);
    assert_true(contains("tapered.json", "\"boundary\":\"periodic\""));
}

/* What is prepared and written is what is read again, with its units in text; what was done is
 * reported, and a conversion without options changes nothing. */
static void a_map_is_converted(void **state) {
    (void)state;
    assert_int_equal(
        run_shell(
            "awk 'BEGIN { for (j = 0; j < 40; j++) for (i = 0; i < 50; i++) printf \"%.17g%c\", "
            "(i > 20 && i < 25 && j > 10 && j < 30) ? \"nan\" : 3 * i + cos(i * 0.7) * cos(j * "
            "0.6), i < 49 ? 44 : 10 }' | sed 's/^0,/nan,/' > uneven.csv"),
        0);
    assert_int_equal(
        run_shell("$RUGO convert uneven.csv even.npy && $RUGO convert even.npy even.csv && "
                  "grep -v '^#' even.csv > bare.csv && $RUGO convert bare.csv again.npy && "
                  "cmp even.npy again.npy"),
        0);
    assert_int_equal(
        run_shell("$RUGO convert uneven.csv prepared.csv --dx 0.5um --z-unit nm --crop "
                  "2um,0,40,40 --detrend plane --fill --filter S=2.5um,robust --resample "
                  "60,60"),
        0);
    static const char *const STEPS[] = {"spacing: 500 nm by 500 nm",
                                        "crop: columns 4 to 43",
                                        "detrend: plane",
                                        "fill: 76 holes, 4.75 % of the points",
                                        "s_filter: robust Gaussian, cut-off 2.5",
                                        "resample: 40 by 40 points to 60 by 60",
                                        "written: 60 by 60 points"};
    for (size_t step = 0; step < sizeof STEPS / sizeof *STEPS; step++)
        assert_true(contains("shell.out", STEPS[step]));
    assert_int_equal(
        run_shell("grep -q '^# done: crop, columns 4' prepared.csv && grep -q '^# z unit: "
                  "m' prepared.csv"),
        0);
    assert_int_equal(run_shell("$RUGO convert uneven.csv prepared.xyz --dx 2 && sed '/^#/d' "
                               "prepared.xyz | head -n 2 | tail -n 1 | grep -q '^2 0 '"),
                     0);
    /* text files keep units, spacings and holes */
    assert_int_equal(
        run_shell("for i in csv xyz; do $RUGO convert uneven.csv kept.$i --dx 1um,0.5um "
                  "--z-unit um && $RUGO convert kept.$i kept_$i.npy && grep -q '50 by 40 "
                  "points, 1e-06 by 5e-07 m apart, heights in m' shell.out || exit; done; "
                  "cmp kept_csv.npy kept_xyz.npy"),
        0);
    assert_int_equal(run_shell("$RUGO convert uneven.csv prepared.tif"), 2);
    assert_true(contains("shell.err", "allowed are files that end in .npy, .csv or .xyz"));
    assert_int_equal(run_shell("$RUGO convert uneven.csv absent/prepared.npy"), 1);
    assert_int_equal(run_shell("$RUGO characterise uneven.csv --dx 0.5um"), 2);
    assert_true(contains("shell.err", "--z-unit"));
}

/* A patch becomes a map that repeats, of twice its sides and one draw a number; a map that repeats
 * already does not. */
static void a_patch_is_extended(void **state) {
    (void)state;
    assert_int_equal(
        run_shell("$RUGO generate one.json -o whole.npy && $RUGO convert whole.npy part.npy --crop "
                  "0,0,24,20 --detrend plane && $RUGO convert part.npy first.npy --boundary open "
                  "--extend && $RUGO convert part.npy again.npy --boundary open --extend 1 && "
                  "$RUGO convert part.npy other.npy --boundary open --extend 2 && cmp first.npy "
                  "again.npy && ! cmp -s first.npy other.npy"),
        0);
    assert_true(contains("shell.out", "extend: to 48 by 40 points, draw 1, "));
    assert_int_equal(run_shell("$RUGO press part.npy --boundary mirrored --extend"), 2);
    assert_true(contains("shell.err", "allowed: one of them"));
    assert_int_equal(run_shell("$RUGO press part.npy --counter part.npy --extend"), 2);
    assert_true(contains("shell.err", "by the same draw"));
    assert_int_equal(
        run_shell("$RUGO press part.npy --boundary open --extend --error none --loads 0.1 --format "
                  "json > part.json"),
        0);
    assert_true(contains("part.json", "\"boundary_by\":\"extension\""));
    assert_int_equal(run_shell("$RUGO convert whole.npy first.npy --extend"), 2);
    assert_true(contains("shell.err", "the map repeats already (by seam)"));
    assert_int_equal(run_shell("$RUGO convert part.npy first.npy --extend=-1"), 2);
    assert_true(contains("shell.err", "--extend -1: allowed is the number of a draw"));
    assert_int_equal(run_shell("$RUGO convert part.npy first.npy --extend --window hann"), 2);
    assert_true(contains("shell.err", "allowed: one of them"));
}

/* Lines with offsets and two spikes, exchanged and turned; options by what people type, and
 * --despike with and without its number before a file. */
static void what_instruments_leave_is_removed(void **state) {
    (void)state;
    assert_int_equal(
        run_shell("awk 'BEGIN { for (j = 0; j < 40; j++) for (i = 0; i < 50; i++) printf "
                  "\"%.17g%c\", cos(i * 0.3) * cos(j * 0.2) + 9 * int(1.5 + 1.4 * sin(j * j * j)) "
                  "+ (i * 50 + j == 1020 "
                  "|| i * 50 + j == 530 ? 40 : 0), i < 49 ? 44 : 10 }' > scanned.csv"),
        0);
    assert_int_equal(run_shell("$RUGO convert --lines median --despike scanned.csv turned.npy "
                               "--fill --transpose --rotate 30 --dx 0.5um --z-unit nm"),
                     0);
    static const char *const STEPS[] = {"lines: median of each of 40 lines along x, RMS ",
                                        "despike: 2 points, 0.1 %, became holes: beyond 8 ",
                                        "transpose: x and y exchanged, 40 by 50 points",
                                        "rotate: 30 degrees counter-clockwise, 40 by 50 points to ",
                                        "fill: "};
    for (size_t step = 0; step < sizeof STEPS / sizeof *STEPS; step++)
        assert_true(contains("shell.out", STEPS[step]));
    assert_int_equal(run_shell("$RUGO characterise --despike 5 scanned.csv --lines mean "
                               "--deconvolve tip=20nm --dx 0.5um --z-unit nm"),
                     0);
    assert_int_equal(run_shell("$RUGO press scanned.csv --dx 0.5um --z-unit nm --error none"), 0);
    assert_true(
        contains("shell.err", "rugo press: warning: scanned.csv: Lines: along x, offsets "));
    assert_int_equal(run_shell("$RUGO press scanned.csv --dx 0.5um --z-unit nm --error none "
                               "--lines median --despike --fill"),
                     0);
    assert_false(contains("shell.err", "Lines:"));
    assert_int_equal(run_shell("$RUGO convert --despike scanned.csv --rotate 400 turned.npy"), 2);
    assert_true(contains("shell.err", "--rotate 400: allowed are degrees"));
}

/* A matrix with two points that were not measured: refused by all commands, until the option says
 * what the value is. */
static void missing_points_are_asked_for(void **state) {
    (void)state;
    static const char *const COMMANDS[] = {"characterise missing.csv", "press missing.csv",
                                           "convert missing.csv holes.csv"};
    assert_int_equal(
        run_shell("awk 'BEGIN { for (j = 0; j < 40; j++) for (i = 0; i < 50; i++) printf "
                  "\"%.9g%c\", (i * 50 + j == 1020 || i * 50 + j == 530) ? -9999 : cos(i * 0.3 + "
                  "j * j), i < 49 ? 44 : 10 }' > missing.csv"),
        0);
    for (size_t c = 0; c < sizeof COMMANDS / sizeof *COMMANDS; c++) {
        char line[120];
        snprintf(line, sizeof line, "$RUGO %s", COMMANDS[c]);
        assert_int_equal(run_shell(line), 2);
        assert_true(contains("shell.err", "missing.csv: 2 of 2000 heights are -9999, far from all "
                                          "others, "));
    }
    assert_int_equal(run_shell("$RUGO convert missing.csv holes.csv --missing -9999 --fill"), 0);
    assert_true(contains("shell.out",
                         "missing: 2 points, 0.1 %, became holes: heights of -9999\nfill: 2 "));
    assert_int_equal(run_shell("$RUGO characterise missing.csv --missing none"), 0);
    assert_int_equal(run_shell("$RUGO press missing.csv --missing -9999 --fill --error none"), 0);
}

/* What is printed of a matrix of numbers says once that nothing says their units, until options
 * do; JSON stays as it is. */
static void unknown_units_are_said(void **state) {
    (void)state;
    static const char *const COMMANDS[] = {"characterise bare.csv", "press bare.csv --error none",
                                           "convert bare.csv out.csv"};
    static const char NOTE[] = "\nunits: the file names none; --dx 0.5um and --z-unit nm ";
    assert_int_equal(
        run_shell("awk 'BEGIN { for (j = 0; j < 40; j++) for (i = 0; i < 50; i++) printf "
                  "\"%.9g%c\", cos(i * 0.3 + j * j), i < 49 ? 44 : 10 }' > bare.csv"),
        0);
    for (size_t c = 0; c < sizeof COMMANDS / sizeof *COMMANDS; c++) {
        char line[120];
        snprintf(line, sizeof line, "$RUGO %s", COMMANDS[c]);
        assert_int_equal(run_shell(line), 0);
        char *text = slurp("shell.out");
        const char *first = strstr(text, NOTE);
        assert_non_null(first);
        assert_null(strstr(first + 1, "\nunits: "));
        free(text);
        snprintf(line, sizeof line, "$RUGO %s --dx 0.5um --z-unit nm", COMMANDS[c]);
        assert_int_equal(run_shell(line), 0);
        assert_false(contains("shell.out", "\nunits: "));
    }
    assert_int_equal(run_shell("$RUGO convert bare.csv out.csv --dx 0.5um"), 0);
    assert_true(contains("shell.out", "units: the file names none of heights; --z-unit nm "));
    assert_int_equal(run_shell("$RUGO convert bare.csv out.csv --z-unit nm"), 0);
    assert_true(contains("shell.out", "units: the file names none of x and y; --dx 0.5um "));
    assert_int_equal(run_shell("$RUGO characterise bare.csv --format json"), 0);
    assert_false(contains("shell.out", "units"));
}

/* A sphere's map with units: Hertz's radius of 32 um needs 10.0825 N on a radius of 1 mm. */
/* One screen unless more is asked for; groups as text and as JSON; other groups are refused. */
static void groups_are_printed(void **state) {
    (void)state;
    assert_int_equal(run_shell("$RUGO generate -o g.npy one.json >/dev/null && $RUGO characterise "
                               "g.npy && test $(wc -l <shell.out) -le 45 && ! grep -q '^heights$' "
                               "shell.out"),
                     0);
    assert_true(contains("shell.out", "more: --all, --format json, or --group of preparation"));
    assert_int_equal(run_shell("$RUGO characterise g.npy --group acf,heights >g.txt && "
                               "grep '^[a-z_]*$' g.txt"),
                     0);
    char *names = slurp("shell.out");
    assert_string_equal(names, "heights\nacf\n");
    free(names);
    assert_int_equal(run_shell("$RUGO characterise g.npy --group grid --format json"), 0);
    assert_true(contains("shell.out", "{\"grid\":{\"nx\":"));
    assert_false(contains("shell.out", "heights"));
    assert_int_equal(run_shell("$RUGO characterise g.npy --group height"), 2);
    assert_true(contains("shell.err", "--group height: there is no group 'height'; the map has "));
    assert_true(contains("shell.err", ", grid, heights, "));
    assert_int_equal(run_shell("$RUGO characterise g.npy --group grid --all"), 2);
    assert_int_equal(run_shell("$RUGO characterise g.npy --trust-to 1 --format study"), 2);
    assert_true(contains("shell.err", "do not go with --format study"));
    assert_int_equal(run_shell("$RUGO characterise absent.npy --picture x.jpg"), 2);
    assert_true(contains("shell.err", "picture x.jpg: its name ends in none of .svg"));
    assert_int_equal(run_shell("$RUGO characterise g.npy --group grid --format svg"), 2);
    assert_true(contains("shell.err", "--group goes with --format text or json"));
}

/* A profilometer's columns are a trace to every command, packed or not; what is made of them is in
 * the record. Columns that can be a map too are asked back, in a study as well. */
static void columns_are_a_trace(void **state) {
    (void)state;
    assert_int_equal(
        run_shell("awk 'BEGIN { print \"X_(microns),Z_(angstroms)\"; for (i = 0; i < 256; i++) "
                  "printf \"%.3f,%.2f\\n\", 5 + 0.5 * i, 100 * cos(i * 3.14159265358979 / 16) }' "
                  "> trace.csv && gzip -k trace.csv && $RUGO convert trace.csv.gz trace.npy"),
        0);
    assert_true(contains("shell.out", "columns: x z, 256 rows at even positions\n"));
    assert_true(contains("shell.out", "unpacked: by gzip, "));
    assert_true(contains("shell.out", "written: 256 by 1 points, 5e-07 by 5e-07 m apart, "
                                      "heights in m\n"));
    assert_int_equal(run_shell("$RUGO characterise trace.csv.gz && $RUGO press trace.csv.gz"), 0);
    assert_int_equal(run_shell("gzip -c trace.csv | $RUGO characterise - --name trace.csv.gz"), 0);
    assert_int_equal(run_shell("head -c 300 trace.csv.gz > cut.csv.gz; $RUGO characterise "
                               "cut.csv.gz"),
                     2);
    assert_true(contains("shell.err", "cut.csv.gz: gzip: "));
    assert_int_equal(
        run_shell("printf '0 5\\n1 3\\n5 4\\n7 1\\n8 2\\n' > either.txt; $RUGO convert "
                  "either.txt a.npy"),
        2);
    assert_true(contains("shell.err", "either.txt: 5 rows of 2 numbers are either positions and "
                                      "heights of a trace or a map of 2 x 5 heights; --columns "
                                      "xz or --columns map says which"));
    assert_int_equal(run_shell("$RUGO convert either.txt a.npy --columns xz"), 0);
    assert_true(contains("shell.out", "uneven positions, 0.5 to 2 of their mean distance apart; "
                                      "resampled at it"));
    assert_int_equal(run_shell("$RUGO convert either.txt a.npy --columns map"), 0);
    assert_true(contains("shell.out", "written: 2 by 5 points"));
    assert_int_equal(run_shell("$RUGO convert trace.npy a.npy --columns xz"), 2);
    assert_true(contains("shell.err", "a npy file says what it holds"));
}

static void a_measured_map_is_pressed_in_units(void **state) {
    (void)state;
    assert_int_equal(
        run_shell(
            "awk 'BEGIN { for (j = 0; j < 90; j++) for (i = 0; i < 90; i++) printf \"%.9g%c\", "
            "-((i - 45.3) ^ 2 + (j - 44.8) ^ 2) / 2, i < 89 ? 44 : 10 }' > sphere.csv && $RUGO "
            "press sphere.csv --dx 1um --z-unit nm --modulus 210GPa --force 1N,10.08246154N "
            "--format json -o s.npy --gap g.csv --contact c.png --vtu s.vtu >sphere.json && "
            "$RUGO press sphere.csv --dx 1um --z-unit nm --modulus 210GPa --pressure 1MPa"),
        0);
    assert_true(contains("shell.out", "boundary: open") && contains("shell.out", "peak pressure"));
    assert_int_equal(
        run_shell("test $(wc -l <g.csv) = 90 && head -c 4 c.png | grep -q PNG && grep -q "
                  "'NumberOfPoints=\"8100\"' s.vtu && $RUGO characterise s.npy"),
        0);
    char *text = slurp("sphere.json");
    cJSON *document = cJSON_Parse(text);
    const cJSON *physical = cJSON_GetObjectItem(document, "physical");
    const struct {
        const char *key;
        double value;
    } HERTZ[] = {{"contact_area", 3.2169909e-9},
                 {"peak_pressure", 4.7011922e9},
                 {"approach", 1.024e-6},
                 {"force", 10.08246154}};
    for (size_t h = 0; h < sizeof HERTZ / sizeof *HERTZ; h++) {
        const cJSON *values = cJSON_GetObjectItem(physical, HERTZ[h].key);
        check_relative(cJSON_GetArrayItem(values, 1)->valuedouble, HERTZ[h].value, 0.005);
    }
    assert_string_equal(cJSON_GetObjectItem(document, "boundary")->valuestring, "open");
    assert_true(cJSON_GetObjectItem(document, "cpu_seconds")->valuedouble > 0);
    assert_true(cJSON_GetObjectItem(document, "peak_bytes")->valuedouble > 1e6);
    cJSON_Delete(document);
    free(text);
    assert_int_equal(run_shell("$RUGO press sphere.csv --boundary open --model layered"), 2);
    assert_true(contains("shell.err", "sphere.csv: the map does not repeat, and --model layered"));
    /* Files that could not be written are refused before anything is computed. */
    assert_int_equal(run_shell("$RUGO press sphere.csv --loads 0.1 -o p.pdf > told"), 2);
    assert_true(contains("shell.err", "file p.pdf: its name ends in none of .npy, .csv, .xyz"));
    assert_int_equal(run_shell("$RUGO press sphere.csv --loads 0.1 --vtu no/such.vtu >> told"), 1);
    assert_true(contains("shell.err", "cannot write no/such.vtu: No such file or directory"));
    assert_int_equal(run_shell("[ ! -s told ] && [ ! -e p.pdf ]"), 0);
    assert_int_equal(run_shell("$RUGO press sphere.csv --pressure 1MPa"), 2);
    assert_true(contains("shell.err", "--pressure needs the stiffness of the block"));
}

/* A map too small to have an inside is pressed without a warning of its seam; one with an inside is
 * not. */
static void small_maps_have_no_seam(void **state) {
    (void)state;
    spit("few.csv", "1,2\n2,1\n");
    assert_int_equal(run_shell("$RUGO press few.csv --boundary periodic --loads 0.1"), 0);
    assert_false(contains("shell.err", "its seam is rougher"));
    spit("tilt.csv", "1,2,3,4,5,6,7,8,9,10,11,12\n1,2,3,4,5,6,7,8,9,10,11,12\n");
    assert_int_equal(run_shell("$RUGO press tilt.csv --boundary periodic --loads 0.1"), 0);
    assert_true(contains("shell.err", "its seam is rougher than the roughest place inside"));
}

/* Threads that share a large map give its digits, whatever their number. */
static void threads_give_the_same_digits(void **state) {
    (void)state;
    spit("drawn.json",
         "{\"name\": \"drawn\", \"kind\": \"statistics\", \"surface\": {\"dimension\": 2, "
         "\"hurst\": 0.8, \"wavelength_ratio\": 12, \"length_ratio\": 2, "
         "\"points_per_wavelength\": 8, \"rms_slope\": 0.1}}");
    assert_int_equal(
        run_shell("$RUGO generate drawn.json -o drawn.npy >/dev/null && for threads in 0 1 3; do "
                  "$RUGO press drawn.npy --loads 0.1,0.3 --threads $threads --format csv -o "
                  "$threads.npy > $threads.csv || exit 1; done; cmp 0.csv 1.csv && cmp 0.npy 1.npy "
                  "&& cmp 0.csv 3.csv && cmp 0.npy 3.npy"),
        0);
}

/* Steps and nodes of a pressed surface, and many surfaces at once. */
static void steps_and_ranges_are_written(void **state) {
    (void)state;
    spit("pressed.json",
         "{\"name\": \"pressed\", \"kind\": \"contact\", \"surface\": {\"dimension\": 1, "
         "\"hurst\": 0.8, \"wavelength_ratio\": 2, \"length_ratio\": 2, \"rms_slope\": 0.05}, "
         "\"contact\": {\"model\": [\"halfspace\", \"full\"], \"pressures\": {\"to\": 0.2, "
         "\"steps\": 2}}}");
    assert_int_equal(
        run_shell("$RUGO generate pressed.json --steps all --nodes all.csv --mesh all.inp && "
                  "$RUGO generate pressed.json --steps one --nodes one.csv --model halfspace "
                  "--pressure 0.1 -o z.csv && ls all one && wc -l <all.csv && wc -l <one.csv && "
                  "grep -c '^[*]STEP' all.inp && head -1 all.csv"),
        0);
    assert_true(contains("shell.out", "all:\nstep-1.vtu\nstep-2.vtu\nsteps.pvd\n\none:\n"
                                      "step-1.vtu\nsteps.pvd\n65\n33\n2\nload,node,x,y,z,gap,"
                                      "pressure,status,u_x,u_y,u_z\n"));
    assert_int_equal(run_shell("$RUGO press z.csv --boundary periodic --loads 0.1,0.2 --steps map "
                               "--nodes map.csv >/dev/null && ls map && wc -l <map.csv"),
                     0);
    assert_true(contains("shell.out", "step-1.vtu\nstep-2.vtu\nsteps.pvd\n65\n"));
    assert_int_equal(
        run_shell("$RUGO generate pressed.json --realisation 3..5 -o many/ --format csv && ls many "
                  "&& $RUGO generate pressed.json --realisation 4 -o 4.csv && cmp 4.csv "
                  "many/realisation-4.csv"),
        0);
    assert_true(contains("shell.out", "\nrealisation 5\n"));
    assert_true(contains("shell.out", "realisation-3.csv\nrealisation-4.csv\nrealisation-5.csv\n"));
}

static void wrong_steps_and_ranges_are_refused(void **state) {
    (void)state;
    static const struct {
        const char *options, *error;
    } WRONG[] = {
        {"--realisation 5..3 -o many/", "--realisation 5..3: neither a whole number from 0"},
        {"--realisation 0..3 -o z.npy", "several realisations need a folder: -o DIR/"},
        {"--realisation 0..3 -o many/ --mesh m.msh", "are of one realisation"},
        {"--pressure 0.1", "--pressure belongs to --mesh, --steps or --nodes"},
        {"--model full", "--model belongs to --mesh, --steps or --nodes"},
        {"--steps s --pressure 0.2,0.1", "--pressure 0.2,0.1: not up to 1000 rising numbers"},
        {"--steps s --model layered", "the case has no model layered"},
        {"--mesh m.msh --set contact.model=[\\\"halfspace\\\"]", "--mesh needs \"full\" among"},
        {"--mesh m.stl", "--mesh m.stl: its name ends in none of .vtu, .msh, .inp"},
        {"--nodes n.vtu", "--nodes n.vtu: its name does not end in .csv"},
        {"--picture n.jpg --nodes early.csv", "its name ends in none of .svg, .png, .pdf, .eps"},
    };
    char line[200];
    for (size_t w = 0; w < sizeof WRONG / sizeof *WRONG; w++) {
        snprintf(line, sizeof line, "$RUGO generate pressed.json %s", WRONG[w].options);
        assert_int_equal(run_shell(line), 2);
        assert_true(contains("shell.err", WRONG[w].error));
    }
    assert_int_equal(access("early.csv", F_OK), -1);
    assert_int_equal(run_shell("$RUGO generate one.json --nodes n.csv"), 2);
    assert_true(contains("shell.err", "--nodes needs a study of kind contact"));
    assert_int_equal(run_shell("$RUGO generate pressed.json --nodes no/such.csv"), 1);
    assert_true(contains("shell.err", "cannot open no/such.csv"));
}

/* The program has no locale but "C": numbers are read and written with a point, whatever the
 * environment asks for. */
static void a_comma_in_the_environment_changes_nothing(void **state) {
    (void)state;
    if (!comma_locale_make()) {
        print_message("skipped: localedef makes no locale here\n");
        skip();
    }
    assert_int_equal(
        run_shell("all() { $RUGO check one.json && $RUGO curves one --db l.db && "
                  "$RUGO plot one --db l.db --quantity psd -o l.svg && cat l.svg && "
                  "$RUGO generate one.json -o l.csv && cat l.csv && "
                  "$RUGO characterise l.csv --dx 0.125 && "
                  "$RUGO press l.csv --dx 0.125 --loads 0.1 --format csv; } && "
                  "LC_ALL=comma $RUGO run --db l.db one.json && "
                  "(export LC_ALL=C; all) >point.txt && (export LC_ALL=comma; all) >comma.txt && "
                  "cmp point.txt comma.txt && grep -q 0.125 comma.txt"),
        0);
}

/* Pictures of the autocorrelation and the spectrum have units, also of logarithms, as maps have;
 * maps without units have none. */
static void planes_have_units(void **state) {
    (void)state;
    assert_int_equal(run_shell("$RUGO generate -o plane.csv one.json >/dev/null && $RUGO "
                               "characterise plane.csv --boundary open --dx 0.1um --z-unit nm "
                               "--acf acf.svg --psd psd.svg >/dev/null && $RUGO characterise "
                               "plane.csv --boundary open --acf bare.svg >/dev/null"),
                     0);
    assert_true(contains("acf.svg", ">tx (\xc2\xb5m)<"));
    assert_true(contains("acf.svg", ">R (nm<"));
    assert_true(contains("psd.svg", ">kx (rad/\xc2\xb5m)<"));
    assert_true(contains("psd.svg", ">ky (rad/\xc2\xb5m)<"));
    assert_true(contains("psd.svg", ">log10 C (nm<"));
    assert_true(contains("bare.svg", ">tx<"));
    assert_true(contains("bare.svg", ">R<"));
    /* In xyz 0 is in the middle, too: there an autocorrelation is largest. */
    assert_int_equal(
        run_shell("$RUGO characterise plane.csv --boundary open --dx 0.1um --z-unit nm "
                  "--acf acf.xyz >/dev/null && sort -g -k3 acf.xyz | tail -n 1 | grep "
                  "-q '^0 0 ' && head -n 1 acf.xyz | grep -q '^-.* -'"),
        0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_surface_goes_out_and_in),
        cmocka_unit_test(maps_of_one_surface_go_together),
        cmocka_unit_test(grooves_are_in_no_law_of_several_maps),
        cmocka_unit_test(a_map_in_a_file_is_pressed),
        cmocka_unit_test(several_models_press_a_map),
        cmocka_unit_test(coatings_are_pressed),
        cmocka_unit_test(a_measured_map_does_not_repeat),
        cmocka_unit_test(lengths_have_units),
        cmocka_unit_test(a_map_is_converted),
        cmocka_unit_test(a_patch_is_extended),
        cmocka_unit_test(what_instruments_leave_is_removed),
        cmocka_unit_test(missing_points_are_asked_for),
        cmocka_unit_test(unknown_units_are_said),
        cmocka_unit_test(columns_are_a_trace),
        cmocka_unit_test(groups_are_printed),
        cmocka_unit_test(planes_have_units),
        cmocka_unit_test(a_measured_map_is_pressed_in_units),
        cmocka_unit_test(small_maps_have_no_seam),
        cmocka_unit_test(threads_give_the_same_digits),
        cmocka_unit_test(steps_and_ranges_are_written),
        cmocka_unit_test(wrong_steps_and_ranges_are_refused),
        cmocka_unit_test(a_comma_in_the_environment_changes_nothing),
    };
    return cmocka_run_group_tests(tests, setup, NULL);
}
