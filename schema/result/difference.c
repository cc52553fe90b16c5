#include "schema/result/difference.h"
#include "schema/result/total.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* The bound of the mesh error of a difference of two cases. */

/* Texts of the parameters in which the two cases of a difference differ. */

/* The finest curve of a case, and the next coarser one of its series and model; NULL: none. */
struct mesh_curves {
    const struct curve *fine, *coarse;
};

static struct mesh_curves mesh_curves_of(const struct case_result *result,
                                         const struct curve *finest) {
    struct mesh_curves out = {finest, NULL};
    for (size_t n = 0; n < result->curve_count; n++) {
        const struct curve *curve = &result->curves[n];
        if (curve_same_series(curve, finest) && same_text(curve->model, finest->model) &&
            same_text(curve->kinematics, finest->kinematics) && curve->level < finest->level &&
            curve->n == finest->n && (out.coarse == NULL || curve->level > out.coarse->level))
            out.coarse = curve;
    }
    return out;
}

static bool lacks_values(const struct curve *curve) {
    for (size_t k = 0; k < curve->n && curve->valueless != NULL; k++)
        if (curve->valueless[k] > 0)
            return true;
    return false;
}

static bool is_comparable(const struct mesh_curves *a, const struct mesh_curves *b) {
    return a->coarse != NULL && b->coarse != NULL && same_number(a->fine->level, b->fine->level) &&
           same_number(a->coarse->level, b->coarse->level) && !lacks_values(a->fine) &&
           !lacks_values(a->coarse) && !lacks_values(b->fine) && !lacks_values(b->coarse);
}

static double change_at(const struct mesh_curves *curves, size_t at) {
    return curves->fine->y[at] - curves->coarse->y[at];
}

/* Returns whether the mesh error at a point is a bound alone. */
static bool is_bounded(const struct mesh_curves *curves, size_t at) {
    const struct curve_error *error = &curves->fine->errors[ERROR_DISCRETISATION];
    return error->value != NULL && error->bound != NULL && error->value[at] == 0 &&
           error->bound[at] > 0;
}

/* Where both cases bound the error of their mesh by a multiple of the change between levels, the
 * same multiple of the change of the difference bounds the error of the difference. This is smaller
 * where levels change alike in both cases. As a change may vanish by accident, the largest one of
 * neighbouring points counts.
 *
 * Lowers bound[n] at the points a[n] and b[n] of the curves. Leaves it where the levels of the
 * cases differ, some realisation lacks a value, or a case knows more than a bound. */
static void difference_mesh_bounds(const struct mesh_curves *minuend,
                                   const struct mesh_curves *subtrahend, size_t n, const size_t *a,
                                   const size_t *b, double *bound) {
    for (size_t k = 0; k < n && is_comparable(minuend, subtrahend); k++) {
        double changes = fabs(change_at(minuend, a[k])) + fabs(change_at(subtrahend, b[k])),
               largest = 0;
        if (!is_bounded(minuend, a[k]) || !is_bounded(subtrahend, b[k]) || !(changes > 0))
            continue;
        for (size_t near = k > 0 ? k - 1 : 0; near < n && near <= k + 1; near++)
            largest =
                fmax(largest, fabs(change_at(minuend, a[near]) - change_at(subtrahend, b[near])));
        bound[k] = fmin(bound[k], bound[k] / changes * largest);
    }
}

/* Returns "A less B", or the text that both share, in the result's arena; NULL without memory, or
 * where both are NULL. */
static const char *difference_text(struct case_result *out, const char *a, const char *b) {
    char text[160];
    if (same_text(a, b))
        return result_text(out, a);
    snprintf(text, sizeof text, "%.64s less %.64s", a != NULL ? a : "-", b != NULL ? b : "-");
    return result_text(out, text);
}

