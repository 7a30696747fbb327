"""Each call of docs/coming-from.md runs, also those that need shapely or matplotlib."""

import re
import shutil
import zipfile

from conftest import ROOT, samples

import lamella


def write_3mf(path, mesh):
    vertices = "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in mesh.vertices)
    triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in mesh.faces)
    with zipfile.ZipFile(path, "w") as package:
        package.writestr("[Content_Types].xml", "<Types/>")
        package.writestr("_rels/.rels", '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
                         '<Relationship Target="/3D/3dmodel.model" Id="r" '
                         'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>')
        package.writestr("3D/3dmodel.model", '<model unit="millimeter" '
                         'xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>'
                         f'<object id="1"><mesh><vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh></object>'
                         '</resources><build><item objectid="1"/></build></model>')


def test_what_users_of_other_libraries_call_here_runs(rook, tmp_path, monkeypatch):
    shutil.copy(rook, tmp_path / "part.stl")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("webbrowser.open", lambda address: True)
    page = (ROOT / "docs/coming-from.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| .* \| `([^|]*)` \|$", page, re.MULTILINE)
    tables = page.count("|---|---|")
    lines = len(re.findall(r"^\|", page, re.MULTILINE))
    assert len(rows) == lines - 2 * tables > 60, "each row has code"
    write_3mf(tmp_path / "part.3mf", lamella.read_mesh("part.stl"))
    lamella.write("layers.3mf", lamella.slice("part.stl", 1))
    names = {}
    (prepared,) = samples("docs/coming-from.md")
    exec(compile(prepared, "docs/coming-from.md", "exec"), names)
    for row in rows:
        exec(compile(row, row, "exec"), names)
