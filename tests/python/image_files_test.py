"""Images for resin printers."""

import io
import json
import sys
import zipfile

import numpy as np
import pytest
from conftest import ROOT, box_arrays

import lamella

sys.path.append(str(ROOT / "tests" / "app"))
from png_image import Image  # noqa: E402

IMAGES = [
    ("png-zip", {"pixel_mm": 0.2}, ["--pixel-size", 0.2]),
    ("png-zip", {"pixels": (90, 80), "display_mm": (45, 40)}, ["--resolution", "90x80", "--display-size", "45,40"]),
    ("png-zip", {"pixel_mm": (0.2, 0.3), "antialias": 1}, ["--pixel-size", "0.2,0.3", "--antialias", 1]),
    ("png-zip", {"pixel_mm": 0.5, "grey_curve": [(0, 60), (0.5, 180)]}, ["--pixel-size", 0.5, "--grey-curve", "0:60,0.5:180"]),
    ("png-zip", {"part_colours": [(255, 0, 128)]}, ["--part-colours", "#ff0080"]),
    ("png-zip", {"part_colours": True}, ["--part-colours", "auto"]),
    ("png-zip", {"pixel_mm": 0.5, "orientation": "portrait", "mirror": "xy", "gamma": 2.5},
     ["--pixel-size", 0.5, "--orientation", "portrait", "--mirror", "xy", "--gamma", 2.5]),
    ("png-zip", {"pixel_mm": 0.5, "mirror": "y"}, ["--pixel-size", 0.5, "--mirror", "y"]),
    ("sl1", {"mirror": "none", "orientation": "landscape"}, ["--mirror", "none", "--orientation", "landscape"]),
    ("goo", {"printer": "mars 4 max"}, ["--printer", "mars 4 max"]),
    ("goo", {"printer": "mars 4 max", "resin": {"exposure_s": 2, "travel": {"lift_mm": 7}, "exposure_ranges": {"0:9": 35}}},
     ["--printer", "mars 4 max", "--resin", "resin.toml"]),
    ("goo", {"printer": "mars 4 max", "resin": "resin.toml", "exposure_s": 9},
     ["--printer", "mars 4 max", "--resin", "resin.toml", "--exposure", 9]),
    ("sl1s", {"exposure_s": 3, "first_exposure_s": 20.5, "fade_layers": 4},
     ["--exposure", 3, "--first-exposure", 20.5, "--fade-layers", 4]),
]  # fmt: skip


RESIN = 'exposure_s = 2\n[travel]\nlift_mm = 7\n[exposure_ranges]\n"0:9" = 35\n'


@pytest.mark.parametrize("name, keywords, options", IMAGES)
def test_options_of_images_are_those_of_the_program(program, rook, tmp_path, monkeypatch, name, keywords, options):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "resin.toml").write_text(RESIN)
    (tmp_path / "program").mkdir()
    target = tmp_path / "program" / "rook.out"
    program.succeed("slice", rook, "-o", target, "--format", name, "--layer-height", 10, *options)
    lamella.write(tmp_path / "rook.out", lamella.slice(rook, 10), format=name, **keywords)
    assert (tmp_path / "rook.out").read_bytes() == target.read_bytes()
    lamella.write(tmp_path / "rook.json", lamella.slice(rook, 10))
    lamella.convert(tmp_path / "rook.json", tmp_path / "converted.out", format=name, **keywords)
    assert (tmp_path / "converted.out").stat().st_size > 0


@pytest.mark.parametrize(
    "resin, text",
    [
        ({"exposre_s": 3}, "resin: there is no exposre_s; did you mean exposure_s?"),
        ({"travel": {"lift": 3}}, "resin: travel: there is no lift; "),
        ({"bottom_layers": 2.5}, "resin: bottom_layers: "),
        ({"travel": 3}, "resin: travel: expected a table, found "),
        ({"exposure_ranges": {"2:1": 3}}, "resin: exposure_ranges: there is 2:1, which ends where it begins or below; write the"),
        ({"exposure_ranges": {"0:1": 3, "0.5:2": 3}}, "resin: exposure_ranges: there is 0.5:2, which overlaps "),
        ({"density_g_ml": 0}, "resin: a density of 0 g/ml: choose a positive number"),
        ("bad.toml", "bad.toml: there is no exposre_s; did you mean exposure_s?"),
        (3, "resin: expected a TOML file, or a dict of its settings, found "),
    ],
)
def test_settings_of_resin_that_are_wrong_say_where(tmp_path, monkeypatch, resin, text):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bad.toml").write_text("exposre_s = 3")
    layers = lamella.Stack([lamella.Layer([[(0, 0), (4, 0), (4, 4), (0, 4)]], 1, 0, 2)])
    with pytest.raises((lamella.UsageError, TypeError)) as caught:
        lamella.write(tmp_path / "x.goo", layers, printer="mars 4 max", resin=resin)
    assert str(caught.value).startswith(text)


