"""Reference values of the contact law that share no code with the kernels."""

from .enclosures import contact_enclosure
from .precise import MissingDependencyError, contact_precise

__all__ = ["MissingDependencyError", "contact_enclosure", "contact_precise"]
