"""The page with all tables."""

import dataclasses

from bench.harness import chart
from bench.harness.page import Chart, Page, Table, brief
from bench.paper import fit, growth, tables
from bench.paper.cell import ENGINES
from bench.paper.images import VIEWS
from bench.paper.tables import ENGINE_TITLES


def build_page(measured, figures, machine, timeout):
    """`measured`: parts, cells, order_parts, order_cells, split_cells, rival_cells, rival_titles,
    growth."""
    titles = {part.name: part.title for part in measured.parts}
    page = Page("The EECC paper, measured again")
    page.say(f"{figures['source']}. Each figure of the paper is followed by ours and the ratio paper / ours.",
             "The paper does not name its machine, so ratios of seconds depend on machine, implementation and part. "
             "Counts (Tables 2, 3, 4 and 7) do not depend on the machine; ratios between engines hardly do.",
             f"{machine['processor']}, {machine['threads']} threads (the paper's engines use one); {machine['memory']}; "
             f"{machine['system']}; {machine['compiler']}; {machine['program']}; {machine['date']}.",
             "Each measurement is a process of its own. Seconds are from opening the file to the last layer in "
             f"memory; those of short runs are medians. Limit for a run: {timeout:g} s. Longer times are estimated "
             "from runs on some of the planes (**≥**: a lower bound, because the lists of few planes fit the cache "
             "and those of all may not) or from the next smaller sheet (**≈**). A time counts only if the layers "
             "equal those of the sweep engine; see **Correctness** below.")
    page.heading("The parts")
    page.say("The sheets equal the paper's, triangle by triangle. The other parts of the paper are not published; ours have "
             "the same kind, size and number of triangles. Each image shows the stack of layers up to one layer, and "
             "that layer from above.")
    for part in measured.parts:
        if part.name in measured.images:
            page.show(Chart(f"part-{part.name}", f"{part.title}, as in {VIEWS[part.name].figures}", measured.images[part.name]))
    page.heading("Fig. 2: a false match")
    page.say("Two boxes touch along an edge, which every plane cuts in one point. The conventional method looks for an "
             "end with the same coordinates and takes the first that it finds, here one of the other box. ECC, EECC "
             "and the sweep use the triangles that share the edge.")
    page.show(Chart("false-match", "The layer of two boxes that touch along an edge", measured.false_match))
    page.heading("Table 5: time")
    page.show(tables.times(measured.cells, titles, figures["table5_seconds"], ENGINES, figures["stopped_after_seconds"]))
    page.show(Chart("times", "Seconds of each engine", time_chart(measured.cells, titles)))
    page.say(*estimates(measured.cells, titles))
    page.heading("Table 1: conventional and ECC")
    first = {name: titles[name] for name in figures["table1_seconds"] if name in titles}
    page.show(tables.times(measured.cells, first, figures["table1_seconds"], ["conventional", "ecc"],
                           figures["stopped_after_seconds"]))
    page.heading("Table 2: searches")
    page.show(tables.searches(measured.cells, titles, figures["table2_searches"]))
    page.heading("Table 3: cases under edge matching")
    page.show(tables.cases(measured.cells, titles, figures["table3_cases"]))
    page.say("The sheets equal the paper's, triangle by triangle; the other parts only have the same kind and size, so their "
             "counts can only be similar. The counts of front and back depend on the order of the triangles in the "
             "paper's files, which it does not give.")
    page.heading("Table 4: how often each case occurs")
    shares, count = tables.case_shares(measured.cells, figures["table4_percent"])
    page.show(shares)
    page.say(f"The paper's mean is over 50 unpublished parts, ours over {count}.")
    page.heading("Table 6: other slicers")
    if measured.rival_cells:
        page.show(tables.against_rivals(measured.rival_cells, measured.cells, titles, measured.rival_titles,
                                        figures["table6_seconds"]))
        page.say("Their times are of whole processes, from the STL file to G-code with one wall and no infill (for "
                 "Slic3r, to slices as SVG); `make rivals` makes the full comparison. The paper's times come from "
                 "timers added to the sources of unnamed versions.")
    else:
        page.say("Not measured in this run.")
    page.heading("Table 7: growth")
    page.say("In the paper's formulas, k is the number of lists on a plane, m the number of intersections on a "
             "triangle, and n the number of triangles. ECC checks O(m n) lists at best and O(k m n) at worst, EECC O(2 "
             "n) and O(2 k n). Here the checks are counted on sheets in which k and m vary independently. k is half "
             "the number of triangles that cross a plane. The split order reaches this number of lists; in the order "
             "hole by hole, the active lists of EECC are those of one hole.")
    page.show(tables.exponents(measured.growth, figures["table7_checks"]))
    for block in growth_charts(measured.growth):
        page.show(block)
    page.heading("Section 4.1: bytes per intersection")
    page.show(tables.memory(measured.growth, figures["section41_bytes"]))
    page.say("The paper counts the node only. Our node is 8 bytes larger because its coordinates are in double "
             "precision. The other columns are bytes per additional intersection: allocated for nodes, lists and "
             "edges, and in the peak memory of the whole process. The sweep engine has no node per intersection; only "
             "its output grows.")
    page.heading("The order of the triangles")
    page.say("These runs have the same sheet with its triangles in four orders: wall by wall; hole by hole (the lower "
             "triangles of its walls, then the upper ones; so are the sheets of all tables above); split (all lower "
             "triangles of the walls, then all upper ones); and shuffled. The order decides how many lists are open at "
             "a time.")
    page.show(tables.orders(measured.order_cells, measured.order_parts))
    page.say("**Which order did the paper's sheets have?** The paper does not state it. According to Table 3, half of the "
             "intersections begin a list, half link two, and hardly any are put at the front or the back. All lower "
             "triangles must therefore come before the upper ones, either in each hole or in the whole sheet. Table 5 "
             "decides between the two. Without the time of everything else, EECC needs 118, 174, 180, 181 and 196 "
             "microseconds per search of Table 3 on 100 to 1,225 holes. Its active list does not grow with the sheet, "
             "so it holds the lists of one hole; with a split over the whole sheet, it would grow with the number of "
             "holes. Edge matching alone, which still visits completed lists, needs 0.34 to 0.45 microseconds more per "
             "search for each hole of the sheet. The ratios confirm the order hole by hole:")
    page.show(tables.order_of_the_paper(measured.cells, measured.split_cells, titles, figures["table5_seconds"]))
    page.heading("Correctness")
    page.show(correctness(measured.cells + measured.order_cells + measured.split_cells))
    page.heading("What could not be reproduced")
    page.say(*not_reproduced(measured.cells, titles, figures))
    return page


