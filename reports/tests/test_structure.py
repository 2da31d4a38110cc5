"""Computing and drawing stay apart, and the code keeps to its limits."""

import ast
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent.parent
FILES = sorted(path for folder in (HERE, HERE / "charts", HERE / "tests") for path in folder.glob("*.py"))
MODULES = {".".join(path.relative_to(HERE.parent).with_suffix("").parts): path for path in FILES}
COMPUTES = ("numpy", "scipy", "h5py", "csv", "json", "tomllib")
DRAWS = ("matplotlib",)


def imports_of(tree: ast.AST) -> set[str]:
    """The modules that a file imports, anywhere in it, and what it takes of them."""
    found: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
    return found


def uses(modules: set[str], packages: tuple[str, ...]) -> bool:
    """Whether any module belongs to one of the packages."""
    return any(module.split(".")[0] in packages for module in modules)


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(HERE)))
def test_no_file_both_computes_and_plots(path: Path) -> None:
    """Only charts/ imports matplotlib, and nothing in it can read or compute: so no function does both."""
    modules = imports_of(ast.parse(path.read_text(encoding="utf-8")))
    in_charts = path.parent.name == "charts"
    assert not (uses(modules, DRAWS) and uses(modules, COMPUTES))
    assert in_charts or not uses(modules, DRAWS)
    assert not in_charts or modules & MODULES.keys() <= {"reports.charts.style", "reports.words"}


def test_no_modules_import_each_other() -> None:
    """Taking away, again and again, every module that imports none of those left takes away all: there is no circle."""
    left = {name: imports_of(ast.parse(path.read_text(encoding="utf-8"))) & MODULES.keys() for name, path in MODULES.items()}
    while free := [name for name, modules in left.items() if not modules & left.keys()]:
        for name in free:
            del left[name]
    assert not left


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(HERE)))
def test_files_and_functions_are_short_typed_and_described(path: Path) -> None:
    """Files under 500 lines; functions under 60, with a docstring and type hints."""
    text = path.read_text(encoding="utf-8")
    assert len(text.splitlines()) < 500
    tree = ast.parse(text)
    assert ast.get_docstring(tree), "a file says what it is for"
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef):
            where = f"{node.name}, line {node.lineno}"
            assert node.end_lineno - node.lineno < 60, where
            assert node.returns is not None, where
            assert all(item.annotation for item in node.args.args if item.arg != "self"), where
            assert ast.get_docstring(node) or node.name == "__init__", where
