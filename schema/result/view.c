#include "schema/result/view.h"
#include <string.h>

bool view_lists(const char *const *names, const char *name) {
    for (; names != NULL && *names != NULL; names++)
        if (strcmp(*names, name) == 0)
            return true;
    return false;
}
