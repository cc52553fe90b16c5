#include "server/show/progress.h"
#include "server/show/summary_cells.h"
#include "worker/clock.h"
#include <math.h>
#include <stdio.h>
#include <unistd.h>

enum { BAR = 20, TERMINAL_MS = 500, PLAIN_MS = 10000 };

/* The store's estimate, which knows what the cases cost; between two jobs' ends it runs down with
 * the clock. */
static double estimate_left(struct study_progress *progress, const struct study_status *now,
                            int64_t clock) {
    double estimate = now->seconds_left / (double)(now->workers > 0 ? now->workers : 1);
    if (!(fabs(estimate - progress->estimate) <= 0)) { /* also the first, or a NaN */
        progress->estimate = estimate;
        progress->estimate_ms = clock;
    }
    double left = estimate - (double)(clock - progress->estimate_ms) / 1000;
    return left < 0 ? 0 : left;
}

/* Estimates what is left at the pace so far, as if all realisations cost the same. */
static double seconds_left(struct study_progress *progress, const struct study_status *now,
                           int64_t clock) {
    double elapsed = (double)(clock - progress->start_ms) / 1000;
    double done = (double)(now->realisations_done - progress->start_done);
    double left = (double)(now->realisations_total - now->realisations_done);
    return done > 0 && now->cases == 1 ? left * elapsed / done
                                       : estimate_left(progress, now, clock);
}

static void print_bar(const struct study_status *now, double share, const char *left) {
    char bar[BAR + 1];
    for (int i = 0; i < BAR; i++)
        bar[i] = i < (int)(share * BAR) ? '#' : '.';
    bar[BAR] = '\0';
    fprintf(stderr, "\r[%s] %5.1f %%  %llu of %llu realisations, %s left   ", bar, 100 * share,
            (unsigned long long)now->realisations_done, (unsigned long long)now->realisations_total,
            left);
}

int progress_tick(void *context) {
    struct study_progress *progress = context;
    int64_t clock = clock_ms();
    if (clock < progress->next_ms)
        return 0;
    bool terminal = isatty(STDERR_FILENO);
    struct study_status now;
    if (store_status(progress->store, progress->study, &now, NULL) != 0)
        return 0; /* the next tick may find it unlocked */
    if (progress->next_ms == 0) {
        progress->start_ms = clock;
        progress->start_done = now.realisations_done;
    }
    progress->next_ms = clock + (terminal ? TERMINAL_MS : PLAIN_MS);
    double share = (double)now.realisations_done / (double)now.realisations_total;
    char left[48];
    duration_text(seconds_left(progress, &now, clock), left, sizeof left);
    if (terminal)
        print_bar(&now, share, left);
    else
        fprintf(stderr, "rugo run: %s %.1f %%, %s left\n", progress->study, 100 * share, left);
    fflush(stderr);
    progress->shown = terminal;
    study_status_clear(&now);
    return 0;
}

void progress_end(struct study_progress *progress) {
    progress->next_ms = 0;
    if (progress->shown) {
        progress_tick(progress);
        fputc('\n', stderr);
    }
}
