"""What options mean: numbers, ranges, distributions, the scene, the output file."""

from __future__ import annotations

import math
from argparse import ArgumentParser, ArgumentTypeError, Namespace
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import ParameterError
from ..symbols import SYMBOLS

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ..scene import Scene

FORMATS = (".txt", ".csv", ".nc")
PARAMETERS = ("alpha", "kappa", "mu", "gamma", "j")
NUMBERS = "a number, LOW:HIGH:COUNT, LOW:HIGH:COUNT:log, or several of these with commas between"
DISTRIBUTIONS = "a number, uniform:LOW:HIGH or normal:MEAN:SD"


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
    from ..tables import spread

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


def angles(text: str) -> Any:
    """Numbers in rad, or in degrees with ``deg`` behind them: 3deg, 0deg:6deg:61."""
    if "deg" not in text:
        return numbers(text)
    low, *rest = text.split(":")
    ends = [low, *rest[:1]]
    if any(not end.endswith("deg") for end in ends):
        raise ArgumentTypeError(f"{text!r} must be degrees throughout, as in 0deg:6deg:61")
    return numbers(":".join([end.removesuffix("deg") for end in ends] + rest[1:])) * (math.pi / 180.0)


def angle(text: str) -> float:
    """One angle in rad, or in degrees with ``deg`` behind it."""
    return number(text.removesuffix("deg")) * (math.pi / 180.0 if text.endswith("deg") else 1.0)


def times(text: str) -> list[float]:
    """:data:`NUMBERS`, as a list even of one."""
    import numpy as np

    return np.atleast_1d(numbers(text)).tolist()


def distribution(text: str) -> Any:
    """:data:`DISTRIBUTIONS`, as a float or a frozen scipy.stats distribution."""
    name, *rest = text.split(":")
    if not rest and name not in ("uniform", "normal"):
        return number(text)
    try:
        first, second = map(float, rest)
    except ValueError:
        raise ArgumentTypeError(f"{text!r} must be {DISTRIBUTIONS}") from None
    allowed = {"uniform": second > first, "normal": second > 0.0}
    if not allowed.get(name, False) or not abs(first) + abs(second) < float("inf"):
        raise ArgumentTypeError(f"{text!r} must be {DISTRIBUTIONS}, finite, HIGH > LOW, SD > 0")
    from scipy import stats

    return stats.uniform(first, second - first) if name == "uniform" else stats.norm(first, second)


def whole(text: str) -> int:
    """A whole number."""
    try:
        return int(text)
    except ValueError:
        with suppress(ValueError):
            if float(text).is_integer():  # 1e6
                return int(float(text))
        raise ArgumentTypeError(f"{text!r} must be a whole number") from None


def count(text: str) -> int:
    """A whole number in [1, 10^12]: more, numpy cannot even be asked for."""
    value = whole(text)
    if not 1 <= value <= 10**12:
        raise ArgumentTypeError(f"{text!r} must be a whole number in [1, 1000000000000]")
    return value


def add_scene_options(parser: ArgumentParser, value: Callable[[str], Any] = number) -> None:
    """Options that name a scene; each parameter is parsed by ``value``."""
    group = parser.add_argument_group(
        "scene",
        "a preset or a file, changed by any of the parameters; or --alpha, --kappa and --mu alone.\n"
        "If the file has a [cylinder] section, all inputs and outputs are in SI units: m/s, rad/s, s, N/m, N m/m",
    )
    base = group.add_mutually_exclusive_group()
    base.add_argument(
        "--preset", metavar="NAME", help="paper-section-5, paper-section-5-rounded, paper-figures-2-3, rubber-roller"
    )
    base.add_argument("--scene", metavar="FILE.toml", help="a file with [scene], [cylinder] (SI) or preset")
    for name in PARAMETERS:
        default = {"gamma": " (required for roll and ensemble)", "j": " (default 0.5, a solid cylinder)"}.get(name, "")
        symbol = SYMBOLS[name]
        group.add_argument(f"--{name}", type=value, help=f"{symbol.long_name}, {symbol.range}{default}")


def scene_parameters(arguments: Namespace) -> dict[str, Any]:
    """The five parameters, or those given of them, and a series for alpha: file or preset first, options over it.

    Raises
    ------
    ParameterError
        An unknown preset, or too little given.
    ConfigError
        A scene file that cannot be read.
    """
    from ..config import preset, read_scene

    base: Scene | None = None
    if arguments.preset is not None:
        base = preset(arguments.preset)
    elif arguments.scene is not None:
        base = read_scene(arguments.scene)
    parameters = {} if base is None else base.numbers
    changed = {name: getattr(arguments, name) for name in PARAMETERS if getattr(arguments, name) is not None}
    if base is not None and base.material is not None and "alpha" not in changed:
        parameters |= {"alpha": None, "material": base.material}
    parameters |= changed
    if not {"alpha", "kappa", "mu"} <= parameters.keys():
        given = ", ".join(f"--{name}" for name in parameters) or "nothing"
        raise ParameterError("scene", given, "--preset, --scene, or --alpha, --kappa and --mu")
    return parameters


def add_creep_options(parser: ArgumentParser, value: Callable[[str], Any]) -> None:
    """--V and one of --delta, --omega."""
    parser.add_argument("--V", type=value, required=True, help="velocity of the axis, any sign")
    parser.add_argument("--delta", type=value, help="creep ratio (omega - V)/V; this or --omega")
    parser.add_argument("--omega", type=value, help="angular velocity; this or --delta")


def add_time_options(parser: ArgumentParser, end: str, required: bool = True) -> None:
    """One of --t-end and --times, and the controls of a motion."""
    group = parser.add_mutually_exclusive_group(required=required)
    group.add_argument("--t-end", type=number, dest="t", metavar="T", help=f"end time; {end}")
    group.add_argument("--times", type=times, dest="t", metavar="TIMES", help=f"output times: {NUMBERS}")
    parser.add_argument("--rtol", type=number, default=1e-8, help="relative tolerance in [1e-12, 1e-2] (default 1e-8)")
    parser.add_argument("--rest", type=number, help="end a motion where max(|V|, |omega|) falls below this")


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
