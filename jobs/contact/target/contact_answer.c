/* The answer of a case that asks for an error: its curves with their errors, and the realisations
 * that each component still needs. */
#include "jobs/contact/contact_measure.h"
#include "jobs/contact/contact_scalars.h"
#include "jobs/contact/target/contact_density.h"
#include "jobs/contact/target/contact_target.h"
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Components on cells of rising length, of which the last two that have begun are the base and the
 * cell that it is compared with. The other components are below. */
static const char *const LENGTHS[CONTACT_LENGTHS_MOST] = {"cell", "base", "longer", "longest"};
enum { LENGTH_COUNT = CONTACT_LENGTHS_MOST, LENGTH_BASE = 1 };
static const char *const ROLE_NAMES[ROLES] = {[ROLE_MESH] = "mesh",
                                              [ROLE_FINE] = "fine",
                                              [ROLE_MODEL] = "model",
                                              [ROLE_MODEL_MESH] = "model_mesh"};

/* --- the realisations that components still need --- */

/* The statistical error is reduced to this part of the error asked for at least, where the bounds
 * leave less and the error is out of reach. */
static const double STATISTICAL_LEAST = 0.5;
enum { DOUBLED_MOST = 64, LEVELS_LEAST = 3 };
/* A longer cell may begin where the bound by the change between lengths takes LENGTH_LEAST of the
 * error, and is LENGTH_SEEN times its own standard error. */
static const double LENGTH_LEAST = 0.3, LENGTH_SEEN = 2.8;
/* It must save so many times the work that it is expected to take, as the solver's steps grow with
 * the length, at most in proportion. */
static const double LONGER_SAVES = 4;
enum { LONGER_FIRST = 8 };
/* More realisations may reduce a bound by so many of its standard errors. */
static const double REDUCED_BY = 2;

/* Returns what bounds leave of an error for the statistical one; 0 where they leave nothing. */
static double left_by(double error, double bounds) {
    return bounds < error ? sqrt(error * error - bounds * bounds) : 0;
}

static double asked_at(const struct contact_answer *answer, const struct contact_sum *sum,
                       size_t load) {
    return answer->target.error * fabs(sum->value[load]);
}

/* The state of a plan. */
struct planning {
    const struct contact_answer *answer;
    const struct contact_sum *sum;
    size_t count;
    struct target_part parts[ROLES + 1]; /* with room for the longer cell */
    double *allowed;                     /* statistical error, by load */
    double *multipliers, *quantiles;
    bool reaches;   /* the present bounds leave enough for the statistical error */
    double lacking; /* work, with these bounds */
};

/* A bound (of: NULL: none) as it may become with more realisations: a multiple of itself, but no
 * less than the bound less some of its standard errors (NULL: not limited by them). */
struct forecast {
    const double *of, *standard_error;
    double times;
};
static const struct forecast UNCHANGED;

static double forecast_at(const struct forecast *forecast, size_t load) {
    double then = forecast->times * forecast->of[load];
    return forecast->standard_error == NULL
               ? then
               : fmax(then, forecast->of[load] - REDUCED_BY * forecast->standard_error[load]);
}

/* Sets the statistical error that is allowed at each load if a bound becomes as forecast: what the
 * bounds leave of the error, at least STATISTICAL_LEAST of it. Returns whether the bounds leave
 * STATISTICAL_LEAST at every load. */
static bool allow(const struct planning *planning, struct forecast forecast) {
    const struct contact_answer *answer = planning->answer;
    bool enough = true;
    for (size_t k = 0; k < answer->loads; k++) {
        double asked = asked_at(answer, planning->sum, k);
        double all = contact_sum_bounds(answer, planning->sum, k);
        double less =
            forecast.of != NULL ? pow(forecast.of[k], 2) - pow(forecast_at(&forecast, k), 2) : 0;
        double left = left_by(asked, sqrt(fmax(0, all * all - less)));
        enough = enough && !(left < STATISTICAL_LEAST * asked);
        planning->allowed[k] = fmax(left, STATISTICAL_LEAST * asked);
    }
    return enough;
}

