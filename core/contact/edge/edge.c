#include "core/contact/edge/edge.h"
#include "core/contact/contact.h"
#include <math.h>
#include <stdlib.h>

static const double SCALE_TOLERANCE = 1e-6; /* Newton's next step is about its square */
enum { SCALE_STEPS = 40, ANGLE_STEPS = 40 };

/* --- the calibrated law --- */

struct edge_direction edge_direction(const struct edge_law *law, double angle) {
    size_t a = 0;
    while (a + 2 < law->count && angle > law->angle[a + 1])
        a++;
    if (law->count == 1)
        return (struct edge_direction){&law->table[0], &law->table[0], 0};
    double part = (angle - law->angle[a]) / (law->angle[a + 1] - law->angle[a]);
    return (struct edge_direction){&law->table[a], &law->table[a + 1], fmin(fmax(part, 0), 1)};
}

/* Returns true distance less distance, between two samples, and its derivative, both by the root of
 * the distance. */
static double shift_at(const double *low, const double *high, double part, double root,
                       double *slope) {
    double position = root * EDGE_SAMPLES_A_UNIT;
    if (!(position < EDGE_SAMPLES - 1)) {
        *slope = 0;
        return low[EDGE_SAMPLES - 1] + part * (high[EDGE_SAMPLES - 1] - low[EDGE_SAMPLES - 1]);
    }
    size_t a = (size_t)position;
    double first = low[a] + part * (high[a] - low[a]);
    double second = low[a + 1] + part * (high[a + 1] - low[a + 1]);
    *slope = (second - first) * EDGE_SAMPLES_A_UNIT;
    return first + (position - (double)a) * (second - first);
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
    /* Both distances rise with the scale w, as p^2 w^3 and rise w. Newton's method is kept within
     * bounds of the solution. Without a start, it begins where neither distance alone reaches 2. */
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
    double scale = M_PI / (2 * force);
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
    double scale = 4 * M_PI / (3 * force);
    return 2 / (hertz_ratio(scale * fmax(0, gap_left)) + hertz_ratio(scale * fmax(0, gap_right)));
}

/* --- how the law is calibrated: on a wave --- */

/* The wave has about WAVE_STEPS spacings of the grid and is pressed to WAVE_LOAD of the pressure of
 * full contact. Neither matters as long as the edges are far from each other. The effect of the
 * wave's own curvature is removed by its closed form, and the mesh's effect on long waves by the
 * compliance of the first of them. At this load the squared pressure bends least. */
enum {
    WAVE_STEPS = 64,
    PHASES = 64,
    PHASES_LEAST = 6,
    REACH = 8,
    PAIRS_MOST = 2048,
    HALVINGS = 50
};
static const double WAVE_LOAD = 0.4;
static const double FIRST_MOST = 2;     /* widths between the first two pairs */
static const double SLOPE_LEAST = 0.05; /* of true distances by those of the fields */

/* Directions of normals, in whole numbers over dx and dy. Those from 45 degrees on are needed where
 * dx and dy differ. */
static const size_t DIRECTIONS[EDGE_DIRECTIONS][2] = {
    {1, 0}, {4, 1}, {3, 1}, {2, 1}, {3, 2}, {1, 1}, {2, 3}, {1, 2}, {1, 3}, {1, 4}, {0, 1}};
enum { DIAGONAL = 5 };

/* --- the exact wave, of amplitude 1 --- */

struct wave {
    double length; /* in spacings along the normal */
    double edge;   /* half-width of the contact, as a phase */
};

/* Distance to the edge at which the pressure is p (F11.2). */
static double wave_inside(const struct wave *wave, double p) {
    double root = p * wave->length / (2 * M_PI), square = root * root;
    double sum = 1 + WAVE_LOAD, product = WAVE_LOAD - square;
    if (!(product > 0))
        return wave->edge * wave->length / M_PI;
    double sine_squared = 2 * product / (sum + sqrt(sum * sum - 4 * product));
    return (wave->edge - asin(sqrt(sine_squared))) * wave->length / M_PI;
}

