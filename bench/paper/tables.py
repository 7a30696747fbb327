"""The paper's tables compared with ours. Pure functions: cells and the paper's figures in, tables out."""

from bench.harness.page import Table, brief
from bench.paper import growth
from bench.paper.cell import ENGINES

ENGINE_TITLES = {"conventional": "conventional", "ecc": "ECC", "ecc-edge-match": "ECC + edge matching", "eecc": "EECC",
                 "sweep": "sweep"}
CASES = [("new", "no matching list"), ("front", "front"), ("back", "back"), ("link", "link two lists")]


def find(cells, part, engine):
    return next((cell for cell in cells if cell.part == part and cell.engine == engine), None)


def times(cells, titles, seconds, engines, stopped_after):
    """Builds tables 1 and 5; each cell is "the paper's / ours = ratio"."""
    heads = [f"{ENGINE_TITLES[engine]}: paper / ours = ratio" if engine != "sweep" else "sweep: ours" for engine in engines]
    table = Table(["part", "triangles", "layers", *heads] + (["EECC to sweep"] if "sweep" in engines else []))
    for part, title in titles.items():
        rows = [find(cells, part, engine) for engine in engines]
        if not any(rows):
            continue
        known = next(cell for cell in rows if cell and cell.triangles)
        line = [title, f"{known.triangles:,}", known.layers]
        for engine, cell in zip(engines, rows):
            paper = seconds.get(part, {}).get(engine, "")
            line.append(ours(cell) if engine == "sweep" else compared(paper, cell, stopped_after))
        if "sweep" in engines:
            line.append(to_sweep(find(cells, part, "eecc"), find(cells, part, "sweep")))
        table.add(*line)
    return table


def ours(cell):
    if cell is None:
        return ""
    if cell.ok:
        return brief(cell.seconds)
    if cell.ended == "timeout" and cell.estimate:
        return f"{cell.sign}{brief(cell.estimate)}"
    return cell.ended


def compared(paper, cell, stopped_after):
    """`paper` is a number, None if the authors stopped, "" if they give none."""
    if cell is None:
        return ""
    said = "not given" if paper == "" else (f"> {stopped_after:,}" if paper is None else brief(paper))
    mine = cell.best_known
    if mine is None or paper == "" or cell.lower_bound:
        return f"{said} / {ours(cell)}"
    ratio = (stopped_after if paper is None else paper) / mine
    if paper is None and ratio < 1:
        return f"{said} / {ours(cell)}"
    return f"{said} / {ours(cell)} = {'> ' if paper is None else ''}{cell.sign}{brief(ratio)}"


def to_sweep(eecc, sweep):
    mine, its = (cell and cell.best_known for cell in (eecc, sweep))
    return f"{eecc.sign}{brief(mine / its)} x" if mine and its else ""


def searches(cells, titles, figures):
    table = Table(["part", "ECC: paper", "ours", "ratio", "EECC: paper", "ours", "ratio"])
    for part, theirs in figures.items():
        line = [titles.get(part, part)]
        for engine in ("ecc", "eecc"):
            cell = find(cells, part, engine)
            count = cell and (cell.matching["searches"] if cell.matching else cell.searches_estimate)
            if not count:
                line += [f"{theirs[engine]:,}", "", ""]
                continue
            sign = "" if cell.matching else "≈ "
            line += [f"{theirs[engine]:,}", f"{sign}{count:,.0f}", brief(theirs[engine] / count)]
        if part in titles:
            table.add(*line)
    return table


def cases(cells, titles, figures):
    """Builds table 3, of ECC with edge matching."""
    table = Table(["part", "whose", *[title for _, title in CASES], "requires sorting"], texts=2)
    for part, title in titles.items():
        cell = find(cells, part, "ecc-edge-match")
        theirs = figures.get(part)
        if theirs:
            table.add(title, "paper", *[f"{theirs[case]:,}" for case, _ in CASES], f"{theirs['searches']:,}")
        if cell and cell.matching:
            mine = cell.matching["by_edge_link"]
            table.add(title, "ours", *[f"{mine[case]:,}" for case, _ in CASES], f"{cell.matching['searches']:,}")
            if theirs:
                table.add(title, "ratio", *[ratio(theirs[case], mine[case]) for case, _ in CASES],
                          ratio(theirs["searches"], cell.matching["searches"]))
    return table


def ratio(theirs, mine):
    return brief(theirs / mine) if mine else "-"


def case_shares(cells, figures):
    """Builds table 4: the mean over parts of each part's percentages. Returns the table and the number of parts."""
    shares = []
    for cell in cells:
        if cell.engine == "eecc" and cell.matching:
            counts = cell.matching["by_edge_link"]
            total = sum(counts[case] for case, _ in CASES)
            if total:
                shares.append({case: 100 * counts[case] / total for case, _ in CASES})
    table = Table(["case", "paper %", "ours %", "ratio"])
    for case, title in CASES:
        mine = sum(share[case] for share in shares) / len(shares) if shares else 0.0
        table.add(title, f"{figures[case]:.2f}", f"{mine:.2f}", ratio(figures[case], mine))
    return table, len(shares)


