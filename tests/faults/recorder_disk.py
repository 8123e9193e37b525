#!/usr/bin/env python3
"""A recorder whose disk fills up says so and leaves no part of a file. Usage: recorder_disk.py WADI_RECORDER."""
import os
import resource
import signal
import subprocess
import sys
import tempfile


def record(program, folder, most_bytes):
    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (most_bytes, most_bytes))

    return subprocess.run([program, "dam_break", "--size", "64x64", "--seconds", "1", "--every", "0.5", "--backend", "cpu", "--out", folder],
                          capture_output=True, text=True, preexec_fn=limit)


def main():
    with tempfile.TemporaryDirectory() as folder:
        full = record(sys.argv[1], folder, 1000)
        assert full.returncode != 0, "a full disk passed unnoticed:\n" + full.stdout
        assert "cannot write" in full.stdout + full.stderr, full.stdout + full.stderr
        left = [name for name in os.listdir(folder) if os.path.getsize(os.path.join(folder, name)) > 0]
        assert not left, f"parts of files are left: {left}"
        roomy = record(sys.argv[1], folder, 1 << 26)
        assert roomy.returncode == 0, roomy.stdout + roomy.stderr
        assert any(name.endswith(".png") for name in os.listdir(folder))
    print("a full disk is told, and nothing half written is left")


main()
