"""Whether a run is worse than another: python3 .ci/worse.py OLD NEW, two files results.json of `verify`.

Worse is: a study, a rate, a level or an error of OLD that NEW does not have; a verdict on a study or a rate that was
better; an error that is larger by more than one per cent, or no longer a finite number >= 0. Errors that the floor of
their own study sets aside are round-off, and are not compared. Each place is named, and the exit status is 1.
"""

import json
import math
import sys
from pathlib import Path

WITHIN = 0.01
VERDICTS = ["pass", "inconclusive", "fail"]


def named(number: int, level: dict) -> str:
    """A level in words, which no other level of its study has."""
    parameters = [f"{name} = {value}" for name, value in level.items() if name not in ("step", "errors", "work", "without")]
    return ", ".join([f"level {number + 1}", *parameters])


def errors(study: dict) -> dict[tuple[str, str], float]:
    """The errors by name and level; null, which is not finite, as NaN."""
    found = {}
    for number, level in enumerate(study["levels"]):
        for name, error in level["errors"].items():
            found[name, named(number, level)] = math.nan if error is None else error
    return found


def at_floor(study: dict) -> set[tuple[str, str]]:
    """The errors, by name and level, that the study's floor sets aside."""
    found = set()
    for rate in study["rates"]:
        levels = [named(number, level) for number, level in enumerate(study["levels"]) if rate["norm"] in level["errors"]]
        for aside in rate.get("set_aside", []):
            if aside["because"] == "at-floor" and aside["level"] < len(levels):
                found.add((rate["norm"], levels[aside["level"]]))
    return found


def is_error(number: float) -> bool:
    return math.isfinite(number) and number >= 0


def worse(old: dict, new: dict):
    """What is worse in a study, one text each."""
    rates = {rate["norm"]: rate for rate in new["rates"]}
    verdicts = [("the study", old, new)]
    verdicts += [(f"the rate of {rate['norm']}", rate, rates.get(rate["norm"])) for rate in old["rates"]]
    for what, before, after in verdicts:
        if after is None:
            yield f"{what} is lost"
        elif VERDICTS.index(after["verdict"]) > VERDICTS.index(before["verdict"]):
            yield f"{what} was {before['verdict']}, is {after['verdict']}"
    not_compared = at_floor(old) | at_floor(new)
    found = errors(new)
    for (name, level), before in errors(old).items():
        after = found.get((name, level))
        if after is None:
            yield f"{name} at {level} is lost"
        elif not is_error(before) or (name, level) in not_compared:
            continue
        elif not is_error(after) or after > (1 + WITHIN) * before:
            yield f"{name} at {level} was {before}, is {after}"


def main(old: Path, new: Path) -> int:
    before, after = ({study["id"]: study for study in json.loads(path.read_text())["studies"]} for path in (old, new))
    if not before:
        print(f"{old}: expected a study, found none")
        return 1
    count = 0
    for name, study in before.items():
        for text in worse(study, after[name]) if name in after else ["the study is lost"]:
            print(f"{name}: {text}")
            count += 1
    compared = sum(len(errors(study)) for study in before.values())
    print(f"{count} worse of {compared} errors in {len(before)} studies")
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main(*map(Path, sys.argv[1:])))
