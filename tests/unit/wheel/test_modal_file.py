import numpy as np
import pytest

from wheelrail.errors import DataFileError, ParameterError
from wheelrail.wheel.modal_file import read_modes
from wheelrail.wheel.modes import FlexibleWheel, Mode

WHEEL = FlexibleWheel(
    tuple(
        Mode.with_frequency(name=name, mass=mass, frequency=frequency, damping_ratio=ratio, shape=shape)
        for name, mass, frequency, ratio, shape in [
            ("2,0,a", 41.0, 412.6, 1e-4, (0.0, 0.83, -0.04)),
            ("2,0,a*", 41.0, 412.6, 1e-4, (0.02, 0.0, 0.0)),
            ("1,r", 160.0, 1650.25, 1.0, (0.0, -0.1, 0.9)),
        ]
    )
)
FREQUENCY = np.array([0.0, 100.0, 412.5, 1700.0, 6000.0])


def written(tmp_path, text):
    path = tmp_path / "modes.csv"
    path.write_text(text, encoding="utf-8")
    return path


def table(columns, rows):
    lines = [",".join(columns)] + [",".join(str(entry) for entry in row) for row in rows]
    return "\n".join(lines) + "\n"


def as_table(wheel, kind):
    """The same wheel in the different ways a table can say it."""
    scale = {"mass": 1.0, "kg": 1.0, "t": 1e-3}[kind]
    rows = []
    for mode in wheel.modes:
        if kind == "mass":
            numbers = (mode.frequency, mode.damping_ratio, mode.mass, *mode.shape)
        else:
            numbers = (
                mode.frequency / 1e3,
                200.0 * mode.damping_ratio,
                *(np.array(mode.shape) / np.sqrt(scale * mode.mass)).tolist(),
            )
        rows.append([f'"({mode.name})"', *(repr(float(number)) for number in numbers)])
    if kind == "mass":
        return table(
            ["name", "frequency [Hz]", "damping_ratio", "modal_mass [kg]", "shape_x", "shape_y", "shape_z"], rows
        )
    shapes = [f"shape_{axis} [1/sqrt({kind})]" for axis in "xyz"]
    return table(["name", "frequency_kHz", "loss_factor [%]", *shapes], rows)


@pytest.mark.parametrize("kind", ["mass", "kg", "t"])
def test_round_trip(tmp_path, kind):
    wheel, notes = read_modes(written(tmp_path, as_table(WHEEL, kind)))
    assert notes == []
    assert [mode.name for mode in wheel.modes] == ["2,0,a", "2,0,a*", "1,r"]
    expected = WHEEL.receptance(FREQUENCY)
    np.testing.assert_allclose(wheel.receptance(FREQUENCY), expected, atol=1e-13 * np.abs(expected).max())
    assert len(wheel.without(["2,0,a"]).modes) == 1


def test_modes_without_damping_take_the_users(tmp_path):
    columns = ["name", "frequency [Hz]", "modal_mass [kg]", "shape_x", "shape_y", "shape_z"]
    path = written(tmp_path, table(columns, [['"3,0,a"', 900, 50, 0, 1, 0], ['"1,r"', 1600, 100, 0, 0, 1]]))
    assert [mode.damping_ratio for mode in read_modes(path, damping=2e-3)[0].modes] == pytest.approx([2e-3, 2e-3])
    assert [mode.damping_ratio for mode in read_modes(path, damping="thesis")[0].modes] == pytest.approx([1e-4, 1.0])
    with pytest.raises(DataFileError) as caught:
        read_modes(path)
    assert str(caught.value) == (
        f"{path}: no (viscous) damping of 2 modes (the first is 3,0,a); give it in the file, or for all modes "
        "together: damping"
    )
    wheel, notes = read_modes(path, damping=0.0)
    assert wheel.modes[0].damping == 0.0
    assert notes == ["modes.csv: 2 modes without any damping"]


