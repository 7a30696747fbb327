"""Scan vectors in Python."""

import numpy as np
import pytest

import lamella


def square(size, z=0.05, index=0):
    return lamella.Layer([[(0, 0), (size, 0), (size, size), (0, size)]], z, z - 0.05, z + 0.05, index)


def test_vectors_are_views_and_lines(tmp_path):
    (layer,) = lamella.scan([square(10)])
    assert [exposure.name for exposure in layer.exposures] == ["core hatch", "core contour 1"]
    hatch, contour = layer.layers
    assert hatch.hatches.base is not None and not hatch.hatches.flags.writeable
    assert contour.rings == 1
    lines = layer.vectors
    assert lines.shape == (len(hatch.hatches) + 4, 2, 2)
    assert (np.bincount(layer.exposure) == [len(hatch.hatches), 4]).all()
    assert np.isclose(contour.perimeter, 4 * 9.9)
    figures = layer.figures
    assert np.isclose(figures[1].marked_mm, 4 * 9.9)
    assert figures[0].vectors == len(hatch.hatches) and figures[0].energy_j > 0


def test_hatch_lines_are_those_that_shapely_cuts():
    shapely = pytest.importorskip("shapely.geometry")
    strategy = lamella.ScanStrategy()
    strategy.contours.count = 0
    strategy.hatch.border = 0
    strategy.hatch.shortest = 0
    strategy.hatch.pattern = "lines"
    strategy.hatch.distance = 0.37
    strategy.hatch.angle_degrees = 0
    ring = [(0, 0.1), (7, 0.2), (9.3, 5), (4, 3.3), (2.2, 8.1)]
    hole = [(3, 1), (3, 2), (5, 2), (5, 1)]
    layer = lamella.Layer([ring, hole], 0)
    (scanned,) = lamella.scan([layer], strategy)
    found = {}
    for a, b in scanned.vectors:
        found.setdefault(round(a[1] / 0.37), []).append(tuple(sorted((a[0], b[0]))))
    body = shapely.Polygon(ring, [hole])
    for k in range(-1, 24):
        cut = body.intersection(shapely.LineString([(-1, k * 0.37), (10, k * 0.37)]))
        pieces = [piece for piece in getattr(cut, "geoms", [cut]) if piece.length > 0]
        expected = sorted((min(x for x, _ in p.coords), max(x for x, _ in p.coords)) for p in pieces)
        assert np.allclose(np.array(sorted(found.get(k, []))).ravel(), np.array(expected).ravel())


def test_skins_see_the_layers_around(tmp_path):
    strategy = {"upskin": {"layers": 2}, "downskin": {"layers": 1}}
    layers = [square(10, 0.05 + 0.1 * i, i) for i in range(5)]
    have = [
        {e.region for e, vectors in layer if e.kind == "hatch" and len(vectors.hatches)}
        for layer in lamella.scan(iter(layers), strategy)
    ]
    assert have == [{"downskin"}, {"core"}, {"core"}, {"upskin"}, {"upskin"}]


def test_supports_have_rules_of_their_own():
    strategy = {"upskin": {"layers": 3}, "support": {"contours": {"count": 2}, "hatch": {"distance": 1.5, "parameters": "slow"}},
                "parameters": {"slow": {"speed_mm_s": 7}}}
    layers = [square(10, 0.05 + 0.1 * i, i) for i in range(2)]
    scanned = list(lamella.scan(layers, strategy, "foot", support=True))
    assert [layer.index for layer in scanned] == [0, 1]
    assert [e.name for e in scanned[0].exposures] == ["support hatch", "support contour 2", "support contour 1"]
    assert {e.part for e in scanned[0].exposures} == {"foot"} and {e.region for e in scanned[0].exposures} == {"support"}
    assert scanned[0].exposures[0].parameters.speed_mm_s == 7
    plain = {"contours": {"count": 2}, "hatch": {"distance": 1.5, "pattern": "meander"}}
    for one, other in zip(scanned, lamella.scan(layers, plain)):
        assert (one.vectors == other.vectors).all()
    with pytest.raises(TypeError):
        lamella.scan(layers, support="yes")


