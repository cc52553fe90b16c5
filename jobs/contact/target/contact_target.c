#include "jobs/contact/target/contact_target.h"
#include "jobs/contact/case/contact_case.h"
#include "jobs/contact/model/model.h"
#include "jobs/contact/target/contact_sum.h"
#include "jobs/target.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Realisations of the first round: enough to estimate variances. */
enum {
    BASE_FIRST = 32,
    CELL_FIRST = 64,
    MESH_FIRST = 16,
    FINE_FIRST = 16,
    MODEL_FIRST = 8,
    MODEL_MESH_FIRST = 6,
    COMPONENTS_MOST = 8
};
enum { LADDER_MOST = 5, LADDER_LEAST = 3 };
static const double COARSEST = 4; /* points a shortest wave, of meshes that are chosen */

/* Most of the error asked for that the heights of a profile may take, and the same of a small
 * error; and an area at light loads. */
static const double HEIGHTS_MOST = 0.65, HEIGHTS_SMALL = 0.35, LIGHT_AREA = 0.05;
/* Errors below this are small. Much of them is the difference of models, which changes by up to 0.1
 * % of the area from 16 to 32 points a shortest wave at light loads. It is then estimated on meshes
 * twice as fine, and heights may take the smaller share. */
static const double SMALL_ERROR = 0.004;
/* The share of the error asked for that meshes of any fineness may leave. */
static const double FLOOR_MOST = 0.2;

/* The parameters that the study leaves to be chosen. */
struct choices {
    struct target target;
    const char *model; /* borrowed from the parameters */
    bool mesh, length, height, weighting, tolerance, transition;
    bool stiffness; /* is asked for */
    bool densities; /* of pressure are asked for */
    bool profile;
    bool own_grid; /* the surface depends on the grid that it is generated on, which is kept */
    double ladder[LADDER_MOST];
    size_t levels;
    /* Lengths of a rectangular cell are those of its shorter side, here and in variants. */
    double length_ratio, mesh_length_ratio, fine_length_ratio, model_length_ratio;
    double sides[2];         /* of a rectangle that the study names, along x and y; else 0 */
    double transition_depth; /* of columns */
    /* In place of nayak_alpha, which would give others on each cell; or NaN, and the exponent also
     * where it is given. */
    double wavelength_ratio, hurst;
};

/* How a component differs from the case. */
struct variant {
    const char *role;
    uint64_t realisations;
    double share;        /* as in struct study_case */
    bool both;           /* both models; else the cheap one */
    size_t first, count; /* of the ladder */
    double length_ratio;
    bool law; /* estimates the law difference */
};

/* --- parameters --- */

/* Replaces a value; takes the new one (NULL: out of memory). */
static int put(cJSON *parameters, const char *table, const char *name, cJSON *value) {
    cJSON *object = cJSON_GetObjectItemCaseSensitive(parameters, table);
    if (object == NULL)
        object = cJSON_AddObjectToObject(parameters, table);
    cJSON_DeleteItemFromObjectCaseSensitive(object, name);
    if (object != NULL && value != NULL && cJSON_AddItemToObject(object, name, value))
        return 0;
    cJSON_Delete(value);
    return ERROR_MEMORY;
}

static void take_out(cJSON *parameters, const char *table, const char *name) {
    cJSON_DeleteItemFromObjectCaseSensitive(cJSON_GetObjectItemCaseSensitive(parameters, table),
                                            name);
}

/* Sets the length; a rectangle keeps its shape. */
static int put_length(cJSON *parameters, const struct choices *choices, double length) {
    static const char *const names[] = {"length_ratio", "length_ratio_y"};
    if (!(choices->sides[0] > 0))
        return put(parameters, "surface", "length_ratio", cJSON_CreateNumber(length));
    int status = 0;
    for (size_t a = 0; a < 2 && status == 0; a++)
        status = put(parameters, "surface", names[a],
                     cJSON_CreateNumber(choices->sides[a] * (length / choices->length_ratio)));
    return status;
}

