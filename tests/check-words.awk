# What check-words looks for; its input is the list of what is left, then documents and C files. Prints FILE:LINE: what.

function complain(file, line, what,    entry, best) {
    best = ""
    for (entry in left)
        if ((file == entry || (entry ~ /\/$/ && file ~ /\.[ch]$/ && index(file, entry) == 1)) && length(entry) > length(best))
            best = entry
    if (best != "") {
        dirty[best] = 1
        return
    }
    printf "%s:%d: %s\n", file, line, what
    bad = 1
}

# The phrases in which the words stay what they are in English.
function check_words(text,    word) {
    text = " " tolower(text) " "
    gsub(/by way of|in (its |the |their )?place( of)?|tak(e|es|en|ing) (the |its |their )?place|took place|decimal places?/, " ", text)
    gsub(/[0-9](st|nd|rd|th) edition/, " ", text)
    while (match(text, GIVEN_UP)) {
        word = substr(text, RSTART + 1, RLENGTH - 2)
        text = " " substr(text, RSTART + RLENGTH - 1)
        complain(FILENAME, FNR, "the word \"" word "\" was given up (core/theory/GLOSSARY.md)")
    }
}

# Text without code, pictures and the targets of links; code is one word.
function plain(text) {
    gsub(/``[^`]*``|`[^`]*`/, "x", text)
    gsub(/!\[[^]]*\]\([^)]*\)/, "", text)
    gsub(/\]\([^)]*\)/, "]", text)
    gsub(/<https?:[^>]*>|https?:[^ ]*/, "x", text)
    return text
}

# Each sentence of a paragraph, of a list's item, or of a cell of a table, which may be a list between semicolons.
function check_sentences(text, file, line, ends,    sentence, count, n, word, words, w, length_) {
    gsub(/[.?!][])"*_']*[ \t]+/, "&\001", text)
    if (ends != "") gsub(ends, "&\001", text)
    count = split(text, sentence, "\001")
    for (n = 1; n <= count; n++) {
        length_ = 0
        words = split(sentence[n], word, /[ \t]+/)
        for (w = 1; w <= words; w++)
            if (word[w] ~ /[A-Za-z0-9]/) length_++
        if (length_ > MOST) complain(file, line, "a sentence of " length_ " words: " substr(sentence[n], 1, 60) "...")
    }
}

function end_paragraph() {
    if (paragraph != "") check_sentences(plain(paragraph), document, begun, "")
    paragraph = ""
}

function check_row(row,    cell, count, n) {
    row = plain(row)
    count = split(row, cell, "|")
    for (n = 1; n <= count; n++) check_sentences(cell[n], FILENAME, FNR, ";")
}

# The part of a line of C that is comment.
function comment_of(line,    out, start) {
    out = ""
    while (line != "") {
        if (within) {
            start = index(line, "*/")
            out = out " " (start > 0 ? substr(line, 1, start - 1) : line)
            line = start > 0 ? substr(line, start + 2) : ""
            within = start == 0
        } else {
            gsub(/"([^"\\]|\\.)*"/, "", line)
            start = index(line, "/*")
            line = start > 0 ? substr(line, start + 2) : ""
            within = start > 0
        }
    }
    return out
}

BEGIN {
    MOST = 40
    GIVEN_UP = "[^a-z0-9_](tell|tells|told|telling|soften[a-z]*|stiffen[a-z]*|bridges?|pieces?|ways?|chances?|places?|placed|meters?|" \
        "mend|mends|mended|mending|wish|wishes|wished|errands?|seal|seals|sealed|sealing|editions?)[^a-z0-9_]"
}

FILENAME == list {
    if ($0 !~ /^#/ && $0 != "") left[$0] = 1
    next
}
FNR == 1 {
    end_paragraph()
    code = within = 0
    blank = 1
}
FILENAME ~ /\.[ch]$/ {
    check_words(comment_of($0))
    next
}
/^[ \t]*```/ {
    end_paragraph()
    code = !code
    next
}
code { next }
/^[ \t]*$/ {
    end_paragraph()
    blank = 1
    next
}
/^    / && blank && !item { next } # an indented block
{ blank = 0 }
{ check_words(plain($0)) }
/^\|/ {
    check_row($0)
    next
}
/^#/ {
    end_paragraph()
    item = 0
    next
}
/^[ \t]*([*-]|[0-9]+\.) / {
    end_paragraph()
    item = 1
    sub(/^[ \t]*([*-]|[0-9]+\.) /, "")
}
/^[^ \t]/ && paragraph == "" { item = 0 }
{
    if (paragraph == "") {
        document = FILENAME
        begun = FNR
    }
    paragraph = paragraph (paragraph == "" ? "" : " ") $0
}
END {
    end_paragraph()
    for (entry in left)
        if (!(entry in dirty)) {
            printf "%s: %s is clean, or is not there: take it out\n", list, entry
            bad = 1
        }
    exit bad
}
