"""The project file: read, checked and written; every error names its key.

A project says *where* the net comes from (``[surface]`` with ``[patch]`` or, from a file, with
``[remesh]``; or ``[mesh]``), *what* it must be (``[net]``) and *how* it is built: lamellas
(``[profile]``, ``[joint]``, ``[facade]``) or panels (``[panels]``, ``[supports]``, ``[connector]``)
cut from ``[sheet]`` and ``[panel_sheet]``.
"""

from __future__ import annotations

import difflib
import json
import tomllib
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any, get_args

from pydantic import ValidationError

from fabrication.angle_sections import ANGLE_CHOICES, FieldSection, MirrorSection
from fabrication.angle_settings import require_angle
from fabrication.errors import ProjectError
from fabrication.export_sections import ExportSection
from fabrication.export_settings import require_export
from fabrication.joint_sections import (
    BlocksSection,
    CleatSection,
    JointSection,
    StudSection,
    WasherSection,
)
from fabrication.key_help import key_help
from fabrication.lamella_sections import (
    BarsSection,
    FlatSection,
    PapersSection,
    SegmentsSection,
    SpliceSection,
)
from fabrication.motion_sections import MotionSection, UmbrellaSection
from fabrication.panel_sections import (
    BeamsSection,
    ConnectorSection,
    FacadeSection,
    MouldsSection,
    PanelsSection,
    SupportsSection,
)
from fabrication.panel_settings import require_panels
from fabrication.section_types import MaterialSection, Section
from fabrication.sections import NetSection, ProfileSection, Project, SheetSection
from fabrication.settings import require_makeable
from fabrication.shop_sections import LayersSection, ShopSection
from fabrication.source_sections import (
    GuideSection,
    MeshSection,
    PatchSection,
    RemeshSection,
    SurfaceSection,
)


def read_project(path: Path | str) -> Project:
    """Read and validate a project file; a mesh file is looked for beside it.

    Raises
    ------
    ProjectError
        When the file is missing, is not TOML, a key is wrong, missing or unknown, or the settings
        do not go together.
    """
    path = Path(path)
    return project_of(read_document(path)[1], path)