/* Gap at a distance outside of the edge: the continuation of the pressure there. */
static double wave_gap(const struct wave *wave, double distance) {
    double sine = sin(wave->edge + M_PI * distance / wave->length);
    double root = sqrt(fmax(0, sine * sine - WAVE_LOAD));
    return 2 * (sine * root - WAVE_LOAD * log((sine + root) / sqrt(WAVE_LOAD)));
}

static double wave_outside(const struct wave *wave, double gap) {
    double least = 0, most = wave->length / 2 * (1 - 2 / M_PI * wave->edge);
    for (int a = 0; a < HALVINGS; a++) {
        double middle = 0.5 * (least + most);
        if (wave_gap(wave, middle) < gap)
            least = middle;
        else
            most = middle;
    }
    return 0.5 * (least + most);
}

/* --- the wave on a coated block, on a fine grid --- */

enum { FINE_COUNT = 8192, FINE_EDGE = 1 };

/* The fields near the edge: pressure and gap at a distance of one spacing, less what the wave's own
 * curvature adds. */
struct tip {
    double pressure, gap;
};

/* Return the squared pressure, and the gap to the power of 2/3, of an uncoated wave of the same
 * contact over what they would be if its edge were straight, at a distance inside or outside. */
static double wave_bend_inside(const struct wave *wave, double distance) {
    double by = M_PI * distance / wave->length, sine = sin(wave->edge - by);
    double cosine = cos(wave->edge - by) / cos(wave->edge), edge = sin(wave->edge);
    return by > 1e-3 ? cosine * cosine * (edge * edge - sine * sine) / (by * sin(2 * wave->edge))
                     : 1;
}

static double wave_bend_outside(const struct wave *wave, double distance) {
    double by = M_PI * distance / wave->length, sine = sin(wave->edge + by), edge = sin(wave->edge);
    double root = sqrt(fmax(0, sine * sine - edge * edge));
    double gap = sine * root - edge * edge * log((sine + root) / edge);
    double straight = 4.0 / 3 * cos(wave->edge) * sqrt(sin(2 * wave->edge)) * pow(by, 1.5);
    return by > 1e-3 ? pow(gap / straight, 2.0 / 3) : 1;
}

/* Finds the edge of the wave and the fields there from pressures and gaps of the fine grid. step:
 * of that, in spacings. */
static void read_tip(const struct contact_state *state, double step, struct wave *wave,
                     struct tip *out) {
    size_t last = 0, to_unit = (size_t)(1 / step);
    while (last + 1 < FINE_COUNT / 2 && state->p[last + 1] > 0)
        last++;
    /* Squared pressures fall evenly towards the edge. */
    size_t near = last > FINE_EDGE ? last - FINE_EDGE : 0;
    size_t next = near > FINE_EDGE ? near - FINE_EDGE : 0;
    double square = state->p[near] * state->p[near];
    double fall = state->p[next] * state->p[next] - square;
    double edge = (double)near + (fall > 0 ? FINE_EDGE * square / fall : 0);
    wave->edge = M_PI * edge * step / wave->length;
    double inside = fmax(0, edge - (double)to_unit), outside = edge + (double)to_unit;
    size_t in = (size_t)inside, beyond = (size_t)outside;
    double a = inside - (double)in, b = outside - (double)beyond, apart = (double)to_unit * step;
    double p = (1 - a) * state->p[in] + a * state->p[in + 1];
    double gap = (1 - b) * state->opening[beyond] + b * state->opening[beyond + 1];
    out->pressure = p / sqrt(apart * wave_bend_inside(wave, apart));
    out->gap = gap / pow(apart * wave_bend_outside(wave, apart), 1.5);
}

