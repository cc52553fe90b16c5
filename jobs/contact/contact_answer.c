/* The answer of a case that asks for an error: its curves, what it errs by, and what each component
 * lacks. */
#include "jobs/contact/contact_sum.h"
#include "jobs/contact/contact_target.h"
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const ROLE_NAMES[ROLES] = {"base", "cell", "mesh", "model"};

/* Of the error asked for: rounds bring chance to the first share, and from there on to what the
 * bounds of the other sources leave, which few realisations tell badly; where that is less than the
 * second share, the error is out of reach, and sampling ends with the first. */
static const double CHANCE_FIRST = 0.5, CHANCE_LEAST = 0.25;
enum { SHARPENED_MOST = 64 };

/* --- what is reached, and what is missing --- */

/* What the error is made of at the load where it is largest. Loads without a value are left out:
 * their curve says so. */
struct reached {
    double all, chance, mesh, cell, model;
};

static struct reached error_reached(const struct contact_answer *answer,
                                    const struct contact_sum *sum) {
    struct reached most = {0};
    for (size_t k = 0; k < answer->loads; k++) {
        double y = fabs(sum->value[k]);
        double all = (sum->width[k] + contact_sum_bounds(answer, sum, k)) / y;
        if (!isnan(y) && !(all <= most.all))
            most = (struct reached){isnan(all) ? INFINITY : all, sum->width[k] / y,
                                    answer->named_mesh ? 0 : sum->mesh[k] / y, sum->cell[k] / y,
                                    sum->model[k] / y};
    }
    return most;
}

/* Doubles a component whose bound alone takes a quarter of the error asked for at a load where all
 * bounds leave too little: whether levels show their order is seen better by more realisations. */
static bool sharpen(const struct contact_answer *answer, const struct contact_sum *sum,
                    enum role role, uint64_t *wanted) {
    const double *bound = role == ROLE_MESH ? sum->mesh : sum->model;
    const struct target_component *of = answer->of[role];
    if (of == NULL || of->done >= SHARPENED_MOST || component_case(of)->level_count < 3 ||
        (role == ROLE_MESH && answer->named_mesh))
        return false;
    for (size_t k = 0; k < answer->loads; k++) {
        double all = answer->target.error * fabs(sum->value[k]);
        double left = all - contact_sum_bounds(answer, sum, k);
        if (left < CHANCE_LEAST * all && bound[k] > CHANCE_LEAST * all && *wanted < 2 * of->done) {
            *wanted = 2 * of->done;
            return true;
        }
    }
    return false;
}

static int plan(const struct contact_answer *answer, const struct contact_sum *sum,
                uint64_t wanted[ROLES], struct error *err) {
    struct target_part parts[ROLES];
    size_t count = contact_sum_parts(answer, sum, parts), part = 0;
    uint64_t allotted[ROLES];
    double *allowed = array_create(answer->loads, sizeof *allowed);
    if (allowed == NULL)
        return error_memory(err, answer->loads * sizeof *allowed, "a plan");
    for (size_t k = 0; k < answer->loads; k++) {
        double all = answer->target.error * fabs(sum->value[k]);
        double left = all - contact_sum_bounds(answer, sum, k);
        bool first = sum->width[k] > CHANCE_FIRST * all || left < CHANCE_LEAST * all;
        allowed[k] = first ? fmax(left, CHANCE_FIRST * all) : left;
    }
    struct target_plan plan = {&answer->target, answer->loads, allowed};
    target_allot(&plan, count, parts, allotted);
    bool sharpened = false;
    for (size_t a = 0; a < ROLES; a++) {
        if (answer->of[a] == NULL)
            continue;
        if (a == ROLE_MESH || a == ROLE_MODEL)
            sharpened = sharpen(answer, sum, (enum role)a, &allotted[part]) || sharpened;
        part++;
    }
    if (sharpened)
        target_hold(&answer->target, count, parts, allotted);
    part = 0;
    for (size_t a = 0; a < ROLES; a++)
        if (answer->of[a] != NULL)
            wanted[a] = allotted[part++];
    free(allowed);
    return 0;
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
    const struct contact_model *model = one_case->models[one_case->model_count - 1];
    bool area = measure == MEASURE_EDGES;
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
    return result_add_curve(answer->result, &curve, err);
}

/* --- scalars: what was reached, and the checks of the sum --- */

/* The coarsest level has one mean, whether by the component "base" or by "mesh": their difference
 * in standard errors, the largest of the loads, shows whether the sum is one (Giles 2015, section
 * 3.5). */
static double consistency(const struct contact_answer *answer, enum contact_measure measure) {
    double most = NAN;
    for (size_t k = 0; answer->of[ROLE_MESH] != NULL && k < answer->loads; k++) {
        struct estimate a = contact_tally_mean(component_tally(answer->of[ROLE_BASE]), measure, k);
        struct estimate b = contact_tally_mean(component_tally(answer->of[ROLE_MESH]), measure, k);
        most = fmax(most, fabs(a.value - b.value) / hypot(a.standard_error, b.standard_error));
    }
    return most;
}

/* By how much the changes between levels fall from one to the next, in powers of two, at the load
 * where they fall least; NaN with fewer than three levels. */
static double bias_rate(const struct contact_answer *answer, enum contact_measure measure) {
    double least = NAN;
    const struct target_component *mesh = answer->of[ROLE_MESH];
    for (size_t k = 0; mesh != NULL && component_case(mesh)->level_count > 2 && k < answer->loads;
         k++)
        least = fmin(
            least, log2(fabs(contact_tally_level(component_tally(mesh), measure, 0, 1, k).value) /
                        fabs(contact_tally_level(component_tally(mesh), measure, 0, 2, k).value)));
    return least;
}

