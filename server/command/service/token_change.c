/* Changes of a file of tokens. */
#include "schema/digest.h"
#include "schema/hex.h"
#include "server/command/service/secret_file.h"
#include "server/command/service/token_file.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { TOKEN_DIGITS = 48 };

/* Makes a token and the line that stands for it, of words that were checked. */
static int make(const char *role, const char *name, char token[TOKEN_DIGITS + 1], char line[256],
                struct error *err) {
    unsigned char digest[DIGEST_SIZE];
    char text[DIGEST_TEXT_SIZE];
    int status = hex_random(token, TOKEN_DIGITS, err);
    if (status != 0)
        return status;
    digest_text(token, digest);
    digest_print(digest, text);
    snprintf(line, 256, "%s:%s:%s\n", role, name, text);
    return 0;
}

/* Reads a file of tokens as it is; "" where there is none. */
static int read_whole(const char *file, char **text, size_t *size, struct error *err) {
    if (access(file, F_OK) == 0)
        return secret_file_read(file, false, text, size, err);
    *size = 0;
    *text = calloc(1, 1);
    return *text != NULL ? 0 : error_memory(err, 1, "a file of tokens");
}

static int append(const char *file, const char *line, struct error *err) {
    char *text = NULL;
    size_t size = 0, length = strlen(line);
    int status = read_whole(file, &text, &size, err);
    if (status != 0)
        return status;
    char *longer = malloc(size + length + 2);
    bool gap = size > 0 && text[size - 1] != '\n';
    if (longer == NULL)
        status = error_memory(err, size + length, "a file of tokens");
    else {
        snprintf(longer, size + length + 2, "%s%s%s", text, gap ? "\n" : "", line);
        status = secret_file_replace(file, longer, strlen(longer), err);
        explicit_bzero(longer, size + length + 2);
    }
    free(longer);
    explicit_bzero(text, size);
    free(text);
    return status;
}

int token_file_add(const char *file, const char *role, const char *name, char **token,
                   struct error *err) {
    char fresh[TOKEN_DIGITS + 1], line[256];
    int status = token_words_check(role, name, err);
    if (status == 0)
        status = make(role, name, fresh, line, err);
    if (status == 0 && (*token = strdup(fresh)) == NULL)
        status = error_memory(err, sizeof fresh, "a token");
    if (status == 0 && (status = append(file, line, err)) != 0) {
        free(*token);
        *token = NULL;
    }
    explicit_bzero(fresh, sizeof fresh);
    return status;
}

/* The names of the lines of a file, in their order. */
struct revocation {
    const char *name;
    bool *gone; /* by the number of the line */
    unsigned count;
};

static int mark(void *context, const struct token_line *line, struct error *err) {
    struct revocation *revocation = context;
    (void)err;
    if (strcmp(line->name, revocation->name) == 0) {
        revocation->gone[line->number] = true;
        revocation->count++;
    }
    return 0;
}

/* Leaves out the lines that are gone, in place. */
static void cut_lines(char *text, const bool *gone) {
    char *to = text;
    size_t number = 0;
    for (const char *from = text; *from != '\0';) {
        size_t length = strcspn(from, "\n");
        length += from[length] == '\n';
        if (!gone[++number]) {
            memmove(to, from, length);
            to += length;
        }
        from += length;
    }
    *to = '\0';
}

int token_file_revoke(const char *file, const char *name, unsigned *count, struct error *err) {
    char *text = NULL;
    size_t size = 0, lines = 2;
    int status = secret_file_read(file, false, &text, &size, err);
    if (status != 0)
        return status;
    for (size_t i = 0; i < size; i++)
        lines += text[i] == '\n';
    struct revocation revocation = {.name = name, .gone = calloc(lines + 1, sizeof(bool))};
    char *copy = strdup(text);
    if (revocation.gone == NULL || copy == NULL)
        status = error_memory(err, size, "a file of tokens");
    else
        status = token_lines_visit(copy, mark, &revocation, err);
    if (status == 0 && revocation.count == 0)
        status = error_set(err, ERROR_ABSENT, "%s holds no token of \"%.40s\"", file, name);
    if (status == 0) {
        cut_lines(text, revocation.gone);
        status = secret_file_replace(file, text, strlen(text), err);
    }
    *count = revocation.count;
    free(revocation.gone);
    free(copy);
    explicit_bzero(text, size);
    free(text);
    return status;
}
