/* Protects: the one table of options: each type's values, bounds and defaults, the messages on
 * wrong ones, and that every command's own table is sound. */
#include "server/command/command.h"
#include "server/show/quantity.h"
#include "tests/support/check.h"
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct values {
    bool flag;
    const char *text, *model, *optional;
    unsigned count;
    int64_t index, pair[2];
    double number;
    int choice;
    const char **list;
};
#define AT(member) offsetof(struct values, member)
static const struct option_row ROWS[] = {
    {"flag", 'f', OPTION_FLAG, 0, 0, AT(flag), NULL, NULL, "a flag"},
    {"text", 't', OPTION_TEXT, 0, 0, AT(text), "TEXT", "standard", "a text"},
    {"optional", 0, OPTION_OPTIONAL, 0, 0, AT(optional), "[N]", "8", "a number or none"},
    {"model", 0, OPTION_MODELS, 0, 0, AT(model), "MODEL", "halfspace", "a model"},
    {"count", 0, OPTION_COUNT, 1, 7, AT(count), "N", "3", "a count"},
    {"index", 0, OPTION_INDEX, 0, 0, AT(index), "I", NULL, "an index"},
    {"pair", 0, OPTION_PAIR, 0, 0, AT(pair), "A B", NULL, "two indices"},
    {"number", 0, OPTION_NUMBER, 0, 0, AT(number), "X", NULL, "a number above 0"},
    {"choice", 0, OPTION_CHOICE, 0, 0, AT(choice), "one|two|three", "two", "a word"},
    {"list", 0, OPTION_LIST, 0, 0, AT(list), "WORD", NULL, "words"},
    {0}};

/* Parses a line of words; keeps what is printed on standard error. */
static int parse(const char *line, struct values *values, const char **argument, char told[200]) {
    static char copy[200];
    char *argv[24] = {"test"};
    int argc = 1;
    snprintf(copy, sizeof copy, "%s", line);
    for (char *word = strtok(copy, " "); word != NULL && argc < 23; word = strtok(NULL, " "))
        argv[argc++] = word;
    FILE *file = tmpfile();
    int standard_error = dup(STDERR_FILENO);
    assert_non_null(file);
    assert_true(standard_error >= 0 && dup2(fileno(file), STDERR_FILENO) >= 0);
    *values = (struct values){0};
    int status = options_parse(argc, argv, ROWS, values, 0, 1, "[FILE]", argument);
    assert_true(dup2(standard_error, STDERR_FILENO) >= 0);
    close(standard_error);
    rewind(file);
    told[fread(told, 1, 199, file)] = 0;
    fclose(file);
    return status;
}

static void defaults(void **state) {
    (void)state;
    struct values v;
    const char *argument = "left";
    char told[200];
    assert_int_equal(parse("", &v, &argument, told), 0);
    assert_null(argument);
    assert_false(v.flag);
    assert_string_equal(v.text, "standard");
    assert_string_equal(v.model, "halfspace");
    assert_int_equal(v.count, 3);
    assert_int_equal(v.index, -1);
    assert_true(v.pair[0] == -1 && v.pair[1] == -1);
    assert_true(v.number == 0);
    assert_int_equal(v.choice, 1);
    assert_null(v.list[0]);
    assert_null(v.optional);
    options_clear(ROWS, &v);
}

/* A number behind it is its value, a file is not, nor is another option. */
static void a_value_may_be_left_out(void **state) {
    (void)state;
    static const struct {
        const char *line, *value;
    } LINES[] = {{"--optional file", "8"},         {"--optional 5.5 file", "5.5"},
                 {"file --optional", "8"},         {"--optional=3 file", "3"},
                 {"--optional -t word file", "8"}, {"--optional=all file", "all"}};
    for (size_t l = 0; l < sizeof LINES / sizeof *LINES; l++) {
        struct values v;
        const char *argument = NULL;
        char told[200];
        assert_int_equal(parse(LINES[l].line, &v, &argument, told), 0);
        assert_string_equal(argument, "file");
        assert_string_equal(v.optional, LINES[l].value);
        options_clear(ROWS, &v);
    }
}

static void values_of_each_type(void **state) {
    (void)state;
    struct values v;
    const char *argument = NULL;
    char told[200];
    assert_int_equal(parse("-f -t word --count=7 --list a file --index 0 --number 2e-3 "
                           "--choice three --list b",
                           &v, &argument, told),
                     0);
    assert_string_equal(argument, "file");
    assert_true(v.flag);
    assert_string_equal(v.text, "word");
    assert_int_equal(v.count, 7);
    assert_int_equal(v.index, 0);
    assert_true(v.number == 2e-3);
    assert_int_equal(v.choice, 2);
    assert_string_equal(v.list[0], "a");
    assert_string_equal(v.list[1], "b");
    assert_null(v.list[2]);
    options_clear(ROWS, &v);
}