/* Kurtosis of the differences between the two models on the finest level, the largest of the loads:
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

/* What plain sampling of the model that is asked for would take on the finest mesh where it was
 * solved, for the same error by chance alone. */
static double plain_work(const struct contact_answer *answer, const struct contact_sum *sum,
                         enum contact_measure measure) {
    const struct target_component *from =
        answer->of[ROLE_MODEL] != NULL ? answer->of[ROLE_MODEL] : answer->of[ROLE_BASE];
    const struct contact_case *one_case = component_case(from);
    size_t first =
        contact_case_cell(one_case, one_case->model_count - 1, one_case->level_count - 1, 0);
    double quantile = gsl_cdf_ugaussian_Pinv((1 + answer->target.confidence) / 2);
    double realisations = 0, work = 0;
    for (size_t k = 0; k < answer->loads; k++) {
        double variance = component_variance(
            from, contact_tally_mean(component_tally(from), measure, first + k).standard_error);
        double allowed = answer->target.error * sum->value[k] / quantile;
        realisations = fmax(realisations, variance / (allowed * allowed));
        work += contact_tally_total(component_tally(from), MEASURE_WORK, first + k) /
                (double)from->done * (double)grid_points(&contact_case_finest(one_case)->grid);
    }
    return realisations * work;
}

static double work_done(const struct contact_answer *answer) {
    double sum = 0;
    for (size_t a = 0; a < ROLES; a++)
        if (answer->of[a] != NULL)
            sum += contact_sum_work(answer->of[a]) * (double)answer->of[a]->done;
    return sum;
}

static int put_scalars(const struct contact_answer *answer, const struct contact_sum *sum,
                       enum contact_measure measure, struct error *err) {
    const struct reached reached = error_reached(answer, sum);
    const struct {
        const char *name;
        double value;
    } scalars[] = {{"error_asked", answer->target.error},
                   {"error_reached", reached.all},
                   {"error_chance", reached.chance},
                   {"error_mesh", reached.mesh},
                   {"error_cell", reached.cell},
                   {"error_model", reached.model},
                   {"work", work_done(answer)},
                   {"plain_work", plain_work(answer, sum, measure)},
                   {"consistency", consistency(answer, measure)},
                   {"bias_rate", bias_rate(answer, measure)},
                   {"difference_kurtosis", kurtosis(answer, measure)}};
    int status = 0;
    for (size_t a = 0; a < sizeof scalars / sizeof *scalars && status == 0; a++)
        status = target_add_scalar(answer->result, scalars[a].name, scalars[a].value, err);
    return status;
}

/* --- together --- */

/* Which component is what. */
static int find_components(struct contact_answer *out, size_t count,
                           const struct target_component *components, struct error *err) {
    for (size_t a = 0; a < count; a++) {
        size_t r = 0;
        while (r < ROLES && strcmp(components[a].role, ROLE_NAMES[r]) != 0)
            r++;
        if (r == ROLES)
            return error_set(err, ERROR_INPUT, "a component of the unknown role \"%.40s\"",
                             components[a].role);
        out->of[r] = &components[a];
    }
    if (out->of[ROLE_BASE] == NULL)
        return error_set(err, ERROR_INPUT, "a target without its component \"base\"");
    return 0;
}

static bool has_begun(size_t count, const struct target_component *components) {
    for (size_t a = 0; a < count; a++)
        if (components[a].done == 0)
            return false;
    return count > 0;
}

static int read_target(struct contact_answer *out, const cJSON *parameters, struct error *err) {
    int status = target_read(&out->target, parameters, CONTACT_TABLES, TARGET_CONTACT_AREA,
                             TARGET_MEAN_GAP, NULL, err);
    /* what is chosen was taken out of the parameters, but for the grid of a surface that needs it
     */
    out->named_mesh = json_at(parameters, "/contact/levels") != NULL;
    return status;
}

static int answer_sums(const struct contact_answer *answer, uint64_t wanted[ROLES],
                       struct error *err) {
    static const enum contact_measure MEASURES[] = {MEASURE_EDGES, MEASURE_GAP}; /* as the enum */
    struct contact_sum sums[2];
    int status = 0;
    for (size_t a = 0; a < 2 && status == 0; a++)
        status = contact_sum_create(answer, MEASURES[a], &sums[a], err);
    for (size_t a = 0; a < 2 && status == 0; a++)
        status = put_curve(answer, &sums[a], MEASURES[a], err);
    size_t place = (size_t)answer->target.quantity - TARGET_CONTACT_AREA;
    const struct contact_sum *asked = &sums[place];
    if (status == 0)
        status = plan(answer, asked, wanted, err);
    if (status == 0)
        status = put_scalars(answer, asked, MEASURES[place], err);
    return status;
}

int contact_target_answer(const cJSON *parameters, size_t count,
                          const struct target_component *components, uint64_t *wanted,
                          struct case_result *out, struct error *err) {
    struct contact_answer answer = {.result = out};
    uint64_t allotted[ROLES] = {0};
    for (size_t a = 0; a < count; a++)
        wanted[a] = components[a].done;
    int status = find_components(&answer, count, components, err);
    if (status == 0)
        status = read_target(&answer, parameters, err);
    if (status != 0 || !has_begun(count, components))
        return status;
    answer.one_case = component_case(answer.of[ROLE_MODEL] != NULL ? answer.of[ROLE_MODEL]
                                                                   : answer.of[ROLE_BASE]);
    answer.loads = answer.one_case->load_count;
    status = answer_sums(&answer, allotted, err);
    for (size_t a = 0; a < count && status == 0; a++)
        for (size_t r = 0; r < ROLES; r++)
            if (answer.of[r] == &components[a])
                wanted[a] = allotted[r];
    return status;
}