def time_chart(cells, titles):
    items = []
    for cell in sorted(cells, key=lambda cell: cell.engine != "sweep"):
        value = cell.best_known
        note = cell.ended if value is None else f"{tables.ours(cell)} s"
        items.append(chart.Bar(titles[cell.part], ENGINE_TITLES[cell.engine], value, None, note))
    items.sort(key=lambda item: list(titles.values()).index(item.group))
    return chart.bars(items, "Seconds of each engine (≈, ≥: estimated)", "seconds, logarithmic")


def estimates(cells, titles):
    told = [f"{titles[cell.part]}, {ENGINE_TITLES[cell.engine]}: more than the limit; {cell.sign}{brief(cell.estimate)} s from "
            f"{cell.estimated_from}" for cell in cells if cell.estimate]
    return ["Estimated: " + "; ".join(told) + "."] if told else []


def growth_charts(measured):
    def series(samples, x, y):
        # Edge matching alone differs from EECC in the cost of a search; the shuffled order hardly differs from split.
        found = []
        for engine in ("ecc", "eecc"):
            for order in ("split", "hole", "wall"):
                points = [(x(s), y(s)) for s in samples if s.engine == engine and s.order == order and y(s) > 0]
                if points:
                    found.append(chart.Series(f"{ENGINE_TITLES[engine]}, {order}", points, fit.power_law(points)))
        return found

    per_search = series(measured.against_k, lambda s: s.k, lambda s: s.comparisons / s.searches)
    per_triangle = series(measured.against_m, lambda s: s.m, lambda s: s.searches / s.triangles)
    checks = series(measured.against_m, lambda s: s.m, lambda s: s.comparisons / s.triangles)
    k_axis, m_axis = "k: half the triangles that cross a plane", "m: planes that cross a triangle"
    drawn = [("growth-k", "Lists looked at in one search", per_search, k_axis, "lists per search"),
             ("growth-m", "Searches for one triangle", per_triangle, m_axis, "searches per triangle"),
             ("growth-m-lists", "Lists looked at for one triangle", checks, m_axis, "lists per triangle")]
    return [Chart(name, title, chart.scatter(points, title, x_axis, y_axis))
            for name, title, points, x_axis, y_axis in drawn if points]


