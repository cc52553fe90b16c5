#include "core/instrument/text_map.h"
#include "core/instrument/text_number.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

struct growing {
    double *numbers; /* owned */
    size_t count, capacity;
};

static int append(struct growing *numbers, double number, struct error *err) {
    if (numbers->count == numbers->capacity) {
        size_t capacity = numbers->capacity == 0 ? 1024 : 2 * numbers->capacity;
        double *more = capacity <= SIZE_MAX / sizeof *more
                           ? realloc(numbers->numbers, capacity * sizeof *more)
                           : NULL;
        if (more == NULL)
            return error_memory(err, capacity * sizeof *more, "a height map");
        numbers->numbers = more;
        numbers->capacity = capacity;
    }
    numbers->numbers[numbers->count++] = number;
    return 0;
}

static int refuse(const struct text_field *field, size_t line, size_t column, struct error *err) {
    int shown = field->end - field->at < 40 ? (int)(field->end - field->at) : 40;
    return error_set(err, ERROR_INPUT,
                     "line %zu, column %zu: '%.*s' is not a number as the others; allowed: numbers "
                     "as -1.5e-6, with point or comma throughout, and nan for holes",
                     line, column, shown, field->at);
}

/* The separator behind the last number of a row, which some programs write, makes no hole but where
 * one is missing. */
static bool is_ending(const struct text_field *field, size_t column, size_t columns) {
    return field->last && field->at == field->end && column > 0 &&
           (columns == 0 || column == columns);
}

static int read_row(struct growing *numbers, struct text_line line, struct text_dialect *dialect,
                    size_t *columns, struct error *err) {
    struct text_field field;
    const size_t number_of_line = line.number;
    size_t column = 0;
    int status = 0;
    while (status == 0 && text_field_next(&line, dialect->separator, &field)) {
        double number;
        if (is_ending(&field, column, *columns))
            break;
        if (text_value_of(&field, dialect, &number) == TEXT_OTHER)
            return refuse(&field, number_of_line, column + 1, err);
        status = append(numbers, number, err);
        column++;
    }
    if (*columns == 0)
        *columns = column;
    if (status == 0 && column != *columns)
        return error_set(err, ERROR_INPUT,
                         "line %zu has %zu numbers, not %zu; allowed: as many in each row, and as "
                         "the header says",
                         number_of_line, column, *columns);
    return status;
}

int text_table_read(struct text_table *out, const struct text_block *block, const char *end,
                    size_t columns, struct error *err) {
    struct text_line line = block->first;
    struct text_dialect dialect = text_dialect_of(line);
    struct growing numbers = {0};
    const char *next = block->next;
    struct text_table table = {.line = line.number};
    int status = 0;
    bool more = true;
    for (; status == 0 && more; more = text_line_next(&line, &next, end)) {
        if (line.at == line.end)
            continue;
        if (table.rows > 0 && !text_goes_on(line, dialect.separator))
            break; /* the header of the next block, or a comment */
        status = read_row(&numbers, line, &dialect, &columns, err);
        table.rows++;
    }
    table.numbers = numbers.numbers;
    table.columns = columns;
    if (status != 0)
        free(numbers.numbers);
    else
        *out = table;
    return status;
}
