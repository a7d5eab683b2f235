"""Files that other programs open: GLB, PLY, OBJ, .3dm, IFC4.

What is built becomes a :class:`~fabrication.export.interchange.model.Model`, plain data: every part
with its mark, layer, mesh, axis and numbers. One module per format writes it.
"""
