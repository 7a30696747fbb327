"""Reports the comparison as tables, images and JSON."""

import dataclasses
import re

from bench.broken.image import image
from bench.harness.page import Chart, Page, Table


def build_page(found, public, present, absent, here):
    page = Page("Broken meshes, as slicers see them")
    page.say(
        "Meshes that were broken on purpose, so that it is known what they are meant to be, cut by each program. Told is how "
        "far the areas of the layers are off: the sum of the differences of all layers over the sum of the true areas, and "
        "the layer where it is most. True areas come straight from the triangles of the sound solid; no slicer is asked.",
        "Lamella cuts a mesh as it is unless it is told to mend it, and says what it left open. The others mend without being asked. "
        "Tool paths (PrusaSlicer, CuraEngine) run within the contour and thin features get none: the first table, of a sound "
        "body, says how near their areas can be.")
    page.show(Table(["", ""], [[name, text] for name, text in here.items()]
                    + [[rival.title, version] for rival, version in present], texts=2))
    if absent:
        page.say(f"Not installed: {', '.join(absent)}.")
    if found:
        page.heading("Areas off, in percent")
        page.show(overview(found))
    for finding in found:
        show(page, finding, f"It is meant to be closed; {finding.broken}.")
    if public:
        page.heading("Meshes of the folder")
        page.say("Compared with Lamella's layers of the mesh as it is, where it is closed, else with those of the mesh mended by all "
                 "policies.")
        page.show(overview(public))
    for finding in public:
        show(page, finding, f"The mesh is {finding.broken}.")
    return page


def overview(findings):
    fullest = sorted(findings, key=lambda finding: -len(finding.rows))
    columns = list(dict.fromkeys(view.title for finding in fullest for view, _ in finding.rows))
    table = Table(["mesh", *columns])
    for finding in findings:
        cells = {view.title: percent(off) if off else view.ended for view, off in finding.rows}
        table.add(finding.title, *(cells.get(column, "") for column in columns))
    return table


def show(page, finding, words):
    page.heading(finding.title, 3)
    options = " ".join(finding.policies)
    page.say(words + (f" Mended by `{options}`." if options else ""))
    table = Table(["slicer", "areas off %", "layers", "open chains", "most at z", "there mm²"])
    for view, off in finding.rows:
        if off is None:
            table.add(view.title, view.ended, "", "", "", "")
        else:
            table.add(view.title, percent(off), len(view.layers), "" if view.open_chains is None else view.open_chains,
                      f"{off.worst_z:.3f}", f"{off.worst_mm2:+.2f}")
    page.show(table)
    for view, _ in finding.rows:
        if view.last_words:
            page.say(f"{view.title} says: {view.last_words}")
    if finding.expected:
        page.show(Chart(image_name(finding), f"{finding.title}, one layer", layer_image(finding)))


def image_name(finding):
    return "broken-" + re.sub(r"[^A-Za-z0-9.]+", "-", finding.name)


def layer_image(finding):
    z = finding.z
    expected = next((layer.area_mm2 for layer in finding.expected if abs(layer.z - z) < 1e-3), 0.0)
    panels = []
    for (view, _), drawn in zip(finding.rows, finding.drawings):
        area = next((layer.area_mm2 for layer in view.layers if abs(layer.z - z) < 1e-3), 0.0)
        open_chains = f", {len(drawn.chains)} open" if drawn is not None and drawn.chains else ""
        panels.append((view.title, drawn, f"{area:.1f} mm²{open_chains}" if view.ok else view.ended))
    return image(f"{finding.title}: the layer at z = {z:g}, {expected:.1f} mm² in truth", panels, finding.bounds)


def percent(off):
    value = 100 * off.share
    return "0" if value < 1e-9 else "< 0.001" if value < 0.001 else f"{value:.3f}"


def as_json(found, public, present):
    def rows(finding):
        return [{"slicer": view.slicer, "ended": view.ended, "layers": len(view.layers), "open_chains": view.open_chains,
                 "difference": off and dataclasses.asdict(off), "areas_mm2": [[layer.z, layer.area_mm2] for layer in view.layers]}
                for view, off in finding.rows]

    def one(finding):
        return {"name": finding.name, "broken": finding.broken, "policies": finding.policies,
                "true_areas_mm2": [[layer.z, layer.area_mm2] for layer in finding.expected], "slicers": rows(finding)}

    return {"versions": {rival.name: version for rival, version in present}, "broken": [one(finding) for finding in found],
            "folder": [one(finding) for finding in public]}
