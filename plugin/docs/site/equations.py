"""Formulas as pages write them in backquotes (`u' = 2 u/(1 + sqrt(1 + 4 r |V*|))`) to TeX. Names stay as they are, so that prose and formula say
the same: `hs` is set as hs, `h_m` with an index, `rho_s` with a Greek letter. What this does not take for a formula stays code."""
import re

GREEK = {name: "\\" + name for name in ("alpha", "beta", "gamma", "eta", "kappa", "lambda", "mu", "nu", "omega", "phi", "rho", "sigma", "chi")}
GREEK["eps"] = "\\varepsilon"
FUNCTIONS = {"max", "min", "sqrt", "floor", "clamp", "sign", "exp", "ln", "det", "tan", "artanh", "mean", "minmod", "sum", "grad", "sin", "cos"}
RELATIONS = {"=": "=", "<-": "\\leftarrow", "<=": "\\le", ">=": "\\ge", "<": "<", ">": ">", "+=": "\\mathrel{+}=", "-=": "\\mathrel{-}=", "?": "\\mathbin{?}", ":": "\\mathbin{:}"}
# A name with its index (`h_m`, `h_m,R`, `c_0`); a number; what else a formula has.
TOKEN = re.compile(
    r"(?P<space>\s+)|(?P<number>\d+(?:\.\d+)?(?:e-?\d+)?)|(?P<name>[A-Za-z]+\d*(?:_[A-Za-z0-9]+(?:(?<=_[a-z]),[A-Z](?![A-Za-z_(]))?)*)"
    r"|(?P<index>_[A-Za-z0-9]+)|(?P<relation><-|<=|>=|\+=|-=|[=<>?:])|(?P<sign>\.\.\.|[-+/^'*|()\[\],.])")
# Words of three letters and more that are quantities, not English.
QUANTITIES = {"dts", "scale", "phase", "pos", "neg", "sxx", "Gxx", "Gxy", "Gyx", "Vxx", "Vyy", "Vxy", "dxy", "ulp", "falls", "free", "due", "extra", "level",
              "share", "gained", "dev", "div"}
ENGLISH = {"of", "is", "to"}  # words of two letters that are no names


class NoFormula(Exception):
    pass


def tokens_of(text):
    found, at = [], 0
    while at < len(text):
        token = TOKEN.match(text, at)
        if not token:
            raise NoFormula(f"{text[at]!r} at {at}")
        if token.lastgroup == "space":
            if found:
                found[-1][2] = True
        else:
            found.append([token.lastgroup, token[0], False])  # kind, text, a blank follows
        at = token.end()
    return found


def letters(name):
    """One name without its index."""
    if name in GREEK:
        return GREEK[name]
    return name if len(name) == 1 else f"\\mathit{{{name}}}"


def name_to_tex(name):
    base, *indices = name.split("_")
    if base == "grad":
        return f"\\nabla_{{{''.join(indices)}}}"
    if len(base) > 2 and base not in GREEK and base not in QUANTITIES and indices:  # a setting's name, whole
        return "\\mathit{" + name.replace("_", "\\_") + "}"
    if not indices:
        digits = re.fullmatch(r"([A-Za-z])(\d+)", base)
        return f"{digits[1]}_{{{digits[2]}}}" if digits else letters(base)
    parts = ",".join(part if len(part) == 1 or part.isdigit() or "," in part else GREEK.get(part, f"\\mathrm{{{part}}}") for part in indices)
    return f"{letters(base)}_{{{parts}}}"


def side_by_side(factors):
    """Factors of a product; words of English in one piece."""
    words = []
    for factor, _ in factors:
        if words and factor.startswith("\\text{") and words[-1].startswith("\\text{"):
            words[-1] = f"{words[-1][:-1]} {factor[6:]}"
        else:
            words.append(factor)
    text = words[0]
    for before, after in zip(words, words[1:]):
        text += ("\\ " if "\\text{" in (before[:6], after[:6]) else " " if before in ("\\sum", "\\cdot") or after == "\\cdot" else "\\,") + after
    return text


