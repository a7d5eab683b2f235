"""BTLx: timber strips for joinery machines, one file with a part per strip, in its flat state."""
