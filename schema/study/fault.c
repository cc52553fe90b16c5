#include "schema/study/fault.h"
#include "core/error.h"
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Stands for a text that there was no memory for. */
static char no_text[] = "";

static char *text_copy(const char *text) {
    char *copy = strdup(text);
    return copy != NULL ? copy : no_text;
}

static void text_free(char *text) {
    if (text != no_text)
        free(text);
}

/* Makes room for the faults; those that were counted before there was any have no text. */
static bool reserve(struct fault_list *list, size_t counted) {
    if (list->faults != NULL)
        return true;
    list->faults = array_create(FAULTS_KEPT, sizeof *list->faults);
    for (size_t i = 0; list->faults != NULL && i < counted; i++)
        list->faults[i] = (struct fault){no_text, no_text};
    return list->faults != NULL;
}

void fault_add(struct fault_list *list, const char *pointer, const char *format, ...) {
    size_t at = list->count++;
    if (at >= FAULTS_KEPT || !reserve(list, at))
        return;
    char detail[400];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(detail, sizeof detail, format, arguments);
    va_end(arguments);
    list->faults[at] = (struct fault){text_copy(pointer), text_copy(detail)};
}

void fault_list_clear(struct fault_list *list) {
    size_t kept = list->count < FAULTS_KEPT ? list->count : FAULTS_KEPT;
    for (size_t i = 0; list->faults != NULL && i < kept; i++) {
        text_free(list->faults[i].pointer);
        text_free(list->faults[i].detail);
    }
    free(list->faults);
    *list = (struct fault_list){0};
}
