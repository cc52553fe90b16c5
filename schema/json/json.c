#include "schema/json/json.h"
#include "core/file/text_mark.h"
#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const struct json_limits JSON_LIMITS = {.bytes = 16u << 20, .depth = 32, .values = 1000000};

/* The gate reads the text once, before cJSON does. Each scan_... moves `at` past what it is named
 * for, or notes the first fault and returns false. */
struct gate {
    const char *text, *at, *end;
    const struct json_limits *limits;
    size_t depth, values;
    const char *fault; /* what is wrong at `at` */
};

static bool refuse(struct gate *gate, const char *fault) {
    if (gate->fault == NULL)
        gate->fault = fault;
    return false;
}

static void skip_space(struct gate *gate) {
    while (gate->at < gate->end && strchr(" \t\n\r", *gate->at) != NULL && *gate->at != '\0')
        gate->at++;
}

static bool next_is(const struct gate *gate, char c) {
    return gate->at < gate->end && *gate->at == c;
}

/* Returns the length of a UTF-8 sequence in bytes; 0 where it is not valid (RFC 3629: shortest
 * form, no surrogates, up to U+10FFFF). */
static size_t utf8_length(const unsigned char *s, size_t room) {
    static const struct {
        unsigned char lead_low, lead_high, next_low, next_high, length;
    } FORMS[] = {{0xc2, 0xdf, 0x80, 0xbf, 2}, {0xe0, 0xe0, 0xa0, 0xbf, 3},
                 {0xe1, 0xec, 0x80, 0xbf, 3}, {0xed, 0xed, 0x80, 0x9f, 3},
                 {0xee, 0xef, 0x80, 0xbf, 3}, {0xf0, 0xf0, 0x90, 0xbf, 4},
                 {0xf1, 0xf3, 0x80, 0xbf, 4}, {0xf4, 0xf4, 0x80, 0x8f, 4}};
    if (s[0] < 0x80)
        return 1;
    for (size_t f = 0; f < sizeof FORMS / sizeof *FORMS; f++) {
        size_t length = FORMS[f].length;
        if (s[0] < FORMS[f].lead_low || s[0] > FORMS[f].lead_high || room < length)
            continue;
        bool good = s[1] >= FORMS[f].next_low && s[1] <= FORMS[f].next_high;
        for (size_t i = 2; i < length; i++)
            good = good && (s[i] & 0xc0) == 0x80;
        return good ? length : 0;
    }
    return 0;
}

/* Reads the four hex digits behind \u; returns their value, or -1. */
static long scan_hex(struct gate *gate) {
    long value = 0;
    for (int i = 0; i < 4; i++, gate->at++) {
        if (gate->at >= gate->end || !isxdigit((unsigned char)*gate->at))
            return -1;
        int c = tolower((unsigned char)*gate->at);
        value = value * 16 + (c <= '9' ? c - '0' : c - 'a' + 10);
    }
    return value;
}

static bool scan_escape(struct gate *gate) {
    gate->at++;
    if (gate->at >= gate->end || *gate->at == '\0' || strchr("\"\\/bfnrtu", *gate->at) == NULL)
        return refuse(gate, "an unknown escape in a string");
    if (*gate->at++ != 'u')
        return true;
    long code = scan_hex(gate);
    if (code == 0)
        return refuse(gate, "a NUL character in a string");
    if (code < 0 || (code >= 0xdc00 && code <= 0xdfff))
        return refuse(gate, "a malformed \\u escape in a string");
    if (code < 0xd800 || code > 0xdbff)
        return true;
    bool pair = gate->end - gate->at >= 6 && gate->at[0] == '\\' && gate->at[1] == 'u';
    if (pair) {
        gate->at += 2;
        long low = scan_hex(gate);
        pair = low >= 0xdc00 && low <= 0xdfff;
    }
    return pair || refuse(gate, "half of a surrogate pair in a string");
}

/* Skips ASCII characters that need no escape. They are most bytes, because results are base64. */
static void skip_plain(struct gate *gate) {
    const unsigned char *at = (const unsigned char *)gate->at;
    const unsigned char *end = (const unsigned char *)gate->end;
    while (at < end && *at >= 0x20 && *at < 0x80 && *at != '"' && *at != '\\')
        at++;
    gate->at = (const char *)at;
}

static bool scan_string(struct gate *gate) {
    gate->at++;
    for (skip_plain(gate); gate->at < gate->end && *gate->at != '"'; skip_plain(gate)) {
        unsigned char c = (unsigned char)*gate->at;
        if (c < 0x20)
            return refuse(gate, "a control character in a string");
        if (c == '\\') {
            if (!scan_escape(gate))
                return false;
            continue;
        }
        size_t length =
            utf8_length((const unsigned char *)gate->at, (size_t)(gate->end - gate->at));
        if (length == 0)
            return refuse(gate, "invalid UTF-8");
        gate->at += length;
    }
    if (gate->at >= gate->end)
        return refuse(gate, "a string without an end");
    gate->at++;
    return true;
}

