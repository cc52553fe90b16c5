#include "jobs/units.h"
#include <cjson/cJSON.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

enum { POWERS_MOST = 2 };

/* An axis or a scalar in a physical unit: `factor` times powers of E* in Pa, of lambda_s in metres
 * and of scalars of the result, over the sum of the resistivities of both bodies. */
struct unit_row {
    const char *of; /* the label of the axis, or the name of the scalar */
    int dimension;  /* of surfaces of this dimension alone; 0: of all */
    enum conduction { NOTHING, CURRENT, HEAT } conducts; /* over the resistivities to it */
    const char *symbol;                                  /* NULL: the name */
    const char *unit;
    int modulus, length;
    struct scalar_power {
        const char *scalar;
        double power;
    } powers[POWERS_MOST];
    double factor; /* 0: 1 */
};

/* clang-format off */
#define SQUARE_ROOT_OF_A_THIRD 0.57735026918962576
#define HEIGHT {{"rms_height", 1}}
#define HEIGHT_SQUARED {{"rms_height", 2}}
#define SLOPE_OVER_HEIGHT {{"rms_slope", 1}, {"rms_height", -1}}
#define SLOPE_TIMES_HEIGHT {{"rms_slope", 1}, {"rms_height", 1}}
#define CONDUCTANCE "G (rho1 + rho2) sqrt(m0)/(2 h'_rms)"
#define CURVATURE {{"m4", 0.5}}
static const struct unit_row AXES[] = {
    {"p/(E* h'_rms)", 0, NOTHING, "p", "Pa", 1, 0, {{"rms_slope", 1}}, 0},
    {"peak p/(E* h'_rms)", 0, NOTHING, "peak p", "Pa", 1, 0, {{"rms_slope", 1}}, 0},
    {"mean gap/sqrt(m0)", 0, NOTHING, "mean gap", "m", 0, 1, HEIGHT, 0},
    {"mean gap/sqrt(m0) as the load falls", 0, NOTHING, "mean gap as the load falls", "m", 0, 1, HEIGHT, 0},
    {"approach/sqrt(m0)", 0, NOTHING, "approach", "m", 0, 1, HEIGHT, 0},
    {"approach left/sqrt(m0)", 0, NOTHING, "approach left", "m", 0, 1, HEIGHT, 0},
    {"tangential displacement/sqrt(m0)", 0, NOTHING, "tangential displacement", "m", 0, 1, HEIGHT, 0},
    {"sliding/sqrt(m0)", 0, NOTHING, "sliding", "m", 0, 1, HEIGHT, 0},
    {"work that friction takes/(E* h'_rms sqrt(m0))", 0, NOTHING, "work that friction takes", "J/m^2", 1, 1, SLOPE_TIMES_HEIGHT, 0},
    {"work of a cycle/(E* h'_rms sqrt(m0))", 0, NOTHING, "work of a cycle", "J/m^2", 1, 1, SLOPE_TIMES_HEIGHT, 0},
    {"Kt sqrt(m0)/(E* h'_rms)", 0, NOTHING, "Kt", "Pa/m", 1, -1, SLOPE_OVER_HEIGHT, 0},
    {"K sqrt(m0)/(E* h'_rms)", 0, NOTHING, "K", "Pa/m", 1, -1, SLOPE_OVER_HEIGHT, 0},
    {CONDUCTANCE, 0, CURRENT, "G", "S/m^2", 0, -1, SLOPE_OVER_HEIGHT, 2},
    {CONDUCTANCE, 0, HEAT, "G", "W/(m^2 K)", 0, -1, SLOPE_OVER_HEIGHT, 2},
    {"patches per lambda_l^2", 0, NOTHING, "patches", "1/m^2", 0, -2, {{"wavelength_ratio", -2}}, 0},
    {"patches per lambda_l", 0, NOTHING, "patches", "1/m", 0, -1, {{"wavelength_ratio", -1}}, 0},
    {"mean patch/lambda_l^2", 0, NOTHING, "mean patch", "m^2", 0, 2, {{"wavelength_ratio", 2}}, 0},
    {"mean patch/lambda_l", 0, NOTHING, "mean patch", "m", 0, 1, {{"wavelength_ratio", 1}}, 0},
    {"z/sqrt(m0)", 0, NOTHING, "z", "m", 0, 1, HEIGHT, 0},
    {"-sqrt(3/m4) kappa_m", 2, NOTHING, "-kappa_m", "1/m", 0, -1, CURVATURE, SQUARE_ROOT_OF_A_THIRD},
    {"kappa_m/sqrt(m4)", 2, NOTHING, "kappa_m", "1/m", 0, -1, CURVATURE, 0},
    {"z''/sqrt(m4)", 1, NOTHING, "z''", "1/m", 0, -1, CURVATURE, 0},
    {"-z''/sqrt(m4)", 1, NOTHING, "-z''", "1/m", 0, -1, CURVATURE, 0},
    {"k lambda_s", 0, NOTHING, "k", "1/m", 0, -1, {{0}}, 0},
    {"power spectral density", 1, NOTHING, "C", "m^3", 0, 3, {{0}}, 0},
    {"power spectral density", 2, NOTHING, "C", "m^4", 0, 4, {{0}}, 0},
    {"lag/lambda_s", 0, NOTHING, "lag", "m", 0, 1, {{0}}, 0},
};
static const struct unit_row SCALARS[] = {
    {"rms_height", 0, NOTHING, NULL, "m", 0, 1, {{0}}, 0},
    {"correlation_length", 0, NOTHING, NULL, "m", 0, 1, {{0}}, 0},
    {"correlation_length_e", 0, NOTHING, NULL, "m", 0, 1, {{0}}, 0},
    {"psd_plateau", 1, NOTHING, NULL, "m^3", 0, 3, {{0}}, 0},
    {"psd_plateau", 2, NOTHING, NULL, "m^4", 0, 4, {{0}}, 0},
    {"rms_curvature", 0, NOTHING, NULL, "1/m", 0, -1, {{0}}, 0},
    {"lowest", 0, NOTHING, NULL, "m", 0, 1, HEIGHT, 0},
    {"highest", 0, NOTHING, NULL, "m", 0, 1, HEIGHT, 0},
    {"m0", 0, NOTHING, NULL, "m^2", 0, 2, {{0}}, 0},
    {"m4", 0, NOTHING, NULL, "1/m^2", 0, -2, {{0}}, 0},
    {"m4_finite_difference", 0, NOTHING, NULL, "1/m^2", 0, -2, {{0}}, 0},
    {"summit_density", 1, NOTHING, NULL, "1/m", 0, -1, {{0}}, 0},
    {"summit_density", 2, NOTHING, NULL, "1/m^2", 0, -2, {{0}}, 0},
    {"summit_height_mean", 0, NOTHING, NULL, "m", 0, 1, HEIGHT, 0},
    {"summit_height_variance", 0, NOTHING, NULL, "m^2", 0, 2, HEIGHT_SQUARED, 0},
    {"summit_curvature_mean", 0, NOTHING, NULL, "1/m", 0, -1, CURVATURE, 0},
    {"pit_density", 1, NOTHING, NULL, "1/m", 0, -1, {{0}}, 0},
    {"pit_density", 2, NOTHING, NULL, "1/m^2", 0, -2, {{0}}, 0},
    {"pit_height_mean", 0, NOTHING, NULL, "m", 0, 1, HEIGHT, 0},
    {"pit_height_variance", 0, NOTHING, NULL, "m^2", 0, 2, HEIGHT_SQUARED, 0},
    {"pit_curvature_mean", 0, NOTHING, NULL, "1/m", 0, -1, CURVATURE, 0},
    {"mean_gap_last", 0, NOTHING, NULL, "m", 0, 1, HEIGHT, 0},
    {"kappa_highest_load", 0, NOTHING, NULL, "Pa", 1, 0, {{"rms_slope", 1}}, 0},
    {"power_law_highest_load", 0, NOTHING, NULL, "Pa", 1, 0, {{"rms_slope", 1}}, 0},
    {"erf_highest_load", 0, NOTHING, NULL, "Pa", 1, 0, {{"rms_slope", 1}}, 0},
    {"percolation_load", 0, NOTHING, NULL, "Pa", 1, 0, {{"rms_slope", 1}}, 0},
    {"sliding_to_full_slip", 0, NOTHING, NULL, "m", 0, 1, HEIGHT, 0},
};
/* clang-format on */

