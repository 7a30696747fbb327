"""Scan vectors in Python."""

import copy
import dataclasses
import io
import pickle

import numpy as np
import pytest
from conftest import box_arrays

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


def test_material_that_no_vector_reaches_is_measured():
    thin = lamella.Layer([[(20, 0), (20.08, 0), (20.08, 5), (20, 5)], *square(10)], 0.05, 0, 0.1)
    strategy = lamella.ScanStrategy()
    strategy.contours.thin_walls = strategy.support.contours.thin_walls = "leave out"
    for support in [False, True]:
        assert [layer.unreached_mm2 for layer in lamella.scan([square(10)], support=support)] == [0]
        (layer,) = lamella.scan([thin], strategy, support=support)
        assert np.isclose(layer.unreached_mm2, 0.4)
        (layer,) = lamella.scan([thin], support=support)
        assert layer.unreached_mm2 < strategy.accepted_mm2
        assert len(layer.layers[1].hatches) == 1


def test_hashes_of_vectors_see_their_order():
    hatches = [
        layer.layers[0]
        for pattern in ["lines", "meander", "lines"]
        for layer in lamella.scan([square(10)], {"hatch": {"pattern": pattern}})
    ]
    assert hatches[0] == hatches[2] != hatches[1]
    assert hatches[0].hash == hatches[2].hash != hatches[1].hash


def test_what_no_vectors_are_made_of_is_reported(tmp_path):
    """At once of a stack, and of other layers at their end; in the words of the program."""
    inward = lamella.Mesh(*box_arrays(inward=True))
    with pytest.warns(lamella.DefectWarning, match="^the mesh: 10 rings bound no material in 10 of 10 layers, first at z = 0.5 mm") as told:
        stack = lamella.slice(inward, 1)
    assert len(told) == 1
    assert "orient=True corrects" in str(told[0].message)
    inside_out = "^layers: 10 rings bound no material in 10 of 10 layers, first at z = 0.5 mm .* filled\\(\"nonzero\"\\) turns"
    with pytest.warns(lamella.DefectWarning, match=inside_out):
        lamella.scan(stack)
    for layers in [lamella.iter_layers(inward, 1), iter(stack)]:
        with pytest.warns(lamella.DefectWarning, match=inside_out):
            assert sum(len(layer.vectors) for layer in lamella.scan(layers)) == 0
    square = '{"index":0,"z":1,"bottom":0,"top":2,"parts":[{"rings":[[0,0,9,0,9,9,0,9]],"chains":[[1,1,2,2]],"hatches":[1,1,2,1]}]}'
    header = '{"format":"lamella layers","version":1,"units":"mm","parts":[{"label":"part"}],"layers":['
    (tmp_path / "a.json").write_text(header + square + "]}")
    read = lamella.read(tmp_path / "a.json")
    with pytest.warns(lamella.DefectWarning) as told:
        lamella.scan(read)
    assert [str(warning.message) for warning in told] == [
        f"{tmp_path}/a.json: 1 open contour left out in 1 of 1 layer, first at z = 1 mm: only closed contours bound material",
        f"{tmp_path}/a.json: 1 hatch line left out: layers are hatched anew",
    ]


@pytest.mark.filterwarnings("ignore:.* spot sizes were left out")
@pytest.mark.parametrize(
    "options, keywords",
    [
        (["--layers", "4:6"], {"layers": (4, 6)}),
        (["--layers", "38:99"], {"layers": (38, 99)}),
        (["--z-range", "0:2"], {"z_range": (0, 2)}),
    ],
)
def test_skins_see_the_layers_beside_those_that_are_sliced(program, bodies, tmp_path, options, keywords):
    box = bodies("box", "--size", 10)
    skins = {"upskin": {"layers": 3}, "downskin": {"layers": 2}}
    (tmp_path / "skins.toml").write_text("upskin.layers = 3\ndownskin.layers = 2\n")
    slicing = ["--layer-height", 0.25, *options, "--strategy", tmp_path / "skins.toml"]
    program.succeed("slice", box, "-o", tmp_path / "program.ovf", *slicing)
    stream = lamella.iter_layers(box, 0.25, **keywords)
    lamella.write(tmp_path / "python.ovf", lamella.scan(stream, skins))
    assert (tmp_path / "python.ovf").read_bytes() == (tmp_path / "program.ovf").read_bytes()


