#include "jobs/contact/contact_plan.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of the error asked for: the least that chance is brought to, where the bounds leave less and the
 * error is out of reach; and the most that the length of the cell may take. */
static const double CHANCE_LEAST = 0.5, BOUND_MOST = 0.4;
enum { SHARPENED_MOST = 64, LEVELS_SHARPENED = 3 };
/* A longer cell begins where the bound by the change between lengths is larger than that and than
 * so many times what chance may make of it, or with all the sampling there was. */
static const double LENGTH_SEEN = 2.8;
enum { LONGER_FIRST = 8 };

/* What bounds that come to so much leave to chance of an error; 0 where they leave nothing. */
static double left_by(double error, double bounds) {
    return bounds < error ? sqrt(error * error - bounds * bounds) : 0;
}

static double asked_at(const struct contact_answer *answer, const struct contact_sum *sum,
                       size_t load) {
    return answer->target.error * fabs(sum->value[load]);
}

static double left_at(const struct contact_answer *answer, const struct contact_sum *sum,
                      size_t load) {
    return left_by(asked_at(answer, sum, load), contact_sum_bounds(answer, sum, load));
}

/* How many times the work done so far it takes to bring chance to what the bounds leave at every
 * load, if those of a role were `times` what they are; INFINITY where they leave too little. */
static double work_with(const struct contact_answer *answer, const struct contact_sum *sum,
                        enum role role, double times) {
    const double *bound = role == ROLE_MODEL ? sum->model : sum->mesh;
    double most = 0;
    for (size_t k = 0; k < answer->loads; k++) {
        double asked = asked_at(answer, sum, k), all = contact_sum_bounds(answer, sum, k);
        double less = bound[k] * bound[k] * (1 - times * times);
        double left = left_by(asked, sqrt(fmax(0, all * all - less)));
        double ratio = left < CHANCE_LEAST * asked ? INFINITY : sum->width[k] / left;
        most = fmax(most, ratio * ratio);
    }
    return most;
}

/* Doubles a component whose levels tell a bound, where a bound half as large saves more work than
 * that takes: whether levels show their order is seen better by more realisations. */
static bool sharpen(const struct contact_answer *answer, const struct contact_sum *sum,
                    enum role role, const struct target_part *part, double work, uint64_t *wanted) {
    if (part->done >= SHARPENED_MOST ||
        component_case(answer->of[role])->level_count < LEVELS_SHARPENED ||
        (role != ROLE_MODEL && (answer->named_mesh || role != contact_sum_mesh(answer))))
        return false;
    double now = work_with(answer, sum, role, 1), then = work_with(answer, sum, role, 0.5);
    double least = work_with(answer, sum, role, 0);
    bool saves =
        isfinite(now) ? (now - then) * work > part->work * (double)part->done : isfinite(least);
    if (saves)
        *wanted = 2 * part->done;
    return saves;
}

/* Whether the change between the two longest cells keeps the answer from the error asked for: by
 * far more than chance, or with all the sampling there was. */
static bool is_short(const struct contact_answer *answer, const struct contact_sum *sum,
                     bool sampled) {
    for (size_t k = 0; k < answer->loads; k++) {
        double all = asked_at(answer, sum, k);
        bool missed = sampled && sum->width[k] > left_at(answer, sum, k);
        bool seen = sum->length[k] > LENGTH_SEEN * sum->length_chance[k];
        if (sum->length[k] > BOUND_MOST * all && (missed || seen))
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
                        size_t count, const struct target_part *parts, uint64_t *wanted) {
    bool sharpened = false;
    double work = 0;
    for (size_t part = 0; part < count; part++)
        work += parts[part].work * (double)parts[part].done;
    for (size_t a = 0, part = 0; a < ROLES; a++)
        if (answer->of[a] != NULL) {
            bool bounds = a == ROLE_MESH || a == ROLE_FINE || a == ROLE_MODEL;
            sharpened =
                (bounds && sharpen(answer, sum, (enum role)a, &parts[part], work, &wanted[part])) ||
                sharpened;
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
        allowed[k] = fmax(left_at(answer, sum, k), CHANCE_LEAST * asked_at(answer, sum, k));
    struct target_plan plan = {&answer->target, answer->loads, allowed};
    target_allot(&plan, count, parts, wanted);
    free(allowed);
    wanted[count] = 0;
    if (lengthen(answer, sum, parts, count, wanted))
        return 0;
    uint64_t sharper[ROLES];
    for (size_t a = 0; a < count; a++)
        sharper[a] = parts[a].done;
    if (sharpen_all(answer, sum, count, parts, sharper)) {
        memcpy(wanted, sharper, count * sizeof *sharper);
        target_hold(&answer->target, count, parts, wanted);
    }
    return 0;
}
