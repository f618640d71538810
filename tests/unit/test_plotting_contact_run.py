"""Pictures of the contact at steps of a run, by the command."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from wheelrail.case import load_case
from wheelrail.cli import main
from wheelrail.interaction.build import build_model
from wheelrail.interaction.start import start
from wheelrail.plotting.contact_run import contact_of

CASE = Path(__file__).parents[2] / "examples" / "cases" / "rolling_contact.toml"


def test_the_map_holds_what_the_state_holds():
    model = build_model(load_case(CASE))
    state = start(model, model.start_inputs)
    picture = contact_of(model, state)
    area = 1e-6
    assert area * picture.pressure.sum() == pytest.approx(65e3, rel=1e-12)
    # The figures of Vollebregt's open CONTACT (rev 2707) for this case.
    assert area * picture.tractions[1].sum() == pytest.approx(-7995.24847593571, abs=1e-6)
    assert (np.count_nonzero(picture.contact), np.count_nonzero(picture.slipping)) == (87, 18)
    # The rear of the contact slips: rolling goes to positive x.
    columns = picture.slipping.any(axis=0)
    assert picture.x[columns].max() < 0.0


def test_command_draws_steps_and_an_animation(tmp_path, capsys):
    assert main(["contact", str(CASE), "--step", "0", "--step", "3", "--animate", "--output", str(tmp_path)]) == 0
    files = [Path(line) for line in capsys.readouterr().out.splitlines()]
    assert [file.name for file in files] == [
        "rolling_contact_contact_0.png",
        "rolling_contact_contact_3.png",
        "rolling_contact_contact.gif",
    ]
    with Image.open(files[0]) as picture:
        assert min(picture.size) > 600
    with Image.open(files[2]) as film:
        assert film.n_frames == 4


@pytest.mark.parametrize(
    ("arguments", "words"), [(["--step", "-1"], ">= 0"), (["--output", "nowhere"], "no such folder")]
)
def test_refusals(tmp_path, capsys, monkeypatch, arguments, words):
    monkeypatch.chdir(tmp_path)
    assert main(["contact", str(CASE), *arguments]) == 2
    assert words in capsys.readouterr().err


def test_a_spring_has_no_area_to_draw(tmp_path, capsys):
    case = CASE.read_text().replace('normal = "half-space"', 'normal = "hertz"').replace('"transient"', '"fastsim"')
    (tmp_path / "spring.toml").write_text(case)
    assert main(["contact", str(tmp_path / "spring.toml"), "--output", str(tmp_path)]) == 2
    assert "half-space" in capsys.readouterr().err
