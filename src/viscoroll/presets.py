"""Scenes by name: the cylinder, the scenes and the starts of the paper, and a rubber roller."""

from __future__ import annotations

from .materials import Material, Prony
from .rollers import Cylinder, Scene

__all__ = [
    "PAPER_CYLINDER",
    "PAPER_FIGURES_2_3",
    "PAPER_SECTION_5",
    "PAPER_SECTION_5_ROUNDED",
    "PAPER_STARTS",
    "RUBBER_CYLINDER",
    "RUBBER_ROLLER",
]

#: Cylinder of Sect. 5 as computed in the paper: from the dimensional list of Sect. 4 with g = 9.81
#: m/s^2 and mu = 0.2, SI units.  Gives alpha = 11.031, kappa = 2.9210, gamma = 11231 and the
#: paper's numbers.
PAPER_CYLINDER = Cylinder(R=0.1, m=35.5, E=2.3e5, nu=0.49, T_epsilon=10.7, T_sigma=0.97, mu=0.2)
#: Its dimensionless scene.
PAPER_SECTION_5 = PAPER_CYLINDER.scene()
#: The rounded parameters printed at the end of Sect. 4; stick onset of IC1 moves 2 % later.
PAPER_SECTION_5_ROUNDED = Scene(alpha=11.0, kappa=2.91, mu=0.2, gamma=1.1e4, j=0.5)
#: Figs. 2 and 3 use kappa = 29.1, ten times that of Sects. 4-5; alpha is varied there
#: (1, 1.5, 21.5, 81.5 in Figs. 2 and 3b, 11 in Fig. 3a).
PAPER_FIGURES_2_3 = Scene(alpha=11.0, kappa=29.1, mu=0.2, gamma=1.1e4, j=0.5)
#: The paper's cylinder made of a rubber with short times, so that the law of steady rolling may
#: drive its motion at any speed (:meth:`Scene.validity`): R = 0.1 m, m = 35.5 kg/m, mu = 0.3, j =
#: 0.5, load m g = 348 N/m; long-time modulus E = 3 MPa, nu = 0.5, density 1130 kg/m^3, and a Prony
#: series with the strengths (divided by E) 0.3, 0.6, 1.5 and the times 20 ms, 1 ms, 10 us, also of
#: the half-space.
#: T_ref is 1 s: V of its scene is in radii a second.
#: ``rubber.toml`` of the sample files holds another rubber.
RUBBER_CYLINDER = Cylinder(
    R=0.1,
    m=35.5,
    mu=0.3,
    material=Material(
        3e6, 0.5, Prony([0.3, 0.6, 1.5], [2e-2, 1e-3, 1e-5]), name="rubber", density=1130.0
    ),
)
#: Its dimensionless scene: kappa = 10.62, mu = 0.3, gamma = 98.1, j = 0.5.
RUBBER_ROLLER = RUBBER_CYLINDER.scene()
#: Scenes by the names of the command line.
PRESETS = {
    "paper-section-5": PAPER_SECTION_5,
    "paper-section-5-rounded": PAPER_SECTION_5_ROUNDED,
    "paper-figures-2-3": PAPER_FIGURES_2_3,
    "rubber-roller": RUBBER_ROLLER,
}
#: Initial conditions (V, omega) of Sect. 5.1.
PAPER_STARTS = {"IC1": (1.5, 0.5), "IC2": (-1.5, 0.5), "IC3": (-1.5, -2.0)}
