#include "core/full/load_steps.h"
#include "core/full/face.h"
#include <math.h>

/* --- jumps --- */

/* Drags of a jump: the first and the largest one, E* times the mesh's unit; factor by which they
 * rise where a round fails, and fall after small changes of the face. From the largest drag
 * over the mean force of a node of DRAG_SMALL on, and after each fall by DRAG_FALL, equilibrium
 * without drag is tried. Rounds balance to DRAG_TOLERANCE, and from DRAG_REST on to the tolerance
 * of a load, at which a drag counts as none. Also under larger tolerances: rounds that balanced to
 * one of 1e-4 saved 1 % of the iterations of 12 jumps, and to one of 1e-2 a profile jumped 424
 * times in place of 2. */
static const double DRAG_FIRST = 0.02, DRAG_MOST = 10, DRAG_RISE = 4, DRAG_FALL = 0.25;
static const double DRAG_TOLERANCE = 1e-5, DRAG_SMALL = 1e-2, DRAG_REST = 1e-4;
/* Rounds; and rounds after one that failed in which its drag, and up to twice as much, is not tried
 * again. */
enum { DRAG_ROUNDS = 200, DRAG_HELD = 6 };

/* Returns the drag after a round that changed the face by so much, the `since`th after one that
 * failed. */
static double less_drag(double drag, double change, double failed, int since) {
    double less = drag / (8 * change < FACE_CHANGE_MOST   ? DRAG_RISE
                          : 2 * change < FACE_CHANGE_MOST ? 2
                                                          : 1);
    return since < DRAG_HELD ? fmax(less, 2 * failed) : less;
}

/* The rounds of a jump: implicit steps of motion against drag, whose end is at rest. */
static int drag_rounds(const struct load_steps *s, double load, struct error *err) {
    double drag = DRAG_FIRST, tried = INFINITY, force = INFINITY, failed = 0;
    struct dragged now = {0};
    int status = ERROR_NUMERIC, since = 0;
    for (int round = 0; round < DRAG_ROUNDS && drag < DRAG_MOST; round++) {
        bool exact = force < DRAG_REST;
        double tolerance = exact ? s->tolerance : DRAG_TOLERANCE;
        status = s->by->drag(s->solver, load, drag, tolerance, &now, err);
        if (status != 0 && status != ERROR_NUMERIC)
            return status;
        if (status != 0) {
            s->by->fall(s->solver);
            failed = drag;
            since = 0;
            drag *= DRAG_RISE;
            continue;
        }
        force = now.force;
        s->by->hold(s->solver);
        if (exact && force <= s->tolerance)
            return 0;
        drag = less_drag(drag, now.change, failed, ++since);
        if (force > DRAG_SMALL || force > tried * DRAG_FALL)
            continue;
        status = s->by->drag(s->solver, load, 0, s->tolerance, &now, err);
        if (status != ERROR_NUMERIC)
            return status;
        tried = force;
        s->by->fall(s->solver);
    }
    return status != 0 ? status
                       : error_set(err, ERROR_NUMERIC,
                                   "the face jumps and finds no rest in %d rounds", DRAG_ROUNDS);
}

/* Goes from the last load to another that no equilibrium leads to nearby: the block moves against a
 * drag until it is at rest, as far as it jumps. */
static int jump(struct load_steps *s, double load, struct error *err) {
    s->by->leave(s->solver);
    s->by->hold(s->solver);
    int status = drag_rounds(s, load, err);
    s->by->land(s->solver, load, status == 0);
    s->jumps += status == 0;
    return status;
}

/* --- steps --- */

/* After so many halvings of a careful step it is a jump, after so many it fails. The first careful
 * step over the whole change. */
enum { CUTS_SMOOTH = 2, CUTS_MOST = 5 };
static const double CAREFUL_STEP = 0.125;

static double first_step(const struct load_steps *s) {
    return s->careful ? CAREFUL_STEP : 1;
}

static bool is_jump(const struct load_steps *s, double whole, double step, int cuts) {
    return s->careful && (cuts >= (whole == 0 ? 1 : CUTS_SMOOTH) ||
                          fabs(step) < 2 * CAREFUL_STEP * s->least_step * fabs(whole));
}

/* Returns whether no smaller step is tried. */
static bool is_last(const struct load_steps *s, double whole, double step, int cuts) {
    if (fabs(step) < first_step(s) * s->least_step * fabs(whole))
        return true;
    return s->careful ? cuts == CUTS_MOST || (whole == 0 && cuts > 1) : whole == 0;
}

/* A state at which a jump came to rest may need its drag again, under the same load. */
int load_steps_follow(struct load_steps *s, double from, double goal, struct error *err) {
    double whole = goal - from, step = first_step(s) * whole, change = 0;
    int status = 0, cuts = 0;
    s->reached = from;
    do {
        s->failed = step;
        if (s->by->check(s->solver, err) != 0)
            return ERROR_NUMERIC;
        step = fabs(step) < fabs(goal - s->reached) ? step : goal - s->reached;
        double next = step == goal - s->reached ? goal : s->reached + step;
        status = is_jump(s, whole, step, cuts) ? jump(s, next, err)
                                               : s->by->step(s->solver, next, &change, err);
        if (status == 0) {
            s->reached = next;
            step *= cuts > 0 || 2 * change > FACE_CHANGE_MOST ? 1 : 2;
            cuts = 0;
            continue;
        }
        if (status != ERROR_NUMERIC)
            return status;
        cuts++;
        step /= 2;
        s->cuts++;
        s->failed = 2 * step;
        if (is_last(s, whole, step, cuts))
            return status;
    } while (s->reached != goal || status != 0);
    return 0;
}
