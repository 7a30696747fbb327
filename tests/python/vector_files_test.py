"""Files of scan vectors."""

import pickle

import pytest

import lamella


def test_scan_vectors_keep_their_parameters(program, jobs):
    stack = lamella.read(jobs / "program.ilt")
    assert stack.exposure is None and lamella.read(jobs / "part.cli").exposure is None
    for part in [*stack.parts, *stack[1:3].parts, *pickle.loads(pickle.dumps(stack)).parts]:
        exposure = part.exposure
        assert part.label == f"{exposure.part} {exposure.name}" and exposure.parameters.speed_mm_s > 0
    program.succeed("convert", jobs / "program.ilt", jobs / "expected.ovf")
    lamella.convert(jobs / "program.ilt", jobs / "converted.ovf")
    lamella.write(jobs / "written.ovf", stack)
    for name in ("converted.ovf", "written.ovf"):
        assert (jobs / name).read_bytes() == (jobs / "expected.ovf").read_bytes()
    with pytest.raises(lamella.UsageError, match="holds scan vectors"):
        lamella.verify(stack[1:3])
    text = program.error("scan", jobs / "program.ilt", "-o", jobs / "out.ilt").replace("program.ilt", "converted.ovf")
    for vectors in [lamella.read(jobs / "converted.ovf"), lamella.read(jobs / "converted.ovf")[1:3]]:
        with pytest.raises(lamella.InputError) as caught:
            lamella.scan(vectors)
        assert str(caught.value) == text


def test_scan_vectors_are_written_as_by_the_program(program, rook, jobs):
    layers = lamella.read(jobs / "part.cli")
    for name in ("ilt", "ovf"):
        lamella.write(jobs / f"job.{name}", lamella.scan(layers, part=layers.label))
        assert (jobs / f"job.{name}").read_bytes() == (jobs / f"program.{name}").read_bytes()
    program.succeed("slice", rook, "-o", jobs / "sliced.ilt", "--layer-height", 2, "--scan")
    scanned = lamella.scan(lamella.iter_layers(rook, 2), part=layers.label)
    lamella.write(jobs / "streamed.ilt", scanned)
    assert (jobs / "streamed.ilt").read_bytes() == (jobs / "sliced.ilt").read_bytes()
    with pytest.raises(lamella.UsageError, match="no layers to write"):
        lamella.write(jobs / "nothing.ilt", scanned)
    # What could not be written is there still.
    scanned = lamella.scan(lamella.iter_layers(rook, 2), part=layers.label)
    with pytest.raises(lamella.UsageError):
        lamella.write(jobs / "job.unknown", scanned)
    lamella.write(jobs / "again.ilt", scanned)
    assert (jobs / "again.ilt").read_bytes() == (jobs / "sliced.ilt").read_bytes()


def test_scan_layers_of_any_kind_are_written(jobs):
    scanned = list(lamella.scan(lamella.read(jobs / "part.cli")))

    def known(exposures):  # of what these files keep
        return [(e.part, e.name, e.parameters.power_w, e.parameters.speed_mm_s) for e in exposures]

    for what in (scanned, iter(scanned), scanned[0]):
        lamella.write(jobs / "out.ilt", what)
        parts = lamella.read(jobs / "out.ilt").parts
        assert known(part.exposure for part in parts) == known(scanned[0].exposures)
        assert len(parts[0]) == (1 if what is scanned[0] else len(scanned))
    (other,) = lamella.scan([lamella.Layer([], 1e3)], part="other")
    with pytest.raises(lamella.UsageError, match="the same exposures"):
        lamella.write(jobs / "mixed.ilt", [*scanned, other])
    assert not (jobs / "mixed.ilt").exists()
