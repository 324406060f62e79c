"""Flow maps on disk."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..core import stored
from ..core.typed import Floats
from ..materials.prony import Prony


@dataclass(frozen=True)
class FlowMap:
    """Tables that roll the motions of one scene.

    Attributes
    ----------
    parameters : alpha or series in its own unit of time, kappa, mu, j.
    first : kappa V of the slowest stick onset in it is 2**first.
    table : all tables, see ``kernels/flow/layout.py``.
    errors : stated ones, four times the worst of 100 motions that the integrator rolled at rtol 1e-12 when the map was
        built: of V and omega relative to the larger of the two; of distance and angle, relative to the larger of the
        two so far (and to 1e-5 of that at rest: they are differences of what is left to it); of the energy lost in
        slip and in rolling, relative to that at the start.
    problem : why the scene has no map, or "".
    """

    parameters: tuple[Any, ...]
    first: int
    table: Floats
    errors: tuple[float, ...]
    problem: str

    @property
    def slow_rate(self) -> float:
        """At which ln V falls in the end, as gamma t counts time: T_mean/(1 + j)."""
        material, _, _, j = self.parameters
        T_mean: float = material.T_mean if isinstance(material, Prony) else (material - 1.0) / material
        return T_mean / (1.0 + j)

    def stated_error(self, *, path: bool, loss: bool) -> float:
        """The largest of the errors of the speeds and, where asked for, of the path and the losses."""
        speeds, way, lost = self.errors
        return max(speeds, way if path else 0.0, lost if loss else 0.0)


def folder() -> Path:
    """Where maps are kept."""
    return stored.folder("flow")


def _numbers(parameters: tuple[Any, ...]) -> tuple[float, ...]:
    """The parameters as numbers: those of a series are alpha, the rates of relaxation, and their strengths."""
    material, *others = parameters
    if isinstance(material, Prony):
        return (material.alpha, *material.modes.a.tolist(), *material.modes.E.tolist(), *others)
    return parameters


def path_of(parameters: tuple[Any, ...], octave: int) -> Path:
    """File of the map for kappa V < 2**octave at stick onset."""
    return folder() / stored.file_name((*_numbers(parameters), octave))


def load(path: Path, parameters: tuple[Any, ...]) -> FlowMap | None:
    """The map in a file; None if there is none, or after a warning, none that is whole."""
    from ..kernels.flow.layout import SIZE

    def read(data: Any) -> FlowMap:
        found = FlowMap(
            parameters, int(data["first"]), data["table"], tuple(data["errors"].tolist()), str(data["problem"]),
        )  # fmt: skip
        if found.table.shape != (SIZE,):
            raise ValueError("its table is of another size")
        return found

    return stored.load(path, "flow map", _numbers(parameters), read)


def save(made: FlowMap, path: Path) -> None:
    """Keep a map; where it cannot be written it is built anew next time."""
    stored.save(
        path, _numbers(made.parameters), first=made.first, table=made.table, errors=made.errors, problem=made.problem,
    )  # fmt: skip