/* Keeps the height of the block, which may be given in lengths of the cell. */
static int put_height(cJSON *parameters, const struct choices *choices,
                      const struct variant *variant) {
    const cJSON *lengths = json_at(parameters, "/contact/block_height/lengths");
    if (lengths == NULL && (!choices->height || !variant->both))
        return 0;
    double height = lengths != NULL
                        ? lengths->valuedouble * choices->length_ratio / variant->length_ratio
                        : 1.5;
    cJSON *value = cJSON_CreateObject();
    if (value == NULL || cJSON_AddNumberToObject(value, "lengths", height) == NULL) {
        cJSON_Delete(value);
        return ERROR_MEMORY;
    }
    return put(parameters, "contact", "block_height", value);
}

/* Leaves the estimators that are asked for, and edges: the error asked for is of these. */
static int put_estimators(cJSON *parameters) {
    static const char edges[] = "edges";
    const cJSON *asked = json_at(parameters, "/contact/estimators"), *one;
    cJSON *all = cJSON_CreateStringArray((const char *const[]){edges}, 1);
    bool list = cJSON_IsArray(asked), added = all != NULL;
    for (one = list ? asked->child : asked; added && one != NULL; one = list ? one->next : NULL)
        if (cJSON_IsString(one) && strcmp(one->valuestring, edges) != 0)
            added = cJSON_AddItemToArray(all, cJSON_CreateString(one->valuestring));
    if (added)
        return put(parameters, "contact", "estimators", all);
    cJSON_Delete(all);
    return ERROR_MEMORY;
}

/* Returns the object of the densities, made where there is none; NULL: no memory. */
static cJSON *densities_of(cJSON *parameters) {
    static const char name[] = "pressure_pdf";
    cJSON *contact = cJSON_GetObjectItemCaseSensitive(parameters, "contact");
    cJSON *densities = cJSON_GetObjectItemCaseSensitive(contact, name);
    return densities != NULL ? densities : cJSON_AddObjectToObject(contact, name);
}

/* Has a component count the differences of densities, where it has any. */
static int put_pairs(cJSON *parameters, bool counted) {
    cJSON *densities = densities_of(parameters);
    cJSON_DeleteItemFromObjectCaseSensitive(densities, "pairs");
    if (densities == NULL)
        return ERROR_MEMORY;
    return !counted || cJSON_AddStringToObject(densities, "pairs", "counted") != NULL
               ? 0
               : ERROR_MEMORY;
}

/* Writes out the load of the densities of a study that leaves it out: the highest. A case with
 * loads of densities is one that answers them. */
static int put_density_loads(cJSON *parameters) {
    const cJSON *loads = json_at(parameters, "/contact/pressures/values");
    const cJSON *last = cJSON_GetArrayItem(loads, cJSON_GetArraySize(loads) - 1);
    cJSON *densities = densities_of(parameters);
    if (json_at(densities, "/at") != NULL || last == NULL)
        return 0;
    cJSON *at = cJSON_CreateDoubleArray(&last->valuedouble, 1);
    if (densities != NULL && at != NULL && cJSON_AddItemToObject(densities, "at", at))
        return 0;
    cJSON_Delete(at);
    return ERROR_MEMORY;
}

/* Means of areas by edges and gaps are within about this of the exact ones: a thousandth of the
 * error asked for. Components subtract solutions of one surface, and their differences must be a
 * hundredth below that error too. The bound of it (contact_errors.c) is several times as much. */
static double tolerance_of(const struct choices *choices) {
    return fmax(1e-8, fmin(1e-4, 1e-3 * choices->target.error));
}

/* Returns the cheap model that another is compared with on the same mesh. The one with the same
 * elements has the same error of the mesh, and becomes the half-space in the limit of the levels. A
 * named mesh has no such limit. */
static const char *linear_model(const struct choices *choices) {
    bool limit = choices->mesh && strcmp(choices->model, "layered") != 0;
    return limit ? "layered" : "halfspace";
}

