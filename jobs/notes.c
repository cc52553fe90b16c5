#include "jobs/notes.h"

static bool is_printable(uint64_t character) {
    return character >= ' ' && character <= '~';
}

void notes_add(struct notes *notes, uint64_t realisation, const char *text) {
    if (notes->count++ >= NOTES_MOST)
        return;
    struct note *note = &notes->kept[notes->count - 1];
    size_t length = 0;
    for (; text[length] != 0 && length + 1 < NOTE_SIZE; length++)
        note->text[length] = is_printable((unsigned char)text[length]) ? text[length] : '?';
    note->text[length] = 0;
    note->realisation = realisation;
}

void notes_merge(struct notes *into, const struct notes *from) {
    struct notes merged = {.count = into->count + from->count};
    size_t a = 0, b = 0;
    for (size_t n = 0; n < notes_kept(&merged); n++) {
        bool ours = b == notes_kept(from) ||
                    (a < notes_kept(into) && into->kept[a].realisation < from->kept[b].realisation);
        merged.kept[n] = ours ? into->kept[a++] : from->kept[b++];
    }
    *into = merged;
}

/* A text ends with 0; its characters take a byte each. */
void notes_put(struct bytes *bytes, const struct notes *notes) {
    bytes_put_unsigned(bytes, notes->count);
    for (size_t n = 0; n < notes_kept(notes); n++) {
        const char *text = notes->kept[n].text;
        bytes_put_unsigned(bytes, notes->kept[n].realisation);
        do
            bytes_put_unsigned(bytes, (unsigned char)*text);
        while (*text++ != 0);
    }
}

static void get_text(struct byte_reader *reader, char text[NOTE_SIZE]) {
    for (size_t length = 0; length < NOTE_SIZE && !reader->failed; length++) {
        uint64_t character = bytes_get_unsigned(reader);
        text[length] = (char)character;
        if (character == 0)
            return;
        if (!is_printable(character))
            break;
    }
    text[0] = 0;
    reader->failed = true;
}

void notes_get(struct byte_reader *reader, struct notes *notes) {
    uint64_t last = 0;
    *notes = (struct notes){.count = bytes_get_unsigned(reader)};
    for (size_t n = 0; n < notes_kept(notes) && !reader->failed; n++) {
        struct note *note = &notes->kept[n];
        note->realisation = bytes_get_unsigned(reader);
        get_text(reader, note->text);
        if (note->realisation < last)
            reader->failed = true;
        last = note->realisation;
    }
}

int notes_result(const struct notes *notes, struct case_result *out, struct error *err) {
    size_t count = notes_kept(notes);
    out->notes = result_room(out, count + 1, sizeof *out->notes);
    bool done = out->notes != NULL;
    for (size_t n = 0; n < count && done; n++) {
        out->notes[n].realisation = notes->kept[n].realisation;
        out->notes[n].text = result_text(out, notes->kept[n].text);
        done = out->notes[n].text != NULL;
    }
    if (!done)
        return error_set(err, ERROR_MEMORY, "no memory left for notes");
    out->note_count = count;
    out->notes_all = notes->count;
    return 0;
}