/* What units are made of; NaN: not known. */
struct scales {
    const struct case_result *result;
    int dimension;
    double length;                /* lambda_s in metres */
    double modulus;               /* E* in Pa */
    double resistivity[HEAT + 1]; /* to each, of both bodies together; 1 to nothing */
};

static double number_of(const struct case_result *result, const char *pointer) {
    const struct result_parameter *parameter = result_parameter(result, pointer);
    return parameter != NULL && parameter->text == NULL ? parameter->number : (double)NAN;
}

static bool has_loads_in_pascal(const struct case_result *result) {
    const struct result_parameter *unit = result_parameter(result, "/contact/pressures/unit");
    return unit != NULL && same_text(unit->text, "Pa");
}

/* Young's modulus is 1 unless given, in a unit that nobody knows. The counter body is rigid unless
 * it has one. */
static double modulus_of(const struct case_result *result, double length) {
    double young = number_of(result, "/contact/young"), nu = number_of(result, "/contact/poisson");
    double counter = number_of(result, "/counter_surface/young");
    double counter_nu = number_of(result, "/counter_surface/poisson");
    bool known = young != 1 && (!isnan(length) || has_loads_in_pascal(result));
    if (!known)
        return NAN;
    if (isnan(counter))
        return young / (1 - nu * nu);
    counter_nu = isnan(counter_nu) ? nu : counter_nu;
    return 1 / ((1 - nu * nu) / young + (1 - counter_nu * counter_nu) / counter);
}