/* Sets what a component estimates of errors, and the pairs that its differences need. */
static int put_errors(cJSON *parameters, const struct choices *choices,
                      const struct variant *variant) {
    /* the components together estimate the error of the cell */
    int status = put(parameters, "contact", "cell_error", cJSON_CreateString("none"));
    if (status == 0 && !variant->law)
        status = put(parameters, "contact", "law_difference", cJSON_CreateString("none"));
    cJSON *like = cJSON_GetObjectItemCaseSensitive(
        cJSON_GetObjectItemCaseSensitive(parameters, "surface"), "like");
    cJSON_DeleteItemFromObjectCaseSensitive(like, "uncertainty"); /* it is not known of an answer */
    if (status == 0 && choices->densities)
        status = put_pairs(parameters, variant->both || variant->count > 1);
    return status;
}

static cJSON *variant_parameters(const struct study_case *one, const struct choices *choices,
                                 const struct variant *variant) {
    const char *const models[] = {variant->both ? linear_model(choices) : "halfspace",
                                  choices->model};
    cJSON *all = cJSON_Duplicate(one->parameters, true);
    const double *ladder = choices->ladder + variant->first;
    if (all == NULL)
        return NULL;
    cJSON_DeleteItemFromObjectCaseSensitive(all, "target");
    int status = put_estimators(all);
    if (status == 0 && !choices->stiffness)
        status = put(all, "contact", "stiffness", cJSON_CreateString("omitted"));
    if (status == 0)
        status =
            put(all, "contact", "model", cJSON_CreateStringArray(models, variant->both ? 2 : 1));
    if (!variant->both) /* only elements have it */
        take_out(all, "contact", "gap_weighting");
    else if (status == 0 && choices->weighting) /* it is nearer to the limit in profiles */
        status = put(all, "contact", "gap_weighting", cJSON_CreateString("dual"));
    if (status == 0 && choices->transition)
        status =
            put(all, "contact", "transition_depth", cJSON_CreateNumber(choices->transition_depth));
    if (status == 0)
        status =
            put(all, "contact", "levels", cJSON_CreateDoubleArray(ladder, (int)variant->count));
    if (status == 0)
        status = put_length(all, choices, variant->length_ratio);
    if (status == 0 && !isnan(choices->wavelength_ratio)) {
        take_out(all, "surface", "nayak_alpha");
        status =
            put(all, "surface", "wavelength_ratio", cJSON_CreateNumber(choices->wavelength_ratio));
    }
    if (status == 0 && !isnan(choices->hurst))
        status = put(all, "surface", "hurst", cJSON_CreateNumber(choices->hurst));
    if (status == 0 && !choices->own_grid)
        status = put(all, "surface", "points_per_wavelength",
                     cJSON_CreateNumber(ladder[variant->count - 1]));
    if (status == 0 && choices->tolerance)
        status = put(all, "contact", "tolerance", cJSON_CreateNumber(tolerance_of(choices)));
    if (status == 0)
        status = put_errors(all, choices, variant);
    if (status == 0)
        status = put_height(all, choices, variant);
    if (status == 0)
        return all;
    cJSON_Delete(all);
    return NULL;
}

/* --- choices --- */

/* Returns the one model that is asked for; NULL, and a fault, if there are several. */
static const char *read_model(const cJSON *parameters, struct fault_list *faults) {
    const cJSON *model = json_at(parameters, "/contact/model");
    if (cJSON_IsArray(model) && cJSON_GetArraySize(model) == 1)
        model = model->child;
    if (cJSON_IsString(model))
        return model->valuestring;
    fault_add(faults, "/contact/model", "a target is of one model; the others come by themselves");
    return NULL;
}

/* Returns how many times an error must be multiplied by five to reach 5 %, at most 4. The smaller
 * the error, the finer the meshes and the longer the cells that are chosen. */
static size_t steps_of(double error) {
    size_t steps = 0;
    while (steps < 4 && error * pow(5, (double)steps) < 0.05)
        steps++;
    return steps;
}

/* Returns whether heights are translated from a Gaussian field: they have waves shorter than the
 * band's, for which profiles need a level more. */
static bool is_translated(const cJSON *parameters) {
    const cJSON *law = json_at(parameters, "/surface/heights/law");
    return cJSON_IsString(law) && strcmp(law->valuestring, "translation") == 0;
}

/* Reads or chooses the levels: from the coarsest that is solved up to the one that the study names,
 * or to one that is fine enough, as far as that is known in advance. */
