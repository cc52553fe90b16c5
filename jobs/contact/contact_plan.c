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

/* What bounds that come to so much leave to chance of an error; 0 where they leave nothing. */
static double left_by(double error, double bounds) {
    return bounds < error ? sqrt(error * error - bounds * bounds) : 0;
}

static double asked_at(const struct contact_answer *answer, const struct contact_sum *sum,
                       size_t load) {
    return answer->target.error * fabs(sum->value[load]);
}

static bool is_of_model(enum role role) {
    return role == ROLE_MODEL || role == ROLE_MODEL_MESH;
}

/* How far chance may go at each load if the bounds of a role were `times` what they are: what the
 * bounds leave of the error, at least CHANCE_LEAST of it. Returns whether they leave that at every
 * load. */
static bool allow(const struct contact_answer *answer, const struct contact_sum *sum,
                  enum role role, double times, double *allowed) {
    const double *bound = role == ROLE_CELL   ? sum->length
                          : is_of_model(role) ? sum->model
                                              : sum->mesh;
    bool enough = true;
    for (size_t k = 0; k < answer->loads; k++) {
        double asked = asked_at(answer, sum, k), all = contact_sum_bounds(answer, sum, k);
        double less = bound[k] * bound[k] * (1 - times * times);
        double left = left_by(asked, sqrt(fmax(0, all * all - less)));
        enough = enough && !(left < CHANCE_LEAST * asked);
        allowed[k] = fmax(left, CHANCE_LEAST * asked);
    }
    return enough;
}

/* Doubles a component whose levels tell a bound, where a bound half as large saves more work than
 * that takes, or brings the error within reach: whether levels show their order is seen better by
 * more realisations. */
static bool sharpen(const struct contact_answer *answer, const struct contact_sum *sum,
                    const struct target_plan *plan, double *allowed, size_t count,
                    const struct target_part *parts, enum role role, size_t at, uint64_t *wanted) {
    double needed[ROLES];
    const struct target_part *part = &parts[at];
    if (part->done >= SHARPENED_MOST ||
        component_case(answer->of[role])->level_count < LEVELS_SHARPENED ||
        (!is_of_model(role) && (answer->named_mesh || role != contact_sum_mesh(answer))))
        return false;
    bool reaches = allow(answer, sum, role, 1, allowed);
    double now = target_least_work(plan, count, parts, needed);
    bool could = allow(answer, sum, role, 0, allowed);
    (void)allow(answer, sum, role, 0.5, allowed);
    double then = target_least_work(plan, count, parts, needed);
    bool saves = reaches ? now - then > part->work * (double)part->done : could;
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
static size_t lengthened(const struct contact_answer *answer, const struct contact_sum *sum,
                         struct target_part parts[ROLES]) {
    const struct contact_case *own = component_case(answer->of[ROLE_BASE]);
    double times = component_case(answer->longer)->surface.length_ratio / own->surface.length_ratio;
    struct target_part all[ROLES];
    size_t count = 0;
    (void)contact_sum_parts(answer, sum, all);
    for (size_t a = 0, part = 0; a < ROLES; a++) {
        if (answer->of[a] == NULL)
            continue;
        struct target_part one = all[part++];
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
static bool lengthen(const struct contact_answer *answer, const struct contact_sum *sum,
                     const struct target_plan *plan, double *allowed, size_t count,
                     struct target_part parts[ROLES + 1], uint64_t *wanted) {
    if (answer->longer == NULL || !is_seen(answer, sum))
        return false;
    struct target_part longer[ROLES];
    double needed[ROLES];
    bool reaches = allow(answer, sum, ROLE_CELL, 1, allowed);
    double now = target_least_work(plan, count, parts, needed);
    (void)allow(answer, sum, ROLE_CELL, 0.25, allowed);
    double then = target_least_work(plan, lengthened(answer, sum, longer), longer, needed);
    if (reaches && now <= LONGER_SAVES * then)
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

/* Adds what sharper bounds need, in place of all else where they do. */
static void sharpen_all(const struct contact_answer *answer, const struct contact_sum *sum,
                        const struct target_plan *plan, double *allowed, size_t count,
                        const struct target_part *parts, uint64_t *wanted) {
    bool sharpened = false;
    uint64_t sharper[ROLES];
    for (size_t a = 0; a < count; a++)
        sharper[a] = parts[a].done;
    for (size_t a = 0, part = 0; a < ROLES; a++)
        if (answer->of[a] != NULL) {
            bool bounds = a == ROLE_MESH || a == ROLE_FINE || is_of_model((enum role)a);
            sharpened = (bounds && sharpen(answer, sum, plan, allowed, count, parts, (enum role)a,
                                           part, &sharper[part])) ||
                        sharpened;
            part++;
        }
    if (!sharpened)
        return;
    memcpy(wanted, sharper, count * sizeof *sharper);
    target_hold(&answer->target, count, parts, wanted);
}

int contact_plan(const struct contact_answer *answer, const struct contact_sum *sum,
                 uint64_t wanted[ROLES + 1], struct error *err) {
    struct target_part parts[ROLES + 1];
    size_t count = contact_sum_parts(answer, sum, parts);
    double *room = array_create(answer->loads, 2 * sizeof *room);
    if (room == NULL)
        return error_memory(err, answer->loads * 2 * sizeof *room, "a plan");
    const struct target_plan plan = {&answer->target, answer->loads, room, room + answer->loads};
    (void)allow(answer, sum, ROLE_MODEL, 1, room);
    target_allot(&plan, count, parts, wanted);
    wanted[count] = 0;
    if (!lengthen(answer, sum, &plan, room, count, parts, wanted))
        sharpen_all(answer, sum, &plan, room, count, parts, wanted);
    free(room);
    return 0;
}
