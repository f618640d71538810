import numpy as np
import pytest

from wheelrail.errors import DataFileError, ParameterError
from wheelrail.wheel.modes import FlexibleWheel, Mode
from wheelrail.wheel.receptance_file import read_receptance

WHEEL = FlexibleWheel(
    tuple(
        Mode.with_frequency(name=name, mass=50.0, frequency=frequency, damping_ratio=5e-3, shape=shape)
        for name, frequency, shape in [
            ("2,0,a", 400.0, (0.0, 1.0, 0.3)),
            ("2,0,a*", 400.0, (0.2, 0.0, 0.0)),
            ("1,r", 1600.0, (0.0, -0.2, 0.9)),
        ]
    )
)
FREQUENCY = np.arange(0.0, 2001.0, 5.0)
EXACT = WHEEL.receptance(FREQUENCY)
AXES = {name: i for i, name in enumerate("xyz")}


def of(pair, receptance=EXACT):
    return receptance[:, AXES[pair[0]], AXES[pair[1]]]


def written(tmp_path, columns):
    """A table with the given columns, by their headers."""
    path = tmp_path / "wheel.csv"
    rows = zip(*columns.values(), strict=True)
    lines = [";".join(columns)] + [";".join(repr(float(entry)) for entry in row) for row in rows]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def parts(pairs, unit="m/N", factor=1.0, order=0, receptance=EXACT):
    columns = {"frequency [Hz]": FREQUENCY}
    for pair in pairs:
        values = of(pair, receptance) * (2j * np.pi * FREQUENCY) ** order * factor
        columns[f"re_{pair} [{unit}]"] = values.real
        columns[f"im_{pair} [{unit}]"] = values.imag
    return columns


@pytest.mark.parametrize(
    ("unit", "factor", "order"),
    [
        ("m/N", 1.0, 0),
        ("um/N", 1e6, 0),
        ("m/s/N", 1.0, 1),
        ("mm/(N s)", 1e3, 1),
        ("m/s^2/N", 1.0, 2),
        ("1/kg", 1.0, 2),
        ("g/N", 1.0 / 9.80665, 2),
    ],
)
def test_displacement_velocity_and_acceleration(tmp_path, unit, factor, order):
    path = written(tmp_path, parts(["xx", "yy", "zz", "yz"], unit, factor, order))
    found, notes = read_receptance(path)
    first = 1 if order else 0
    np.testing.assert_array_equal(found.frequency, FREQUENCY[first:])
    np.testing.assert_allclose(found.values, EXACT[first:], atol=1e-14 * np.abs(EXACT).max())
    left_out = ["wheel.csv: line at 0 Hz left out: a velocity or acceleration says nothing about it"] if order else []
    assert notes == [*left_out, "wheel.csv: yx, zx taken as zero, as the wheel's symmetry has it"]


def test_magnitude_and_phase(tmp_path):
    columns = {"frequency_kHz": FREQUENCY / 1e3, "abs_zz [mm/N]": np.abs(of("zz")) * 1e3}
    columns["phase_zz [deg]"] = np.degrees(np.angle(of("zz")))
    found, notes = read_receptance(written(tmp_path, columns))
    np.testing.assert_allclose(found.values[:, 2, 2], of("zz"), atol=1e-14 * np.abs(EXACT).max())
    assert not found.values[:, :2].any()
    assert found.given.sum() == 1
    assert notes == [
        "wheel.csv: yx, zx taken as zero, as the wheel's symmetry has it",
        "wheel.csv: xx, yy not given: the wheel is taken as rigid in that direction",
    ]


def test_missing_coupling_is_said(tmp_path):
    _, notes = read_receptance(written(tmp_path, parts(["xx", "yy", "zz"])))
    assert notes[-1] == (
        "wheel.csv: yz not given and taken as zero: lateral and vertical motion aren't coupled in the wheel, and no "
        "squeal can come from that coupling"
    )


