"""The page's own numbers, and those that the code's comments cite."""

import re

from coverage import CHECKS
from reference import ROOT

PAGE = (ROOT / "docs/theory.md").read_text()
# A number in brackets of its own, not the argument of a call.
CITATION = re.compile(r"(?<![\w>)\]])\((\d{1,2}\.\d{1,2})\)")


def page():
    """The numbers at the ends of the page's equations: in order, without gaps, and all covered."""
    blocks = re.findall(r"```text\n(.*?)```", PAGE, re.S)
    listed = re.findall(r"\((\d+)\.(\d+)\)$", "\n".join(blocks), re.M)
    expected = None
    for section, number in ((int(a), int(b)) for a, b in listed):
        if expected is not None and section == expected[0]:
            assert number == expected[1] + 1, f"({section}.{number}) follows ({expected[0]}.{expected[1]})"
        else:
            assert number == 1, f"section {section} begins with ({section}.{number})"
        expected = (section, number)
    numbers_ = {f"{a}.{b}" for a, b in listed}
    covered = {number for covers_, _ in CHECKS for number in covers_}
    assert numbers_ == covered, f"on one side only: {sorted(numbers_ ^ covered)}"
    for block in blocks:
        for line in block.splitlines():
            body = re.sub(r"\s*\(\d+\.\d+\)$", "", line)
            assert len(body) < 140, line
    cited = re.findall(r"\((\d+\.\d+)\)", PAGE)
    assert set(cited) <= numbers_, f"cited, but not there: {sorted(set(cited) - numbers_)}"
    return numbers_


def code(numbers_):
    """Every number that a comment of the code cites is on the page."""
    count = 0
    for path in sorted(ROOT.rglob("*.rs")):
        if "target" in path.relative_to(ROOT).parts:
            continue
        for n, line in enumerate(path.read_text().splitlines(), 1):
            comment = re.search(r"//.*", line)
            for number in CITATION.findall(comment.group()) if comment else []:
                assert number in numbers_, f"{path.relative_to(ROOT)}:{n}: ({number}) is not on the page"
                count += 1
    return count
