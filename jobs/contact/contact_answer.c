/* The answer of a case that asks for an error: its curves, what it errs by, and what each component
 * lacks. */
#include "jobs/contact/contact_plan.h"
#include "jobs/contact/contact_target.h"
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Components on cells of rising length, whose last two that have begun are the base and the cell
 * beside it; and the others. */
static const char *const LENGTHS[CONTACT_LENGTHS_MOST] = {"cell", "base", "longer", "longest"};
enum { LENGTH_COUNT = CONTACT_LENGTHS_MOST, LENGTH_BASE = 1 };
static const char *const ROLE_NAMES[ROLES] = {[ROLE_MESH] = "mesh",
                                              [ROLE_FINE] = "fine",
                                              [ROLE_MODEL] = "model",
                                              [ROLE_MODEL_MESH] = "model_mesh"};

/* --- what is reached --- */

/* What the error is made of at the load where it is largest. Loads without a value are left out:
 * their curve says so. */
struct reached {
    double all, chance, mesh, cell, model, generation;
};

static struct reached error_reached(const struct contact_answer *answer,
                                    const struct contact_sum *sum) {
    struct reached most = {0};
    for (size_t k = 0; k < answer->loads; k++) {
        double y = fabs(sum->value[k]);
        double all = hypot(sum->width[k], contact_sum_bounds(answer, sum, k, true)) / y;
        if (!isnan(y) && !(all <= most.all))
            most = (struct reached){isnan(all) ? INFINITY : all,
                                    sum->width[k] / y,
                                    answer->named_mesh ? 0 : sum->mesh[k] / y,
                                    sum->cell[k] / y,
                                    sum->model[k] / y,
                                    sum->generation[k] / y};
    }
    return most;
}

/* --- curves --- */

static void put_bound(const struct contact_answer *answer, double *bound, struct curve_error *out) {
    double *none = result_numbers(answer->result, answer->loads);
    *out = (struct curve_error){.applies = true, .order = NAN};
    if (none == NULL)
        return; /* not known, then */
    out->value = out->standard_error = none;
    out->bound = bound;
}

static int put_curve(const struct contact_answer *answer, const struct contact_sum *sum,
                     enum contact_measure measure, struct error *err) {
    const struct contact_case *one_case = answer->one_case;
    const struct contact_model *model = answer->model;
    bool area = measure != MEASURE_GAP;
    struct curve curve = curve_named(area ? "contact_area" : "mean_gap", "p/(E* h'_rms)",
                                     area ? "A/A0" : "mean gap/sqrt(m0)");
    double *loads = result_numbers(answer->result, answer->loads);
    if (loads == NULL)
        return error_memory(err, answer->loads * sizeof *loads, "loads");
    memcpy(loads, one_case->loads, answer->loads * sizeof *loads);
    curve.series = area ? "edges" : "";
    curve.model = contact_model_name(model);
    curve.kinematics = model->kinematics != NULL ? model->kinematics(one_case) : NULL;
    if (answer->named_mesh)
        curve.level = contact_case_finest(one_case)->points;
    curve_set_points(&curve, answer->loads, loads, sum->value, sum->standard_error);
    curve.errors[ERROR_DISCRETISATION].applies = curve.errors[ERROR_CELL].applies = true;
    curve.errors[ERROR_MODEL].applies = contact_case_has_scale(one_case);
    put_bound(answer, sum->solver, &curve.errors[ERROR_SOLVER]);
    curve.errors[ERROR_BLOCK].applies =
        isfinite(component_case(answer->of[ROLE_BASE])->blocks[0].height);
    if (answer->of[ROLE_MESH] != NULL)
        put_bound(answer, sum->mesh, &curve.errors[ERROR_DISCRETISATION]);
    if (answer->of[ROLE_CELL] != NULL)
        put_bound(answer, sum->cell, &curve.errors[ERROR_CELL]);
    if (answer->of[ROLE_MODEL] != NULL && !answer->named_mesh)
        put_bound(answer, sum->model, &curve.errors[ERROR_MODEL]);
    curve.errors[ERROR_GENERATION].applies = surface_paths_apply(&one_case->surface);
    if (contact_case_has_paths(component_case(answer->of[ROLE_BASE])))
        put_bound(answer, sum->generation, &curve.errors[ERROR_GENERATION]);
    return result_add_curve(answer->result, &curve, err);
}