def test_skins_see_the_layers_that_were_taken_from_a_stream(bodies):
    skins = {"downskin": {"layers": 2}}
    stream = lamella.iter_layers(bodies("box", "--size", 10), 0.25)
    everything = list(lamella.scan(lamella.slice(bodies("box", "--size", 10), 0.25), skins))
    next(stream)
    assert list(lamella.scan(stream, skins)) == everything[1:]


@pytest.mark.filterwarnings("error")
def test_skins_at_the_ends_of_a_piece_of_a_part_are_warned_of(bodies, tmp_path):
    box = bodies("box", "--size", 10)
    stack = lamella.slice(box, 0.25)
    lamella.write(tmp_path / "box.json", stack)
    below, above = {"downskin": {"layers": 1}}, {"upskin": {"layers": 1}}
    for middle in [stack[4:6], lamella.slice(box, 0.25, layers=(4, 6)), lamella.slice(box, 0.25, z_range=(1, 1.5)),
                   pickle.loads(pickle.dumps(stack[4:6])), lamella.read(tmp_path / "box.json")[4:6]]:  # fmt: skip
        for strategy, sides in [(below, "below"), (above, "above"), ({**below, **above}, "below and above")]:
            with pytest.warns(lamella.DefectWarning, match=f"^layers: those {sides} are not in the stack"):
                lamella.scan(middle, strategy)
        lamella.scan(middle)
        lamella.scan(middle, {**below, **above}, support=True)
    for whole in [stack, lamella.slice(box, 0.25, layers=(0, 999)), lamella.Stack(list(stack[4:6]))]:
        lamella.scan(whole, {**below, **above})
    lamella.scan(stack[:4], below)
    lamella.scan(stack[4:], above)


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


def test_points_that_a_file_moved_off_straight_ways_are_left_out(tmp_path):
    side = np.linspace(0, 10, 101)
    turned = np.array([[np.cos(0.5), np.sin(0.5)], [-np.sin(0.5), np.cos(0.5)]])
    ring = np.concatenate([np.column_stack([side, 0 * side]), [(10, 10), (0, 10)]]) @ turned
    lamella.write(tmp_path / "a.cli", lamella.Stack([lamella.Layer([ring], 0.05, 0, 0.1, 0)]))
    read = lamella.read(tmp_path / "a.cli")
    plain = {"contours": {"count": 1}}

    def points_of_contours(layers, support):
        (layer,) = lamella.scan(layers, plain, support=support)
        return [len(vectors.points) for exposure, vectors in layer if exposure.kind == "contour"]

    for support in [False, True]:
        assert points_of_contours(read, support) == [4]
        assert points_of_contours(iter(read), support)[0] > 4


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


