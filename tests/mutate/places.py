"""Finds the places in a source where something can be broken: declarations and statements, by libclang."""
import json
import os
import re

import clang.cindex as cindex
from clang.cindex import CursorKind as Kind
from clang.cindex import TypeKind

from expressions import LEFT_ALONE, NUMBERS, Expressions, inside, number_kind
from source_text import flat

FUNCTIONS = {Kind.FUNCTION_DECL, Kind.CXX_METHOD, Kind.CONSTRUCTOR, Kind.DESTRUCTOR, Kind.CONVERSION_FUNCTION, Kind.FUNCTION_TEMPLATE}
SCOPES = {Kind.NAMESPACE, Kind.STRUCT_DECL, Kind.CLASS_DECL, Kind.CLASS_TEMPLATE, Kind.CLASS_TEMPLATE_PARTIAL_SPECIALIZATION,
          Kind.LINKAGE_SPEC, Kind.UNION_DECL}


def compile_commands(folder):
    """The compiler's arguments that libclang needs, by source."""
    with open(os.path.join(folder, "compile_commands.json"), encoding="utf-8") as file:
        entries = json.load(file)
    commands = {}
    for entry in entries:
        words = re.findall(r'(?:[^\s"\\]|\\.|"(?:[^"\\]|\\.)*")+', entry["command"])
        words = [re.sub(r'\\(.)', r"\1", word) for word in words]
        arguments = ["-x", "c++"]
        for at, word in enumerate(words):
            if word.startswith(("-D", "-I", "-std")):
                arguments.append(word)
            elif word == "-isystem":
                arguments += [word, words[at + 1]]
        commands[entry["file"]] = arguments
    return commands


def places_in(source, arguments, root, wanted):
    """The mutants of all files in `wanted` (from the project's root) that this source holds: itself and headers."""
    unit = cindex.Index.create().parse(source, arguments)
    errors = [d for d in unit.diagnostics if d.severity >= cindex.Diagnostic.Fatal]
    if errors:
        raise RuntimeError(f"clang can't read {source}: {errors[0].spelling}")
    finders = {}
    for cursor in unit.cursor.get_children():
        file = cursor.location.file
        if file is None:
            continue
        name = os.path.relpath(file.name, root) if file.name.startswith(root + "/") else None
        if name not in wanted:
            continue
        if name not in finders:
            with open(file.name, "rb") as stream:
                finders[name] = Finder(name, stream.read())
        finders[name].declaration(cursor)
    return [mutant for finder in finders.values() for mutant in finder.mutants]


