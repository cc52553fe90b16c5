#include "schema/result/bytes/curve_bytes.h"
#include "schema/result/bytes/bytes.h"
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Marks of the parts of a curve. Lists of named parts end with PART_END, so that older bytes stay
 * readable when a table of attributes or sources gets another row. */
enum { FORMAT_CURVE = 0x4355, FORMAT_CURVES = 0x4353, FORMAT_VERSION = 1, TEXT_MOST = 4096 };
enum part {
    PART_END,
    PART_TEXT,
    PART_NUMBER,
    PART_ERROR,
    PART_THEORY,
    PART_BOUND,   /* of the error before it */
    PART_UNKNOWN, /* a source that applies, and of which nothing is known */
    PART_LAW,     /* the other law of heights */
    PART_EFFECTIVE,
};

static void put_text(struct bytes *bytes, const char *text) {
    size_t length = strlen(text);
    bytes_put_unsigned(bytes, length);
    for (size_t a = 0; a < length; a++)
        bytes_put_unsigned(bytes, (unsigned char)text[a]);
}

static void put_numbers(struct bytes *bytes, size_t n, const double *numbers) {
    for (size_t a = 0; a < n; a++)
        bytes_put_double(bytes, numbers[a]);
}

static void put_attributes(struct bytes *bytes, const struct curve *curve) {
    for (size_t a = 0; a < CURVE_ATTRIBUTE_COUNT; a++) {
        const struct curve_attribute *row = &CURVE_ATTRIBUTES[a];
        const char *text = curve_attribute_text(curve, row);
        double number = curve_attribute_number(curve, row);
        if (text == NULL && isnan(number))
            continue;
        bytes_put_unsigned(bytes, text != NULL ? PART_TEXT : PART_NUMBER);
        put_text(bytes, row->key);
        if (text != NULL)
            put_text(bytes, text);
        else
            bytes_put_double(bytes, number);
    }
    bytes_put_unsigned(bytes, PART_END);
}

/* Puts cells as distances from one to the next, the first from -1. */
static void put_values(struct bytes *bytes, const struct curve *curve) {
    size_t count = curve_value_count(curve);
    bytes_put_unsigned(bytes, curve->n);
    bytes_put_unsigned(bytes, curve->columns);
    put_numbers(bytes, curve->n, curve->x);
    if (curve->columns > 0) {
        put_text(bytes, curve->x2_label);
        put_numbers(bytes, curve->columns, curve->x2);
        bytes_put_unsigned(bytes, curve->cell_count);
        for (size_t a = 0; a < curve->cell_count; a++)
            bytes_put_unsigned(bytes, a > 0 ? curve->cells[a] - curve->cells[a - 1]
                                            : (uint64_t)curve->cells[a] + 1);
        bytes_put_double(bytes, curve->empty_y);
        bytes_put_double(bytes, curve->empty_standard_error);
    }
    put_numbers(bytes, count, curve->y);
    put_numbers(bytes, count, curve->standard_error);
    bytes_put_unsigned(bytes, curve->valueless != NULL);
    put_numbers(bytes, curve->valueless != NULL ? curve->n : 0, curve->valueless);
    bytes_put_unsigned(bytes, curve->counted);
    bytes_put_double(bytes, curve->counted ? curve->underflow : 0);
    bytes_put_double(bytes, curve->counted ? curve->overflow : 0);
}

static void put_parts(struct bytes *bytes, const struct curve *curve) {
    for (size_t s = 0; s < ERROR_SOURCES; s++) {
        const struct curve_error *error = &curve->errors[s];
        if (!error->applies)
            continue;
        bytes_put_unsigned(bytes, error->value != NULL ? PART_ERROR : PART_UNKNOWN);
        put_text(bytes, ERROR_SOURCE_ROWS[s].name);
        if (error->value == NULL)
            continue;
        bytes_put_double(bytes, error->order);
        bytes_put_unsigned(bytes, error->order_observed);
        put_numbers(bytes, curve_value_count(curve), error->value);
        put_numbers(bytes, curve_value_count(curve), error->standard_error);
        if (error->bound == NULL)
            continue;
        bytes_put_unsigned(bytes, PART_BOUND);
        put_text(bytes, ERROR_SOURCE_ROWS[s].name);
        put_numbers(bytes, curve_value_count(curve), error->bound);
    }
    if (curve->law_difference != NULL) {
        bytes_put_unsigned(bytes, PART_LAW);
        put_numbers(bytes, curve_value_count(curve), curve->law_difference);
        put_numbers(bytes, curve_value_count(curve), curve->law_standard_error);
    }
    if (curve->effective != NULL) {
        bytes_put_unsigned(bytes, PART_EFFECTIVE);
        put_numbers(bytes, curve_value_count(curve), curve->effective);
    }
    for (size_t t = 0; t < curve->theory_count; t++) {
        const struct theory *theory = &curve->theories[t];
        size_t cells = curve->n * (curve->columns > 0 ? curve->columns : 1);
        bytes_put_unsigned(bytes, PART_THEORY);
        put_text(bytes, theory->name);
        bytes_put_unsigned(bytes, theory->y != NULL);
        put_numbers(bytes, theory->y != NULL ? cells : 0, theory->y);
    }
    bytes_put_unsigned(bytes, PART_END);
}

