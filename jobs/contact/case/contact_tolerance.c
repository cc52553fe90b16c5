#include "jobs/contact/case/contact_tolerance.h"
#include "schema/json/field.h"
#include "schema/json/json.h"
#include <math.h>

static const char PATH[] = "/contact/tolerance";

/* Areas by edges and gaps are within about 1 % of their limit on 8 points a shortest wave, where
 * that error falls with the square of the points. A third level shows the order, and the error is
 * known to a quarter (test_contact_errors.c). */
static const double MESH_ERROR = 0.01, MESH_POINTS = 8, KNOWN = 0.25;
enum { LEVELS_KNOWN = 3 };

static const double SHARE = 0.01, LEAST = 1e-8, MOST = 1e-4;

double contact_tolerance(double points, size_t levels) {
    double error = MESH_ERROR * pow(MESH_POINTS / points, 2);
    if (levels >= LEVELS_KNOWN)
        error *= KNOWN;
    return fmin(MOST, fmax(LEAST, SHARE * error));
}

int contact_tolerance_fill(const cJSON *document, cJSON *parameters, struct error *err) {
    const cJSON *levels = json_at(parameters, "/contact/levels");
    int count = cJSON_GetArraySize(levels);
    const cJSON *finest = count > 0 ? cJSON_GetArrayItem(levels, count - 1)
                                    : json_at(parameters, "/surface/points_per_wavelength");
    cJSON *contact = cJSON_GetObjectItemCaseSensitive(parameters, "contact");
    if (json_at(document, PATH) != NULL || contact == NULL || !cJSON_IsNumber(finest))
        return 0;
    double tolerance = contact_tolerance(finest->valuedouble, count > 0 ? (size_t)count : 1);
    cJSON_DeleteItemFromObjectCaseSensitive(contact, "tolerance");
    return field_put(contact, "tolerance", json_number(tolerance))
               ? 0
               : error_memory(err, sizeof tolerance, "a tolerance");
}