@pytest.mark.filterwarnings("ignore:.*parameters of scan vectors")
def test_files_of_vectors_are_verified(tmp_path):
    strategy = {"contours": {"count": 2}}
    layers = [square(10, z=0.05 + 0.1 * i, index=i) for i in range(5)]
    scanned = list(lamella.scan(layers, strategy))
    path = tmp_path / "job.cli"

    lamella.write(path, scanned)
    cube = tmp_path / "cube.stl"
    corners = np.array([(x, y, z) for z in (0, 0.5) for y in (0, 10) for x in (0, 10)], float)
    faces = [(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4),
             (2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5)]  # fmt: skip
    lamella.write(cube, lamella.Mesh(corners, faces))
    found = lamella.verify_vectors(path, cube, strategy=strategy)
    assert found.ok and found.findings == [] and found.layers == 5
    assert found.contour_vectors == 5 * 8 and found.hatch_vectors == sum(len(s.layers[0].hatches) for s in scanned)
    assert found.unreached_layers == 0 and found.unreached_mm2 == 0
    assert lamella.verify_vectors(path, (corners * 0.9, faces)).outside > 0
    assert lamella.verify_vectors(path, (corners * 0.9999, faces), tolerance=0.01).outside == 0
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
    marked = tmp_path / "marked.toml"
    marked.write_bytes(b"\xef\xbb\xbf" + path.read_bytes().replace(b"\n", b"\r\n"))
    for strategy in (path, str(path), tables, marked):
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
        ({"hatch": {"parameters": ""}, "parameters": {"": {}}}, "strategy: hatch.parameters: expected the name of a parameter set, found an empty text"),
        ({"hatches": {}}, "strategy: there is no hatches; did you mean hatch?"),
        ({"hatch": {"distance": 0}}, "`hatch.distance` is 0, but has to be above 0"),
        ({"hatch": {"pattern": "zigzag"}}, 'hatch.pattern: "zigzag" is none of "lines", "meander", "stripes", "chessboard" and'),
        ({"contours": {"count": -1}}, "strategy: contours.count: -1 is not possible; expected a whole number from 0 to"),
        ({"upskin": {"layers": 2**40}}, "strategy: upskin.layers: 1099511627776 is not possible"),
        ({"seed": -1}, "strategy: seed: -1 is not possible; expected a whole number, 0 or more"),
        ({"support": {"hatch": {"cell": np.inf}}}, "strategy: support.hatch.cell: inf is not possible"),
        ({"parameters": {"hatch": {"name": "fast"}}}, "strategy: parameters.hatch: there is no name"),
        ({"hatch": {"parameters": "slow"}}, "there are no parameters slow"),
        ({"parameters": {"slow": {}}}, "the parameters slow are used nowhere"),
    ],
)
def test_strategies_that_are_wrong_say_where(tables, text):
    with pytest.raises(lamella.UsageError) as caught:
        list(lamella.scan([square(10)], tables))
    assert text in str(caught.value)


@pytest.mark.parametrize(
    "strategy, text",
    [
        (5, "strategy: expected a ScanStrategy, a TOML file, or a dict of tables, found 5"),
        ({"hatch": 3}, "strategy: hatch: expected a table, found 3"),
        ({"hatch": {"distance": "wide"}}, "strategy: hatch.distance: expected a finite number, found 'wide'"),
        ({"hatch": {"distance": {}}}, "strategy: hatch.distance: expected a finite number, found an object of type dict"),
        ({"hatch": {"distance": {"x": 1}}}, "strategy: hatch.distance: expected a finite number, found an object of type"),
        ({"hatch": {"distance": True}}, "strategy: hatch.distance: expected a finite number, found True"),
        ({"contours": {"count": True}}, "strategy: contours.count: expected a whole number"),
        ({"contours": {"count": 1.5}}, "strategy: contours.count: expected a whole number"),
        ({"contours": {"before_hatch": 1}}, "strategy: contours.before_hatch: expected True or False, found 1"),
        ({"hatch": {"pattern": 5}}, 'strategy: hatch.pattern: expected "lines", '),
        ({"hatch": {"parameters": []}}, "strategy: hatch.parameters: expected a text, found an object of type list"),
        ({"parameters": {5: {}}}, "strategy: parameters: expected a text, found 5"),
    ],
)
def test_wrong_types_are_type_errors(strategy, text):
    with pytest.raises(TypeError) as caught:
        lamella.scan([square(10)], strategy)
    assert str(caught.value).startswith(text)


def test_layers_of_wrong_types_are_type_errors():
    with pytest.raises(TypeError):
        list(lamella.scan([1, 2]))