static void put_curve(struct bytes *bytes, const struct curve *curve) {
    put_text(bytes, curve->quantity);
    put_text(bytes, curve->x_label);
    put_text(bytes, curve->y_label);
    put_attributes(bytes, curve);
    put_values(bytes, curve);
    put_parts(bytes, curve);
}

int curves_encode(const struct curve *curves, size_t count, unsigned char **data, size_t *size,
                  struct error *err) {
    struct bytes bytes = {0};
    bytes_put_unsigned(&bytes, count == 1 ? FORMAT_CURVE : FORMAT_CURVES);
    bytes_put_unsigned(&bytes, FORMAT_VERSION);
    if (count != 1)
        bytes_put_unsigned(&bytes, count);
    for (size_t a = 0; a < count; a++)
        put_curve(&bytes, &curves[a]);
    bytes_put_checksum(&bytes);
    if (bytes.failed) {
        int status = error_memory(err, bytes.capacity, "curves");
        bytes_clear(&bytes);
        return status;
    }
    *data = bytes.data;
    *size = bytes.size;
    return 0;
}

/* --- decoding --- */

/* A decoding that runs out of memory marks its reader as failed and out of memory. */
struct decoding {
    struct byte_reader reader;
    struct case_result *result;
    size_t size; /* of all bytes */
    bool no_memory;
};

static void *room_for(struct decoding *decoding, size_t count, size_t size, size_t bytes_each) {
    struct byte_reader *reader = &decoding->reader;
    size_t left = (size_t)(reader->end - reader->at);
    if (reader->failed || count > left / bytes_each) { /* more than the bytes left can hold */
        reader->failed = true;
        return NULL;
    }
    void *room = result_room(decoding->result, count > 0 ? count : 1, size);
    decoding->no_memory = decoding->no_memory || room == NULL;
    reader->failed = reader->failed || room == NULL;
    return room;
}

static const char *get_text(struct decoding *decoding) {
    uint64_t length = bytes_get_unsigned(&decoding->reader);
    if (length > TEXT_MOST)
        decoding->reader.failed = true;
    char *text = room_for(decoding, (size_t)length + 1, 1, 1);
    for (uint64_t a = 0; text != NULL && a < length; a++) {
        uint64_t byte = bytes_get_unsigned(&decoding->reader);
        decoding->reader.failed = decoding->reader.failed || byte == 0 || byte > UCHAR_MAX;
        text[a] = (char)(unsigned char)byte;
    }
    return text;
}

static double *get_numbers(struct decoding *decoding, uint64_t n) {
    double *numbers = room_for(decoding, (size_t)n, sizeof *numbers, sizeof *numbers);
    for (uint64_t a = 0; numbers != NULL && a < n; a++)
        numbers[a] = bytes_get_double(&decoding->reader);
    return numbers;
}

static void get_attributes(struct decoding *decoding, struct curve *curve) {
    for (size_t a = 0; a < CURVE_ATTRIBUTE_COUNT; a++)
        curve_set_attribute(curve, &CURVE_ATTRIBUTES[a], NULL, NAN);
    for (;;) {
        uint64_t part = bytes_get_unsigned(&decoding->reader);
        if (decoding->reader.failed || part == PART_END)
            return;
        const char *key = get_text(decoding);
        const char *text = part == PART_TEXT ? get_text(decoding) : NULL;
        double number = part == PART_NUMBER ? bytes_get_double(&decoding->reader) : (double)NAN;
        for (size_t a = 0; key != NULL && a < CURVE_ATTRIBUTE_COUNT; a++)
            if (strcmp(CURVE_ATTRIBUTES[a].key, key) == 0)
                curve_set_attribute(curve, &CURVE_ATTRIBUTES[a], text, number);
    }
}

static void get_cells(struct decoding *decoding, struct curve *curve) {
    struct byte_reader *reader = &decoding->reader;
    uint64_t all = (uint64_t)curve->n * curve->columns, next = 0;
    curve->x2_label = get_text(decoding);
    curve->x2 = get_numbers(decoding, curve->columns);
    curve->cell_count = (size_t)bytes_get_unsigned(reader);
    uint32_t *cells = room_for(decoding, curve->cell_count, sizeof *cells, 1);
    for (size_t a = 0; cells != NULL && a < curve->cell_count; a++) {
        uint64_t step = bytes_get_unsigned(reader);
        uint64_t cell = next + step - 1;
        if (step == 0 || step > all || cell >= all) {
            reader->failed = true;
            return;
        }
        cells[a] = (uint32_t)cell;
        next = cell + 1;
    }
    curve->cells = cells;
    curve->empty_y = bytes_get_double(reader);
    curve->empty_standard_error = bytes_get_double(reader);
}

