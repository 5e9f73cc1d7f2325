#!/usr/bin/env bash
# Runs convergence-study as a step of GitHub Actions, and hands its report on to the steps after it.
#
# Reads RUN, the arguments of the program; writes `status` and, where there is a report, `report` and `comment` to
# GITHUB_OUTPUT; ends as the program does. The summary of the job and its annotations are the program's own doing.
set -euo pipefail

# Patterns are for the program, not for the shell.
set -f
# shellcheck disable=SC2206
arguments=(${RUN:-verify})

report=$(mktemp -d "$RUNNER_TEMP/convergence-report-XXXXXX")
status=0
convergence-study "${arguments[@]}" --out "$report" || status=$?
echo "status=$status" >>"$GITHUB_OUTPUT"
# `list`, `verify --dry-run` and a run that ends with another status write none.
comment=$(find "$report" -name summary.md -o -name rates.md | head -1)
if [ "$status" -le 1 ] && [ -n "$comment" ]; then
    echo "report=$report" >>"$GITHUB_OUTPUT"
    echo "comment=$comment" >>"$GITHUB_OUTPUT"
fi
exit "$status"
