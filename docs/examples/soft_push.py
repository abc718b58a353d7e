"""A controller in Python: control.law: process, control.command: python3 soft_push.py

One JSON line per sample comes in, one goes out. Whatever is written to the standard error is shown
where the run fails.
"""
import json
import sys

told = {}
for line in sys.stdin:
    now = json.loads(line)
    if "setup" in now:  # in the first line, and in one after something has changed
        told = now
    wanted = told["control"]["force"]
    gain = told["settings"].get("gain", 0.1)
    volts = 1 + 0.3 * (0.1 - now["encoder"]) + gain * (wanted - now["force"])
    print(json.dumps({"command": volts, "calculated_force": now["force"]}), flush=True)
