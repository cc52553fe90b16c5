#include "jobs/surface/surface_counter.h"
#include "schema/json/field.h"
#include "schema/json/json.h"
#include <stdlib.h>
#include <string.h>

static const char SURFACE[] = "surface", COUNTER[] = "counter_surface"; /* members of studies */
static const char RATIO[] = "/counter_surface/wavelength_ratio",
                  LENGTH[] = "/counter_surface/length_ratio";

/* Faults of what the second face has from the first stay where that stands. */
static bool is_shared(const char *pointer) {
    static const char *const SHARED[] = {"/surface/dimension", "/surface/length_ratio_y",
                                         "/surface/points_per_wavelength"};
    for (size_t s = 0; s < sizeof SHARED / sizeof *SHARED; s++)
        if (strcmp(pointer, SHARED[s]) == 0)
            return true;
    return false;
}

/* Adds the faults of the second face, which was read as a surface of its own. */
static void take_faults(const struct fault_list *faults, struct values *values) {
    char pointer[200];
    for (size_t f = 0; f < faults->count && f < FAULTS_KEPT && faults->faults != NULL; f++) {
        const char *at = faults->faults[f].pointer, *detail = faults->faults[f].detail;
        if (at == NULL || detail == NULL)
            continue;
        if (*at == '/' && strncmp(at + 1, SURFACE, sizeof SURFACE - 1) == 0 && !is_shared(at))
            snprintf(pointer, sizeof pointer, "%c%s%s", *at, COUNTER, at + sizeof SURFACE);
        else
            snprintf(pointer, sizeof pointer, "%s", at);
        values_fault(values, pointer, "%s", detail);
    }
}

static bool put_missing(cJSON *object, const char *name, double value) {
    return cJSON_HasObjectItem(object, name) || field_put(object, name, json_number(value));
}

/* Makes a document in which the second face is the surface. A spectrum without ratios has the cell
 * in lambda_s of the first face. */
static cJSON *document_of(const struct surface_case *first, const cJSON *counter, bool affine,
                          double points) {
    cJSON *document = cJSON_CreateObject(), *surface = cJSON_Duplicate(counter, true);
    bool put = document != NULL && surface != NULL &&
               put_missing(surface, "dimension", first->dimension) &&
               put_missing(surface, "points_per_wavelength", points) &&
               put_missing(surface, "length_ratio", first->length_ratio) &&
               (affine || put_missing(surface, "wavelength_ratio", first->wavelength_ratio));
    double length = cJSON_GetNumberValue(cJSON_GetObjectItemCaseSensitive(surface, "length_ratio"));
    put = put && (surface_case_is_square(first) ||
                  put_missing(surface, "length_ratio_y",
                              length * first->length_ratio_y / first->length_ratio));
    if (!put || !cJSON_AddItemToObject(document, SURFACE, surface)) {
        cJSON_Delete(surface);
        cJSON_Delete(document);
        return NULL;
    }
    return document;
}

/* What two faces cannot have. */
static void check_faces(const struct surface_case *first, const struct surface_case *counter,
                        struct values *values) {
    bool scaled = first->spectrum.scale != SCALE_NONE;
    if (scaled != (counter->spectrum.scale != SCALE_NONE))
        values_fault(values, scaled ? "/counter_surface/rms_slope" : "/surface/rms_slope",
                     "give both faces a scale, rms_slope or rms_height, or neither");
    if (first->plateau != NULL)
        values_fault(
            values, "/surface/plateau/rms_ratio",
            "the sum of two faces is of faces of one surface each; allowed: one of plateau "
            "and counter_surface");
    if (first->grooves != NULL)
        values_fault(values, "/surface/grooves/period",
                     "grooves are of one face that a flat is pressed on; allowed: one of grooves "
                     "and counter_surface");
    if (surface_case_translated(first))
        values_fault(values, "/surface/heights/law",
                     "\"translation\": the sum of two faces is no translation; allowed: "
                     "\"iterated\"");
    if (surface_case_translated(counter))
        values_fault(values, "/counter_surface/heights/law",
                     "\"translation\": the sum of two faces is no translation; allowed: "
                     "\"iterated\"");
}

