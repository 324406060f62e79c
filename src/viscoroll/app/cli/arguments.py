"""What arguments mean: numbers, ranges, the scene, the output file."""

from __future__ import annotations

from argparse import ArgumentParser, ArgumentTypeError
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...core.errors import ParameterError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ...cylinder import Cylinder
    from ...scene import Scene

FORMATS = (".txt", ".csv", ".nc")
NUMBERS = "a number, LOW:HIGH:COUNT, LOW:HIGH:COUNT:log, or several of these with commas between"


def number(text: str) -> float:
    """One number; NaN and infinity pass, for the library to refuse by name."""
    try:
        return float(text)
    except ValueError:
        raise ArgumentTypeError(f"{text!r} must be a number") from None


def numbers(text: str) -> float | NDArray[np.float64]:
    """:data:`NUMBERS`; a single number stays a scalar."""
    import numpy as np

    parts = [_part(part) for part in text.split(",")]
    return float(parts[0]) if len(parts) == 1 and np.ndim(parts[0]) == 0 else np.hstack(parts)


def _part(text: str) -> float | NDArray[np.float64]:
    from ...io.tables import spread

    low, *rest = text.split(":")
    try:
        if not rest:
            return float(low)
        high, count, *spacing = rest
        return spread(float(low), float(high), int(count), *spacing)  # type: ignore[arg-type]
    except ParameterError as error:
        raise ArgumentTypeError(f"{text!r}: {error}") from None
    except (ValueError, TypeError):
        raise ArgumentTypeError(f"{text!r} must be {NUMBERS}") from None


def whole(text: str) -> int:
    """A whole number."""
    try:
        return int(text)
    except ValueError:
        raise ArgumentTypeError(f"{text!r} must be a whole number") from None


def count(text: str) -> int:
    """A whole number in [1, 10^12]: more, numpy cannot even be asked for."""
    value = whole(text)
    if not 1 <= value <= 10**12:
        raise ArgumentTypeError(f"{text!r} must be a whole number in [1, 1000000000000]")
    return value


def add_scene(parser: ArgumentParser) -> None:
    """What rolls."""
    parser.add_argument("scene", metavar="SCENE", help="FILE.toml with [scene], [cylinder] (SI) or preset; or a preset")


def body_of(text: str) -> Scene | Cylinder:
    """The scene or the cylinder of a file, or the preset of that name.

    Raises
    ------
    ParameterError
        An unknown preset.
    FileError
        A file that cannot be read.
    """
    from ...io.config import preset, read_body

    return read_body(text) if text.endswith(".toml") else preset(text)


def add_creep(parser: ArgumentParser, value: Callable[[str], Any]) -> None:
    """--V and one of --delta, --omega."""
    parser.add_argument("--V", type=value, required=True, help="velocity of the axis, any sign")
    creep = parser.add_mutually_exclusive_group(required=True)
    creep.add_argument("--delta", type=value, help="creep ratio (omega R - V)/V")
    creep.add_argument("--omega", type=value, help="angular velocity")


def output_path(*suffixes: str) -> Callable[[str], Path | None]:
    """A file with one of ``suffixes``, or None for -; what cannot be written is refused before any work."""

    def path(text: str) -> Path | None:
        if text == "-":
            return None
        if Path(text).suffix.lower() not in suffixes:
            raise ArgumentTypeError(f"{text!r} must end in {' or '.join(suffixes)}")
        try:
            has_folder, is_folder = Path(text).parent.is_dir(), Path(text).is_dir()
        except (OSError, ValueError) as error:  # too long for the file system, a null byte
            raise ArgumentTypeError(f"{text!r:.60}: cannot be a file ({getattr(error, 'strerror', error)})") from None
        if not has_folder:
            raise ArgumentTypeError(f"{text!r} cannot be written: its folder does not exist")
        if is_folder and Path(text).suffix != ".zarr":
            raise ArgumentTypeError(f"{text!r} cannot be written: it is a directory")
        return Path(text)

    return path


def add_output_option(parser: ArgumentParser, *suffixes: str, required: bool = False) -> None:
    """-o FILE with one of ``suffixes``; where text may be one, --format too."""
    where = "" if required else "; without it, or -: standard output"
    parser.add_argument(
        "-o", dest="output", metavar="FILE", type=output_path(*suffixes), required=required,
        help=f"{' or '.join(suffixes)}{where}",
    )  # fmt: skip
    if not required:
        parser.add_argument(
            "--format", choices=("text", "csv", "json"), default="text", help="of standard output (default: text)"
        )
