"""Jobs for resin printers as a reader sees them that shares no code with their writer (resin_files.py): their pixels are
those of the images that `png-zip` makes for the same printer, and their settings those that were given. Where vendors'
files are at hand, our codes give the vendors' bytes for their images.

Needs LAMELLA_PROGRAM, and LAMELLA_ENCODE_RUNS (tests/slices/images/encode_runs.cpp) and LAMELLA_SHARED for the vendors' files.
"""

import io
import json
import lzma
import os
import struct
import subprocess
import sys
import zipfile
from pathlib import Path

try:
    import numpy as np
    import pytest
except ImportError:
    print("no NumPy or pytest: skipped")
    sys.exit(0)

sys.path.insert(0, str(Path(__file__).resolve().parent))
import resin_files  # noqa: E402

PROGRAM = os.environ["LAMELLA_PROGRAM"]
SAMPLES = Path(os.environ.get("LAMELLA_SHARED", "")) / "resin" / "samples"
LAYERS = 12
HEIGHT = 0.1

# Printer, extension, format and version of the file, values of grey as the file shows them.
PRINTERS = [
    ("Elegoo Mars 4 DLP", ".goo", "goo", "3.0", lambda v: v),
    ("Phrozen Sonic Mini 8K S", ".prz", "goo", "3.0", lambda v: v),
    ("Creality LD-002H", ".ctb", "ctb", 3, lambda v: resin_files.GREY_CTB[v >> 1]),
    ("Elegoo Mars 2", ".ctb", "ctb", 4, lambda v: resin_files.GREY_CTB[v >> 1]),
    ("Anycubic Photon", ".photon", "cbddlp", 2, lambda v: resin_files.grey_of_sets(4)[
        sum((v >= threshold).astype(np.uint8) for threshold in (63, 127, 191, 255))]),
    ("Anycubic Photon Mono", ".pwmo", "anycubic", 515, lambda v: (v >> 4) * np.uint8(17)),
    ("Anycubic Photon Ultra", ".dlp", "anycubic", 516, lambda v: (v >> 4) * np.uint8(17)),
    ("Anycubic Photon Mono SE", ".pwms", "anycubic", 516, lambda v: v),
    ("Phrozen Sonic", ".zip", "chitubox-zip", None, lambda v: v),
    ("Phrozen Shuffle", ".zip", "chitubox-zip", None, lambda v: v),
    ("Uniz IBEE (Klipper)", ".zip", "chitubox-zip", None, lambda v: v),
    ("Concepts3D Athena 8K", ".nanodlp", "nanodlp", 1, lambda v: v),
    ("Original Prusa SL1S", ".sl1s", "sl1", None, lambda v: v),
]
NAMES = [row[0] for row in PRINTERS]
MIRRORED = {"Phrozen Shuffle": (False, False), "Uniz IBEE (Klipper)": (False, True)}


@pytest.fixture(scope="module")
def part(tmp_path_factory):
    """A tetrahedron with no symmetry, so that no mirroring leaves its layers as they are."""
    corners = [(0, 0, 0), (9, 1, 0), (1, 5, 0), (2, 1, LAYERS * HEIGHT)]
    text = "solid part\n"
    for triangle in ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)):
        text += "facet normal 0 0 0\nouter loop\n"
        text += "".join("vertex {} {} {}\n".format(*corners[k]) for k in triangle) + "endloop\nendfacet\n"
    path = tmp_path_factory.mktemp("part") / "part.stl"
    path.write_text(text + "endsolid part\n")
    return path


def run(*arguments):
    result = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    return result


def sliced(part, path, printer, *options):
    run("slice", part, "-o", path, "--printer", printer, "--layer-height", HEIGHT, "-q", *options)
    return path


def images(path, most=None):
    """The images of an archive, or the first few of them."""
    with zipfile.ZipFile(path) as archive:
        names = sorted(name for name in archive.namelist() if name.endswith(".png"))
        return [resin_files.decode_png(archive.read(name))[..., 0] for name in names[:most]]


@pytest.mark.parametrize("printer, extension, kind, version, shown", PRINTERS, ids=NAMES)
def test_pixels_and_settings_are_those_of_the_printer(part, tmp_path, printer, extension, kind, version, shown):
    job = resin_files.read(sliced(part, tmp_path / f"job{extension}", printer))
    expected = images(sliced(part, tmp_path / "images.zip", printer, "--format", "png-zip"))
    assert (job.format, job.version) == (kind, version)
    assert job.warnings == []
    assert len(job.layers) == len(expected) == LAYERS
    for layer, image in zip(job.layers, expected):
        assert np.array_equal(layer.pixels(), shown(image))
    assert [layer.z_mm for layer in job.layers] == pytest.approx([HEIGHT * (i + 1) for i in range(LAYERS)], abs=1e-5)
    assert job.layer_height_mm == pytest.approx(HEIGHT)
    assert len(job.previews) > 0 and all(preview.max() > 60 and preview[0, 0].max() == 0 for preview in job.previews)
    if "lit_pixels" in job.layers[0].settings:
        assert [layer.settings["lit_pixels"] for layer in job.layers] == [np.count_nonzero(i >> 4) for i in expected]


