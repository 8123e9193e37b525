#!/usr/bin/env python3
"""Two processes stay in step, the CPU beside itself and beside Vulkan where there is a device; without players they part, and the
step is named. Usage: lockstep.py PROGRAM."""
import re
import subprocess
import sys

NO_DEVICE = 77
first = None
for other in ("cpu", "vulkan"):
    run = subprocess.run([sys.argv[1], "cpu", other], capture_output=True, text=True, timeout=300)
    if other == "vulkan" and run.returncode == NO_DEVICE:
        print("vulkan: no device, left out")
        continue
    found = re.fullmatch(r"in step for 120 steps: hash ([0-9a-f]{16}), ([\d.]+) m3 of sand moved in, ([\d.]+) m3 of water\n", run.stdout)
    if run.returncode != 0 or not found or not (float(found[2]) > 5 and float(found[3]) > 0.5):
        sys.exit(f"cpu beside {other}: exit code {run.returncode}\n{run.stdout}{run.stderr}")
    if first not in (None, found[1]):
        sys.exit(f"cpu beside {other}: hash {found[1]}, cpu beside cpu: {first}")
    first = found[1]
    apart = subprocess.run([sys.argv[1], "cpu", other, "--without-players"], capture_output=True, text=True, timeout=300)
    step = re.match(r"desync at step (\d+): ", apart.stdout)
    if apart.returncode != 3 or not step or int(step[1]) != 11:  # the first step that has edits of both
        sys.exit(f"cpu beside {other} without players: exit code {apart.returncode}\n{apart.stdout}{apart.stderr}")
    print(f"cpu beside {other}: in step; without players they part at step {step[1]}")
