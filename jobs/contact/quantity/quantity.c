#include "jobs/contact/quantity/quantity.h"

#define ADDRESS(name, count) &name##_QUANTITY,
static const struct contact_quantity *const QUANTITIES[] = {CONTACT_QUANTITY_LIST(ADDRESS)};
#define COUNT(name, count) (count),
static const size_t COUNTS[] = {CONTACT_QUANTITY_LIST(COUNT)};

const struct contact_quantity *contact_quantity_at(size_t at, size_t *measure) {
    *measure = MEASURE_QUANTITIES;
    for (size_t q = 0; q < at && q < CONTACT_QUANTITIES; q++)
        *measure += COUNTS[q];
    return at < CONTACT_QUANTITIES ? QUANTITIES[at] : NULL;
}

/* Returns the quantity with a measure, and its first number; CONTACT_QUANTITIES: there is none. */
static size_t quantity_of(size_t number, size_t *first) {
    size_t q = 0;
    for (*first = 0; q < CONTACT_QUANTITIES && number >= *first + COUNTS[q]; q++)
        *first += COUNTS[q];
    return q;
}

static void ask(struct contact_case *one_case, size_t q) {
    size_t behind = 0;
    for (size_t before = 0; before <= q; before++)
        behind += COUNTS[before];
    one_case->asked.of[q] = true;
    one_case->tangent = one_case->tangent || QUANTITIES[q]->tangent;
    if (one_case->asked.measures < behind)
        one_case->asked.measures = behind;
}

void contact_quantities_read(struct contact_case *one_case, struct values *values) {
    one_case->tangent = one_case->stiffness;
    for (size_t q = 0; q < CONTACT_QUANTITIES; q++)
        if (QUANTITIES[q]->read(one_case, values))
            ask(one_case, q);
}

void contact_quantities_ask(struct contact_case *one_case, size_t measure) {
    size_t first, q = quantity_of(measure - MEASURE_QUANTITIES, &first);
    if (q < CONTACT_QUANTITIES)
        ask(one_case, q);
}

const struct measure *quantity_measure(size_t number) {
    size_t first, q = quantity_of(number, &first);
    return q < CONTACT_QUANTITIES ? &QUANTITIES[q]->measures[number - first] : NULL;
}

bool quantity_is_asked(const struct contact_case *one_case, size_t number) {
    size_t first, q = quantity_of(number, &first);
    return q < CONTACT_QUANTITIES && one_case->asked.of[q];
}

/* Returns whether a quantity is asked for and has a state. */
static bool has_state(const struct quantity_scene *scene, size_t q) {
    return scene->one_case->asked.of[q] && QUANTITIES[q]->create != NULL;
}

int contact_quantities_create(struct contact_quantities *out, const struct quantity_scene *scene,
                              struct error *err) {
    int status = 0;
    *out = (struct contact_quantities){.one_case = scene->one_case};
    for (size_t q = 0; q < CONTACT_QUANTITIES && status == 0; q++)
        if (has_state(scene, q))
            status = QUANTITIES[q]->create(&out->of[q], scene, err);
    if (status != 0)
        contact_quantities_clear(out);
    return status;
}

void contact_quantities_clear(struct contact_quantities *quantities) {
    for (size_t q = 0; q < CONTACT_QUANTITIES; q++)
        if (quantities->of[q] != NULL)
            QUANTITIES[q]->destroy(&quantities->of[q]);
}

double contact_quantities_bytes(const struct quantity_scene *scene) {
    double bytes = 0;
    for (size_t q = 0; q < CONTACT_QUANTITIES; q++)
        bytes += has_state(scene, q) ? QUANTITIES[q]->bytes(scene) : 0;
    return bytes;
}

double contact_quantities_seconds(const struct quantity_scene *scene) {
    double seconds = 0;
    for (size_t q = 0; q < CONTACT_QUANTITIES; q++)
        seconds += has_state(scene, q) ? QUANTITIES[q]->seconds(scene) : 0;
    return seconds;
}

struct cost_jumps contact_quantities_jumps(const struct quantity_scene *scene) {
    struct cost_jumps all = {0};
    for (size_t q = 0; q < CONTACT_QUANTITIES; q++)
        if (has_state(scene, q) && QUANTITIES[q]->jumps != NULL)
            all = cost_jumps_sum(all, QUANTITIES[q]->jumps(scene));
    return all;
}

int contact_quantities_measure(const struct contact_quantities *quantities,
                               const struct measure_context *context,
                               const struct contact_pressed *pressed,
                               const struct contact_area *area, double *values, struct error *err) {
    const struct contact_case *one_case = quantities != NULL ? quantities->one_case : NULL;
    size_t first = 0;
    int status = 0;
    for (size_t a = 0; a < QUANTITY_MEASURES_MOST; a++)
        values[a] = (double)NAN;
    for (size_t q = 0; q < CONTACT_QUANTITIES && status == 0; first += COUNTS[q++])
        if (one_case != NULL && one_case->asked.of[q] && QUANTITIES[q]->measure != NULL)
            status = QUANTITIES[q]->measure(quantities->of[q], context, pressed, area,
                                            values + first, err);
    return status;
}

void contact_quantities_measure_falling(const struct contact_case *one_case,
                                        const struct measure_context *context,
                                        const struct contact_state *state, size_t stride,
                                        double *values) {
    double own[QUANTITY_MEASURES_MOST];
    for (size_t q = 0, first = MEASURE_QUANTITIES; q < CONTACT_QUANTITIES; first += COUNTS[q++]) {
        if (!one_case->asked.of[q] || QUANTITIES[q]->measure_falling == NULL)
            continue;
        for (size_t a = 0; a < COUNTS[q]; a++)
            own[a] = values[(first + a) * stride];
        QUANTITIES[q]->measure_falling(context, state, own);
        for (size_t a = 0; a < COUNTS[q]; a++)
            values[(first + a) * stride] = own[a];
    }
}

int contact_quantities_complete(const struct contact_quantities *quantities,
                                const struct measure_context *context, const double *z,
                                size_t stride, double *values, struct error *err) {
    int status = 0;
    for (size_t q = 0; q < CONTACT_QUANTITIES && status == 0; q++)
        if (quantities->one_case->asked.of[q] && QUANTITIES[q]->complete != NULL)
            status = QUANTITIES[q]->complete(quantities->of[q], context, z, stride, values, err);
    return status;
}