@pytest.mark.parametrize("printer", ["Elegoo Mars 4 DLP", "Phrozen Shuffle", "Uniz IBEE (Klipper)"])
def test_images_are_mirrored_as_the_printer_needs(part, tmp_path, printer):
    upright = images(sliced(part, tmp_path / "a.zip", printer, "--format", "png-zip", "--mirror", "none"))
    mirrored = images(sliced(part, tmp_path / "b.zip", printer, "--format", "png-zip"))
    along_x, along_y = MIRRORED.get(printer, (True, False))
    for one, other in zip(upright, mirrored):
        one = one[:, ::-1] if along_x else one
        one = one[::-1] if along_y else one
        assert np.abs(one.astype(int) - other).max() <= 1
    # Seen from above, x runs to the right and y upwards: the corner at (9, 1) is at the right, below the middle.
    rows, columns = np.nonzero(upright[0])
    assert rows[columns == columns.max()].mean() > upright[0].shape[0] / 2


def test_volume_and_time_are_sums_over_layers(part, tmp_path):
    for printer, extension in (("Elegoo Mars 4 DLP", ".goo"), ("Elegoo Mars 2", ".ctb"), ("Photon Ultra", ".dlp")):
        job = resin_files.read(sliced(part, tmp_path / f"job{extension}", printer))
        pixel = job.display_mm[0] / job.pixels[0] * job.display_mm[1] / job.pixels[1]
        volume = sum(float(layer.pixels().sum(dtype=np.uint64)) / 255 for layer in job.layers) * pixel * HEIGHT / 1000
        assert job.settings["volume_ml"] == pytest.approx(volume, rel=0.02)
        assert job.settings["weight_g"] == pytest.approx(1.1 * job.settings["volume_ml"])
        moving = 60 * (5 / 65 + 5 / 150) + 0.5
        seconds = sum(layer.exposure_s + moving for layer in job.layers)
        assert job.settings["print_time_s"] == round(seconds)


def expected_exposure(index, first, normal, bottom_layers, fading):
    if index < bottom_layers:
        return first
    return max(first + (index - bottom_layers + 1) * (normal - first) / (fading + 1), normal)


@pytest.mark.parametrize("printer, extension", [row[:2] for row in PRINTERS], ids=NAMES)
def test_exposures_fade_from_the_first_layers_to_the_others(part, tmp_path, printer, extension):
    path = sliced(part, tmp_path / f"job{extension}", printer, "--exposure", 3, "--first-exposure", 33, "--fade-layers", 4)
    job = resin_files.read(path, check=False)
    assert job.settings["exposure_s"] == 3 and job.settings["bottom_exposure_s"] == 33
    exposures = [layer.exposure_s for layer in job.layers]
    if job.format in ("goo", "ctb", "cbddlp", "anycubic"):
        assert exposures == pytest.approx([expected_exposure(i, 33, 3, 5, 4) for i in range(LAYERS)], rel=1e-6)
    if job.format == "chitubox-zip":
        with zipfile.ZipFile(path) as archive:
            code = archive.read("run.gcode").decode()
        lit = [float(part.split("G4 P")[1].split(";")[0]) / 1000 for part in code.split(";light on")[1:]]
        assert lit == pytest.approx([expected_exposure(i, 33, 3, 5, 4) for i in range(LAYERS)])
        assert [float(line.split(":")[1]) for line in code.splitlines() if line.startswith(";currPos")] == pytest.approx(
            [layer.z_mm for layer in job.layers])


@pytest.mark.parametrize("printer, extension", [row[:2] for row in PRINTERS], ids=NAMES)
def test_bytes_depend_on_neither_threads_nor_time(part, tmp_path, printer, extension):
    for folder in ("a", "b", "c"):
        (tmp_path / folder).mkdir()
    paths = [sliced(part, tmp_path / folder / f"job{extension}", printer, "--threads", threads)
             for folder, threads in (("a", 1), ("b", 1), ("c", 3))]
    first, *others = [path.read_bytes() for path in paths]
    assert all(other == first for other in others)


