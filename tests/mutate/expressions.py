"""What can be broken in an expression, by libclang."""
import re

from clang.cindex import CursorKind as Kind
from clang.cindex import TypeKind

import kinds
from mutant import Mutant, Part, shown
from source_text import SourceText, flat

# Constant expressions, types and default arguments: a switch that is read while the program runs has no place there.
LEFT_ALONE = {Kind.PARM_DECL, Kind.TYPE_REF, Kind.TEMPLATE_REF, Kind.NAMESPACE_REF, Kind.MEMBER_REF, Kind.STATIC_ASSERT, Kind.ENUM_DECL,
              Kind.CXX_UNARY_EXPR, Kind.TEMPLATE_TYPE_PARAMETER, Kind.TEMPLATE_NON_TYPE_PARAMETER, Kind.TEMPLATE_TEMPLATE_PARAMETER,
              Kind.TYPEDEF_DECL, Kind.TYPE_ALIAS_DECL, Kind.CXX_TYPEID_EXPR, Kind.USING_DECLARATION, Kind.STRING_LITERAL}
INTEGERS = {TypeKind.INT, TypeKind.UINT, TypeKind.LONG, TypeKind.ULONG, TypeKind.LONGLONG, TypeKind.ULONGLONG, TypeKind.SHORT, TypeKind.USHORT,
            TypeKind.CHAR_S, TypeKind.CHAR_U, TypeKind.SCHAR, TypeKind.UCHAR}
NUMBERS = INTEGERS | {TypeKind.FLOAT, TypeKind.DOUBLE}
DEPENDENT = {TypeKind.DEPENDENT, TypeKind.UNEXPOSED, TypeKind.INVALID}
SMALLEST_CONSTANT = 1e-6  # no test can tell whether a smaller tolerance is doubled
LARGE = 50

INTEGER = re.compile(rb"(0[xX][0-9a-fA-F']+|0[bB][01']+|[0-9][0-9']*)([uUlLzZ]*)\Z")
FLOATING = re.compile(rb"[0-9.][0-9a-fA-FxXpPeE.'+-]*?([fFlL]?)\Z")


def number_kind(cursor):
    return cursor.type.get_canonical().kind


def inside(cursor):
    """Without the conversions and parentheses about it."""
    while cursor.kind in (Kind.UNEXPOSED_EXPR, Kind.PAREN_EXPR):
        children = list(cursor.get_children())
        if len(children) != 1:
            break
        cursor = children[0]
    return cursor


