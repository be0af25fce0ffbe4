from studies._cure import study as cure

study = cure("cure-isothermal", "Cure at 360 K", 0.0, ("material.resin.state.cure.heat=0",))
