"""Python in a process of its own."""

import os
import subprocess
import sys

from places import ROOT


def python(*arguments: object, **environment: str) -> subprocess.CompletedProcess[str]:
    """An interpreter with these arguments, in the repository's folder; an environment of its own beside ours."""
    return subprocess.run(
        [sys.executable, *map(str, arguments)], cwd=ROOT, env=os.environ | environment,
        capture_output=True, text=True, timeout=300, check=False,
    )  # fmt: skip


def printed(code: str, *arguments: object, **environment: str) -> str:
    """What a program that must succeed prints."""
    done = python("-c", code, *arguments, **environment)
    assert done.returncode == 0, done.stderr
    return done.stdout


def stage(name: str, *arguments: object) -> subprocess.CompletedProcess[str]:
    """A stage ("evidence.prove", "offline"; "" is all of the demo) that ends of its own accord: 2 where it refuses, 1
    where it fails.
    """
    done = python("-m", f"pipeline.{name}".rstrip("."), *arguments)
    assert "Traceback" not in done.stderr, done.stderr
    return done


def made(name: str, *arguments: object) -> str:
    """What a stage prints that must do its work."""
    done = stage(name, *arguments)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def stage_refused(name: str, *arguments: object) -> str:
    """The one line of a stage that refuses."""
    done = stage(name, *arguments)
    assert (done.returncode, done.stderr.count("\n")) == (2, 1), done.stderr
    return done.stderr
