"""What other rooms take from this one, a line each, for type checkers, and for ``__init__.py``."""

from .ensembles import FIELDS as FIELDS
from .ensembles import Ensemble as Ensemble
from .ensembles import ensemble as ensemble
from .many_motions import FLOW_PAYS as FLOW_PAYS
from .motion_arguments import Drive as Drive
from .motion_arguments import output_times as output_times
from .motion_datasets import column_attributes as column_attributes
from .motion_datasets import provenance as provenance
from .motion_problem import SolverOptions as SolverOptions
from .motion_problem import make_problem as make_problem
from .summaries import LEVELS as LEVELS
from .summaries import QUANTITIES as QUANTITIES
from .summaries import Summary as Summary
from .summaries import drawn_summary as drawn_summary
from .summaries import merge_summaries as merge_summaries
from .summaries import summarise as summarise
from .summaries import summary_dataset as summary_dataset
