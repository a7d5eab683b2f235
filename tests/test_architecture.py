import subprocess
import sys

FRESH_PAIR = """
import build123d, cadquery
box = build123d.Box(1, 2, 3)
shape = cadquery.Shape.cast(box.wrapped)
assert abs(shape.Volume() - 6.0) < 1e-9, shape.Volume()
back = build123d.Solid(cadquery.Workplane().box(1, 1, 2).val().wrapped)
assert abs(back.volume - 2.0) < 1e-9, back.volume
print("one kernel")
"""

LIGHT = """
import sys
import fabrication.cli
from fabrication.project import read_project
read_project("examples/01_enneper_60.toml")
heavy = {"OCP", "build123d", "cadquery", "scipy", "ezdxf"} & set(sys.modules)
assert not heavy, heavy
print("light")
"""

NO_WINDOW = """
import sys
import fabrication
fabrication.structure, fabrication.nest, fabrication.flat_parts, fabrication.fit
heavy = {"OCP", "build123d", "cadquery"} & set(sys.modules)
assert not heavy, heavy
print("no kernel")
"""


def run(code: str) -> str:
    result = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False
    )
    assert result.returncode == 0, result.stderr
    return result.stdout.strip()


def test_build123d_and_cadquery_share_one_kernel_in_a_fresh_interpreter():
    assert run(FRESH_PAIR) == "one kernel"


def test_help_and_check_load_nothing_heavy():
    assert run(LIGHT) == "light"


def test_flat_parts_do_not_load_the_cad_kernel():
    assert run(NO_WINDOW) == "no kernel"


def test_public_functions_are_not_shadowed_by_their_modules():
    code = """
import importlib, pkgutil
import fabrication, gridshell
for package in (gridshell, fabrication):
    for module in pkgutil.walk_packages(package.__path__, package.__name__ + "."):
        importlib.import_module(module.name)
    for name in package.__all__:
        assert type(getattr(package, name)).__name__ != "module", name
print("unshadowed")
"""
    assert run(code) == "unshadowed"
