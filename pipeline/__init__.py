"""The stages behind the Makefile; README.md shows which makes what from what."""

import warnings

from viscoroll.core.errors import ModelWarning

# they compute the paper's example, which steady rolling may not drive, and say so where it is shown
warnings.simplefilter("ignore", ModelWarning)
