"""Flow maps, and their files beside the compiled kernels: sealed, and limited to those used
last.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from ..core.checks import Floats
from ..core.files import load_kept, save_kept
from ..kernels.numerics.cache_folder import cache_root
from ..materials.prony import Prony

#: maps kept; the one that was used longest ago goes first
KEPT = 64


@dataclass(frozen=True)
class FlowMap:
    """Tables of the free motions of one scene, from which a motion is looked up without
    integration.

    Attributes
    ----------
    parameters : (alpha, or series in its own unit of time; kappa; mu; j), numbers.
    first : binary exponent: kappa V of the slowest tabulated onset of partial slip is 2**first.
    table : all tables in one vector, see ``kernels/motion/flow_layout.py``.
    errors : stated errors of (speeds, path, losses), four times the largest of 100 motions against
        the integrator at rtol 1e-12, measured when the map was built, at least 1e-10, 5e-10, 1e-10:
        of V and omega relative to the larger of the two; of distance and angle relative to the
        larger of the two so far (and to 1e-5 of that at rest); of slip and rolling loss relative to
        the initial energy.  Infinite where ``problem`` is not "".
    problem : why the scene has no map, or "".
    """

    parameters: tuple[Any, ...]
    first: int
    table: Floats
    errors: tuple[float, ...]
    problem: str

    @property
    def slow_rate(self) -> float:
        """Rate at which ln V falls at low speeds, in time gamma t: T_mean/(1 + j), a float; 0 if
        elastic.
        """
        material, _, _, j = self.parameters
        T_mean: float = (
            material.T_mean if isinstance(material, Prony) else (material - 1.0) / material
        )
        return T_mean / (1.0 + j)

    def stated_error(self, *, path: bool, loss: bool) -> float:
        """Return the largest stated error, relative, of the speeds and, if requested, of path and
        losses.

        path, loss : whether the errors of distance and angle, and those of slip and rolling loss,
        count.
        Returns a float; infinite where the scene has no map.
        """
        speeds, way, lost = self.errors
        return max(speeds, way if path else 0.0, lost if loss else 0.0)


def folder() -> Path:
    """Return the path of the folder of the maps, named by the sources of kernels and modules that
    make and read them.

    It may not exist yet.
    """
    return cache_root() / f"flow-{_digest(Path(__file__).parents[1])}"


@lru_cache(maxsize=1)
def _digest(package: Path) -> str:
    """Return a digest of all sources on which the bits of a map depend: kernels, materials and
    motions.

    package: folder of the package.
    Returns a text of the first 16 hexadecimal digits of the SHA-256; it is computed once in a
    process.
    """
    from ..kernels.numerics.jit import sources_digest

    digest = hashlib.sha256(sources_digest().encode())
    for part in ("materials", "motion"):
        for path in sorted((package / part).rglob("*.py")):
            digest.update(path.name.encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


def _numbers(parameters: tuple[Any, ...]) -> tuple[float, ...]:
    """Return the parameters as numbers, by which a map is named and compared.

    parameters : (alpha or :class:`Prony` series, kappa, mu, j).
    Returns a flat tuple: (alpha, kappa, mu, j), or with a series (alpha, relaxation rates,
    strengths, kappa, mu, j).
    """
    material, *others = parameters
    if isinstance(material, Prony):
        return (material.alpha, *material.modes.a.tolist(), *material.modes.E.tolist(), *others)
    return parameters


def path_of(parameters: tuple[Any, ...], octave: int) -> Path:
    """Return the path of the file of a flow map, which may not exist.

    parameters : (alpha or :class:`Prony` series, kappa, mu, j).
    octave : the map covers kappa V < 2**octave at the onset of partial slip.
    Returns the path in :func:`folder`; its name is a digest of the parameters and the octave.
    """
    numbers = np.array((*_numbers(parameters), octave), np.float64)
    return folder() / (hashlib.sha256(b"sealed" + numbers.tobytes()).hexdigest()[:20] + ".npz")


def load(path: Path, parameters: tuple[Any, ...]) -> FlowMap | None:
    """Return the map in a file.

    The time of last change of the file is set to now if it can be: maps that were used last are
    kept.

    path : path of the file, as of :func:`path_of`.
    parameters : (alpha or :class:`Prony` series, kappa, mu, j) that the map must have.
    Returns the :class:`FlowMap`; None if there is no file that can be read, also if others may
    write to it or to a folder above it, or if one belongs to another user; None with a
    RuntimeWarning if its content is damaged or of other parameters.
    """
    damaged = "flow map is damaged ({}) and is built again"
    return load_kept(path, damaged, lambda data: _read(data, parameters))


def _read(data: Any, parameters: tuple[Any, ...]) -> FlowMap:
    """Return the :class:`FlowMap` in the arrays of a file.

    data: arrays by name.
    parameters: (alpha or :class:`Prony` series, kappa, mu, j) that the map must have.
    Raises ValueError for one of another scene or with a table of another size, and KeyError for one
    that lacks an array.
    """
    from ..kernels.motion.flow_layout import SIZE

    if not np.array_equal(data["parameters"], _numbers(parameters)):
        raise ValueError("it belongs to another scene")
    if data["table"].shape != (SIZE,):
        raise ValueError("the size of its table is wrong")
    return FlowMap(
        parameters=parameters,
        first=int(data["first"]),
        table=data["table"],
        errors=tuple(data["errors"].tolist()),
        problem=str(data["problem"]),
    )


def save(new_map: FlowMap, path: Path) -> None:
    """Write a map, and delete the oldest maps of the folder beyond :data:`KEPT`.

    Nothing is raised if it cannot be written, or an old map not deleted (OSError), also if others
    may write to a folder above it: the map is then not on disk, or too many are.  The file has the
    fields of :class:`FlowMap`, with the parameters as of :func:`_numbers`, and a seal.

    new_map : the :class:`FlowMap`.
    path : path of the file, as of :func:`path_of`; it is replaced if it exists.
    """
    save_kept(path, KEPT, vars(new_map) | {"parameters": _numbers(new_map.parameters)})
