"""Study files: which points they make, and that all their faults come at once, before anything is computed."""

from __future__ import annotations

import pytest

from wheelrail.errors import CaseError


def test_a_grid_has_all_combinations_with_the_last_key_fastest(study_of):
    study = study_of('[vary]\n"load.preload" = [50e3, 60e3]\n"simulation.speed" = [10.0, 20.0, 30.0]')
    found = [(point.case.load.preload, point.case.simulation.speed) for point in study.points]
    assert found == [(p, v) for p in (50e3, 60e3) for v in (10.0, 20.0, 30.0)]
    assert study.shape == (2, 3)
    assert [point.index for point in study.points] == list(range(6))
    axis = study.axes[1]
    assert (axis.name, axis.unit, axis.description) == ("simulation_speed", "m/s", "Rolling speed")


def test_a_list_takes_the_values_side_by_side(study_of):
    study = study_of('combine = "list"\n[vary]\n"load.preload" = [50e3, 60e3]\n"simulation.speed" = [10.0, 20.0]')
    assert [(p.case.load.preload, p.case.simulation.speed) for p in study.points] == [(50e3, 10.0), (60e3, 20.0)]
    assert study.shape == (2,)


def test_points_one_by_one_with_bare_keys(study_of):
    study = study_of(
        "[[point]]\nload.preload = 50e3\nexcitation.2.seed = 7\n[[point]]\nload.preload = 60e3\nexcitation.2.seed = 8"
    )
    assert [(p.case.load.preload, p.case.excitation[1].seed) for p in study.points] == [(50e3, 7), (60e3, 8)]


@pytest.mark.parametrize(
    ("key", "given", "expected"),
    [
        ("load.preload", "{ from = 1, to = 4, count = 4 }", [1, 2, 3, 4]),
        ("friction.coefficient", "{ from = 0.1, to = 0.4, count = 4 }", [0.1, 0.2, 0.3, 0.4]),
        ("load.preload", '{ from = 1e3, to = 1e5, count = 3, spacing = "log" }', [1e3, 1e4, 1e5]),
        ("load.preload", "{ from = 60e3, to = 50e3, count = 3 }", [60e3, 55e3, 50e3]),
    ],
)
def test_ranges(study_of, key, given, expected):
    values = study_of(f'[vary]\n"{key}" = {given}').axes[0].values
    assert list(values) == expected  # exactly: 0.3 is 0.3


def test_set_changes_all_points(study_of):
    study = study_of('[set]\n"simulation.duration" = 0.02\n[vary]\n"load.preload" = [50e3, 60e3]')
    assert [point.case.simulation.duration for point in study.points] == [0.02, 0.02]


def test_points_have_the_seeds_of_the_case_unless_the_study_has_one(study_of):
    vary = '[vary]\n"load.preload" = [50e3, 60e3]'
    assert [point.case.excitation[1].seed for point in study_of(vary).points] == [1, 1]
    drawn = [point.case.excitation[1].seed for point in study_of(f"seed = 5\n{vary}").points]
    assert len({1, *drawn}) == 3
    assert drawn == [point.case.excitation[1].seed for point in study_of(f"seed = 5\n{vary}").points]
    assert drawn != [point.case.excitation[1].seed for point in study_of(f"seed = 6\n{vary}").points]