def correctness(cells):
    table = Table(["engine", "cells measured", "equal hashes in every layer", "equal within tolerance", "wrong", "failed"])
    for engine in ENGINES:
        mine = [cell for cell in cells if cell.engine == engine]
        if mine:
            table.add(ENGINE_TITLES[engine], sum(cell.ok for cell in mine), sum(cell.check == "hashes" for cell in mine),
                      sum(cell.ok and cell.check != "hashes" for cell in mine),
                      sum(cell.ended == "wrong" for cell in mine),
                      sum(cell.ended not in ("ok", "wrong", "timeout") for cell in mine))
    return table


def not_reproduced(cells, titles, figures):
    """Describes the largest differences from the paper, and their general reasons."""
    texts = ["The seconds of the paper themselves: its machine and compiler are not known, and all parts except the "
             "sheets had to be rebuilt."]
    for engine in ("ecc", "eecc"):
        ratios = {}
        for part, theirs in figures["table5_seconds"].items():
            found = tables.find(cells, part, engine)
            mine = found and found.best_known
            if mine and theirs.get(engine) and not found.lower_bound:
                ratios[part] = theirs[engine] / mine
        if len(ratios) > 1:
            low, high = min(ratios, key=ratios.get), max(ratios, key=ratios.get)
            texts.append(
                f"{ENGINE_TITLES[engine]}: the paper's time is {brief(ratios[low])} times ours on {titles[low]} and "
                f"{brief(ratios[high])} times on {titles[high]}. If lists are few, ours does little work per "
                "intersection; if a search looks at tens of thousands of lists, both wait for memory.")
    alike = [titles[part] for part in titles if not_slower(cells, part, "ecc", "eecc")]
    if alike:
        texts.append(f"A gain of EECC over ECC on {', '.join(alike)}: few lists are open at a time there, so a search "
                     "ends at once in ECC, too, and edge links only add cost.")
    odd = tables.find(cells, "rook", "ecc")
    if odd and odd.matching:
        texts.append(f"Table 2 gives the rook {figures['table2_searches']['rook']['ecc']:,} searches by ECC. A rook of "
                     "that size "
                     f"has {odd.matching['searches']:,} intersections on these planes, and ECC searches once for each; "
                     "the paper's figure must belong to another model or layer height. Its Tables 1 and 5 also give "
                     "two times for "
                     "the rook (5.573 and 34.81 s, 0.575 and 2.855 s).")
    return texts


def not_slower(cells, part, one, other):
    mine, its = (tables.find(cells, part, engine) for engine in (one, other))
    return bool(mine and its and mine.ok and its.ok and mine.seconds <= its.seconds)


def as_json(measured, machine, timeout):
    return {"machine": machine, "timeout_seconds": timeout,
            "cells": [dataclasses.asdict(cell) for cell in measured.cells],
            "order_cells": [dataclasses.asdict(cell) for cell in measured.order_cells],
            "split_cells": [dataclasses.asdict(cell) for cell in measured.split_cells],
            "rival_cells": [dataclasses.asdict(cell) for cell in measured.rival_cells],
            "growth": dataclasses.asdict(measured.growth)}
