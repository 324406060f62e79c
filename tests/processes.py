"""Python in a process of its own."""

import os
import subprocess
import sys

from places import ROOT


def python(*arguments, cwd=ROOT, **environment):
    """An interpreter with these arguments, in the repository's folder or another; an environment of
    its own beside ours.
    """
    return subprocess.run(
        [sys.executable, *map(str, arguments)],
        cwd=cwd,
        env=os.environ | environment,
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )


def begun(text, folder, *arguments, **options):
    """The program in a process of its own, at work on the run file of this text, and its store."""
    (folder / "run.toml").write_text(text)
    command = "-m viscoroll ensemble run.toml -o store.zarr --threads 2"
    process = subprocess.Popen(
        [sys.executable, *command.split(), *arguments],
        cwd=folder,
        stdout=subprocess.DEVNULL,
        text=True,
        **options,
    )
    return process, folder / "store.zarr"


def printed(code, *arguments, **environment):
    """What a program that must succeed prints."""
    done = python("-c", code, *arguments, **environment)
    assert done.returncode == 0, done.stderr
    return done.stdout


def stage(name, *arguments):
    """A stage ("evidence.prove", "offline"; "" is all of the demo) that ends of its own accord: 2
    where it refuses, 1 where it fails.
    """
    done = python("-m", f"pipeline.{name}".rstrip("."), *arguments)
    assert "Traceback" not in done.stderr, done.stderr
    return done


def made(name, *arguments):
    """What a stage prints that must do its work."""
    done = stage(name, *arguments)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def stage_refused(name, *arguments):
    """The one line of a stage that refuses."""
    done = stage(name, *arguments)
    assert (done.returncode, done.stderr.count("\n")) == (2, 1), done.stderr
    return done.stderr
