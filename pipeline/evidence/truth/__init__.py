"""The truth: law and motions in many digits, sharing no code with the kernels, and the check values
made by them.

Nothing here is installed with the package: python-flint comes with ``viscoroll[dev]``.
"""

from .enclosures import contact_enclosure

__all__ = ["contact_enclosure"]
