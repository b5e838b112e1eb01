"""Plots and pictures by matplotlib, as elements of a page."""
import base64
import io
import re

import numpy

try:
    import matplotlib
    from matplotlib.figure import Figure
except ImportError:
    raise ImportError("matplotlib is missing: install python3-matplotlib, which draws the "
                      "plots") from None

# Colours that people with any kind of colour vision tell apart (Okabe and Ito).
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7f7f7f")
DASHES = ("-", (0, (6, 2)), (0, (2, 2)), (0, (7, 2, 2, 2)), (0, (4, 1, 1, 1, 1, 1)))
MARKS = "os^Dvp*"
INK = "#010203"
"""stands for the colour of the page's text"""
BACKDROP = "#9a9a9a"


def look_of(number):
    """Each curve differs in colour, dashes and mark."""
    return {"color": COLOURS[number % len(COLOURS)], "linestyle": DASHES[number % len(DASHES)],
            "marker": MARKS[number % len(MARKS)]}


def settings(salt):
    return {"svg.fonttype": "none", "svg.hashsalt": salt, "font.size": 11,
            "font.family": "sans-serif", "text.color": INK, "axes.edgecolor": INK,
            "axes.labelcolor": INK, "xtick.color": INK, "ytick.color": INK,
            "axes.titlesize": 12, "axes.spines.top": False, "axes.spines.right": False,
            "text.parse_math": False}


def draw_curves(axes, plot):
    labelled = 0
    for curve in plot.curves:
        if not curve.points:
            continue
        x, y = numpy.array(curve.points).T
        if not curve.label:
            axes.plot(x, y, color=BACKDROP, linewidth=1)
            continue
        look = look_of(labelled if curve.style is None else curve.style)
        labelled += 1
        if not curve.markers and len(x) > 1:
            look["marker"] = ""
        axes.plot(x, y, label=curve.label, linewidth=2.6 if curve.emphasised else 1.6,
                  markersize=5, zorder=4 if curve.emphasised else 3, **look)


def figure_of(plot):
    figure = Figure(figsize=(6.4, 4.8), layout="constrained")
    axes = figure.add_subplot()
    draw_curves(axes, plot)
    axes.set(title=plot.title, xlabel=plot.x_label, ylabel=plot.y_label)
    if plot.x_logarithmic:
        axes.set_xscale("log")
    if plot.y_logarithmic:
        axes.set_yscale("log")
    axes.grid(True, color=BACKDROP, alpha=0.35, linewidth=0.6)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=2, frameon=False,
                handlelength=3.5)
    return figure


def svg_of(plot):
    """A plot as an element that any number of stand in one page. The same plot gives the same
    text."""
    out = io.StringIO()
    with matplotlib.rc_context(settings(plot.title)):
        figure_of(plot).savefig(out, format="svg", transparent=True, metadata={"Date": None})
    text = out.getvalue()
    text = text[text.index("<svg"):]
    text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.DOTALL)
    # What nothing refers to; each plot has the same.
    text = re.sub(r'<g id="[^"]*"', "<g", text)
    text = re.sub(r'^<svg [^>]*?(viewBox="[^"]*")[^>]*>', r'<svg \1 role="img">', text)
    return text.replace(INK, "currentColor")


def view_axes(yaw_deg, pitch_deg):
    """Rows: what is right, down and away in the picture, in the map frame."""
    yaw, pitch = numpy.radians([yaw_deg, pitch_deg])
    away = numpy.array([numpy.cos(yaw) * numpy.cos(pitch), numpy.sin(yaw) * numpy.cos(pitch),
                        -numpy.sin(pitch)])
    right = numpy.array([numpy.sin(yaw), -numpy.cos(yaw), 0])
    return numpy.stack([right, numpy.cross(away, right), away])


def usual_range(values, stray=0.05):
    """Where all values but a share at either end lie."""
    low, high = numpy.quantile(values, [stray, 1 - stray])
    return low, max(high, low + 1e-9)


def picture_figure(low, high, width_inch=7):
    """A figure whose pixels are square in a box (right, down)."""
    shape = numpy.maximum(high - low, 1e-6)
    height_inch = float(numpy.clip(width_inch * shape[1] / shape[0], 1, 2 * width_inch))
    figure = Figure(figsize=(width_inch, height_inch), facecolor="white")
    axes = figure.add_axes([0, 0, 1, 1])
    axes.set(xlim=(low[0], high[0]), ylim=(high[1], low[1]), aspect="equal")
    axes.set_axis_off()
    return figure, axes


def png_of(figure, dpi=130):
    out = io.BytesIO()
    figure.savefig(out, format="png", dpi=dpi)
    return out.getvalue()


def image(png, text):
    """An <img> with the picture in it. text: escaped."""
    return (f'<img alt="{text}" src="data:image/png;base64,'
            f'{base64.b64encode(png).decode()}">')