/* --- scalars: what was reached, and the checks of the sum --- */

/* The coarsest level has one mean, whether by the component "mesh" or by one on cells of the same
 * length: their difference in standard errors, the largest of the loads, shows whether the sum is
 * one (Giles 2015, section 3.5). NaN without two such components. */
static double consistency(const struct contact_answer *answer, enum contact_measure measure) {
    const struct target_component *mesh = answer->of[ROLE_MESH], *other = NULL;
    double most = NAN;
    for (size_t a = 0; mesh != NULL && a < answer->length_count; a++)
        if (component_case(answer->lengths[a])->surface.length_ratio ==
            component_case(mesh)->surface.length_ratio)
            other = answer->lengths[a];
    for (size_t k = 0; other != NULL && k < answer->loads; k++) {
        struct estimate a = contact_tally_mean(component_tally(other), measure, k);
        struct estimate b = contact_tally_mean(component_tally(mesh), measure, k);
        most = fmax(most, fabs(a.value - b.value) / hypot(a.standard_error, b.standard_error));
    }
    return most;
}

/* By how much the changes between levels fall from one to the next, in powers of two, at the load
 * where they fall least; NaN with fewer than three levels. */
static double bias_rate(const struct contact_answer *answer, enum contact_measure measure) {
    double least = NAN;
    const struct target_component *mesh = answer->of[contact_sum_mesh(answer)];
    for (size_t k = 0; mesh != NULL && component_case(mesh)->level_count > 2 && k < answer->loads;
         k++)
        least = fmin(
            least, log2(fabs(contact_tally_level(component_tally(mesh), measure, 0, 1, k).value) /
                        fabs(contact_tally_level(component_tally(mesh), measure, 0, 2, k).value)));
    return least;
}

/* Kurtosis of the differences between the two models on one level, the largest of the loads:
 * above about 100 the variance that the plan is made by is of too few realisations (Giles 2015,
 * section 3.4). NaN without a component "model". */
static double kurtosis(const struct contact_answer *answer, enum contact_measure measure) {
    const struct target_component *model = answer->of[ROLE_MODEL];
    size_t cheap = 0, asked = 0;
    double most = NAN;
    if (model == NULL || !contact_rows_column(component_case(model), 0, measure, &cheap) ||
        !contact_rows_column(component_case(model), 1, measure, &asked))
        return NAN;
    const struct contact_rows *rows = &component_tally(model)->rows;
    for (size_t k = 0; k < answer->loads; k++) {
        double mean = 0, square = 0, fourth = 0, n = (double)rows->count;
        for (size_t r = 0; r < rows->count; r++)
            mean += (rows->values[r * rows->width + asked + k] -
                     rows->values[r * rows->width + cheap + k]) /
                    n;
        for (size_t r = 0; r < rows->count; r++) {
            double off = rows->values[r * rows->width + asked + k] -
                         rows->values[r * rows->width + cheap + k] - mean;
            square += off * off / n;
            fourth += off * off * off * off / n;
        }
        most = fmax(most, fourth / (square * square));
    }
    return most;
}

/* What plain sampling would take for the same error: of the model that is asked for, on the finest
 * mesh where it was solved, and on the cells of the base. Their own errors, which remain, are those
 * of the cell and of generation alone here: that of the mesh is left out in favour of plain
 * sampling. It takes two realisations at least, since one tells no error. */
