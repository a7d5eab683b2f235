"""fabrication: from a net to what a shop needs.

The pipeline::

    built  = structure(net, Profile(width=100.0, thickness=2.5, material=STAINLESS))
    parts  = flat_parts(built, SlotJoint(clearance=0.3))        straight strips with their slots
    sheets = nest(parts, Sheet(6000.0, 1500.0))
    write_dxf(sheets, "out/sheets")                             CUT, MARK and TEXT layers
    write_step(solids(built, parts), "out/roof.step")           one named solid per lamella

Names are loaded when they are first used: the CAD kernel takes seconds and is not needed for a
net, a flat part or a sheet. Lengths are mm, angles radians, stresses N/mm2.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
