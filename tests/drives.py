"""Drives that data files hold: numbers, schedules and gains in plain words."""

import viscoroll as vr


def given(plain):
    """As calls take them."""
    if not isinstance(plain, dict):
        return plain
    if "times" in plain:
        return vr.Schedule(**plain)
    return vr.Feedback(**plain | {"value": given(plain["value"])})
