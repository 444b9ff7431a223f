#!/usr/bin/python3
"""Counts the test cases of a run: summary.py FOLDER

FOLDER holds LABEL.testlog.json files as `meson test` writes them, and failed-steps, a line for each
step before the tests that failed. A test that prints TAP counts as its cases; one that ends badly
without a failing case (a crash, a timeout, a sanitizer's report, fewer cases than planned) counts
as one failure more. Prints skips, failures with their logs and what they said, and the totals as
the last line: of a run elsewhere this may be all that is kept.
"""
import json
import re
import sys
from pathlib import Path

CASE = re.compile(r"^(not )?ok\b(?:\s+\d+)?\s*-?\s*(.*)")
GOOD = {"OK", "SKIP", "EXPECTEDFAIL"}
SAID_LINES = 8


def cases(output):
    """(name, 'passed' | 'failed' | 'skipped') for every top-level TAP line."""
    for line in output.splitlines():
        match = CASE.match(line)
        if not match:
            continue
        name, _, directive = match[2].partition("#")
        directive = directive.strip().upper()
        if directive.startswith("SKIP"):
            yield match[2].strip(), "skipped"
        elif directive.startswith("TODO"):
            yield match[2].strip(), "skipped"
        else:
            yield name.strip() or "(unnamed)", "failed" if match[1] else "passed"


def is_tap(output):
    return re.search(r"^1\.\.\d+", output, re.M) is not None


def judge(test):
    """The cases of one entry of testlog.json."""
    output = test.get("stdout") or ""
    results = list(cases(output)) if is_tap(output) else []
    if test["result"] not in GOOD and not any(state == "failed" for _, state in results):
        results.append((f"ended with {test['result']}, status {test.get('returncode')}", "failed"))
    if not results:
        results.append(("", "skipped" if test["result"] == "SKIP" else "passed"))
    return results


def said(test, name):
    """What a failing case printed after its line, or else the end of the test's errors."""
    lines = (test.get("stdout") or "").splitlines()
    for number, line in enumerate(lines):
        match = CASE.match(line)
        if match and match[1] and match[2].partition("#")[0].strip() == name:
            rest = lines[number + 1:]
            end = next((i for i, text in enumerate(rest) if not text.startswith("#")), len(rest))
            if end:
                return rest[:min(end, SAID_LINES)]
    return (test.get("stderr") or "").splitlines()[-SAID_LINES:]


def write_log(folder, label, test):
    name = re.sub(r"[^A-Za-z0-9_.-]+", "_", test["name"].split(" / ")[-1])
    path = folder / f"{label}-{name}.log"
    command = " ".join(test.get("command") or [])
    path.write_text(f"{command}\n{test.get('stdout') or ''}\n{test.get('stderr') or ''}\n")
    return path


def main():
    folder = Path(sys.argv[1])
    count = {"passed": 0, "failed": 0, "skipped": 0}
    steps = folder / "failed-steps"
    failures = steps.read_text().splitlines() if steps.exists() else []
    count["failed"] = len(failures)
    failures = [f"FAILED {line}: {folder / line.split(':')[0]}.log" for line in failures]
    for log in sorted(folder.glob("*.testlog.json")):
        label = log.name.removesuffix(".testlog.json")
        for line in log.read_text().splitlines():
            test = json.loads(line)
            results = judge(test)
            for name, state in results:
                count[state] += 1
                if state == "failed":
                    path = write_log(folder, label, test)
                    failures.append(f"FAILED [{label}] {test['name']} {name}: {path}")
                    failures += ["    " + line[:300] for line in said(test, name)]
                elif state == "skipped":
                    print(f"skipped [{label}] {test['name']} {name}".rstrip())
    print(*failures, sep="\n", end="\n" if failures else "")
    if count["passed"] + count["failed"] == 0:
        print("no test ran")
    print(f"{count['passed']} passed, {count['failed']} failed")
    return count["failed"] > 0 or count["passed"] == 0


sys.exit(main())
