"""Which check covers which equations."""

CHECKS = []


def covers(*numbers):
    """Marks a check with the equations that it covers."""

    def mark(check):
        CHECKS.append((numbers, check))
        return check

    return mark