static struct target_plan plan_of(const struct planning *planning) {
    return (struct target_plan){&planning->answer->target, planning->answer->loads,
                                planning->allowed, planning->multipliers, planning->quantiles};
}

/* Returns the work that is lacking to reach the statistical error that is allowed now. */
static double lacking_of(const struct planning *planning, size_t count,
                         const struct target_part *parts) {
    const struct target_plan plan = plan_of(planning);
    double needed[ROLES];
    return target_least_work(&plan, count, parts, needed);
}

/* Doubles a component by whose levels a bound is estimated, where a bound half as large saves more
 * work than that takes, or brings the error within reach. More realisations make the order of the
 * levels more certain. */
static bool reduce_bound(const struct planning *planning, enum role role,
                         const struct target_part *part, uint64_t *wanted) {
    const struct contact_answer *answer = planning->answer;
    bool of_model = role == ROLE_MODEL || role == ROLE_MODEL_MESH;
    if (part->done >= DOUBLED_MOST ||
        component_case(answer->of[role])->level_count < LEVELS_LEAST ||
        (!of_model && (answer->named_mesh || role != contact_sum_mesh(answer))))
        return false;
    const struct contact_sum *sum = planning->sum;
    struct forecast forecast = {.of = of_model ? sum->model : sum->mesh,
                                .standard_error = of_model ? sum->model_standard_error
                                                           : sum->mesh_standard_error};
    bool saves;
    if (planning->reaches) {
        forecast.times = 0.5;
        (void)allow(planning, forecast);
        double then = lacking_of(planning, planning->count, planning->parts);
        saves = planning->lacking - then > part->work * (double)part->done;
    } else {
        saves = allow(planning, forecast);
    }
    if (saves)
        *wanted = 2 * part->done;
    return saves;
}

/* Returns whether the change between the two longest cells exceeds its statistical error at a load
 * where it takes much of the error. */
static bool is_seen(const struct contact_answer *answer, const struct contact_sum *sum) {
    for (size_t k = 0; k < answer->loads; k++)
        if (sum->length[k] > LENGTH_LEAST * asked_at(answer, sum, k) &&
            sum->length[k] > LENGTH_SEEN * sum->length_standard_error[k])
            return true;
    return false;
}

/* Returns the parts with the longer cell as base. Fewer realisations of it, as many in all longest
 * waves, give the same statistical error. The base becomes the cell that it is compared with, and
 * needs no more. */
static size_t lengthened(const struct planning *planning, struct target_part parts[ROLES]) {
    const struct contact_answer *answer = planning->answer;
    const struct contact_case *own = component_case(answer->of[ROLE_BASE]);
    double times = component_case(answer->longer)->surface.length_ratio / own->surface.length_ratio;
    size_t count = 0;
    for (size_t a = 0, part = 0; a < ROLES; a++) {
        if (answer->of[a] == NULL)
            continue;
        struct target_part one = planning->parts[part++];
        if (a == ROLE_CELL)
            continue;
        if (a == ROLE_BASE) {
            one.done = 0;
            one.work *= answer->longer->seconds / one.seconds / pow(times, own->surface.dimension);
        }
        parts[count++] = one;
    }
    return count;
}

/* Starts longer cells instead of all else, if they bring the error within reach or take less work
 * than more of the same, and there is time. */
static bool lengthen(struct planning *planning, uint64_t *wanted) {
    const struct contact_answer *answer = planning->answer;
    const size_t count = planning->count;
    struct target_part longer[ROLES];
    if (answer->longer == NULL || !is_seen(answer, planning->sum))
        return false;
    (void)allow(planning, (struct forecast){.of = planning->sum->length, .times = 0.25});
    double then = lacking_of(planning, lengthened(planning, longer), longer);
    if (planning->reaches && planning->lacking <= LONGER_SAVES * then)
        return false;
    uint64_t next[ROLES + 1];
    for (size_t a = 0; a < count; a++)
        next[a] = planning->parts[a].done;
    next[count] = LONGER_FIRST;
    planning->parts[count] = (struct target_part){.seconds = answer->longer->seconds};
    target_hold(&answer->target, count + 1, planning->parts, next);
    if (next[count] < LONGER_FIRST)
        return false;
    memcpy(wanted, next, sizeof *next * (count + 1));
    return true;
}