static bool scan_digits(struct gate *gate) {
    const char *start = gate->at;
    while (gate->at < gate->end && isdigit((unsigned char)*gate->at))
        gate->at++;
    return gate->at > start || refuse(gate, "a malformed number");
}

/* An integer without point or exponent must be kept exactly. A double does so up to 2^53, and so
 * for all integers of up to 15 digits. */
static bool is_inexact_integer(const char *text, size_t length) {
    enum { EXACT_DIGITS = 15 };
    char digits[64];
    if (length <= EXACT_DIGITS || memchr(text, '.', length) != NULL)
        return false;
    snprintf(digits, sizeof digits, "%.*s", (int)length, text);
    errno = 0;
    long long value = strtoll(digits, NULL, 10);
    return strpbrk(digits, ".eE") == NULL &&
           (errno != 0 || value > 1LL << 53 || value < -(1LL << 53));
}

static bool scan_number(struct gate *gate) {
    const char *start = gate->at;
    if (next_is(gate, '-'))
        gate->at++;
    if (next_is(gate, '0'))
        gate->at++;
    else if (!scan_digits(gate))
        return false;
    if (next_is(gate, '.')) {
        gate->at++;
        if (!scan_digits(gate))
            return false;
    }
    bool exponent = next_is(gate, 'e') || next_is(gate, 'E');
    if (exponent) {
        gate->at++;
        if (next_is(gate, '+') || next_is(gate, '-'))
            gate->at++;
        if (!scan_digits(gate))
            return false;
    }
    if (gate->at < gate->end && (isalnum((unsigned char)*gate->at) || *gate->at == '.'))
        return refuse(gate, "a malformed number");
    if (gate->at - start > 60) /* cJSON reads numbers through a buffer of 64 */
        return refuse(gate, "a number of more than 60 characters");
    if (is_inexact_integer(start, (size_t)(gate->at - start)))
        return refuse(gate,
                      "an integer beyond 2^53, which would be changed; write a larger seed as "
                      "a decimal string");
    /* A NUL or punctuation follows the last value, so that strtod stops where the scan did. A
     * number of so few characters without an exponent is within range. */
    if (exponent && !isfinite(strtod(start, NULL)))
        return refuse(gate, "a number beyond the range of a double");
    return true;
}

static bool scan_word(struct gate *gate, const char *word) {
    size_t length = strlen(word);
    if ((size_t)(gate->end - gate->at) < length || memcmp(gate->at, word, length) != 0)
        return refuse(gate, "something that is no JSON value");
    gate->at += length;
    return true;
}

static bool scan_value(struct gate *gate);

static bool scan_member(struct gate *gate, bool object) {
    skip_space(gate);
    if (object) {
        if (!next_is(gate, '"'))
            return refuse(gate, "a member name was expected");
        if (!scan_string(gate))
            return false;
        skip_space(gate);
        if (!next_is(gate, ':'))
            return refuse(gate, "a ':' was expected");
        gate->at++;
    }
    return scan_value(gate);
}

static bool scan_container(struct gate *gate, bool object) {
    char close = object ? '}' : ']';
    if (++gate->depth > gate->limits->depth)
        return refuse(gate, "nesting deeper than is allowed");
    gate->at++;
    skip_space(gate);
    if (next_is(gate, close)) {
        gate->at++;
        gate->depth--;
        return true;
    }
    for (;;) {
        if (!scan_member(gate, object))
            return false;
        skip_space(gate);
        if (next_is(gate, close))
            break;
        if (!next_is(gate, ','))
            return refuse(gate, object ? "a ',' or '}' was expected" : "a ',' or ']' was expected");
        gate->at++;
    }
    gate->at++;
    gate->depth--;
    return true;
}

static bool scan_value(struct gate *gate) {
    skip_space(gate);
    if (++gate->values > gate->limits->values)
        return refuse(gate, "more values than are allowed");
    if (gate->at >= gate->end)
        return refuse(gate, "the text ends where a value was expected");
    switch (*gate->at) {
    case '{':
        return scan_container(gate, true);
    case '[':
        return scan_container(gate, false);
    case '"':
        return scan_string(gate);
    case 't':
        return scan_word(gate, "true");
    case 'f':
        return scan_word(gate, "false");
    case 'n':
        return scan_word(gate, "null");
    default:
        if (*gate->at == '-' || isdigit((unsigned char)*gate->at))
            return scan_number(gate);
        return refuse(gate, "something that is no JSON value");
    }
}

static int gate_error(const struct gate *gate, struct error *err) {
    size_t line = 1, column = 1;
    for (const char *c = gate->text; c < gate->at; c++) {
        column = *c == '\n' ? 1 : column + 1;
        line += *c == '\n';
    }
    return error_set(err, ERROR_INPUT, "line %zu, column %zu: %s", line, column, gate->fault);
}

static int by_name(const void *a, const void *b) {
    const cJSON *const *x = a, *const *y = b;
    return strcmp((*x)->string, (*y)->string);
}

