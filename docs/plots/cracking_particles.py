"""Draws docs/src/images/cracking-particles.svg: particles on a kinked crack and their bilinear segments.

Run from anywhere: python3 docs/plots/cracking_particles.py
"""

import math
from pathlib import Path

WIDTH, HEIGHT = 640, 300
SPACING = 52
CRACK = [(0, 190), (200, 176), (330, 100), (470, 112)]
COLORS = ["#0072b2", "#d55e00"]


def along(path, spacing):
    """Particles at the vertices, and at about the spacing between them."""
    places = [path[0]]
    for (ax, ay), (bx, by) in zip(path, path[1:]):
        n = round(math.hypot(bx - ax, by - ay) / spacing)
        places += [(ax + (bx - ax) * k / n, ay + (by - ay) * k / n) for k in range(1, n + 1)]
    return places


def distance(p, path):
    """Distance of a point from a polyline."""
    least = math.inf
    for (ax, ay), (bx, by) in zip(path, path[1:]):
        ex, ey = bx - ax, by - ay
        t = min(1, max(0, ((p[0] - ax) * ex + (p[1] - ay) * ey) / (ex * ex + ey * ey)))
        least = min(least, math.hypot(p[0] - ax - t * ex, p[1] - ay - t * ey))
    return least


def middle(a, b):
    return ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)


def main():
    particles = along(CRACK, SPACING)
    parts = []
    for i in range(WIDTH // SPACING + 1):
        for j in range(HEIGHT // SPACING + 1):
            p = (10 + i * SPACING, 14 + j * SPACING)
            if distance(p, CRACK) > 0.4 * SPACING:
                parts.append(f'<circle cx="{p[0]}" cy="{p[1]}" r="3.5" fill="#999"/>')
    for k, p in enumerate(particles):
        ends = [middle(particles[m], p) for m in (k - 1,) if k > 0] + [p]
        ends += [middle(p, particles[k + 1])] if k + 1 < len(particles) else []
        points = " ".join(f"{x:.1f},{y:.1f}" for x, y in ends)
        color = COLORS[k % 2]
        parts.append(f'<polyline points="{points}" fill="none" stroke="{color}" stroke-width="5"/>')
    for k, (x, y) in enumerate(particles):
        color = COLORS[k % 2]
        if k + 1 == len(particles):
            parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="7" fill="white" stroke="{color}" stroke-width="3"/>')
            continue
        a = particles[max(k - 1, 0)]
        b = particles[k + 1]
        length = math.hypot(b[0] - a[0], b[1] - a[1])
        nx, ny = -(b[1] - a[1]) / length, (b[0] - a[0]) / length
        for side in (9, -9):
            parts.append(f'<circle cx="{x + side * nx:.1f}" cy="{y + side * ny:.1f}" r="4.5" fill="{color}"/>')
    style = 'font-family="sans-serif" font-size="15" fill="#222"'
    parts.append(f'<text x="{particles[-1][0] + 14:.0f}" y="{particles[-1][1] + 22:.0f}" {style}>tip: one particle</text>')
    parts.append(f'<text x="222" y="253" {style}>a segment with a kink at its particle</text>')
    parts.append('<path d="M280 238 L210 186" stroke="#222" fill="none"/>')
    text = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}">'
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>\n' + "\n".join(parts) + "\n</svg>\n"
    )
    target = Path(__file__).resolve().parents[1] / "src/images/cracking-particles.svg"
    target.write_text(text)
    print(f"wrote {target}")


if __name__ == "__main__":
    main()
