"""Sound files: pitch, level and refusals."""

import numpy as np
import pytest
from scipy.io import wavfile

from wheelrail.results.sound import write_sound


def test_a_tone_keeps_its_pitch_and_the_scale_its_amplitude(tmp_path) -> None:
    dt = 7.2e-5  # dx 1 mm at 50 km/h
    time = np.arange(20000) * dt
    full_scale = write_sound(tmp_path / "tone.wav", 65e3 + 800.0 * np.sin(2.0 * np.pi * 3137.0 * time), dt=dt)
    rate, sound = wavfile.read(tmp_path / "tone.wav")
    assert (rate, sound.dtype, sound.ndim) == (48000, np.int16, 1)
    assert len(sound) / rate == pytest.approx(20000 * dt, rel=1e-3)
    middle = sound[4800:-4800] / 32767.0 * full_scale
    spectrum = np.abs(np.fft.rfft(middle * np.hanning(len(middle))))
    assert np.argmax(spectrum) * rate / len(middle) == pytest.approx(3137.0, abs=1.0)
    assert np.abs(middle).max() == pytest.approx(800.0, rel=0.02)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (np.full(5000, 65e3), "nothing to hear"),
        (np.zeros(10), "at least 0.05 s"),
        (np.array([0.0, np.nan] * 2500), "not finite"),
    ],
)
def test_refusals(tmp_path, values, message) -> None:
    with pytest.raises(ValueError, match=message):
        write_sound(tmp_path / "none.wav", values, dt=7.2e-5)
    assert not list(tmp_path.iterdir())
