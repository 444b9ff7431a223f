#!/usr/bin/python3
"""The counting of `./dev test` itself, as TAP: a run that went wrong must never look right."""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

SUMMARY = Path(__file__).parent.parent / "lib" / "summary.py"


def run(tests, steps=""):
    """(last line, whole output, exit status) of the summary of those tests."""
    with tempfile.TemporaryDirectory() as folder:
        if tests:
            lines = [json.dumps({"name": "a / t", "returncode": 0} | test) for test in tests]
            Path(folder, "x.testlog.json").write_text("\n".join(lines) + "\n")
        if steps:
            Path(folder, "failed-steps").write_text(steps)
        done = subprocess.run([SUMMARY, folder], capture_output=True, text=True)
        return done.stdout.splitlines()[-1], done.stdout, done.returncode


def tap(result, *lines):
    return {"result": result, "stdout": "\n".join([*lines, ""])}


CASES = [
    ("cases count, not programs", [tap("OK", "1..2", "ok 1 - a", "ok 2 - b")], "",
     "2 passed, 0 failed"),
    ("a failing case", [tap("FAIL", "1..2", "ok 1 - a", "not ok 2 - b")], "", "1 passed, 1 failed"),
    ("a crash after good cases", [tap("ERROR", "1..2", "ok 1 - a")], "", "1 passed, 1 failed"),
    ("a timeout", [tap("TIMEOUT", "ok 1 - a", "1..1")], "", "1 passed, 1 failed"),
    ("no TAP", [tap("OK", "fine"), tap("FAIL", "bad")], "", "1 passed, 1 failed"),
    ("a skip is neither", [tap("OK", "1..2", "ok 1 - a", "ok 2 - b # SKIP no data")], "",
     "1 passed, 0 failed"),
    ("indented cases belong to others", [tap("OK", "1..1", "    not ok 1 - c", "ok 1 - a")], "",
     "1 passed, 0 failed"),
    ("a step before the tests", [tap("OK", "1..1", "ok 1 - a")], "chroot: failed\n",
     "1 passed, 1 failed"),
    ("nothing ran", [], "", "0 passed, 0 failed"),
]
print(f"1..{len(CASES) + 1}")
for number, (name, tests, steps, wanted) in enumerate(CASES, 1):
    last, output, status = run(tests, steps)
    good = last == wanted and (status == 0) == (wanted.endswith(" 0 failed") and wanted[0] != "0")
    print(f"{'ok' if good else 'not ok'} {number} - {name}")
    if not good:
        print(f"# wanted {wanted!r}, got {last!r} and status {status}", file=sys.stderr)
_, output, _ = run([tap("FAIL", "1..1", "not ok 1 - a", "# because of 7", "# and 8")], "")
print("ok" if "because of 7\n" in output else "not ok", len(CASES) + 1, "- a failure's reason")
