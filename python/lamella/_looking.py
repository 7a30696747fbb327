"""Images of layers: SVG for notebooks, pages, and drawings by matplotlib, which is imported on first use."""

from __future__ import annotations

import html
from typing import TYPE_CHECKING, Any, List, Optional, Tuple

import numpy as np
import numpy.typing as npt

from . import _arguments as check

if TYPE_CHECKING:
    from ._lamella import Layer, Stack

LARGE_PIXELS = 360  # the longer side of an image of a layer
SMALL_PIXELS = 120  # and of each of those of a stack
SMALL_PICTURES = 5
MOST_POINTS = 20_000  # in one image; where there are more, they are rounded to a coarser grid
MATERIAL = "lightsteelblue"
OUTLINE = "steelblue"

Window = Tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]  # the smallest and the largest x and y


def window_of(layers: List[Layer]) -> Optional[Window]:
    """Returns the box of all points, none if there are none."""
    points = [part for layer in layers for part in (layer.points, layer.hatches.reshape(-1, 2)) if len(part)]
    if not points:
        return None
    return np.min([p.min(axis=0) for p in points], axis=0), np.max([p.max(axis=0) for p in points], axis=0)


def layer_svg(layer: Layer) -> str:
    return _svg(layer, window_of([layer]), LARGE_PIXELS)


def stack_html(stack: Stack) -> str:
    """Returns a line of text and images of a few layers, all at the same scale."""
    count = len(stack)
    text = html.escape(repr(stack).strip("<>"))
    chosen = [stack[i] for i in sorted({round(i) for i in np.linspace(0, count - 1, SMALL_PICTURES)})] if count else []
    window = window_of(chosen)
    images = "".join(
        f'<figure style="display:inline-block;margin:4px;text-align:center">{_svg(layer, window, SMALL_PIXELS)}'
        f"<figcaption>z = {layer.z:.6g} mm</figcaption></figure>"
        for layer in chosen
    )
    return f"<div><p>{text}</p>{images}</div>"