def against_rivals(rival_cells, cells, titles, rival_titles, figures):
    table = Table(["part", "program", "paper s", "ours s", "ratio", "its layers"], texts=2)
    for part, theirs in figures.items():
        for cell in (cell for cell in rival_cells if cell.part == part):
            if cell.slicer in rival_titles:
                paper = theirs.get(cell.slicer, "")
                said = "" if paper == "" else ("crashed" if paper is None else brief(paper))
                mine = brief(cell.seconds) if cell.ok else cell.ended
                times_ = brief(paper / cell.seconds) if paper and cell.ok else ""
                layers = cell.last_words if cell.agreement is None else cell.agreement.text()
                table.add(titles[part], rival_titles[cell.slicer], said, mine, times_, layers)
        for engine in ("eecc", "sweep"):
            cell = find(cells, part, engine)
            if cell:
                paper = theirs.get(engine)
                mine = cell.best_known
                table.add(titles[part], ENGINE_TITLES[engine], brief(paper) if paper else "", ours(cell),
                          brief(paper / mine) if paper and mine else "", "")
    return table


def exponents(measured, figures):
    """Builds table 7 as growth: the exponents of the paper's formulas and the fitted ones."""
    laws = [
        ("lists looked at per search, against k", "per_search_against_k", measured.against_k, lambda s: s.k,
         lambda s: s.comparisons / s.searches),
        ("searches per cut triangle, against m", "searches_per_triangle_against_m", measured.against_m, lambda s: s.m,
         lambda s: s.searches / s.triangles),
        ("lists looked at per cut triangle, against m", "per_triangle_against_m", measured.against_m, lambda s: s.m,
         lambda s: s.comparisons / s.triangles),
    ]
    table = Table(["quantity", "engine", "order of triangles", "paper's exponent", "fitted exponent"], texts=3)
    for title, key, samples, x, y in laws:
        for engine in growth.COUNTING:
            for order in dict.fromkeys(sample.order for sample in samples):
                chosen = [sample for sample in samples if sample.engine == engine and sample.order == order]
                fitted = growth.exponent(chosen, x, y)
                # The worst case is the split order; edge matching alone is not in the paper's table.
                paper = figures.get(engine, {}).get(key, "") if order == "split" else ""
                said = "-" if fitted is None else f"{fitted:.2f}".replace("-0.00", "0.00")
                table.add(title, ENGINE_TITLES[engine], order, paper, said)
    return table


def memory(measured, figures):
    table = Table(["engine", "paper", "our node", "ratio", "node, lists and edges", "whole process"])
    for engine in [*growth.COUNTING, "sweep"]:
        samples = [sample for sample in measured.of_memory if sample.engine == engine]
        if not samples:
            continue
        paper, node = figures.get(engine), samples[-1].node_bytes
        slope, whole = (growth.bytes_per_intersection(samples, size)
                        for size in (lambda s: s.bytes, lambda s: s.peak_rss_bytes))
        table.add(ENGINE_TITLES[engine], paper or "", node or "", ratio(paper, node) if paper and node else "",
                  brief(slope) if slope and node else "", brief(max(whole or 0, 0)))
    return table


def order_of_the_paper(cells, split_cells, titles, seconds):
    """Gives evidence for the order hole by hole: ratios between engines and growth, which hardly depend on a
    machine."""
    table = Table(["part", "edge matching / EECC: paper", "ours, by hole", "ours, split", "growth of EECC: paper",
                   "ours, by hole", "ours, split", "lists per search of EECC: by hole", "split"])
    sheets = [name for name in titles if name in seconds and name.startswith("sheet-") and "edge" not in name]

    def of(found, name, engine):
        cell = find(found, name, engine)
        return cell and cell.best_known

    def quotient(a, b):
        return brief(a / b) if a and b else ""

    for name in sheets:
        paper, first = seconds[name], seconds[sheets[0]]
        searched = [find(found, part, "eecc") for found, part in ((cells, name), (split_cells, f"{name}-split"))]
        table.add(titles[name], quotient(paper["ecc-edge-match"], paper["eecc"]),
                  quotient(of(cells, name, "ecc-edge-match"), of(cells, name, "eecc")),
                  quotient(of(split_cells, f"{name}-split", "ecc-edge-match"), of(split_cells, f"{name}-split", "eecc")),
                  quotient(paper["eecc"], first["eecc"]),
                  quotient(of(cells, name, "eecc"), of(cells, sheets[0], "eecc")),
                  quotient(of(split_cells, f"{name}-split", "eecc"), of(split_cells, f"{sheets[0]}-split", "eecc")),
                  *[brief(cell.matching["comparisons"] / cell.matching["searches"]) if cell and cell.matching else ""
                    for cell in searched])
    return table


def orders(cells, names, engines=tuple(ENGINES)):
    """`names`: order -> part name."""
    table = Table(["engine", *[f"{order}, s" for order in names], *[f"{order}, lists per search" for order in names]])
    for engine in engines:
        found = [find(cells, part, engine) for part in names.values()]
        if any(found):
            per_search = [brief(cell.matching["comparisons"] / cell.matching["searches"])
                          if cell and cell.matching and cell.matching["searches"] else "" for cell in found]
            table.add(ENGINE_TITLES[engine], *[ours(cell) for cell in found], *per_search)
    return table