static void value_text(const struct result_parameter *value, char text[64]) {
    if (value == NULL)
        snprintf(text, 64, "-");
    else if (value->text != NULL)
        snprintf(text, 64, "%.63s", value->text);
    else
        snprintf(text, 64, "%.10g", value->number);
}

/* Fills the parameters of the result: those of the first case, as "0.8 less 0.2" where the second
 * one has another value, and "0.8 less -" where it has none. */
static int difference_parameters(const struct case_result *a, const struct case_result *b,
                                 struct case_result *out, struct error *err) {
    out->parameters = result_room(out, a->parameter_count + 1, sizeof *out->parameters);
    if (out->parameters == NULL)
        return error_set(err, ERROR_MEMORY, "no memory left for parameters");
    for (size_t p = 0; p < a->parameter_count; p++) {
        const struct result_parameter *one = &a->parameters[p];
        const struct result_parameter *other = result_parameter(b, one->pointer);
        struct result_parameter *to = &out->parameters[out->parameter_count++];
        char first[64], second[64];
        bool same = other != NULL && same_text(one->text, other->text) &&
                    same_number(one->number, other->number);
        value_text(one, first);
        value_text(other, second);
        *to = (struct result_parameter){.pointer = result_text(out, one->pointer),
                                        .number = same ? one->number : (double)NAN,
                                        .list = same && one->list,
                                        .flag = same && one->flag};
        if (!same || one->text != NULL)
            to->text = same ? result_text(out, one->text) : difference_text(out, first, second);
        if (to->pointer == NULL || (to->text == NULL && isnan(to->number)))
            return error_set(err, ERROR_MEMORY, "no memory left for parameters");
    }
    return 0;
}

/* Two points are the same where their x differ by less than this part of x. */
static const double SAME_X = 1e-9;
enum { REMARK_SIZE = 1024 };

/* What a difference is made from and into. */
struct maker {
    const struct case_result *minuend, *subtrahend;
    const struct difference_pairs *pairs; /* or NULL */
    struct case_result *out;
    char remark[REMARK_SIZE];
};
/* Two curves, and the points that both have. */
struct curve_pair {
    const struct curve *minuend, *subtrahend;
    size_t n;      /* points in both */
    size_t *a, *b; /* their indices in either */
};

static int no_room(struct error *err) {
    return error_set(err, ERROR_MEMORY, "no memory left for a difference");
}

/* Adds a sentence that is not there yet, where there is room for it. */
__attribute__((format(printf, 2, 3))) static void remark(struct maker *maker, const char *format,
                                                         ...) {
    char text[256];
    size_t used = strlen(maker->remark);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (strstr(maker->remark, text) == NULL && used + strlen(text) + 3 < REMARK_SIZE)
        snprintf(maker->remark + used, REMARK_SIZE - used, "%s%s", used > 0 ? "; " : "", text);
}

/* --- what is compared with what --- */

static bool same_model(const struct curve *a, const struct curve *b) {
    return same_text(a->model, b->model) && same_text(a->kinematics, b->kinematics);
}

static bool is_finest(const struct case_result *result, const struct curve *curve) {
    for (size_t n = 0; n < result->curve_count; n++) {
        const struct curve *other = &result->curves[n];
        if (curve_same_series(other, curve) && same_model(other, curve) &&
            other->level > curve->level)
            return false;
    }
    return true;
}

static bool has_one_model(const struct case_result *result, const struct curve *like) {
    const struct curve *first = NULL;
    for (size_t n = 0; n < result->curve_count; n++) {
        const struct curve *curve = &result->curves[n];
        if (!curve_same_series(curve, like))
            continue;
        if (first != NULL && !same_model(first, curve))
            return false;
        first = curve;
    }
    return first != NULL;
}

/* Returns the curve of the subtrahend that goes with one of the minuend, or NULL. */
static const struct curve *partner_of(const struct maker *maker, const struct curve *curve) {
    bool any = has_one_model(maker->minuend, curve) && has_one_model(maker->subtrahend, curve);
    for (size_t n = 0; n < maker->subtrahend->curve_count; n++) {
        const struct curve *other = &maker->subtrahend->curves[n];
        if (curve_same_series(other, curve) && (any || same_model(other, curve)) &&
            is_finest(maker->subtrahend, other))
            return other;
    }
    return NULL;
}

