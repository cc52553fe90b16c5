/* Protects: labels are set as people write them, and nothing of them becomes markup. */
#include "core/file/memory_file.h"
#include "server/show/plot/plot_words.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

static void labels_are_set(void **state) {
    (void)state;
    static const struct {
        const char *label, *out;
    } LABELS[] = {
        {"z/sqrt(m0)", "z/√m₀"},
        {"sqrt(a + b)", "√(a + b)"},
        {"A/A0", "A/A₀"},
        {"k lambda_s", "k λ<tspan class=\"index\" dy=\"3\">s</tspan>"},
        {"h'_rms)", "h′<tspan class=\"index\" dy=\"3\">rms</tspan><tspan dy=\"-3\">)</tspan>"},
        {"C_l = 3", "C<tspan class=\"index\" dy=\"3\">l</tspan> <tspan dy=\"-3\">=</tspan> 3"},
        {"-sqrt(3/m4) kappa", "−√(3/m₄) κ"},
        {"L^-2", "L<tspan class=\"index\" dy=\"-5\">-2</tspan>"},
        {"z''", "z″"},
        {"lambdas alphabet 10 nodes", "lambdas alphabet 10 nodes"},
        {"a < b & c", "a &lt; b &amp; c"},
        {"_x^", "_x^"},
        {"", ""},
    };
    for (size_t n = 0; n < sizeof LABELS / sizeof *LABELS; n++) {
        struct memory_file memory;
        assert_true(memory_file_open(&memory));
        svg_label(memory.file, LABELS[n].label);
        char *text = memory_file_close(&memory, NULL);
        assert_string_equal(text, LABELS[n].out);
        free(text);
    }
}

static void parameters_have_symbols(void **state) {
    (void)state;
    assert_string_equal(plot_symbol("contact", "/surface/hurst"), "H");
    assert_string_equal(plot_symbol("statistics", "/surface/heights/shape"), "C");
    assert_string_equal(plot_symbol("contact", "/surface/dimension"), "dimension");
    assert_string_equal(plot_symbol("no such kind", "/surface/hurst"), "hurst");
    assert_string_equal(plot_symbol(NULL, "/surface/hurst"), "hurst");
    assert_int_equal(plot_letters("lambda_s = 8"), strlen("l_s = 8"));
}

/* Axes over parameters have words, the symbol and the unit; without a row, the name. */
static void parameters_have_labels(void **state) {
    (void)state;
    static const struct {
        const char *kind, *pointer, *label;
    } LABELS[] = {{"contact", "/surface/hurst", "Hurst exponent H"},
                  {"contact", "/surface/length_ratio", "length ratio L/lambda_l"},
                  {"statistics", "/surface/heights/shape", "shape C"},
                  {"statistics", "/surface/dimension", "dimension"},
                  {NULL, "/surface/length_ratio", "length ratio"}};
    char label[80];
    for (size_t n = 0; n < sizeof LABELS / sizeof *LABELS; n++) {
        plot_parameter_label(LABELS[n].kind, LABELS[n].pointer, label, sizeof label);
        assert_string_equal(label, LABELS[n].label);
    }
}

/* The symbol that pictures have leads to the name that commands take. */
static void symbols_are_near_their_parameters(void **state) {
    (void)state;
    struct near_name near = {.typed = "C"};
    plot_near_parameter(&near, "contact", "/surface/hurst");
    assert_null(near.name);
    plot_near_parameter(&near, "contact", "/surface/heights/shape");
    assert_string_equal(near.name, "shape");
}

static void names_are_words(void **state) {
    (void)state;
    static const struct {
        const char *name, *words;
    } NAMES[] = {{"summit_height_pdf", "summit height PDF"},
                 {"persson_light_load", "Persson light load"},
                 {"gw_mccool", "GW McCool"},
                 {"weibull_min", "Weibull min"},
                 {"personal_pdfs", "personal pdfs"},
                 {"_", " "},
                 {"", ""}};
    char words[40];
    for (size_t n = 0; n < sizeof NAMES / sizeof *NAMES; n++) {
        plot_in_words(NAMES[n].name, words, sizeof words);
        assert_string_equal(words, NAMES[n].words);
    }
    plot_in_words("summit_height_pdf", words, sizeof "summit_hei");
    assert_string_equal(words, "summit hei");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(labels_are_set),
        cmocka_unit_test(parameters_have_symbols),
        cmocka_unit_test(parameters_have_labels),
        cmocka_unit_test(symbols_are_near_their_parameters),
        cmocka_unit_test(names_are_words),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
