#include "jobs/contact/contact_plan.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The least of the error asked for that chance is brought to, where the bounds leave less and the
 * error is out of reach. */
static const double CHANCE_LEAST = 0.5;
enum { SHARPENED_MOST = 64, LEVELS_SHARPENED = 3 };
/* A longer cell may begin where the bound by the change between lengths takes that much of the
 * error, and is so many times what chance may make of it. */
static const double LENGTH_LEAST = 0.3, LENGTH_SEEN = 2.8;
/* It must save so many times what it is expected to take: the solver's steps grow with the length,
 * up to in proportion to it. */
static const double LONGER_SAVES = 4;
enum { LONGER_FIRST = 8 };
/* More realisations may take so many times its chance off a bound. */
static const double SHARPENED_SEEN = 2;

/* What bounds that come to so much leave to chance of an error; 0 where they leave nothing. */
static double left_by(double error, double bounds) {
    return bounds < error ? sqrt(error * error - bounds * bounds) : 0;
}

static double asked_at(const struct contact_answer *answer, const struct contact_sum *sum,
                       size_t load) {
    return answer->target.error * fabs(sum->value[load]);
}

/* A plan under way. */
struct planning {
    const struct contact_answer *answer;
    const struct contact_sum *sum;
    size_t count;
    struct target_part parts[ROLES + 1]; /* and room for the longer cell */
    double *allowed;                     /* by load: how far chance may go */
    double *multipliers, *quantiles;
    bool reaches;   /* the bounds as they are leave enough to chance */
    double lacking; /* work, with these bounds */
};

/* A bound (of: NULL: none) as it may become: so many times what it is, or what chance may take off
 * it by more realisations where that is less; chance: NULL: no matter what that is. */
struct hope {
    const double *of, *chance;
    double times;
};
static const struct hope AS_IT_IS;

static double hoped(const struct hope *hope, size_t load) {
    double then = hope->times * hope->of[load];
    return hope->chance == NULL ? then
                                : fmax(then, hope->of[load] - SHARPENED_SEEN * hope->chance[load]);
}

/* How far chance may go at each load if a bound were as hoped: what the
 * bounds leave of the error, at least CHANCE_LEAST of it. What the surfaces owe to the way they are
 * found no plan lessens: where it is the whole error or more, chance goes as far as without it.
 * Returns whether the other bounds leave CHANCE_LEAST at every load. */
static bool allow(const struct planning *planning, struct hope hope) {
    const struct contact_answer *answer = planning->answer;
    bool enough = true;
    for (size_t k = 0; k < answer->loads; k++) {
        double asked = asked_at(answer, planning->sum, k);
        double found = planning->sum->generation[k];
        double all = contact_sum_bounds(answer, planning->sum, k, false);
        double less = hope.of != NULL ? pow(hope.of[k], 2) - pow(hoped(&hope, k), 2) : 0;
        double planned = sqrt(fmax(0, all * all - less)), without = left_by(asked, planned);
        double left = found >= asked ? without : left_by(asked, hypot(planned, found));
        enough = enough && !(without < CHANCE_LEAST * asked);
        planning->allowed[k] = fmax(left, CHANCE_LEAST * asked);
    }
    return enough;
}

static struct target_plan plan_of(const struct planning *planning) {
    return (struct target_plan){&planning->answer->target, planning->answer->loads,
                                planning->allowed, planning->multipliers, planning->quantiles};
}

/* What is lacking to bring chance to what is allowed now. */
static double lacking_of(const struct planning *planning, size_t count,
                         const struct target_part *parts) {
    const struct target_plan plan = plan_of(planning);
    double needed[ROLES];
    return target_least_work(&plan, count, parts, needed);
}

/* Doubles a component whose levels tell a bound, where a bound half as large saves more work than
 * that takes, or brings the error within reach: whether levels show their order is seen better by
 * more realisations. */
