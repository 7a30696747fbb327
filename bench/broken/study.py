"""Slices one mesh after the other with every slicer."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Optional

from bench.broken.cases import LAYER_HEIGHT_MM
from bench.broken.triangles import bounds, write_stl
from bench.broken.views import difference, our_view, their_view
from bench.harness.layers import Layer
from bench.rivals.job import Job

OURS = ("lamella", "lamella-mended")
# Policies for meshes whose defects are unknown.
ALL_POLICIES = ("--weld-tolerance", "0.001", "--drop-duplicates", "--orient", "--close-gaps", "2", "--fill", "nonzero")
# Formats that each program reads; it is not given others.
READS = {"slic3r": (".stl", ".obj", ".amf", ".3mf"), "prusa-slicer": (".stl", ".obj", ".amf", ".3mf"), "cura": (".stl",)}


@dataclass
class Finding:
    name: str
    title: str
    broken: str  # its defect
    policies: tuple  # suitable ones
    rows: list  # of (View, Difference, or None without layers)
    bounds: tuple
    expected: list  # layers
    z: Optional[float] = None  # of the layer drawn, above the bottom
    drawings: list = field(default_factory=list)  # of this layer, one for each row


class Study:
    def __init__(self, program, folder, rivals, timeout, threads):
        self.program, self.folder, self.timeout, self.threads = program, Path(folder), timeout, threads
        self.rivals = rivals
        self.folder.mkdir(parents=True, exist_ok=True)

    def case(self, case):
        """Compares with the intended solid."""
        mesh = self.folder / f"{case.name}.stl"
        write_stl(mesh, case.triangles)
        extent = bounds(case.triangles)
        expected = [Layer(z - extent[0][2], 0, area) for z, area in zip(case.planes(), case.true_areas())]
        views = self.ours(mesh, case.policies, LAYER_HEIGHT_MM) + self.theirs(mesh, extent, LAYER_HEIGHT_MM)
        return self.finding(case.name, case.title, case.broken, case.policies, views, extent, expected)

    def mesh(self, mesh):
        """Compares with Lamella's result: without policies if the mesh is closed, otherwise with all of them."""
        views = self.ours(mesh.path, ALL_POLICIES, LAYER_HEIGHT_MM)
        expected = views[0 if mesh.closed else -1].layers
        views += self.theirs(mesh.path, mesh.bounds, LAYER_HEIGHT_MM)
        return self.finding(mesh.name, mesh.name, "closed" if mesh.closed else "not closed", ALL_POLICIES, views, mesh.bounds,
                            expected)

    def ours(self, mesh, policies, layer_height):
        """Slices without policies, and with them if there are any."""
        tries = [(OURS[0], "Lamella", ())]
        if policies:
            tries.append((OURS[1], "Lamella, repaired", policies))
        return [our_view(self.program, mesh, self.folder, name, title, layer_height, options, self.timeout)
                for name, title, options in tries]

    def theirs(self, mesh, extent, layer_height):
        job = Job(mesh, self.folder / "rival", layer_height, [], extent[0][2], self.threads)
        job.folder.mkdir(exist_ok=True)
        views = []
        for rival in self.rivals:
            if mesh.suffix.lower() in READS[rival.name]:
                for old in job.folder.iterdir():
                    old.unlink()
                views.append(their_view(rival, job, extent, self.timeout))
        return views

    def finding(self, name, title, broken, policies, views, extent, expected):
        sinking = {rival.name for rival in self.rivals if rival.sinks}
        rows = [(view, difference(view, expected, LAYER_HEIGHT_MM, view.slicer in sinking) if view.ok and expected else None)
                for view in views]
        found = Finding(name, title, broken, policies, rows, extent, expected)
        if expected:
            found.z = telling_height(found)
            found.drawings = [view.draw(found.z) for view in views]
        for view in views:
            view.draw = None  # it keeps all layers in memory
        return found


def telling_height(finding):
    """Returns the height of the layer with the largest difference of the others; if they agree with the truth, of
    Lamella without mending."""
    told = [(view, off) for view, off in finding.rows if off]
    others = [off for view, off in told if view.slicer not in OURS and off.share > 0.01]
    worst = max(others or [off for _, off in told], key=lambda off: off.share)
    return min((layer.z for layer in finding.expected), key=lambda z: abs(z - worst.worst_z))