static void get_values(struct decoding *decoding, struct curve *curve) {
    struct byte_reader *reader = &decoding->reader;
    curve->n = (size_t)bytes_get_unsigned(reader);
    curve->columns = (size_t)bytes_get_unsigned(reader);
    if (curve->n > UINT32_MAX || curve->columns > UINT32_MAX / (curve->n > 0 ? curve->n : 1))
        reader->failed = true;
    curve->x = get_numbers(decoding, curve->n);
    if (curve->columns > 0)
        get_cells(decoding, curve);
    curve->y = get_numbers(decoding, curve_value_count(curve));
    curve->standard_error = get_numbers(decoding, curve_value_count(curve));
    if (bytes_get_unsigned(reader) != 0)
        curve->valueless = get_numbers(decoding, curve->n);
    curve->counted = bytes_get_unsigned(reader) != 0;
    curve->underflow = bytes_get_double(reader);
    curve->overflow = bytes_get_double(reader);
}

/* Returns the error of the source named next; *unknown for a source that this program does not
 * know. */
static struct curve_error *get_source(struct decoding *decoding, struct curve *curve,
                                      struct curve_error *unknown) {
    const char *name = get_text(decoding);
    for (size_t s = 0; name != NULL && s < ERROR_SOURCES; s++)
        if (strcmp(ERROR_SOURCE_ROWS[s].name, name) == 0)
            return &curve->errors[s];
    return unknown;
}

static void get_error(struct decoding *decoding, struct curve *curve, enum part part) {
    struct curve_error unknown = {0}, *error = get_source(decoding, curve, &unknown);
    if (part == PART_BOUND) {
        error->bound = get_numbers(decoding, curve_value_count(curve));
        return;
    }
    *error = (struct curve_error){.applies = true, .order = NAN};
    if (part == PART_UNKNOWN)
        return;
    error->order = bytes_get_double(&decoding->reader);
    error->order_observed = bytes_get_unsigned(&decoding->reader) != 0;
    error->value = get_numbers(decoding, curve_value_count(curve));
    error->standard_error = get_numbers(decoding, curve_value_count(curve));
}

static void get_theory(struct decoding *decoding, struct curve *curve) {
    if (curve->theory_count == THEORIES_MOST) {
        decoding->reader.failed = true;
        return;
    }
    struct theory *theory = &curve->theories[curve->theory_count++];
    theory->name = get_text(decoding);
    if (bytes_get_unsigned(&decoding->reader) != 0)
        theory->y =
            get_numbers(decoding, (uint64_t)curve->n * (curve->columns > 0 ? curve->columns : 1));
}

static void get_law(struct decoding *decoding, struct curve *curve) {
    curve->law_difference = get_numbers(decoding, curve_value_count(curve));
    curve->law_standard_error = get_numbers(decoding, curve_value_count(curve));
}

static void get_parts(struct decoding *decoding, struct curve *curve) {
    for (;;) {
        uint64_t part = bytes_get_unsigned(&decoding->reader);
        if (decoding->reader.failed || part == PART_END)
            return;
        if (part == PART_ERROR || part == PART_BOUND || part == PART_UNKNOWN)
            get_error(decoding, curve, (enum part)part);
        else if (part == PART_THEORY)
            get_theory(decoding, curve);
        else if (part == PART_LAW)
            get_law(decoding, curve);
        else if (part == PART_EFFECTIVE)
            curve->effective = get_numbers(decoding, curve_value_count(curve));
        else
            decoding->reader.failed = true;
    }
}

/* last: nothing may follow. */
static int decode_curve(struct decoding *decoding, bool last, struct error *err) {
    const struct byte_reader *reader = &decoding->reader;
    struct curve curve = {0};
    curve.quantity = get_text(decoding);
    curve.x_label = get_text(decoding);
    curve.y_label = get_text(decoding);
    get_attributes(decoding, &curve);
    get_values(decoding, &curve);
    get_parts(decoding, &curve);
    if (decoding->no_memory)
        return error_memory(err, decoding->size, "a curve");
    if (reader->failed || curve.series == NULL || (last && reader->at != reader->end))
        return error_set(err, ERROR_INPUT, "a stored curve is damaged");
    return result_add_curve(decoding->result, &curve, err);
}

int curves_decode(struct case_result *result, const unsigned char *data, size_t size,
                  struct error *err) {
    struct decoding decoding = {bytes_open(data, size), result, size, false};
    uint64_t format = bytes_get_unsigned(&decoding.reader);
    uint64_t version = bytes_get_unsigned(&decoding.reader);
    uint64_t count = format == FORMAT_CURVES ? bytes_get_unsigned(&decoding.reader) : 1;
    size_t before = result->curve_count;
    int status = 0;
    if ((format != FORMAT_CURVE && format != FORMAT_CURVES) || version != FORMAT_VERSION ||
        count == 0)
        decoding.reader.failed = true;
    do
        status = decode_curve(&decoding, count <= 1, err);
    while (status == 0 && --count > 0);
    if (status != 0)
        result->curve_count = before;
    return status;
}