class Parser:
    """expression: terms between signs and relations; term: factors side by side; a/b takes one factor on either side, as the pages have it."""

    def __init__(self, text):
        self.tokens, self.at = tokens_of(text), 0

    def peek(self, *texts):
        return self.at < len(self.tokens) and (not texts or self.tokens[self.at][1] in texts)

    def take(self):
        self.at += 1
        return self.tokens[self.at - 1]

    def expression(self, *ends):
        parts, listed = [], False
        while self.peek() and not (ends and self.peek(*ends)):
            kind, text, _ = self.tokens[self.at]
            if kind == "relation":
                self.take()
                parts.append(RELATIONS[text])
            elif text in "+-,":
                self.take()
                listed = listed or text == ","
                parts.append({",": ",\\;"}.get(text, text))
                if text == "+" and self.peek("-"):  # +-x
                    self.take()
                    parts[-1] = "\\pm"
            else:
                parts.append(self.term(ends))
        self.listed = listed  # (a, b): its brackets stay above and below a line
        return " ".join(parts)

    def term(self, ends):
        factors = []
        while self.peek() and not (ends and self.peek(*ends)):
            kind, text, blank = self.tokens[self.at]
            if kind == "relation" or text in ("+", "-", ",", ")", "]"):
                break
            if text == "/":
                if not factors:
                    raise NoFormula("a quotient of nothing")
                wide = blank and self.tokens[self.at - 1][2]  # a b / c d: all of both
                self.take()
                if wide:
                    above = factors[0][1] if len(factors) == 1 else side_by_side(factors)
                    return f"\\frac{{{above}}}{{{self.term(ends)}}}"
                factors[-1] = (f"\\frac{{{factors[-1][1]}}}{{{self.factor(ends)[1]}}}",) * 2
            elif text == ".":
                self.take()
                factors.append(("\\cdot",) * 2)
            elif text == "...":
                self.take()
                factors.append(("\\ldots",) * 2)
            else:
                factors.append(self.factor(ends))
        if not factors:
            raise NoFormula("nothing where a factor is due")
        return factors[0][1] if len(factors) == 1 and "\\frac" in factors[0][0] and not factors[0][0].startswith("\\left") else side_by_side(factors)

    def factor(self, ends):
        """(as it stands, as it stands above or below a line: without its outer brackets)"""
        kind, text, blank = self.take()
        if kind == "number":
            base = bare = re.sub(r"e(-?\d+)", r"\\cdot 10^{\1}", text)
        elif kind == "name" and text in FUNCTIONS:
            return self.function(text, ends)
        elif kind == "name":
            stem = text.split("_")[0]
            if text in ENGLISH or len(stem) > 2 and stem not in GREEK and stem not in QUANTITIES and not re.fullmatch(r"[A-Za-z]{1,2}\d+", stem) and "_" not in text:
                return (f"\\text{{{text}}}",) * 2
            base = bare = name_to_tex(text)
        elif text in "([":
            inside = self.expression(")" if text == "(" else "]")
            if not self.peek(")", "]"):
                raise NoFormula("an open bracket")
            blank = self.take()[2]
            base = f"\\left{text}{inside}\\right{')' if text == '(' else ']'}"
            bare = base if self.listed else inside
        elif text == "|":
            inside = self.expression("|")
            if not self.peek("|"):
                raise NoFormula("an open bar")
            blank = self.take()[2]
            base = bare = f"\\left|{inside}\\right|"
        else:
            raise NoFormula(f"{text!r} where a factor is due")
        return self.behind(base, bare, blank, ends)

    def behind(self, base, bare, blank, ends):
        """Primes, stars, powers."""
        while not blank and self.peek() and (self.tokens[self.at][1] in ("'", "*", "^") or self.tokens[self.at][0] == "index"):
            kind, text, blank = self.take()
            if kind == "index":
                base = f"{{{base}}}_{{{text[1:]}}}"
            elif text == "'":
                base += "'"
            elif text == "*":
                base = f"{base}^{{*}}"
            elif blank or not self.peek() or self.peek(")", ",", "|"):
                base = f"\\hat{{{base}}}"  # r^
            else:
                sign = "-" if self.peek("-") else ""
                if sign:
                    self.take()
                power = self.tokens[self.at]
                if power[0] == "name" and len(power[1]) == 1:
                    above, blank = power[1], power[2]
                    self.take()
                elif power[0] == "number":
                    above, blank = power[1], power[2]
                    self.take()
                else:
                    above = self.factor(ends)[1]
                    blank = self.tokens[self.at - 1][2]
                base = f"{{{base}}}^{{{sign}{above}}}"
            bare = base
        return base, bare

    def function(self, name, ends):
        head = {"sum": "\\sum", "grad": "\\nabla", "max": "\\max", "min": "\\min", "exp": "\\exp", "ln": "\\ln", "det": "\\det", "tan": "\\tan", "sin": "\\sin",
                "cos": "\\cos"}.get(name, f"\\operatorname{{{name}}}")
        power = ""
        if self.peek("^"):
            self.take()
            power = f"^{{{self.take()[1]}}}"
        if not self.peek("("):
            return (head + power,) * 2
        self.take()
        inside = self.expression(")")
        if not self.peek(")"):
            raise NoFormula("an open bracket")
        blank = self.take()[2]
        base = f"\\sqrt{{{inside}}}" if name == "sqrt" else f"{head}{power}\\left({inside}\\right)"
        return self.behind(base, base, blank, ends)


def to_tex(code):
    """TeX of a formula, or None where the text in backquotes is something else."""
    text = " ".join(code.split())
    single = re.fullmatch(r"[A-Za-z]{1,2}\d?(_[A-Za-z0-9]{1,2})?['*]?|" + "|".join(f"{name}(_[A-Za-z0-9]{{1,2}})?'?" for name in GREEK), text)
    if not single and not re.search(r"[=<>+/^|(,-]", text):
        return None
    if text in ENGLISH or re.search(r"--|[A-Za-z]{2,}\.[A-Za-z]{2}|[a-z]{3,}/[a-z]{3,}|/\*|::|[a-z]{3,}-\w", text):
        return None  # a word, an option, a key of a level, a file, a name with hyphens
    try:
        parser = Parser(text)
        tex = parser.expression()
    except (NoFormula, IndexError):
        return None
    return tex if parser.at == len(parser.tokens) else None


SILENT = re.compile(r"\\(left|right|mathit|mathrm|mathrel|mathbin|operatorname|text|frac|hat|pm|le|ge|leftarrow|cdot|ldots)(?![a-z])|\\[,; _]")
SPOKEN = {"\\varepsilon": "eps", "\\nabla": "grad"}


def said(text):
    """Letters and digits of a formula, in their order."""
    for sign, word in SPOKEN.items():
        text = text.replace(sign, word)
    return "".join(re.findall(r"[A-Za-z0-9]", SILENT.sub(" ", text)))


def formula(code):
    """to_tex, held to saying what the page says: the same names and numbers in the same order."""
    tex = to_tex(code)
    if tex is not None and said(tex) != said(code):
        raise ValueError(f"`{code}` became {tex}")
    return tex
