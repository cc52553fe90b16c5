#include "server/command/like_options.h"
#include "schema/json/json.h"
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define AT(member) offsetof(struct like_options, member)
static const struct option_row ROWS[] = {
    {"file", 0, OPTION_TEXT, 0, 0, AT(file), NULL, NULL, NULL},
    {"spectrum", 0, OPTION_CHOICE, 0, 0, AT(spectrum), "table|fit", "table", NULL},
    {"heights", 0, OPTION_CHOICE, 0, 0, AT(heights), "quantiles|fit|gaussian", "quantiles", NULL},
    {"contact", 0, OPTION_CHOICE, 0, 0, AT(contact), "mirrored|none", "mirrored", NULL},
    MAP_OPTION_ROWS(struct like_options, map),
    {0}};

/* A member is named as the option, with underscores for dashes. */
static bool is_named(const struct option_row *row, const char *member) {
    const char *name = row->name;
    while (*name != '\0' && (*name == *member || (*name == '-' && *member == '_'))) {
        name++;
        member++;
    }
    return *name == '\0' && *member == '\0';
}

static int refuse(const cJSON *member, const char *allowed, struct error *err) {
    char *text = json_print(member);
    error_fill(err, ERROR_INPUT, "\"%.40s\": %.60s is not %.200s", member->string,
               text != NULL ? text : "?", allowed);
    free(text);
    return ERROR_INPUT;
}

/* Takes the number of a word of "text|json". */
static int take_choice(int *out, const struct option_row *row, const cJSON *member,
                       struct error *err) {
    const char *text = cJSON_GetStringValue(member), *word = row->argument;
    for (int n = 0; text != NULL && word != NULL; n++) {
        size_t length = strcspn(word, "|");
        if (strlen(text) == length && strncmp(text, word, length) == 0) {
            *out = n;
            return 0;
        }
        word = word[length] == '|' ? word + length + 1 : NULL;
    }
    return refuse(member, row->argument, err);
}

static int take_text(struct like_options *out, const char **text, const cJSON *member,
                     struct error *err) {
    *text = cJSON_GetStringValue(member);
    if (*text != NULL && **text != '\0')
        return 0;
    if (!cJSON_IsNumber(member) || out->number_count == LIKE_NUMBERS_MOST)
        return refuse(member, "a text", err);
    char *number = out->numbers[out->number_count++];
    snprintf(number, LIKE_NUMBER_SIZE, "%.17g", member->valuedouble);
    *text = number;
    return 0;
}

static int take(struct like_options *out, const struct option_row *row, const cJSON *member,
                struct error *err) {
    void *at = (char *)out + row->at;
    if (row->type == OPTION_CHOICE)
        return take_choice(at, row, member, err);
    if (row->type == OPTION_TEXT)
        return take_text(out, at, member, err);
    if (!cJSON_IsBool(member))
        return refuse(member, "true or false", err);
    *(bool *)at = cJSON_IsTrue(member) != 0;
    return 0;
}

static int refuse_name(const char *name, struct error *err) {
    char known[300] = "";
    size_t used = 0;
    for (const struct option_row *row = ROWS; row->name != NULL && used < sizeof known; row++)
        used += (size_t)snprintf(known + used, sizeof known - used, "%s%s", used > 0 ? ", " : "",
                                 row->name);
    for (char *c = known; *c != '\0'; c++)
        *c = *c == '-' ? '_' : *c;
    return error_set(err, ERROR_INPUT, "unknown name \"%.60s\"; there are %s", name, known);
}

int like_options_parse(struct like_options *out, const cJSON *like, struct error *err) {
    *out = (struct like_options){.map.words.boundary = ASK_BOUNDARY_OPEN};
    int status = 0;
    if (cJSON_IsArray(like))
        return error_set(err, ERROR_INPUT,
                         "a list of files; one study is like one measured surface");
    if (!cJSON_IsString(like) && !cJSON_IsObject(like))
        return error_set(err, ERROR_INPUT, "neither the name of a file nor an object with it");
    if (cJSON_IsString(like))
        out->file = like->valuestring;
    for (const cJSON *member = like->child; member != NULL && status == 0; member = member->next) {
        const struct option_row *row = ROWS;
        while (row->name != NULL && !is_named(row, member->string))
            row++;
        status = row->name != NULL ? take(out, row, member, err) : refuse_name(member->string, err);
    }
    if (status == 0 && (out->file == NULL || *out->file == '\0'))
        status = error_set(err, ERROR_INPUT, "\"file\" is missing, the name of a measured surface");
    return status;
}
