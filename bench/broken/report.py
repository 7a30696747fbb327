"""Reports the comparison as tables, images and JSON."""

import dataclasses
import re

from bench.broken.image import image
from bench.harness.page import Chart, Page, Table


def build_page(found, public, present, absent, here):
    page = Page("Broken meshes, as slicers see them")
    page.say(
        "Each program slices meshes that were damaged on purpose, so that the true area of every layer is known. The tables "
        "give the sum of the absolute area errors of all layers, in percent of the sum of the true areas, and the layer with "
        "the largest error. True areas are computed directly from the triangles of the sound solid, without a slicer.",
        "Lamella repairs a mesh only on request, and reports open contours. The others repair every mesh. Tool paths "
        "(PrusaSlicer, CuraEngine) run within the contour, and thin features get none: the table of the sound ring shows the "
        "error of areas that are reconstructed from them.")
    page.show(Table(["", ""], [[name, text] for name, text in here.items()]
                    + [[rival.title, version] for rival, version in present], texts=2))
    if absent:
        page.say(f"Not installed: {', '.join(absent)}.")
    if found:
        page.heading("Area errors, in percent")
        page.show(overview(found))
    for finding in found:
        show(page, finding, f"The solid is known. Defect: {finding.broken}.")
    if public:
        page.heading("Meshes of the folder")
        page.say("The layers are compared with Lamella's: without repairs if the mesh is closed, otherwise after all repairs.")
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
    page.say(words + (f" Repaired by `{options}`." if options else ""))
    table = Table(["slicer", "area error %", "layers", "open chains", "worst at z", "error there mm²"])
    for view, off in finding.rows:
        if off is None:
            table.add(view.title, view.ended, "", "", "", "")
        else:
            table.add(view.title, percent(off), len(view.layers), "" if view.open_chains is None else view.open_chains,
                      f"{off.worst_z:.3f}", f"{off.worst_mm2:+.2f}")
    page.show(table)
    for view, _ in finding.rows:
        if view.last_words:
            page.say(f"Last output of {view.title}: {view.last_words}")
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
