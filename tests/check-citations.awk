# What check-citations looks for; its input is the files of the tree, the documents that others cite first.

function complain(what) {
    if ((FILENAME, what) in told) return
    told[FILENAME, what] = 1
    printf "%s:%d: %s\n", FILENAME, FNR, what
    bad = 1
}

# --- what there is ---

# The anchor that a heading gets.
function anchor_of(heading) {
    heading = tolower(heading)
    gsub(/[^a-z0-9 _-]/, "", heading)
    gsub(/ /, "-", heading)
    return heading
}

# Numbers such as 3.14 to 3.19 or 2.17, 2.18 in a text, each put into known.
function take_numbers(text, known,    number, last, range, n) {
    last = 0
    while (match(text, /[2-4]\.[0-9]+/)) {
        number = substr(text, RSTART, RLENGTH)
        range = substr(text, 1, RSTART - 1) ~ /^[a-e]?( to |-)$/
        text = substr(text, RSTART + RLENGTH)
        known[number] = 1
        split(number, part, ".")
        if (range && last > 0)
            for (n = last; n < part[2]; n++) known[part[1] "." n] = 1
        last = part[2] + 0
    }
}

# `**A, B & C (1999).**`: each name with that year belongs to the entry.
function take_entry(line,    year, names, count, n) {
    if (!match(line, /\((18|19|20)[0-9][0-9]\)/)) return
    year = substr(line, RSTART + 1, 4)
    names = substr(line, 5, RSTART - 6)
    sub(/ et al\.$/, "", names)
    count = split(names, name, /, | & /)
    for (n = 1; n <= count; n++) {
        entry[name[n], year] = 1
        sub(/.* /, "", name[n]) # Van Loan
        entry[name[n], year] = 1
    }
}

# --- one line, in context ---

