"""The site as a reader meets it: built without a warning, and open in a real browser, which reaches
nothing else.
"""

import functools
import html
import importlib.util
import os
import re
import shutil
import subprocess
import sys
import threading
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from types import ModuleType
from urllib.parse import urlsplit

import pytest
from filelock import FileLock
from places import ROOT

import viscoroll as vr

SITE = ROOT / "docs/_build/html"
NEEDED = (
    "fmpy",
    "myst_parser",
    "numpydoc",
    "pydata_sphinx_theme",
    "sphinx",
    "sphinx_copybutton",
    "sphinx_design",
    "sphinx_gallery",
)
BUILD = "-W --keep-going -n -E -q -b html docs docs/_build/html"
BROWSERS = ("chromium", "chromium-browser", "google-chrome")
FEWEST_GALLERY_PAGES = 12
#: pages that a browser holds open at once
AT_ONCE = 12
#: what the theme says of itself
REMARKS = ("[PST]", "Got invalid theme mode")


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The site as `make docs` builds it: any warning is an error.  Of several workers one builds,
    the others wait.
    """
    missing = [name for name in NEEDED if importlib.util.find_spec(name) is None]
    if missing:
        pytest.skip(f"not installed (make docs): {', '.join(missing)}")
    folder = tmp_path_factory.getbasetemp()
    folder = folder.parent if "PYTEST_XDIST_WORKER" in os.environ else folder
    with FileLock(folder / "site.lock"):
        if not (folder / "site.built").exists():
            for made in (
                "_build",
                "api",
                "gallery",
                "tutorial",
            ):  # of examples and names that may be gone
                shutil.rmtree(ROOT / "docs" / made, ignore_errors=True)
            command = [sys.executable, "-m", "sphinx", *BUILD.split()]
            built = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
            assert built.returncode == 0, built.stderr
            (folder / "site.built").touch()
    return SITE


def test_every_public_name_has_its_entry(site):
    from sphinx.util.inventory import InventoryFile

    held = InventoryFile.loads((site / "objects.inv").read_bytes(), uri="").data
    names = {name for kind, entries in held.items() if kind.startswith("py:") for name in entries}
    for name in set(vr.__all__) - {"__version__"}:
        value = getattr(vr, name)
        if isinstance(value, ModuleType):  # what it offers has
            assert {f"{value.__name__}.{own}" for own in value.__all__} - names == set()
        else:
            assert {f"viscoroll.{name}", f"{value.__module__}.{name}"} & names, name


def test_every_gallery_page_shows_a_picture(site):
    written = sorted((ROOT / "docs/examples/gallery").rglob("*.py"))
    assert len(written) >= FEWEST_GALLERY_PAGES
    for path in written:
        name = path.relative_to(ROOT / "docs/examples").with_suffix(".html")
        text = (site / name).read_text()
        assert "_images/sphx_glr_" in text, name
        assert "Traceback" not in text, name


@pytest.fixture(scope="module")
def browse(site, tmp_path_factory):
    """A browser on a server of the site: a function from a path to the page as it stands, and what
    went wrong.

    ``probe.html`` may be written into the folder that it gives; all names but the server's are
    unknown to the browser.
    """
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser is None:
        pytest.skip(f"not installed (make site-tools): {' or '.join(BROWSERS)}")
    missing = []
    profile = tmp_path_factory.mktemp("browser")
    probe = profile / "probe.html"

    class Handler(SimpleHTTPRequestHandler):
        def translate_path(self, path):
            return (
                str(probe) if urlsplit(path).path == "/probe.html" else super().translate_path(path)
            )

        def end_headers(self):
            # else two probes written within one second are one page to the browser: "not modified
            # since" counts seconds
            self.send_header("Cache-Control", "no-store")
            super().end_headers()

        def log_error(self, format, *args):
            missing.append(f"{self.path}: {format % args}")

        def log_message(self, format, *args):
            pass

    def open_page(path, milliseconds=10_000):
        missing.clear()
        done = subprocess.run(
            [
                browser,
                "--headless",
                "--no-sandbox",
                "--disable-gpu",
                "--disable-dev-shm-usage",
                "--disable-extensions",
                "--enable-logging=stderr",
                "--v=0",
                f"--user-data-dir={profile / 'profile'}",
                "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
                f"--virtual-time-budget={milliseconds}",
                "--dump-dom",
                f"http://127.0.0.1:{server.server_port}/{path}",
            ],
            capture_output=True,
            text=True,
            check=True,
            env=os.environ | {"HOME": str(profile)},
        )
        said = [
            line
            for line in done.stderr.splitlines()
            if "CONSOLE" in line and not any(r in line for r in REMARKS)
        ]
        return done.stdout, missing + said

    with ThreadingHTTPServer(
        ("127.0.0.1", 0), functools.partial(Handler, directory=str(site))
    ) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        open_page.probe = probe
        yield open_page
        server.shutdown()


#: frames of pages, and in the end, for each, its title and first heading as text
FRAMES = """<!DOCTYPE html><link rel="icon" href="/_static/mark.svg"><title>probe</title><pre id="found"></pre>
{frames}
<script>
addEventListener("load", () => {{
  document.getElementById("found").textContent = [...document.querySelectorAll("iframe")].map((frame) => {{
    const page = frame.contentDocument, heading = page.querySelector("h1");
    return [frame.getAttribute("src"), page.title, heading ? heading.textContent : ""].join("\\t");
  }}).join("\\n");
}});
</script>
"""  # noqa: E501


def test_the_browser_tells_what_is_wrong(browse):
    browse.probe.write_text('<img src="no.png"><script>throw new Error("planted")</script>')
    said = "\n".join(browse("probe.html")[1])
    assert "/no.png: code 404" in said
    assert "planted" in said


def test_pages_load_in_a_browser(browse):
    """With all that they load; links are Sphinx's and ``docs/test_readme.py``'s to hold."""
    paths = [
        path.relative_to(SITE).as_posix()
        for path in SITE.rglob("*.html")
        if "_static" not in path.parts
    ]
    found = {}
    for first in range(0, len(paths), AT_ONCE):
        frames = "\n".join(
            f'<iframe src="/{html.escape(path)}"></iframe>'
            for path in paths[first : first + AT_ONCE]
        )
        browse.probe.write_text(FRAMES.format(frames=frames))
        page, wrong = browse("probe.html")
        assert not wrong, "\n".join(wrong)
        report = html.unescape(re.search(r'<pre id="found">(.*?)</pre>', page, re.S)[1])
        found |= {
            line.split("\t")[0][1:]: tuple(line.split("\t")[1:]) for line in report.splitlines()
        }
    assert found.keys() == set(paths)
    for path, (title, heading) in found.items():
        assert "viscoroll" in title, path
        assert heading, path


def test_search_finds_roll(browse):
    page, wrong = browse("search.html?q=roll")
    assert not wrong, "\n".join(wrong)
    results = re.search(r'id="search-results">.*', page, re.S)[0]
    assert re.search(r'href="api/viscoroll\.roll\.html', results)
