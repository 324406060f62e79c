"""The command line as ``python -m viscoroll``."""

from .app.cli import main

if __name__ == "__main__":
    raise SystemExit(main())