class Finder(Expressions):
    """Walks one file's declarations and statements."""

    # --- declarations ---

    def declaration(self, cursor):
        kind = cursor.kind
        if kind in SCOPES:
            for child in cursor.get_children():
                self.declaration(child)
        elif kind in FUNCTIONS:
            self.function(cursor)
        elif kind in (Kind.VAR_DECL, Kind.FIELD_DECL):
            self.variable(cursor)
        elif kind == Kind.UNEXPOSED_DECL or kind == Kind.FRIEND_DECL:
            for child in cursor.get_children():
                self.declaration(child)

    def function(self, cursor):
        children = list(cursor.get_children())
        bodies = [child for child in children if child.kind == Kind.COMPOUND_STMT]
        if not bodies or not self.of(bodies[-1]).startswith(b"{"):
            return
        body = bodies[-1]
        head = self.data[self.span(cursor)[0] : self.span(body)[0]]
        if re.search(rb"\bconsteval\b", head):
            return
        before, self.at_run_time = self.at_run_time, bool(re.search(rb"\bconstexpr\b", head))
        if cursor.kind == Kind.CONSTRUCTOR or (cursor.kind == Kind.FUNCTION_TEMPLATE and b":" in head):
            for child in children:  # of the members
                if child.kind.is_expression() and self.span(child)[0] > cursor.location.offset:
                    self.expression(child)
        self.statement(body)
        self.at_run_time = before

    def variable(self, cursor):
        start, end = self.span(cursor)
        if re.search(rb"\b(constexpr|constinit)\b", self.data[start : cursor.location.offset]):
            return
        for child in cursor.get_children():
            at = self.span(child)[0]
            if cursor.kind == Kind.FIELD_DECL and self.of(child) in (b"0", b"0.0", b"0.0F", b"false", b"-1"):
                continue  # what is filled later
            if cursor.kind == Kind.FIELD_DECL and inside(child).kind == Kind.DECL_REF_EXPR:
                continue  # a format's own number, the same for who writes and who reads
            if child.kind.is_expression() and at > cursor.location.offset and self.data[cursor.location.offset : at].rstrip()[-1:] != b"[":
                self.expression(child)

    # --- statements ---

    def statement(self, cursor):
        kind = cursor.kind
        if kind in LEFT_ALONE:
            return
        children = list(cursor.get_children())
        if kind == Kind.COMPOUND_STMT:
            for child in children:
                self.maybe_dropped(child)
        elif kind == Kind.IF_STMT:
            self.if_statement(cursor, children)
        elif kind in (Kind.FOR_STMT, Kind.WHILE_STMT, Kind.DO_STMT):
            self.loop(cursor, children)
        elif kind == Kind.CXX_FOR_RANGE_STMT:
            for child in children[:-1]:
                if child.kind.is_expression():
                    self.unordered.add(self.span(child))
                    self.expression(child)
                elif child.kind == Kind.DECL_STMT:
                    self.statement(child)
            self.maybe_dropped(children[-1])
        elif kind == Kind.CASE_STMT:
            self.maybe_dropped(children[-1])
        elif kind in (Kind.DEFAULT_STMT, Kind.LABEL_STMT):
            for child in children[-1:]:
                self.maybe_dropped(child)
        elif kind == Kind.DECL_STMT:
            for child in children:
                self.declaration(child)
        elif kind == Kind.RETURN_STMT:
            for child in children:
                self.returned(child)
                self.expression(child)
        elif kind.is_expression():
            self.expression(cursor)
        else:
            for child in children:
                self.statement(child)

    def maybe_dropped(self, cursor):
        """A statement of a block or branch."""
        dropped = inside(cursor) if cursor.kind.is_expression() else cursor
        assigns = dropped.kind == Kind.COMPOUND_ASSIGNMENT_OPERATOR or self.operator(dropped) in (b"=", b"+=", b"-=", b"*=", b"/=", b"|=", b"&=")
        steps = dropped.kind == Kind.UNARY_OPERATOR and self.of(dropped).strip(b"+-") != self.of(dropped)
        if cursor.kind.is_expression() and (dropped.kind == Kind.CALL_EXPR or assigns or steps) and not self.unwatched(dropped):
            self.whole(cursor, "statement dropped", b"", wrapper="void")
        self.statement(cursor)

    def if_statement(self, cursor, children):
        if re.match(rb"if\s+(constexpr|consteval)\b", self.of(cursor)):
            for child in children:
                if not child.kind.is_expression():
                    self.maybe_dropped(child)
            return
        declares = any(child.kind == Kind.VAR_DECL for child in children)
        conditions = [i for i, child in enumerate(children[:2]) if child.kind.is_expression() and not declares]
        first = conditions[0] if conditions else (1 if declares else 0)
        for i, child in enumerate(children):
            if i < first:
                if child.kind == Kind.VAR_DECL:
                    self.variable(child)
                else:
                    self.statement(child)
            elif i == first:
                if not declares:
                    self.condition(child)
                    self.expression(child)
            else:
                self.maybe_dropped(child)

    def condition(self, cursor):
        if self.of(cursor).strip() in (b"true", b"false") or b"EINTR" in self.of(cursor):
            return
        self.conditions.add(self.span(cursor))
        self.whole(cursor, "condition never true", b"false", wrapper="bool")
        self.whole(cursor, "condition always true", b"true", wrapper="bool")

    def loop(self, cursor, children):
        if cursor.kind == Kind.FOR_STMT:
            head = self.data[self.span(cursor)[0] : self.span(children[-1])[0]]
            for child in children[:-1]:
                # The step of a loop isn't changed: the loop would never end.
                if child.kind == Kind.DECL_STMT:
                    self.statement(child)
                elif self.is_condition(cursor, child, head):
                    self.expression(child)
            self.maybe_dropped(children[-1])
            return
        for child in children:
            if child.kind == Kind.VAR_DECL:
                self.variable(child)
            elif child.kind.is_expression():
                if cursor.kind == Kind.WHILE_STMT and child is children[0] and self.of(child) != b"true" and b"EINTR" not in self.of(child):
                    self.whole(child, "condition never true", b"false", wrapper="bool")
                self.expression(child)
            else:
                self.maybe_dropped(child)

    def is_condition(self, loop, child, head):
        start = self.span(child)[0] - self.span(loop)[0]
        return head[:start].count(b";") == 1 and child.kind.is_expression()

    def returned(self, cursor):
        inner = inside(cursor)
        if number_kind(cursor) in NUMBERS and inner.kind not in (Kind.INTEGER_LITERAL, Kind.FLOATING_LITERAL) and self.of(cursor) != b"-1":
            self.whole(cursor, "result zero", b"0")
        if number_kind(inner) == TypeKind.BOOL and inner.kind in (Kind.CALL_EXPR, Kind.DECL_REF_EXPR, Kind.MEMBER_REF_EXPR):
            if not self.operator(inner):
                self.whole(cursor, "result negated", b"!static_cast<bool>(" + (flat(self.of(cursor)) or b"#") + b")", wrapper="bool")