def read_document(path: Path) -> tuple[str, dict[str, Any]]:
    """The text of a project file, and the tables it holds.

    Raises
    ------
    ProjectError
        When it cannot be read or is not TOML.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
        return text, tomllib.loads(text)
    except OSError as error:
        raise ProjectError(
            "The project file cannot be read",
            where=str(path),
            value=error.strerror or type(error).__name__,
            advice="check the path",
        ) from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ProjectError("The project file is not TOML", where=f"{path}: {error}") from None


def project_of(document: Mapping[str, Any], path: Path) -> Project:
    """Validate what a project file holds; files it names are looked for beside *path*.

    Raises
    ------
    ProjectError
        As :func:`read_project`.
    """
    try:
        project = Project.model_validate(document)
    except ValidationError as error:
        raise _explained(path, error) from None
    require_makeable(project, path)
    require_angle(project, path)
    require_panels(project, path)
    require_export(project, path)
    return project


# ---- writing -----------------------------------------------------------------------------------


def project_text(project: Project, *, explained: bool = False) -> str:
    """*project* as TOML with every setting; what is unset stands in a comment.

    ``read_project`` makes the same project of it.

    Parameters
    ----------
    explained : with what every key means behind it, and the sections it could have besides.
    """
    lines = [f"name = {_toml(project.name)}"]
    for name in type(project).model_fields:
        section = getattr(project, name)
        if isinstance(section, Section):
            about = f"  # {key_help('Project', name)}" if explained else ""
            lines += ["", f"[{name}]{about}", *_settings(section, explained)]
    if explained:
        lines += ["", "# Sections that it could have, too:", *_possible(project)]
    return "\n".join(lines) + "\n"


def _settings(section: Section, explained: bool) -> Iterator[str]:
    names = {kind: name for name, kind in reversed(_sections().items())}
    for name, field in type(section).model_fields.items():
        value = getattr(section, name)
        about = key_help(names[type(section)], name) if explained else ""
        if value is None:
            yield f"# {name} = ...  # unset: {field.description}" + (f"; {about}" if about else "")
        else:
            yield f"{name} = {_toml(value)}" + (f"  # {about}" if about else "")


_OF_STRIPS = ("bars", "shop", "flat", "papers", "segments", "export", "facade")
_OF_PANELS = ("supports", "connector", "beams", "moulds", "panel_sheet", "export")
_OF_UMBRELLAS = ("shop", "papers", "motion", "export")


def _possible(project: Project) -> Iterator[str]:
    """Sections that *project* does not have and its kind may have, with their keys, as comments."""
    possible = _OF_UMBRELLAS if project.umbrella is not None else _OF_STRIPS
    for name in _OF_PANELS if project.panels is not None else possible:
        if getattr(project, name) is not None:
            continue
        yield f"# [{name}]  # {key_help('Project', name)}"
        kinds = _kinds_of(Project.model_fields[name].annotation)
        for kind in kinds if len(kinds) == 1 else ():
            yield from _blank(kind)
        if len(kinds) > 1:
            tags = [get_args(kind.model_fields["kind"].annotation)[0] for kind in kinds]
            yield f"#   kind = ...  # {', '.join(tags)}; each has keys of its own"


def _kinds_of(annotation: Any) -> list[type[Section]]:
    """All sections that an annotation allows."""
    if isinstance(annotation, type):
        return [annotation] if issubclass(annotation, Section) else []
    return [kind for part in get_args(annotation) for kind in _kinds_of(part)]


def _blank(kind: type[Section]) -> Iterator[str]:
    """The keys of a section: needed ones, and what the others are when they are left out."""
    named = next(name for name, section in _sections().items() if section is kind)
    for name, field in kind.model_fields.items():
        if field.is_required() or field.default is None:
            said = "..."
        else:
            said = _toml(field.get_default(call_default_factory=True))
        need = "needed; " if field.is_required() else ""
        need = f"unset: {field.description}; " if field.default is None else need
        yield f"#   {name} = {said}  # {need}{key_help(named, name)}"


def _toml(value: Any) -> str:
    if isinstance(value, Section):
        given = value.model_dump(exclude_none=True)
        return "{ " + ", ".join(f"{key} = {_toml(getattr(value, key))}" for key in given) + " }"
    if isinstance(value, tuple | list):
        return "[" + ", ".join(map(_toml, value)) + "]"
    if isinstance(value, str | bool):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    return repr(value)


# ---- errors ------------------------------------------------------------------------------------

_LIMITS: dict[str, Callable[[dict[str, Any]], str]] = {
    **dict.fromkeys(("float_type", "float_parsing"), lambda _: "a number"),
    **dict.fromkeys(
        ("int_type", "int_from_float", "int_parsing", "int_parsing_size"),
        lambda _: "a whole number",
    ),
    **dict.fromkeys(("bool_type", "bool_parsing"), lambda _: "true or false"),
    **dict.fromkeys(
        ("model_type", "model_attributes_type", "dict_type"), lambda _: "a table of settings"
    ),
    "string_type": lambda _: "text in quotes",
    "finite_number": lambda _: "a finite number",
    "greater_than": lambda c: f"> {c['gt']:g}",
    "greater_than_equal": lambda c: f">= {c['ge']:g}",
    "less_than": lambda c: f"< {c['lt']:g}",
    "less_than_equal": lambda c: f"<= {c['le']:g}",
    "string_too_short": lambda c: f"{c['min_length']} or more characters",
    "string_too_long": lambda c: f"{c['max_length']} characters at most",
    "list_type": lambda _: "a list of tables",
    "tuple_type": lambda _: "a list of 2 numbers",
    "too_long": lambda c: f"a list of {c['max_length']} numbers",
    "literal_error": lambda c: c["expected"].replace(" or ", ", ").replace("'", ""),
    "angle_choice": lambda _: ANGLE_CHOICES,
    "value_error": lambda c: str(c["error"]),
}
"""What is allowed instead, by pydantic's name for the mistake."""


_TOLD = 4
"""Of further mistakes, so many are named."""