static void read_ladder(struct choices *out, const cJSON *document, const cJSON *parameters,
                        struct fault_list *faults) {
    const cJSON *levels = json_at(document, "/contact/levels");
    double points = json_number_at(parameters, "/surface/points_per_wavelength", 8);
    size_t named = levels != NULL ? (size_t)cJSON_GetArraySize(levels) : 0;
    out->mesh = levels == NULL && json_at(document, "/surface/points_per_wavelength") == NULL;
    if (named > 1)
        fault_add(faults, "/contact/levels",
                  "a target answers on one mesh, and sees coarser ones by itself: give one level");
    if (named > 0)
        points = cJSON_GetArrayItem(levels, (int)named - 1)->valuedouble;
    if (out->mesh) {
        size_t count = LADDER_LEAST;
        if (out->profile)
            count += steps_of(out->target.error) + is_translated(parameters);
        out->levels = count < LADDER_MOST ? count : LADDER_MOST;
        for (size_t l = 0; l < out->levels; l++)
            out->ladder[l] = ldexp(COARSEST, (int)l);
        return;
    }
    for (int halvings = 2; halvings >= 0; halvings--)
        if (halvings == 0 || ldexp(points, -halvings) >= COARSEST)
            out->ladder[out->levels++] = ldexp(points, -halvings);
}

/* Returns the power of two nearest to the length at which heights (HEIGHTS_CELL) take most of the
 * error at light loads; 0 if heights do not matter. */
static double length_of_heights(const struct choices *choices, const cJSON *parameters) {
    double ratio = json_number_at(parameters, "/surface/wavelength_ratio", (double)NAN);
    if (!choices->profile || !choices->own_grid || isnan(ratio))
        return 0;
    double error = choices->target.error;
    double share = error < SMALL_ERROR ? HEIGHTS_SMALL : HEIGHTS_MOST;
    double waves = HEIGHTS_CELL / (share * error * sqrt(LIGHT_AREA));
    return exp2(round(log2(waves / ratio)));
}

/* Reads or chooses the lengths. Chosen cells begin with a length that often suffices; cells four
 * times as long follow if the change between them requires it. Values that are added change less
 * with the length, and cost more: shorter cells suffice for them. */
static void read_length(struct choices *out, const cJSON *document, const cJSON *parameters,
                        struct fault_list *faults) {
    static const char path[] = "/surface/length_ratio_y";
    size_t steps = steps_of(out->target.error);
    double usual = ldexp(out->profile ? 32 : 8, (int)(out->profile ? steps : steps / 2));
    double short_cell = ldexp(4, 2 * (int)steps); /* its error falls as 1/L: F15.7 */
    double named = json_number_at(parameters, "/surface/length_ratio", 8);
    double along_y = json_number_at(parameters, path, named);
    out->length = json_at(document, "/surface/length_ratio") == NULL;
    if (out->length && json_at(parameters, path) != NULL)
        fault_add(faults, path,
                  "a target chooses the length of square cells alone: give "
                  "length_ratio, too");
    if (along_y != named && !out->profile) {
        out->sides[0] = named;
        out->sides[1] = along_y;
    }
    out->length_ratio = out->length         ? fmax(usual, length_of_heights(out, parameters))
                        : out->sides[0] > 0 ? fmin(named, along_y)
                                            : named;
    out->mesh_length_ratio = out->length_ratio > usual ? out->length_ratio / 4 : out->length_ratio;
    out->fine_length_ratio = fmin(out->length_ratio, out->profile ? fmax(16, short_cell) : 4);
    out->model_length_ratio = fmin(out->length_ratio, out->profile ? fmax(4, short_cell / 2) : 1);
}

/* Reads or chooses the depth of the transition. The deeper columns of elements widen, the smaller
 * their error, and the more they cost. */
static void read_transition(struct choices *out, const cJSON *document, const cJSON *parameters) {
    static const char path[] = "/contact/transition_depth";
    static const double TIMES = 1.25;
    const struct choice *choice = choice_find(CONTACT_MODEL_CHOICES, out->model);
    const struct contact_model *model = choice != NULL ? CONTACT_MODELS[choice->value] : NULL;
    enum measure_field field = out->target.quantity == TARGET_MEAN_GAP ? FIELD_GAP : FIELD_PRESSURE;
    out->transition_depth = json_number_at(parameters, path, 8);
    out->transition = model != NULL && model->mesh_floor != NULL && json_at(document, path) == NULL;
    while (out->transition &&
           model->mesh_floor(out->profile ? 1 : 2, field, out->transition_depth) >
               FLOOR_MOST * out->target.error)
        out->transition_depth *= TIMES;
}

