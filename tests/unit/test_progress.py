"""Progress bars: where they are shown, and where not."""

from __future__ import annotations

from wheelrail.progress import progress_bar


def test_no_bar_without_a_terminal_or_when_quiet(capsys):
    for options in ({}, {"quiet": True}, {"quiet": True, "force": True}):
        with progress_bar("work", **options) as reached:
            reached(0.5)
            reached(1.0)
    assert capsys.readouterr() == ("", "")


def test_a_bar_appears_with_the_first_value_and_ends_at_the_total(capsys):
    with progress_bar("work", total=200, unit="steps", force=True) as reached:
        assert capsys.readouterr().err == ""
        reached(50)
        reached(200)
        out, err = capsys.readouterr()
    assert out == ""
    assert "work:" in err
    assert "100%" in err
    assert err.endswith("\n")  # the next bar has a line of its own
    assert capsys.readouterr().err == ""


def test_an_error_ends_the_bar(capsys):
    try:
        with progress_bar("work", force=True) as reached:
            reached(0.25)
            raise KeyboardInterrupt
    except KeyboardInterrupt:
        pass
    assert capsys.readouterr().err.endswith("\n")
