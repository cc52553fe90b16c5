/* Passes over the nodes of a solver, shared by its team block by block: sums are added in the order
 * of blocks, so that digits do not depend on the number of threads. Private to
 * core/contact/solver. */
#ifndef RUGO_CORE_CONTACT_SOLVER_PASS_H
#define RUGO_CORE_CONTACT_SOLVER_PASS_H

#include <stddef.h>

struct conjugate_gradient;

/* What a pass works with; each takes what it names. */
struct pass {
    struct conjugate_gradient *solver;
    double step, mean, approach, released;
    double w_mean, t_mean, beta;
};
enum { PASS_SUMS = 7, PASS_MOSTS = 3 };
struct pass_result {
    double sum[PASS_SUMS],
        most[PASS_MOSTS]; /* over the nodes of a block; their use is the pass's */
};
/* Works on nodes first .. first + count - 1, a multiple of the lanes, of a zeroed result. */
typedef void pass_block(const struct pass *pass, size_t first, size_t count,
                        struct pass_result *out);

/* Returns the number of results that a pass over so many nodes writes. */
size_t pass_blocks(size_t padded);
struct pass_result pass_run(const struct pass *pass, pass_block *block);

#endif
