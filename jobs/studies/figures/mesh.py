#!/usr/bin/env python3
"""Draws a meshed profile as an SVG, pressed if the file has a step: mesh.py block.vtu > mesh.svg

Colours tell the vertical stress, from the most compressed (blue) to none (cream).
"""
import re
import sys

WIDTH = 760


def numbers(text, name):
    match = re.search(r'<DataArray[^>]*Name="%s"[^>]*>([^<]*)<' % name, text)
    return [float(word) for word in match.group(1).split()] if match else None


def rows(values, size):
    return [values[i:i + size] for i in range(0, len(values), size)]


def colour(share):
    """From cream to blue."""
    low, high = (250, 240, 214), (28, 78, 138)
    return "#%02x%02x%02x" % tuple(round(a + (b - a) * share) for a, b in zip(low, high))


def main():
    text = open(sys.argv[1], encoding="ascii").read()
    points = rows(numbers(text, "Points"), 3)
    moved = rows(numbers(text, "displacement") or [0] * (3 * len(points)), 3)
    cells = rows([int(n) for n in numbers(text, "connectivity")], 4)
    stress = rows(numbers(text, "stress") or [0] * (3 * len(cells)), 3)
    places = [(p[0] + u[0], p[1] + u[1]) for p, u in zip(points, moved)]
    left, right = min(x for x, _ in places), max(x for x, _ in places)
    low, high = min(y for _, y in places), max(y for _, y in places)
    scale = WIDTH / (right - left)
    most = sorted(-s[1] for s in stress)[int(0.99 * len(stress))] or 1
    print('<svg xmlns="http://www.w3.org/2000/svg" viewBox="-1 -1 %d %d">'
          % (WIDTH + 2, round((high - low) * scale) + 12))
    print('<rect x="-1" y="-1" width="100%" height="100%" fill="#fff"/>')
    print('<g stroke="#555" stroke-width=".4">')
    for cell, s in zip(cells, stress):
        corners = " ".join("%.1f,%.1f" % ((places[n][0] - left) * scale,
                                          (high - places[n][1]) * scale) for n in cell)
        print('<path d="M%sz" fill="%s"/>' % (corners, colour(min(1, max(0, -s[1] / most)))))
    base = (high - low) * scale
    print('</g>\n<path d="M0 %.1fH%d" stroke="#000" stroke-width="3"/>\n</svg>' % (base + 1.5, WIDTH))


if __name__ == "__main__":
    main()
