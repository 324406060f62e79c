"""The public names, for type checkers and editors; ``__init__.py`` loads them on first use."""

from . import sampling as sampling
from . import tables as tables
from .bound_law import Law as Law
from .bound_law import law as law
from .contact_stress import stress as stress
from .cylinder import Cylinder as Cylinder
from .dma import Fit as Fit
from .dma import fit_prony as fit_prony
from .dma import read_dma as read_dma
from .drive import Feedback as Feedback
from .equilibria import humps as humps
from .equilibria import steady as steady
from .errors import MOTION_STATUS as MOTION_STATUS
from .errors import ConfigError as ConfigError
from .errors import ConvergenceError as ConvergenceError
from .errors import MissingDependencyError as MissingDependencyError
from .errors import ModelWarning as ModelWarning
from .errors import MotionStatus as MotionStatus
from .errors import OutOfTableError as OutOfTableError
from .errors import OutputError as OutputError
from .errors import ParameterError as ParameterError
from .errors import TableError as TableError
from .errors import ViscorollError as ViscorollError
from .materials.bodies import Bodies as Bodies
from .materials.law_file import load_law as load_law
from .materials.material import Material as Material
from .materials.measured import Measured as Measured
from .materials.prony import Prony as Prony
from .materials.shift import WLF as WLF
from .materials.shift import Arrhenius as Arrhenius
from .motion import ensemble as ensemble
from .motion import roll as roll
from .presets import PAPER_CYLINDER as PAPER_CYLINDER
from .presets import PAPER_FIGURES_2_3 as PAPER_FIGURES_2_3
from .presets import PAPER_SECTION_5 as PAPER_SECTION_5
from .presets import PAPER_SECTION_5_ROUNDED as PAPER_SECTION_5_ROUNDED
from .presets import PAPER_STARTS as PAPER_STARTS
from .presets import RUBBER_CYLINDER as RUBBER_CYLINDER
from .presets import RUBBER_ROLLER as RUBBER_ROLLER
from .rolling_contact import contact as contact
from .scene import Scene as Scene

__version__: str
