"""Slips that a programmer could make in a C++ file, found in its syntax tree (libclang) and written into it beside the original.

Every slip has a number. The file that is written does what the original does, but for the slip whose number is in the environment
(`slip.hpp`): so all slips of all files are built once. A slip is one of these:

    condition never, condition always   of if, while (never alone), ?: and of what a function returns as bool
    operand dropped                     of && and ||
    statement dropped                   a call or an assignment whose value nobody reads
    operator                            < for <=, > for >=, == for != and back, + for - and back, of numbers that are built in
"""
from dataclasses import dataclass, field

from clang.cindex import Config, CursorKind, Index, TranslationUnit, TypeKind

Config.set_library_file("libclang-14.so.1")

OPERATORS = {"<": ("<=", "lt"), "<=": ("<", "le"), ">": (">=", "gt"), ">=": (">", "ge"),
             "==": ("!=", "eq"), "!=": ("==", "ne"), "+": ("-", "add"), "-": ("+", "sub")}
LOGICAL = ("&&", "||")
FUNCTIONS = (CursorKind.FUNCTION_DECL, CursorKind.CXX_METHOD, CursorKind.CONSTRUCTOR, CursorKind.DESTRUCTOR,
             CursorKind.FUNCTION_TEMPLATE, CursorKind.CONVERSION_FUNCTION)
BRANCHES = (CursorKind.IF_STMT, CursorKind.FOR_STMT, CursorKind.WHILE_STMT, CursorKind.CXX_FOR_RANGE_STMT)
NUMBERS = (TypeKind.CHAR_U, TypeKind.UCHAR, TypeKind.USHORT, TypeKind.UINT, TypeKind.ULONG, TypeKind.ULONGLONG, TypeKind.CHAR_S,
           TypeKind.SCHAR, TypeKind.SHORT, TypeKind.INT, TypeKind.LONG, TypeKind.LONGLONG, TypeKind.FLOAT, TypeKind.DOUBLE)
COMPOUND_ASSIGNMENT = CursorKind.COMPOUND_ASSIGNMENT_OPERATOR


@dataclass
class Slip:
    file: str
    line: int
    what: str  # as it is shown: "condition never: a < b"
    edits: list = field(default_factory=list)  # (start, end, text before, text after), or (start, end, text) in place of it
    number: int = 0


