#include "core/contact/solver/pass.h"
#include "core/contact/solver/conjugate_step.h"
#include <math.h>

/* Nodes of a block. Several arrays of so many are as much as a processor's own cache holds. */
enum { BLOCK = 1 << 14 };

struct shared_pass {
    const struct pass *pass;
    pass_block *block;
};

size_t pass_blocks(size_t padded) {
    return padded / BLOCK + (padded % BLOCK != 0);
}

static void run_block(void *context, size_t part, size_t thread) {
    (void)thread;
    const struct shared_pass *shared = context;
    struct conjugate_gradient *solver = shared->pass->solver;
    size_t first = part * BLOCK, rest = solver->padded - first;
    solver->results[part] = (struct pass_result){0};
    shared->block(shared->pass, first, rest < BLOCK ? rest : BLOCK, &solver->results[part]);
}

struct pass_result pass_run(const struct pass *pass, pass_block *block) {
    const struct conjugate_gradient *solver = pass->solver;
    size_t blocks = pass_blocks(solver->padded);
    struct shared_pass shared = {pass, block};
    team_share(solver->team, blocks, run_block, &shared);
    struct pass_result total = solver->results[0];
    for (size_t b = 1; b < blocks; b++) {
        const struct pass_result *one = &solver->results[b];
        for (size_t s = 0; s < PASS_SUMS; s++)
            total.sum[s] += one->sum[s];
        for (size_t m = 0; m < PASS_MOSTS; m++)
            total.most[m] = fmax(total.most[m], one->most[m]);
    }
    return total;
}