VARY = '[vary]\n"load.preload" = [50e3, 60e3]\n'


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "[vary] or [[point]]: missing; give one of them"),
        ("vary = 1", "vary = 1: must be a table"),
        ("[vary]", "vary: empty; give at least one key of the case file with its values"),
        ("colour = 1\n" + VARY, "colour: unknown key; allowed: title, case, combine, seed"),
        ("seed = -1\n" + VARY, "seed = -1: must be a whole number from 0 to 2147483647"),
        ('combine = "star"\n' + VARY, 'combine = "star": must be one of: grid, list'),
        ('[vary]\n"load.preload" = []', "vary.load.preload: must have at least one value"),
        ('[vary]\n"load.preload" = [1, 2, 1.0]', "vary.load.preload: has 1.0 twice"),
        ('[vary]\n"load.preload" = 5e3', "vary.load.preload: must be a list of values, or a range"),
        ('[vary]\n"load.preload" = {from = 1, to = 2}', "vary.load.preload: a range needs count"),
        ('[vary]\n"load.preload" = {from = 1, to = 2, count = 1}', "count = 1: must be a whole number from 2"),
        ('[vary]\n"load.preload" = {from = 0, to = 2, count = 3, spacing = "log"}', "from and to must be > 0"),
        ('[vary]\n"load.preload" = {from = 1, to = 2, count = 3, step = 1}', "step: unknown key of a range"),
        ('[vary]\n"lode.preload" = [1.0]', "vary.lode.preload: no such section; did you mean 'load'?"),
        ('[vary]\n"load.preloat" = [1.0]', "at load.preloat = 1.0: load.preloat: unknown key; did you mean 'preload'?"),
        ('[vary]\n"load" = [1.0]', "vary.load: must be a key of a table, such as load.KEY"),
        ('[vary]\n"output.record" = [["force_z"]]', "vary.output.record: can't be varied"),
        ('[vary]\n"excitation.0.seed" = [1]', "vary.excitation.0.seed: excitations are counted from 1; the case has 2"),
        ('[vary]\n"excitation.3.seed" = [1]', "excitation.1.KEY to excitation.2.KEY"),
        ('[set]\n"load.preloads.x" = 1.0\n' + VARY, "set.load.preloads.x: must be a key of a table"),
        ('[set]\n"load.preload" = 1.0\n' + VARY, "vary.load.preload: in [set] as well"),
        ('[vary]\n"load.preload" = [50e3, -1.0]', "at load.preload = -1.0: load.preload = -1.0: must be > 0 (N)"),
        (
            '[vary]\n"load.preload" = [50e3, 60e3]\n"simulation.speed" = [0.0, 1.0, 2.0]',
            "at load.preload = 50000.0, simulation.speed = 0.0 (and at 1 other point): simulation.speed = 0.0: must be",
        ),
        (
            'combine = "list"\n[vary]\n"load.preload" = [50e3]\n"simulation.speed" = [1.0, 2.0]',
            "all keys need the same number of values: load.preload has 1, simulation.speed has 2",
        ),
        (
            '[vary]\n"load.preload" = {from = 1, to = 2, count = 1000}\n'
            '"simulation.speed" = {from = 1, to = 2, count = 1000}',
            "vary: 1000 x 1000 points; must be at most 100000",
        ),
        ("[[point]]\nload.preload = 1.0\n[[point]]\nsimulation.speed = 1.0", "point #2.load.preload: missing"),
        ("[[point]]\nload.preload = 1.0\n[[point]]\nload.preload = 1.0", "point #2: is the same as point #1"),
        (VARY + "[[point]]\nload.preload = 1.0", "[vary] or [[point]]: both given; give one of them"),
        (VARY + "[results]\nform = 0.1", "results.form: unknown key; did you mean 'from'?"),
        (VARY + "[results]\nfrom = -1", "results.from = -1: must be a finite number >= 0 (s)"),
        (VARY + "[results]\nfrom = 0.05", "results.from = 0.05: leaves less than 2 steps of the 0.05 s"),
        (VARY + '[results]\noutputs = ["force_w"]', 'results.outputs: "force_w": did you mean'),
        (VARY + '[results]\nstatistics = ["p101"]', 'results.statistics: "p101": must be one of: mean, std'),
        (VARY + "[results]\nsqueal = true", 'needs a tangential contact model, but contact.tangential = "none"'),
        (
            VARY + '[results.third_octave]\noutputs = ["force_z"]\nlowest = 100',
            "results.third_octave: highest missing",
        ),
        (
            VARY + '[results.third_octave]\noutputs = ["force_z"]\nlowest = 100\nhighest = 101',
            "no whole band lies between 100 Hz and 101 Hz",
        ),
        (VARY + "[workers]\ncount = -1", "workers.count = -1: must be a whole number from 0 to 1000"),
    ],
)
def test_faults(study_of, text, words):
    with pytest.raises(CaseError) as error:
        study_of(text)
    assert words in str(error.value)
    assert str(error.value).startswith(str(error.value.source))


def test_all_faults_come_in_one_report(study_of):
    with pytest.raises(CaseError) as error:
        study_of('seed = -1\n[vary]\n"load.preload" = []\n"simulation.speed" = 4\n[results]\nfrom = "x"')
    assert len(error.value.faults) == 4


def test_faults_of_the_case_file_are_told(study_of, tmp_path):
    (tmp_path / "base.toml").write_text("[simulation]\nspeed = 0")
    with pytest.raises(CaseError, match=r"study\.toml: \d+ faults") as error:
        study_of(VARY)
    assert "simulation.speed = 0: must be > 0" in str(error.value)
    (tmp_path / "base.toml").unlink()
    with pytest.raises(CaseError, match="no such file"):
        study_of(VARY)


@pytest.mark.parametrize(
    ("content", "words"),
    [(b"\xff", "not UTF-8 text"), (b"case = ", "not valid TOML"), (b"", "case: missing; give the case file")],
)
def test_unreadable_study_files(tmp_path, content, words):
    from wheelrail.study import load_study

    (tmp_path / "study.toml").write_bytes(content)
    with pytest.raises(CaseError, match=words):
        load_study(tmp_path / "study.toml")
    with pytest.raises(CaseError, match="no such file"):
        load_study(tmp_path / "none.toml")


def test_seeds_of_the_study_and_varied_ones_exclude_each_other(study_of):
    with pytest.raises(
        CaseError, match=r"excitation\.2\.seed: varied, but seed = 7 gives every point seeds of its own"
    ):
        study_of('seed = 7\n[vary]\n"excitation.2.seed" = [1, 2]')
