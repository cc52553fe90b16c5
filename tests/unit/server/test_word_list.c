/* Protects: a list of what is allowed has each word once, also one that is part of another word,
 * and says where it leaves out the rest. */
#include "server/show/word_list.h"
#include "tests/support/check.h"
#include <string.h>

static void words_are_compared_whole(void **state) {
    (void)state;
    static const char *const WORDS[] = {"0.85", "0.8", "85", "0.85", "", NULL, "0", "0.8"};
    char list[64] = "";
    for (size_t w = 0; w < sizeof WORDS / sizeof *WORDS; w++)
        word_list_add(list, sizeof list, ", ", WORDS[w]);
    assert_string_equal(list, "0.85, 0.8, 85, 0");
    *list = '\0';
    word_list_add(list, sizeof list, "; ", "layered nodes 8");
    word_list_add(list, sizeof list, "; ", "layered nodes");
    word_list_add(list, sizeof list, "; ", "nodes 8");
    assert_string_equal(list, "layered nodes 8; layered nodes; nodes 8");
}

static void what_has_no_room_is_said_once(void **state) {
    (void)state;
    for (size_t size = 4; size < 40; size++) {
        char list[40] = "";
        for (int n = 0; n < 5; n++) {
            word_list_append(list, size, ", ", "nodes");
            assert_true(strlen(list) < size);
        }
        const char *more = strstr(list, "...");
        assert_true(size >= sizeof "nodes, nodes, nodes, nodes, nodes, ..." || more != NULL);
        assert_true(more == NULL || more[3] == '\0');
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(words_are_compared_whole),
        cmocka_unit_test(what_has_no_room_is_said_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
