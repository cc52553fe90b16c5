#include "core/contact/solver/pass.h"
#include <math.h>
#include <stdlib.h>

/* Nodes of a block. Several arrays of so many are as much as a processor's own cache holds. */
enum { BLOCK = 1 << 14 };

int pass_board_create(struct pass_board *out, size_t padded, struct error *err) {
    size_t blocks = team_parts(padded, BLOCK);
    *out = (struct pass_board){padded, array_create(blocks, sizeof *out->results), NULL};
    return out->results != NULL ? 0 : error_memory(err, blocks * sizeof *out->results, "a contact");
}

void pass_board_clear(struct pass_board *board) {
    free(board->results);
    *board = (struct pass_board){0};
}

double pass_board_bytes(size_t padded) {
    return sizeof(struct pass_result) * (double)team_parts(padded, BLOCK);
}

struct shared_pass {
    const struct pass_board *board;
    const struct pass *pass;
    pass_block *block;
};

static void run_block(void *context, size_t first, size_t end, size_t thread) {
    (void)thread;
    const struct shared_pass *shared = context;
    struct pass_result *result = &shared->board->results[first / BLOCK];
    *result = (struct pass_result){0};
    shared->block(shared->pass, first, end - first, result);
}

struct pass_result pass_run(const struct pass_board *board, const struct pass *pass,
                            pass_block *block) {
    struct shared_pass shared = {board, pass, block};
    team_share_ranges(board->team, board->padded, BLOCK, run_block, &shared);
    struct pass_result total = board->results[0];
    for (size_t b = 1; b < team_parts(board->padded, BLOCK); b++) {
        const struct pass_result *one = &board->results[b];
        for (size_t s = 0; s < PASS_SUMS; s++)
            total.sum[s] += one->sum[s];
        for (size_t m = 0; m < PASS_MOSTS; m++)
            total.most[m] = fmax(total.most[m], one->most[m]);
    }
    return total;
}
