"""A loop over a method with its calls written out: in CPython calls take longer than a step's arithmetic.

The method's source takes the place of `step(...)`, the model's that of `acceleration(...)`; what hangs on
h and w0² alone is computed before the loop; and where a method is first-same-as-last, its first
acceleration is the last one of the step before.  No operation is changed or reordered, so neither is
a bit; tests/bench/methods_vs_c.py measures what it brings.
"""

import ast
import inspect
import re
import sys
from collections.abc import Callable
from functools import cache
from types import FunctionType
from typing import Any

from engine.methods import Method
from engine.models.pendulum import acceleration

_OPENING = "theta, omega = phase"
_SHARED = {"acceleration", "h", "omega", "phase", "theta"}  # names that mean the same in loops and methods
_GIVEN = {"h", "w0_squared"}  # what does not change during a loop


class NotInlinableError(Exception):
    """No source, or not that of a step as in the book: `theta, omega = phase`, formulas, a returned pair."""


def written_out(loop: Callable[..., Any], method: Method) -> Callable[..., Any]:
    """`loop(step, acceleration, ...)` as a function of (w0_squared, ...) for this method and the pendulum.

    The loop has one statement `theta, omega = step(acceleration, ..., h)`.  Raises NotInlinableError.
    """
    formulas, definition = _formulas(method), _definition(loop)
    if _names(*formulas) & _names(*definition.body) - _SHARED:
        raise NotInlinableError(method.key)  # a variable of one would overwrite the other's
    writer = _Writer(formulas, method.first_same_as_last)
    writer.visit(definition)
    arguments = dict.fromkeys(["w0_squared", *(argument.arg for argument in definition.args.args)])
    definition.args.args = [ast.arg(name) for name in arguments if name not in ("step", "acceleration")]
    definition.returns = None
    definition.body[:0] = ast.parse("\n".join(f"{name} = {value}" for value, name in writer.before.items())).body
    namespace = dict(vars(sys.modules[loop.__module__]))
    exec(compile(ast.unparse(definition), f"<{definition.name} of {method.key}>", "exec"), namespace)
    written: Callable[..., Any] = namespace[definition.name]
    return written


_source = cache(inspect.getsource)  # it costs 0.6 ms a call, half of the time that writing out takes


def _definition(function: Callable[..., Any]) -> ast.FunctionDef:
    try:
        (definition,) = ast.parse(_source(function)).body
    except (OSError, TypeError, SyntaxError) as error:  # no file, no function, a part of a statement
        raise NotInlinableError(str(function)) from error
    if not isinstance(definition, ast.FunctionDef) or not isinstance(function, FunctionType) or function.__closure__:
        raise NotInlinableError(str(function))
    return definition


def _formulas(method: Method) -> list[ast.stmt]:
    """The statements that carry theta and omega one step forward."""
    match [node for node in _definition(method.step).body if not isinstance(node, ast.Expr)]:
        case [opening, *formulas, ast.Return(value=ast.Tuple() as following)]:
            if ast.unparse(opening) == _OPENING and all(isinstance(formula, ast.Assign) for formula in formulas):
                return [*formulas, *ast.parse(f"theta, omega = {ast.unparse(following)}").body]
    raise NotInlinableError(method.key)


def _names(*statements: ast.stmt) -> set[str]:
    return {node.id for statement in statements for node in ast.walk(statement) if isinstance(node, ast.Name)}


def _is_call(node: ast.AST, name: str) -> bool:
    return isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == name


class _Writer(ast.NodeTransformer):
    """Writes calls out, and notes in `before` what is computed before the loop: expression -> variable."""

    def __init__(self, formulas: list[ast.stmt], first_same_as_last: bool) -> None:
        self.formulas = formulas
        calls = [node for each in formulas for node in ast.walk(each) if _is_call(node, "acceleration")]
        self.kept = (calls[0], calls[-1]) if first_same_as_last else ()
        self.before: dict[str, str] = {}

    def visit_Assign(self, node: ast.Assign) -> Any:
        if not _is_call(node.value, "step"):
            return self.generic_visit(node)
        return [self.visit(formula) for formula in self.formulas]

    def visit_Call(self, node: ast.Call) -> ast.AST:
        if not _is_call(node, "acceleration"):
            return self.generic_visit(node)
        if node in self.kept[:1]:
            self.before[ast.unparse(self.visit(_model("phase[0]")))] = "kept"
            return ast.Name("kept")
        written: ast.expr = self.visit(_model(ast.unparse(node.args[0])))
        return ast.NamedExpr(ast.Name("kept"), written) if node in self.kept[1:] else written

    def visit_BinOp(self, node: ast.BinOp) -> ast.AST:
        return self._early(node)

    def visit_UnaryOp(self, node: ast.UnaryOp) -> ast.AST:
        return self._early(node)

    def _early(self, node: ast.expr) -> ast.AST:
        names = _names(ast.Expr(node))
        if not names or names - _GIVEN:
            return self.generic_visit(node)
        return ast.Name(self.before.setdefault(ast.unparse(node), f"given{len(self.before)}"))


def _model(theta: str) -> ast.expr:
    """The model's acceleration at the expression `theta`."""
    (inner,) = (node for node in _definition(acceleration).body if isinstance(node, ast.FunctionDef))
    (formula,) = (node.value for node in inner.body if isinstance(node, ast.Return) and node.value)
    return ast.parse(re.sub(r"\btheta\b", f"({theta})", ast.unparse(formula)), mode="eval").body
