#include "core/contact/edge.h"
#include <math.h>

static const double PI = 3.14159265358979323846;

static const double SCALE_TOLERANCE = 1e-6; /* Newton's next step is of its square */
enum { SCALE_STEPS = 40, ANGLE_STEPS = 40 };

/* --- the law in use --- */

struct edge_direction edge_direction(const struct edge_law *law, double angle) {
    size_t a = 0;
    while (a + 2 < law->count && angle > law->angle[a + 1])
        a++;
    if (law->count == 1)
        return (struct edge_direction){&law->table[0], &law->table[0], 0};
    double part = (angle - law->angle[a]) / (law->angle[a + 1] - law->angle[a]);
    return (struct edge_direction){&law->table[a], &law->table[a + 1], fmin(fmax(part, 0), 1)};
}

/* Returns true distance less distance, between two samples, and its derivative, both by the root
 * of the distance. */
static double shift_at(const double *low, const double *high, double part, double root,
                       double *slope) {
    double place = root * EDGE_SAMPLES_A_UNIT;
    if (!(place < EDGE_SAMPLES - 1)) {
        *slope = 0;
        return low[EDGE_SAMPLES - 1] + part * (high[EDGE_SAMPLES - 1] - low[EDGE_SAMPLES - 1]);
    }
    size_t a = (size_t)place;
    double first = low[a] + part * (high[a] - low[a]);
    double second = low[a + 1] + part * (high[a + 1] - low[a + 1]);
    *slope = (second - first) * EDGE_SAMPLES_A_UNIT;
    return first + (place - (double)a) * (second - first);
}

static double shift_inside(const struct edge_direction *direction, double root, double *slope) {
    return shift_at(direction->low->inside, direction->high->inside, direction->part, root, slope);
}

static double shift_outside(const struct edge_direction *direction, double root, double *slope) {
    return shift_at(direction->low->outside, direction->high->outside, direction->part, root,
                    slope);
}

double edge_inside(const struct edge_direction *direction, double distance) {
    double slope;
    return distance + shift_inside(direction, sqrt(distance), &slope);
}

double edge_inside_slope(const struct edge_direction *direction, double distance) {
    double slope, root = sqrt(distance);
    shift_inside(direction, root, &slope);
    return fmax(0, (2 * root + slope) * root);
}

double edge_outside(const struct edge_direction *direction, double distance) {
    double slope;
    return distance + shift_outside(direction, sqrt(distance), &slope);
}

double edge_scale(const struct edge_direction *direction, double pressure_squared, double gap_rise,
                  double apart, double start) {
    /* Both distances rise with the scale w, as p^2 w^3 and rise w: Newton's method within what
     * brackets the solution. Without a start, from where neither alone reaches a distance of 2. */
    double least = 0, most = INFINITY, w = start;
    if (!(start > 0)) {
        w = cbrt(2 / pressure_squared) / 2;
        w = gap_rise > 0 ? fmin(w, 1 / gap_rise) : w;
    }
    for (int a = 0; a < SCALE_STEPS; a++) {
        double in = sqrt(pressure_squared * w * w * w), out = sqrt(gap_rise * w);
        double in_slope, out_slope;
        double excess = in * in + out * out - apart + shift_inside(direction, in, &in_slope) +
                        shift_outside(direction, out, &out_slope);
        if (excess > 0)
            most = w;
        else
            least = w;
        double slope = (1.5 * (2 * in + in_slope) * in + 0.5 * (2 * out + out_slope) * out) / w;
        double next = w - excess / slope;
        bool within = next > least && next < most;
        if (within && fabs(next - w) <= SCALE_TOLERANCE * w)
            return next;
        if (within)
            w = fmin(next, 2 * w);
        else
            w = most < INFINITY ? 0.5 * (least + most) : 2 * w;
    }
    return w;
}

double edge_overlap(const struct edge_law *law) {
    double sum = 0, all = 0;
    if (law->count == 1)
        return -law->table[0].inside[0];
    for (size_t a = 0; a + 1 < law->count; a++) {
        double width = law->angle[a + 1] - law->angle[a];
        sum -= width * (law->table[a].inside[0] + law->table[a + 1].inside[0]) / 2;
        all += width;
    }
    return sum / all;
}

/* --- patches of one node --- */

/* t with sinh(2t)/2 - t = y >= 0, by Newton's method from above, where it is monotone. */
static double hertz_angle(double y) {
    double t = fmin(cbrt(1.5 * y), 0.5 * asinh(4 * y + 4));
    for (int a = 0; a < ANGLE_STEPS && t > 0; a++) {
        double sine = sinh(t), step = (0.5 * sinh(2 * t) - t - y) / (2 * sine * sine);
        t -= step;
        if (!(fabs(step) > 1e-12 * t))
            break;
    }
    return t;
}

double edge_lone(double force, double gap_left, double gap_right) {
    /* At a distance x = a cosh t from the middle of a contact of half-width a the gap is
     * (2 force/(pi E*)) (sinh(2t)/2 - t) (Johnson 1985, section 4.2); the two nodes are 2 steps
     * apart. */
    double scale = PI / (2 * force);
    return 2 / (cosh(hertz_angle(scale * fmax(0, gap_left))) +
                cosh(hertz_angle(scale * fmax(0, gap_right))));
}

/* r >= 1 with r ((r^2 - 2) acos(1/r) + sqrt(r^2 - 1)) = y >= 0, by Newton's method from above,
 * where it is monotone. */
static double hertz_ratio(double y) {
    double r = 2 + cbrt(y);
    for (int a = 0; a < ANGLE_STEPS && r > 1; a++) {
        double angle = acos(1 / r), root = sqrt((r - 1) * (r + 1));
        double value = r * ((r * r - 2) * angle + root) - y;
        double step = value / ((3 * r * r - 2) * angle + 3 * root);
        r -= step;
        if (!(fabs(step) > 1e-12 * r))
            break;
    }
    return fmax(1, r);
}

double edge_lone_axis(double force, double gap_left, double gap_right) {
    /* At a distance r a from the middle of a contact of radius a the gap is (3 force/(4 pi E* a))
     * ((r^2 - 2) acos(1/r) + sqrt(r^2 - 1)) (Johnson 1985, section 3.4). */
    double scale = 4 * PI / (3 * force);
    return 2 / (hertz_ratio(scale * fmax(0, gap_left)) + hertz_ratio(scale * fmax(0, gap_right)));
}
