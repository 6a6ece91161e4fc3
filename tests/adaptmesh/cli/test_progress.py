"""The progress bar on the terminal."""

import io

from adaptmesh.cli.progress import TerminalProgress


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_silent_when_not_a_terminal():
    stream = io.StringIO()
    with TerminalProgress(stream, delay=0.0) as progress:
        progress("placing points", 0.5)
    assert stream.getvalue() == ""


def test_silent_while_the_work_is_short():
    stream = Terminal()
    with TerminalProgress(stream, delay=60.0) as progress:
        progress("placing points", 0.5)
    assert stream.getvalue() == ""


def test_names_the_stage_and_how_much_is_done():
    stream = Terminal()
    with TerminalProgress(stream, delay=0.0) as progress:
        progress("placing points", 0.25)
        progress("smoothing", 0.75)
    assert "smoothing" in stream.getvalue()
    assert "75%" in stream.getvalue()