static double plain_work(const struct contact_answer *answer, const struct contact_sum *sum,
                         double error) {
    const struct target_component *base = answer->of[ROLE_BASE];
    const struct target_component *model = contact_sum_finest_model(answer);
    const struct target_component *from = model != NULL ? model : base;
    const struct contact_case *one_case = component_case(from);
    size_t first =
        contact_case_cell(one_case, one_case->model_count - 1, one_case->level_count - 1, 0);
    double waves = component_case(base)->surface.length_ratio / one_case->surface.length_ratio;
    double quantile = gsl_cdf_ugaussian_Pinv((1 + answer->target.confidence) / 2);
    double realisations = 2, work = 0;
    for (size_t k = 0; k < answer->loads; k++) {
        double all = error * fabs(sum->value[k]), left = all * all - sum->cell[k] * sum->cell[k] -
                                                         sum->generation[k] * sum->generation[k];
        realisations = fmax(realisations, sum->variance[ROLE_BASE][k] * quantile * quantile / left);
        work += contact_tally_total(component_tally(from), MEASURE_WORK, first + k) /
                (double)from->done * (double)grid_points(&contact_case_finest(one_case)->grid);
    }
    return realisations * work * pow(waves, one_case->surface.dimension);
}

static double work_done(size_t count, const struct target_component *components) {
    double sum = 0;
    for (size_t a = 0; a < count; a++)
        if (components[a].done > 0)
            sum += contact_sum_work(&components[a]) * (double)components[a].done;
    return sum;
}

static int put_scalars(const struct contact_answer *answer, const struct contact_sum *sum,
                       enum contact_measure measure, double work, struct error *err) {
    const struct reached reached = error_reached(answer, sum);
    double error = fmax(answer->target.error, reached.all);
    const struct {
        const char *name;
        double value;
    } scalars[] = {{"error_asked", answer->target.error},
                   {"error_reached", reached.all},
                   {"error_chance", reached.chance},
                   {"error_mesh", reached.mesh},
                   {"error_cell", reached.cell},
                   {"error_model", reached.model},
                   {"error_generation", reached.generation},
                   {"length_ratio", component_case(answer->of[ROLE_BASE])->surface.length_ratio},
                   {"work", work},
                   {"plain_work", plain_work(answer, sum, error)},
                   {"consistency", consistency(answer, measure)},
                   {"bias_rate", bias_rate(answer, measure)},
                   {"difference_kurtosis", kurtosis(answer, measure)}};
    int status = 0;
    for (size_t a = 0; a < sizeof scalars / sizeof *scalars && status == 0; a++)
        status = target_add_scalar(answer->result, scalars[a].name, scalars[a].value, err);
    return status;
}

/* --- together --- */

/* Which component is what. Of the lengths those that have begun are the first, without a gap. */
static int find_components(struct contact_answer *out, size_t count,
                           const struct target_component *components, struct error *err) {
    const struct target_component *lengths[LENGTH_COUNT] = {0};
    for (size_t a = 0; a < count; a++) {
        size_t r = 0, l = 0;
        while (r < ROLES &&
               (ROLE_NAMES[r] == NULL || strcmp(components[a].role, ROLE_NAMES[r]) != 0))
            r++;
        while (l < LENGTH_COUNT && strcmp(components[a].role, LENGTHS[l]) != 0)
            l++;
        if (r < ROLES)
            out->of[r] = &components[a];
        else if (l < LENGTH_COUNT)
            lengths[l] = &components[a];
        else
            return error_set(err, ERROR_INPUT, "a component of the unknown role \"%.40s\"",
                             components[a].role);
    }
    if (lengths[LENGTH_BASE] == NULL)
        return error_set(err, ERROR_INPUT, "a target without its component \"base\"");
    for (size_t l = 0; l < LENGTH_COUNT && out->longer == NULL; l++) {
        if (lengths[l] != NULL && l > LENGTH_BASE && lengths[l]->done == 0)
            out->longer = lengths[l];
        else if (lengths[l] != NULL)
            out->lengths[out->length_count++] = lengths[l];
    }
    out->of[ROLE_BASE] = out->lengths[out->length_count - 1];
    out->of[ROLE_CELL] = out->length_count > 1 ? out->lengths[out->length_count - 2] : NULL;
    return 0;
}