def test_modes_out_of_range_are_left_out_and_noted(tmp_path):
    columns = ["frequency [Hz]", "damping_ratio", "modal_mass [kg]", "shape_x", "shape_y", "shape_z"]
    rows = [[f, 1e-3, 50, 0, 1, 0] for f in (0.0, 2e-4, 8000.0, 400.0)]
    wheel, notes = read_modes(written(tmp_path, table(columns, rows)), highest=7000.0)
    assert [(mode.name, mode.frequency) for mode in wheel.modes] == [("mode-4", pytest.approx(400.0))]
    assert notes == [
        "modes.csv: 2 modes below 1 Hz left out; rigid-body motion comes from the suspension",
        "modes.csv: 1 modes above 7000 Hz left out",
    ]
    with pytest.raises(DataFileError, match=r"none of its 4 modes \(0 Hz to 8000 Hz\) lies between 500 Hz and 700 Hz"):
        read_modes(written(tmp_path, table(columns, rows)), lowest=500.0, highest=700.0)


GOOD = "name,frequency [Hz],damping_ratio,modal_mass [kg],shape_x,shape_y,shape_z\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "frequency [Hz],damping_ratio,shape_x,shape_y,shape_z\n400,1e-3,0,1,0\n",
            "{path}, line 1: the scale of the shapes is open: there is no column modal_mass [kg], and shape_x names no "
            'unit; mass-normalised shapes are "shape_x [1/sqrt(kg)]", or [1/sqrt(t)] from a model in mm, t and s',
        ),
        (
            "frequency [Hz],damping_ratio,modal_mass [kg],shape_y,shape_z\n400,1e-3,50,1,0\n",
            "{path}, line 1: no column shape_x; needed are frequency, shape_x, shape_y, shape_z",
        ),
        (
            "frequency [Hz],damping_ratio,loss_factor,modal_mass [kg],shape_x,shape_y,shape_z\n1,1,1,1,1,1,1\n",
            "{path}, line 1: both damping_ratio and loss_factor; one of them says it",
        ),
        (GOOD + "a,400,1.5,50,0,1,0\n", "{path}, line 2: damping_ratio = 1.5; allowed is 0 to 1"),
        (GOOD + "a,400,1e-3,0,0,1,0\n", "{path}, line 2: modal_mass = 0; allowed is above 0"),
        (GOOD + "a,400,1e-3,50,0,1,0\nb,-4,1e-3,5,0,1,0\n", "{path}, line 3: frequency = -4; allowed is at least 0 Hz"),
        (
            GOOD + '"(2,0,a)",400,1e-3,50,0,1,0\n"2, 0, a",400,1e-3,50,1,0,0\n',
            '{path}, line 3: a second mode "2,0,a" (mark the turned partner by an asterisk); each mode has a name of '
            "its own",
        ),
        (GOOD + ",400,1e-3,50,0,1,0\n", "{path}, line 2: no name; each mode has a name of its own"),
        (GOOD + "a,400,1e-3,50,0,x,0\n", '{path}, line 2: shape_y is "x", not a finite number'),
        (
            GOOD.replace("shape_x", "shape_x [m]") + "a,400,1e-3,50,0,1,0\n",
            "{path}, line 1: column shape_x has the unit [m]; it is a number without a unit",
        ),
    ],
)
def test_faults(tmp_path, text, message):
    path = written(tmp_path, text)
    with pytest.raises(DataFileError) as caught:
        read_modes(path)
    assert str(caught.value) == message.format(path=path)


def test_arguments_that_do_not_apply(tmp_path):
    path = written(tmp_path, GOOD + "a,400,1e-3,50,0,1,0\n")
    for name, value in (("node", 1), ("axes", ("x", "y", "z")), ("units", "mm-t-s")):
        with pytest.raises(ParameterError, match="belongs to a universal file"):
            read_modes(path, **{name: value})
    with pytest.raises(ParameterError, match="leave one of the two out"):
        read_modes(path, damping=1e-3)