def test_reciprocity_is_measured(tmp_path):
    columns = parts(["yy", "zz", "yz", "zy"])
    columns["re_zy [m/N]"] = columns["re_zy [m/N]"] * 1.04
    columns["im_zy [m/N]"] = columns["im_zy [m/N]"] * 1.04
    found, notes = read_receptance(written(tmp_path, columns))
    np.testing.assert_allclose(found.values[:, 1, 2], 1.02 * of("yz"), rtol=1e-14)
    assert "wheel.csv: zy and yz differ by 3.9 % (rms); their mean is used" in notes
    columns["re_zy [m/N]"], columns["im_zy [m/N]"] = -columns["re_yz [m/N]"], -columns["im_yz [m/N]"]
    path = written(tmp_path, columns)
    with pytest.raises(DataFileError) as caught:
        read_receptance(path)
    assert str(caught.value) == (
        f"{path}: the receptances zy and yz differ by 200 % (rms); by reciprocity they are equal, and at most 50 % is "
        "allowed. Is the sign of a direction right?"
    )


def test_passivity_is_measured(tmp_path):
    wrong = EXACT.copy()
    wrong[120:130, 2, 2] = np.conj(wrong[120:130, 2, 2])
    _, notes = read_receptance(written(tmp_path, parts(["zz"], receptance=wrong)))
    share = np.max(of("zz", wrong).imag / np.abs(of("zz", wrong)))
    at = FREQUENCY[np.argmax(of("zz", wrong).imag / np.abs(of("zz", wrong)))]
    count = np.count_nonzero(of("zz", wrong).imag / np.abs(of("zz", wrong)) > 0.02)
    assert count > 0
    assert notes[-1] == (
        f"wheel.csv: {count} of 401 lines aren't passive; the worst at {at:g} Hz by {100 * share:.2g} % of the "
        "receptance"
    )


def test_cross_receptance_beyond_what_the_points_allow_is_not_passive(tmp_path):
    wrong = EXACT.copy()
    wrong[:, 1, 2] = wrong[:, 2, 1] = 4.0 * wrong[:, 1, 2]
    _, notes = read_receptance(written(tmp_path, parts(["yy", "zz", "yz"], receptance=wrong)))
    assert "lines aren't passive" in notes[-1]


def test_other_time_factor_is_refused(tmp_path):
    path = written(tmp_path, parts(["zz"], receptance=np.conj(EXACT)))
    with pytest.raises(DataFileError) as caught:
        read_receptance(path)
    assert str(caught.value) == (
        f"{path}: the imaginary parts of the point receptances are positive: the wheel would feed in energy. Is "
        "the time factor exp(+i omega t), and does the displacement point the same way as the force?"
    )


def test_faults(tmp_path):
    good = parts(["zz"])

    def refused(columns):
        path = written(tmp_path, columns)
        with pytest.raises(DataFileError) as caught:
            read_receptance(path)
        return str(caught.value).replace(str(path), "FILE")

    assert refused({**good, "frequency [Hz]": FREQUENCY[::-1]}) == (
        "FILE, line 3: frequency 1995 Hz follows 2000 Hz; they increase from 0 Hz on"
    )
    assert refused({"frequency [Hz]": FREQUENCY, "re_zz [m/N]": FREQUENCY}) == (
        "FILE, line 1: the pair zz has re_zz; it needs re_zz and im_zz, or abs_zz and phase_zz"
    )
    assert refused({key.replace("im_zz [m/N]", "im_zz [m/s/N]"): values for key, values in good.items()}) == (
        "FILE, line 1: re_zz is in m/N and im_zz in m/s/N; both are parts of the same quantity"
    )
    assert refused({key.replace("[m/N]", ""): values for key, values in good.items()}).startswith(
        'FILE, line 1: column re_zz names no unit; write "re_zz [m/N]" (allowed: m/N, mm/N, um/N'
    )
    assert refused(parts(["yy"])) == "FILE: no vertical point receptance zz (there are yy)"
    assert refused({"frequency [Hz]": FREQUENCY}) == (
        "FILE, line 1: no receptance; the vertical one for instance is re_zz [m/N] and im_zz [m/N]"
    )
    assert refused({key: values[:10] for key, values in good.items()}) == "FILE: 10 frequencies; at least 16 are needed"
    assert refused({key.replace("frequency", "re_yy"): values for key, values in good.items()}) == (
        "FILE, line 1: no column frequency [Hz]"
    )


def test_arguments_that_do_not_apply(tmp_path):
    path = written(tmp_path, parts(["zz"]))
    for name, value in (("node", 1), ("axes", ("x", "y", "z")), ("units", "mm-t-s"), ("quantity", "mobility")):
        with pytest.raises(ParameterError, match="belongs to a universal file"):
            read_receptance(path, **{name: value})
