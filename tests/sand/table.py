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

    @property
    def ok(self):
        return self.least <= self.measured <= self.most  # never for NaN

    @property
    def limit(self):
        if self.least == self.most:
            return f"= {self.least:.4g}"
        if math.isinf(self.least):
            return "" if math.isinf(self.most) else f"<= {self.most:.4g}"
        return f">= {self.least:.4g}" if math.isinf(self.most) else f"{self.least:.4g} ... {self.most:.4g}"


def near(name, measured, value, share, source, unit="m"):
    """Within a share of a reference value."""
    margin = abs(value) * share
    return Row(name, measured, value - margin, value + margin, unit, f"{source} {value:.4g}, {100 * share:g} %")


def at_most(name, measured, most, unit="", reference=""):
    return Row(name, measured, most=most, unit=unit, reference=reference)


def at_least(name, measured, least, unit="", reference=""):
    return Row(name, measured, least=least, unit=unit, reference=reference)


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
        verdict = ("OK  " if row.ok else "FAIL") if row.limit else "    "
        text = f"  {verdict} {row.name:{wide}} {row.measured:10.4g} {row.unit:4} {row.limit:20}"
        if control is not None:
            other = control[index]
            text += f" control {other.measured:10.4g} {'holds' if other.ok and other.limit else 'breaks' if other.limit else '':6}"
        yield f"{text}  {row.reference}".rstrip()
