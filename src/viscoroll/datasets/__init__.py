"""Sample files that are installed with the package, for the examples of the documentation."""

from pathlib import Path

from ..core import FileError, FilePath, as_file_error, as_path, check_choice, write_bytes

__all__ = ["copy_files", "path"]

_FOLDER = Path(__file__).parent


def path(name: str) -> Path:
    """Return the path of a sample file that is installed with the package, for examples and trials.

    Parameters
    ----------
    name : name of the file, one of these.
        ``"dma.csv"``: storage and loss modulus of a rubber over frequency, 0.01 to 100 Hz, with 0.5
        % noise.
        ``"dma_export.csv"``: storage modulus and tan delta as an instrument writes them, with
        semicolons and decimal commas, 0.1 to 100 Hz.
        ``"run.toml"``: a run file of 16 motions with uncertain speed and friction.
        ``"rubber.toml"``: a rubber roller on steel, with both materials.
        ``"ensemble.toml"``, ``"sensitivity.toml"``, ``"rubber-sensitivity.toml"``: run files of 20
        000 motions.  ``"measured.toml"``, with ``"drum.csv"`` and ``"launch.csv"``: rolling
        resistance and a motion of a rubber roller, made with noise from known parameters, to
        identify these.

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
    check_choice("name", name, *_names())
    return _FOLDER / name


def copy_files(folder: FilePath) -> list[Path]:
    """Copy all sample files into a folder, which is made if it does not exist.

    Parameters
    ----------
    folder : path of the folder.  A file of the same name and content stays as it is.

    Returns
    -------
    list of pathlib.Path
        The copies, in the order of their names.

    Raises
    ------
    FileError
        A file of the same name with other content, which then stays, as no file is written; a
        folder that cannot be made or written to.  Where a write fails, the copies before it stay.

    Examples
    --------
    >>> vr.datasets.copy_files("samples")[0].name
    'dma.csv'
    """
    contents = {as_path(folder) / name: (_FOLDER / name).read_bytes() for name in _names()}
    with as_file_error(folder, "cannot be written"):
        Path(folder).mkdir(parents=True, exist_ok=True)
        for copy, content in contents.items():
            if copy.exists() and copy.read_bytes() != content:
                raise FileError(copy, "exists already, with other content: name another folder")
    for copy, content in contents.items():
        if not copy.exists():
            write_bytes(copy, content)
    return [*contents]


def _names() -> list[str]:
    """Return the names of all sample files, in alphabetical order."""
    return sorted(file.name for file in _FOLDER.iterdir() if file.suffix in (".csv", ".toml"))
