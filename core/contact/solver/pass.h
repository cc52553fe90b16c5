/* Passes over the nodes of a solver, shared by its team block by block: sums are added in the order
 * of blocks, so that digits do not depend on the number of threads. Private to
 * core/contact/solver. */
#ifndef RUGO_CORE_CONTACT_SOLVER_PASS_H
#define RUGO_CORE_CONTACT_SOLVER_PASS_H

#include "core/team.h"

/* What passes over the nodes of a solver share. */
struct pass_board {
    size_t padded;               /* nodes, a multiple of the lanes */
    struct pass_result *results; /* owned: of each block */
    struct team *team;           /* borrowed; NULL: the caller alone */
};
int pass_board_create(struct pass_board *out, size_t padded, struct error *err);
void pass_board_clear(struct pass_board *board);
double pass_board_bytes(size_t padded);

struct conjugate_gradient;

/* What a pass works with; each takes what it names. */
struct pass {
    struct conjugate_gradient *solver;
    double step, mean, approach;
    double w_mean, t_mean, beta;
    double *scaled;    /* of all nodes */
    const double *set; /* of all nodes: above 0 in a set of them */
};
enum { PASS_SUMS = 7, PASS_MOSTS = 3 };
struct pass_result {
    double sum[PASS_SUMS],
        most[PASS_MOSTS]; /* over the nodes of a block; their use is the pass's */
};
/* Works on nodes first .. first + count - 1, a multiple of the lanes, of a zeroed result. */
typedef void pass_block(const struct pass *pass, size_t first, size_t count,
                        struct pass_result *out);

/* Works on all nodes. Returns the sums over the blocks, and what is largest of them. */
struct pass_result pass_run(const struct pass_board *board, const struct pass *pass,
                            pass_block *block);

#endif
