"""Files a shop opens: DXF sheets, STEP, lists and reports."""
