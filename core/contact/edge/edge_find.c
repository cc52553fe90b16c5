#include "core/contact/edge/edge_find.h"
#include <math.h>

static const double COSINE_LEAST = 0.1;
/* Limits of the bends: squared pressure is p^2 = c^2 d (1 - bend d), and the gap's rise bends
 * likewise. */
static const double BEND_MOST = 0.5, SLOPE_LEAST = 0.75;
enum { ROUNDS = 4, INVERSE_STEPS = 2 };

double edge_highest_pressure(size_t n, const double *p) {
    double most = 0;
    for (size_t i = 0; i < n; i++)
        most = p[i] > most ? p[i] : most;
    return most;
}

void edge_fill_rise(const struct contact_state *state, double highest, double stiffness,
                    size_t first, size_t end, double *rise) {
    for (size_t i = first; i < end; i++) {
        if (state->p[i] > 0) {
            rise[i] = (state->p[i] / highest) * (state->p[i] / highest);
            continue;
        }
        double gap = 0.75 * fmax(0, state->opening[i]) * stiffness;
        double open = highest > 0 ? cbrt(gap / highest) : 1;
        rise[i] = -open * open;
    }
}

/* Returns the index a few steps from another one, of count, which closes upon itself or not. */
static size_t stepped(size_t count, bool open, size_t at, int steps) {
    size_t back = (size_t)-steps, from = at % count;
    if (steps >= 0)
        return open && from + (size_t)steps >= count ? count - 1 : (from + (size_t)steps) % count;
    return open && from < back ? 0 : (from + back * (count - 1)) % count;
}

struct edge_crossing edge_crossing_at(const struct edge_family *family, size_t line, size_t a,
                                      size_t b) {
    const struct edge_family *f = family;
    int on = b == a + 1 ? 1 : -1;
    size_t left = stepped(f->lines, f->open, line, 1);
    size_t right = stepped(f->lines, f->open, line, -1);
    return (struct edge_crossing){
        .inside = edge_node(f, line, a),
        .outside = edge_node(f, line, b),
        .before = edge_node(f, line, stepped(f->nodes, f->open, a, -on)),
        .far_before = edge_node(f, line, stepped(f->nodes, f->open, a, -2 * on)),
        .beyond = edge_node(f, line, stepped(f->nodes, f->open, b, on)),
        .far_beyond = edge_node(f, line, stepped(f->nodes, f->open, b, 2 * on)),
        .inside_left = edge_node(f, left, a),
        .outside_left = edge_node(f, left, b),
        .inside_right = edge_node(f, right, a),
        .outside_right = edge_node(f, right, b),
        .step = f->step,
        .across = f->across,
        .row = f->row,
        .profile = f->lines == 1};
}

/* A crossing during its iteration. Distances are true ones, in spacings along the normal. */
struct found {
    struct edge_direction direction;
    double cosine;     /* between the line and the normal, without its sign */
    double spacing;    /* along the normal, the grid's length */
    double scale;      /* 1/c^(2/3) */
    double apart;      /* of the two nodes */
    double field;      /* distance of the inside node by its pressure, without the bend */
    double inside;     /* of the inside node */
    double open_field; /* of the outside node by its gap, without the bend */
    double bend;
    double bent;      /* 1 - bend d there */
    double open_bent; /* the same of the gap's rise at the outside node */
    double next;      /* squared pressure at the next node inside, by the law over that found */
};

/* Finds the edge for the direction and the bends so far. */
static void find_edge(const struct edge_crossing *x, const struct edge_law *law, const double *rise,
                      struct found *f) {
    double sine = sqrt(fmax(0, 1 - f->cosine * f->cosine));
    double nx = x->row ? f->cosine : sine, ny = x->row ? sine : f->cosine;
    f->direction = edge_direction(law, atan2(ny, nx));
    f->spacing = hypot(f->cosine * x->step, sine * x->across);
    f->apart = f->cosine * x->step / f->spacing;
    double squared = rise[x->inside] / f->spacing / f->bent;
    double open = fmax(0, -rise[x->outside]) / f->spacing / f->open_bent;
    f->scale = edge_scale(&f->direction, squared, open, f->apart, f->scale);
    f->field = squared * f->scale * f->scale * f->scale;
    f->inside = edge_inside(&f->direction, f->field);
    f->open_field = open * f->scale;
}

/* Returns the signed distance of a node to the edge. */
static double distance_of(const struct found *f, double rise) {
    return rise > 0 ? edge_inside(&f->direction, rise / f->spacing * f->scale * f->scale * f->scale)
                    : -edge_outside(&f->direction, -rise / f->spacing * f->scale);
}

/* Finds the cosine of the gradient of the signed distance with the line. */
static void find_cosine(const struct edge_crossing *x, const double *rise, struct found *f) {
    double along = f->cosine;
    double beside =
        (distance_of(f, rise[x->inside_left]) + distance_of(f, rise[x->outside_left]) -
         distance_of(f, rise[x->inside_right]) - distance_of(f, rise[x->outside_right])) *
        f->spacing / (4 * x->across);
    f->cosine = fmax(COSINE_LEAST, along / hypot(along, beside));
}

/* Returns the factor between the rise at the one or two nodes of a chord and the rise without bend:
 * over a chord the rise is a parabola. share: of a step, to the nearer edge. */
static double bent_chord(double share, bool two) {
    double length = (two ? 1 : 0) + 2 * share;
    return length > 0 ? fmax(BEND_MOST, 1 - share / length) : BEND_MOST;
}

/* Returns the bend of a rise that is (1 - bend next)/(1 - bend near) of the law's from one node to
 * the next, at these distances. */
