"""Reference values of the contact law and of motions that share no code with the kernels."""

from ..errors import MissingDependencyError
from .driven import roll_driven
from .enclosures import contact_enclosure
from .motion import roll_precise
from .precise import contact_precise

__all__ = ["MissingDependencyError", "contact_enclosure", "contact_precise", "roll_driven", "roll_precise"]
