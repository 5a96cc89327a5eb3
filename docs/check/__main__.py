"""Checks every numbered equation of docs/theory.md, with nothing but Python's standard library.

Against what: the vectors of tests/golden, which come from differentiating the published equations in binary128, and, where
those say nothing, a construction that does not use the equation: Newton's law, a finer integration of the flow, a sum in
place of an integral. Also checks that the page's numbers have no gaps, that each is covered here, and that every number
cited in the code's comments is on the page.

    python3 docs/check
"""

import sys

import checks_estimation  # noqa: F401
import checks_flight  # noqa: F401
import checks_law  # noqa: F401
import checks_model  # noqa: F401
import checks_sampled  # noqa: F401
import pages
from coverage import CHECKS


def main():
    for numbers_, check in CHECKS:
        try:
            check()
        except AssertionError as error:
            sys.exit(f"{check.__name__} ({', '.join(numbers_)}): {error}")
    try:
        on_page = pages.page()
        cited = pages.code(on_page)
    except AssertionError as error:
        sys.exit(str(error))
    print(f"{len(on_page)} equations hold, by {len(CHECKS)} checks; {cited} citations in the code.")


if __name__ == "__main__":
    main()
