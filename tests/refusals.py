"""Bad input: an error of the package's own, in one line that names the thing, its value and what is
allowed.
"""

from functools import partial

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


def each(call, given, error=vr.ParameterError, **usual):
    """Parameters of a test: calls, the words of the answer, and the error that has them.

    given: words, with " | " between, -> a dict of arguments beside the ``usual`` or in place of
    them, a tuple of arguments, or one; without ``call`` a function that makes the whole call; a
    list of several of these.
    """
    found = []
    for words, ways in given.items():
        for one in ways if isinstance(ways, list) else [ways]:
            named = one if isinstance(one, dict) else {}
            listed = one if isinstance(one, tuple) else () if isinstance(one, dict) else (one,)
            made = partial(call, *listed, **usual | named) if call else one
            found.append(pytest.param(made, words.split(" | "), error, id=words))
    return found


def refusals(rows):
    """The test of rows that ``each`` makes."""

    @pytest.mark.parametrize("call, words, error", rows)
    def test(call, words, error):
        refused(call, *words, error=error)

    return test
