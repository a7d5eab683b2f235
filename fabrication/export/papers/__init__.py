"""Papers for the shop: the only package that imports reportlab."""
