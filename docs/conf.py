"""The site: `make docs`.  Pages are Markdown (MyST), examples are run by sphinx-gallery; nothing is
fetched.
"""

from __future__ import annotations

import os
import re
import sys
import tomllib
import warnings
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
sys.path.insert(
    0, str(HERE)
)  # gallery_images below, imported by name so that Sphinx can keep its environment

import matplotlib.pyplot as plt  # noqa: E402
from sphinx_gallery.sorting import ExplicitOrder  # noqa: E402

import viscoroll  # noqa: E402
from viscoroll.presets import read_law_source  # noqa: E402

warnings.simplefilter(
    "ignore", viscoroll.ModelWarning
)  # pages on the paper's example say it in words
plt.style.use(HERE / "viscoroll.mplstyle")
os.environ["VISCOROLL_QUIET"] = "1"  # no word about compiling in the output of an example

#: Pages that are kept elsewhere in the tree: page -> file.  What stands in docs/ of them is a
#: pointer.
ELSEWHERE = {
    "changes": "CHANGELOG.md",
    "contributing": "CONTRIBUTING.md",
    "data": "data/README.md",
    "materials": "data/materials/README.md",
    "peers": "pipeline/evidence/bench/README.md",
    "pipeline": "pipeline/README.md",
}
#: The address of the repository stands in [project.urls] of pyproject.toml, once there is one, and
#: nowhere else.
ADDRESS = (
    tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    .get("urls", {})
    .get("Repository")
)

project = "viscoroll"
author = "The viscoroll developers"
copyright = author
version = release = viscoroll.__version__

extensions = [
    "myst_parser",
    "numpydoc",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx_copybutton",
    "sphinx_design",
    "sphinx_gallery.gen_gallery",
]
exclude_patterns = ["_build", "_templates", "examples", "**/*.ipynb", "**/*.py"]
templates_path = ["_templates"]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
suppress_warnings = ["config.cache"]

myst_enable_extensions = ["colon_fence"]
myst_heading_anchors = 4

autosummary_generate = True
autodoc_typehints = "none"  # numpydoc sections give shapes and units, which types do not
autodoc_member_order = "bysource"
numpydoc_show_class_members = False
nitpicky = True
nitpick_ignore_regex = [
    (r"py:.*", r"(?!viscoroll).*"),
]

sphinx_gallery_conf = {
    "examples_dirs": ["examples/tutorial", "examples/gallery"],
    "gallery_dirs": ["tutorial", "gallery"],
    "filename_pattern": r"\.py$",
    "ignore_pattern": r"__init__\.py",
    "subsection_order": ExplicitOrder(
        [
            f"examples/gallery/{name}"
            for name in ("contact", "materials", "motion", "drive", "heat", "uncertain")
        ]
    ),
    "within_subsection_order": "FileNameSortKey",
    "image_scrapers": "gallery_images.shown",
    "reset_modules": (),
    "abort_on_example_error": True,
    "only_warn_on_example_error": False,
    "download_all_examples": False,
    "capture_repr": (),
    "show_signature": False,
    "write_computation_times": False,
    "min_reported_time": 1e9,
    "remove_config_comments": True,
}

html_theme = "pydata_sphinx_theme"
html_title = "viscoroll"
html_logo = html_favicon = "_static/mark.svg"
html_static_path = ["_static", "loading/read_law.js"]
html_css_files = ["viscoroll.css"]
html_show_sourcelink = False
html_copy_source = False
html_theme_options = {
    "logo": {"text": "viscoroll"},
    "navbar_end": ["theme-switcher", *(["navbar-icon-links"] if ADDRESS else [])],
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": [],
    "show_prev_next": True,
    "navigation_with_keys": False,
    "pygments_light_style": "a11y-high-contrast-light",
    **({"github_url": ADDRESS} if ADDRESS else {}),
}
smartquotes = False  # V' is a derivative
copybutton_exclude = ".linenos, .gp, .go"

_LINK = re.compile(r"(?<!!)\[([^\]\[]*(?:\[[^\]]*\])?[^\]\[]*)\]\(([^)\s]+)\)")


def linked(text: str, folder: Path, page: str) -> str:
    """``text``, written for ``folder`` of the tree, with links as the site's ``page`` needs them.

    A link to a file that the site has no page for becomes one into the repository, or plain words
    while that has no address.
    """
    pages = {(ROOT / file).resolve(): name for name, file in ELSEWHERE.items()}

    def link(match: re.Match[str]) -> str:
        words, target = match.groups()
        name, _, anchor = target.partition("#")
        if not name or re.match(r"[a-z]+:", target):
            return match[0]
        path = (folder / name).resolve()
        if path == ROOT / "README.md":
            path = HERE / "index.md"
        if path in pages:
            path = HERE / f"{pages[path]}.md"
        if path.is_relative_to(HERE):
            here = os.path.relpath(path, (HERE / page).parent)
            return f"[{words}]({here}{'#' + anchor if anchor else ''})"
        where = path.relative_to(ROOT).as_posix()
        return f"[{words}]({ADDRESS}/blob/main/{where})" if ADDRESS else words

    return _LINK.sub(link, text)


def read(app: Any, page: str, source: list[str]) -> None:
    """Fetch a page that is kept elsewhere; turn the links of every Markdown page."""
    file = ROOT / ELSEWHERE[page] if page in ELSEWHERE else HERE / f"{page}.md"
    if file.exists():
        text = file.read_text(encoding="utf-8") if page in ELSEWHERE else source[0]
        source[0] = linked(text, file.parent, page)


_SECTIONS = ("Parameters", "Attributes", "Returns")


def spoken(app: Any, what: str, name: str, thing: Any, options: Any, lines: list[str]) -> None:
    """Docstrings as they are meant, for numpydoc.

    "name : words" gives a name and what it is, where numpydoc would take the words for a type;
    and |V| is an absolute value, not a substitution of reStructuredText.
    """
    section, result = "", []
    for line, following in zip(lines, [*lines[1:], ""], strict=True):
        if following and not following.strip("-"):
            section = line
        entry = re.match(r"(\S[^:`]*?) : (.+)", line) if section in _SECTIONS else None
        result += [entry[1], f"    {entry[2]}"] if entry else [line]
    text = "\n".join(result).split("``")
    text[::2] = [part.replace("|", "\\|") for part in text[::2]]
    lines[:] = "``".join(text).split("\n")


def write_law(app: Any, error: Exception | None) -> None:
    """The law that live.md computes with, as a script, for a page that is opened from a disk may
    not fetch.
    """
    if error is None:
        path = Path(app.outdir) / "_static/rubber.json"
        law = viscoroll.tables.law(read_law_source(viscoroll.datasets.path("rubber.toml")))
        viscoroll.tables.export(law, path)
        path.with_suffix(".js").write_text(
            f"const RUBBER = {path.read_text(encoding='utf-8')};\n", encoding="utf-8"
        )


def setup(app: Any) -> dict[str, bool]:
    app.connect("source-read", read)
    app.connect("build-finished", write_law)
    app.connect("autodoc-process-docstring", spoken, priority=400)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
