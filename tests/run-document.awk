# What run-document asks of awk. pass=cut: the steps of a page, each into a file of its own below `folder`, and a list of
# them: run LINE FILE, serve LINE FILE, show LINE FILE, write LINE FILE NAME. pass=compare: what a page shows, then
# what its commands printed.

# --- cut ---

function fault(what) {
    printf "%s:%d: %s\n", FILENAME, FNR, what >"/dev/stderr"
    bad = 1
}

function begin(step, line, name) {
    steps++
    file = sprintf("%s/%03d", folder, steps)
    printf "" >file
    print step, line, file, name >list
}

# A fence opens; `named` is the last file that the paragraph before it says the text is to be written as.
function open_fence(language) {
    inside = 1
    kind = ""
    if (language == "sh") kind = "run"
    else if ((language == "text" || language == "") && last == "run") kind = "show"
    else if (named != "") kind = "write"
    else if (language == "text" || language == "") fault("no commands stand before what is shown")
    if (kind != "") begin(kind, FNR, named)
    if (kind == "run") commands++
    last = kind
    named = ""
}

pass == "cut" && /^```/ {
    if (inside) inside = 0
    else open_fence(substr($0, 4))
    next
}
pass == "cut" && inside {
    if (kind == "") next
    print >file
    # What follows a server in the background waits until it listens.
    if (kind == "run" && /^rugo serve .*&[ \t]*(#.*)?$/) {
        print "serve", FNR >list
        begin("run", FNR + 1, "")
    }
    next
}
pass == "cut" && /^    / && blank { fault("an indented block is not run: put it between fences") }
pass == "cut" {
    blank = $0 ~ /^[ \t]*$/
    if (blank && named == "") next
    if (!blank && ended) named = ""
    ended = blank
    if (match($0, /as `[A-Za-z0-9_.\/-]+\.(json|py|txt)`/)) named = substr($0, RSTART + 4, RLENGTH - 5)
    if (/^#/) last = ""
}

# --- compare ---

# Numbers are the same within one unit of the last digit that is shown; whole ones are the same.
function same_number(shown, printed,    digits, power) {
    if (shown == printed) return 1
    if (shown !~ /[.e]/) return 0
    power = digits = shown
    if (!sub(/.*e/, "", power)) power = 0
    sub(/e.*/, "", digits)
    digits = digits ~ /\./ ? length(digits) - index(digits, ".") : 0
    return shown - printed <= 1.000001 * 10 ^ (power - digits) && printed - shown <= 1.000001 * 10 ^ (power - digits)
}

function same_word(shown, printed,    one, other, before) {
    if (shown == printed) return 1
    if (match(shown, /\.\.\./)) # whatever stands between
        return length(printed) >= length(shown) - 3 && index(printed, substr(shown, 1, RSTART - 1)) == 1 &&
            substr(printed, length(printed) - length(shown) + RSTART + 3) == substr(shown, RSTART + 3)
    while (match(shown, NUMBER)) {
        one = substr(shown, RSTART, RLENGTH)
        before = substr(shown, 1, RSTART - 1)
        shown = substr(shown, RSTART + RLENGTH)
        if (!match(printed, NUMBER) || substr(printed, 1, RSTART - 1) != before) return 0
        other = substr(printed, RSTART, RLENGTH)
        printed = substr(printed, RSTART + RLENGTH)
        if (!same_number(one, other)) return 0
    }
    return shown == printed
}

# Words from the i-th that is shown and the j-th that was printed on; `...` alone is any number of words.
function same_words(i, j, shown_words, printed_words) {
    for (; i <= shown_words; i++) {
        if (shown_word[i] == "...") {
            for (; j <= printed_words + 1; j++)
                if (same_words(i + 1, j, shown_words, printed_words)) return 1
            return 0
        }
        if (j > printed_words || !same_word(shown_word[i], printed_word[j])) return 0
        j++
    }
    return j > printed_words
}

function same_line(shown, printed) {
    return same_words(1, 1, split(shown, shown_word, /[ \t]+/), split(printed, printed_word, /[ \t]+/))
}

# Lines likewise; `...` alone is any number of lines. farthest: the first line that no attempt came beyond.
function same_lines(i, j) {
    for (; i <= shown_lines; i++) {
        if (i > farthest) {
            farthest = i
            beside = j
        }
        if (shown_line[i] ~ /^[ \t]*\.\.\.[ \t]*$/) {
            for (; j <= printed_lines + 1; j++)
                if (same_lines(i + 1, j)) return 1
            return 0
        }
        if (j > printed_lines || !same_line(shown_line[i], printed_line[j])) return 0
        j++
    }
    if (j <= printed_lines && farthest <= shown_lines) {
        farthest = shown_lines + 1
        beside = j
    }
    return j > printed_lines
}

pass == "compare" { sub(/[ \t]+$/, "") }
pass == "compare" && FILENAME == shown { shown_line[++shown_lines] = $0; next }
pass == "compare" { printed_line[++printed_lines] = $0 }

BEGIN { NUMBER = "[0-9]+([.][0-9]+)?(e[-+]?[0-9]+)?" }
END {
    if (pass == "cut" && commands == 0) fault("the page has no commands")
    if (pass == "compare" && !same_lines(1, 1)) {
        print "  shown:   " (farthest <= shown_lines ? shown_line[farthest] : "(nothing more)")
        print "  printed: " (beside <= printed_lines ? printed_line[beside] : "(nothing more)")
        bad = 1
    }
    exit bad
}