def test_layers_that_do_not_ascend_are_refused():
    layers = [square(10, z) for z in (0.05, 0.25, 0.15)]
    for support in (False, True):
        scanned = lamella.scan(layers, {"hatch": {"distance": 1}}, support=support)
        with pytest.raises(lamella.UsageError, match=r"^layers: must ascend in z: 0\.15 mm comes after 0\.25 mm$"):
            list(scanned)


def test_a_strategy_is_that_of_the_call():
    strategy = lamella.ScanStrategy()
    expected = list(lamella.scan([square(10)], strategy))
    scanned = lamella.scan([square(10)], strategy)
    strategy.hatch.distance = 1
    strategy.hatch.parameters.power_w = 7
    assert list(scanned) == expected
    exposure = expected[0].exposures[0]
    exposure.parameters.power_w = 7
    assert exposure.parameters.power_w == 200, "parameters of an exposure are a copy"


@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_what_scanning_takes_and_gives_is_copied_and_compared(protocol):
    strategy = lamella.ScanStrategy()
    strategy.upskin.hatch.pattern = "hexagons"
    strategy.support.contours.parameters.name = "caf\udce9"
    strategy.seed = 2**63
    scanned = next(lamella.scan([square(10)], strategy, "a\udcff"))
    for thing in (strategy, strategy.hatch, strategy.upskin, strategy.hatch.parameters, scanned, scanned.exposures,
                  scanned.figures):  # fmt: skip
        for same in (pickle.loads(pickle.dumps(thing, protocol)), copy.deepcopy(thing)):
            assert same == thing and same is not thing and type(same) is type(thing)
    assert hash(scanned) == hash(copy.deepcopy(scanned))
    assert strategy != lamella.ScanStrategy() and strategy != 5 and strategy.hatch != lamella.HatchRule
    assert strategy.hatch == lamella.HatchRule() and scanned.exposures[0] != scanned.exposures[1]
    assert scanned.figures[0] != scanned.figures[1]


def test_attributes_with_few_values_list_them():
    for attribute, values in [
        (lamella.HatchRule.pattern, ["lines", "meander", "stripes", "chessboard", "hexagons"]),
        (lamella.HatchRule.order, ["rows", "random"]),
        (lamella.ContourRule.order, ["inside-out", "outside-in"]),
        (lamella.ContourRule.start, ["aligned", "sharpest", "random"]),
    ]:
        assert attribute.__doc__.endswith(": " + ", ".join(f'"{value}"' for value in values))


def test_attributes_of_strategies_distinguish_wrong_types_from_wrong_values():
    contours = lamella.ContourRule()
    with pytest.raises(lamella.UsageError, match="^count: -1 is not possible"):
        contours.count = -1
    with pytest.raises(lamella.UsageError, match='^order: "upwards" is none of "inside-out" and "outside-in"$'):
        contours.order = "upwards"
    for attribute, value in [("count", True), ("count", "1"), ("distance", False), ("before_hatch", 1), ("order", 1)]:
        with pytest.raises(TypeError, match=f"^{attribute}: expected "):
            setattr(contours, attribute, value)
    with pytest.raises(TypeError, match="^name: expected a text, found 5$"):
        contours.parameters.name = 5
    assert (contours.count, contours.distance, contours.before_hatch) == (1, 0.1, False)
    contours.count, contours.distance, contours.before_hatch = np.int64(2), np.float32(0.5), np.bool_(True)
    assert (contours.count, contours.distance, contours.before_hatch) == (2, 0.5, True)


def test_names_need_not_be_utf_8():
    strategy = {"hatch": {"parameters": "caf\udce9"}, "parameters": {"caf\udce9": {"power_w": 7}}}
    (layer,) = lamella.scan([square(10)], strategy, "a\udcff")
    exposure = layer.exposures[0]
    assert next(lamella.scan([square(10)], part="")).exposures[0].part == "part"
    assert (exposure.part, exposure.parameters.name) == ("a\udcff", "caf\udce9")
    assert repr(exposure) == "<lamella.Exposure a\udcff core hatch>"


