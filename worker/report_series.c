#include "worker/report_series.h"
#include "schema/json/wire_field.h"

#include <math.h>
#include <string.h>

/* --- sizes --- */

/* Sums of squares of a quotient: over the points where all numbers are known. */
struct quotient {
    double above, below;
};

static void quotient_add(struct quotient *sums, const cJSON *above, const cJSON *minus,
                         const cJSON *below) {
    const cJSON *a = above ? above->child : NULL, *b = below ? below->child : NULL;
    const cJSON *m = minus ? minus->child : NULL;
    for (; a && b && (m || !minus); a = a->next, b = b->next, m = m ? m->next : NULL) {
        if (cJSON_IsArray(a) && cJSON_IsArray(b)) {
            quotient_add(sums, a, m, b);
        } else if (cJSON_IsNumber(a) && cJSON_IsNumber(b) && (!minus || cJSON_IsNumber(m))) {
            double difference = a->valuedouble - (minus ? m->valuedouble : 0);
            sums->above += difference * difference;
            sums->below += b->valuedouble * b->valuedouble;
        }
    }
}

double relative_size(const cJSON *above, const cJSON *minus, const cJSON *below) {
    struct quotient sums = {0};
    quotient_add(&sums, above, minus, below);
    return sums.below > 0 ? sqrt(sums.above / sums.below) : (double)NAN;
}

/* --- which curve belongs to which --- */

static bool same_member(const cJSON *a, const cJSON *b, const char *key) {
    const cJSON *one = field_at(a, key), *other = field_at(b, key);
    return one ? cJSON_Compare(one, other, true) : !other;
}

/* Of one estimator, at one pressure. */
static bool same_series(const cJSON *a, const cJSON *b) {
    return same_member(a, b, "quantity") && same_member(a, b, "series") &&
           same_member(a, b, "pressure");
}

/* The curve of the same series and model that has such errors at its points, as only that of the
 * finest level has; NULL without one. */
static const cJSON *finest_with(const cJSON *curves, const cJSON *curve, const char *errors) {
    const cJSON *other;
    cJSON_ArrayForEach(other, curves) {
        if (cJSON_IsArray(field_at(other, errors)) && same_series(other, curve) &&
            same_member(other, curve, "model")) {
            return other;
        }
    }
    return NULL;
}

static bool has_model_error(const cJSON *curve) {
    return cJSON_IsArray(field_at(curve, "model_error"));
}

/* The most complete model: that of the curve which has no model error beside one that has. NULL
 * with one model. */
static const cJSON *complete_model(const cJSON *curves) {
    const cJSON *partial = curves ? curves->child : NULL;
    while (partial && !has_model_error(partial)) {
        partial = partial->next;
    }
    const cJSON *other = partial ? curves->child : NULL;
    while (other && (has_model_error(other) || !same_series(other, partial) ||
                     !same_member(other, partial, "level"))) {
        other = other->next;
    }
    return field_at(other, "model");
}

/* The curve of the most complete model on the same level; NULL where it is this one itself. */
static const cJSON *complete_of(const cJSON *curves, const cJSON *curve) {
    const cJSON *model = complete_model(curves), *other;
    if (!model || cJSON_Compare(model, field_at(curve, "model"), true)) {
        return NULL;
    }
    cJSON_ArrayForEach(other, curves) {
        if (cJSON_Compare(model, field_at(other, "model"), true) && same_series(other, curve) &&
            same_member(other, curve, "level")) {
            return other;
        }
    }
    return NULL;
}

/* --- errors --- */

/* a - b; a where b is no list, null where either is unknown. NULL: out of memory. */
static cJSON *difference_of(const cJSON *a, const cJSON *b) {
    cJSON *difference = cJSON_CreateArray();
    const cJSON *x = a ? a->child : NULL, *y = b ? b->child : NULL;
    bool complete = difference != NULL, all = cJSON_IsArray(b);
    for (; complete && x && (y || !all); x = x->next, y = y ? y->next : NULL) {
        bool known = cJSON_IsNumber(x) && (!all || cJSON_IsNumber(y));
        cJSON *item = known ? cJSON_CreateNumber(x->valuedouble - (all ? y->valuedouble : 0))
                            : cJSON_CreateNull();
        complete = cJSON_AddItemToArray(difference, item);
    }
    return fields_finish(difference, complete);
}

static cJSON *limit_of(const cJSON *finest) {
    return difference_of(field_at(finest, "y"), field_at(finest, "discretisation_error"));
}

static bool discretisation_error(const cJSON *curves, const cJSON *curve, double *out) {
    const cJSON *finest = finest_with(curves, curve, "discretisation_error");
    cJSON *limit = finest ? limit_of(finest) : NULL;
    *out = relative_size(field_at(curve, "y"), limit, limit);
    cJSON_Delete(limit);
    return !finest || limit;
}

/* Of the finest level, which counts it between limits; where it does not, between curves of one
 * level. */
static bool model_error(const cJSON *curves, const cJSON *curve, double *out) {
    const cJSON *finest = finest_with(curves, curve, "model_error");
    if (!finest) {
        const cJSON *complete = field_at(complete_of(curves, curve), "y");
        *out = relative_size(field_at(curve, "y"), complete, complete);
        return true;
    }
    const cJSON *error = field_at(finest, "model_error");
    cJSON *limit = limit_of(finest), *complete = limit ? difference_of(limit, error) : NULL;
    bool done = complete != NULL;
    *out = relative_size(error, NULL, complete);
    cJSON_Delete(limit);
    cJSON_Delete(complete);
    return done;
}

bool series_errors(const cJSON *curves, const cJSON *curve, struct series_errors *out) {
    return discretisation_error(curves, curve, &out->discretisation) &&
           model_error(curves, curve, &out->model);
}

/* --- cost --- */

static bool is_work(const cJSON *curve) {
    const char *quantity = cJSON_GetStringValue(field_at(curve, "quantity"));
    return quantity && strcmp(quantity, "work") == 0;
}

/* Points x transforms of all loads, times log2 of the points: what fast transforms cost. */
static double cost_of(const cJSON *work) {
    const cJSON *y, *points = field_at(work, "points");
    double sum = 0;
    cJSON_ArrayForEach(y, field_at(work, "y")) {
        sum += cJSON_IsNumber(y) ? y->valuedouble : 0;
    }
    return cJSON_IsNumber(points) ? sum * log2(fmax(points->valuedouble, 2)) : sum;
}

double series_share(const cJSON *curves, const cJSON *curve) {
    double own = 0, all = 0;
    const cJSON *work;
    cJSON_ArrayForEach(work, curves) {
        if (is_work(work)) {
            double cost = cost_of(work);
            bool same = same_member(work, curve, "model") && same_member(work, curve, "level");
            own += same ? cost : 0;
            all += cost;
        }
    }
    return all > 0 ? own / all : 1;
}