/* Returns the first name that an object has twice, or NULL; sets *failed when out of memory. */
static const char *duplicate_name(const cJSON *object, bool *failed) {
    size_t count = (size_t)cJSON_GetArraySize(object), n = 0;
    if (count < 2)
        return NULL;
    const cJSON **members = array_create(count, sizeof *members);
    if (members == NULL) {
        *failed = true;
        return NULL;
    }
    for (const cJSON *member = object->child; member != NULL; member = member->next)
        members[n++] = member;
    qsort(members, n, sizeof *members, by_name);
    const char *name = NULL;
    for (size_t i = 1; i < n && name == NULL; i++)
        if (strcmp(members[i - 1]->string, members[i]->string) == 0)
            name = members[i]->string;
    free(members);
    return name;
}

/* Recurses no deeper than the gate allows. */
static int check_names(const cJSON *value, struct error *err) {
    bool failed = false;
    const char *name = cJSON_IsObject(value) ? duplicate_name(value, &failed) : NULL;
    if (failed)
        return error_memory(err, 0, "the members of an object");
    if (name != NULL)
        return error_set(err, ERROR_INPUT, "the name \"%.60s\" is given twice in one object", name);
    for (const cJSON *child = value->child; child != NULL; child = child->next) {
        int status = check_names(child, err);
        if (status != 0)
            return status;
    }
    return 0;
}

int json_parse(const char *text, size_t size, const struct json_limits *limits, cJSON **out,
               struct error *err) {
    if (limits == NULL)
        limits = &JSON_LIMITS;
    if (size > limits->bytes)
        return error_set(err, ERROR_INPUT, "%zu bytes of JSON; allowed: up to %zu", size,
                         limits->bytes);
    if (text_mark_is_utf16(text, size, NULL))
        return error_set(err, ERROR_INPUT, "the text is in UTF-16; JSON is in UTF-8");
    size_t mark = text_mark_length(text, size);
    text += mark;
    size -= mark;
    char *copy = malloc(size + 1); /* ends with NUL, which strtod and cJSON need */
    if (copy == NULL)
        return error_memory(err, size + 1, "a JSON text");
    memcpy(copy, text, size);
    copy[size] = 0;
    struct gate gate = {.text = copy, .at = copy, .end = copy + size, .limits = limits};
    bool good = scan_value(&gate);
    skip_space(&gate);
    if (good && gate.at < gate.end)
        good = refuse(&gate, "text behind the end of the value");
    int status = good ? 0 : gate_error(&gate, err);
    cJSON *value = good ? cJSON_ParseWithLength(copy, size + 1) : NULL;
    free(copy);
    if (good && value == NULL)
        return error_memory(err, size, "a JSON value");
    if (status == 0)
        status = check_names(value, err);
    if (status != 0) {
        cJSON_Delete(value);
        return status;
    }
    *out = value;
    return 0;
}

/* Reads one reference token of a pointer, unescaped; false when it does not fit. */
static bool pointer_token(const char **at, char *token, size_t room) {
    size_t n = 0;
    for ((*at)++; **at != '\0' && **at != '/'; (*at)++) {
        char c = **at;
        if (c == '~' && ((*at)[1] == '0' || (*at)[1] == '1'))
            c = *++(*at) == '0' ? '~' : '/';
        if (n + 1 >= room)
            return false;
        token[n++] = c;
    }
    token[n] = 0;
    return true;
}

const cJSON *json_at(const cJSON *root, const char *pointer) {
    const cJSON *value = root;
    char token[256];
    while (value != NULL && *pointer != '\0') {
        if (*pointer != '/' || !pointer_token(&pointer, token, sizeof token))
            return NULL;
        if (cJSON_IsArray(value)) {
            char *end;
            errno = 0;
            long index = strtol(token, &end, 10);
            bool good =
                isdigit((unsigned char)*token) && *end == '\0' && errno == 0 && index <= INT32_MAX;
            value = good ? cJSON_GetArrayItem(value, (int)index) : NULL;
        } else {
            value = cJSON_GetObjectItemCaseSensitive(value, token);
        }
    }
    return value;
}

double json_number_at(const cJSON *root, const char *pointer, double otherwise) {
    const cJSON *value = json_at(root, pointer);
    return cJSON_IsNumber(value) ? value->valuedouble : otherwise;
}

cJSON *json_number(double value) {
    return isfinite(value) ? cJSON_CreateNumber(value) : cJSON_CreateNull();
}

cJSON *json_numbers(const double *values, size_t n) {
    cJSON *array = cJSON_CreateArray();
    bool complete = array != NULL;
    for (size_t i = 0; complete && i < n; i++) {
        cJSON *number = json_number(values[i]);
        complete = number != NULL && cJSON_AddItemToArray(array, number);
        if (!complete)
            cJSON_Delete(number);
    }
    if (complete)
        return array;
    cJSON_Delete(array);
    return NULL;
}
