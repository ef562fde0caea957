"""Log-log charts as SVG, without any library."""
import html
import math

# Okabe and Ito, without the yellow that paper swallows; with the five marks no two of 35 lines look alike, in grey
# neither.
COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#000000", "#e69f00", "#56b4e9"]
MARKS = ["M-3 -3h6v6h-6z", "M0 -4L4 3H-4z", "M0 -4.2L4.2 0L0 4.2L-4.2 0z", "M-3 -3L3 3M-3 3L3 -3", "M-3.2 0a3.2 3.2 0 1 0 6.4 0a3.2 3.2 0 1 0 -6.4 0z"]


def mark(k, x, y):
    colour = COLOURS[k % len(COLOURS)]
    return f'<path transform="translate({x:.1f} {y:.1f})" d="{MARKS[k % len(MARKS)]}" stroke="{colour}" fill="{colour}"/>'


def decades(values):
    low, high = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))
    return low, max(high, low + 1)


def power(k):
    return f"{10.0 ** k:g}" if -3 <= k <= 3 else f"1e{k}"


def loglog(path, title, x_label, y_label, series):
    """series: [(name, [(x, y), ...], dashed)]; points that are not positive are left out."""
    series = [(name, [(x, y) for x, y in points if x > 0 and y > 0], dashed) for name, points, dashed in series]
    series = [s for s in series if s[1]]
    if not series:
        return False
    width, height, left, top, bottom, legend = 840, max(460, 60 + 18 * len(series)), 70, 36, 52, 290
    x0, x1 = decades([x for _, points, _ in series for x, _ in points])
    y0, y1 = decades([y for _, points, _ in series for _, y in points])
    right = width - legend
    at_x = lambda x: left + (math.log10(x) - x0) / (x1 - x0) * (right - left)
    at_y = lambda y: height - bottom - (math.log10(y) - y0) / (y1 - y0) * (height - bottom - top)
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="12">',
        f'<rect width="{width}" height="{height}" fill="white"/>',
        f'<text x="{left}" y="22" font-size="14">{html.escape(title)}</text>',
    ]
    for k in range(x0, x1 + 1):
        x = at_x(10.0**k)
        out.append(f'<path d="M{x:.1f} {top}V{height - bottom}" stroke="#ddd"/>')
        out.append(f'<text x="{x:.1f}" y="{height - bottom + 16}" text-anchor="middle">{power(k)}</text>')
    for k in range(y0, y1 + 1):
        y = at_y(10.0**k)
        out.append(f'<path d="M{left} {y:.1f}H{right}" stroke="#ddd"/>')
        out.append(f'<text x="{left - 6}" y="{y + 4:.1f}" text-anchor="end">{power(k)}</text>')
    out.append(f'<text x="{(left + right) / 2:.0f}" y="{height - 14}" text-anchor="middle">{html.escape(x_label)}</text>')
    middle = (top + height - bottom) / 2
    out.append(f'<text x="16" y="{middle:.0f}" transform="rotate(-90 16 {middle:.0f})" text-anchor="middle">{html.escape(y_label)}</text>')
    for k, (name, points, dashed) in enumerate(series):
        colour = COLOURS[k % len(COLOURS)]
        dash = ' stroke-dasharray="5 3"' if dashed else ""
        line = "L".join(f"{at_x(x):.1f} {at_y(y):.1f}" for x, y in points)
        out.append(f'<path d="M{line}" fill="none" stroke="{colour}" stroke-width="1.8"{dash}/>')
        out += [mark(k, at_x(x), at_y(y)) for x, y in points]
        y = top + 12 + 18 * k
        out.append(f'<path d="M{right + 12} {y - 4}h22" stroke="{colour}" stroke-width="2"{dash}/>')
        out.append(mark(k, right + 23, y - 4))
        out.append(f'<text x="{right + 40}" y="{y}">{html.escape(name)}</text>')
    out.append("</svg>\n")
    path.write_text("\n".join(out))
    return True
