#!/usr/bin/env bash
# Runs `cargo xtask verify` as a step of GitHub Actions, and tells the steps after it where the report is.
#
# Reads TIER and IDS; writes `status` and, where a report was written, `report` to GITHUB_OUTPUT; ends as verify does. The
# report is a copy of the files that this run wrote, and of no others that the checkout had. The summary of the job and its
# annotations are the program's own doing.
set -euo pipefail

# Patterns are for the program, not for the shell.
set -f
# shellcheck disable=SC2206
ids=(${IDS:-})
tier=${TIER:-quick}

if [ "${#ids[@]}" -gt 0 ]; then
    report=reports/local/partial
elif [ "$tier" = full ]; then
    report=reports/full
else
    report=reports
fi

# Every run makes it anew: one that is there afterwards is of this run, and none is after `--dry-run`, or where study files
# were named.
rm -f "$report/results.json"
status=0
cargo xtask verify --tier "$tier" ${ids[@]+"${ids[@]}"} || status=$?
echo "status=$status" >>"$GITHUB_OUTPUT"
is_written=$([ ! -f "$report/results.json" ] || echo yes)
# A run of a tier that does not pass leaves the committed report as it is.
if [ "$status" -eq 1 ] && [ "${#ids[@]}" -eq 0 ]; then
    report=reports/local/$tier
fi
# With any other status nothing was written.
if [ "$status" -le 1 ] && [ -n "$is_written" ]; then
    copy=$(mktemp -d "$RUNNER_TEMP/thermobeam-report-XXXXXX")
    for file in README.md index.html junit.xml results.json summary.md; do
        cp "$report/$file" "$copy"
    done
    # Figures that the record lists, and that of all rates; those that only the page shows are in a folder of their own.
    mkdir -p "$copy/figures/page"
    { grep --only-matching '"file": "[^"]*\.svg"' "$report/results.json" || true; echo '"file": "rates.svg"'; } | cut -d '"' -f 4 | while read -r figure; do
        for file in "figures/$figure" "figures/page/$figure"; do
            [ ! -f "$report/$file" ] || cp "$report/$file" "$copy/$file"
        done
    done
    cp reports/local/provenance.json "$copy"
    echo "report=$copy" >>"$GITHUB_OUTPUT"
fi
exit "$status"
