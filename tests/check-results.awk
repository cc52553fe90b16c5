# Compares one number of a table with "value standard-error" in found. heading, table: the table of that number under the
# heading, or of the page where heading is empty; place: "row / column / number", the row by its first cells joined with ", ", the number counted in its cell.
function trim(text) {
    gsub(/^[ ]+|[ ]+$/, "", text)
    return text
}
# The n-th number of a cell goes to `value`, its digits behind the point to `digits`, the error behind "+-" to `error`.
function number_of(cell, n,    count) {
    while (match(cell, /[-+]?[0-9]+(\.[0-9]+)?/)) {
        text = substr(cell, RSTART, RLENGTH)
        cell = substr(cell, RSTART + RLENGTH)
        if (++count == n) {
            value = text + 0
            digits = index(text, ".") ? length(text) - index(text, ".") : 0
            error = match(cell, /^ \+- [0-9.]+/) ? substr(cell, 4, RLENGTH - 3) + 0 : 0
            return 1
        }
        if (match(cell, /^ *\+- [0-9.]+/)) # an error is no number of its own
            cell = substr(cell, RSTART + RLENGTH)
    }
    return 0
}
BEGIN {
    split(place, part, " / ")
    row = trim(part[1]); column = part[2] + 0; number = part[3] + 0
    heading = trim(heading); table = table + 0; inside = heading == ""
    split(found, result, " ")
}
heading != "" && /^#+ / { title = $0; sub(/^#+ /, "", title); inside = title == heading; tables = 0; next }
inside && /^\| *---/ { tables++; next }
inside && tables == table && /^\|/ {
    count = split($0, cells, "|")
    label = ""
    for (c = 2; c < count && label != row; c++)
        label = label (c > 2 ? ", " : "") trim(cells[c])
    if (label == row && number_of(trim(cells[column + 1]), number)) {
        seen = 1
        off = result[1] - value
        allowed = 4 * sqrt(result[2] ^ 2 + error ^ 2) + 0.5 / 10 ^ digits
        if (result[1] == "" || !(off <= allowed && -off <= allowed)) {
            printf "%s, %s table %d, %s, column %d: %s stands there, %s +- %s comes out\n", FILENAME, heading, table, row, column, text, \
                result[1], result[2]
            wrong = 1
        }
        exit
    }
}
END {
    if (!seen)
        printf "%s, %s table %d has no number %d in column %d of \"%s\"\n", FILENAME, heading, table, number, column, row
    exit wrong || !seen
}
