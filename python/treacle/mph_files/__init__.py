"""Files of the program of the authors of [K23], and the cases that they become (docs/import.md). All in SI units."""
