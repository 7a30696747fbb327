"""Files with defects: warnings or, with `strict`, errors."""

from pathlib import Path

import pytest

import lamella


def test_what_a_format_has_no_place_for_is_an_error_where_it_is_asked_to_be(tmp_path):
    chain = lamella.Layer([], 1, bottom=0.5, top=1, chains=[[(0, 0), (1, 0), (1, 1)]])
    with pytest.warns(lamella.DefectWarning):
        lamella.write(tmp_path / "out.slc", chain)
    for write in (lambda **options: lamella.write(tmp_path / "strict.slc", chain, **options),
                  lambda **options: lamella.convert(tmp_path / "chain.json", tmp_path / "strict.slc", **options)):
        lamella.write(tmp_path / "chain.json", chain)
        with pytest.raises(lamella.DefectError):
            write(strict=True)
        assert not (tmp_path / "strict.slc").exists()


def test_what_is_odd_about_a_slice_file_is_an_error_where_it_is_asked_to_be(tmp_path):
    layers = '{"z":1,"bottom":0,"top":2,"parts":[{"rings":[[0,0,4,0,0,4],[1,1,2,2]]}]}'
    (tmp_path / "odd.json").write_text('{"format":"lamella layers","version":1,"parts":[{"label":"a"}],"layers":[' + layers + "]}")
    with pytest.warns(lamella.DefectWarning) as caught:
        lamella.convert(tmp_path / "odd.json", tmp_path / "out.cli")
    for ask in [lambda: lamella.read(tmp_path / "odd.json", strict=True),
                lambda: lamella.convert(tmp_path / "odd.json", tmp_path / "strict.cli", strict=True)]:  # fmt: skip
        with pytest.raises(lamella.DefectError) as error:
            ask()
        assert str(error.value) == str(caught[0].message)
    assert not (tmp_path / "strict.cli").exists()


def test_odd_files_are_warned_of(rook, tmp_path):
    path = tmp_path / "long.stl"
    path.write_bytes(Path(rook).read_bytes() + b"more")
    with pytest.warns(lamella.DefectWarning) as caught:
        mesh = lamella.read(path)
    assert len(mesh.warnings) == 1 and "4 bytes" in mesh.warnings[0]
    assert [str(warning.message) for warning in caught] == [f"{path}: {mesh.warnings[0]}"]
    assert caught[0].filename == __file__
    with pytest.raises(lamella.DefectError, match="long.stl"):
        lamella.read(path, strict=True)


def test_odd_slice_files_are_errors_where_they_are_asked_to_be(tmp_path):
    path = tmp_path / "falling.cli"
    layers = "".join(f"$$LAYER/{z}\n$$POLYLINE/1,1,4,0,0,1,0,1,1,0,0\n" for z in (2, 1))
    path.write_text(f"$$HEADERSTART\n$$ASCII\n$$UNITS/1\n$$VERSION/200\n$$HEADEREND\n$$GEOMETRYSTART\n{layers}$$GEOMETRYEND\n")
    with pytest.warns(lamella.DefectWarning, match="falling.cli: layers do not ascend"):
        assert len(lamella.read(path)) == 2
    with pytest.raises(lamella.DefectError, match="falling.cli: layers do not ascend"):
        lamella.read(path, strict=True)
