"""What ``wheelrail roughness`` says and writes."""

import csv

import numpy as np
import pytest

from wheelrail.errors import DataFileError, ParameterError, WheelrailError
from wheelrail.excitation.coherent_spectrum import CoherentSpectrum
from wheelrail.excitation.named_spectra import named_spectrum, read_spectrum
from wheelrail.roughness_command import roughness_report

DX = 1e-3
LIMIT = named_spectrum("iso3095-2013-limit")


def measured(folder, *, shift=0.0, lateral=(-4e-3, 0.0, 4e-3), on="rail", length=10.0):
    lines = CoherentSpectrum(
        wavelengths=LIMIT.wavelengths,
        levels=LIMIT.levels + shift,
        lateral=np.array(lateral),
        decay=0.2,
        length=length,
        seed=3,
        dx=DX,
        on=on,
        name="lines",
    ).realise(dx=DX, seed_override=None)
    path = folder / "site.csv"
    header = "x_m," + ",".join(f"y={1e3 * y:g}mm_um" for y in lateral)
    rows = (",".join(f"{v:.4f}" for v in (i * DX, *(1e6 * column))) for i, column in enumerate(lines.values.T))
    path.write_text("\n".join([header, *rows]), encoding="utf-8")
    return path


def test_smooth_lines_are_within_the_limit(tmp_path):
    report = roughness_report(measured(tmp_path, shift=-3.0), tmp_path)
    assert not report.exceeded
    assert report.text.splitlines()[-1] == "mean: within the limit in all 22 bands (iso3095-2013-limit)"
    assert "y=-4mm: 0 spikes removed" in report.text
    assert [path.name for path in report.files] == [
        "site_roughness.csv", "site_spectrum.csv", "site_roughness.png", "site_coherence.png",
    ]  # fmt: skip
    for path in report.files[2:]:
        assert path.read_bytes().startswith(b"\x89PNG")


def test_table_and_files_agree_with_what_was_put_in(tmp_path):
    report = roughness_report(measured(tmp_path, shift=2.0), tmp_path, process=False)
    assert report.exceeded
    assert "ABOVE the limit in " in report.text.splitlines()[-1]
    assert "lines as measured" in report.text
    rows = {row.split()[0]: row.split() for row in report.text.splitlines()[2:25]}
    assert rows["31.5"][4] == "-5.0"
    with open(report.files[0], encoding="utf-8") as stream:
        table = {row["wavelength_mm"]: row for row in csv.DictReader(line for line in stream if line[0] != "#")}
    for wavelength, level in zip(LIMIT.wavelengths[6:], LIMIT.levels[6:], strict=True):
        name = next(name for name in table if abs(float(name) / (1e3 * wavelength) - 1.0) < 0.03)
        assert float(table[name]["limit_dB"]) == level
        assert float(table[name]["mean_dB"]) == pytest.approx(level + 2.0, abs=0.7)  # 10 m: levels scatter
        lines = [float(table[name][f"y={y}mm [dB]"]) for y in (-4, 0, 4)]
        mean = 10.0 * np.log10(np.mean(10.0 ** (0.1 * np.array(lines))))
        assert float(table[name]["mean_dB"]) == pytest.approx(mean, abs=0.01)
    # The mean spectrum can be used for synthesis.
    spectrum = read_spectrum(report.files[1])
    assert spectrum.levels[list(np.rint(10 * np.log10(spectrum.wavelengths))).index(-20)] == pytest.approx(
        float(table["10"]["mean_dB"])
    )


def test_one_line_without_a_position(tmp_path):
    path = measured(tmp_path, lateral=(0.0,), shift=-3.0)
    path.write_text(path.read_text(encoding="utf-8").replace("y=0mm_um", "height_um"), encoding="utf-8")
    report = roughness_report(path, tmp_path)
    assert len(report.files) == 3
    assert report.text.splitlines()[-1].startswith("height: within the limit in all 22 bands")
    assert "lowest" not in report.text


def test_bands_that_are_not_reached_are_named(tmp_path):
    report = roughness_report(measured(tmp_path, shift=-3.0, length=20.0), tmp_path, segment_length=1.0)
    assert "not reached by the measurement: 400, 315, 250, 200, 160 mm" in report.text.splitlines()[-1]


def test_a_wheel(tmp_path):
    path = measured(tmp_path, on="wheel", length=2.0 * np.pi * 0.46, shift=-3.0)
    report = roughness_report(path, tmp_path, on="wheel", wheel_radius=0.46)
    assert not report.exceeded
    assert any("one turn" in note for note in report.notes)
    with pytest.raises(ParameterError, match="wheel_radius"):
        roughness_report(path, tmp_path, on="wheel")


def test_refusals(tmp_path):
    path = measured(tmp_path)
    with pytest.raises(WheelrailError, match="no such folder"):
        roughness_report(path, tmp_path / "absent")
    with pytest.raises(ParameterError, match="known spectra"):
        roughness_report(path, tmp_path, limit="iso")
    with pytest.raises(DataFileError, match="no such file"):
        roughness_report(tmp_path / "absent.csv", tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == {"site.csv"}
