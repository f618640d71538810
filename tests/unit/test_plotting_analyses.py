"""Figures of contact filters, decay rates, impacts and velocities: what is drawn, and how axes are named."""

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from wheelrail.analysis.contact_filter import ContactFilter
from wheelrail.analysis.contact_filter_models import enclosing_filters, patch_filter
from wheelrail.analysis.contact_velocity import ContactVelocities
from wheelrail.analysis.impact_statistics import impact_statistics, turns
from wheelrail.analysis.track_decay_rate import DecayRate, decay_rate_limit, grid_positions
from wheelrail.plotting.contact_filter import contact_filter_figure
from wheelrail.plotting.decay_rate import decay_rate_figure
from wheelrail.plotting.impacts import impacts_figure
from wheelrail.plotting.velocity_spectra import velocity_figure

BANDS = 10.0 ** (np.arange(18, 38) / 10.0)  # 63 Hz to 5 kHz


def draw(figure):
    FigureCanvasAgg(figure).draw()
    return figure.axes


def curve(axis, label):
    (line,) = (line for line in axis.lines if line.get_label() == label)
    return np.asarray(line.get_xdata(), float), np.asarray(line.get_ydata(), float)


def names(axis):
    return {label.get_text() for label in axis.get_xticklabels()}


def test_contact_filters():
    waves = 20.0 / BANDS
    one = ContactFilter(BANDS, waves, patch_filter(waves, radius=6e-3))
    other = ContactFilter(BANDS, waves, np.where(waves > 8e-3, -3.0, np.nan))
    (axis,) = draw(
        contact_filter_figure(
            filters={"winkler": one, "half-space": other},
            speed=20.0,
            theory={"patch": (waves, one.levels)},
            enclosing=enclosing_filters(load=65e3, wheel_diameter=0.92),
            title="a $ b",
        )
    )
    for label in ("winkler", "patch"):
        np.testing.assert_allclose(curve(axis, label)[0], 1e3 * waves)
        np.testing.assert_allclose(curve(axis, label)[1], one.levels)
    assert np.isnan(curve(axis, "half-space")[1]).sum() == np.sum(waves <= 8e-3)
    assert "CNOSSOS, 50 to 100 kN" in {text.get_text() for text in axis.get_legend().get_texts()}
    left, right = axis.get_xlim()
    assert left > 1e3 * waves.max()
    assert right < 1e3 * waves.min()
    assert {"250", "31.5", "8"} <= names(axis)
    (above,) = axis.child_axes
    assert above.get_xlabel() == "Frequency at 72 km/h / Hz"
    # 20 m/s over 20 mm: 1 kHz, at the same place.
    at, below = above.transData.transform((1e3, 0.0)), axis.transData.transform((20.0, 0.0))
    assert at[0] == pytest.approx(below[0])
    assert {"100", "1000", "5000"} <= names(above)


def test_too_many_filters():
    one = ContactFilter(BANDS, 20.0 / BANDS, np.zeros(len(BANDS)))
    for filters in ({}, {str(i): one for i in range(5)}):
        with pytest.raises(ValueError, match="one to 4"):
            contact_filter_figure(filters=filters, speed=20.0, title="")


def test_decay_rates_and_limits():
    positions = grid_positions(0.6)
    rates = np.geomspace(10.0, 0.15, len(BANDS))
    one = DecayRate(BANDS, rates, rates * positions[-1], positions)
    (axis,) = draw(decay_rate_figure({"vertical": one}, title=""))
    np.testing.assert_array_equal(curve(axis, "vertical")[1], rates)
    limit = curve(axis, "vertical, EN ISO 3095 at least")
    np.testing.assert_array_equal(limit, decay_rate_limit("vertical"))
    x, y = curve(axis, "vertical, upper bound")
    np.testing.assert_array_equal(x, BANDS[~one.measurable])
    assert 0 < len(x) < len(BANDS)
    assert np.all(y * positions[-1] < 10.0)
    assert axis.get_yscale() == "log"
    assert {"63", "1k", "4k"} <= names(axis)
    (axis,) = draw(decay_rate_figure({"vertical": one}, limits=False, title=""))
    assert not any("3095" in str(line.get_label()) for line in axis.lines)


def test_impacts():
    force = np.full(2000, 60e3)
    force[::400] = 150e3
    force[1::400] = 0.0
    kwargs = {"dt": 1e-3, "speed": 10.0}
    statistics = impact_statistics(force, static_load=60e3, **kwargs)
    found = turns(force, radius=4.0 / (2.0 * np.pi), **kwargs)
    assert len(found) == 5
    first, second = draw(impacts_figure(force=force, statistics=statistics, turns=found, title=""))
    x, y = curve(first, "contact force")
    assert y[np.searchsorted(x, 100.0)] == pytest.approx(0.25)  # 1 of 400 steps
    np.testing.assert_array_equal(curve(second, "largest"), ([1, 2, 3, 4, 5], [150.0] * 5))
    np.testing.assert_array_equal(curve(second, "smallest")[1], 0.0)
    assert len(draw(impacts_figure(force=force, statistics=statistics, title=""))) == 1


def test_velocities():
    squares = {"wheel_disp_z": np.full(len(BANDS), 1e-8), "rail_disp_y": np.zeros(len(BANDS))}
    squares["rail_disp_y"][3:] = 1e-10
    velocities = ContactVelocities(BANDS, squares, np.full(len(BANDS), 10.0))
    (axis,) = draw(velocity_figure(velocities, title=""))
    np.testing.assert_allclose(curve(axis, "wheel, vertical")[1], 100.0)
    x, y = curve(axis, "rail, lateral")
    np.testing.assert_array_equal(x, BANDS[3:])
    np.testing.assert_allclose(y, 80.0)
    assert axis.get_ylabel() == "Velocity level / dB re 1 nm/s"
    with pytest.raises(ValueError, match="too short"):
        velocity_figure(ContactVelocities(np.empty(0), {}, np.empty(0)), title="")
