from studies._cure import study as cure

study = cure("cure-adiabatic", "Cure by its own heat", 2.4e5, ())
