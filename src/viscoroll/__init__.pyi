"""The public names, a line each, for type checkers, editors and ``__init__.py``, which loads them on first use."""

from . import presets as presets
from .app import fmu as fmu
from .app.dma import Fit as Fit
from .app.dma import fit_prony as fit_prony
from .app.dma import read_dma as read_dma
from .app.identification import Coastdown as Coastdown
from .app.identification import Resistance as Resistance
from .app.identification import Traction as Traction
from .app.identification import identify as identify
from .contact_law.assumptions import Validity as Validity
from .contact_law.bound import Law as Law
from .contact_law.bound import law as law
from .contact_law.contact import contact as contact
from .contact_law.equilibria.resistance import humps as humps
from .contact_law.equilibria.result import Steady as Steady
from .contact_law.equilibria.rolling import steady as steady
from .contact_law.judged import validity as validity
from .contact_law.stress import stress as stress
from .core.drive import Feedback as Feedback
from .core.drive import Schedule as Schedule
from .core.errors import ConvergenceError as ConvergenceError
from .core.errors import FileError as FileError
from .core.errors import MissingDependencyError as MissingDependencyError
from .core.errors import ModelWarning as ModelWarning
from .core.errors import MotionStatus as MotionStatus
from .core.errors import ParameterError as ParameterError
from .core.errors import ViscorollError as ViscorollError
from .core.results import Values as Values
from .cylinder import Cylinder as Cylinder
from .io import runs as runs
from .io import sampling as sampling
from .io import tables as tables
from .materials.bodies import Bodies as Bodies
from .materials.law_file import load_law as load_law
from .materials.material import Material as Material
from .materials.measured import Measured as Measured
from .materials.prony import Prony as Prony
from .materials.shift import WLF as WLF
from .materials.shift import Arrhenius as Arrhenius
from .motion.batch import ensemble as ensemble
from .motion.many import Ensemble as Ensemble
from .motion.one import Motion as Motion
from .motion.single import roll as roll
from .scene import Scene as Scene

__version__: str
