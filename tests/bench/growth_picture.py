#!/usr/bin/env python3
"""Draws the tables of growth of a page: what an operation takes over the sizes, both on logarithmic scales, so that slopes are
exponents. A table has a column "exponent" behind its sizes. Its first heading names the sizes, and behind a comma the unit of
the values (us where there is none). Prints the picture, growth.svg beside the page, two tables a row.

growth_picture.py PAGE
"""
import math
import re
import sys

COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"]
LEFT, TOP, WIDTH, HEIGHT, GAP, BELOW = 64, 34, 190, 300, 250, 36
UNITS = {"us": ["µs", "ms", "s"], "ms": ["µs", "ms", "s"], "MB": ["kB", "MB", "GB"]}


def number(cell):
    """None of "-", what was not measured."""
    return None if cell == "-" else float(cell.replace(" ", ""))


def tables(page):
    """Yields the heading, the unit, the sizes and the rows (name, values, exponent) of each table with exponents."""
    heading, unit, sizes, rows = None, "us", [], []
    for line in page.splitlines() + [""]:
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if "exponent" in cells:
            heading, _, unit = cells[0].replace("`", "").partition(", ")
            last = cells.index("exponent")
            sizes, rows = [int(number(cell)) for cell in cells[1:last]], []
        elif heading and line.startswith("| ") and not line.startswith("| ---"):
            name = re.sub(r" \(.*\)|`", "", cells[0])
            rows.append((name, [number(cell) for cell in cells[1:len(sizes) + 1]], cells[len(sizes) + 1]))
        elif heading and not line.startswith("|"):
            yield heading, unit or "us", sizes, rows
            heading = None


def label_heights(wanted, top):
    """Moves labels that would overlap apart, in order."""
    heights = []
    for y in wanted:
        heights.append(max(y, heights[-1] + 13) if heights else y)
    excess = max(0, heights[-1] - (top + HEIGHT + 4))
    for n in range(len(heights) - 1, -1, -1):
        most = heights[n + 1] - 13 if n + 1 < len(heights) else heights[n] - excess
        heights[n] = min(heights[n], most)
    return heights


def size_text(size):
    """10 000, or 16k of powers of two, which have no such round numbers."""
    if size < 1024 or size % 1024:
        return f"{size:,}".replace(",", " ")
    return f"{size >> 10}k" if size < 1 << 20 else f"{size >> 20}M"


def decade_text(decade, unit):
    """A power of ten of the unit, by the prefix that suits it: 10 µs for 0.01 ms."""
    names = UNITS[unit]
    power = decade + (0 if unit == "us" else 3)
    prefix = min(max(power // 3, 0), 2)
    return f"{10.0 ** (power - 3 * prefix):g} {names[prefix]}"


def panel(left, top, table):
    heading, unit, sizes, rows = table
    rows = [(name, [pair for pair in zip(sizes, values) if pair[1]], exponent) for name, values, exponent in rows]
    every = [value for _, pairs, _ in rows for _, value in pairs]
    low, high = math.floor(math.log10(min(every))), math.ceil(math.log10(max(every)))

    def x_of(size):
        return left + WIDTH * math.log10(size / sizes[0]) / math.log10(sizes[-1] / sizes[0])

    def y_of(value):
        return top + HEIGHT * (high - math.log10(value)) / (high - low)

    title = heading + (": memory" if unit == "MB" else ": time" if unit == "ms" else "")
    print(f'<text class="title" x="{left}" y="{top - 16}">{title}</text>')
    for decade in range(low, high + 1):
        y = y_of(10.0**decade)
        print(f'<path class="rule" d="M{left} {y:.1f}h{WIDTH}"/>'
              f'<text class="end" x="{left - 6}" y="{y + 4:.1f}">{decade_text(decade, unit)}</text>')
    for size in sizes:
        print(f'<text class="middle" x="{x_of(size):.1f}" y="{top + HEIGHT + 18}">{size_text(size)}</text>')
    order = sorted(range(len(rows)), key=lambda n: -rows[n][1][-1][1])
    heights = label_heights([y_of(rows[n][1][-1][1]) for n in order], top)
    for n, y in zip(order, heights):
        name, pairs, exponent = rows[n]
        colour = COLOURS[n % len(COLOURS)]
        points = " ".join(f"{x_of(size):.1f},{y_of(value):.1f}" for size, value in pairs)
        dash = ' stroke-dasharray="5 3"' if n >= len(COLOURS) else ""
        end, last = left + WIDTH, pairs[-1]
        print(f'<polyline points="{points}" stroke="{colour}"{dash}/>'
              f'<path class="rule" d="M{x_of(last[0]) + 2:.1f} {y_of(last[1]):.1f}L{end + 12} {y:.1f}"/>'
              f'<text x="{end + 15}" y="{y + 4:.1f}" fill="{colour}">{name}: {exponent}</text>')


def main():
    with open(sys.argv[1], encoding="utf-8") as page:
        drawn = list(tables(page.read()))
    height = (len(drawn) + 1) // 2 * (TOP + HEIGHT + BELOW)
    print(f'<svg xmlns="http://www.w3.org/2000/svg" width="940" height="{height}" font-family="sans-serif" font-size="11">'
          "<style>polyline{fill:none;stroke-width:1.6}.rule{stroke:#ccc;fill:none}.title{font-weight:bold}"
          ".end{text-anchor:end;fill:#555}.middle{text-anchor:middle;fill:#555}</style>"
          f'<rect width="940" height="{height}" fill="#fff"/>')
    for n, table in enumerate(drawn):
        panel(LEFT + n % 2 * (WIDTH + GAP), TOP + n // 2 * (TOP + HEIGHT + BELOW), table)
    print("</svg>")


if __name__ == "__main__":
    main()
