#!/usr/bin/env python3
"""Draws the tables of growth in schema/README.md: the time of an operation over the studies of a store, and over the cases
of one study, both on logarithmic scales, so that slopes are exponents. Prints the picture, schema/growth.svg.

growth_picture.py README.md
"""
import math
import re
import sys

COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"]
LEFT, TOP, WIDTH, HEIGHT, GAP = 64, 34, 190, 300, 250
DECADES = range(0, 6)  # 1 us to 100 ms


def tables(page):
    """Yields the heading, the sizes and the rows (name, microseconds) of each table with exponents."""
    heading, sizes, rows = None, [], []
    for line in page.splitlines() + [""]:
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if "exponent" in cells:
            heading, last = cells[0], cells.index("exponent")
            sizes, rows = [int(cell.replace(" ", "")) for cell in cells[1:last]], []
        elif heading and line.startswith("| ") and not line.startswith("| ---"):
            name = re.sub(r" \(.*\)", "", cells[0])
            rows.append((name, [float(cell.replace(" ", "")) for cell in cells[1:len(sizes) + 1]]))
        elif heading and not line.startswith("|"):
            yield heading, sizes, rows
            heading = None


def label_heights(wanted):
    """Moves labels that would overlap apart, in order."""
    heights = []
    for y in wanted:
        heights.append(max(y, heights[-1] + 13) if heights else y)
    excess = max(0, heights[-1] - (TOP + HEIGHT + 4))
    for n in range(len(heights) - 1, -1, -1):
        most = heights[n + 1] - 13 if n + 1 < len(heights) else heights[n] - excess
        heights[n] = min(heights[n], most)
    return heights


def panel(left, heading, sizes, rows):
    def x_of(size):
        return left + WIDTH * math.log10(size / sizes[0]) / math.log10(sizes[-1] / sizes[0])

    def y_of(us):
        return TOP + HEIGHT * (1 - math.log10(us) / DECADES[-1])

    print(f'<text class="title" x="{left}" y="18">{heading}</text>')
    for decade in DECADES:
        y = y_of(10**decade)
        words = f"{10**decade} µs" if decade < 3 else f"{10**(decade - 3)} ms"
        print(f'<path class="rule" d="M{left} {y:.1f}h{WIDTH}"/>'
              f'<text class="end" x="{left - 6}" y="{y + 4:.1f}">{words}</text>')
    for size in sizes:
        print(f'<text class="middle" x="{x_of(size):.1f}" y="{TOP + HEIGHT + 18}">{size:,}</text>'.replace(",", " "))
    rows = sorted(rows, key=lambda row: -row[1][-1])
    heights = label_heights([y_of(us[-1]) for _, us in rows])
    for n, ((name, us), y) in enumerate(zip(rows, heights)):
        colour = COLOURS[n % len(COLOURS)]
        points = " ".join(f"{x_of(size):.1f},{y_of(value):.1f}" for size, value in zip(sizes, us))
        dash = ' stroke-dasharray="5 3"' if n >= len(COLOURS) else ""
        end = left + WIDTH
        print(f'<polyline points="{points}" stroke="{colour}"{dash}/>'
              f'<path class="rule" d="M{end + 2} {y_of(us[-1]):.1f}L{end + 12} {y:.1f}"/>'
              f'<text x="{end + 15}" y="{y + 4:.1f}" fill="{colour}">{name}</text>')


def main():
    page = open(sys.argv[1], encoding="utf-8").read()
    print('<svg xmlns="http://www.w3.org/2000/svg" width="940" height="370" font-family="sans-serif" font-size="11">'
          "<style>polyline{fill:none;stroke-width:1.6}.rule{stroke:#ccc;fill:none}.title{font-weight:bold}"
          ".end{text-anchor:end;fill:#555}.middle{text-anchor:middle;fill:#555}</style>"
          '<rect width="940" height="370" fill="#fff"/>')
    for n, (heading, sizes, rows) in enumerate(tables(page)):
        panel(LEFT + n * (WIDTH + GAP), heading, sizes, rows)
    print("</svg>")


if __name__ == "__main__":
    main()