/* Brings the wavelengths of the second face to lambda_s of the first. */
static void scale_waves(const struct surface_case *first, struct surface_case *counter) {
    struct spectrum *spectrum = &counter->spectrum;
    if (spectrum->type != SPECTRUM_SELF_AFFINE)
        return;
    double unit = first->grid.lx / (counter->length_ratio * counter->wavelength_ratio);
    spectrum->wavelength_short *= unit;
    spectrum->wavelength_long *= unit;
    spectrum->wavelength_rolloff *= unit;
}

/* Gives the second face to the first, whose grid becomes that of both. */
static int join(struct surface_case *first, struct surface_case *counter, double points,
                struct values *values, struct error *err) {
    scale_waves(first, counter);
    first->counter = array_create(1, sizeof *first->counter);
    first->counter_face = array_create(1, sizeof *first->counter_face);
    if (first->counter == NULL || first->counter_face == NULL) {
        surface_case_clear(counter);
        return error_memory(err, sizeof *counter, "a counter face");
    }
    *first->counter = *counter;
    *first->counter_face =
        (struct counter_face){.spectrum = counter->spectrum, .options = counter->options};
    first->spectrum.counter = first->counter_face;
    surface_case_grid(first, points, "/surface/points_per_wavelength", values, &first->grid);
    return 0;
}

static int read_counter(struct surface_case *first, const cJSON *counter, bool affine,
                        struct values *values, struct error *err) {
    double points = values_number(values, "/surface/points_per_wavelength");
    struct fault_list faults = {0};
    struct surface_case face;
    struct error reason = {0};
    cJSON *document = document_of(first, counter, affine, points);
    if (document == NULL)
        return error_memory(err, sizeof face, "a counter face");
    size_t before = values_fault_count(values);
    int status = surface_case_read(&face, document, &faults, &reason);
    take_faults(&faults, values);
    if (status == ERROR_INPUT && values_fault_count(values) == before)
        values_fault(values, RATIO, "%s", reason.text);
    if (status == 0)
        check_faces(first, &face, values);
    if (status == 0 && values_fault_count(values) == before)
        status = join(first, &face, points, values, err);
    else if (status == 0)
        surface_case_clear(&face);
    else if (status != ERROR_INPUT)
        status = error_set(err, status, "%s", reason.text);
    fault_list_clear(&faults);
    cJSON_Delete(document);
    return status == ERROR_INPUT ? 0 : status;
}

int surface_counter_fill(struct surface_case *out, const cJSON *parameters, struct values *values,
                         const struct surface_case **surface, struct error *err) {
    const cJSON *counter = cJSON_GetObjectItemCaseSensitive(parameters, COUNTER);
    size_t before = values_fault_count(values);
    bool affine = values_choice(values, "/counter_surface/spectrum/type") == SPECTRUM_SELF_AFFINE;
    if (counter == NULL || *surface == NULL)
        return 0;
    for (size_t p = 0; p < 2 && !affine; p++) {
        const char *path = p == 0 ? RATIO : LENGTH;
        if (values_is_given(values, path))
            values_fault(values, path,
                         "belongs to a self-affine spectrum: others are in lambda_s of /surface, "
                         "and have its cell");
    }
    int status =
        values_fault_count(values) == before ? read_counter(out, counter, affine, values, err) : 0;
    if (status == 0 && values_fault_count(values) == before)
        return 0;
    surface_case_clear(out);
    *surface = NULL;
    return status;
}

struct counter_body surface_counter_body(const cJSON *parameters, struct values *values,
                                         double poisson) {
    struct counter_body body = {.given = cJSON_HasObjectItem(parameters, COUNTER),
                                .young = values_number(values, "/counter_surface/young"),
                                .poisson = values_number(values, "/counter_surface/poisson")};
    if (isnan(body.young) && !isnan(body.poisson))
        values_fault(values, "/counter_surface/poisson",
                     "%g: a rigid counter body has none; give its young, too", body.poisson);
    if (isnan(body.poisson))
        body.poisson = poisson;
    return body;
}
