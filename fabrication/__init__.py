"""fabrication: from a net to what a shop needs.

The pipeline::

    built  = structure(net, Profile(width=100.0, thickness=2.5, material=STAINLESS))
    parts  = flat_parts(built, SlotJoint(clearance=0.3))        straight strips with their slots
    sheets = nest(parts, Sheet(6000.0, 1500.0))
    write_dxf(sheets, "out/sheets")                             CUT, MARK and TEXT layers
    write_step(solids(built, parts), "out/roof.step")           one named solid per lamella

On a planar net panels take the place of lamellas::

    built  = panelled(skin, PanelSystem(panels, plates, connectors))
    sheets = nest([panel_piece(panel) for panel in built.panels], Sheet(3000.0, 1500.0))
    write_bodies(structure_bodies(built), "out/roof.step", name="roof")    equal parts share a solid

Names are loaded when they are first used: the CAD kernel takes seconds and is not needed for a
net, a flat part or a sheet. Lengths are mm, angles radians, stresses N/mm2.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