static bool same_x(double a, double b) {
    return fabs(a - b) <= SAME_X * fmax(fabs(a), fabs(b));
}

/* Finds the points that both curves have; x rises in both. */
static int find_points(struct maker *maker, struct curve_pair *pair, struct error *err) {
    const struct curve *one = pair->minuend, *other = pair->subtrahend;
    size_t most = one->n < other->n ? one->n : other->n;
    pair->a = result_room(maker->out, 2 * most + 1, sizeof *pair->a);
    if (pair->a == NULL)
        return no_room(err);
    pair->b = pair->a + most;
    for (size_t a = 0, b = 0; a < one->n && b < other->n;) {
        if (same_x(one->x[a], other->x[b])) {
            pair->a[pair->n] = a++;
            pair->b[pair->n++] = b++;
        } else if (one->x[a] < other->x[b]) {
            a++;
        } else {
            b++;
        }
    }
    return 0;
}

/* --- errors by source --- */

static double at_or_zero(const double *numbers, size_t at) {
    return numbers != NULL ? numbers[at] : 0;
}

/* Combines the errors of a source. A source that does not bear on a case adds nothing to the
 * difference. */
static int combine_error(struct maker *maker, const struct curve_pair *pair,
                         enum error_source source, struct curve *out, struct error *err) {
    const struct curve_error *a = &pair->minuend->errors[source];
    const struct curve_error *b = &pair->subtrahend->errors[source];
    struct curve_error *to = &out->errors[source];
    size_t n = pair->n;
    to->applies = a->applies || b->applies;
    if (!to->applies || (a->applies && a->value == NULL) || (b->applies && b->value == NULL))
        return 0;
    double *value = result_numbers(maker->out, 3 * n);
    if (value == NULL)
        return no_room(err);
    double *bound = value + n, *standard_error = bound + n;
    for (size_t k = 0; k < n; k++) {
        size_t i = pair->a[k], j = pair->b[k];
        value[k] = at_or_zero(a->value, i) - at_or_zero(b->value, j);
        bound[k] = at_or_zero(a->bound, i) + at_or_zero(b->bound, j);
        standard_error[k] =
            hypot(at_or_zero(a->standard_error, i), at_or_zero(b->standard_error, j));
    }
    if (source == ERROR_DISCRETISATION && maker->pairs != NULL) {
        struct mesh_curves one = mesh_curves_of(maker->minuend, pair->minuend);
        struct mesh_curves other = mesh_curves_of(maker->subtrahend, pair->subtrahend);
        difference_mesh_bounds(&one, &other, n, pair->a, pair->b, bound);
    }
    to->value = value;
    to->bound = bound;
    to->standard_error = standard_error;
    return 0;
}

/* --- curves --- */

/* Returns the effective realisations of a difference of independent means; 0: not known. */
static double effective_of(double a, double sampled_a, double b, double sampled_b) {
    const double variances[] = {a * a, b * b}, realisations[] = {sampled_a, sampled_b};
    double freedom = total_freedom(2, variances, realisations);
    return sampled_a > 0 && sampled_b > 0 && freedom > 0 ? freedom + 1 : 0;
}

/* The mean over pairs less that over all realisations, of which some lack a value: its bound, and
 * how many lack one, by point. */
struct missing {
    double *bound, *lacking;
    bool any;
};

static void put_pair(const struct paired_value *value, size_t k, double *y, double *standard_error,
                     double *effective, struct missing *missing) {
    double all = (double)(value->pairs + value->lacking);
    y[k] = value->value;
    standard_error[k] = value->standard_error;
    effective[k] = value->effective;
    missing->lacking[k] = (double)value->lacking;
    missing->bound[k] = value->lacking > 0
                            ? (double)value->lacking / all * MISSING_DEVIATIONS * value->deviation
                            : 0;
    missing->any = missing->any || value->lacking > 0;
}

