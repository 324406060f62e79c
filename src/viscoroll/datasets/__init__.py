"""Sample files that are installed with the package, for the examples of the documentation."""

from __future__ import annotations

from pathlib import Path

from ..core.errors import ParameterError

__all__ = ["path"]

_FOLDER = Path(__file__).parent


def path(name: str) -> Path:
    """Return the path of a sample file that is installed with the package, for examples and trials.

    Parameters
    ----------
    name : name of the file, one of these three.
        ``"dma.csv"``: storage and loss modulus of a rubber over frequency, 0.01 to 100 Hz, with 0.5 % noise.
        ``"dma_export.csv"``: storage modulus and tan delta as an instrument writes them, with semicolons and decimal
        commas, 0.1 to 100 Hz.
        ``"run.toml"``: a run file of 16 motions with uncertain speed and friction.

    Returns
    -------
    pathlib.Path
        The file, in the folder of the installed package.

    Raises
    ------
    ParameterError
        An unknown name; the message lists the names.

    Examples
    --------
    >>> vr.datasets.path("dma.csv").name
    'dma.csv'
    """
    names = sorted(file.name for file in _FOLDER.iterdir() if file.suffix in (".csv", ".toml"))
    if name not in names:
        raise ParameterError("name", repr(name), f"one of {', '.join(names)}")
    return _FOLDER / name