def test_one_shade_or_one_set_without_anti_aliasing(part, tmp_path):
    job = resin_files.read(sliced(part, tmp_path / "job.photon", "Anycubic Photon", "--antialias", 1))
    assert job.settings["level_sets"] == 1
    job = resin_files.read(sliced(part, tmp_path / "job.pwms", "Anycubic Photon Mono SE", "--antialias", 8))
    assert all(set(np.unique(layer.pixels())) <= {0, 255} for layer in job.layers)


def test_a_pipe_has_the_bytes_of_the_file(part, tmp_path):
    path = sliced(part, tmp_path / "job.ctb", "Elegoo Mars 2")
    result = subprocess.run([PROGRAM, "slice", part, "-o", "-", "--printer", "Elegoo Mars 2", "--layer-height", str(HEIGHT),
                             "-q"], capture_output=True)
    assert result.returncode == 0, result.stderr
    assert result.stdout == path.read_bytes()


def test_layers_of_a_slice_file_are_converted(part, tmp_path):
    run("slice", part, "-o", tmp_path / "part.cli", "--layer-height", HEIGHT, "-q")
    run("convert", tmp_path / "part.cli", tmp_path / "a.goo", "--printer", "Elegoo Mars 4 DLP", "-q")
    run("convert", tmp_path / "part.cli", tmp_path / "images.zip", "--printer", "Elegoo Mars 4 DLP", "--format", "png-zip", "-q")
    job = resin_files.read(tmp_path / "a.goo")
    for layer, image in zip(job.layers, images(tmp_path / "images.zip")):
        assert np.array_equal(layer.pixels(), image)
    assert [layer.z_mm for layer in job.layers] == pytest.approx([HEIGHT * (i + 1) for i in range(LAYERS)], abs=1e-5)


@pytest.mark.parametrize("arguments, parts", [
    (["-o", "a.goo", "--printer", "Mras 4"], ["did you mean Elegoo Mars 4?"]),
    (["-o", "a.goo", "--printer", "typewriter"], ["there is no printer 'typewriter'", "give a part of its name"]),
    (["-o", "a.goo", "--printer", "Photon M"], ["several printers", "Anycubic Photon Mono X"]),
    (["-o", "a.ctb", "--printer", "Mars 4"], ["the Elegoo Mars 4 reads files with the extension .goo"]),
    (["-o", "a.goo", "--format", "ctb", "--printer", "Mars 4"], ["--format ctb", "the Elegoo Mars 4 reads the format goo"]),
    (["-o", "a.goo"], ["give --printer, or --resolution and --display-size"]),
    (["-o", "a.goo", "--printer", "Mars 4", "--scale", "150"], ["180 mm high", "up to 175 mm", "5 mm too high"]),
    (["-o", "a.cli", "--format", "cli", "--printer", "Mars 4"], ["--printer goes with the formats"]),
], ids=range(8))
def test_errors_say_what_to_do(part, tmp_path, arguments, parts):
    if "--scale" in arguments:  # a tall, thin part
        part = tmp_path / "tall.stl"
        run("make", "box", "-o", part, "--size", "0.3,0.3,1.2")
    result = subprocess.run([PROGRAM, "slice", str(part), *arguments, "--layer-height", "1"], cwd=tmp_path, capture_output=True,
                            text=True)
    assert result.returncode == 2
    for text in parts:
        assert text in result.stderr


# The vendors' own files.

def encoded(code, size, pictures):
    """The bytes of images that are given as runs, by our encoder."""
    source = io.BytesIO()
    for values, lengths in pictures:
        source.write(code + struct.pack("<III", *size, len(values)))
        runs = np.zeros(len(values), [("value", "u1"), ("length", "<u4")])
        runs["value"], runs["length"] = values, lengths
        source.write(runs.tobytes())
    output = subprocess.run([os.environ["LAMELLA_ENCODE_RUNS"]], input=source.getvalue(), capture_output=True, check=True).stdout
    found, at = [], 0
    while at < len(output):
        (count,) = struct.unpack_from("<I", output, at)
        found.append(output[at + 4:at + 4 + count])
        at += 4 + count
    return found


def runs_of_8_bits(values, lengths):
    """Runs of 7-bit greys with a lowest bit that differs where neighbours are equal: the vendor divided them there."""
    low, wide = 0, []
    for k, value in enumerate(values.tolist()):
        low = 1 - low if k > 0 and value == values[k - 1] else 0
        wide.append(2 * value + low)
    return np.array(wide), lengths