# Without the leader of a comment or of a quotation.
function strip(line) {
    sub(/^[ \t]*(\/\*+|\*\/|\*|\/\/|#+|--|>)?[ \t]*/, "", line)
    sub(/[ \t]*(\*\/)?[ \t]*$/, "", line)
    return line
}

# The part of a C line that is comment; elsewhere all of it.
function comment_of(line,    out, start) {
    if (FILENAME !~ /\.(c|h|inc)$/) return line
    out = ""
    if (within) {
        if (!match(line, /\*\//)) return line
        out = substr(line, 1, RSTART - 1)
        line = substr(line, RSTART + 2)
        within = 0
    }
    while ((start = index(line, "/*")) > 0) {
        line = substr(line, start + 2)
        if (match(line, /\*\//)) {
            out = out " " substr(line, 1, RSTART - 1)
            line = substr(line, RSTART + 2)
        } else {
            within = 1
            return out " " line
        }
    }
    return out
}

function folder_of(path) { return match(path, /.*\//) ? substr(path, 1, RLENGTH) : "" }

# A path without . and .. in it.
function normal(path,    n, count, out, piece) {
    count = split(path, piece, "/")
    out = ""
    for (n = 1; n <= count; n++) {
        if (piece[n] == "." || piece[n] == "") continue
        if (piece[n] == "..") sub(/\/?[^\/]*$/, "", out)
        else out = out (out == "" ? "" : "/") piece[n]
    }
    return out
}

function is_cited_file(token) {
    return (token in file) || (normal(folder_of(FILENAME) token) in file) || (token in ending)
}

# Documents and sources named in a text.
function check_files(text,    token, base) {
    while (match(text, /[A-Za-z0-9_.\/*-]+\.(md|c|h|inc|sql|yaml|awk|py|json|svg)/)) {
        token = substr(text, RSTART, RLENGTH)
        text = substr(text, RSTART + RLENGTH)
        if (text ~ /^[A-Za-z0-9_(]/) continue # part of something longer
        if (token ~ /[*]/ || token ~ /^\// || token ~ /^(Random123|suitesparse|unistring)\//) continue
        base = token
        sub(/.*\//, "", base)
        if (base ~ /(NAME|FILE|STUDY|NNN)\./) continue # whatever the reader puts there
        # Files of users have these endings too.
        if (token ~ /\.(json|svg|py|sql|yaml)$/ && token !~ /^(core|schema|jobs|worker|server|tests)\//) continue
        # Migrations stay to the letter: what they name may have moved to another folder since.
        if (FILENAME ~ /\/migrations\// && base in ending) continue
        if (!is_cited_file(token)) complain("there is no file " token)
    }
}

function check_links(line,    target, path, anchor) {
    while (match(line, /\]\([^) ]+\)/)) {
        target = substr(line, RSTART + 2, RLENGTH - 3)
        line = substr(line, RSTART + RLENGTH)
        if (target ~ /^[a-z]+:/) continue
        path = anchor = target
        sub(/#.*/, "", path)
        if (!sub(/^[^#]*#/, "", anchor)) anchor = ""
        path = path == "" ? FILENAME : normal(folder_of(FILENAME) path)
        if (!(path in file) && !(path in folder)) complain("the link " target " leads nowhere")
        else if (anchor != "" && !((path, anchor) in heading)) complain("there is no heading for the link " target)
    }
}

# FORMULAS.md, section 3; F3.1; (2.50), (3.14-3.19) of the reference; Table 3.1.
function check_numbers(text,    all, cited, document, number, label, n) {
    all = text
    while (match(text, /[A-Z]+\.md,? (section|sections) [0-9]+/)) {
        cited = substr(text, RSTART, RLENGTH)
        text = substr(text, RSTART + RLENGTH)
        document = number = cited
        sub(/\.md.*/, ".md", document)
        sub(/.* /, "", number)
        if (!((document, number) in section)) complain(document " has no section " number)
    }
    text = " " all
    while (match(text, /[^A-Za-z0-9%.]F[0-9]+\.[0-9]+/)) {
        label = substr(text, RSTART + 1, RLENGTH - 1)
        text = substr(text, RSTART + RLENGTH)
        if (!(label in formula)) complain("FORMULAS.md has no " label)
    }
    text = all
    while (match(text, /(reference('s)?,? (equations? |eqs?\. ?)?\(?[2-4]\.[0-9]+|\([2-4]\.[0-9]+)[0-9a-e.,-]*(( to |, |-)[2-4]\.[0-9]+[a-e]?)*/)) {
        cited = substr(text, RSTART, RLENGTH)
        text = substr(text, RSTART + RLENGTH)
        # A number of three digits, or not alone in its brackets.
        if (cited ~ /[0-9]\.[0-9][0-9][0-9]/ || (cited ~ /^\(/ && text !~ /^\)/)) continue
        split("", wanted)
        take_numbers(cited, wanted)
        for (n in wanted)
            if (!(n in equation)) complain("FORMULAS.md names no equation " n " of the reference")
    }
    text = all
    while (match(text, /Tables? [0-9]\.[0-9]+/)) {
        cited = substr(text, RSTART, RLENGTH)
        text = substr(text, RSTART + RLENGTH)
        sub(/^Tables? /, "", cited)
        if (!(cited in table)) complain("BIBLIOGRAPHY.md names no Table " cited " of the reference")
    }
}

function is_name(word) {
    return word ~ /^[A-Z][a-z]/ && \
        word !~ /^(In|Of|By|At|On|Since|Until|About|From|To|And|The|January|February|March|April|May|June|July|August|September|October|November|December|Copyright|Debian|Version)$/
}

# Author (1999), Author & Author 1999, Author's (1999), Author et al. (1999) that begin in the first `length` characters.
function check_authors(text, most,    start, cited, year, names, count, n, offset, word) {
    offset = 0
    while (match(text, /[A-Z][A-Za-z-]+( (&|and) [A-Z][A-Za-z-]+)?('s| et al\.)?,? \(?(18|19|20)[0-9][0-9]/)) {
        start = offset + RSTART
        cited = substr(text, RSTART, RLENGTH)
        offset += RSTART + RLENGTH - 1
        text = substr(text, RSTART + RLENGTH)
        if (start > most) return
        if (text ~ /^([0-9x]|\.[0-9])/) continue
        year = substr(cited, length(cited) - 3)
        names = cited
        sub(/('s| et al\.)?,? \(?[0-9]+$/, "", names)
        count = split(names, word, / & | and /)
        if (!is_name(word[count])) continue
        for (n = 1; n <= count; n++)
            if (!((word[n], year) in entry)) {
                complain("BIBLIOGRAPHY.md has no " names " (" year ")")
                break
            }
    }
}

function check_paths(line) {
    if (match(line, /\/(home|root|work|Users)\/[A-Za-z0-9._-]+/))
        complain("a path of one machine: " substr(line, RSTART, RLENGTH))
}

# `name()` in a document is a function of the program.
function check_functions(line,    name) {
    while (match(line, /`[a-z0-9_]+\(\)`/)) {
        name = substr(line, RSTART + 1, RLENGTH - 4)
        line = substr(line, RSTART + RLENGTH)
        if (!(name in defined)) complain("there is no function " name "()")
    }
}

# --- the first reading: what there is ---

pass == "files" {
    file[$0] = 1
    path = $0
    while (sub(/\/[^\/]*$/, "", path)) folder[path] = 1
    path = $0
    while (sub(/^[^\/]*\//, "", path)) ending[path] = 1
    next
}
pass == "known" {
    base = FILENAME
    sub(/.*\//, "", base)
    if (FILENAME ~ /\.md$/ && /^#+ /) {
        title = $0
        sub(/^#+ /, "", title)
        heading[FILENAME, anchor_of(title)] = 1
        if (title ~ /^[0-9]+\.? /) section[base, title + 0] = 1
    }
    if (base == "FORMULAS.md") {
        if (match($0, /\*\*F[0-9]+\.[0-9]+\*\*/)) formula[substr($0, RSTART + 2, RLENGTH - 4)] = 1
        text = held $0
        held = ""
        while (match(text, /reference, [^);]*[);]/)) {
            cited = substr(text, RSTART, RLENGTH)
            text = substr(text, RSTART + RLENGTH)
            take_numbers(cited, equation)
        }
        if (match(text, /\(reference,.*$/)) held = substr(text, RSTART) " "
        else if (text ~ /\(reference, *$/) held = text " "
    }
    if (base == "BIBLIOGRAPHY.md") {
        if (/^\* \*\*/) take_entry($0)
        text = $0
        while (match(text, /Table [0-9]\.[0-9]+/)) {
            table[substr(text, RSTART + 6, RLENGTH - 6)] = 1
            text = substr(text, RSTART + RLENGTH)
        }
    }
    if (FILENAME ~ /^(core|schema|jobs|worker|server)\/.*\.[ch]$/) {
        text = $0
        while (match(text, /[a-z0-9_]+\(/)) {
            defined[substr(text, RSTART, RLENGTH - 1)] = 1
            text = substr(text, RSTART + RLENGTH)
        }
    }
    next
}

# --- the second: what is cited ---

FNR == 1 { finish(); within = 0; before = ""; current = FILENAME }
{
    check_paths($0)
    if (FILENAME ~ /\.md$/) {
        check_links($0)
        check_functions($0)
    }
    text = /^#include/ ? "" : strip(comment_of($0))
    check_files(text)
    check_numbers(text)
    if (before != "") check_authors(before " " text, length(before))
    before = text
}
function finish() {
    if (before != "") check_authors(before, length(before))
}
END { finish(); exit bad }
