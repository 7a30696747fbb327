"""Reports the comparison as a table, a chart and JSON."""

import dataclasses

from bench.harness import chart
from bench.harness.page import Chart, Page, Table, brief

OURS = ("lamella", "lamella-1", "older-lamella", "older-lamella-1")
TELLING = ("rook", "lattice", "sheet-1225")


def build_page(cells, parts, rivals, absent, machine, timeout, threads):
    """`rivals` are those that ran, with their versions: [(rival, version)]; `absent`: {title: reason}."""
    page = Page("Lamella beside other slicers")
    titles = {"lamella": f"Lamella, {counted(threads)}", "lamella-1": "Lamella, 1 thread",
              "older-lamella": f"older Lamella, {counted(threads)}", "older-lamella-1": "older Lamella, 1 thread",
              **{rival.name: rival.title for rival, _ in rivals}}
    part_titles = {part.name: part.title for part in parts}
    page.say(
        "All slicers cut the same parts at the same heights (layers of 0.1 mm, cut in the middle), one process after "
        "the other on one machine. A rival's time counts only if its layers agree with Lamella's; the column *same layers* "
        "gives the result of this check. Times that do not count are in brackets.".replace("*", "**"),
        f"{machine['processor']}, {machine['threads']} threads, {machine['memory']}; {machine['system']}; "
        f"{machine['program']}; {machine['date']}. Limit for one run: {timeout:g} s.")
    telling = [part for part in TELLING if part in part_titles]
    if telling:
        page.show(Chart("rivals-short", "Time of the whole process: " + ", ".join(part_titles[part] for part in telling),
                        time_chart([cell for cell in cells if cell.part in telling], titles, part_titles)))
    page.heading("All parts")
    page.show(Chart("rivals", "Time of the whole process", time_chart(cells, titles, part_titles)))
    for part in parts:
        page.heading(part.title)
        page.show(part_table([cell for cell in cells if cell.part == part.name], titles))
    page.heading("What is compared")
    page.say("**Whole process** is the time from the start to the end of the process, from file to file. Lamella "
             "writes a CLI file; the table below lists the outputs of the others. Slicers for printers continue to "
             "tool paths, with one wall and no infill, as in the paper. **Cutting alone** is the time that they report "
             "for their first stage, which for some includes cleaning up the contours; for Lamella, it is the time "
             "from the mesh in memory to the layers in memory. Times of short runs are medians. **User** is the "
             "processor time of the program itself, **system** that of the operating system for it; most of that goes "
             "into the memory that it provides. **Peak** is the largest resident size; it is never below about 7 MB, the "
             "size of the program that starts the others. **Fresh** is the memory that the operating system provided during "
             "the whole run: page faults times the size of their pages.",
             "**Equal** means that every layer has the same number of contours, and that areas and lengths agree to "
             "one in 100,000, as far as a slicer has them. Otherwise the column lists the layers that only one of the two has, "
             "the numbers of contours of the slicer and of Lamella, and the sums of the differences of areas and of "
             "lengths, relative to Lamella's sums. A time counts if at most one layer (or 1% of them) is missing, and contours, areas and "
             "lengths agree within 1%. Tool paths run inside the contour and close gaps by design; contour areas are "
             "reconstructed from them.")
    table = Table(["slicer", "version", "threads", "writes", "compared"], texts=5)
    table.add("Lamella", machine["program"].split()[-1], "all, or one", "CLI file", "is compared with")
    for rival, version in rivals:
        table.add(rival.title, version, "all" if rival.threaded else "one", rival.writes, rival.compared)
    page.show(table)
    for title, why in absent.items():
        page.say(f"**{title}** is missing: {why}.")
    return page


def counted(threads):
    return f"{threads} thread" + ("s" if threads != 1 else "")


def part_table(cells, titles):
    table = Table(["slicer", "whole process s", "to Lamella's", "cutting alone s", "to Lamella's", "user s",
                   "system s", "peak MB", "fresh MB", "same layers"])
    ours = cells[0]
    for cell in cells:
        if cell.seconds is None or not cell.ok:
            said = f"{ending(cell)}" + ("" if cell.seconds is None else f" after {seconds(cell.seconds)}")
            table.add(titles[cell.slicer], said, "", "", "", "", "", megabytes(cell.peak_rss_bytes), "",
                      f"it says: {cell.last_words}" if cell.last_words else "")
            continue
        values = [seconds(cell.seconds), ratio(cell.seconds, ours.seconds), seconds(cell.slicing_seconds),
                  ratio(cell.slicing_seconds, ours.slicing_seconds)]
        if not cell.counts:
            values = [f"({value})" if value else "" for value in values]
        table.add(titles[cell.slicer], *values, seconds(cell.user_seconds), seconds(cell.system_seconds),
                  megabytes(cell.peak_rss_bytes), megabytes(cell.fresh_bytes),
                  cell.agreement.text() if cell.agreement else "-")
    return table


def ending(cell):
    return {"timeout": "timeout", "skipped": "not tried after a timeout on a smaller one"}.get(cell.ended, cell.ended)


def seconds(value):
    if value is None:
        return ""
    return brief(value)


def ratio(value, ours):
    if value is None or not ours:
        return ""
    times = value / ours
    return f"{brief(times)} x"


def megabytes(value):
    return "" if value is None else f"{value / 1e6:,.0f}"


def time_chart(cells, titles, part_titles):
    first = {}
    items = []
    for cell in cells:
        first.setdefault(cell.part, cell)
        if cell.ok and cell.seconds:
            note = f"{seconds(cell.seconds)} s"
            if cell.slicer not in OURS:
                note += f", {ratio(cell.seconds, first[cell.part].seconds)}" if cell.counts else ", other layers"
        else:
            note = ending(cell) + (f" after {seconds(cell.seconds)} s" if cell.ended == "timeout" else "")
        limit_hit = cell.ended == "timeout"
        items.append(chart.Bar(part_titles[cell.part], titles[cell.slicer], cell.seconds if cell.ok or limit_hit else None,
                               cell.slicing_seconds if cell.ok else None, note, hollow=limit_hit))
    return chart.bars(items, "Time of the whole process", "seconds, logarithmic; x: times Lamella's", "cutting alone")


def as_json(cells, rivals, absent, machine, timeout, threads):
    return {"machine": machine, "timeout_seconds": timeout, "threads": threads, "layer_height_mm": 0.1,
            "versions": {rival.name: version for rival, version in rivals}, "absent": absent,
            "cells": [{**dataclasses.asdict(cell), "counts": cell.counts} for cell in cells]}