def test_scan_layers_have_a_layer_for_each_exposure():
    (layer,) = lamella.scan([square(10)])
    with pytest.raises(lamella.UsageError, match="^layers: expected 2, one for each exposure, found 1$"):
        dataclasses.replace(layer, layers=layer.layers[:1])
    with pytest.raises(lamella.UsageError, match="^layers: index, z, bottom and top must be those of the scan layer$"):
        dataclasses.replace(layer, layers=(layer.layers[0], square(10, z=9)))


def test_files_of_pyslm_find_what_they_look_for():
    (layer,) = lamella.scan([square(10)])
    pyslm = lamella.to_pyslm(layer, mid=3)
    assert pyslm.z == 100 and pyslm.layerId == 0
    (hatch,) = pyslm.getHatchGeometry()
    (contour,) = pyslm.getContourGeometry()
    assert hatch.coords.shape == (2 * len(layer.layers[0].hatches), 2) and hatch.bid == 1 and hatch.mid == 3
    assert (contour.coords[0] == contour.coords[-1]).all() and contour.bid == 2
    assert pyslm.getGeometry() == [hatch, contour] and pyslm.getPointsGeometry() == []


def test_strategies_may_be_derived():
    class Fine(lamella.ScanStrategy):
        def __init__(self, distance):
            super().__init__()
            self.hatch.distance = distance

        def lines_per_mm(self):
            return 1 / self.hatch.distance

    fine = Fine(0.05)
    assert fine == Fine(0.05) and fine != Fine(0.06)
    assert copy.deepcopy(fine) == fine
    (scanned,) = lamella.scan([square(10)], fine)
    assert scanned == next(lamella.scan([square(10)], {"hatch": {"distance": 0.05}}))


def changed_strategy():
    strategy = lamella.ScanStrategy()
    strategy.seed = 2**63 - 1
    strategy.hatch.pattern, strategy.hatch.distance = "chessboard", 1 / 3
    strategy.upskin.layers = 3
    strategy.upskin.hatch.parameters.name = 'fine "lines" \\ of\n\x7f\u00e4'
    strategy.contours.parameters.power_w = 123.456
    strategy.contours.before_hatch = not strategy.contours.before_hatch
    return strategy


def test_strategies_are_written_as_the_program_reads_them(program, tmp_path):
    layers = [square(10, 0.05 + 0.1 * i, i) for i in range(3)]
    for strategy in (lamella.ScanStrategy(), changed_strategy()):
        path = tmp_path / "strategy.toml"
        path.write_text(strategy.to_toml(), encoding="utf-8")
        assert program.succeed("strategy", "show", path).decode() == strategy.to_toml()
        # Whatever is taken as a file.
        for file in (path, path.read_bytes(), io.BytesIO(path.read_bytes())):
            assert list(lamella.scan(layers, file)) == list(lamella.scan(layers, strategy))
    assert lamella.ScanStrategy().to_toml() == program.succeed("strategy", "show").decode()


def test_a_strategy_that_a_file_cannot_hold_is_refused():
    strategy = lamella.ScanStrategy()
    strategy.hatch.parameters.name = strategy.contours.parameters.name
    with pytest.raises(lamella.UsageError, match='several sets of parameters with the name "contour"'):
        strategy.to_toml()
    strategy.hatch.parameters.name = ""
    with pytest.raises(lamella.UsageError, match="no name"):
        strategy.to_toml()
    strategy = lamella.ScanStrategy()
    strategy.seed = 2**63
    with pytest.raises(lamella.UsageError, match="the seed is 9223372036854775808, and TOML"):
        strategy.to_toml()
    strategy.hatch.distance = -1
    with pytest.raises(lamella.UsageError, match="distance"):
        strategy.to_toml()


