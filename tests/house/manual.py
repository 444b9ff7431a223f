#!/usr/bin/python3
"""The man page and `recede SUBCOMMAND --help` name the same options, as TAP.

Usage: manual.py PAGE COMMAND
"""
import re
import subprocess
import sys

page, command = sys.argv[1:]
text = open(page, encoding="utf-8").read().replace("\\-", "-")
in_page = set(re.findall(r"(--[a-z][a-z-]+)", text))
SUBCOMMANDS = ["fill", "synthesize", "scale-map", "orient"]
NOT_OURS = {"--help-all"}
in_help = {}
for name in SUBCOMMANDS:
    done = subprocess.run([command, name, "--help"], capture_output=True, text=True, timeout=30)
    in_help[name] = set(re.findall(r"^\s+(?:-\w, )?(--[a-z][a-z-]+)", done.stdout, re.M)) - NOT_OURS

print(f"1..{len(SUBCOMMANDS) + 1}")
for number, name in enumerate(SUBCOMMANDS, 1):
    missing = in_help[name] - in_page
    print(f"{'not ' if missing or not in_help[name] else ''}ok {number} - {name}: all in the page")
    if missing:
        print(f"# not in the page: {' '.join(sorted(missing))}")
unknown = in_page - set().union(*in_help.values()) - {"--version"}
print(f"{'not ' if unknown else ''}ok {len(SUBCOMMANDS) + 1} - the page invents no option")
if unknown:
    print(f"# unknown to the command: {' '.join(sorted(unknown))}")
