"""``viscoroll samples``: the sample files of the documentation, in a folder of the user."""

from __future__ import annotations

from argparse import Namespace

import viscoroll as vr

from .arguments import command, option


@command(
    "samples",
    option("folder", metavar="FOLDER", nargs="?", default="samples", help="folder for the files (default: samples)"),
)
def samples(arguments: Namespace) -> None:
    """Copy the sample files of the documentation into a folder, and print their paths.

    arguments: parsed command line with folder, path of the folder, which is made if it does not exist; "samples" if not
        given.
    Returns None; a path is printed on each line, in the order of their names, also of files that were there already.
    Raises FileError for a file there of the same name with other content, before any is written, and where the folder
    cannot be written to.
    """
    for file in vr.datasets.copy_files(arguments.folder):
        print(file)