class Finder:
    """Finds the slips of one file."""

    def __init__(self, path, shown, arguments):
        self.path, self.shown, self.slips = path, shown, []
        unit = Index.create().parse(path, args=arguments, options=TranslationUnit.PARSE_DETAILED_PROCESSING_RECORD)
        errors = [d for d in unit.diagnostics if d.severity >= 3]
        if errors:
            raise SystemExit(f"propose: clang does not read {shown}: {errors[0].spelling} ({errors[0].location.file}:{errors[0].location.line})")
        with open(path, "rb") as file:
            self.text = file.read()
        self.macros = [self.extent(c) for c in unit.cursor.get_children() if c.kind == CursorKind.MACRO_INSTANTIATION and self.here(c)]
        for cursor in unit.cursor.get_children():
            if self.here(cursor):
                self.outside(cursor)

    def here(self, cursor):
        return cursor.location.file is not None and cursor.location.file.name == self.path

    @staticmethod
    def extent(cursor):
        return cursor.extent.start.offset, cursor.extent.end.offset

    def piece(self, start, end):
        return self.text[start:end].decode()

    def add(self, cursor, kind, make):
        """make(number) gives the edits."""
        start, end = self.extent(cursor)
        if start >= end or any(start < m_end and m_start < end for m_start, m_end in self.macros):
            return
        shown = " ".join(self.piece(start, end).split())
        shown = shown if len(shown) < 90 else shown[:87] + "..."
        self.slips.append(Slip(self.shown, cursor.extent.start.line, f"{kind}: {shown}", make))

    def outside(self, cursor):
        if cursor.kind in FUNCTIONS:
            for child in cursor.get_children():
                if child.kind == CursorKind.COMPOUND_STMT:
                    self.inside(child, cursor.result_type.get_canonical().kind == TypeKind.BOOL)
            return
        for child in cursor.get_children():
            self.outside(child)

    def condition(self, cursor, always=True):
        if cursor.kind.is_declaration() or cursor.kind == CursorKind.DECL_STMT:
            return
        start, end = self.extent(cursor)
        if self.piece(start, end) in ("true", "false"):
            return
        self.add(cursor, "never", lambda n: [(start, end, "((", f") && !slip::made({n}))")])
        if always:
            self.add(cursor, "always", lambda n: [(start, end, "((", f") || slip::made({n}))")])

    def inside(self, cursor, returns_bool):
        kind, children = cursor.kind, list(cursor.get_children())
        if kind == CursorKind.LAMBDA_EXPR:
            returns_bool = False
        if kind == CursorKind.COMPOUND_STMT:
            for child in children:
                self.statement(child)
        elif kind in BRANCHES:
            self.branch(kind, children)
        elif kind == CursorKind.CONDITIONAL_OPERATOR:
            self.condition(children[0])
        elif kind == CursorKind.RETURN_STMT and returns_bool and children:
            self.condition(children[0])
        elif kind == CursorKind.BINARY_OPERATOR:
            self.operator(cursor, children)
        for child in children:
            self.inside(child, returns_bool)

    def branch(self, kind, children):
        if kind == CursorKind.IF_STMT:
            # "if (auto x = f())" has a declaration in the condition's place.
            at = next((i for i, c in enumerate(children) if c.kind.is_expression()), None)
            if at is None or children[0].kind == CursorKind.VAR_DECL:
                return
            self.condition(children[at])
            bodies = children[at + 1:]
        else:
            if kind == CursorKind.WHILE_STMT:
                self.condition(children[0], always=False)
            bodies = children[-1:]
        for body in bodies:
            self.statement(body)

    def statement(self, cursor):
        """A call or an assignment as a statement: dropped."""
        if not self.dropped_is_legal(cursor):
            return
        start, end = self.extent(cursor)
        self.add(cursor, "dropped", lambda n: [(start, end, f"slip::made({n}) ? void() : void(", ")")])

    def dropped_is_legal(self, cursor):
        if cursor.kind in (CursorKind.CALL_EXPR, COMPOUND_ASSIGNMENT):
            return self.piece(*self.extent(cursor)).split("(")[0] not in ("assert", "static_assert")
        if cursor.kind == CursorKind.UNARY_OPERATOR:
            return "++" in self.piece(*self.extent(cursor)) or "--" in self.piece(*self.extent(cursor))
        return cursor.kind == CursorKind.BINARY_OPERATOR and self.sign(list(cursor.get_children())) == "="

    def sign(self, children):
        if len(children) != 2:
            return None
        return self.piece(self.extent(children[0])[1], self.extent(children[1])[0]).strip()

    def operator(self, cursor, children):
        sign = self.sign(children)
        if sign in LOGICAL:
            for child in children:
                start, end = self.extent(child)
                after = ") || slip::made({}))" if sign == "&&" else ") && !slip::made({}))"
                self.add(child, f"without, beside {sign}", lambda n, s=start, e=end, a=after: [(s, e, "((", a.format(n))])
        elif sign in OPERATORS and all(c.type.get_canonical().kind in NUMBERS for c in children):
            doubles = any(c.type.get_canonical().kind in (TypeKind.FLOAT, TypeKind.DOUBLE) for c in children)
            if doubles and sign not in ("+", "-"):
                return  # whether a measured number equals its bound is no question
            other, name = OPERATORS[sign]
            (start, left), (right, end) = self.extent(children[0]), self.extent(children[1])
            self.add(cursor, f"{other} for {sign}", lambda n: [(start, end, f"slip::{name}({n}, ", ")"), (left, right, ", ")])


def with_slips(text, slips):
    """The file's text (bytes) with all of these slips beside the original."""
    events = []  # (offset, order, text, offset where the original goes on)
    for slip in slips:
        for start, end, before, *after in slip.edits(slip.number):
            if not after:  # instead of the operator
                events.append((start, (2, 0, 0), before, end))
                continue
            # What ends at an offset goes first, the inner one first; then what begins there, the outer one first.
            events.append((start, (1, -end, slip.number), before, start))
            events.append((end, (0, -start, -slip.number), after[0], end))
    out, at = [], 0
    for offset, _, piece, goes_on in sorted(events):
        if offset > at:
            out.append(text[at:offset])
            at = offset
        out.append(piece.encode())
        at = max(at, goes_on)
    return b"".join(out) + text[at:]