/* Takes the values from pairs of realisations where these give every point, else from the
 * curves. */
static bool fill_values(const struct maker *maker, const struct curve_pair *pair, double *y,
                        double *standard_error, double *effective, struct missing *missing) {
    const struct curve *a = pair->minuend, *b = pair->subtrahend;
    struct paired_value value;
    bool paired = maker->pairs != NULL;
    for (size_t k = 0; k < pair->n && paired; k++) {
        paired = maker->pairs->point(maker->pairs->context, a, pair->a[k], b, pair->b[k], &value);
        if (paired)
            put_pair(&value, k, y, standard_error, effective, missing);
    }
    for (size_t k = 0; k < pair->n && !paired; k++) {
        size_t i = pair->a[k], j = pair->b[k];
        y[k] = a->y[i] - b->y[j];
        standard_error[k] = hypot(a->standard_error[i], b->standard_error[j]);
        effective[k] = effective_of(a->standard_error[i], curve_sampled_at(a, i),
                                    b->standard_error[j], curve_sampled_at(b, j));
    }
    return paired;
}

static int set_values(struct maker *maker, const struct curve_pair *pair, struct curve *out,
                      struct error *err) {
    size_t n = pair->n;
    double *x = result_numbers(maker->out, 9 * n);
    if (x == NULL)
        return no_room(err);
    double *y = x + n, *standard_error = y + n, *minuend = standard_error + n;
    double *subtrahend = minuend + n, *zero = subtrahend + n;
    double *effective = zero + 3 * n;
    struct missing missing = {.bound = zero + n, .lacking = zero + 2 * n};
    for (size_t k = 0; k < n; k++) {
        x[k] = pair->minuend->x[pair->a[k]];
        minuend[k] = pair->minuend->y[pair->a[k]];
        subtrahend[k] = pair->subtrahend->y[pair->b[k]];
    }
    out->paired = fill_values(maker, pair, y, standard_error, effective, &missing);
    for (size_t k = 0; k < n; k++)
        if (effective[k] > 0)
            out->effective = effective;
    out->minuend = minuend;
    out->subtrahend = subtrahend;
    curve_set_points(out, n, x, y, standard_error);
    if (!out->paired)
        return combine_error(maker, pair, ERROR_MISSING, out, err);
    struct curve_error *error = &out->errors[ERROR_MISSING];
    error->applies = missing.any;
    if (missing.any) {
        error->value = zero;
        error->bound = missing.bound;
        error->standard_error = zero;
        out->valueless = missing.lacking;
    }
    return 0;
}

static int set_theories(struct maker *maker, const struct curve_pair *pair, struct curve *out,
                        struct error *err) {
    const struct curve *a = pair->minuend, *b = pair->subtrahend;
    for (size_t t = 0; t < a->theory_count; t++)
        for (size_t u = 0; u < b->theory_count; u++) {
            const double *one = a->theories[t].y, *other = b->theories[u].y;
            if (one == NULL || other == NULL ||
                strcmp(a->theories[t].name, b->theories[u].name) != 0)
                continue;
            double *y = result_numbers(maker->out, pair->n);
            const char *name = result_text(maker->out, a->theories[t].name);
            if (y == NULL || name == NULL)
                return no_room(err);
            for (size_t k = 0; k < pair->n; k++)
                y[k] = one[pair->a[k]] - other[pair->b[k]];
            out->theories[out->theory_count++] = (struct theory){name, y};
            break;
        }
    return 0;
}

