import base64
import json
import re
import zlib

from fabrication.export.scene.page import deflated, library, library_folder, scripts, viewer


def test_the_library_has_what_the_viewer_asks_of_it():
    exported = re.search(r"export\s*\{([^}]*)\}", library())[1]
    names = {re.split(r"\s+as\s+", name.strip())[-1] for name in exported.split(",")}
    assert {"THREE", "OrbitControls"} <= names
    assert (library_folder() / "index.js").is_file()


def test_the_viewer_is_one_module_without_imports():
    assert not re.search(r"^\s*import\b", viewer(), re.MULTILINE)
    assert viewer().count("export function viewer") == 1


def test_scripts_cannot_end_early():
    found = scripts()
    assert found.count("<script") == found.count("</script") == 3
    assert "sourceMappingURL" not in found


def test_what_is_deflated_comes_back():
    value = {"A1": "<svg>é</svg>", "n": [1, 2.5, None]}
    assert json.loads(zlib.decompress(base64.b64decode(deflated(value)))) == value