/* Two words, one with a comma, before and behind other words. */
static void pairs_are_two_words_or_one(void **state) {
    (void)state;
    static const char *const LINES[] = {"file --pair 3 0", "--pair 3 0 file", "--pair 3,0 file",
                                        "-f --pair=3,0 --index 1 file", "--pair=3 0 file -f"};
    for (size_t l = 0; l < sizeof LINES / sizeof *LINES; l++) {
        struct values v;
        const char *argument = NULL;
        char told[200];
        assert_int_equal(parse(LINES[l], &v, &argument, told), 0);
        assert_string_equal(argument, "file");
        assert_true(v.pair[0] == 3 && v.pair[1] == 0);
        options_clear(ROWS, &v);
    }
}

static void wrong_values_are_told(void **state) {
    (void)state;
    static const struct {
        const char *line, *text;
    } WRONG[] = {
        {"--model none", "--model none is not halfspace, layered or full"},
        {"--count 0", "--count 0 is not a whole number in [1, 7]"},
        {"--count 8", "--count 8 is not a whole number in [1, 7]"},
        {"--count 99999999999999999999", "is not a whole number in [1, 7]"},
        {"--count 2x", "--count 2x is not a whole number in [1, 7]"},
        {"--index -1", "--index -1 is not a whole number of 0 or more"},
        {"--pair 1", "--pair needs two values"},
        {"--pair 1 x", "--pair x is not a whole number of 0 or more"},
        {"--pair 1,2,3", "--pair 2,3 is not a whole number of 0 or more"},
        {"--number 0", "--number 0 is not a number above 0"},
        {"--number nan", "--number nan is not a number above 0"},
        {"--number inf", "--number inf is not a number above 0"},
        {"--choice fou", "--choice fou is not one or two or three"},
        {"--choice tw", "--choice tw is not one or two or three"},
        {"--flag=1", "--flag takes no value"},
        {"--list", "--list needs a value"},
        {"--chioce one", "unknown option --chioce (did you mean --choice?)"},
        {"--umber=1", "unknown option --umber (did you mean --number?)"},
        {"--colour red", "unknown option --colour; see rugo test --help"},
        {"-z", "unknown option -z"},
        {"a b", "unexpected argument b"},
    };
    for (size_t w = 0; w < sizeof WRONG / sizeof *WRONG; w++) {
        struct values v;
        const char *argument;
        char told[200];
        assert_int_equal(parse(WRONG[w].line, &v, &argument, told), EXIT_USAGE);
        if (strstr(told, WRONG[w].text) == NULL)
            fail_msg("%s: told %s", WRONG[w].line, told);
        options_clear(ROWS, &v);
    }
}

static void rising_lists(void **state) {
    (void)state;
    double values[3];
    size_t count;
    assert_true(rising_numbers("0.5,1,2e1", 3, values, &count));
    assert_int_equal(count, 3);
    assert_true(values[2] == 20);
    static const char *const WRONG[] = {"", "1,", "1,1", "2,1", "0", "1;2", "1,nan", "1,2,3,4"};
    for (size_t w = 0; w < sizeof WRONG / sizeof *WRONG; w++)
        assert_false(rising_numbers(WRONG[w], 3, values, &count));
}

/* Distinct names, defaults that parse, a value that lies within the struct, help for all. */
static void tables_of_the_commands_are_sound(void **state) {
    (void)state;
    size_t rows = 0;
    for (size_t c = 0; COMMANDS[c] != NULL; c++) {
        const struct command *command = COMMANDS[c];
        char *argv[] = {(char[20]){0}, NULL};
        snprintf(argv[0], 20, "%s", command->name);
        assert_true(command->least <= command->most && command->most <= ARGUMENTS_MOST);
        for (const struct option_row *row = command->options; row->name != NULL; row++, rows++) {
            assert_true(strlen(row->help) > 0);
            assert_true((row->type == OPTION_FLAG) == (row->argument == NULL));
            assert_true(row->at < command->options_size);
            for (const struct option_row *other = command->options; other < row; other++) {
                assert_string_not_equal(row->name, other->name);
                assert_true(row->at != other->at);
            }
        }
        void *values = calloc(1, command->options_size);
        const char *arguments[ARGUMENTS_MOST];
        assert_non_null(values);
        assert_int_equal(
            options_parse(1, argv, command->options, values, 0, command->most, "", arguments), 0);
        options_clear(command->options, values);
        free(values);
    }
    assert_true(rows > 40);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults),
        cmocka_unit_test(values_of_each_type),
        cmocka_unit_test(a_value_may_be_left_out),
        cmocka_unit_test(pairs_are_two_words_or_one),
        cmocka_unit_test(wrong_values_are_told),
        cmocka_unit_test(rising_lists),
        cmocka_unit_test(tables_of_the_commands_are_sound),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