static bool sharpen(const struct planning *planning, enum role role, const struct target_part *part,
                    uint64_t *wanted) {
    const struct contact_answer *answer = planning->answer;
    bool of_model = role == ROLE_MODEL || role == ROLE_MODEL_MESH;
    if (part->done >= SHARPENED_MOST ||
        component_case(answer->of[role])->level_count < LEVELS_SHARPENED ||
        (!of_model && (answer->named_mesh || role != contact_sum_mesh(answer))))
        return false;
    const struct contact_sum *sum = planning->sum;
    struct hope hope = {.of = of_model ? sum->model : sum->mesh,
                        .chance = of_model ? sum->model_chance : sum->mesh_chance};
    bool saves;
    if (planning->reaches) {
        hope.times = 0.5;
        (void)allow(planning, hope);
        double then = lacking_of(planning, planning->count, planning->parts);
        saves = planning->lacking - then > part->work * (double)part->done;
    } else {
        saves = allow(planning, hope);
    }
    if (saves)
        *wanted = 2 * part->done;
    return saves;
}

/* Whether the change between the two longest cells is more than chance makes it at a load where it
 * takes much of the error. */
static bool is_seen(const struct contact_answer *answer, const struct contact_sum *sum) {
    for (size_t k = 0; k < answer->loads; k++)
        if (sum->length[k] > LENGTH_LEAST * asked_at(answer, sum, k) &&
            sum->length[k] > LENGTH_SEEN * sum->length_chance[k])
            return true;
    return false;
}

/* The parts as they would be with the longer cell for base: a share of its realisations with as
 * much length makes for the same chance. The base becomes the cell beside it, and needs no more. */
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

/* Begins with longer cells in place of all else where these bring the error within reach, or take
 * less work than more of the same, and there is time. */
static bool lengthen(struct planning *planning, uint64_t *wanted) {
    const struct contact_answer *answer = planning->answer;
    const size_t count = planning->count;
    struct target_part longer[ROLES];
    if (answer->longer == NULL || !is_seen(answer, planning->sum))
        return false;
    (void)allow(planning, (struct hope){.of = planning->sum->length, .times = 0.25});
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

/* Adds what sharper bounds need, in place of all else where they do. */
static void sharpen_all(const struct planning *planning, uint64_t *wanted) {
    bool sharpened = false;
    uint64_t sharper[ROLES];
    for (size_t a = 0; a < planning->count; a++)
        sharper[a] = planning->parts[a].done;
    for (size_t a = 0, part = 0; a < ROLES; a++)
        if (planning->answer->of[a] != NULL) {
            bool bounds = a != ROLE_BASE && a != ROLE_CELL;
            sharpened = (bounds &&
                         sharpen(planning, (enum role)a, &planning->parts[part], &sharper[part])) ||
                        sharpened;
            part++;
        }
    if (!sharpened)
        return;
    memcpy(wanted, sharper, planning->count * sizeof *sharper);
    target_hold(&planning->answer->target, planning->count, planning->parts, wanted);
}

int contact_plan(const struct contact_answer *answer, const struct contact_sum *sum,
                 uint64_t wanted[ROLES + 1], struct error *err) {
    struct planning planning = {.answer = answer, .sum = sum};
    planning.count = contact_sum_parts(answer, sum, planning.parts);
    planning.allowed = array_create(answer->loads, 3 * sizeof *planning.allowed);
    if (planning.allowed == NULL)
        return error_memory(err, answer->loads * 3 * sizeof *planning.allowed, "a plan");
    planning.multipliers = planning.allowed + answer->loads;
    planning.quantiles = planning.multipliers + answer->loads;
    planning.reaches = allow(&planning, AS_IT_IS);
    planning.lacking = lacking_of(&planning, planning.count, planning.parts);
    const struct target_plan plan = plan_of(&planning);
    target_allot(&plan, planning.count, planning.parts, wanted);
    wanted[planning.count] = 0;
    if (!lengthen(&planning, wanted))
        sharpen_all(&planning, wanted);
    free(planning.allowed);
    return 0;
}