static bool has_begun(const struct contact_answer *answer) {
    for (size_t a = 0; a < ROLES; a++)
        if (answer->of[a] != NULL && answer->of[a]->done == 0)
            return false;
    return true;
}

static int read_target(struct contact_answer *out, const cJSON *parameters, struct error *err) {
    int status = target_read(&out->target, parameters, CONTACT_TABLES, TARGET_CONTACT_AREA,
                             TARGET_MEAN_GAP, NULL, err);
    /* what is chosen was taken out of the parameters, but for the grid of a surface that needs it
     */
    out->named_mesh = json_at(parameters, "/contact/levels") != NULL;
    const cJSON *name = json_at(parameters, "/contact/model");
    if (cJSON_IsArray(name))
        name = name->child;
    const struct choice *model = choice_find(CONTACT_MODEL_CHOICES, cJSON_GetStringValue(name));
    if (status == 0 && model == NULL)
        return error_set(err, ERROR_INPUT, "a target without its model");
    out->model = status == 0 ? CONTACT_MODELS[model->value] : NULL;
    return status;
}

/* Areas by edges: as they are under load where the model that is asked for tells them so. The cheap
 * model knows that to first order, which leaves less to the difference of models. */
static enum contact_measure area_measure(const struct contact_answer *answer) {
    const struct contact_case *one_case = answer->one_case;
    return contact_case_stretches(one_case, one_case->model_count - 1) ? MEASURE_EDGES_STRETCHED
                                                                       : MEASURE_EDGES;
}

static int answer_sums(const struct contact_answer *answer, double work, uint64_t wanted[ROLES + 1],
                       struct error *err) {
    const enum contact_measure measures[] = {area_measure(answer), MEASURE_GAP}; /* as the enum */
    struct contact_sum sums[2];
    int status = 0;
    for (size_t a = 0; a < 2 && status == 0; a++)
        status = contact_sum_create(answer, measures[a], &sums[a], err);
    for (size_t a = 0; a < 2 && status == 0; a++)
        status = put_curve(answer, &sums[a], measures[a], err);
    size_t place = (size_t)answer->target.quantity - TARGET_CONTACT_AREA;
    const struct contact_sum *asked = &sums[place];
    if (status == 0)
        status = contact_plan(answer, asked, wanted, err);
    if (status == 0)
        status = put_scalars(answer, asked, measures[place], work, err);
    return status;
}

int contact_target_answer(const cJSON *parameters, size_t count,
                          const struct target_component *components, uint64_t *wanted,
                          struct case_result *out, struct error *err) {
    struct contact_answer answer = {.result = out};
    uint64_t allotted[ROLES + 1] = {0};
    for (size_t a = 0; a < count; a++)
        wanted[a] = components[a].done;
    int status = find_components(&answer, count, components, err);
    if (status == 0)
        status = read_target(&answer, parameters, err);
    if (status != 0 || !has_begun(&answer))
        return status;
    answer.one_case = component_case(answer.of[ROLE_MODEL] != NULL ? answer.of[ROLE_MODEL]
                                                                   : answer.of[ROLE_BASE]);
    answer.loads = answer.one_case->load_count;
    status = answer_sums(&answer, work_done(count, components), allotted, err);
    size_t part = 0;
    for (size_t r = 0; r < ROLES && status == 0; r++)
        if (answer.of[r] != NULL)
            wanted[answer.of[r] - components] = allotted[part++];
    if (status == 0 && answer.longer != NULL)
        wanted[answer.longer - components] = allotted[part];
    return status;
}
