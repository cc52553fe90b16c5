/* The rows of /contact/.... Several have defaults that depend on others: contact_case.c. */
#include "core/full/material.h"
#include "jobs/contact/case/contact_case.h"
#include "jobs/contact/model/model.h"

static const struct choice HEIGHTS[] = {{"infinite", 0}, {0}};
static const struct choice HEIGHT_UNITS[] = {
    {"rms_heights", HEIGHT_RMS_HEIGHTS}, {"lengths", HEIGHT_LENGTHS}, {0}};
static const struct choice FINE_HEIGHTS[] = {{"whole", 0}, {0}};
static const struct choice FINE_UNITS[] = {
    {"rms_heights", HEIGHT_RMS_HEIGHTS}, {"wavelengths", HEIGHT_WAVELENGTHS}, {0}};
static const struct choice WEIGHTINGS[] = {{"standard", GAP_STANDARD}, {"dual", GAP_DUAL}, {0}};
static const struct choice AREAS[] = {{"flat", false}, {"current", true}, {0}};
static const struct choice GAP_DIRECTIONS[] = {{"vertical", false}, {"normal", true}, {0}};
static const struct choice COMPANION_CHOICES[] = {
    {"probed", COMPANION_PROBED}, {"none", COMPANION_NONE}, {0}};
static const struct choice PAIRS[] = {{"counted", PAIRS_COUNTED}, {"omitted", PAIRS_OMITTED}, {0}};
static const struct choice KEPT_LOADS[] = {{"all", 0}, {0}};
static const struct choice ESTIMATORS[] = {
    {"nodes", AREA_NODES}, {"edges", AREA_EDGES}, {"perimeter", AREA_PERIMETER}, {0}};

static const struct choice STIFFNESSES[] = {
    {"measured", STIFFNESS_MEASURED}, {"omitted", STIFFNESS_OMITTED}, {0}};

static const struct choice ASPERITIES[] = {
    {"omitted", ASPERITIES_OMITTED}, {"counted", ASPERITIES_COUNTED}, {0}};
static const struct choice LOAD_UNITS[] = {
    {"E* h'", LOAD_UNIT_REDUCED}, {"Pa", LOAD_UNIT_PASCAL}, {0}};

#define COATING_TARGET "a target's bounds were measured on blocks without a coating"