/* Adds the realisations that reduce bounds instead of all else, if there are such. */
static void reduce_bounds(const struct planning *planning, uint64_t *wanted) {
    bool reduces = false;
    uint64_t next[ROLES];
    for (size_t a = 0; a < planning->count; a++)
        next[a] = planning->parts[a].done;
    for (size_t a = 0, part = 0; a < ROLES; a++)
        if (planning->answer->of[a] != NULL) {
            bool bounds = a != ROLE_BASE && a != ROLE_CELL;
            reduces = (bounds &&
                       reduce_bound(planning, (enum role)a, &planning->parts[part], &next[part])) ||
                      reduces;
            part++;
        }
    if (!reduces)
        return;
    memcpy(wanted, next, planning->count * sizeof *next);
    target_hold(&planning->answer->target, planning->count, planning->parts, wanted);
}

/* Plans how many realisations each component is to have in all, by part (contact_sum_parts), and
 * behind these the longer cell, if there is one. Bounds are reduced first, by longer cells and by
 * more realisations of components whose levels show their order. Then the statistical error is
 * reduced to what the bounds leave. sum: of the quantity whose error is asked for. */
static int plan_realisations(const struct contact_answer *answer, const struct contact_sum *sum,
                             uint64_t wanted[ROLES + 1], struct error *err) {
    struct planning planning = {.answer = answer, .sum = sum};
    planning.count = contact_sum_parts(answer, sum, planning.parts);
    planning.allowed = array_create(answer->loads, 3 * sizeof *planning.allowed);
    if (planning.allowed == NULL)
        return error_memory(err, answer->loads * 3 * sizeof *planning.allowed, "a plan");
    planning.multipliers = planning.allowed + answer->loads;
    planning.quantiles = planning.multipliers + answer->loads;
    planning.reaches = allow(&planning, UNCHANGED);
    planning.lacking = lacking_of(&planning, planning.count, planning.parts);
    const struct target_plan plan = plan_of(&planning);
    target_allot(&plan, planning.count, planning.parts, wanted);
    wanted[planning.count] = 0;
    if (!lengthen(&planning, wanted))
        reduce_bounds(&planning, wanted);
    free(planning.allowed);
    return 0;
}

/* --- the error reached --- */

/* The parts of the error at the load where it is largest. Loads without a value are left out, as
 * their curve shows. */
struct reached {
    double all, statistical, mesh, cell, model, solver;
};

static struct reached error_reached(const struct contact_answer *answer,
                                    const struct contact_sum *sum) {
    struct reached most = {0};
    for (size_t k = 0; k < answer->loads; k++) {
        double y = fabs(sum->value[k]);
        double all = hypot(sum->width[k], contact_sum_bounds(answer, sum, k)) / y;
        if (!isnan(y) && !(all <= most.all))
            most = (struct reached){isnan(all) ? INFINITY : all,
                                    sum->width[k] / y,
                                    answer->named_mesh ? 0 : sum->mesh[k] / y,
                                    sum->cell[k] / y,
                                    sum->model[k] / y,
                                    sum->solver[k] / y};
    }
    return most;
}

/* --- curves --- */

/* Returns whether a source bears on the answer. */
static bool applies(const struct contact_answer *answer, enum error_source source) {
    switch (source) {
    case ERROR_DISCRETISATION:
    case ERROR_CELL:
    case ERROR_SOLVER:
        return true;
    case ERROR_BLOCK:
        return isfinite(component_case(answer->of[ROLE_BASE])->blocks[0].height);
    case ERROR_MODEL:
        return contact_case_has_scale(answer->one_case);
    case ERROR_PATCH: /* which components do not estimate */
        return answer->patch;
    default:
        return false;
    }
}