SAMPLE_CODES = [
    ("mars4max_gear_chitubox2.1.goo.xz", b"g", 426),
    ("gear_photon_mono_v515.pwmo.xz", b"p", 426),
    ("gear_photon_mono_x_v516.pwmx.xz", b"p", 426),
    ("gear_photon_mono_4k_v516.pwma.xz", b"p", 426),
    ("gear_photon_m3_v516.pm3.xz", b"p", 426),
    ("stairs_ctbv3_chitubox1.6.ctb", b"c", 400),
    ("saturn_ctbv4_first200layers.ctb", b"c", 200),
]


@pytest.mark.parametrize("name, code, layers", SAMPLE_CODES, ids=[row[0] for row in SAMPLE_CODES])
def test_codes_give_the_bytes_of_vendors(tmp_path, name, code, layers):
    if not (SAMPLES / name).exists() or "LAMELLA_ENCODE_RUNS" not in os.environ:
        pytest.skip(f"no {SAMPLES / name}; set LAMELLA_SHARED and LAMELLA_ENCODE_RUNS")
    data = (SAMPLES / name).read_bytes()
    path = tmp_path / name.removesuffix(".xz")
    path.write_bytes(lzma.decompress(data) if name.endswith(".xz") else data)
    job = resin_files.read(path, check=False)
    assert len(job.layers) == layers
    runs = [layer.picture.planes()[0] for layer in job.layers]
    if code == b"c":
        runs = [runs_of_8_bits(*picture) for picture in runs]
    if code == b"p":
        runs = [(values * 16, lengths) for values, lengths in runs]
    expected = [layer.picture.data() for layer in job.layers]
    if code == b"g":  # with the byte before the runs, and the checksum
        expected = [b"\x55" + chunks + bytes([resin_files.goo_checksum(chunks)]) for chunks in expected]
    found = encoded(code, job.pixels, runs)
    assert [index for index in range(layers) if found[index] != expected[index]] == []



# Our reader. Its pixels are those of the other reader, or those of `png-zip`.

SAMPLE_FILES = [row[0] for row in SAMPLE_CODES] + ["Smilie_cbddlp_v1.photon", "pyphotonfile_reference_v1.photon",
                                                   "pyphotonfile_reference.sl1"]


def sample(tmp_path, name):
    if not (SAMPLES / name).exists():
        pytest.skip(f"no {SAMPLES / name}; set LAMELLA_SHARED")
    data = (SAMPLES / name).read_bytes()
    path = tmp_path / name.removesuffix(".xz")
    path.write_bytes(lzma.decompress(data) if name.endswith(".xz") else data)
    return path


