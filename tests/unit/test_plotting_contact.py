"""What the contact figures and animations show: units, counts, the border of the contact, frames."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from matplotlib.animation import FFMpegWriter
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, QuadMesh
from matplotlib.figure import Figure
from matplotlib.quiver import Quiver
from PIL import Image

from wheelrail.plotting.animation import animate_contact, instants_figure
from wheelrail.plotting.contact import STICK, contact_figure, draw_cut, draw_stick_slip
from wheelrail.plotting.contact_map import ContactMap, border, view_of
from wheelrail.plotting.creep import CreepPanel, creep_force_figure
from wheelrail.plotting.files import PlotError

MX, MY, DX, DY = 9, 7, 1e-3, 0.5e-3


def state(scale=1.0, contact=None, friction=0.3, mx=MX, my=MY):
    x, y = (np.arange(mx) - mx // 2) * DX, (np.arange(my) - my // 2) * DY
    xx, yy = np.meshgrid(x, y)
    pressure = 1e9 * np.maximum(1.0 - (xx / (0.4 * mx * DX)) ** 2 - (yy / (0.4 * my * DY)) ** 2, 0.0)
    touching = pressure > 0 if contact is None else contact
    pressure = np.where(touching, pressure, 0.0)
    tractions = scale * np.stack([-0.1 * pressure, 0.2 * pressure])
    slipping = np.broadcast_to(xx < -0.5 * DX, pressure.shape)  # outside the contact too: not to be counted
    return ContactMap(x, y, pressure, tractions, touching, slipping, friction)


def values_of(axis):
    (mesh,) = (item for item in axis.collections if isinstance(item, QuadMesh))
    array = mesh.get_array()
    assert array is not None
    return np.ma.asarray(array).reshape(mesh.get_coordinates().shape[0] - 1, -1), mesh.get_coordinates()


def test_panels_show_the_arrays_in_mm_and_mpa():
    shown = state()
    figure = contact_figure(shown, title="100 $ a_b", step=60, time=4.3e-3, note="0.1 %")
    pressure, arrows, division, cut, bar = figure.axes
    values, corners = values_of(pressure)
    np.testing.assert_array_equal(~np.ma.getmaskarray(values), shown.contact)
    np.testing.assert_allclose(values.filled(0.0), shown.pressure / 1e6)
    # Edges of the elements, half an element beyond the centres.
    np.testing.assert_allclose(corners[0, :, 0], np.arange(MX + 1) - 4.5)
    np.testing.assert_allclose(corners[:, 0, 1], (np.arange(MY + 1) - 3.5) * 0.5)
    (quiver,) = (item for item in arrows.collections if isinstance(item, Quiver))
    np.testing.assert_allclose(quiver.U, shown.tractions[0][shown.contact] / 1e6)
    np.testing.assert_allclose(quiver.V, shown.tractions[1][shown.contact] / 1e6)
    np.testing.assert_array_equal(values_of(division)[0].filled(-1) == 1, shown.contact & shown.slipping)
    slip, stick = int((shown.contact & shown.slipping).sum()), int((shown.contact & ~shown.slipping).sum())
    texts = [text.get_text() for text in division.get_legend().get_texts()]
    assert texts == [f"stick: {stick} elements", f"slip: {slip} elements"]
    assert division.get_xlabel() == "$x$ / mm"
    assert bar.get_ylabel() == "$p_3$ / MPa"
    assert all("rolling" in axis.get_title(loc="right") for axis in (pressure, arrows, division, cut))
    assert figure.get_suptitle() == "100 \\$ a_b\n0.1 %, step 60, t = 4.3 ms"
    FigureCanvasAgg(figure).draw()


def test_cut_goes_through_the_centre_line():
    shown = state(friction=np.full((MY, MX), 0.25))
    figure = contact_figure(shown)
    lines = {line.get_label(): line for line in figure.axes[3].lines}
    for label, expected in (
        (r"bound $\pm\mu\,p_3$", 0.25 * shown.pressure),
        ("longitudinal $p_1$", shown.tractions[0]),
        ("lateral $p_2$", shown.tractions[1]),
    ):
        x = np.asarray(lines[label].get_xdata(), float)
        np.testing.assert_allclose(lines[label].get_ydata(), np.interp(x, 1e3 * shown.x, expected[MY // 2] / 1e6))
        assert x[0] == -4.0  # an element without contact on either side, where the tractions are zero
        assert lines[label].get_ydata()[0] == 0.0
    axis = Figure().subplots()
    draw_cut(axis, shown, row=1)
    assert axis.lines[0].get_ydata().max() == pytest.approx(0.25e-6 * shown.pressure[1].max())
    assert axis.lines[0].get_ydata().max() < 0.25e-6 * shown.pressure.max()


def test_border_of_one_and_of_two_patches():
    x, y = np.arange(6.0), np.arange(4.0)
    mask = np.zeros((3, 5), dtype=bool)
    mask[1, 1:3] = True
    segments = {tuple(map(tuple, segment)) for segment in border(mask, x, y)}
    assert segments == {
        ((1.0, 1.0), (1.0, 2.0)),
        ((3.0, 1.0), (3.0, 2.0)),
        ((1.0, 1.0), (2.0, 1.0)),
        ((2.0, 1.0), (3.0, 1.0)),
        ((1.0, 2.0), (2.0, 2.0)),
        ((2.0, 2.0), (3.0, 2.0)),
    }
    mask[1, 4] = True  # at the edge of the grid: closed there as well
    assert len(border(mask, x, y)) == 10
    assert border(np.zeros((3, 5), dtype=bool), x, y) == []


def test_view_holds_the_contact_off_centre():
    touching = np.zeros((MY, MX), dtype=bool)
    touching[2:4, 6:9] = True
    (left, right), (low, high) = view_of(touching, state())
    assert right - left == pytest.approx(high - low)
    assert left < 1.5 < 4.5 < right
    assert low < -0.75 < 0.25 < high
    whole = view_of(np.zeros((MY, MX), dtype=bool), state())
    assert whole[0][0] < -4.0 < 4.0 < whole[0][1]


def test_a_fine_grid_gets_fewer_arrows_and_keeps_the_centre_line():
    axis = Figure().subplots()
    draw_stick_slip(axis, state(mx=101, my=99))
    (quiver,) = (item for item in axis.collections if isinstance(item, Quiver))
    assert 50 < len(quiver.U) <= 21 * 21
    assert 0.0 in quiver.Y
    assert 0.0 in quiver.X


def test_lost_contact_can_be_drawn():
    nothing = np.zeros((MY, MX), dtype=bool)
    figure = contact_figure(state(contact=nothing))
    assert "no contact" in [text.get_text() for text in figure.axes[0].texts]
    assert figure.axes[2].get_legend().get_texts()[0].get_text() == "stick: 0 elements"
    FigureCanvasAgg(figure).draw()


@pytest.mark.parametrize("name", ["pressure", "tractions", "contact", "slipping"])
def test_arrays_that_do_not_fit_are_refused(name):
    fields = {**state().__dict__}
    fields = {key: fields[key] for key in ("x", "y", "pressure", "tractions", "contact", "slipping", "friction")}
    fields[name] = fields[name][..., 1:]
    with pytest.raises(ValueError, match=f"{name} has the shape"):
        ContactMap(**fields)


FORCES = np.column_stack([np.zeros(5), -1e3 * np.arange(5.0)])


def test_animation_has_a_frame_for_each_state_and_replaces_the_file(tmp_path):
    path = tmp_path / "run.gif"
    path.write_text("earlier")
    states, seen = [state(scale) for scale in (0.0, 0.25, 0.5, 0.75, 1.0)], []
    returned = animate_contact(
        path,
        states,
        FORCES,
        distance=1e-3 * np.arange(5),
        title="t",
        force_limit=5e3,
        frames_per_second=10.0,
        progress=seen.append,
    )
    assert returned == path
    assert seen == pytest.approx([0.2, 0.4, 0.6, 0.8, 1.0])
    assert [item.name for item in tmp_path.iterdir()] == ["run.gif"]
    with Image.open(path) as film:
        assert film.n_frames == 5
        assert film.size == (737, 594)  # 6.7 in x 5.4 in at 110 dpi
        assert film.info["duration"] == 100
        frames = []
        for n in range(film.n_frames):
            film.seek(n)
            frames.append(np.asarray(film.convert("RGB"), dtype=int))
    # Only what moves changes: the axes stay where they are, the stuck elements keep their colour.
    colour = np.array([int(STICK[i : i + 2], 16) for i in (1, 3, 5)])
    for frame in frames:
        assert frame.shape == frames[0].shape
        assert (np.abs(frame - colour).max(axis=2) < 12).sum() > 2000
        moved = np.abs(frame - frames[0]).max(axis=2) > 40
        assert moved.mean() < 0.05
    assert all((np.abs(a - b).max(axis=2) > 40).sum() > 20 for a, b in itertools.pairwise(frames))


@pytest.mark.skipif(not FFMpegWriter.isAvailable(), reason="ffmpeg is not installed")
def test_film_as_mp4(tmp_path):
    path = animate_contact(tmp_path / "run.mp4", [state()] * 5, FORCES, distance=np.arange(5.0), title="t")
    assert path.read_bytes()[4:8] == b"ftyp"
    assert [item.name for item in tmp_path.iterdir()] == ["run.mp4"]


def test_animations_that_are_refused(tmp_path, monkeypatch):
    states, distance = [state()] * 5, np.arange(5.0)

    def animate(name="a.gif", states=states, forces=FORCES):
        animate_contact(tmp_path / name, states, forces, distance=distance, title="t")

    monkeypatch.setattr(FFMpegWriter, "isAvailable", lambda: False)
    with pytest.raises(PlotError, match=r"ffmpeg, which is not installed; write a \.gif"):
        animate("a.mp4")
    with pytest.raises(PlotError, match=r"\.gif or \.mp4"):
        animate("a.png")
    with pytest.raises(PlotError, match="no folder"):
        animate("nowhere/a.gif")
    with pytest.raises(PlotError, match="no frames"):
        animate(states=[])
    with pytest.raises(PlotError, match=r"shape \(5, 2\)"):
        animate(forces=FORCES[:4])
    with pytest.raises(PlotError, match="frame 4 lies on another grid"):
        animate(states=[*states[:4], state(mx=11)])
    assert not list(tmp_path.iterdir())


def test_a_stopped_animation_leaves_the_earlier_file(tmp_path):
    path = tmp_path / "run.gif"
    path.write_text("earlier")

    def stop(share):
        assert share == 0.2
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        animate_contact(path, [state()] * 5, FORCES, distance=np.arange(5.0), title="t", progress=stop)
    assert path.read_text() == "earlier"
    assert [item.name for item in tmp_path.iterdir()] == ["run.gif"]


def test_instants_share_their_scales():
    figure = instants_figure([state(0.5), state(1.0), state(0.25)], ["a", "b", "c"], title="t")
    maps, cuts = figure.axes[:3], figure.axes[3:]
    assert [axis.get_title(loc="left").strip() for axis in maps] == ["a", "b", "c"]
    quivers = [next(item for item in axis.collections if isinstance(item, Quiver)) for axis in maps]
    assert len({quiver.scale for quiver in quivers}) == 1
    assert len({axis.get_ylim() for axis in cuts}) == 1
    assert any(isinstance(item, LineCollection) for item in maps[0].collections)
    FigureCanvasAgg(figure).draw()


def test_creep_panels_keep_a_look_for_each_law_and_leave_out_what_does_not_apply():
    x = np.linspace(0.0, 1.0, 5)
    panels = [
        CreepPanel("one", x, "a", "b", {"exact": x, "other": 2 * x}, (0.0, 1.5)),
        CreepPanel("two", x, "a", "b", {"exact": x**2, "other": np.full(5, np.nan)}),
        CreepPanel("three", x, "a", "b", {"other": 3 * x}),
    ]
    figure = creep_force_figure(panels, title="t")
    one, two, three, unused = figure.axes
    curves = [{line.get_label(): line for line in axis.lines} for axis in (one, two, three)]
    np.testing.assert_array_equal(curves[0]["other"].get_ydata(), 2 * x)
    assert curves[0]["other"].get_color() == curves[2]["other"].get_color() != curves[0]["exact"].get_color()
    assert "other" not in curves[1]
    assert one.get_ylim() == (0.0, 1.5)
    assert not unused.axison
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["exact", "other"]
    with pytest.raises(ValueError, match="6 different curves"):
        creep_force_figure([CreepPanel("", x, "", "", {str(n): x for n in range(6)})], title="")
