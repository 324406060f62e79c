"""Every stage of the evidence by its name: `python -m pipeline.evidence` lists them,
`... NAME OPTIONS` runs one.
"""

from __future__ import annotations

import runpy
import sys
from pathlib import Path

STAGES = {
    ".".join(path.relative_to(Path(__file__).parent).with_suffix("").parts).removesuffix(
        ".__main__"
    ): path
    for path in sorted(Path(__file__).parent.rglob("*.py"))
    if path != Path(__file__) and "\nif __name__ ==" in path.read_text(encoding="utf-8")
}

if __name__ == "__main__":
    name, *sys.argv[1:] = sys.argv[1:] or [""]
    if name not in STAGES:
        for each, path in STAGES.items():
            print(f"{each:<24}", path.read_text(encoding="utf-8").partition("\n")[0].strip('"'))
        sys.exit(2 if name else 0)
    runpy.run_module(f"pipeline.evidence.{name}", run_name="__main__", alter_sys=True)