/* Solves the wave of amplitude `spacing`, on the exact block. */
static int solve_tip(const struct block *exact, double spacing, struct wave *wave, struct tip *out,
                     struct error *err) {
    const double length = wave->length * spacing, k = 2 * M_PI / length;
    const struct grid grid = {FINE_COUNT, 1, length, length};
    struct contact_options options = CONTACT_DEFAULTS;
    struct compliance *compliance = NULL;
    struct contact *contact = NULL;
    struct contact_state state;
    double *z = array_create(FINE_COUNT, sizeof *z);
    options.tolerance = 1e-10;
    int status = z != NULL ? compliance_create(&compliance, &grid, exact, err)
                           : error_memory(err, FINE_COUNT * sizeof *z, "a wave");
    if (status == 0)
        status = contact_create(&contact, compliance, &options, err);
    for (size_t i = 0; status == 0 && i < FINE_COUNT; i++)
        z[i] = spacing * cos(2 * M_PI * (double)i / FINE_COUNT);
    if (status == 0)
        status = contact_begin(contact, z, err);
    if (status == 0)
        status = contact_press(contact, WAVE_LOAD * spacing / block_compliance_exact(k, exact),
                               &state, err);
    if (status == 0) {
        read_tip(&state, wave->length / FINE_COUNT, wave, out);
        out->gap /= spacing;
    }
    contact_destroy(&contact);
    compliance_destroy(&compliance);
    free(z);
    return status;
}

/* --- its problem as that of a profile --- */

/* Compliances along the wave vectors (q m/count) of a direction m, as those of a profile whose node
 * t stands for all nodes with i mx + j my = t. */
static int line_compliance(struct compliance **out, const struct grid *grid,
                           const struct block *block, const size_t m[2], size_t count,
                           struct error *err) {
    double dx = grid_dx(grid), dy = grid_is_profile(grid) ? dx : grid_dy(grid);
    size_t nx = m[0] > 0 ? count / m[0] : 2, ny = m[1] > 0 ? count / m[1] : 2;
    if (grid_is_profile(grid))
        ny = 1;
    struct grid plane = {.nx = nx,
                         .ny = ny,
                         .lx = (double)nx * dx,
                         .ly = grid_is_profile(grid) ? (double)nx * dx : (double)ny * dy};
    double length = (double)count / hypot((double)m[0] / dx, (double)m[1] / dy);
    struct block deep = *block;
    deep.height =
        block->model == MODEL_HALFSPACE ? INFINITY : 1.5 * length + block->coating.thickness;
    struct compliance *whole = NULL, *line = array_create(1, sizeof *line);
    int status = line != NULL ? compliance_create(&whole, &plane, &deep, err)
                              : error_memory(err, sizeof *line, "a wave");
    if (status == 0) {
        *line = (struct compliance){.grid = {count, 1, length, length},
                                    .block = deep,
                                    .waved = {count, 1, length, length},
                                    .waves = count / 2 + 1,
                                    .layers = whole->layers};
        line->length = array_create(line->waves, sizeof *line->length);
        if (whole->weight != NULL)
            line->weight = array_create(line->waves, sizeof *line->weight);
        if (line->length == NULL || (whole->weight != NULL && line->weight == NULL))
            status = error_memory(err, 2 * line->waves * sizeof(double), "a wave");
    }
    for (size_t q = 0; status == 0 && q < line->waves; q++) {
        size_t mx = q % nx, row = q % ny;
        if (m[0] == 0)
            mx = 0;
        if (m[1] == 0)
            row = 0;
        if (2 * mx > nx) {
            mx = nx - mx;
            row = (ny - row) % ny;
        }
        line->length[q] = whole->length[mx * ny + row];
        if (line->weight != NULL)
            line->weight[q] = whole->weight[mx * ny + row];
    }
    compliance_destroy(&whole);
    if (status != 0)
        compliance_destroy(&line);
    *out = line;
    return status;
}

/* --- tables --- */

struct pair {
    double field, truth; /* distances to the edge */
};
struct pairs {
    struct pair inside[PAIRS_MOST], outside[PAIRS_MOST];
    size_t inside_count, outside_count;
};

/* By Shell's method, which needs no memory. */
static void sort_pairs(struct pair *pairs, size_t count) {
    size_t gap = 1;
    while (gap < count / 3)
        gap = 3 * gap + 1;
    for (; gap > 0; gap /= 3)
        for (size_t a = gap; a < count; a++) {
            struct pair moved = pairs[a];
            size_t b = a;
            for (; b >= gap && pairs[b - gap].field > moved.field; b -= gap)
                pairs[b] = pairs[b - gap];
            pairs[b] = moved;
        }
}