/* Sets the unit that both have with the same scale; without memory none. */
static struct physical_unit common_unit(struct case_result *out, const struct physical_unit *a,
                                        const struct physical_unit *b) {
    struct physical_unit unit = {result_text(out, a->unit), result_text(out, a->symbol), a->scale};
    bool same = same_text(a->unit, b->unit) && same_x(a->scale, b->scale);
    return same && unit.symbol != NULL ? unit : (struct physical_unit){0};
}

static int set_names(struct maker *maker, const struct curve_pair *pair, struct curve *out,
                     struct error *err) {
    const struct curve *a = pair->minuend, *b = pair->subtrahend;
    out->quantity = result_text(maker->out, a->quantity);
    out->x_label = result_text(maker->out, a->x_label);
    out->y_label = result_text(maker->out, a->y_label);
    out->series = result_text(maker->out, a->series);
    out->model = difference_text(maker->out, a->model, b->model);
    out->kinematics = difference_text(maker->out, a->kinematics, b->kinematics);
    out->pressure = a->pressure;
    out->level = same_number(a->level, b->level) ? a->level : (double)NAN;
    out->points = same_number(a->points, b->points) ? a->points : (double)NAN;
    out->x_unit = common_unit(maker->out, &a->x_unit, &b->x_unit);
    out->y_unit = common_unit(maker->out, &a->y_unit, &b->y_unit);
    bool done = out->quantity != NULL && out->x_label != NULL && out->y_label != NULL &&
                out->series != NULL &&
                (out->model != NULL || (a->model == NULL && b->model == NULL)) &&
                (out->kinematics != NULL || (a->kinematics == NULL && b->kinematics == NULL));
    return done ? 0 : no_room(err);
}

static void remark_alone(struct maker *maker, const struct curve *curve, const char *which) {
    remark(maker, "%s%s%s is of the %s case alone", curve->quantity,
           curve->model != NULL ? " by " : "", curve->model != NULL ? curve->model : "", which);
}

/* Names the curves of the subtrahend that go with none of the minuend. */
static void remark_others(struct maker *maker) {
    for (size_t b = 0; b < maker->subtrahend->curve_count; b++) {
        const struct curve *curve = &maker->subtrahend->curves[b];
        bool alone = is_finest(maker->subtrahend, curve);
        for (size_t a = 0; a < maker->minuend->curve_count && alone; a++)
            alone = !curve_same_series(&maker->minuend->curves[a], curve) ||
                    partner_of(maker, &maker->minuend->curves[a]) != curve;
        if (alone)
            remark_alone(maker, curve, "second");
    }
}

static int add_curve(struct maker *maker, const struct curve *minuend, struct error *err) {
    struct curve_pair pair = {.minuend = minuend, .subtrahend = partner_of(maker, minuend)};
    struct curve out = curve_named(NULL, NULL, NULL);
    if (pair.subtrahend == NULL) {
        remark_alone(maker, minuend, "first");
        return 0;
    }
    if (minuend->columns > 0 || pair.subtrahend->columns > 0) {
        remark(maker, "%s is a matrix", minuend->quantity);
        return 0;
    }
    int status = find_points(maker, &pair, err);
    if (status == 0 && pair.n == 0)
        remark(maker, "%s has no %s in common", minuend->quantity, minuend->x_label);
    if (status != 0 || pair.n == 0)
        return status;
    if (pair.n < minuend->n || pair.n < pair.subtrahend->n)
        remark(maker, "%s has %zu points in common of %zu and %zu", minuend->quantity, pair.n,
               minuend->n, pair.subtrahend->n);
    status = set_names(maker, &pair, &out, err);
    if (status == 0)
        status = set_values(maker, &pair, &out, err);
    for (enum error_source s = 0; s < ERROR_SOURCES && status == 0; s++)
        if (s != ERROR_MISSING)
            status = combine_error(maker, &pair, s, &out, err);
    if (status == 0)
        status = set_theories(maker, &pair, &out, err);
    return status != 0 ? status : result_add_curve(maker->out, &out, err);
}

/* --- scalars --- */

