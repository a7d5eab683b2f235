from fabrication.export import html
from fabrication.export.html import rendered


def page(tmp_path, monkeypatch, text, **values):
    (tmp_path / "a.html").write_text(text, encoding="utf-8")
    monkeypatch.setattr(html, "__file__", str(tmp_path / "html.py"))
    return rendered("a.html", **values)


def test_text_is_escaped_and_what_is_missing_is_nothing(tmp_path, monkeypatch):
    text = "{{ name }}|{{ net.angle.max }}|"
    assert page(tmp_path, monkeypatch, text, name="<b>&", net={}) == "&lt;b&gt;&amp;||"


def test_numbers_and_counts_are_written_as_people_read_them(tmp_path, monkeypatch):
    text = '{{ 1234.5 | fixed(1) }} {{ 1e-9 | figure }} {{ 2 | plural("strip") }}'
    assert page(tmp_path, monkeypatch, text) == "1\u202f234.5 1.00 × 10⁻⁹ 2 strips"
