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
# With any other status nothing was written.
if [ "$status" -le 1 ]; then
    echo "report=$report" >>"$GITHUB_OUTPUT"
    comment=$(find "$report" -name summary.md -o -name rates.md | head -1)
    echo "comment=$comment" >>"$GITHUB_OUTPUT"
fi
exit "$status"
