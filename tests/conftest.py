"""The suite has an environment of its own: what its user chose for other work does not reach it."""

import os

os.environ.pop("VISCOROLL_THREADS", None)