static struct scalar_error combine_scalar_error(const struct scalar_error *a,
                                                const struct scalar_error *b) {
    struct scalar_error out = {.applies = a->applies || b->applies};
    out.known = out.applies && (a->known || !a->applies) && (b->known || !b->applies);
    if (!out.known)
        return out;
    const struct scalar_error none = {0};
    a = a->applies ? a : &none;
    b = b->applies ? b : &none;
    out.value = a->value - b->value;
    out.bound = a->bound + b->bound;
    out.standard_error = hypot(a->standard_error, b->standard_error);
    return out;
}

/* A scalar without a standard error in either case is exact. */
static void set_scalar(const struct maker *maker, const struct scalar *a, const struct scalar *b,
                       struct scalar *out) {
    struct paired_value value;
    bool exact = a->standard_error == 0 && b->standard_error == 0;
    out->paired = exact;
    out->value = a->value - b->value;
    out->standard_error = hypot(a->standard_error, b->standard_error);
    out->effective =
        effective_of(a->standard_error, scalar_sampled(a), b->standard_error, scalar_sampled(b));
    if (exact || maker->pairs == NULL ||
        !maker->pairs->scalar(maker->pairs->context, a->name, &value))
        return;
    out->paired = true;
    out->value = value.value;
    out->standard_error = value.standard_error;
    out->effective = value.lacking > 0 ? (double)value.pairs : 0;
    struct scalar_error *missing = &out->errors[ERROR_MISSING];
    if (missing->applies) {
        double share = (double)value.lacking / (double)(value.pairs + value.lacking);
        *missing = (struct scalar_error){
            .applies = true,
            .known = true,
            .bound = value.lacking > 0 ? share * MISSING_DEVIATIONS * value.deviation : 0};
    }
}

static int add_scalar(struct maker *maker, const struct scalar *a, struct error *err) {
    const struct scalar *b = result_scalar(maker->subtrahend, a->name);
    struct scalar out = {.name = result_text(maker->out, a->name),
                         .difference = true,
                         .law_difference = NAN,
                         .law_standard_error = NAN};
    if (out.name == NULL)
        return no_room(err);
    if (b == NULL)
        return 0;
    out.minuend = a->value;
    out.subtrahend = b->value;
    out.unit = common_unit(maker->out, &a->unit, &b->unit);
    out.theory = a->theory - b->theory;
    out.grid = a->grid - b->grid;
    for (size_t s = 0; s < ERROR_SOURCES; s++)
        out.errors[s] = combine_scalar_error(&a->errors[s], &b->errors[s]);
    set_scalar(maker, a, b, &out);
    return result_add_scalar(maker->out, &out, err);
}

/* --- all --- */

static int make(struct maker *maker, struct error *err) {
    struct case_result *out = maker->out;
    out->case_number = maker->minuend->case_number;
    out->difference = true;
    out->less = maker->subtrahend->case_number;
    int status = difference_parameters(maker->minuend, maker->subtrahend, out, err);
    for (size_t s = 0; s < maker->minuend->scalar_count && status == 0; s++)
        status = add_scalar(maker, &maker->minuend->scalars[s], err);
    for (size_t a = 0; a < maker->minuend->curve_count && status == 0; a++)
        if (is_finest(maker->minuend, &maker->minuend->curves[a]))
            status = add_curve(maker, &maker->minuend->curves[a], err);
    remark_others(maker);
    if (status == 0 && maker->remark[0] != '\0') {
        out->remark = result_text(out, maker->remark);
        status = out->remark != NULL ? 0 : no_room(err);
    }
    return status;
}

int difference_make(const struct case_result *minuend, const struct case_result *subtrahend,
                    const struct difference_pairs *pairs, struct case_result *out,
                    struct error *err) {
    struct maker maker = {.minuend = minuend, .subtrahend = subtrahend, .pairs = pairs, .out = out};
    int status = make(&maker, err);
    if (status != 0)
        result_clear(out);
    return status;
}