static void fill_table(struct pair *pairs, size_t count, double *table) {
    size_t a = 0;
    sort_pairs(pairs, count);
    for (size_t k = 0; k < EDGE_SAMPLES; k++) {
        double root = (double)k / EDGE_SAMPLES_A_UNIT, field = root * root;
        while (a + 2 < count && pairs[a + 1].field <= field)
            a++;
        double low = sqrt(pairs[a].field), width = sqrt(pairs[a + 1].field) - low;
        /* The law is extrapolated before the first pair, whose node has just come into contact. */
        double part = width > 0 ? fmin(fmax((root - low) / width, -FIRST_MOST), 1) : 0;
        double first = pairs[a].truth - pairs[a].field;
        double second = pairs[a + 1].truth - pairs[a + 1].field;
        table[k] = first + part * (second - first);
        /* True distances rise at least by SLOPE_LEAST of those of the fields. */
        double last = (double)(k > 0 ? k - 1 : 0) / EDGE_SAMPLES_A_UNIT;
        if (k > 0)
            table[k] = fmax(table[k], table[k - 1] - (1 - SLOPE_LEAST) * (field - last * last));
    }
}

/* The wave that a direction is learnt from. */
struct lesson {
    struct wave wave;
    double spacing; /* along the normal */
    double steps;   /* of the line over that */
    double load;
    /* On a mesh whose compliance is larger by this factor, the wave takes that much less
     * pressure. */
    double softer;
    bool coated;
    struct tip tip; /* of a coated block; its pressure is that of the law */
};

/* Return the distance of the fields at a node, at a true distance from the edge. Fields on a coated
 * block are 1 at a spacing from the edge. */
static double field_inside(const struct lesson *lesson, double distance, double p) {
    if (!lesson->coated)
        return wave_inside(&lesson->wave, p);
    double root = p / lesson->tip.pressure;
    return root * root / wave_bend_inside(&lesson->wave, distance);
}

static double field_outside(const struct lesson *lesson, double distance, double gap) {
    if (!lesson->coated)
        return wave_outside(&lesson->wave, gap);
    double root = cbrt(fmax(0, gap) / lesson->tip.gap);
    return root * root / wave_bend_outside(&lesson->wave, distance);
}

/* Presses the wave with its crest `phase` nodes of the line beyond node 0. */
static int press_wave(struct contact *contact, size_t count, const struct lesson *lesson,
                      double phase, double *z, struct pairs *out, struct error *err) {
    const struct wave *wave = &lesson->wave;
    struct contact_state state;
    for (size_t i = 0; i < count; i++)
        z[i] = lesson->spacing * cos(2 * M_PI * ((double)i - phase) / (double)count);
    int status = contact_begin(contact, z, err);
    if (status == 0)
        status = contact_press(contact, lesson->load, &state, err);
    if (status != 0)
        return status;
    for (size_t i = 1; i < count / 2; i++) {
        double distance = wave->edge * wave->length / M_PI - ((double)i - phase) / lesson->steps;
        if (fabs(distance) > REACH)
            continue;
        if (state.p[i] > 0 && out->inside_count < PAIRS_MOST)
            out->inside[out->inside_count++] = (struct pair){
                field_inside(lesson, distance, state.p[i] * lesson->softer), distance};
        else if (state.p[i] == 0 && out->outside_count < PAIRS_MOST)
            out->outside[out->outside_count++] = (struct pair){
                field_outside(lesson, -distance, state.opening[i] / lesson->spacing), -distance};
    }
    return 0;
}

/* Solves the wave on the block where that is coated. The first direction that is learnt sets the
 * stiffness of the law, which is 0 before. */
