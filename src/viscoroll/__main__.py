"""The command line as ``python -m viscoroll``."""

from .cli import main

if __name__ == "__main__":
    raise SystemExit(main())