/* Returns the sum of the resistivities of both bodies, from an array of one for both or of two. */
static double resistivity_of(const struct case_result *result, const char *pointer, int power) {
    const struct result_parameter *given = result_parameter(result, pointer);
    cJSON *list = given != NULL ? cJSON_Parse(given->text) : NULL;
    const cJSON *one = cJSON_GetArrayItem(list, 0), *two = cJSON_GetArrayItem(list, 1);
    double sum = NAN;
    if (cJSON_IsNumber(one))
        sum = pow(one->valuedouble, power) +
              pow(cJSON_IsNumber(two) ? two->valuedouble : one->valuedouble, power);
    cJSON_Delete(list);
    return sum;
}

void units_scales(const struct case_result *result, double *metres, double *modulus) {
    *metres = number_of(result, "/surface/unit");
    *modulus = modulus_of(result, *metres);
}

/* Returns the scalar that curves are scaled by: of the prescribed spectrum where it is known. */
static double scalar_of(const struct case_result *result, const char *name) {
    const struct scalar *scalar = result_scalar(result, name);
    if (scalar == NULL || scalar->difference)
        return NAN;
    return isnan(scalar->theory) ? scalar->value : scalar->theory;
}

static double scale_of(const struct scales *scales, const struct unit_row *row) {
    double scale = row->factor > 0 ? row->factor : 1;
    if (row->modulus != 0)
        scale *= pow(scales->modulus, row->modulus);
    if (row->length != 0)
        scale *= pow(scales->length, row->length);
    scale /= scales->resistivity[row->conducts];
    for (size_t p = 0; p < POWERS_MOST && row->powers[p].scalar != NULL; p++)
        scale *= pow(scalar_of(scales->result, row->powers[p].scalar), row->powers[p].power);
    return scale;
}

static struct physical_unit unit_in(const struct scales *scales, size_t count,
                                    const struct unit_row *rows, const char *of) {
    for (size_t r = 0; r < count && of != NULL; r++) {
        const struct unit_row *row = &rows[r];
        bool fits = row->dimension == 0 || row->dimension == scales->dimension;
        double scale = fits && strcmp(row->of, of) == 0 ? scale_of(scales, row) : (double)NAN;
        if (scale > 0 && isfinite(scale))
            return (struct physical_unit){row->unit, row->symbol != NULL ? row->symbol : row->of,
                                          scale};
    }
    return (struct physical_unit){0};
}
#define UNIT_IN(scales, rows, of) unit_in(scales, sizeof(rows) / sizeof *(rows), rows, of)

/* Densities are over the unit of the axis. */
static struct physical_unit unit_of_density(const struct physical_unit *axis) {
    static const char *const INVERSE[][2] = {{"Pa", "1/Pa"}, {"m", "1/m"}, {"1/m", "m"}};
    for (size_t n = 0; n < sizeof INVERSE / sizeof *INVERSE && axis->unit != NULL; n++)
        if (strcmp(INVERSE[n][0], axis->unit) == 0)
            return (struct physical_unit){INVERSE[n][1], "probability density", 1 / axis->scale};
    return (struct physical_unit){0};
}

static void set_curve(const struct scales *scales, struct curve *curve) {
    curve->x_unit = UNIT_IN(scales, AXES, curve->x_label);
    curve->x2_unit = UNIT_IN(scales, AXES, curve->columns > 0 ? curve->x2_label : NULL);
    curve->y_unit = UNIT_IN(scales, AXES, curve->y_label);
    if (curve->columns == 0 && strcmp(curve->y_label, "probability density") == 0)
        curve->y_unit = unit_of_density(&curve->x_unit);
    /* of heights in m and curvatures in 1/m */
    if (curve->columns > 0 && curve->x_unit.unit != NULL && curve->x2_unit.unit != NULL)
        curve->y_unit = (struct physical_unit){"1", "probability density",
                                               1 / (curve->x_unit.scale * curve->x2_unit.scale)};
}

static void set_all(const struct scales *scales, struct case_result *result) {
    if (isnan(scales->length) && isnan(scales->modulus))
        return;
    for (size_t a = 0; a < result->curve_count; a++)
        set_curve(scales, &result->curves[a]);
    for (size_t s = 0; s < result->scalar_count; s++)
        result->scalars[s].unit = UNIT_IN(scales, SCALARS, result->scalars[s].name);
}

void units_set(struct case_result *result) {
    struct scales scales = {
        .result = result,
        .dimension = number_of(result, "/surface/dimension") == 1 ? 1 : 2,
        .resistivity = {[NOTHING] = 1,
                        [CURRENT] = resistivity_of(result, "/contact/resistivity", 1),
                        [HEAT] = resistivity_of(result, "/contact/conductivity", -1)}};
    units_scales(result, &scales.length, &scales.modulus);
    set_all(&scales, result);
}

void units_set_of_map(struct case_result *result, const struct map_scales *known) {
    const struct scales scales = {
        .result = result,
        .dimension = known->profile ? 1 : 2,
        .length = known->metres,
        .modulus = known->modulus,
        .resistivity = {[NOTHING] = 1,
                        [CURRENT] = known->heat ? (double)NAN : known->resistivity,
                        [HEAT] = known->heat ? known->resistivity : (double)NAN}};
    set_all(&scales, result);
}
