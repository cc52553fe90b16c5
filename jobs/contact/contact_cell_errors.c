#include "jobs/contact/contact_cell_errors.h"
#include "jobs/contact/contact_cell.h"
#include "jobs/contact/contact_mean.h"

/* Series of lengths are not monotone, and fall slower than 1/L here and there: of an error doubling
 * the length is held to leave this much. As a change vanishes somewhere between loads where its
 * sign is one and the other, loads within this ratio of each other share the largest of theirs.
 * Measured by tests/validation/jobs/test_contact_cells.c. */
static const double LEFT = 0.7, NEAR_LOADS = 2;
static const double ROUNDING = 1e-9; /* of ratios that are meant to be round */

/* Of the mean of another length less that of the case's own, relative to this. */
static struct estimate change_of(const struct contact_tally *tally, enum contact_measure measure,
                                 enum contact_length length, size_t load) {
    if (!contact_case_has_length(tally->one_case, length))
        return (struct estimate){NAN, NAN};
    struct estimate own = contact_tally_own_length(tally, measure, load);
    struct estimate other = contact_tally_other_length(tally, measure, length, load);
    return (struct estimate){(other.value - own.value) / own.value,
                             fabs(hypot(own.standard_error, other.standard_error) / own.value)};
}

/* Until all loads are judged, an error holds the changes to both lengths in place of its order and
 * its bound. */
static double *change_at(struct contact_error *error, enum contact_length length) {
    return length == LENGTH_LONGER ? &error->order : &error->bound;
}

/* The most that the changes of the loads around one are: of those near it, and of its neighbours
 * where the sign changes in between. */
static double change_around(const struct contact_case *one_case, struct contact_error *errors,
                            enum contact_length length, size_t load) {
    double most = 0, own = *change_at(&errors[load], length);
    for (size_t k = 0; k < one_case->load_count; k++) {
        double ratio = one_case->loads[k] / one_case->loads[load];
        double change = *change_at(&errors[k], length);
        bool next = k + 1 >= load && k <= load + 1;
        if ((next && change * own < 0) || fmax(ratio, 1 / ratio) <= NEAR_LOADS * (1 + ROUNDING))
            most = fmax(most, fabs(change));
    }
    return isnan(own) ? own : most;
}

/* What one length says of the error at a load. A bound holds what chance does to a change of few
 * surfaces, which totals have no other place for; least: the part of it that is no chance. */
struct verdict {
    double bound, least, standard_error; /* NaN: nothing */
};

static struct verdict judge(const struct contact_tally *tally, enum contact_measure measure,
                            enum contact_length length, size_t load, double y,
                            struct contact_error *errors) {
    const struct contact_case *one_case = tally->one_case;
    if (!contact_case_has_length(one_case, length))
        return (struct verdict){NAN, NAN, NAN};
    double scale = contact_cell_share(one_case->lengths[length].length, LEFT) * fabs(y);
    double change = scale * change_around(one_case, errors, length, load);
    double chance = scale * change_of(tally, measure, length, load).standard_error;
    return (struct verdict){hypot(change, chance), fmax(0, change - chance), chance};
}

/* Shorter surfaces tell their change well, and nothing of what longer ones change: their bound
 * stands where it is the lesser, but not below what longer ones show beyond chance. */
static struct verdict weigh(struct verdict longer, struct verdict shorter) {
    if (isnan(longer.bound) || shorter.bound >= longer.bound)
        return isnan(longer.bound) ? shorter : longer;
    if (isnan(shorter.bound))
        return longer;
    if (shorter.bound >= longer.least)
        return shorter;
    longer.bound = longer.least;
    return longer;
}

/* The change is that of a half-space on a coarse mesh; of other models and meshes it is the same
 * share. The error may be on either side: the bound is on both. */
bool contact_cell_errors(const struct contact_tally *tally, enum contact_measure measure,
                         size_t model, struct contact_error *out) {
    const struct contact_case *one_case = tally->one_case;
    size_t n = one_case->load_count, finest = one_case->level_count - 1;
    bool any = false;
    for (size_t k = 0; k < n; k++) {
        out[k] = (struct contact_error){.value = NAN};
        for (enum contact_length l = 0; l < CONTACT_LENGTHS; l++)
            *change_at(&out[k], l) = change_of(tally, measure, l, k).value;
    }
    for (size_t k = 0; k < n; k++) {
        double y = contact_mean(tally, measure, model, finest, k).value;
        struct verdict of = weigh(judge(tally, measure, LENGTH_LONGER, k, y, out),
                                  judge(tally, measure, LENGTH_SHORTER, k, y, out));
        out[k].value = of.bound;
        out[k].standard_error = of.standard_error;
    }
    for (size_t k = 0; k < n; k++) {
        bool known = !isnan(out[k].value);
        out[k].bound = out[k].value;
        out[k].value = known ? 0 : (double)NAN;
        out[k].order = NAN;
        any = any || known;
    }
    return any;
}
