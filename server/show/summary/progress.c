#include "server/show/summary/progress.h"
#include "schema/json/field.h"
#include "server/show/summary/summary_cells.h"
#include "worker/clock.h"
#include <math.h>
#include <stdio.h>
#include <unistd.h>

enum { BAR = 20, TERMINAL_MS = 500, PLAIN_MS = 10000 };

bool progress_is_due(const struct progress_bar *bar) {
    return clock_ms() >= bar->next_ms;
}

/* Returns the share to show. Jobs that are given back, and times that were taken for shorter, would
 * let it fall. */
static double rising_share(struct progress_bar *bar, const struct progress_state *state) {
    if (state->total > bar->total && bar->total > 0) {
        bar->next_round = true;
        bar->share = 0;
    }
    bar->total = state->total;
    bar->share = fmax(bar->share, state->share);
    return bar->share;
}

/* With the time since it began, which moves whatever else stands still. */
static void print_bar(const struct progress_bar *bar, const struct progress_state *state,
                      const char *left, int64_t now_ms) {
    long long seconds = (now_ms - bar->start_ms) / 1000;
    char text[BAR + 1];
    for (int i = 0; i < BAR; i++)
        text[i] = i < (int)(bar->share * BAR) ? '#' : '.';
    text[BAR] = '\0';
    char done[32];
    realisations_text(state->done, done, sizeof done);
    fprintf(stderr, "\r[%s] %5.1f %%%s  %s of %.0f realisations, %lld:%02lld:%02lld, %s left\033[K",
            text, 100 * bar->share, bar->next_round ? ", next round" : "", done, state->total,
            seconds / 3600, seconds / 60 % 60, seconds % 60, left);
}

void progress_draw(struct progress_bar *bar, const struct progress_state *state) {
    int64_t now_ms = clock_ms();
    bool terminal = isatty(STDERR_FILENO);
    double share = rising_share(bar, state);
    char left[48];
    if (bar->next_ms == 0)
        bar->start_ms = now_ms;
    bar->next_ms = now_ms + (terminal ? TERMINAL_MS : PLAIN_MS);
    if (state->seconds_left > 0 && state->seconds_left < 1)
        snprintf(left, sizeof left, "less than 1 s");
    else
        duration_text(state->seconds_left, left, sizeof left);
    if (terminal)
        print_bar(bar, state, left, now_ms);
    else
        fprintf(stderr, "rugo %s: %s %.1f %%%s, %s left\n", bar->command, state->study, 100 * share,
                bar->next_round ? ", next round" : "", left);
    fflush(stderr);
    bar->shown = terminal;
}

void progress_end(struct progress_bar *bar) {
    if (bar->shown)
        fputc('\n', stderr);
    bar->shown = false;
}

int progress_tick(void *context) {
    struct study_progress *progress = context;
    struct study_status now;
    if (!progress_is_due(&progress->bar) ||
        store_status(progress->store, progress->study, &now, NULL) != 0)
        return 0; /* the next tick may find it unlocked */
    const struct progress_state state = {.study = progress->study,
                                         .share = now.share,
                                         .seconds_left = now.seconds_left,
                                         .done = (double)now.realisations_done + now.part,
                                         .total = (double)now.realisations_total};
    progress_draw(&progress->bar, &state);
    study_status_clear(&now);
    return 0;
}

static double number_of(const cJSON *object, const char *key) {
    const cJSON *number = field_at(object, key);
    return cJSON_IsNumber(number) ? number->valuedouble : (double)NAN;
}

void progress_of_document(struct progress_bar *bar, const cJSON *progress) {
    const cJSON *realisations = field_at(progress, "realisations");
    const char *id = cJSON_GetStringValue(field_at(progress, "id"));
    double share = number_of(progress, "share"); /* an older server has none */
    struct progress_state state = {.study = id != NULL ? id : "?",
                                   .seconds_left = number_of(progress, "seconds_left"),
                                   .done = fmax(0, number_of(realisations, "done")) +
                                           fmax(0, number_of(progress, "part")),
                                   .total = fmax(0, number_of(realisations, "total"))};
    state.share = share >= 0 && share <= 1 ? share : state.done / fmax(1, state.total);
    if (progress_is_due(bar))
        progress_draw(bar, &state);
}
