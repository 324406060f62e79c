"""A cylinder by the table of its law, as an FMU for Modelica tools, Simulink and others: :func:`build`.

    from viscoroll import fmu
    fmu.build(vr.presets.RUBBER_CYLINDER, "roller.fmu")  # or `viscoroll fmu`

Two models.  ``ContactElement`` gives the forces of a contact, with exact slopes, to a mechanism that knows where the
cylinder is.  ``Roller`` is the cylinder itself; in co-simulation it takes its own steps.  Read in this order:
:mod:`variables`, :mod:`description` (modelDescription.xml), fmu.c, :mod:`build`.
"""

from .build import build

__all__ = ["build"]
