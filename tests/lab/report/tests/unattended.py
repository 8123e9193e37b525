"""run_all.py on programs that hang and on ones that fail: what is left out, ended or failed is said, each part gets its turn, and the exit
code is 1. The parts themselves are tested by `report_prices`, `report_effects` and others.

usage: unattended.py RUN_ALL"""
import pathlib
import re
import subprocess
import sys
import tempfile
import time

PARTS = ("frontier", "timings", "prices", "effects", "methods")
RECORDER = "#!/bin/sh\ncase \"$*\" in *--list-backends*) echo 'cpu       0  a processor';; *) echo begun; {} ;; esac\n"


def run(does, minutes, *options):
    with tempfile.TemporaryDirectory() as folder:
        recorder = pathlib.Path(folder) / "wadi-recorder"
        recorder.write_text(RECORDER.format(does))
        recorder.chmod(0o755)
        start = time.monotonic()
        done = subprocess.run([sys.executable, sys.argv[1], folder, "--quick", "--minutes", str(minutes), "--out", f"{folder}/out", *options], capture_output=True, text=True, check=False)
        assert done.returncode == 1, done
        return done.stdout, (pathlib.Path(folder) / "out" / "log.txt").read_text(), time.monotonic() - start


said, log, seconds = run("exec sleep 60", 0.1)
assert "SKIPPED cuda" in said and "SKIPPED vulkan" in said and "SKIPPED cpu" not in said, said
assert [f"== {part}: ENDED: out of time" in said for part in PARTS] == [True] * len(PARTS), said
assert 5 < seconds < 40, seconds
said, log, seconds = run("exit 3", 5)
assert [f"== {part}: FAILED: exit code 1" in said for part in PARTS] == [True] * len(PARTS), said
assert "recordings.Failed" in log and "begun" in log and "no run came to an end" in log and seconds < 40, log
said, log, seconds = run("exit 3", 5, "--parts", "prices", "methods")
assert re.findall(r"^== (\w+): FAILED", said, re.M) == ["prices", "methods"], said
print("OK")
