"""The public names, for type checkers and editors; ``__init__.py`` loads them on first use."""

from . import presets as presets
from . import sampling as sampling
from . import tables as tables
from .assumptions import Validity as Validity
from .bound_law import Law as Law
from .bound_law import law as law
from .contact_stress import stress as stress
from .cylinder import Cylinder as Cylinder
from .dma import Fit as Fit
from .dma import fit_prony as fit_prony
from .dma import read_dma as read_dma
from .drive import Feedback as Feedback
from .drive import Schedule as Schedule
from .equilibria import Steady as Steady
from .equilibria import humps as humps
from .equilibria import steady as steady
from .errors import ConvergenceError as ConvergenceError
from .errors import FileError as FileError
from .errors import MissingDependencyError as MissingDependencyError
from .errors import ModelWarning as ModelWarning
from .errors import MotionStatus as MotionStatus
from .errors import ParameterError as ParameterError
from .errors import ViscorollError as ViscorollError
from .identification import Coastdown as Coastdown
from .identification import Resistance as Resistance
from .identification import Traction as Traction
from .identification import identify as identify
from .judged import validity as validity
from .materials.bodies import Bodies as Bodies
from .materials.law_file import load_law as load_law
from .materials.material import Material as Material
from .materials.measured import Measured as Measured
from .materials.prony import Prony as Prony
from .materials.shift import WLF as WLF
from .materials.shift import Arrhenius as Arrhenius
from .motion import ensemble as ensemble
from .motion import roll as roll
from .motion.many import Ensemble as Ensemble
from .motion.one import Motion as Motion
from .results import Values as Values
from .rolling_contact import contact as contact
from .scene import Scene as Scene

__version__: str