static int lesson_make(struct lesson *out, const struct compliance *line, double steps,
                       double *stiffness, struct error *err) {
    const double count = (double)line->grid.nx, softer = line->length[1] * M_PI / line->grid.lx;
    struct block exact = line->block;
    *out = (struct lesson){.wave = {count / steps, asin(sqrt(WAVE_LOAD))},
                           .spacing = line->grid.lx / count * steps,
                           .steps = steps,
                           .load = WAVE_LOAD * M_PI / (count / steps * softer),
                           .softer = softer,
                           .coated = block_is_coated(&exact)};
    if (!out->coated) {
        *stiffness = 1;
        return 0;
    }
    exact.model = MODEL_HALFSPACE;
    exact.height = INFINITY;
    out->softer = line->length[1] / block_compliance_exact(2 * M_PI / line->grid.lx, &exact);
    int status = solve_tip(&exact, out->spacing, &out->wave, &out->tip, err);
    if (status == 0 && !(*stiffness > 0))
        *stiffness = out->tip.pressure / (0.75 * out->tip.gap);
    out->tip.pressure = *stiffness * 0.75 * out->tip.gap;
    return status;
}

static int learn(const struct grid *grid, const struct block *block, const size_t m[2],
                 double *stiffness, struct edge_table *out, struct error *err) {
    struct contact *contact = NULL;
    struct compliance *line = NULL;
    struct contact_options options = CONTACT_DEFAULTS;
    struct lesson lesson;
    double steps = hypot((double)m[0], (double)m[1]);
    size_t product = 2 * (m[0] > 0 ? m[0] : 1) * (m[1] > 0 ? m[1] : 1);
    size_t count = (size_t)(WAVE_STEPS * steps / (double)product + 0.5) * product;
    size_t phases = (size_t)fmax(PHASES_LEAST, ceil(PHASES / steps));
    struct pairs *pairs = array_create(1, sizeof *pairs);
    double *z = array_create(count, sizeof *z);
    options.tolerance = 1e-10;
    int status = pairs != NULL && z != NULL
                     ? line_compliance(&line, grid, block, m, count, err)
                     : error_memory(err, sizeof *pairs + count * sizeof *z, "a wave");
    if (status == 0)
        status = lesson_make(&lesson, line, steps, stiffness, err);
    if (status == 0)
        status = contact_create(&contact, line, &options, err);
    for (size_t a = 0; status == 0 && a < phases; a++)
        status = press_wave(contact, count, &lesson, (double)a / (double)phases, z, pairs, err);
    if (status == 0 && (pairs->inside_count < 2 || pairs->outside_count < 2))
        status = error_set(err, ERROR_NUMERIC, "the edge of a single wave was not found");
    if (status == 0) {
        fill_table(pairs->inside, pairs->inside_count, out->inside);
        fill_table(pairs->outside, pairs->outside_count, out->outside);
    }
    contact_destroy(&contact);
    compliance_destroy(&line);
    free(pairs);
    free(z);
    return status;
}

/* Fills the direction a of a law, or its mirror image where x and y are alike. */
static int fill_direction(const struct grid *grid, const struct block *block, bool alike, size_t a,
                          struct edge_law *out, struct error *err) {
    const size_t *m = DIRECTIONS[a];
    const double across = grid_is_profile(grid) ? grid_dx(grid) : grid_dy(grid);
    out->angle[a] = atan2((double)m[1] / across, (double)m[0] / grid_dx(grid));
    if (alike && a > DIAGONAL) {
        out->table[a] = out->table[EDGE_DIRECTIONS - 1 - a];
        return 0;
    }
    return learn(grid, block, m, &out->stiffness, &out->table[a], err);
}

int edge_law_make(const struct grid *grid, const struct block *block, struct edge_law *out,
                  struct error *err) {
    const bool profile = grid_is_profile(grid);
    const bool alike = !profile && grid_dx(grid) == grid_dy(grid);
    /* The first one sets the stiffness: across the narrower spacing, be that along x or y. */
    const bool turned = !profile && grid_dy(grid) < grid_dx(grid);
    out->count = profile ? 1 : EDGE_DIRECTIONS;
    out->stiffness = 0;
    for (size_t n = 0; n < out->count; n++) {
        size_t a = turned ? out->count - 1 - n : n;
        int status = fill_direction(grid, block, alike, a, out, err);
        if (status != 0)
            return error_context(err, "law of contact edges");
    }
    return 0;
}
