/* Notes: of a case the same are kept whatever the split and the order of merging, no more than
 * NOTES_MOST of them, all counted; bytes that no honest worker sends are refused. */
#include "jobs/notes.h"
#include "schema/json/json.h"
#include "tests/support/check.h"
#include "tests/support/result_tree.h"
#include <stdio.h>
#include <string.h>

/* Realisation r has r % 3 notes. */
static void add_notes(struct notes *notes, uint64_t first, uint64_t end) {
    char text[32];
    for (uint64_t r = first; r < end; r++)
        for (uint64_t n = 0; n < r % 3; n++) {
            snprintf(text, sizeof text, "note %llu of %llu", (unsigned long long)n,
                     (unsigned long long)r);
            notes_add(notes, r, text);
        }
}

static void check_same(const struct notes *notes, const struct notes *expected) {
    assert_int_equal(notes->count, expected->count);
    for (size_t n = 0; n < notes_kept(expected); n++) {
        assert_int_equal(notes->kept[n].realisation, expected->kept[n].realisation);
        assert_string_equal(notes->kept[n].text, expected->kept[n].text);
    }
}

static void any_split_and_order_keeps_the_first(void **state) {
    (void)state;
    struct notes whole = {0};
    add_notes(&whole, 0, 40);
    assert_int_equal(whole.count, 39);
    assert_int_equal(notes_kept(&whole), NOTES_MOST);
    for (uint64_t split = 0; split <= 40; split++) {
        struct notes low = {0}, high = {0}, backwards = {0};
        add_notes(&low, 0, split);
        add_notes(&high, split, 40);
        notes_merge(&backwards, &high);
        notes_merge(&backwards, &low);
        notes_merge(&low, &high);
        check_same(&low, &whole);
        check_same(&backwards, &whole);
    }
}

static void a_long_text_is_cut_and_made_printable(void **state) {
    (void)state;
    struct notes notes = {0};
    char text[2 * NOTE_SIZE];
    memset(text, 'x', sizeof text);
    text[1] = '\n';
    text[2] = '\xff';
    text[sizeof text - 1] = 0;
    notes_add(&notes, 0, text);
    assert_int_equal(strlen(notes.kept[0].text), NOTE_SIZE - 1);
    assert_memory_equal(notes.kept[0].text, "x??x", 4);
}

static struct byte_reader reader_of(const struct bytes *bytes) {
    return (struct byte_reader){bytes->data, bytes->data + bytes->size, false, false};
}

static void notes_come_back(void **state) {
    (void)state;
    for (uint64_t end = 0; end < 40; end += 13) {
        struct notes notes = {0}, back;
        struct bytes bytes = {0};
        add_notes(&notes, 0, end);
        notes_put(&bytes, &notes);
        struct byte_reader reader = reader_of(&bytes);
        notes_get(&reader, &back);
        assert_false(reader.failed);
        assert_ptr_equal(reader.at, reader.end);
        check_same(&back, &notes);
        /* cut anywhere, they are not */
        for (size_t size = 0; size < bytes.size; size++) {
            reader = reader_of(&bytes);
            reader.end = bytes.data + size;
            notes_get(&reader, &back);
            assert_true(reader.failed);
        }
        bytes_clear(&bytes);
    }
}

/* One note after the other; length 0 ends them. */
struct forged {
    uint64_t realisation;
    size_t length;
    uint64_t character;
};

static bool is_taken(const struct forged *forged) {
    struct bytes bytes = {0};
    struct notes notes;
    size_t count = 0;
    while (forged[count].length > 0)
        count++;
    bytes_put_unsigned(&bytes, count);
    for (size_t n = 0; n < count; n++) {
        bytes_put_unsigned(&bytes, forged[n].realisation);
        for (size_t a = 0; a < forged[n].length; a++)
            bytes_put_unsigned(&bytes, forged[n].character);
        bytes_put_unsigned(&bytes, 0);
    }
    struct byte_reader reader = reader_of(&bytes);
    notes_get(&reader, &notes);
    bytes_clear(&bytes);
    return !reader.failed;
}

static void forged_notes_are_refused(void **state) {
    (void)state;
    assert_true(
        is_taken((struct forged[]){{3, NOTE_SIZE - 1, 'a'}, {3, 1, '~'}, {4, 1, ' '}, {0}}));
    assert_false(is_taken((struct forged[]){{3, NOTE_SIZE, 'a'}, {0}}));
    assert_false(is_taken((struct forged[]){{3, 1, 'a'}, {2, 1, 'a'}, {0}}));
    assert_false(is_taken((struct forged[]){{3, 2, '\n'}, {0}}));
    assert_false(is_taken((struct forged[]){{3, 2, 0xe9}, {0}}));
    assert_false(is_taken((struct forged[]){{3, 2, 'a' + 256}, {0}}));
}

static void the_document_tells_them(void **state) {
    (void)state;
    struct notes notes = {0};
    add_notes(&notes, 0, 3);
    struct case_result result = {0};
    struct error err = {0};
    assert_int_equal(notes_result(&notes, &result, &err), 0);
    cJSON *tree = result_tree(&result), *json = cJSON_GetObjectItem(tree, "notes");
    char *text = cJSON_PrintUnformatted(json);
    assert_string_equal(text, "{\"count\":3,\"kept\":[{\"realisation\":1,\"text\":\"note 0 of 1\"},"
                              "{\"realisation\":2,\"text\":\"note 0 of 2\"},"
                              "{\"realisation\":2,\"text\":\"note 1 of 2\"}]}");
    cJSON_free(text);
    cJSON_Delete(tree);
    result_clear(&result);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_split_and_order_keeps_the_first),
        cmocka_unit_test(a_long_text_is_cut_and_made_printable),
        cmocka_unit_test(notes_come_back),
        cmocka_unit_test(forged_notes_are_refused),
        cmocka_unit_test(the_document_tells_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