/* Returns the bounds of a source by load; NULL: not known. */
static double *bounds_of(const struct contact_answer *answer, const struct contact_sum *sum,
                         enum error_source source) {
    switch (source) {
    case ERROR_DISCRETISATION:
        return answer->of[ROLE_MESH] != NULL ? sum->mesh : NULL;
    case ERROR_CELL:
        return answer->of[ROLE_CELL] != NULL ? sum->cell : NULL;
    case ERROR_SOLVER:
        return sum->solver;
    case ERROR_MODEL:
        return answer->of[ROLE_MODEL] != NULL && !answer->named_mesh ? sum->model : NULL;
    default:
        return NULL;
    }
}

static void put_bounds(const struct contact_answer *answer, const struct contact_sum *sum,
                       struct curve_error errors[ERROR_SOURCES]) {
    for (enum error_source s = 0; s < ERROR_SOURCES; s++) {
        double *bound = bounds_of(answer, sum, s);
        double *none = bound != NULL ? result_numbers(answer->result, sum->points) : NULL;
        errors[s].applies = applies(answer, s) || bound != NULL;
        if (none != NULL) /* else the error is not known */
            errors[s] = (struct curve_error){.applies = true,
                                             .value = none,
                                             .bound = bound,
                                             .standard_error = none,
                                             .order = NAN};
    }
}

/* Gives a curve the law difference, if it is known at any point. */
static void put_law(const struct contact_sum *sum, struct curve *curve) {
    bool any = false;
    for (size_t k = 0; k < sum->points; k++)
        any = any || isfinite(sum->law[k]);
    curve->law_difference = any ? sum->law : NULL;
    curve->law_standard_error = any ? sum->law_standard_error : NULL;
}

/* Makes a curve of the model that is asked for. */
static struct curve curve_of(const struct contact_answer *answer, const char *quantity,
                             const char *x_label, const char *y_label) {
    const struct contact_model *model = answer->model;
    struct curve curve = curve_named(quantity, x_label, y_label);
    curve.model = contact_model_name(model);
    curve.kinematics = model->kinematics != NULL ? model->kinematics(answer->one_case) : NULL;
    if (answer->named_mesh)
        curve.level = contact_case_finest(answer->one_case)->points;
    return curve;
}

/* Adds the curve of a measure of the model that is asked for. */
static int put_curve(const struct contact_answer *answer, const struct contact_sum *sum,
                     const struct measure *measure, struct error *err) {
    const struct contact_case *one_case = answer->one_case;
    const char *label =
        measure_label(measure, UNIT_WAVE, one_case->surface.dimension, answer->result);
    double *loads = result_numbers(answer->result, answer->loads);
    if (loads == NULL || label == NULL)
        return error_memory(err, answer->loads * sizeof *loads, "loads");
    struct curve curve = curve_of(answer, measure->quantity, "p/(E* h'_rms)", label);
    memcpy(loads, one_case->loads, answer->loads * sizeof *loads);
    curve.series = measure->cell == CELL_SAME ? measure->series : "wave";
    curve_set_points(&curve, answer->loads, loads, sum->value, sum->standard_error);
    curve.effective = sum->effective;
    put_bounds(answer, sum, curve.errors);
    put_law(sum, &curve);
    return result_add_curve(answer->result, &curve, err);
}

/* Adds the densities of pressure at the loads that the study chooses. area: the sum by edges. */
static int put_densities(const struct contact_answer *answer, const struct contact_sum *area,
                         struct error *err) {
    const struct contact_case *one_case = answer->one_case;
    int status = 0;
    for (size_t at = 0; at < one_case->pdf_count && status == 0; at++) {
        struct contact_density density;
        status = contact_density_create(answer, area, at, &density, err);
        if (status != 0)
            return status;
        struct curve curve =
            curve_of(answer, "contact_pressure_pdf", "local p/(E* h'_rms)", "probability density");
        curve.pressure = one_case->loads[one_case->pdf_loads[at]];
        curve.counted = true;
        curve.underflow = density.below;
        curve.overflow = density.above;
        curve_set_points(&curve, density.sum.points, density.x, density.sum.value,
                         density.sum.standard_error);
        curve.effective = density.sum.effective;
        put_bounds(answer, &density.sum, curve.errors);
        put_law(&density.sum, &curve);
        status = result_add_curve(answer->result, &curve, err);
    }
    return status;
}