@pytest.mark.parametrize("name", SAMPLE_FILES)
def test_files_of_vendors_are_read_as_the_other_reader_does(tmp_path, name):
    path = sample(tmp_path, name)
    job = resin_files.read(path, check=False)
    run("convert", path, tmp_path / "images.zip", "--format", "png-zip", "-q")
    with zipfile.ZipFile(tmp_path / "images.zip") as archive:
        layers = json.loads(archive.read("manifest.json"))["layers"]
        assert [layer["top"] for layer in layers] == pytest.approx([layer.z_mm for layer in job.layers], abs=1e-5)
        for index in range(0, len(layers), 1 + len(layers) // 12):
            image = resin_files.decode_png(archive.read(layers[index]["file"]))[..., 0]
            assert np.array_equal(image, job.layers[index].pixels()), index
    found = json.loads(run("info", path, "--json").stdout)
    assert tuple(found["pixels"]) == job.pixels
    if all(layer.exposure_s is not None for layer in job.layers):
        assert found["exposures_s"] == pytest.approx([layer.exposure_s for layer in job.layers])


def test_images_are_those_that_another_project_expects(tmp_path):
    run("convert", sample(tmp_path, "mars4max_gear_chitubox2.1.goo.xz"), tmp_path / "a.zip", "--format", "png-zip", "-q")
    found = images(tmp_path / "a.zip", 3)
    for index in range(3):
        expected = resin_files.decode_png((SAMPLES / f"mars4max_gear_layer{index}.png").read_bytes())[..., 0]
        assert np.array_equal(found[index], expected)


@pytest.mark.parametrize("name, extension", [("mars4max_gear_chitubox2.1.goo.xz", ".goo"), ("gear_photon_m3_v516.pm3.xz", ".pm3"),
                                             ("gear_photon_mono_4k_v516.pwma.xz", ".pwma")])
def test_a_file_of_a_vendor_keeps_its_bytes_of_layers_and_exposures(tmp_path, name, extension):
    path = sample(tmp_path, name)
    run("convert", path, tmp_path / f"again{extension}", "-q")
    first, second = resin_files.read(path, check=False), resin_files.read(tmp_path / f"again{extension}")
    assert [layer.picture.data() for layer in second.layers] == [layer.picture.data() for layer in first.layers]
    assert [layer.exposure_s for layer in second.layers] == pytest.approx([layer.exposure_s for layer in first.layers])
    assert [layer.z_mm for layer in second.layers] == pytest.approx([layer.z_mm for layer in first.layers], abs=1e-5)


@pytest.mark.parametrize("printer, extension, kind, version, shown", PRINTERS, ids=NAMES)
def test_our_files_are_read_back(part, tmp_path, printer, extension, kind, version, shown):
    path = sliced(part, tmp_path / f"job{extension}", printer)
    run("convert", path, tmp_path / "back.zip", "--format", "png-zip", "-q")
    expected = images(sliced(part, tmp_path / "images.zip", printer, "--format", "png-zip"))
    found = images(tmp_path / "back.zip")
    assert len(found) == len(expected)
    assert all(np.array_equal(one, shown(other)) for one, other in zip(found, expected))
    # The part is as it was, wherever the display has it; and the same as itself.
    assert "ok" in run("verify", path, "--mesh", part).stdout.splitlines()[0]
    assert "agree" in run("compare", path, path).stdout


def test_wrong_places_are_named(part, tmp_path):
    path = sliced(part, tmp_path / "a.goo", "Elegoo Mars 4 DLP", "--mirror", "none")
    data = bytearray(path.read_bytes())
    data[195318] = 1  # says that the images are mirrored along x
    path.write_bytes(data)
    result = subprocess.run([PROGRAM, "verify", path, "--mesh", part], capture_output=True, text=True)
    assert result.returncode == 4
    assert "the images show the part of the mesh mirrored along x" in result.stdout


def test_differences_are_counted(part, tmp_path):
    one = sliced(part, tmp_path / "a.goo", "Elegoo Mars 4 DLP")
    other = sliced(part, tmp_path / "b.goo", "Elegoo Mars 4 DLP", "--antialias", 1, "--exposure", 9)
    result = subprocess.run([PROGRAM, "compare", one, other], capture_output=True, text=True)
    assert result.returncode == 4
    assert " pixels by up to 1" in result.stdout and "layer 10: exposure_s" in result.stdout


def test_settings_are_converted_and_options_win(part, tmp_path):
    path = sliced(part, tmp_path / "a.goo", "Elegoo Mars 4 DLP", "--exposure", 3, "--first-exposure", 33)
    run("convert", path, tmp_path / "b.goo", "-q")
    run("convert", path, tmp_path / "c.goo", "--exposure", 4, "-q")
    run("convert", path, tmp_path / "d.ctb", "-q")
    read = [resin_files.read(tmp_path / name) for name in ("a.goo", "b.goo", "c.goo", "d.ctb")]
    exposures = [[layer.exposure_s for layer in job.layers] for job in read]
    assert exposures[0] == exposures[1] == exposures[3]
    assert exposures[2][-1] == 4 and exposures[2][0] == 33
    assert read[3].printer == "ELEGOO Mars 4 DLP"
    result = subprocess.run([PROGRAM, "convert", path, tmp_path / "e.goo", "--printer", "Saturn 3 Ultra"], capture_output=True,
                            text=True)
    assert result.returncode == 2
    assert "(ELEGOO Mars 4 DLP)" in result.stderr and "Elegoo Saturn 3 Ultra has" in result.stderr
    (tmp_path / "range.toml").write_text('[exposure_ranges]\n"1:2" = 9\n')
    result = run("convert", sliced(part, tmp_path / "f.photon", "Anycubic Photon"), tmp_path / "f.nanodlp")
    assert result.stderr == ""  # the transition has a place of its own
    ranges = sliced(part, tmp_path / "g.photon", "Anycubic Photon", "--resin", tmp_path / "range.toml")
    result = run("convert", ranges, tmp_path / "f.nanodlp")
    assert "1 setting of the job was left out" in result.stderr and (tmp_path / "f.nanodlp").exists()


def test_outlines_are_converted_to_contours(part, tmp_path):
    path = sliced(part, tmp_path / "a.goo", "Elegoo Mars 4 DLP")
    run("convert", path, tmp_path / "a.cli", "-q")
    run("view", path, "-o", tmp_path / "a.html", "-q")
    one, other = (json.loads(run("info", name, "--json").stdout) for name in (path, tmp_path / "a.cli"))
    assert one["points"] == other["points"] > 100
    assert one["volume_mm3"] == pytest.approx(other["volume_mm3"], rel=1e-3)


if __name__ == "__main__":
    sys.exit(pytest.main([__file__, "-q", "-p", "no:cacheprovider", *sys.argv[1:]]))