def _explained(path: Path, error: ValidationError) -> ProjectError:
    """The first thing that is wrong, unknown keys before all others, as one sentence."""
    problems = error.errors(include_url=False)
    first = min(problems, key=lambda problem: problem["type"] != "extra_forbidden")
    key, location = _key(first["loc"]), first["loc"]
    told_already = {key, _meant(location) if first["type"] == "extra_forbidden" else key}
    others = [k for k in dict.fromkeys(_key(p["loc"]) for p in problems) if k not in told_already]
    told = ", ".join(others[:_TOLD]) + (" ..." if len(others) > _TOLD else "")
    more = f" (to mend, too: {told})" if others else ""
    where = f"{path}, {key}" if key else str(path)
    if first["type"] == "extra_forbidden":
        return ProjectError(f"Unknown key{more}", where=where, advice=_nearest_key(location))
    if first["type"] == "missing" and isinstance(location[-1], int):
        limit = f"{location[-1] + 1} numbers"
        where, value = f"{path}, {_key(location[:-1])}", repr(first["input"])
        return ProjectError(f"A key has a wrong value{more}", where=where, value=value, limit=limit)
    if first["type"] == "missing":
        return ProjectError(f"A key is missing{more}", where=where, advice=f"add {key}")
    if first["type"] == "foreign":
        return ProjectError(
            f"This setting does not belong here{more}",
            where=where,
            value=first["ctx"]["value"],
            limit=first["ctx"]["limit"],
            advice="leave it out",
        )
    if first["type"] == "union_tag_invalid":
        return _unknown_choice(where, more, first["ctx"])
    if first["type"] == "union_tag_not_found":
        tag = first["ctx"]["discriminator"].strip("'")
        return ProjectError(
            f"A key is missing{more}", where=f"{where}.{tag}", advice=f"add {key}.{tag}"
        )
    limit = _LIMITS[first["type"]](first.get("ctx", {}))
    if not key:
        return ProjectError(f"{limit[0].upper()}{limit[1:]}{more}", where=where)
    return ProjectError(
        f"A key has a wrong value{more}", where=where, value=repr(first["input"]), limit=limit
    )


def _unknown_choice(where: str, more: str, context: dict[str, str]) -> ProjectError:
    choices = context["expected_tags"].replace("'", "")
    return ProjectError(
        f"A key has a wrong value{more}",
        where=f"{where}.{context['discriminator'].strip(chr(39))}",
        value=repr(context["tag"]),
        limit=choices,
        advice=_nearest(context["tag"], choices.split(", ")),
    )


def _sections() -> dict[str, type[Section]]:
    """Every section by what stands for it in an error's place: its key, or its kind or layout."""
    named: dict[str, type[Section]] = {
        "remesh": RemeshSection,
        "guides": GuideSection,
        "mesh": MeshSection,
        "net": NetSection,
        "profile": ProfileSection,
        "washer": WasherSection,
        "cleat": CleatSection,
        "stud": StudSection,
        "blocks": BlocksSection,
        "bars": BarsSection,
        "shop": ShopSection,
        "layers": LayersSection,
        "splice": SpliceSection,
        "flat": FlatSection,
        "umbrella": UmbrellaSection,
        "mirror": MirrorSection,
        "motion": MotionSection,
        "segments": SegmentsSection,
        "export": ExportSection,
        "papers": PapersSection,
        "sheet": SheetSection,
        "own material": MaterialSection,
        "panels": PanelsSection,
        "supports": SupportsSection,
        "facade": FacadeSection,
        "beams": BeamsSection,
        "moulds": MouldsSection,
        "panel_sheet": SheetSection,
    }
    section: type[Section]
    for section in get_args(FieldSection):
        named[f"{get_args(section.model_fields['kind'].annotation)[0]} angle"] = section
    for union in (SurfaceSection, PatchSection, ConnectorSection, JointSection):
        for section in get_args(get_args(union)[0]):
            tag = section.model_fields.get("kind") or section.model_fields["layout"]
            named[get_args(tag.annotation)[0]] = section
    return named


def _key(location: tuple[int | str, ...]) -> str:
    """The dotted key a person wrote; names of union branches are left out."""
    sections: list[type[Section]] = [Project, *_sections().values()]
    fields = {name for section in sections for name in section.model_fields}
    *path, last = location or ("",)
    shown = [part for part in path if isinstance(part, int) or part in fields]
    branch = last not in fields and (
        last in _sections() or str(last).endswith((" material", " angle"))
    )
    return ".".join(str(part) for part in (shown if branch else [*shown, last]))


def _meant(location: tuple[int | str, ...]) -> str:
    """The dotted key that a misspelt one most likely stands for."""
    return _key((*location[:-1], _nearest_key(location).strip("'")))


def _nearest_key(location: tuple[int | str, ...]) -> str:
    """Advice: the key of the same section that looks most like the unknown one."""
    sections = _sections()
    inside = [sections[str(part)] for part in location[:-1] if str(part) in sections]
    return _nearest(str(location[-1]), list((inside[-1] if inside else Project).model_fields))


def _nearest(word: str, known: list[str]) -> str:
    match = difflib.get_close_matches(word, known, n=1, cutoff=0.5)
    return f"'{match[0]}'" if match else f"one of {', '.join(known)}"