/* --- scalars: the error reached, and the checks of the sum --- */

/* Returns the difference of two means of the coarsest level in standard errors, the largest of the
 * loads. One is of the component "mesh", the other of a component on cells of the same length; if
 * they disagree the sum is not valid (Giles 2015, section 3.5). NaN without two such components. */
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

/* Returns by which power of two the changes between levels decrease from one to the next, at the
 * load where they decrease least; NaN with fewer than three levels. */
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

/* Returns the kurtosis of the differences between the two models on one level, the largest of the
 * loads. Above about 100 the variance that the plan uses is of too few realisations (Giles 2015,
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

/* Returns the work of plain sampling for the same error: with the model that is asked for, on the
 * finest mesh where it was solved, and on the cells of the base. The error of the cell remains;
 * that of the mesh is left out in favour of plain sampling. At least two realisations are counted,
 * since one has no standard error. */
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
        double all = error * fabs(sum->value[k]), left = all * all - sum->cell[k] * sum->cell[k];
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
                   {"error_chance", reached.statistical},
                   {"error_mesh", reached.mesh},
                   {"error_cell", reached.cell},
                   {"error_model", reached.model},
                   {"error_solver", reached.solver},
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

/* Adds a fit at the heaviest load whose area, by edges, is within its range. */
static int put_fit(const struct contact_answer *answer, const struct contact_sum *area,
                   const struct contact_fit *fit, struct error *err) {
    struct contact_sum sum, exponent;
    double b = NAN; /* of a power law */
    size_t n = 0;
    while (n < answer->loads && area->value[n] <= fit->area_most)
        n++;
    if (n == 0)
        return contact_scalars_put_range(fit, NULL, answer->one_case, 0, NULL, NAN, NAN,
                                         answer->result, err);
    int status = contact_sum_create(answer, fit->measure, &sum, err);
    if (status == 0 && fit->measure == MEASURE_POWER_LAW_A) {
        status = contact_sum_create(answer, MEASURE_POWER_LAW_B, &exponent, err);
        b = status == 0 ? exponent.value[n - 1] : b;
    }
    if (status == 0)
        status = contact_scalars_put_range(fit, NULL, answer->one_case, n, area->value,
                                           sum.value[n - 1], b, answer->result, err);
    if (status != 0)
        return status;
    struct scalar scalar =
        scalar_named(fit->name, sum.value[n - 1], sum.standard_error[n - 1], NAN);
    scalar.effective = fmax(0, sum.effective[n - 1]);
    scalar.law_difference = sum.law[n - 1];
    scalar.law_standard_error = sum.law_standard_error[n - 1];
    for (enum error_source s = 0; s < ERROR_SOURCES; s++) {
        const double *bounds = bounds_of(answer, &sum, s);
        scalar.errors[s] = (struct scalar_error){.applies = applies(answer, s) || bounds != NULL,
                                                 .known = bounds != NULL && !isnan(bounds[n - 1]),
                                                 .bound = bounds != NULL ? bounds[n - 1] : 0};
    }
    return result_add_scalar(answer->result, &scalar, err);
}

/* --- together --- */

/* Finds the role of each component. Of the lengths the first ones have begun, without a gap. */
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
    /* a chosen mesh was taken out of the parameters, unless the surface depends on the grid */
    out->named_mesh = json_at(parameters, "/contact/levels") != NULL;
    out->densities = json_at(parameters, "/contact/pressure_pdf/at") != NULL;
    const char *uncertainty =
        cJSON_GetStringValue(json_at(parameters, "/surface/like/uncertainty"));
    out->patch = uncertainty != NULL && strcmp(uncertainty, "none") != 0;
    const cJSON *name = json_at(parameters, "/contact/model");
    if (cJSON_IsArray(name))
        name = name->child;
    const struct choice *model = choice_find(CONTACT_MODEL_CHOICES, cJSON_GetStringValue(name));
    if (status == 0 && model == NULL)
        return error_set(err, ERROR_INPUT, "a target without its model");
    out->model = status == 0 ? CONTACT_MODELS[model->value] : NULL;
    return status;
}

