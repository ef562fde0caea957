"""Log-log charts as SVG, without any library."""
import html
import math

# Okabe and Ito (2008): colour-blind readers can tell them apart.
COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#000000", "#e69f00", "#56b4e9"]
# About their middle, 4 px each way; the last three are lines and have no inside.
MARKERS = [
    "M-3.5 0a3.5 3.5 0 1 0 7 0a3.5 3.5 0 1 0 -7 0z",
    "M-3.3 -3.3H3.3V3.3H-3.3z",
    "M0 -4.4L4.2 3.2H-4.2z",
    "M0 -4.8L4.8 0L0 4.8L-4.8 0z",
    "M0 4.4L4.2 -3.2H-4.2z",
    "M-4.4 0L3.2 -4.2V4.2z",
    "M4.4 0L-3.2 -4.2V4.2z",
    "M0 -5L1.3 -1.6L4.8 -1.5L2 0.7L3 4.1L0 2.1L-3 4.1L-2 0.7L-4.8 -1.5L-1.3 -1.6z",
    "M-3.8 -4H3.8L-3.8 4H3.8z",
    "M-3.8 -3.8L3.8 3.8M-3.8 3.8L3.8 -3.8",
    "M0 -4.6V4.6M-4.6 0H4.6",
    "M0 -4.6V4.6M-4 -2.3L4 2.3M-4 2.3L4 -2.3",
]
LINES_ONLY = 3
STYLES = len(MARKERS) + len(MARKERS) - LINES_ONLY


def style(k):
    """Colour, marker and inside of the k-th of a chart's series: below STYLES no two have the same marker."""
    k %= STYLES
    hollow = k >= len(MARKERS)
    marker = k % len(MARKERS)
    colour = COLOURS[(marker + 3 * hollow) % len(COLOURS)]
    return colour, MARKERS[marker], "white" if hollow else colour


def decades(values):
    low, high = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))
    return low, max(high, low + 1)


def power(k):
    return f"{10.0 ** k:g}" if -3 <= k <= 3 else f"1e{k}"


def width_of(words):
    """At most, px, at the chart's size of letters."""
    return 7.6 * len(words)


def loglog(path, title, x_label, y_label, series):
    """series: [(name, [(x, y), ...], dashed)]; points that are not positive are left out."""
    series = [(name, [(x, y) for x, y in points if x > 0 and y > 0], dashed) for name, points, dashed in series]
    series = [s for s in series if s[1]]
    if not series:
        return False
    left, top, bottom, plot_width, row = 70, 36, 52, 480, 19
    right = left + plot_width
    width = round(max(right + 52 + max(width_of(name) for name, _, _ in series), left + width_of(title)))
    height = max(460, top + row * len(series) + 16)
    x0, x1 = decades([x for _, points, _ in series for x, _ in points])
    y0, y1 = decades([y for _, points, _ in series for _, y in points])
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
        colour, marker, inside = style(k)
        dash = ' stroke-dasharray="6 4"' if dashed else ""
        mark = lambda x, y: f'<path transform="translate({x:.1f} {y:.1f})" d="{marker}" fill="{inside}" stroke="{colour}" stroke-width="1.5"/>'
        line = "L".join(f"{at_x(x):.1f} {at_y(y):.1f}" for x, y in points)
        out.append(f'<path d="M{line}" fill="none" stroke="{colour}" stroke-width="1.8"{dash}/>')
        out += [mark(at_x(x), at_y(y)) for x, y in points]
        y = top + 12 + row * k
        out.append(f'<path d="M{right + 12} {y - 4}h28" stroke="{colour}" stroke-width="1.8"{dash}/>')
        out.append(mark(right + 26, y - 4))
        out.append(f'<text x="{right + 47}" y="{y}">{html.escape(name)}</text>')
    out.append("</svg>\n")
    path.write_text("\n".join(out))
    return True
