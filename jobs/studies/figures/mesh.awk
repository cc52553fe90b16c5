# Draws a meshed profile as an SVG, pressed if the file has a step: awk -f mesh.awk block.vtu > mesh.svg
#
# Reads what `rugo generate --mesh` writes: arrays of text, a node or an element a line. Colours show
# the vertical stress, from none (cream) to that of the most compressed hundredth (blue).

/<DataArray/ { match($0, /Name="[^"]*"/); name = substr($0, RSTART + 6, RLENGTH - 7); row = 0; next }
/<\/DataArray/ { name = ""; next }
name == "Points" { x[row] = $1; y[row] = $2; points = ++row; next }
name == "displacement" { x[row] += $1; y[row] += $2; row++; next }
name == "connectivity" { for (a = 1; a <= 4; a++) node[row, a] = $a; cells = ++row; next }
name == "stress" { pressed[row] = sorted[row] = -$2; row++; next }

# The value at position `wanted`, counted from 0, of sorted[0 .. cells) in rising order.
function element_at(wanted,    low, high, i, j, pivot, value) {
    low = 0
    high = cells - 1
    while (low < high) {
        pivot = sorted[wanted]
        i = low
        j = high
        while (i <= j) {
            while (sorted[i] < pivot) i++
            while (pivot < sorted[j]) j--
            if (i <= j) {
                value = sorted[i]
                sorted[i++] = sorted[j]
                sorted[j--] = value
            }
        }
        if (j < wanted) low = i
        if (wanted < i) high = j
    }
    return sorted[wanted]
}

function between(from, to, share) { return int(from + (to - from) * share + 0.5) }

END {
    width = 760
    left = right = x[0]
    low = high = y[0]
    for (n = 1; n < points; n++) {
        if (x[n] < left) left = x[n]
        if (x[n] > right) right = x[n]
        if (y[n] < low) low = y[n]
        if (y[n] > high) high = y[n]
    }
    scale = width / (right - left)
    base = (high - low) * scale
    most = element_at(int(0.99 * cells))
    if (!(most > 0)) most = 1
    printf "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-1 -1 %d %d\">\n", width + 2, int(base + 0.5) + 12
    print "<rect x=\"-1\" y=\"-1\" width=\"100%\" height=\"100%\" fill=\"#fff\"/>"
    print "<g stroke=\"#555\" stroke-width=\".4\">"
    for (e = 0; e < cells; e++) {
        share = pressed[e] / most
        share = share < 0 ? 0 : share > 1 ? 1 : share
        printf "<path d=\"M"
        for (a = 1; a <= 4; a++) {
            n = node[e, a]
            printf "%s%.1f,%.1f", (a > 1 ? " " : ""), (x[n] - left) * scale, (high - y[n]) * scale
        }
        printf "z\" fill=\"#%02x%02x%02x\"/>\n", between(250, 28, share), between(240, 78, share), between(214, 138, share)
    }
    printf "</g>\n<path d=\"M0 %.1fH%d\" stroke=\"#000\" stroke-width=\"3\"/>\n</svg>\n", base + 1.5, width
}