def test_the_time_that_builds_agree_upon_is_that_of_a_job(program, rook, tmp_path, monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    program.succeed("slice", rook, "-o", tmp_path / "rook.sl1", "--layer-height", 10)
    expected = (tmp_path / "rook.sl1").read_bytes()
    lamella.write(tmp_path / "rook.sl1", lamella.slice(rook, 10))
    assert (tmp_path / "rook.sl1").read_bytes() == expected
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "soon")
    with pytest.raises(lamella.UsageError, match='SOURCE_DATE_EPOCH is "soon"'):
        lamella.write(tmp_path / "rook.sl1", lamella.slice(rook, 10))
    lamella.write(tmp_path / "rook.cli", lamella.slice(rook, 10))


def moved_box(size, place):
    vertices, faces = box_arrays()
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    return (vertices - low) / (high - low) * size + place, faces


def ball(middle, radius, steps=40):
    """Vertices and faces of a sphere."""
    around, up = np.meshgrid(np.arange(2 * steps) * np.pi / steps, np.arange(steps + 1) * np.pi / steps, indexing="ij")
    vertices = np.stack([np.sin(up) * np.cos(around), np.sin(up) * np.sin(around), -np.cos(up)], axis=-1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(2 * steps), np.arange(steps), indexing="ij")
    a, b = i * (steps + 1) + j, (i + 1) % (2 * steps) * (steps + 1) + j
    faces = np.concatenate([np.stack([a, b, b + 1], axis=-1).reshape(-1, 3), np.stack([a, b + 1, a + 1], axis=-1).reshape(-1, 3)])
    return vertices * radius + middle, faces


def numbers_and_voxels(meshes, step, bits):
    """The numbers in the images of parts, and the voxels of the same grid."""
    file = io.BytesIO()
    stacks = [lamella.slice(mesh, z=np.arange(0.5, 10) * step + 0.013) for mesh in meshes]
    lamella.write(file, stacks, format="png-zip", pixel_mm=step, part_colours=True)
    archive = zipfile.ZipFile(file)
    manifest = json.loads(archive.read("manifest.json"))
    assert manifest["bits"] == bits
    images = [Image(archive.read(layer["file"])) for layer in manifest["layers"]]
    colours = [part["colour"] for part in manifest["parts"]]
    assert len(set(colours)) == len(meshes)
    for image in images:
        assert ["#%02x%02x%02x" % colour for colour in image.palette] == ["#000000", *colours]
    numbers = np.array([[list(row) for row in reversed(image.rows)] for image in images])
    (ux, _, u0), (_, vy, v0) = manifest["column"], manifest["row"]
    origin = ((0.5 - u0) / ux, (manifest["height"] - 0.5 - v0) / vy, manifest["layers"][0]["z"])
    return numbers, lambda of, labels: lamella.voxels(
        of, step, origin=origin, shape=numbers.shape, labels=labels, direction=np.eye(3)).array


def test_colours_of_parts_are_the_labels_of_voxels():
    boxes = [moved_box(size, place) for size, place in [
        ((4, 6, 8), (0, 0, 0)), ((6, 5, 9), (2, 3, 0)), ((3, 9, 7), (8, 0, 0)), ((9, 2, 5), (1, 2, 0))]]
    for count, bits in (1, 1), (2, 2), (3, 2), (4, 4):
        numbers, voxels = numbers_and_voxels(boxes[:count], 0.5, bits)
        assert np.array_equal(numbers, voxels(boxes[:count], True))
        assert set(np.unique(numbers)) - {0} == set(range(1, count + 1))


def test_colours_of_parts_differ_from_labels_of_voxels_only_at_their_borders():
    balls = [ball((0, 0, 5), 5), ball((3, 2.5, 5), 4.2), ball((-4, 1, 5), 3)]
    numbers, voxels = numbers_and_voxels(balls, 0.25, 2)
    labels = voxels(balls, True)
    at_borders = np.zeros(labels.shape, dtype=bool)
    for one in balls:
        coverage = voxels([one], False)
        at_borders |= (coverage > 0) & (coverage < 255)
    differ = numbers != labels
    assert not (differ & ~at_borders).any()
    assert differ.sum() < 0.1 * at_borders.sum() and (numbers > 0).sum() == pytest.approx((labels > 0).sum(), rel=0.01)


def test_images_in_colours_are_read_as_material(tmp_path):
    boxes = [moved_box((4, 6, 8), (0, 0, 0)), moved_box((6, 5, 8), (2, 3, 0))]
    stacks = [lamella.slice(box, 1) for box in boxes]
    lamella.write(tmp_path / "parts.zip", stacks, pixel_mm=0.5, part_colours=[(0, 0, 1), (1, 0, 0)])
    lamella.write(tmp_path / "white.zip", stacks, pixel_mm=0.5, antialias=1)
    colours, white = (lamella.read_layers(tmp_path / name) for name in ("parts.zip", "white.zip"))
    assert [layer.area for layer in colours] == [layer.area for layer in white] == [24 + 30 - 6] * 8
