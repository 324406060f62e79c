"""A misspelt argument of a public call: the TypeError names the one that was meant."""

import inspect

import pytest

import viscoroll as vr


def public_calls():
    """Every public function, class that users make, and method, with its arguments by name."""
    values = [getattr(vr, name) for name in vr.__all__[1:]]
    listed = [
        getattr(value, name)
        for value in values
        if inspect.ismodule(value)
        for name in value.__all__
    ]
    for value in {*filter(callable, [*values, *listed])}:
        if not inspect.isclass(value):
            yield value
        elif not issubclass(value, tuple | int):  # the package makes these
            yield from [value, *(getattr(value, name) for name in dir(value) if name[0] != "_")]


def parameters(call):
    try:
        found = inspect.signature(call).parameters.values()
    except (TypeError, ValueError):  # not callable, or of C
        return []
    if any(each.kind is each.VAR_KEYWORD for each in found):
        return []
    return [
        each.name for each in found if each.kind in (each.KEYWORD_ONLY, each.POSITIONAL_OR_KEYWORD)
    ]


def test_every_misspelt_argument_of_public_calls_is_told():
    asked = [
        (call, name)
        for call in public_calls()
        for name in parameters(call)
        if len(name) > 2 and name != "self"
    ]
    assert len(asked) > 300
    for call, name in asked:
        with pytest.raises(TypeError, match=f"; did you mean '{name}'"):
            call(**{name + "_": None})


def test_a_type_error_of_a_users_function_stays_as_it_is():
    def torque(t):
        return dict(t, speed=1.0) if t < 0.0 else torque(time=t)

    with pytest.raises(TypeError, match=r"argument 'time'$"):
        vr.presets.RUBBER_CYLINDER.roll(1.0, 10.0, 1.0, torque=torque)