/* Returns the measure of the area by edges: as it is under load, if the model that is asked for
 * reports it so. The cheap model has that to first order, so that the difference of models is
 * smaller. */
static enum contact_measure area_measure(const struct contact_answer *answer) {
    const struct contact_case *one_case = answer->one_case;
    return contact_case_stretches(one_case, one_case->model_count - 1) ? MEASURE_EDGES_STRETCHED
                                                                       : MEASURE_EDGES;
}

/* Returns whether the answer has a curve of a measure: one that the model shows, and that has a
 * limit in large cells. */
static bool is_answered(const struct contact_answer *answer, enum contact_measure measure) {
    const struct contact_case *one_case = answer->one_case;
    const struct measure *of = measure_row(measure);
    return measure < MEASURE_PAIRED && of->quantity != NULL && of->cell != CELL_UNLIMITED &&
           of->shown(one_case, one_case->model_count - 1);
}

/* Returns the measure that the components sum for a curve. */
static enum contact_measure summed(const struct contact_answer *answer,
                                   enum contact_measure measure) {
    return measure == MEASURE_EDGES ? area_measure(answer) : measure;
}

/* Sums a measure over the components. The mean patch is the area by nodes over the number of
 * patches: near percolation the mean of the cells' means grows with the cell, and faster than
 * shorter cells show. Both agree in large cells. */
static int sum_measure(const struct contact_answer *answer, enum contact_measure measure,
                       struct contact_sum *out, struct error *err) {
    struct contact_sum nodes, patches;
    if (measure != MEASURE_PATCH_MEAN)
        return contact_sum_create(answer, summed(answer, measure), out, err);
    int status = contact_sum_create(answer, MEASURE_NODES, &nodes, err);
    if (status == 0)
        status = contact_sum_create(answer, MEASURE_PATCHES, &patches, err);
    return status != 0 ? status : contact_sum_quotient(answer, &nodes, &patches, out, err);
}

static int answer_sums(const struct contact_answer *answer, double work, uint64_t wanted[ROLES + 1],
                       struct error *err) {
    const enum contact_measure asked =
        answer->target.quantity == TARGET_MEAN_GAP ? MEASURE_GAP : MEASURE_EDGES;
    struct contact_sum sums[MEASURE_PAIRED];
    int status = 0;
    for (size_t a = 0; a < MEASURE_OWN && status == 0; a++) {
        enum contact_measure measure = MEASURE_CURVES[a];
        if (!is_answered(answer, measure))
            continue;
        status = sum_measure(answer, measure, &sums[measure], err);
        if (status == 0)
            status = put_curve(answer, &sums[measure], measure_row(measure), err);
    }
    if (status == 0 && answer->densities)
        status = put_densities(answer, &sums[MEASURE_EDGES], err);
    if (status == 0)
        status = plan_realisations(answer, &sums[asked], wanted, err);
    if (status == 0)
        status = put_scalars(answer, &sums[asked], summed(answer, asked), work, err);
    for (size_t a = 0; a < CONTACT_FIT_COUNT && status == 0; a++)
        status = put_fit(answer, &sums[MEASURE_EDGES], &CONTACT_FITS[a], err);
    return status;
}

int contact_target_answer(const cJSON *parameters, size_t count,
                          const struct target_component *components, uint64_t *wanted,
                          struct case_result *out, struct error *err) {
    struct contact_answer answer = {.result = out};
    uint64_t planned[ROLES + 1] = {0};
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
    status = answer_sums(&answer, work_done(count, components), planned, err);
    size_t part = 0;
    for (size_t r = 0; r < ROLES && status == 0; r++)
        if (answer.of[r] != NULL)
            wanted[answer.of[r] - components] = planned[part++];
    if (status == 0 && answer.longer != NULL)
        wanted[answer.longer - components] = planned[part];
    return status;
}
