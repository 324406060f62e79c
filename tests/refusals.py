"""Bad input: an error of the package's own, in one line that names the thing, its value and what is
allowed.
"""

import pytest

import viscoroll as vr


def refused(call, *words, error=vr.ParameterError):
    """The text of the error that ``call`` raises: one line that holds ``words``."""
    try:
        call()
    except error as raised:
        text = str(raised)
        assert "\n" not in text, text
        for word in words:
            assert word in text, text
        return text
    pytest.fail(f"not refused: {', '.join(words)}")