static const struct parameter ROWS[] = {
    {.path = "/contact/model",
     .type = PARAMETER_CHOICES,
     .choices = CONTACT_MODEL_CHOICES,
     .default_json = "\"halfspace\"",
     .example_json = "[\"halfspace\", \"layered\"]",
     .help = "what the block is made of (full: finite elements on the rough geometry itself), or a "
             "list of models, all solved on the same realisations"},
    {.path = "/contact/young",
     .symbol = "E",
     .type = PARAMETER_NUMBER,
     .minimum = 0,
     .maximum = 1e100,
     .above_minimum = true,
     .sweep = true,
     .default_json = "1",
     .unit = "any",
     .example_json = "70",
     .help = "Young's modulus E; results are dimensionless and do not depend on it"},
    {.path = "/contact/poisson",
     .symbol = "nu",
     .type = PARAMETER_NUMBER,
     .minimum = 0,
     .maximum = 0.4999,
     .sweep = true,
     .default_json = "0.3",
     .example_json = "0.3",
     .help = "Poisson's ratio; without influence on a half-space that has no coating"},
    {.path = "/contact/coating/thickness",
     .symbol = "t",
     .title = "thickness of the coating",
     .type = PARAMETER_NUMBER,
     .minimum = 0,
     .maximum = 1e6,
     .sweep = true,
     .target_refusal = COATING_TARGET,
     .later = true,
     .unit = "lambda_s",
     .example_json = "[0, 0.5, 2]",
     .help = "halfspace, layered: thickness of a layer of another material, bonded to the face of "
             "the block; below the block's height; 0, or not given: there is none. E*, and with "
             "it loads and curves, is that of the block below"},
    {.path = "/contact/coating/modulus",
     .symbol = "E1/E2",
     .title = "modulus of the coating",
     .type = PARAMETER_NUMBER,
     .minimum = COATING_LEAST,
     .maximum = COATING_MOST,
     .sweep = true,
     .target_refusal = COATING_TARGET,
     .later = true,
     .example_json = "[0.5, 4]",
     .help = "Young's modulus of the coating over that of the block below; with a thickness it is "
             "to be given"},
    {.path = "/contact/coating/poisson",
     .symbol = "nu1",
     .title = "Poisson's ratio of the coating",
     .type = PARAMETER_NUMBER,
     .minimum = 0,
     .maximum = 0.4999,
     .sweep = true,
     .target_refusal = COATING_TARGET,
     .later = true,
     .example_json = "0.2",
     .help = "Poisson's ratio of the coating; unless given that of the block below"},
    {.path = "/contact/block_height",
     .type = PARAMETER_MEASURE,
     .choices = HEIGHTS,
     .units = HEIGHT_UNITS,
     .minimum = 0,
     .maximum = 1e6,
     .above_minimum = true,
     .sweep = true,
     .unit = "the named one",
     .example_json = "{\"lengths\": 2}",
     .help = "height of the block, in RMS heights of the surface (rms_heights) or in sides of the "
             "cell, the longer one of a rectangle (lengths); unless given, halfspace is infinite, "
             "layered and full are 1.5 sides "
             "high; full: 4 RMS heights or more"},
    {.path = "/contact/layer_growth",
     .type = PARAMETER_NUMBER,
     .minimum = 1,
     .maximum = 2,
     .sweep = true,
     .default_json = "1.1",
     .example_json = "1.2",
     .help = "layered, full: thickness of a layer over that above it"},
    {.path = "/contact/transition_depth",
     .type = PARAMETER_NUMBER,
     .minimum = 1,
     .maximum = 1e9,
     .sweep = true,
     .default_json = "8",
     .unit = "their widths",
     .example_json = "1e9",
     .help = "full: depth from which columns of elements are twice as wide, and twice again; 1e9: "
             "all as wide as those of the surface"},
    {.path = "/contact/block_fine_height",
     .type = PARAMETER_MEASURE,
     .choices = FINE_HEIGHTS,
     .units = FINE_UNITS,
     .minimum = 0,
     .maximum = 1e9,
     .above_minimum = true,
     .sweep = true,
     .target_refusal = "a target chooses the depth of the fine zone by transition_depth",
     .later = true,
     .unit = "the named one",
     .example_json = "{\"rms_heights\": 40}",
     .help = "full: depth of the fine zone, in which columns of elements are as wide as those of "
             "the surface, in RMS heights of the surface (rms_heights) or in lambda_s "
             "(wavelengths); or whole, the block. In place of transition_depth, which is in "
             "widths"},
    {.path = "/contact/gap_weighting",
     .type = PARAMETER_CHOICE,
     .choices = WEIGHTINGS,
     .sweep = true,
     .default_json = "\"standard\"",
     .example_json = "[\"standard\", \"dual\"]",
     .help = "layered, full: shape functions that weight the gap of a node: standard ones, over it "
             "and its neighbours, or dual ones, at it alone; multipliers are dual in both"},
    {.path = "/contact/areas",
     .type = PARAMETER_CHOICE,
     .choices = AREAS,
     .sweep = true,
     .target_refusal = "a target compares models over the flat grid",
     .target_choice = "flat",
     .later = true,
     .example_json = "\"current\"",
     .help = "full: what areas, mean gaps and densities of pressure are over: the flat grid "
             "(unless given), or the rough face as it stands under load, with its slopes"},
    {.path = "/contact/gap_direction",
     .type = PARAMETER_CHOICE,
     .choices = GAP_DIRECTIONS,
     .sweep = true,
     .target_refusal = "a target compares vertical gaps of models",
     .target_choice = "vertical",
     .later = true,
     .example_json = "\"normal\"",
     .help = "full: direction in which gaps are measured: vertical (unless given), or along the "
             "normal of the face as it stands, to the flat; what touches does not depend on it"},
    {.path = "/contact/time_limit",
     .type = PARAMETER_NUMBER,
     .minimum = 0,
     .maximum = 1e9,
     .above_minimum = true,
     .target_refusal = "a target solves what its error takes",
     .later = true,
     .unit = "s",
     .example_json = "600",
     .help =
         "full: seconds of CPU time that the loads of a realisation may take on a level, as many "
         "the load that slides, which is pressed anew, and as many its sliding; counted by "
         "iterations as rugo check counts them, so that results stay the same; the loads before "
         "keep their values, and a note says so"},
    {.path = "/contact/kinematics",
     .type = PARAMETER_CHOICE,
     .choices = KINEMATICS_CHOICES,
     .sweep = true,
     .default_json = "\"hencky\"",
     .example_json = "\"small\"",
     .help =
         "full: hencky (finite, logarithmic strain), st_venant_kirchhoff (finite strain, Green's), "
         "small (linear strain on the rough geometry), or neo_hooke (finite strain, of rubber)"},
    {.path = "/contact/pressures/to",
     .type = PARAMETER_NUMBER,
     .minimum = 0,
     .maximum = CONTACT_LOAD_NUMBER_MOST,
     .above_minimum = true,
     .sweep = true,
     .unit = "E* h'",
     .example_json = "0.1",
     .help = "highest load, up to 1e6 E* h'; 0.3 unless given"},
    {.path = "/contact/pressures/steps",
     .type = PARAMETER_INTEGER,
     .minimum = 1,
     .maximum = CONTACT_LOADS_MOST,
     .example_json = "10",
     .help = "number of loads, evenly spaced up to the highest; 30 unless given"},
    {.path = "/contact/pressures/values",
     .type = PARAMETER_NUMBERS,
     .minimum = 0,
     .maximum = CONTACT_LOAD_NUMBER_MOST,
     .above_minimum = true,
     .items_low = 1,
     .items_high = CONTACT_LOADS_MOST,
     .unit = "E* h'",
     .example_json = "[0.001, 0.01, 0.1]",
     .help = "rising loads, up to 1e6 E* h', in place of the two above"},
    {.path = "/contact/pressures/unit",
     .type = PARAMETER_CHOICE,
     .choices = LOAD_UNITS,
     .target_refusal = "a target has loads in E* h'",
     .target_choice = "E* h'",
     .later = true,
     .example_json = "\"Pa\"",
     .help = "of the loads above, of those out of them (pressure_pdf/at, keep/loads) and of "
             "slip/pressure: E* h' (unless given), or Pa, which needs young in Pa and a surface "
             "with rms_slope or rms_height; curves have "
             "loads in E* h' and in Pa"},
    {.path = "/contact/estimators",
     .type = PARAMETER_CHOICES,
     .choices = ESTIMATORS,
     .example_json = "[\"nodes\", \"edges\"]",
     .help =
         "of the contact area: nodes (with its bracket), edges, and in surfaces perimeter; all of "
         "them unless given; with a target edges, and those that are given"},
    {.path = "/contact/stiffness",
     .type = PARAMETER_CHOICE,
     .choices = STIFFNESSES,
     .later = true,
     .example_json = "\"omitted\"",
     .help =
         "measured or omitted, which spares half-spaces up to a quarter of their work and other "
         "models none; unless given measured, with a target omitted"},
    {.path = "/contact/asperities",
     .type = PARAMETER_CHOICE,
     .choices = ASPERITIES,
     .target_refusal = "a target answers contact that is solved",
     .target_choice = "omitted",
     .later = true,
     .example_json = "\"counted\"",
     .help = "theories of asperities by the summits of each surface, without a profile's: counted, "
             "or omitted unless given"},
    {.path = "/contact/levels",
     .type = PARAMETER_NUMBERS,
     .minimum = 2,
     .maximum = 1e4,
     .items_low = 1,
     .items_high = CONTACT_LEVELS_MOST,
     .example_json = "[4, 8, 16]",
     .help = "rising values of points_per_wavelength, each a mesh for the same realisations; the "
             "surface's own unless given"},
    {.path = "/contact/tolerance",
     .type = PARAMETER_NUMBER,
     .minimum = 1e-12,
     .maximum = 1e-2,
     .sweep = true,
     .default_json = "1e-8", /* of cases whose program did not yet write one out */
     .default_text = "by the finest mesh",
     .unit = "largest displacements",
     .example_json = "1e-6",
     .help = "largest violation of the contact conditions; full: largest out-of-balance force, "
             "over the largest contact force; unless given 1e-4 (8/n)^2 on n points a shortest "
             "wave, a quarter of that with three levels, 1e-4 at most and 1e-8 at least"},
    {.path = "/contact/cell_error",
     .type = PARAMETER_CHOICE,
     .choices = COMPANION_CHOICES,
     .target_refusal =
         "a target bounds the error of cells whose length is left out, and of no others",
     .later = true,
     .example_json = "\"none\"",
     .help = "what the length of the cell changes: probed (unless given) on longer surfaces and "
             "ones as long, for about a second or a tenth of the time; or none, and it is not "
             "known"},
    {.path = "/contact/law_difference",
     .type = PARAMETER_CHOICE,
     .choices = COMPANION_CHOICES,
     .later = true,
     .example_json = "\"none\"",
     .help = "what the other law of heights that are not Gaussian would give: probed (unless "
             "given) on some surfaces, for less than a tenth of the time; or none, and it is not "
             "known"},
    {.path = "/contact/generation_error",
     .type = PARAMETER_CHOICE,
     .choices = COMPANION_CHOICES,
     .later = true,
     .example_json = "\"none\"",
     .help = "of older studies, and without effect: law_difference replaces it"},
    {.path = "/contact/pressure_pdf/at",
     .type = PARAMETER_NUMBERS,
     .minimum = 0,
     .maximum = CONTACT_LOAD_NUMBER_MOST,
     .above_minimum = true,
     .items_low = 1,
     .items_high = CONTACT_LOADS_MOST,
     .unit = "E* h'",
     .example_json = "[0.1, 0.3]",
     .help = "rising loads, out of the study's, whose pressures are counted; the last one unless "
             "given"},
    {.path = "/contact/pressure_pdf/bins",
     .type = PARAMETER_NUMBERS,
     .minimum = 0,
     .maximum = 1e6,
     .items_low = 3,
     .items_high = 3,
     .default_json = "[0, 4, 80]",
     .unit = "E* h'",
     .example_json = "[0, 2, 40]",
     .help = "[low, high, count] of the histograms of pressures; a target answers densities of "
             "pressure where /contact/pressure_pdf/at or this is given"},
    {.path = "/contact/pressure_pdf/pairs",
     .type = PARAMETER_CHOICE,
     .choices = PAIRS,
     .target_refusal = "a target counts the pairs that its sum needs",
     .target_choice = "counted",
     .later = true,
     .example_json = "\"counted\"",
     .help = "differences of the densities of pressure between models and levels, realisation by "
             "realisation: counted, and the densities have the error of the model; or omitted "
             "(unless given)"},
    {.path = "/contact/keep/realisations",
     .type = PARAMETER_NUMBERS,
     .minimum = 0,
     .maximum = STUDY_REALISATIONS_MOST - 1,
     .items_low = 1,
     .items_high = CONTACT_KEPT_MOST,
     .target_refusal = "a target has realisations of many cells and meshes, and none of its own",
     .later = true,
     .example_json = "[0, 1]",
     .help =
         "rising numbers of realisations whose nodes rugo run --out writes, by each model on the "
         "finest mesh"},
    {.path = "/contact/keep/loads",
     .type = PARAMETER_NUMBERS,
     .choices = KEPT_LOADS,
     .minimum = 0,
     .maximum = CONTACT_LOAD_NUMBER_MOST,
     .above_minimum = true,
     .items_low = 1,
     .items_high = CONTACT_LOADS_MOST,
     .unit = "E* h'",
     .target_refusal = "a target has realisations of many cells and meshes, and none of its own",
     .later = true,
     .example_json = "[0.1, 0.3]",
     .help = "rising loads, out of the study's, of these files; all of them unless given"},
};
const struct parameter_table CONTACT_PARAMETERS = {"contact", ROWS, sizeof ROWS / sizeof *ROWS};