def test_strategies_show_their_values():
    strategy = changed_strategy()
    text = repr(strategy)
    assert text.startswith("ScanStrategy(") and "object at" not in text
    for shown in ("pattern='chessboard'", f"distance={1 / 3!r}", "layers=3", "power_w=123.456", repr(strategy.support)):
        assert shown in text
    (layer,) = lamella.scan([square(10)])
    assert repr(layer.figures[1]).startswith("ScanFigures(vectors=4, marked_mm=39.")
    for make in (changed_strategy, lamella.ScanStrategy):
        assert make() == make() and make().hatch == make().hatch and make().upskin.hatch == make().upskin.hatch
    assert changed_strategy() != lamella.ScanStrategy()


RULES = [lamella.ContourRule, lamella.HatchRule, lamella.SkinRule, lamella.SupportRule, lamella.ScanStrategy, lamella.ParameterSet]


@pytest.mark.parametrize("rule", RULES)
def test_rules_are_made_by_keywords_and_their_text_makes_them_again(rule):
    default = rule()
    assert rule(**{name: getattr(default, name) for name in vars(rule) if isinstance(vars(rule)[name], property)}) == default
    assert eval(repr(default), vars(lamella)) == default
    strategy = changed_strategy()
    assert eval(repr(strategy), vars(lamella)) == strategy
    with pytest.raises(TypeError, match="got an unexpected keyword argument 'colour'"):
        rule(colour=1)


def test_keywords_of_rules_are_their_attributes():
    strategy = lamella.ScanStrategy(
        hatch=lamella.HatchRule(pattern="chessboard", distance=0.08, parameters=lamella.ParameterSet(name="mild", power_w=90)),
        seed=7,
    )
    assert strategy.hatch.pattern == "chessboard" and strategy.hatch.cell == lamella.HatchRule().cell
    assert strategy.hatch.parameters.power_w == 90 and strategy.contours == lamella.ContourRule()
    other = lamella.ParameterSet(strategy.hatch.parameters, power_w=95)
    assert (other.name, other.power_w, strategy.hatch.parameters.power_w) == ("mild", 95, 90)
    with pytest.raises(lamella.UsageError, match='^pattern: "hexagon" is none of .*; did you mean "hexagons"'):
        lamella.HatchRule(pattern="hexagon")
    with pytest.raises(TypeError, match="did you mean 'distance'"):
        lamella.HatchRule(distanc=1)


def test_strategies_are_made_of_toml(tmp_path):
    strategy = changed_strategy()
    text = strategy.to_toml()
    assert str(strategy) == text
    path = tmp_path / "strategy.toml"
    path.write_bytes(text.encode(errors="surrogateescape"))
    for source in (text, path, str(path), path.read_bytes(), io.BytesIO(path.read_bytes())):
        assert lamella.ScanStrategy.from_toml(source) == strategy
    assert lamella.ScanStrategy.from_toml("seed = 9") == lamella.ScanStrategy(seed=9)
    with pytest.raises(lamella.InputError, match="there is no such file"):
        lamella.ScanStrategy.from_toml(tmp_path / "missing.toml")
    with pytest.raises(lamella.UsageError, match="there is no sead; did you mean seed"):
        lamella.ScanStrategy.from_toml("sead = 9")
    with pytest.raises(TypeError, match="^source: expected a path, bytes, a binary file, or the text of a TOML file, found 5$"):
        lamella.ScanStrategy.from_toml(5)


def test_scanned_layers_are_counted():
    stack = lamella.slice(box_arrays(), 2)
    scanned = lamella.scan(stack)
    assert isinstance(scanned, lamella.ScanStream) and len(scanned) == len(stack)
    next(scanned)
    assert len(scanned) == len(stack) - 1 and len(list(scanned)) == len(stack) - 1 and len(scanned) == 0
