"""Rows of measured values with their limits, and the table that shows them."""
import dataclasses
import math


@dataclasses.dataclass
class Row:
    name: str
    measured: float
    least: float = -math.inf
    most: float = math.inf
    unit: str = ""
    reference: str = ""
    # Bounds that it keeps to so far where it is known to miss its limit, wider than that.
    held_least: float | None = None
    held_most: float | None = None

    @property
    def ok(self):
        return self.least <= self.measured <= self.most  # never for NaN

    @property
    def held(self):
        least = self.least if self.held_least is None else self.held_least
        most = self.most if self.held_most is None else self.held_most
        return least <= self.measured <= most

    @property
    def verdict(self):
        return "" if not self.limit else "OK" if self.ok else "MISS" if self.held else "FAIL"

    @property
    def limit(self):
        if self.least == self.most:
            return f"= {self.least:.4g}"
        if math.isinf(self.least):
            return "" if math.isinf(self.most) else f"<= {self.most:.4g}"
        return f">= {self.least:.4g}" if math.isinf(self.most) else f"{self.least:.4g} ... {self.most:.4g}"


def near(name, measured, value, share, source, unit="m", held=None):
    """Within a share of a reference value; `held`: a wider share that it keeps to so far."""
    margin, wider = abs(value) * share, abs(value) * (held or share)
    text = f"{source} {value:.4g}, {100 * share:g} %" + (f", so far {100 * held:g} %" if held else "")
    return Row(name, measured, value - margin, value + margin, unit, text, value - wider, value + wider)


def at_most(name, measured, most, unit="", reference="", held=None):
    return Row(name, measured, most=most, unit=unit, reference=reference + (f", so far {held:g}" if held else ""), held_most=held)


def at_least(name, measured, least, unit="", reference="", held=None):
    return Row(name, measured, least=least, unit=unit, reference=reference + (f", so far {held:g}" if held else ""), held_least=held)


def exactly(name, measured, value, unit="", reference=""):
    return Row(name, measured, value, value, unit, reference)


def shown(name, measured, unit="", reference=""):
    """A value without a limit."""
    return Row(name, measured, unit=unit, reference=reference)


def lines(title, rows, control=None):
    """The table of a case; `control` are the rows of a run in which the case must fail."""
    wide = max(len(row.name) for row in rows)
    yield title
    for index, row in enumerate(rows):
        text = f"  {row.verdict:4} {row.name:{wide}} {row.measured:10.4g} {row.unit:4} {row.limit:20}"
        if control is not None:
            other = control[index]
            text += f" control {other.measured:10.4g} {'' if not other.limit else 'holds' if other.held else 'breaks':6}"
        yield f"{text}  {row.reference}".rstrip()
