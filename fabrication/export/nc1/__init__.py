"""DSTV NC1: steel plates for the machines of steelwork shops, a file per distinct plate."""
