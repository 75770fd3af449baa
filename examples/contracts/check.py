#!/usr/bin/env python3
"""Asks the sources of a flight stack whether they still do what an example of this project counts on.

    examples/contracts/check.py examples/betaflight/README.md /path/to/betaflight

The contracts are the table "counted on | file | shown by | read at" of the example's page. A row holds where the texts of its
third column stand in the file in this order, white space apart; "or" separates other ways to say it, "no" stands before a text
that must be absent. Of several files the first that is there is asked. What no text can show has none, and is told as such.

Ends with status 1 where a contract is not found: read that place of the stack before you fly with it.
"""

import re
import sys
from pathlib import Path

HEADER = ["counted on", "file", "shown by", "read at"]


def cells(line):
    """Cells of a row of a Markdown table."""
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def contracts(page):
    """Rows of the table of contracts: what is counted on, files, ways to show it."""
    lines = page.read_text(encoding="utf-8").splitlines()
    starts = [number for number, line in enumerate(lines) if line.startswith("|") and cells(line) == HEADER]
    if len(starts) != 1:
        sys.exit(f"{page}: {len(starts)} tables of contracts (| {' | '.join(HEADER)} |), must be one")
    for line in lines[starts[0] + 2 :]:
        if not line.startswith("|"):
            return
        what, files, shown, _ = cells(line)
        ways = [re.findall(r"(no )?`([^`]+)`", way) for way in re.split(r"\bor\b(?=(?:[^`]*`[^`]*`)*[^`]*$)", shown)]
        yield what, re.findall(r"`([^`]+)`", files), [way for way in ways if way]


def squeezed(text):
    """Text without white space, in which lines and indentation of a stack may change."""
    return re.sub(r"\s+", "", text)


def shows(text, way):
    """Whether `text` has the texts of a way in their order, and none that must be absent."""
    place = 0
    for absent, part in way:
        found = text.find(squeezed(part), 0 if absent else place)
        if (found < 0) != bool(absent):
            return False
        place = place if absent else found + len(squeezed(part))
    return True


def main(page, tree):
    """Prints each contract with what became of it; the status."""
    rows = list(contracts(Path(page)))
    missing = 0
    for what, files, ways in rows:
        found = next((tree / file for file in files if (tree / file).is_file()), None)
        if not ways:
            state = "not in a text"
        elif found is None:
            state = "NO SUCH FILE"
        else:
            text = squeezed(found.read_text(encoding="utf-8", errors="replace"))
            held = [number for number, way in enumerate(ways, 1) if shows(text, way)]
            state = "NOT FOUND" if not held else "holds" if len(ways) == 1 else f"holds, way {held[0]}"
        missing += state.isupper()
        print(f"{state:<13} {' or '.join(files)}: {what}")
    print(f"{len(rows)} contracts, {missing} not found in {tree}")
    return 1 if missing else 0


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], Path(sys.argv[2])))
