"""What pipeline/evidence/measure/ensembles.py measured as text, and what follows for a large run."""

from __future__ import annotations

from ..results import Results
from .cells import cell, listed

#: the large run: motions, machines, and motions a block by how they are rolled
MOTIONS, MACHINES = 10**11, 100
BLOCKS_OF = {"one scene, from its flow map": 4_000_000, "seven uncertain inputs, integrated": 1_000_000}
_ABOUT = (
    "\nBlocks of {sizes[block]} motions, a 16th of the run where all inputs are uncertain; one output time, "
    "{threads} threads; {machine[cpu]}, {machine[date]}, by `pipeline/evidence/measure/ensembles.py`.  "
    "Other work on the machine lengthens the seconds, hardly those of the processor.\n"
    "A store is verified at {verify_mb_per_s:.0f} MB/s.\n"
)


def rates(results: Results) -> str:
    """Time, memory and disk of each run, and the bare loop."""
    m = results["ensembles"]
    columns = {
        "run": "{name}", "s": "{seconds:.3g}", "s of processor": "{cpu_s:.3g}", "most memory, MB": "{memory}",
        "disk, MB": "{disk}",
    }  # fmt: skip
    rows = [
        row | {"name": name, "memory": f"{row['peak_mb']:.0f}", "disk": f"{row['stored_mb']:.3g}"}
        for name, row in sorted(m["rows"].items(), key=lambda item: (item[1]["motions"], item[0]))
    ]
    alone = f"{m['loop']['motions']} motions of a scene, `ensemble()` alone"
    return listed(columns, [*rows, m["loop"] | {"name": alone, "memory": "", "disk": ""}]) + cell(_ABOUT, m)


def cluster(results: Results) -> str:
    """What dask costs."""
    m = results["ensembles"]
    found = m["cluster"]
    columns = {
        f"block of {m['sizes']['block']} motions of a scene": "{name}", "threads": "{threads:.3g}",
        "dask, local": "{dask:.3g}", "overhead": "{overhead:+.1%}",
    }  # fmt: skip
    rows = (
        {
            "name": name, "threads": found[f"threads_{clock}_a_block"], "dask": found[f"dask_{clock}_a_block"],
            "overhead": found[f"overhead_{clock}"],
        }
        for name, clock in (("seconds a block", "seconds"), ("of processor", "cpu_s"))
    )  # fmt: skip
    return listed(columns, rows) + cell("\nOnce running; its start takes {dask_start_s:.2g} s.\n", found)


def plan(results: Results) -> str:
    """10^11 motions on 100 machines like the one measured on."""
    m = results["ensembles"]
    sizes, workers = m["sizes"], MACHINES * m["threads"]
    measured = (f"{sizes['fixed'][-1]} motions of a scene", f"{sizes['uncertain']} motions, seven uncertain inputs")
    columns = {
        "motions": "{name}", "blocks": "{blocks} of {block}", "a block takes": "{seconds:.2g} s",
        "tasks a second": "{tasks:.2g}", "all take": "{hours:.2g} h", "records": "{records:.2g} GB",
        "summing up": "{merging:.2g} min",
    }  # fmt: skip
    rows = []
    for (name, block), run in zip(BLOCKS_OF.items(), (m["rows"][key] for key in measured), strict=True):
        blocks, seconds = MOTIONS // block, block * run["cpu_s"] / run["motions"]
        rows.append({
            "name": name, "blocks": blocks, "block": block, "seconds": seconds, "tasks": workers / seconds,
            "hours": blocks * seconds / workers / 3600.0, "records": blocks * m["record_bytes"] / 1e9,
            "merging": blocks * m["merge_s_a_block"] / 60.0,
        })  # fmt: skip
    kept = m["rows"][f"{sizes['designs']} motions of a scene, all kept"]
    whole = MOTIONS * kept["stored_mb"] / kept["motions"] / 1e6
    return listed(columns, rows) + (
        f"\nEvery motion with V, omega, x at one time, its start, onset, rest and status would be {whole:.2g} TB.\n"
    )