def _svg(layer: Layer, window: Optional[Window], pixels: int) -> str:
    title = f"layer {layer.index} at z = {layer.z:.6g} mm: {len(layer)} contours, {layer.area:.6g} mm²"
    if window is None:
        return _document(pixels, pixels // 4, title, f'<text x="4" y="18" font-size="12">{title}</text>')
    low, high = window
    extent = max(float((high - low).max()), 1e-9)
    scale = (pixels - 8) / extent
    width, height = (int(np.ceil(side * scale)) + 8 for side in high - low)
    # Half pixels of the image show all that can be seen; many small contours need coarser ones, and noise is thinned.
    for grid in (0.5, 1, 2, 4):
        contours = [_on_grid(contour, low, high, scale, grid) for contour in layer]
        points = sum(map(len, contours)) + 2 * len(layer.hatches)
        if points <= MOST_POINTS:
            break
    step = -(-points // MOST_POINTS)
    contours = [contour[::step] for contour in contours]
    lines = _pixels(layer.hatches[::step].reshape(-1, 2), low, high, scale).reshape(-1, 2, 2)
    closed = layer.closed
    rings = "".join(f"{_moves(points)}z" for i, points in enumerate(contours) if closed[i] and len(points) > 2)
    chains = "".join(_moves(points) for i, points in enumerate(contours) if not closed[i] and len(points) > 1)
    hatches = "".join(_moves(line) for line in lines)
    return _document(
        width, height, title,
        f'<path d="{rings}" fill="{MATERIAL}" stroke="{OUTLINE}" stroke-width="0.7" fill-rule="nonzero"/>'
        f'<path d="{hatches}" fill="none" stroke="{OUTLINE}" stroke-width="0.4"/>'
        f'<path d="{chains}" fill="none" stroke="crimson" stroke-width="1"/>',
    )  # fmt: skip


def _document(width: int, height: int, title: str, content: str) -> str:
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" '
        f'role="img"><title>{html.escape(title)}</title><rect width="100%" height="100%" fill="white"/>{content}</svg>'
    )


def _pixels(
    points: npt.NDArray[np.float64], low: npt.NDArray[np.float64], high: npt.NDArray[np.float64], scale: float
) -> npt.NDArray[np.float64]:
    """Returns points in pixels, with y downwards."""
    pixels: npt.NDArray[np.float64] = np.column_stack([points[:, 0] - low[0], high[1] - points[:, 1]]) * scale + 4
    return pixels


def _on_grid(
    points: npt.NDArray[np.float64],
    low: npt.NDArray[np.float64],
    high: npt.NDArray[np.float64],
    scale: float,
    grid: float,
) -> npt.NDArray[np.float64]:
    """Returns points in pixels, rounded to a grid, without those equal to their predecessor."""
    rounded = np.round(_pixels(points, low, high, scale) / grid) * grid
    kept = np.ones(len(rounded), dtype=bool)
    kept[1:] = (rounded[1:] != rounded[:-1]).any(axis=1)
    return np.asarray(rounded[kept])


def _moves(points: npt.NDArray[np.float64]) -> str:
    return "M" + "L".join(f"{x:.4g},{y:.4g}" for x, y in points)


def _axes(axes: Any) -> Any:
    if axes is not None and not hasattr(axes, "add_collection"):
        check.refuse_type("axes", "axes of matplotlib", axes)
    try:
        import matplotlib.pyplot as pyplot  # type: ignore[import]
    except ImportError as error:
        raise ImportError("plot needs matplotlib: on Debian, apt install python3-matplotlib") from error
    return pyplot.subplots()[1] if axes is None else axes


def _finish(axes: Any, title: str) -> Any:
    axes.autoscale_view()
    axes.set(aspect="equal", xlabel="x in mm", ylabel="y in mm", title=title)
    return axes


def plot_layer(layer: Layer, axes: Any) -> Any:
    axes = _axes(axes)
    from matplotlib.collections import LineCollection  # type: ignore[import]
    from matplotlib.patches import PathPatch  # type: ignore[import]
    from matplotlib.path import Path  # type: ignore[import]

    closed = layer.closed
    rings = [Path(np.vstack([ring, ring[:1]]), closed=True) for i, ring in enumerate(layer) if closed[i]]
    if rings:  # holes run in the opposite direction, so they stay empty
        axes.add_patch(PathPatch(Path.make_compound_path(*rings), facecolor=MATERIAL, edgecolor=OUTLINE, linewidth=0.7))
    axes.add_collection(LineCollection(layer.hatches, color=OUTLINE, linewidth=0.4))
    axes.add_collection(LineCollection([c for i, c in enumerate(layer) if not closed[i]], color="crimson"))
    return _finish(axes, f"z = {layer.z:.6g} mm")


def plot_values(vectors: npt.NDArray[np.float64], values: npt.NDArray[Any], label: str, z: float, axes: Any) -> Any:
    """Draws lines in colours that show their values."""
    axes = _axes(axes)
    from matplotlib.collections import LineCollection

    lines = LineCollection(vectors, array=values, cmap="viridis", linewidth=0.5)
    axes.add_collection(lines)
    axes.figure.colorbar(lines, ax=axes, label=label)
    return _finish(axes, f"z = {z:.6g} mm")


def plot_groups(
    vectors: npt.NDArray[np.float64], groups: npt.NDArray[np.int64], names: List[str], z: float, axes: Any
) -> Any:
    """Draws lines in the colours of their groups."""
    axes = _axes(axes)
    from matplotlib.collections import LineCollection

    for i, name in enumerate(names):
        axes.add_collection(LineCollection(vectors[groups == i], color=f"C{i % 10}", linewidth=0.5, label=name))
    axes.legend()
    return _finish(axes, f"z = {z:.6g} mm")
