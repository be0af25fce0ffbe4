"""What films and reports of runs are made of. Reads run directories as they are (docs/output.md): nothing here needs
the compiled part of the package, but the packages of `pip install '.[pictures]'`."""
