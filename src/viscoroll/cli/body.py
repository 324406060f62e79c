"""What the options say that rolls: a scene, dimensionless, or the cylinder of a file, in SI units."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

from ..errors import ParameterError
from .arguments import PARAMETERS, scene_parameters

if TYPE_CHECKING:
    from ..scene import Scene
    from ..validity import Validity

#: of a [cylinder], what options may change
_OF_A_CYLINDER = ("mu", "j")


class Body(NamedTuple):
    """A scene with the methods of a :class:`viscoroll.Cylinder`, dimensionless, and what a sheet says of it."""

    scene: Scene

    @property
    def units(self) -> dict[str, str]:
        """Unit of a column in a sheet: of a scene there are none."""
        return {}

    @property
    def constants(self) -> dict[str, float]:
        """Its parameters."""
        return self.scene.numbers

    def contact(self, V: Any, **options: Any) -> Any:
        """As :func:`viscoroll.contact`."""
        from ..rolling_contact import contact

        return contact(self.scene, V, **options)

    def stress(self, x: Any, V: Any, **options: Any) -> Any:
        """As :func:`viscoroll.stress`."""
        from ..contact_stress import stress

        return stress(self.scene, x, V, **options)

    def roll(self, *start: Any, **options: Any) -> Any:
        """As :func:`viscoroll.roll`."""
        from .. import motion

        return motion.roll(self.scene, *start, **options)

    def ensemble(self, *start: Any, **options: Any) -> Any:
        """As :func:`viscoroll.ensemble`."""
        from ..motion import ensemble

        return ensemble(self.scene, *start, **options)

    def steady(self, **loads: Any) -> Any:
        """As :func:`viscoroll.steady`."""
        from ..equilibria import steady

        return steady(self.scene, **loads)

    def validity(self, V: Any, omega: Any = None) -> Validity:
        """As :meth:`viscoroll.Scene.validity`."""
        return self.scene.validity(V, omega=omega)


class BodySI:
    """A cylinder in SI units, with what a sheet says of it."""

    def __init__(self, cylinder: Any) -> None:
        from ..si.units import QUANTITIES

        self.cylinder = cylinder
        self.units = {name: quantity.units for name, quantity in QUANTITIES.items()}
        self.units |= {"R": "m", "m": "kg m-1", "load": "N m-1"}

    @property
    def constants(self) -> dict[str, float]:
        """Its parameters."""
        return {name: getattr(self.cylinder, name) for name in ("R", "m", "mu", "j", "load")}

    def __getattr__(self, name: str) -> Any:
        return getattr(self.cylinder, name)


def body_of(arguments: Namespace) -> Body | BodySI:
    """The scene or the cylinder that the options name; errors as :func:`parts_of`, and of its parameters."""
    parameters, made = parts_of(arguments)
    return made(parameters)


def parts_of(arguments: Namespace) -> tuple[dict[str, Any], Callable[[dict[str, Any]], Body | BodySI]]:
    """What the options give of a scene, or change of a cylinder, and what makes a body of such parameters.

    Raises
    ------
    ParameterError
        An unknown preset, too little given, a parameter that a [cylinder] does not have.
    ConfigError
        A scene file that cannot be read.
    """
    from ..config import read_body
    from ..cylinder import Cylinder
    from ..scene import Scene

    if arguments.scene is not None and isinstance(cylinder := read_body(arguments.scene), Cylinder):
        changed = {name: getattr(arguments, name) for name in PARAMETERS if getattr(arguments, name) is not None}
        wrong = [f"--{name}" for name in changed if name not in _OF_A_CYLINDER]
        if wrong:
            sentence = f"{', '.join(wrong)} cannot change a [cylinder], which is in SI units: change the file"
            raise ParameterError(wrong[0], "given", "left out", sentence)
        return changed, lambda values: BodySI(cylinder.replace(**values))
    return scene_parameters(arguments), lambda values: Body(Scene(**values))
