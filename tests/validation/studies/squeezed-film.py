from studies._squeezed import speed
from studies._squeezed import study as squeezed

mu = 10.0  # [Pa s]; the yield stress of the case is as good as zero

study = squeezed("squeezed-film", "Newtonian fluid between plates that close", lambda x, h: -12 * mu * speed * x / h**3, 0.035,
                 ("material.fluid.rheology.yield_stress=1e-6",))
