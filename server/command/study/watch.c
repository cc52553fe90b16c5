#include "server/command/study/watch.h"
#include <stdio.h>
#include <string.h>
#include <time.h>

bool watch_pause(void) {
    enum { STEP_MS = 100 };
    const struct timespec step = {0, STEP_MS * 1000000L};
    for (int passed = 0; passed < WATCH_MS && stop_requested == 0; passed += STEP_MS)
        nanosleep(&step, NULL);
    return stop_requested == 0;
}

bool watch_has_ended(const cJSON *progress) {
    static const char *const ENDS[] = {"done", "failed", "cancelled"};
    const char *state = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(progress, "state"));
    for (size_t e = 0; state != NULL && e < sizeof ENDS / sizeof *ENDS; e++)
        if (strcmp(state, ENDS[e]) == 0)
            return true;
    return false;
}

int watch_look(struct watch *watch, bool first, cJSON **out, struct error *err) {
    *out = NULL;
    int status = watch->id != NULL ? access_status(watch->access, watch->id, out, err)
                                   : access_list(watch->access, out, err);
    if (status != ERROR_SYSTEM || first) {
        watch->away = false;
        return status;
    }
    if (!watch->away)
        fprintf(stderr, "rugo %s: %s; asked again\n", watch->command, err->text);
    watch->away = true;
    return 0;
}
