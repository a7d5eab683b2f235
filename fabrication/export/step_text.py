"""The text of a STEP file made small, and the same for the same content.

The kernel writes every point as often as it is used, and colours in an order that depends on where
they lie in memory. Here equal points and directions become one, colours follow the parts they
belong to, and all entities are numbered anew. Nothing else changes.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

_NEXT = re.compile(rb";\s*\n#")
_BREAK = re.compile(rb"\n +")
_REFERENCE = re.compile(rb"'(?:[^']|'')*'|#(\d+)")
_COLOURS = b"MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION"
_SHARED = (b"CARTESIAN_POINT", b"DIRECTION")


def compact(data: bytes) -> bytes:
    """The section DATA of a file, from after its keyword on to the end of the file."""
    body, _, tail = data.rpartition(b"ENDSEC;")
    texts = dict(_entities(body))
    same = _duplicates(texts)
    order = [*_parts(texts, same), *_colours(texts, same)]
    new = {old: b"#%d" % number for number, old in enumerate(order, start=1)}
    new |= {old: new[kept] for old, kept in same.items()}

    def renumbered(found: re.Match[bytes]) -> bytes:
        return found[0] if found[1] is None else new[int(found[1])]

    written = [b"%s=%s" % (new[old], _REFERENCE.sub(renumbered, texts[old])) for old in order]
    return b"\n" + b";\n".join(written) + b";\nENDSEC;" + tail


def _entities(body: bytes) -> Iterator[tuple[int, bytes]]:
    """Every entity's number and text, on one line."""
    whole = _BREAK.sub(b"", body.strip())
    for piece in _NEXT.split(whole[1:].rstrip(b";\n ")):
        number, _, text = piece.partition(b"=")
        yield int(number), text.strip()


def _duplicates(texts: Mapping[int, bytes]) -> dict[int, int]:
    """Points and directions that repeat an earlier one, with the number of that one."""
    first: dict[bytes, int] = {}
    same = {}
    for number, text in texts.items():
        if text.startswith(_SHARED):
            kept = first.setdefault(text, number)
            if kept != number:
                same[number] = kept
    return same


def _parts(texts: Mapping[int, bytes], same: Mapping[int, int]) -> Iterator[int]:
    """All but duplicates and colours, as they are."""
    for number, text in texts.items():
        if text.startswith(_COLOURS):
            return
        if number not in same:
            yield number


def _colours(texts: Mapping[int, bytes], same: Mapping[int, int]) -> Iterator[int]:
    """What follows the parts, each colour's block where its part stands among the parts."""
    start = next((n for n, text in texts.items() if text.startswith(_COLOURS)), None)
    if start is None:
        return
    roots = [n for n, text in texts.items() if n >= start and text.startswith(_COLOURS)]
    seen: set[int] = set()
    for root in sorted(roots, key=lambda root: _first_part(texts, root, start)):
        stack = [root]
        while stack:
            number = stack.pop()
            if number in seen or number < start or number in same:
                continue
            seen.add(number)
            yield number
            stack += reversed(_references(texts[number]))
    yield from (n for n in texts if n >= start and n not in seen and n not in same)


def _first_part(texts: Mapping[int, bytes], root: int, start: int) -> int:
    """The smallest number of a part that the block of *root* refers to."""
    found: list[int] = []
    for item in _references(texts[root]):
        if item >= start:
            found += [n for n in _references(texts[item]) if n < start]
    return min(found, default=start)


def _references(text: bytes) -> list[int]:
    return [int(n) for n in _REFERENCE.findall(text) if n]
