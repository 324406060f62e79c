"""Export of a cylinder and its law as a Functional Mock-up Unit (FMU) for Modelica tools, Simulink
and others.

    from viscoroll import fmu
    fmu.build(vr.presets.RUBBER_CYLINDER, "roller.fmu")  # or `viscoroll fmu`

There are two models.  ``ContactElement`` gives the forces of a contact, with exact slopes, to a
multibody model that knows the motion of the cylinder.  ``Roller`` is the cylinder itself; in
co-simulation it has its own step-size control.  :mod:`fmu_build` writes descriptions and sources,
and compiles fmu.c, which has the functions of the standard.
"""

from .fmu_build import build

__all__ = ["build"]
