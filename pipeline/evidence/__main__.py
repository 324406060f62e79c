"""Every stage of the evidence by its name: `python -m pipeline.evidence` lists them,
`... NAME OPTIONS` runs one.
"""

import runpy
import sys
from pathlib import Path

HERE = Path(__file__).parent
#: Name -> what its module says.
STAGES = {
    ".".join(path.relative_to(HERE).with_suffix("").parts).removesuffix(".__main__"): text
    for path in sorted(HERE.rglob("*.py"))
    if "\nif __name__ ==" in (text := path.read_text(encoding="utf-8"))
}
del STAGES["__main__"]

if __name__ == "__main__":
    name, *sys.argv[1:] = sys.argv[1:] or [""]
    if name not in STAGES:
        for each, text in STAGES.items():
            print(f"{each:<24}", text.partition("\n")[0].strip('"'))
        sys.exit(2 if name else 0)
    runpy.run_module(f"pipeline.evidence.{name}", run_name="__main__", alter_sys=True)
