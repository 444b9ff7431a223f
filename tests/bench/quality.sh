#!/bin/bash
# `./dev bench quality [OPTIONS]`: scores and contact sheets of the evaluation data's cases.
exec "$(dirname "${BASH_SOURCE[0]}")/../quality/score.py" "$@"
