"""Images for resin printers."""

import pytest

import lamella

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
    ("sl1s", {"exposure_s": 3, "first_exposure_s": 20.5, "fade_layers": 4},
     ["--exposure", 3, "--first-exposure", 20.5, "--fade-layers", 4]),
]  # fmt: skip


@pytest.mark.parametrize("name, keywords, options", IMAGES)
def test_options_of_images_are_those_of_the_program(program, rook, tmp_path, name, keywords, options):
    (tmp_path / "program").mkdir()
    target = tmp_path / "program" / "rook.out"
    program.succeed("slice", rook, "-o", target, "--format", name, "--layer-height", 10, *options)
    lamella.write(tmp_path / "rook.out", lamella.slice(rook, 10), format=name, **keywords)
    assert (tmp_path / "rook.out").read_bytes() == target.read_bytes()
    lamella.write(tmp_path / "rook.json", lamella.slice(rook, 10))
    lamella.convert(tmp_path / "rook.json", tmp_path / "converted.out", format=name, **keywords)
    assert (tmp_path / "converted.out").stat().st_size > 0


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
