"""Which pictures an example shows: every figure that it gave a name, in that order."""

from __future__ import annotations

from typing import Any

from matplotlib.figure import Figure
from sphinx_gallery.scrapers import figure_rst

_SHOWN: set[int] = set()
_KEPT: list[Figure] = []  # so that no identity is given twice


def shown(block: Any, block_vars: dict[str, Any], gallery_conf: dict[str, Any]) -> str:
    """Save the figures that are new since the last block, as sphinx-gallery wants it.

    A block draws all panels of the figures that it names: a later block is too late, so that an
    empty panel raises RuntimeError, which ends the build.
    """
    new = [
        v
        for v in block_vars["example_globals"].values()
        if isinstance(v, Figure) and id(v) not in _SHOWN
    ]
    paths = []
    for figure, path in zip(new, block_vars["image_path_iterator"], strict=False):
        if not all(axes.has_data() for axes in figure.axes):
            raise RuntimeError(
                f"{path}: a panel is empty when its block ends: draw all of a figure in one block"
            )
        figure.savefig(path, dpi=200)
        _SHOWN.add(id(figure))
        _KEPT.append(figure)
        paths.append(path)
    return figure_rst(paths, gallery_conf["src_dir"])
