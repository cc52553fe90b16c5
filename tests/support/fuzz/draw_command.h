/* Command lines drawn from a command's own table of options, so that a new option is drawn by
 * itself: plausible values, at bounds, beyond them, of another type, given twice, odd texts. What
 * names a file is one of few names in the current folder; no other word has a slash that leads out
 * of it. */
#ifndef RUGO_TESTS_SUPPORT_FUZZ_DRAW_COMMAND_H
#define RUGO_TESTS_SUPPORT_FUZZ_DRAW_COMMAND_H

#include "server/command/options.h"
#include "tests/support/fuzz/choices.h"

/* The files that a line may ask for, ended by NULL: in the current folder, for the caller to
 * remove. */
extern const char *const DRAWN_FILES[];

enum { LINE_MOST = 60 };
struct drawn_line {
    int count;
    char *words[LINE_MOST + 1]; /* owned, ended by NULL; the first is the command */
};
struct line_request { /* borrows */
    const char *command;
    const char *arguments; /* as help shows them: "FILE", "FILE OUT.npy|OUT.csv", "[STUDY.json]" */
    const struct option_row *rows;
    const char *input; /* the word in place of FILE and STUDY.json */
    const char *unit;  /* of lengths in plausible values; "" for none */
};
/* Two thirds of the lines have plausible values alone, which their command may refuse together. */
void draw_line(struct drawn_line *out, struct choices *choices, const struct line_request *request);
void drawn_line_clear(struct drawn_line *line);

#endif
