"""What pipeline/measure/ensembles.py measured as text, and what follows for a large run."""

from __future__ import annotations

from typing import Any

from ..results import table

#: the large run: motions, machines, and motions a block by how they are rolled
MOTIONS, MACHINES = 10**11, 100
BLOCKS_OF = {"one scene, from its flow map": 4_000_000, "seven uncertain inputs, integrated": 1_000_000}


def rates(m: dict[str, Any]) -> str:
    """Time, memory and disk of each run, and the bare loop."""
    found = m["ensembles"]
    rows = [
        (name, f"{row['seconds']:.3g}", f"{row['cpu_s']:.3g}", f"{row['peak_mb']:.0f}", f"{row['stored_mb']:.3g}")
        for name, row in sorted(found["rows"].items(), key=lambda item: (item[1]["motions"], item[0]))
    ]
    loop = found["loop"]
    rows.append(
        (
            f"{loop['motions']} motions of a scene, `ensemble()` alone",
            f"{loop['seconds']:.3g}",
            f"{loop['cpu_s']:.3g}",
            "",
            "",
        )
    )
    about = found["machine"]
    return table(("run", "s", "s of processor", "most memory, MB", "disk, MB"), rows) + (
        f"\nBlocks of {found['sizes']['block']} motions, a 16th of the run where all inputs are uncertain; "
        f"one output time, {found['threads']} threads; {about['cpu']}, {about['date']}, "
        "by `pipeline/measure/ensembles.py`.  Other work on the machine lengthens the seconds, "
        "hardly those of the processor.\n"
        f"A store is verified at {found['verify_mb_per_s']:.0f} MB/s.\n"
    )


def cluster(m: dict[str, Any]) -> str:
    """What dask costs."""
    found = m["ensembles"]["cluster"]
    rows = [
        (
            name,
            f"{found[f'threads_{key}_a_block']:.3g}",
            f"{found[f'dask_{key}_a_block']:.3g}",
            f"{found[f'overhead_{key}']:+.1%}",
        )
        for name, key in (("seconds a block", "seconds"), ("of processor", "cpu_s"))
    ]
    block = m["ensembles"]["sizes"]["block"]
    return table((f"block of {block} motions of a scene", "threads", "dask, local", "overhead"), rows) + (
        f"\nOnce running; its start takes {found['dask_start_s']:.2g} s.\n"
    )


def plan(m: dict[str, Any]) -> str:
    """10^11 motions on 100 machines like the one measured on."""
    found = m["ensembles"]
    sizes, workers = found["sizes"], MACHINES * found["threads"]
    measured = (f"{sizes['fixed'][-1]} motions of a scene", f"{sizes['uncertain']} motions, seven uncertain inputs")
    kept = found["rows"][f"{sizes['designs']} motions of a scene, all kept"]
    rows = []
    for (name, block), row in zip(BLOCKS_OF.items(), (found["rows"][key] for key in measured), strict=True):
        each = row["cpu_s"] / row["motions"]
        blocks, hours = MOTIONS // block, MOTIONS * each / workers / 3600.0
        rows.append(
            (
                name, f"{blocks} of {block}", f"{block * each:.2g} s", f"{workers / (block * each):.2g}",
                f"{hours:.2g} h",
                f"{blocks * found['record_bytes'] / 1e9:.2g} GB", f"{blocks * found['merge_s_a_block'] / 60.0:.2g} min",
            )
        )  # fmt: skip
    head = ("motions", "blocks", "a block takes", "tasks a second", "all take", "records", "summing up")
    whole = MOTIONS * kept["stored_mb"] / kept["motions"] / 1e6
    return table(head, rows) + (
        f"\nEvery motion with V, omega, x at one time, its start, onset, rest and status would be {whole:.2g} TB.\n"
    )


BLOCKS = {"ensembles": rates, "ensembles_cluster": cluster, "ensembles_plan": plan}