static double bend_of(double ratio, double near, double next) {
    double most = BEND_MOST / fmax(next, 0.05);
    return fmin(fmax((1 - ratio) / fmax(0.2, next - ratio * near), -most), most);
}

/* Finds the bend by the next node further inside; of one or two nodes, that of a chord. */
static void find_bend(const struct edge_crossing *x, const double *rise, struct found *f) {
    double inside = fmax(0, f->inside), next = f->inside + f->apart, field = fmax(0, next);
    bool two = rise[x->before] > 0;
    if (!two || !(rise[x->far_before] > 0)) {
        double length = (two ? f->apart : 0) + 2 * inside;
        f->bent = bent_chord(inside / f->apart, two);
        f->bend = length > 0 ? 1 / length : 0;
        return;
    }
    for (int a = 0; a < INVERSE_STEPS; a++)
        field = fmax(0, field + next - edge_inside(&f->direction, field));
    double ratio = rise[x->before] / rise[x->inside] * f->field / fmax(field, 1e-9);
    f->bend = bend_of(ratio, inside, next);
    f->bent = 1 - f->bend * inside;
    f->next = next / fmax(field, 1e-9);
}

/* Finds the bend of the gap by the next node further outside. */
static void find_open_bend(const struct edge_crossing *x, const double *rise, struct found *f) {
    double outside = fmax(0, f->apart - f->inside), next = outside + f->apart;
    bool two = !(rise[x->beyond] > 0);
    if (!two || rise[x->far_beyond] > 0) {
        f->open_bent = bent_chord(outside / f->apart, two);
    } else if (rise[x->outside] < 0) {
        double field = fmax(1e-9, 2 * next - edge_outside(&f->direction, next));
        double ratio = rise[x->beyond] / rise[x->outside] * f->open_field / field;
        f->open_bent = 1 - bend_of(ratio, outside, next) * outside;
    }
}

/* Returns the gap over the largest pressure, from the rise of an open node. */
static double gap_of(double rise) {
    double root = sqrt(fmax(0, -rise));
    return 4.0 / 3 * root * root * root;
}

/* Returns half the width, in steps, of a profile's patch of one node; NaN where the inside node is
 * not alone. */
static double lone_in_profile(const struct edge_crossing *x, const double *rise) {
    if (rise[x->before] > 0)
        return NAN;
    return edge_lone(sqrt(rise[x->inside]) * x->step, gap_of(rise[x->before]),
                     gap_of(rise[x->outside]));
}

/* Returns half the area, in cells, of a surface's patch of one node: an ellipse that reaches no
 * further than the nodes beside it; NaN where the inside node is not alone. */
static double lone_in_surface(const struct edge_crossing *x, const double *rise) {
    if (rise[x->before] > 0 || rise[x->inside_left] > 0 || rise[x->inside_right] > 0)
        return NAN;
    double force = sqrt(rise[x->inside]) * x->step * x->across;
    double along =
        edge_lone_axis(force / x->step, gap_of(rise[x->before]), gap_of(rise[x->outside]));
    double beside = edge_lone_axis(force / x->across, gap_of(rise[x->inside_left]),
                                   gap_of(rise[x->inside_right]));
    return fmin(1, 0.5 * M_PI * along * beside);
}

/* Beside a narrow gap between two contacts the pressure rises more steeply than bends allow for.
 * There slope and bend follow from the next node further inside. */
static void limit_to_next_node(const struct edge_crossing *x, const double *rise,
                               struct edge_found *found) {
    double inside = fmax(0, found->share), next = 1 + found->share;
    double at_inside = found->slope * (1 - found->bend * inside);
    double at_next = found->next * rise[x->before] / next;
    double more = (at_next - at_inside) / (next - inside);
    if (!(next > 0.5 && found->bend < 0 && more > -found->bend * found->slope))
        return;
    found->slope = fmax(at_inside - more * inside, SLOPE_LEAST * at_inside);
    found->bend = (1 - at_next / found->slope) / next;
}

/* Where the law puts a smooth edge as near as that, in steps, the pressure at the next node further
 * inside is 1.6 times that at the node inside, or more. */
static const double SIDE_SHARE = 0;

static bool is_side(const struct edge_crossing *x, const double *rise,
                    const struct edge_found *found) {
    return rise[x->far_before] > 0 && rise[x->before] > 0 && rise[x->inside] > rise[x->before] &&
           found->share < SIDE_SHARE;
}

struct edge_found edge_find(const struct edge_crossing *crossing, const struct edge_law *law,
                            const double *rise) {
    struct found f = {.cosine = 1, .bent = 1, .open_bent = 1, .next = 1};
    double lone =
        crossing->profile ? lone_in_profile(crossing, rise) : lone_in_surface(crossing, rise);
    if (!isnan(lone))
        return (struct edge_found){.lone = lone};
    for (int a = 0; a < ROUNDS; a++) {
        find_edge(crossing, law, rise, &f);
        if (a + 1 == ROUNDS)
            break;
        find_bend(crossing, rise, &f);
        find_open_bend(crossing, rise, &f);
        if (!crossing->profile)
            find_cosine(crossing, rise, &f);
    }
    double scale = f.scale * f.scale * f.scale;
    struct edge_found found = {.lone = NAN,
                               .part = f.cosine * f.cosine,
                               .share = fmin(fmax(f.inside / f.apart, -1), 2),
                               .slope = f.spacing * f.apart / scale,
                               .bend = f.bend * f.apart,
                               .next = f.next,
                               .reach = 1 + edge_inside(&f.direction, 0) / f.apart,
                               .apart = f.apart,
                               .rate = edge_inside_slope(&f.direction, f.field)};
    found.side = is_side(crossing, rise, &found);
    limit_to_next_node(crossing, rise, &found);
    return found;
}
