#!/usr/bin/env python3
# plugin_calls -- what the headers for plugins declare, a plugin can call: it stands in the table of calls.h.
import re
import sys
from pathlib import Path

headers, calls = Path(sys.argv[1]), Path(sys.argv[2])
# Of hosts and of the loader, not of what a pass or a method does; tyn_job_warn is made by TYN_PLUGIN, for its arguments vary.
others = {"tyn_method_register", "tyn_picture_hook_register", "tyn_pass_register", "tyn_num_passes", "tyn_pass_at", "tyn_job_warn"}

in_table = set(re.findall(r"^    (?:X\([^,]+, |V\()(tyn_\w+)", calls.read_text(), re.M))
missing = []
for header in [headers / "pass.h", *sorted((headers / "extend").glob("*.h"))]:
    for name in re.findall(r"^TYN_API [^;(]*?(tyn_\w+)\(", header.read_text(), re.M):
        if name not in in_table and name not in others:
            missing.append(f"{header.name}: {name} is declared for plugins and is not in TYN_CALLS (calls.h)")
if len(in_table) < 60:
    missing.append(f"calls.h: {len(in_table)} functions found, of more than 60")
print("\n".join(missing) or f"{len(in_table)} functions")
sys.exit(bool(missing))
