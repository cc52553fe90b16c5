#include "jobs/contact/contact_plan.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of the error asked for: what chance is to have, for which bounds are made sharper; the most that
 * one bound may take for it; and the least that chance is brought to, where the bounds leave less
 * and the error is out of reach. */
static const double CHANCE_USUAL = 0.8, BOUND_MOST = 0.4, CHANCE_LEAST = 0.5;
enum { SHARPENED_MOST = 64 };
/* A longer cell begins where the bound by the change between lengths is larger than that and than
 * so many times what chance may make of it, or with all the sampling there was. */
static const double LENGTH_SEEN = 2.8;
enum { LONGER_FIRST = 16 };

/* What the bounds leave to chance at a load; 0 where they leave nothing. */
static double left_at(const struct contact_answer *answer, const struct contact_sum *sum,
                      size_t load) {
    double all = answer->target.error * fabs(sum->value[load]);
    double bounds = contact_sum_bounds(answer, sum, load);
    return bounds < all ? sqrt(all * all - bounds * bounds) : 0;
}

/* Doubles a component whose bound alone is too large at a load where all bounds leave less than
 * chance is to have: whether levels show their order is seen better by more realisations. */
static bool sharpen(const struct contact_answer *answer, const struct contact_sum *sum,
                    enum role role, uint64_t *wanted) {
    const double *bound = role == ROLE_MODEL ? sum->model : sum->mesh;
    const struct target_component *of = answer->of[role];
    if (of->done >= SHARPENED_MOST || component_case(of)->level_count < 3 ||
        (role != ROLE_MODEL && (answer->named_mesh || role != contact_sum_mesh(answer))))
        return false;
    for (size_t k = 0; k < answer->loads; k++) {
        double all = answer->target.error * fabs(sum->value[k]);
        if (left_at(answer, sum, k) < CHANCE_USUAL * all && bound[k] > BOUND_MOST * all) {
            *wanted = 2 * of->done;
            return true;
        }
    }
    return false;
}

/* Whether the change between the two longest cells keeps the answer from the error asked for, and
 * more realisations would not tell another one. */
static bool is_short(const struct contact_answer *answer, const struct contact_sum *sum,
                     bool sampled) {
    for (size_t k = 0; k < answer->loads; k++) {
        double all = answer->target.error * fabs(sum->value[k]);
        if (sum->length[k] > BOUND_MOST * all &&
            (sampled || sum->length[k] > LENGTH_SEEN * sum->length_chance[k]))
            return true;
    }
    return false;
}

static bool grows(size_t count, const struct target_part *parts, const uint64_t *wanted) {
    for (size_t a = 0; a < count; a++)
        if (wanted[a] > parts[a].done)
            return true;
    return false;
}

/* Begins with longer cells in place of all else where these are needed, and there is time. */
static bool lengthen(const struct contact_answer *answer, const struct contact_sum *sum,
                     struct target_part parts[ROLES + 1], size_t count, uint64_t *wanted) {
    bool sampled = !grows(count, parts, wanted);
    if (answer->longer == NULL || !is_short(answer, sum, sampled))
        return false;
    uint64_t next[ROLES + 1];
    for (size_t a = 0; a < count; a++)
        next[a] = parts[a].done;
    next[count] = LONGER_FIRST;
    parts[count] = (struct target_part){.seconds = answer->longer->seconds};
    target_hold(&answer->target, count + 1, parts, next);
    if (next[count] < LONGER_FIRST)
        return false;
    for (size_t a = 0; a <= count; a++)
        wanted[a] = next[a];
    return true;
}

/* Adds what sharper bounds need. */
static bool sharpen_all(const struct contact_answer *answer, const struct contact_sum *sum,
                        uint64_t *wanted) {
    bool sharpened = false;
    for (size_t a = 0, part = 0; a < ROLES; a++)
        if (answer->of[a] != NULL) {
            bool bounds = a == ROLE_MESH || a == ROLE_FINE || a == ROLE_MODEL;
            sharpened = (bounds && sharpen(answer, sum, (enum role)a, &wanted[part])) || sharpened;
            part++;
        }
    return sharpened;
}

int contact_plan(const struct contact_answer *answer, const struct contact_sum *sum,
                 uint64_t wanted[ROLES + 1], struct error *err) {
    struct target_part parts[ROLES + 1];
    size_t count = contact_sum_parts(answer, sum, parts);
    double *allowed = array_create(answer->loads, sizeof *allowed);
    if (allowed == NULL)
        return error_memory(err, answer->loads * sizeof *allowed, "a plan");
    for (size_t k = 0; k < answer->loads; k++)
        allowed[k] = fmax(left_at(answer, sum, k),
                          CHANCE_LEAST * answer->target.error * fabs(sum->value[k]));
    struct target_plan plan = {&answer->target, answer->loads, allowed};
    target_allot(&plan, count, parts, wanted);
    free(allowed);
    wanted[count] = 0;
    if (lengthen(answer, sum, parts, count, wanted))
        return 0;
    uint64_t sharper[ROLES];
    for (size_t a = 0; a < count; a++)
        sharper[a] = parts[a].done;
    if (sharpen_all(answer, sum, sharper)) {
        memcpy(wanted, sharper, count * sizeof *sharper);
        target_hold(&answer->target, count, parts, wanted);
    }
    return 0;
}