/* Solves for the wavelength ratio or the Hurst exponent of nayak_alpha on the cell of the base. */
static int read_alpha(struct choices *out, const cJSON *parameters, struct fault_list *faults,
                      struct error *err) {
    struct surface_case surface;
    out->wavelength_ratio = out->hurst = NAN;
    if (json_at(parameters, "/surface/nayak_alpha") == NULL)
        return 0;
    cJSON *all = cJSON_Duplicate(parameters, true);
    int status = all == NULL ? ERROR_MEMORY : put_length(all, out, out->length_ratio);
    if (status != 0)
        status = error_memory(err, 0, "the parameters of a surface");
    else
        status = surface_case_read(&surface, all, faults, err);
    if (status == 0) {
        out->wavelength_ratio = surface.wavelength_ratio;
        out->hurst = surface.hurst_solved ? surface.spectrum.hurst : NAN;
        surface_case_clear(&surface);
    }
    cJSON_Delete(all);
    return status;
}

static int read_choices(struct choices *out, const cJSON *document, const cJSON *parameters,
                        struct fault_list *faults, struct error *err) {
    size_t before = faults->count;
    *out = (struct choices){0};
    int status = target_read(&out->target, parameters, CONTACT_TABLES, TARGET_CONTACT_AREA,
                             TARGET_MEAN_GAP, faults, err);
    if (status != 0)
        return status;
    target_refuse(document, CONTACT_TABLES, faults);
    if (json_at(document, "/counter_surface") != NULL)
        fault_add(faults, "/counter_surface",
                  "a target's bounds were measured on one rough face; leave it out");
    if (json_at(document, "/surface/plateau") != NULL)
        fault_add(faults, "/surface/plateau",
                  "a target's bounds were measured on faces without kinks; leave it out");
    const cJSON *heights = json_at(parameters, "/surface/heights/distribution");
    out->own_grid = cJSON_IsString(heights) && strcmp(heights->valuestring, "gaussian") != 0;
    out->height = json_at(document, "/contact/block_height") == NULL;
    out->tolerance = json_at(document, "/contact/tolerance") == NULL;
    const char *stiffness = cJSON_GetStringValue(json_at(document, "/contact/stiffness"));
    out->stiffness = stiffness != NULL && strcmp(stiffness, "measured") == 0;
    out->densities = json_at(document, "/contact/pressure_pdf") != NULL;
    out->model = read_model(parameters, faults);
    out->profile = json_number_at(parameters, "/surface/dimension", 2) == 1;
    out->weighting = out->profile && json_at(document, "/contact/gap_weighting") == NULL;
    read_ladder(out, document, parameters, faults);
    read_length(out, document, parameters, faults);
    if (faults->count > before)
        return 0; /* the rest depends on the model and the length */
    read_transition(out, document, parameters);
    return read_alpha(out, parameters, faults, err);
}

/* --- components --- */

static int add(struct study_case *one, const struct choices *choices,
               const struct variant *variant) {
    struct study_case *component = &one->components[one->component_count];
    *component = (struct study_case){.parameters = variant_parameters(one, choices, variant),
                                     .realisations = variant->realisations,
                                     .role = variant->role,
                                     .share = variant->share};
    one->component_count += component->parameters != NULL;
    return component->parameters != NULL ? 0 : ERROR_MEMORY;
}

/* Infinitely thin layers of an infinitely high block are a half-space. */
static bool is_halfspace(const struct choices *choices) {
    bool layers = strcmp(choices->model, "layered") == 0;
    return strcmp(choices->model, "halfspace") == 0 || (layers && choices->mesh && choices->height);
}

/* Adds the model that is asked for less the cheap one. For profiles it is solved on a coarse mesh,
 * which is cheap; its change to the limit scatters little and needs few surfaces. For surfaces both
 * are one component, as elements of a third level would take the time of all else. A named mesh
 * comes with the next coarser one, to estimate its error. */