class Expressions:
    """Walks the expressions of one file; `mutants` is what it found. Who inherits it walks the statements, of which lambdas are made."""

    def __init__(self, name, data):
        self.name = name
        self.text = SourceText(data)
        self.data = data
        self.mutants = []
        self.seen = set()
        self.conditions = set()  # spans that are always and never true in mutants of their own
        self.unordered = set()  # spans of lists whose order doesn't matter
        self.covered = set()  # spans of constants whose change is another mutant
        self.at_run_time = False

    # --- text ---

    def span(self, cursor):
        extent = cursor.extent
        return extent.start.offset, extent.end.offset

    def of(self, cursor):
        start, end = self.span(cursor)
        return self.data[start:end]

    def between(self, first, second):
        """What stands between two cursors, on one line; None where they don't follow each other."""
        end, start = self.span(first)[1], self.span(second)[0]
        return flat(self.data[end:start]) if end <= start else None

    # --- expressions ---

    def expression(self, cursor):
        kind = cursor.kind
        if kind in LEFT_ALONE:
            return
        if kind == Kind.LAMBDA_EXPR:
            for child in cursor.get_children():
                if child.kind == Kind.COMPOUND_STMT:
                    self.statement(child)
            return
        if kind in (Kind.COMPOUND_STMT, Kind.DECL_STMT):
            self.statement(cursor)
            return
        if kind == Kind.CALL_EXPR and self.unwatched(cursor):
            return
        if kind in (Kind.INTEGER_LITERAL, Kind.FLOATING_LITERAL, Kind.CXX_BOOL_LITERAL_EXPR, Kind.CHARACTER_LITERAL):
            self.constant(cursor)
            return
        if kind == Kind.DECL_REF_EXPR:
            self.named_constant(cursor)
            return
        children = list(cursor.get_children())
        if kind in (Kind.BINARY_OPERATOR, Kind.COMPOUND_ASSIGNMENT_OPERATOR):
            self.binary(cursor, children)
        elif kind == Kind.UNARY_OPERATOR:
            self.unary(cursor, children)
        elif kind == Kind.CONDITIONAL_OPERATOR and len(children) == 3:
            self.condition(children[0])
        elif kind == Kind.CALL_EXPR:
            self.call(cursor, children)
        elif kind == Kind.INIT_LIST_EXPR and self.span(cursor) not in self.unordered:
            self.exchanged(children)
        elif kind == Kind.MEMBER_REF_EXPR:
            # Template arguments follow the object.
            children = [child for child in children[:1] if child.kind.is_expression()]
        for child in children:
            start, end = self.span(child)
            if end > start:
                self.expression(child)

    def operator(self, cursor):
        """The operator of a binary expression, built in or overloaded; empty for everything else."""
        children = list(cursor.get_children())
        if cursor.kind in (Kind.BINARY_OPERATOR, Kind.COMPOUND_ASSIGNMENT_OPERATOR) and len(children) == 2:
            return self.between(*children) or b""
        if cursor.kind == Kind.CALL_EXPR and cursor.spelling.startswith("operator") and len(children) == 3:
            found = self.between(children[0], children[2]) or b""
            return found if found == cursor.spelling[8:].encode() else b""
        return b""

    def binary(self, cursor, children):
        operator = self.operator(cursor).decode(errors="replace")
        if not operator:
            return
        left, right = flat(self.of(children[0])), flat(self.of(children[1]))
        if left is None or right is None:
            return

        if b"EINTR" in left + right:
            return  # nobody interrupts a test

        def exchanged(kind, other):
            self.whole(cursor, kind, left + b" " + other.encode() + b" " + right)

        sorts = {number_kind(child) for child in children}
        if operator in kinds.COMPARISONS:
            real = bool(sorts & {TypeKind.FLOAT, TypeKind.DOUBLE})
            self.comparison(cursor, operator, left, right, real)
            if operator not in ("==", "!=") and sorts <= INTEGERS:
                # i < 3 and i <= 2 are the same.
                self.covered.update(self.span(inside(child)) for child in children)
            elif operator in ("==", "!="):
                self.covered.update(self.span(inside(child)) for child in children if self.of(child) == b"0")
        elif operator in ("&&", "||"):
            self.whole(cursor, "left operand dropped", right, "bool")
            self.whole(cursor, "right operand dropped", left, "bool")
        elif operator in kinds.ARITHMETIC and sorts <= (NUMBERS if operator in ("*", "/") else NUMBERS | DEPENDENT):
            if operator not in ("%", "&", "|", "<<", ">>") or sorts <= INTEGERS:
                exchanged("arithmetic", kinds.ARITHMETIC[operator])
        elif operator in kinds.COMPOUND and sorts <= NUMBERS | DEPENDENT:
            exchanged("arithmetic", kinds.COMPOUND[operator])

    def comparison(self, cursor, operator, left, right, real=False):
        if operator in ("<", ">=") and right == b"0" and kinds.DESCRIPTOR.search(left.decode(errors="replace")):
            return
        # Of two lengths that are the same to the last bit hardly anything depends: theirs is negated.
        negated = real or operator in ("==", "!=")
        # A condition that is negated is noticed whenever one that is always or never true is.
        if negated and self.span(cursor) in self.conditions:
            return
        other = (kinds.NEGATED if real else kinds.COMPARISONS)[operator]
        self.whole(cursor, "comparison", left + b" " + other.encode() + b" " + right, "bool")

    def unary(self, cursor, children):
        text = self.of(cursor)
        if len(children) != 1:
            return
        operand = flat(self.of(children[0]))
        if operand is None:
            return
        if text.startswith(b"!"):
            if not text.startswith(b"!=") and self.span(cursor) not in self.conditions:  # != may be made of ==
                self.whole(cursor, "not dropped", operand, "bool")
        elif text.startswith(b"-") and not text.startswith(b"--") and number_kind(cursor) in NUMBERS | DEPENDENT:
            self.whole(cursor, "sign dropped", operand)
            self.covered.add(self.span(inside(children[0])))
        elif number_kind(cursor) in INTEGERS:
            for step, other in kinds.STEPS.items():
                if text.startswith(step.encode()):
                    self.whole(cursor, "arithmetic", other.encode() + operand)
                elif text.endswith(step.encode()):
                    self.whole(cursor, "arithmetic", operand + other.encode())

    def vectors(self, cursor, broken):
        # The types of two Eigen expressions differ; those of their values don't.
        if "Eigen::" in cursor.type.get_canonical().spelling:
            self.whole(cursor, "arithmetic", broken, "eval")

    def call(self, cursor, children):
        operator = self.operator(cursor).decode(errors="replace")
        if operator in ("+", "-", "+=", "-="):
            left, right = flat(self.of(children[0])), flat(self.of(children[2]))
            other = kinds.ARITHMETIC.get(operator) or kinds.COMPOUND[operator]
            if left is not None and right is not None:
                self.vectors(cursor, left + b" " + other.encode() + b" " + right)
            return
        if cursor.spelling == "operator-" and self.of(cursor).startswith(b"-") and len(children) == 2:
            self.vectors(cursor, flat(self.of(children[0])))
            return
        if operator in kinds.COMPARISONS:
            # Those of Eigen's arrays give an array.
            if number_kind(cursor) not in {TypeKind.BOOL} | DEPENDENT:
                return
            left, right = flat(self.of(children[0])), flat(self.of(children[2]))
            if left is not None and right is not None:
                self.comparison(cursor, operator, left, right)
            return
        if operator:
            return
        name, at = self.called(cursor, children)
        if name in kinds.NAMES:
            start, end = self.span(cursor)
            text = self.data[start:at] + kinds.NAMES[name].encode() + self.data[at + len(name) : end]
            self.whole(cursor, "other function", flat(text))
        arguments = [argument for argument in cursor.get_arguments() if argument is not None]
        if name in kinds.SYMMETRIC:
            self.unordered.update(self.span(argument) for argument in arguments)
        else:
            self.exchanged(arguments)

    def called(self, cursor, children):
        """The called function's bare name and where it stands."""
        if not children:
            return "", 0
        callee = inside(children[0])
        at = callee.location.offset
        found = re.match(rb"[A-Za-z_]\w*", self.data[at : at + 100])
        if callee.kind not in (Kind.DECL_REF_EXPR, Kind.MEMBER_REF_EXPR) or not found:
            return "", 0
        return found.group().decode(), at

    def unwatched(self, cursor):
        if cursor.kind != Kind.CALL_EXPR:
            return False
        name, at = self.called(cursor, list(cursor.get_children()))
        head = self.data[self.span(cursor)[0] : at]
        return name in kinds.UNWATCHED or any(prefix.encode() in head for prefix in kinds.UNWATCHED_PREFIXES)

    def exchanged(self, arguments):
        """Neighbouring arguments of one type."""
        for first, second in zip(arguments, arguments[1:]):
            if self.between(first, second) != b",":
                continue
            texts = [flat(self.of(first)), flat(self.of(second))]
            if None in texts or texts[0] == texts[1] or any(t.startswith((b"{", b"[", b"std::move(", b".")) for t in texts):
                continue
            if texts[0].endswith(b"begin()") or inside(first).kind == Kind.LAMBDA_EXPR:
                continue
            types = [re.sub(r"\bconst\b|&", "", argument.type.get_canonical().spelling).strip() for argument in (first, second)]
            if types[0] != types[1] or not types[0] or "dependent" in types[0]:
                continue
            self.add("arguments exchanged", (Part(*self.span(first), texts[1]), Part(*self.span(second), texts[0])), "")

    # --- constants ---

    def constant(self, cursor):
        text = self.of(cursor)
        if self.span(cursor) in self.covered:
            return
        if cursor.kind == Kind.CXX_BOOL_LITERAL_EXPR and text in (b"true", b"false"):
            self.whole(cursor, "constant", b"false" if text == b"true" else b"true")
        elif cursor.kind == Kind.CHARACTER_LITERAL and re.match(rb"'.*'\Z", text):
            self.whole(cursor, "constant", b"static_cast<char>(" + text + b" + 1)")
        elif cursor.kind == Kind.INTEGER_LITERAL and (found := INTEGER.match(text)):
            digits = found.group(1).replace(b"'", b"")
            if digits[:1] == b"0" and len(digits) > 1:
                self.whole(cursor, "constant", b"(" + text + b" + 1)")
            else:
                # No test would notice a limit of 1001 instead of 1000.
                other = int(digits) + 1 if int(digits) < LARGE else 2 * int(digits)
                self.whole(cursor, "constant", str(other).encode() + found.group(2))
        elif cursor.kind == Kind.FLOATING_LITERAL and FLOATING.match(text):
            value = float(re.sub(rb"[fFlL']", b"", text)) if b"x" not in text else 1.0
            if value == 0:
                self.whole(cursor, "constant", b"1.0" + FLOATING.match(text).group(1))
            elif abs(value) >= SMALLEST_CONSTANT:
                self.whole(cursor, "constant", b"(2 * " + text + b")")

    def named_constant(self, cursor):
        """A constant of the project where it is used: its definition is a constant expression."""
        text = self.of(cursor)
        if self.span(cursor) in self.covered or not re.match(rb"(\w+::)*k[A-Z]\w*\Z", text):
            return
        sort = number_kind(cursor)
        if sort == TypeKind.DOUBLE or sort == TypeKind.FLOAT:
            self.whole(cursor, "constant", b"(2 * " + text + b")")
        elif sort in INTEGERS:
            self.whole(cursor, "constant", b"(" + text + b" + 1)")

    # --- what is found ---

    def whole(self, cursor, kind, broken, wrapper=""):
        if broken is not None:
            self.add(kind, (Part(*self.span(cursor), broken),), wrapper)

    def add(self, kind, parts, wrapper):
        for part in parts:
            original = self.data[part.start : part.end]
            if part.end <= part.start or flat(original) is None or b"#" in part.broken.replace(b"'#'", b"") and b'"' not in part.broken:
                return
        mutant = Mutant(self.name, self.text.line_of(parts[0].start), kind, parts, wrapper, self.at_run_time)
        if mutant.key() in self.seen:
            return
        self.seen.add(mutant.key())
        mutant.before, mutant.after = shown(self.data, self.text, mutant)
        if mutant.before != mutant.after:
            self.mutants.append(mutant)
