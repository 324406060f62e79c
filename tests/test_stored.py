"""Flow maps on disk: the numbers that were made, or made anew."""

import numpy as np
import pytest

from viscoroll.kernels.motion.flow_layout import SIZE
from viscoroll.motion import flow


def place(alpha):
    """Parameters of a map, and its file."""
    parameters = alpha, 10.0, 0.3, 0.5
    return parameters, flow.path_of(parameters, 4)


def kept(alpha):
    """Whether the map of this alpha is there; else it is made."""
    parameters, path = place(alpha)
    made = flow.FlowMap(parameters, -16, np.full(SIZE, alpha), (1e-9, 2e-9, 3e-9), "")
    found = flow.load(path, parameters)
    if found is None:
        flow.save(made, path)
        return False
    assert np.array_equal(found.table, made.table)
    assert vars(found) | {"table": None} == vars(made) | {"table": None}
    return True


def test_what_others_may_have_written_is_not_read(own_maps):
    kept(2.0)
    (path,) = own_maps.iterdir()
    own_maps.chmod(0o777)
    path.write_bytes(b"others' work, which is damaged if it is looked at")
    assert not kept(2.0)
    assert path.read_bytes().startswith(b"others")
    own_maps.chmod(0o755)
    with pytest.warns(RuntimeWarning, match="cannot be used"):
        assert not kept(2.0)
    assert kept(2.0)


def test_a_damaged_map_is_built_again(own_maps):
    for number in (2.0, 3.0):
        kept(number)
    path, other = (place(number)[1] for number in (2.0, 3.0))
    whole = path.read_bytes()
    for damaged in (
        whole[:200] + bytes([whole[200] ^ 4]) + whole[201:],
        whole[: len(whole) // 2],
        b"",
        other.read_bytes(),
    ):
        path.write_bytes(damaged)
        with pytest.warns(
            RuntimeWarning, match=r"flow map cannot be used \(.+\) and is built again"
        ):
            assert not kept(2.0)
        assert kept(2.0)
