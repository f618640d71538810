import os

import numpy as np
import pytest

from wheelrail.errors import DataFileError
from wheelrail.numerics.column_file import read_columns, read_text

KNOWN = ("name", "frequency", "shape_x", "shape")
HERTZ = {"Hz": 1.0, "kHz": 1e3}


def written(tmp_path, text, encoding="utf-8"):
    path = tmp_path / "table.csv"
    path.write_bytes(text.encode(encoding))
    return path


@pytest.mark.parametrize(
    "header", ["frequency [Hz]", "frequency (Hz)", "frequency_Hz", "Frequency [hz]", "frequency[Hz]"]
)
def test_names_and_units(tmp_path, header):
    file = read_columns(written(tmp_path, f"# a comment\n\nshape_x,{header}\n0.5,100\n-1e-3,2e2\n"), known=KNOWN)
    np.testing.assert_array_equal(file.numbers("frequency", HERTZ), [100.0, 200.0])
    np.testing.assert_array_equal(file.numbers("shape_x", {"": 1.0}), [0.5, -1e-3])
    assert (file.header_line, file.lines) == (3, (4, 5))


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_separators_and_quotes(tmp_path, separator):
    text = separator.join(["name", "frequency [kHz]"]) + "\n" + separator.join(['"2,0,a"', " 0.4 "]) + "\n"
    file = read_columns(written(tmp_path, text), known=KNOWN)
    assert file.fields["name"] == ("2,0,a",)
    assert file.numbers("frequency", HERTZ)[0] == 400.0


def test_windows_line_ends_byte_order_mark_and_latin(tmp_path):
    file = read_columns(written(tmp_path, "\ufefffrequency [Hz]\r\n5\r\n"), known=KNOWN)
    assert file.numbers("frequency", HERTZ)[0] == 5.0
    path = written(tmp_path, "# gr\u00f6\u00dfe\nshape [\u00b5]\n5\n", encoding="latin-1")
    assert read_columns(path, known=KNOWN).numbers("shape", {"\u00b5": 1.0})[0] == 5.0


def test_case_of_a_unit_counts_where_only_the_case_differs(tmp_path):
    file = read_columns(written(tmp_path, "shape [mN]\n1\n"), known=KNOWN)
    assert file.numbers("shape", {"MN": 1e6, "mN": 1e-3})[0] == 1e-3


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "{path}: the file is empty; it needs a header and rows under it"),
        ("frequency [Hz]\n", "{path}: the file is empty; it needs a header and rows under it"),
        ("freq [Hz]\n1\n", '{path}, line 1: unknown column "freq [Hz]"; known: name, frequency, shape_x, shape'),
        ("shape,shape\n1,2\n", "{path}, line 1: two columns shape"),
        (
            "name,frequency [Hz]\n2,0,a,400\n",
            "{path}, line 2: 4 entries, but the header names 2 columns "
            '(an entry that holds "," stands in double quotes)',
        ),
        ("frequency [Hz]\n\n1.2.3\n", '{path}, line 3: frequency is "1.2.3", not a finite number'),
        (
            "shape;frequency [Hz]\n1;1,5\n",
            '{path}, line 2: frequency is "1,5", not a finite number; decimal commas are not read: write a point',
        ),
        ("shape,frequency [Hz]\n1,\n", "{path}, line 2: frequency is an empty field, not a finite number"),
        ("frequency [Hz]\nnan\n", '{path}, line 2: frequency is "nan", not a finite number'),
        (
            "frequency\n1\n",
            '{path}, line 1: column frequency names no unit; write "frequency [Hz]" (allowed: Hz, kHz)',
        ),
        ("frequency [rad/s]\n1\n", "{path}, line 1: column frequency has the unit [rad/s]; allowed: Hz, kHz"),
    ],
)
def test_faults(tmp_path, text, message):
    path = written(tmp_path, text)
    with pytest.raises(DataFileError) as caught:
        read_columns(path, known=KNOWN).numbers("frequency", HERTZ)
    assert str(caught.value) == message.format(path=path)


def test_unit_where_none_is_allowed(tmp_path):
    file = read_columns(written(tmp_path, "shape [m]\n1\n"), known=KNOWN)
    with pytest.raises(DataFileError, match=r"column shape has the unit \[m\]; it is a number without a unit"):
        file.numbers("shape", {"": 1.0})


def test_files_that_are_no_text(tmp_path):
    with pytest.raises(DataFileError, match="there is no such file"):
        read_columns(tmp_path / "none.csv", known=KNOWN)
    with pytest.raises(DataFileError, match="a folder"):
        read_columns(tmp_path, known=KNOWN)
    with pytest.raises(DataFileError, match="UTF-16"):
        read_columns(written(tmp_path, "frequency [Hz]\n1\n", encoding="utf-16"), known=KNOWN)
    with pytest.raises(DataFileError, match="zero bytes"):
        read_columns(written(tmp_path, "a\0b"), known=KNOWN)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no pipes in folders")
def test_a_pipe_is_refused_at_once(tmp_path):
    pipe = tmp_path / "pipe.csv"
    os.mkfifo(pipe)
    with pytest.raises(DataFileError, match="no ordinary file"):
        read_text(pipe)
