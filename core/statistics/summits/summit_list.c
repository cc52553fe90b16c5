#include "core/statistics/summits/summit_list.h"
#include <stdint.h>
#include <stdlib.h>

void summit_list_clear(struct summit_list *list) {
    free(list->summits);
    *list = (struct summit_list){0};
}

int summit_list_add(struct summit_list *list, const struct summit *summit, struct error *err) {
    if (list->count == list->capacity) {
        size_t capacity = list->capacity != 0 ? 2 * list->capacity : 1024;
        size_t bytes = capacity * sizeof *list->summits;
        struct summit *larger =
            capacity < SIZE_MAX / sizeof *larger ? realloc(list->summits, bytes) : NULL;
        if (larger == NULL)
            return error_memory(err, bytes, "summits");
        list->summits = larger;
        list->capacity = capacity;
    }
    list->summits[list->count++] = *summit;
    return 0;
}

int summit_list_append(struct summit_list *list, const struct summit_list *other,
                       struct error *err) {
    int status = 0;
    for (size_t a = 0; a < other->count && status == 0; a++)
        status = summit_list_add(list, &other->summits[a], err);
    return status;
}
