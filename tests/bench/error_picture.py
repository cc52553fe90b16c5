#!/usr/bin/env python3
"""Draws the table of contact at equal error of a page (jobs/studies/VALIDATION.md): how far areas are from their limit over the
CPU time that each code takes, both on logarithmic scales. Prints the picture.

error_picture.py PAGE
"""
import math
import sys

LEFT, TOP, WIDTH, HEIGHT = 64, 24, 420, 300
# A line: its name, the columns of its error and of its time, its colour, how far down its name stands.
LINES = [("Rugo, edges", "`edges`", "Rugo", "#0072b2", 4),
         ("Rugo, nodes", "nodes in contact, by each code", "Rugo", "#56b4e9", 4),
         ("Tamaas, nodes", "nodes in contact, by each code", "Tamaas 1e-4", "#d55e00", 18),
         ("ContactMechanics, nodes", "nodes in contact, by each code", "ContactMechanics", "#009e73", 4)]


def table(page):
    """The heading and the rows of the one table whose first heading begins so."""
    lines = iter(page.splitlines())
    for line in lines:
        if line.startswith("| points a shortest wave, nodes a side |"):
            break
    else:
        sys.exit("error_picture: the page has no table of contact at equal error")
    cells = lambda text: [cell.strip() for cell in text.strip("|").split("|")]
    heading = cells(line)
    rows = []
    for line in lines:
        if not line.startswith("|"):
            break
        if not line.startswith("| ---"):
            rows.append(dict(zip(heading, cells(line))))
    return rows


def decades(values):
    return math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))


def main():
    with open(sys.argv[1], encoding="utf-8") as page:
        rows = table(page.read())
    number = lambda row, column: float(row[column].split()[0])
    points = {name: [(number(row, time), number(row, error)) for row in rows] for name, error, time, _, _ in LINES}
    every = [point for line in points.values() for point in line]
    x0, x1 = decades([time for time, _ in every])
    y0, y1 = decades([error for _, error in every])
    x_of = lambda time: LEFT + WIDTH * (math.log10(time) - x0) / (x1 - x0)
    y_of = lambda error: TOP + HEIGHT * (y1 - math.log10(error)) / (y1 - y0)
    width, height = LEFT + WIDTH + 170, TOP + HEIGHT + 48
    print(f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" font-size="11">'
          "<style>polyline{fill:none;stroke-width:1.6}.rule{stroke:#ccc;fill:none}.end{text-anchor:end;fill:#555}"
          ".middle{text-anchor:middle;fill:#555}</style>"
          f'<rect width="{width}" height="{height}" fill="#fff"/>')
    for decade in range(y0, y1 + 1):
        y = y_of(10.0**decade)
        print(f'<path class="rule" d="M{LEFT} {y:.1f}h{WIDTH}"/><text class="end" x="{LEFT - 6}" y="{y + 4:.1f}">'
              f"{10.0 ** decade:g} %</text>")
    for decade in range(x0, x1 + 1):
        x = x_of(10.0**decade)
        print(f'<path class="rule" d="M{x:.1f} {TOP}v{HEIGHT}"/><text class="middle" x="{x:.1f}" y="{TOP + HEIGHT + 18}">'
              f"{10.0 ** decade:g} s</text>")
    print(f'<text class="middle" x="{LEFT + WIDTH / 2}" y="{TOP + HEIGHT + 38}">CPU time of three loads</text>'
          f'<text x="{LEFT}" y="{TOP - 8}" fill="#555">area less its limit, over it; marks: '
          f"{', '.join(row[next(iter(row))].split(',')[0] for row in rows)} points a shortest wave</text>")
    for name, _, _, colour, down in LINES:
        line = [(x_of(time), y_of(error)) for time, error in points[name]]
        print(f'<polyline points="{" ".join(f"{x:.1f},{y:.1f}" for x, y in line)}" stroke="{colour}"/>')
        for x, y in line:
            print(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2.5" fill="{colour}"/>')
        x, y = line[-1]
        print(f'<text x="{x + 8:.1f}" y="{y + down:.1f}" fill="{colour}">{name}</text>')
    print("</svg>")


if __name__ == "__main__":
    main()
