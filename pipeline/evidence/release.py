"""What a release needs, checked: sdist and wheel, metadata, the README as a package page, licences,
measured numbers.

python -m pipeline.evidence.release

Builds both packages, without a network, and prints each check that fails, with the reason, and each
entry of OWNER.toml that is open: the entries that only the owner of the project can fill in.  Exit
code 1 if a check fails.
"""

import datetime
import re
import sys
import tarfile
import tempfile
import tomllib
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from packaging.metadata import Metadata
from readme_renderer import markdown

import viscoroll as vr

from ..stage import ROOT, said
from .citation import made
from .matrix import packed
from .results import RESULTS, SHORT, kernels_digest, outdated

#: data that others made: their files need a licence beside them in the sdist
MATERIALS = "data/materials/"
#: of the wheel, and of the sdist beside those
SHIPPED = (".py", ".pyi", ".npy", ".h", ".c", ".csv", ".toml", "py.typed")
LARGEST = 4_000_000
#: marks of the machine that built, and what never ships
FOREIGN = re.compile(r"(^|/)(__pycache__|_build|\.venv|\.git|out|data/tables)(/|$)|\.pyc$")
_DATE = re.compile(r'^date-released: "(\d{4}-\d\d-\d\d)"$', re.MULTILINE)


class Packages(NamedTuple):
    """Names in either package, the metadata of the wheel, and the sizes of the sdist's files."""

    wheel: list[str]
    sdist: dict[str, int]
    metadata: Metadata
    texts: dict[str, str]


def built(folder: Path) -> Packages:
    """Both packages of this tree."""
    wheel, sdist, found = packed(folder, "--no-isolation")
    texts = {}
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
    with tarfile.open(sdist) as archive:
        members = {
            each.name.partition("/")[2]: each for each in archive.getmembers() if each.isfile()
        }
        for name in ("LICENSE", "CITATION.cff", "CHANGELOG.md", f"{MATERIALS}README.md"):
            if name in members and (file := archive.extractfile(members[name])) is not None:
                texts[name] = file.read().decode()
    # raises where a field is not valid
    return Packages(
        names,
        {name: each.size for name, each in members.items()},
        Metadata.from_email(found, validate=True),
        texts,
    )


def metadata(packages):
    """Name, version, licence and classifiers say the same everywhere."""
    found = packages.metadata
    if str(found.version) != vr.__version__:
        yield f"the metadata say version {found.version}, the package {vr.__version__}"
    citation = packages.texts.get("CITATION.cff", "")
    if f"version: {vr.__version__}\n" not in citation:
        yield f"CITATION.cff does not name version {vr.__version__}"
    if (date := _DATE.search(citation)) is None or datetime.date.fromisoformat(
        date[1]
    ) > datetime.date.today():
        yield "CITATION.cff has no date-released, or one to come"
    for name, text in made().items():
        if (ROOT / name).read_text(encoding="utf-8") != text:
            yield f"{name} is not that of pyproject.toml: run pipeline.evidence.citation"
    if f"\n## {vr.__version__}\n" not in packages.texts.get("CHANGELOG.md", ""):
        yield f"the CHANGELOG has no section {vr.__version__}, or not as released"
    if found.license_expression != "BSD-3-Clause" or not found.summary or not found.description:
        yield "licence expression, summary or description is missing"


def contents(packages):
    """Every module of the tree is in the wheel, nothing else is; the sdist holds its own tests."""
    modules = {
        path.relative_to(ROOT / "src").as_posix() for path in (ROOT / "src/viscoroll").rglob("*.py")
    }
    own = {name for name in packages.wheel if ".dist-info/" not in name}
    yield from (f"the wheel lacks {name}" for name in sorted(modules - own))
    yield from (f"the wheel ships {name}" for name in sorted(own) if not name.endswith(SHIPPED))
    for name in (
        "Makefile",
        "constraints.txt",
        "tests/conftest.py",
        "docs/conf.py",
        "pipeline/stage.py",
    ):
        if name not in packages.sdist:
            yield f"the sdist lacks {name}"
    yield from (
        f"the sdist ships {name}" for name in sorted(packages.sdist) if FOREIGN.search(name)
    )
    yield from (
        f"{name} has {size / 1e6:.1f} MB" for name, size in packages.sdist.items() if size > LARGEST
    )


def licences(packages):
    """Our licence is in both packages; what others made has its own beside it, and a row that names
    it.
    """
    if (
        not any(name.endswith("licenses/LICENSE") for name in packages.wheel)
        or "LICENSE" not in packages.sdist
    ):
        yield "LICENSE is not in both packages"
    theirs = [
        name for name in packages.sdist if name.startswith(MATERIALS) and name.endswith(".csv")
    ]
    beside = [name for name in packages.sdist if name.startswith(f"{MATERIALS}LICENSE.")]
    rows = packages.texts.get(f"{MATERIALS}README.md", "").splitlines()
    for name in theirs:
        row = next((line for line in rows if Path(name).name in line), "")
        if not any(Path(licence).name in row for licence in beside):
            yield f"{name} has no licence"


def page(packages):
    """The README renders as a package page."""
    if markdown.render(packages.metadata.description or "") is None:
        yield "the README does not render"


def numbers(packages):
    """What README and docs state was measured at the kernels that are shipped."""
    others = outdated(RESULTS)
    if others:
        files = ", ".join(
            f"{name} ({', '.join(one[:SHORT] for one in digests)})"
            for name, digests in others.items()
        )
        yield f"of other kernels than these, {kernels_digest()[:SHORT]}, in data/results: {files}"


def left_to_the_owner() -> Iterator[str]:
    """Entries of OWNER.toml that are open: their file lacks the text, or they are no text of a
    file.
    """
    for entry in tomllib.loads((ROOT / "OWNER.toml").read_text(encoding="utf-8"))["open"]:
        pattern = entry.get("has")
        if pattern is None or not re.search(
            pattern, (ROOT / entry["file"]).read_text(encoding="utf-8"), re.MULTILINE
        ):
            yield f"{entry['what']} ({entry['file']})"


CHECKS = {
    "metadata": metadata,
    "contents": contents,
    "licences": licences,
    "package page": page,
    "measured numbers": numbers,
}


def main():
    said(__doc__).parse_args()
    with tempfile.TemporaryDirectory(prefix="viscoroll-release-") as folder:
        packages = built(Path(folder))
    problems = [
        f"{name}: {problem}" for name, check in CHECKS.items() for problem in check(packages)
    ]
    print("\n".join([*problems, *(f"owner: {entry}" for entry in left_to_the_owner())]))
    return int(bool(problems))


if __name__ == "__main__":
    sys.exit(main())