def test_files_of_vectors_are_verified(tmp_path):
    strategy = {"contours": {"count": 2}}
    layers = [square(10, z=0.05 + 0.1 * i, index=i) for i in range(5)]
    scanned = list(lamella.scan(layers, strategy))
    path = tmp_path / "job.cli"

    def write(vectors):
        names = [f"part {exposure.name}" for exposure in vectors[0].exposures]
        stacks = [lamella.Stack([layer.layers[k] for layer in vectors], name) for k, name in enumerate(names)]
        lamella.write(path, stacks)

    write(scanned)
    cube = tmp_path / "cube.stl"
    corners = np.array([(x, y, z) for z in (0, 0.5) for y in (0, 10) for x in (0, 10)], float)
    faces = [(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4),
             (2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5)]  # fmt: skip
    lamella.write(cube, lamella.Mesh(corners, faces))
    found = lamella.verify_vectors(path, cube, strategy=strategy)
    assert found.ok and found.findings == [] and found.layers == 5
    assert found.contour_vectors == 5 * 8 and found.hatch_vectors == sum(len(s.layers[0].hatches) for s in scanned)
    assert found.cover == pytest.approx(1, abs=0.1)
    assert lamella.verify_vectors(path).cover is None
    assert lamella.verify_vectors(path, (corners * 0.9, faces)).outside > 0
    assert not lamella.verify_vectors(path, cube, strategy={"contours": {"beam_offset": 0.2}}).ok
    with pytest.raises(lamella.UsageError, match="job.cli holds scan vectors, which lamella.verify_vectors checks"):
        lamella.verify(path)
    lamella.write(path, lamella.Stack(layers))
    with pytest.raises(lamella.UsageError, match="job.cli holds no scan vectors; lamella.verify checks layers"):
        lamella.verify_vectors(path)
    with pytest.raises(lamella.UsageError, match="unit_mm goes with a mesh"):
        lamella.verify_vectors(path, unit_mm=1)
    with pytest.raises(TypeError):
        lamella.verify_vectors(lamella.Stack(layers))


def test_strategies_come_from_files_and_dicts(tmp_path):
    path = tmp_path / "s.toml"
    path.write_text('[hatch]\ndistance = 0.5\nparameters = "fast"\n[parameters.fast]\nspeed_mm_s = 1500\n')
    tables = {"hatch": {"distance": 0.5, "parameters": "fast"}, "parameters": {"fast": {"speed_mm_s": 1500}}}
    for strategy in (path, str(path), tables):
        (layer,) = lamella.scan([square(10)], strategy)
        assert layer.exposures[0].parameters.name == "fast"
        assert layer.exposures[0].parameters.speed_mm_s == 1500
        assert layer.exposures[1].parameters.name == "contour"
    (by_hand,) = lamella.scan([square(10)], {"hatch": {"distance": 0.5}})
    assert (by_hand.vectors == layer.vectors).all()


@pytest.mark.parametrize(
    "tables, text",
    [
        ({"hatch": {"distnace": 1}}, "strategy: hatch: there is no distnace; did you mean distance?"),
        ({"hatches": {}}, "strategy: there is no hatches; did you mean hatch?"),
        ({"hatch": {"distance": 0}}, "`hatch.distance` is 0, but has to be above 0"),
        ({"hatch": {"pattern": "zigzag"}}, "there are lines, meander, stripes, chessboard, hexagons"),
        ({"hatch": {"parameters": "slow"}}, "there are no parameters slow"),
        ({"parameters": {"slow": {}}}, "the parameters slow are used nowhere"),
    ],
)
def test_strategies_that_are_wrong_say_where(tables, text):
    with pytest.raises(lamella.UsageError) as caught:
        list(lamella.scan([square(10)], tables))
    assert text in str(caught.value)


def test_wrong_types_are_type_errors():
    for strategy in (5, {"hatch": {"distance": "wide"}}, {"hatch": 3}):
        with pytest.raises(TypeError):
            lamella.scan([square(10)], strategy)
    with pytest.raises(TypeError):
        list(lamella.scan([1, 2]))


def test_files_of_pyslm_find_what_they_look_for():
    (layer,) = lamella.scan([square(10)])
    pyslm = lamella.to_pyslm(layer, mid=3)
    assert pyslm.z == 100 and pyslm.layerId == 0
    (hatch,) = pyslm.getHatchGeometry()
    (contour,) = pyslm.getContourGeometry()
    assert hatch.coords.shape == (2 * len(layer.layers[0].hatches), 2) and hatch.bid == 1 and hatch.mid == 3
    assert (contour.coords[0] == contour.coords[-1]).all() and contour.bid == 2
    assert pyslm.getGeometry() == [hatch, contour] and pyslm.getPointsGeometry() == []