static int add_models(struct study_case *one, const struct choices *choices) {
    const size_t levels = choices->levels, pair = levels > 1 ? 2 : 1;
    const bool split = choices->mesh && choices->profile;
    const size_t count = split ? LADDER_LEAST : pair;
    const size_t finest = choices->target.error < SMALL_ERROR ? LADDER_MOST : LADDER_MOST - 1;
    const size_t most = !choices->mesh ? levels : split ? finest : pair;
    const size_t first = (levels < most ? levels : most) - count;
    const double length = choices->model_length_ratio;
    const double mesh_length = fmax(length / 4, fmin(4, length));
    const struct variant mesh = {"model_mesh", MODEL_MESH_FIRST, 0.01, true, first,
                                 count,        mesh_length,      false};
    const struct variant model = {"model", MODEL_FIRST,       0.05,   true,
                                  first,   split ? 1 : count, length, false};
    int status = split ? add(one, choices, &mesh) : 0;
    return status == 0 ? add(one, choices, &model) : status;
}

/* Adds the most expensive component first, so that none of its jobs is left to the end of a
 * round. */
static int add_all(struct study_case *one, const struct choices *choices) {
    const size_t levels = choices->levels, pair = levels > 1 ? 2 : 1;
    const struct variant fine = {
        "fine", FINE_FIRST, 0.01, false, 0, levels, choices->fine_length_ratio, false};
    const struct variant mesh = {
        "mesh", MESH_FIRST, 0.1, false, 0, pair, choices->mesh_length_ratio, false};
    const struct variant cell = {"cell", CELL_FIRST, 0.3, false, 0, 1, choices->length_ratio / 4,
                                 false};
    const struct variant base = {"base", BASE_FIRST, 1, false, 0, 1, choices->length_ratio, true};
    const struct variant longer = {"longer", 0, 1, false, 0, 1, 4 * choices->length_ratio, true};
    const struct variant longest = {"longest", 0, 1, false, 0, 1, 16 * choices->length_ratio, true};
    int status = 0;
    if (!is_halfspace(choices))
        status = add_models(one, choices);
    if (status == 0 && levels > 2)
        status = add(one, choices, &fine);
    if (status == 0 && levels > 1)
        status = add(one, choices, &mesh);
    if (status == 0 && choices->length)
        status = add(one, choices, &cell);
    if (status == 0)
        status = add(one, choices, &base);
    if (status == 0 && choices->length)
        status = add(one, choices, &longer);
    return status == 0 && choices->length && choices->profile ? add(one, choices, &longest)
                                                              : status;
}

/* Takes out chosen parameters, which are not those of the case; a named mesh stays, by its
 * level. */
static int keep_named(cJSON *parameters, const struct choices *choices) {
    if (choices->length)
        take_out(parameters, "surface", "length_ratio");
    if (choices->tolerance)
        take_out(parameters, "contact", "tolerance");
    if (choices->weighting)
        take_out(parameters, "contact", "gap_weighting");
    if (choices->transition)
        take_out(parameters, "contact", "transition_depth");
    if (choices->mesh && !choices->own_grid)
        take_out(parameters, "surface", "points_per_wavelength");
    const double *finest = &choices->ladder[choices->levels - 1];
    return choices->mesh ? 0
                         : put(parameters, "contact", "levels", cJSON_CreateDoubleArray(finest, 1));
}

int contact_target_expand(const cJSON *document, struct study_case *one, struct fault_list *faults,
                          struct error *err) {
    struct choices choices;
    size_t before = faults->count;
    int status = read_choices(&choices, document, one->parameters, faults, err);
    if (status != 0 || faults->count > before)
        return status == ERROR_INPUT && faults->count > before ? 0 : status;
    one->components = array_create(COMPONENTS_MOST, sizeof *one->components);
    if (one->components == NULL || (choices.densities && put_density_loads(one->parameters) != 0) ||
        add_all(one, &choices) != 0 || keep_named(one->parameters, &choices) != 0)
        return error_memory(err, COMPONENTS_MOST * sizeof *one->components, "components");
    return 0;
}
